//! One output per row, for many rows, without a record of derivatives.

use networks::{Mlp, Shape, plain_device, shards, tensor, values};

/// Rows that pass through a network at once: their activations then stay in the processor's cache.
pub(crate) const CHUNK: usize = 512;

/// The single output of a network for each row; `rows` `[n][inputs]`, result appended to `out`.
///
/// # Panics
/// If the weights do not fit the shape; the caller owns both.
pub(crate) fn outputs(
    shape: &Shape,
    weights: &[f32],
    rows: &[f32],
    threads: usize,
    out: &mut Vec<f32>,
) {
    let device = plain_device();
    let count = rows.len() / shape.inputs;
    let mut states: Vec<Mlp> = (0..threads.min(count).max(1))
        .map(|_| Mlp::new(shape, weights, &device).expect("weights of this shape"))
        .collect();
    let parts = states.len();
    let results = shards::run(&mut states, |i, network| {
        let mut outputs = Vec::with_capacity(count / parts + 1);
        for piece in shards::pieces(shards::part(count, i, parts), CHUNK) {
            let chunk = rows[piece.start * shape.inputs..piece.end * shape.inputs].to_vec();
            outputs.extend(values(network.forward(tensor(
                chunk,
                shape.inputs,
                &device,
            ))));
        }
        outputs
    });
    results.iter().for_each(|part| out.extend_from_slice(part));
}

#[cfg(test)]
mod tests {
    use super::*;
    use networks::Activation;

    #[test]
    fn rows_keep_their_order_whatever_the_threads() {
        // y = 2·x + 1 on 1,500 rows: three chunks, three threads
        let shape = Shape::new(1, &[], 1, Activation::Relu);
        let rows: Vec<f32> = (0..1500).map(|i| i as f32).collect();
        let mut out = Vec::new();
        outputs(&shape, &[2.0, 1.0], &rows, 3, &mut out);
        assert_eq!(out.len(), 1500);
        assert!(out.iter().zip(&rows).all(|(y, x)| *y == 2.0 * x + 1.0));
    }
}
