//! The weights that are exported, checked once.

use policy::{LayerPlace, OUTPUTS, Policy, PolicyError, Shape};
use sha2::{Digest, Sha256};

/// A policy network as flat weights that fit its shape and are finite.
#[derive(Clone, Debug)]
pub struct Network {
    shape: Shape,
    clip: f32,
    flat: Vec<f32>,
}

impl Network {
    /// From flat weights in the layout of [`Shape`], trained with normalised observations cut to ± `clip`.
    ///
    /// # Errors
    /// Where the policy itself would refuse them: wrong length, not finite, no width, no clip.
    pub fn new(shape: Shape, clip: f32, flat: Vec<f32>) -> Result<Self, PolicyError> {
        Policy::check_clip(clip)?;
        Policy::new(shape.clone(), clip).load(&flat)?;
        Ok(Self { shape, clip, flat })
    }

    /// What normalised observations are cut to, ±.
    pub fn clip(&self) -> f32 {
        self.clip
    }

    /// Numbers in an observation.
    pub fn inputs(&self) -> usize {
        self.shape.inputs
    }

    /// Widths of its hidden layers.
    pub fn hidden(&self) -> &[usize] {
        &self.shape.hidden
    }

    /// Observation means `[inputs]`.
    pub fn mean(&self) -> &[f32] {
        &self.flat[self.shape.mean()]
    }

    /// Observation inverse standard deviations `[inputs]`.
    pub fn inverse_deviation(&self) -> &[f32] {
        &self.flat[self.shape.inverse_deviation()]
    }

    /// Standard deviation of exploration per action `[joints]`; a deployed policy does not explore.
    pub fn sigma(&self) -> &[f32] {
        &self.flat[self.shape.sigma()]
    }

    /// Every layer with its weights `[in][out]`, row by row, and its bias `[out]`.
    pub fn layers(&self) -> impl Iterator<Item = (LayerPlace, &[f32], &[f32])> {
        self.shape.layers().map(|place| {
            let (weights, bias) = (
                &self.flat[place.weights.clone()],
                &self.flat[place.bias.clone()],
            );
            (place, weights, bias)
        })
    }

    /// The action of one observation, by this project's own inference.
    ///
    /// # Panics
    /// If it has not [`Self::inputs`] numbers.
    pub fn action(&self, observation: &[f32]) -> [f32; OUTPUTS] {
        let mut policy = Policy::new(self.shape.clone(), self.clip);
        policy.load(&self.flat).expect("checked when it was made");
        let mut action = [0.0; OUTPUTS];
        policy.means(observation, 1, &mut action);
        action
    }

    /// SHA-256 of the flat weights as little-endian f32, in hexadecimal.
    pub fn hash(&self) -> String {
        let bytes: Vec<u8> = self.flat.iter().flat_map(|x| x.to_le_bytes()).collect();
        sha256(&bytes)
    }
}

/// SHA-256 in hexadecimal, as `sha256sum` prints it.
pub fn sha256(bytes: &[u8]) -> String {
    let digest = Sha256::digest(bytes);
    digest.iter().map(|byte| format!("{byte:02x}")).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn hashes_are_the_published_ones() {
        // FIPS 180-2, appendix B.1.
        assert_eq!(
            sha256(b"abc"),
            "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad"
        );
    }

    #[test]
    fn weights_that_the_policy_refuses_are_not_exported() {
        let shape = Shape::new(82, &[4]);
        let error = Network::new(shape.clone(), 5.0, vec![1.0; 3]).unwrap_err();
        assert!(matches!(error, PolicyError::Length { found: 3, .. }));
        let mut flat = vec![1.0; shape.len()];
        flat[200] = f32::NAN;
        assert!(Network::new(shape.clone(), 5.0, flat).is_err());
        let flat = vec![1.0; shape.len()];
        let error = Network::new(shape, f32::NAN, flat).unwrap_err();
        assert!(matches!(error, PolicyError::Clip { .. }));
    }
}
