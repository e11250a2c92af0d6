//! The policy as actors get it: one flat vector of statistics, exploration widths and weights.
//!
//! Layout: observation mean `[inputs]`, observation inverse deviation `[inputs]`, exploration deviation `[outputs]`, then
//! the actor in the layout of [`Shape`]. Copies only: every number arrives with the bits it left with.

use crate::{NetworkError, Scaling, Shape};

/// The parts of a snapshot.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Parts<'a> {
    /// Mean per observation.
    pub mean: &'a [f32],
    /// Inverse deviation per observation.
    pub inverse: &'a [f32],
    /// Exploration deviation per action.
    pub sigma: &'a [f32],
    /// The actor's weights.
    pub actor: &'a [f32],
}

/// Numbers of a snapshot of this actor.
pub fn len(shape: &Shape) -> usize {
    2 * shape.inputs + shape.outputs + shape.len()
}

/// Writes a snapshot into `flat`, whose former content is dropped.
pub fn export(scaling: &Scaling, sigma: &[f32], actor: &[f32], flat: &mut Vec<f32>) {
    flat.clear();
    for part in [&scaling.mean, &scaling.inverse, sigma, actor] {
        flat.extend_from_slice(part);
    }
}

/// Takes a snapshot apart.
///
/// # Errors
/// If it is not as long as the actor's shape says, or a number is not finite.
pub fn import<'a>(shape: &Shape, flat: &'a [f32]) -> Result<Parts<'a>, NetworkError> {
    NetworkError::check_length("snapshot of the policy", len(shape), flat.len())?;
    if let Some(index) = crate::first_not_finite(flat) {
        return Err(NetworkError::NotFinite {
            what: "snapshot of the policy".to_owned(),
            index,
            value: flat[index],
        });
    }
    let (mean, rest) = flat.split_at(shape.inputs);
    let (inverse, rest) = rest.split_at(shape.inputs);
    let (sigma, actor) = rest.split_at(shape.outputs);
    Ok(Parts {
        mean,
        inverse,
        sigma,
        actor,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Activation;

    #[test]
    fn a_snapshot_comes_back_bit_by_bit() {
        let shape = Shape::new(2, &[], 1, Activation::Elu);
        let scaling = Scaling {
            mean: vec![0.1, -0.0],
            inverse: vec![3.0, 1e-30],
            clip: 5.0,
        };
        let mut flat = vec![7.0];
        export(&scaling, &[0.6], &[1.0, 2.0, 3.0], &mut flat);
        assert_eq!(flat.len(), len(&shape));
        let parts = import(&shape, &flat).expect("whole");
        let bits = |x: &[f32]| x.iter().map(|x| x.to_bits()).collect::<Vec<_>>();
        assert_eq!(bits(parts.mean), bits(&scaling.mean));
        assert_eq!(bits(parts.inverse), bits(&scaling.inverse));
        assert_eq!(
            (parts.sigma, parts.actor),
            (&[0.6][..], &[1.0, 2.0, 3.0][..])
        );
        assert!(import(&shape, &flat[1..]).is_err());
        flat[4] = f32::NAN;
        assert!(matches!(
            import(&shape, &flat),
            Err(NetworkError::NotFinite { index: 4, .. })
        ));
    }
}
