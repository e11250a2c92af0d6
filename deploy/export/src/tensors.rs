//! The weights as safetensors, under the names of a PyTorch `Sequential` of linear layers and ELUs.
//!
//! Separate from ONNX because this is for going on with the weights (fine-tuning, another framework) and so keeps what
//! a deployed policy drops: the width of exploration. `torch.nn.Linear` stores `[out, in]`, we store `[in, out]`.

use std::collections::HashMap;

use crate::network::Network;
use policy::OUTPUTS;
use safetensors::SafeTensorError;
use safetensors::tensor::{Dtype, TensorView};

/// Mean, inverse deviation and clip of observations, exploration, and the layers as `actor.0`, `actor.2`, ….
///
/// # Errors
/// When the format's own library refuses, which it has no reason to.
pub fn file(network: &Network) -> Result<Vec<u8>, SafeTensorError> {
    let mut tensors: Vec<(String, Vec<usize>, Vec<u8>)> = Vec::new();
    let mut add = |name: &str, shape: &[usize], values: &[f32]| {
        let bytes = values.iter().flat_map(|x| x.to_le_bytes()).collect();
        tensors.push((name.to_owned(), shape.to_vec(), bytes));
    };
    let inputs = network.inputs();
    add("observation.mean", &[inputs], network.mean());
    add(
        "observation.inverse_deviation",
        &[inputs],
        network.inverse_deviation(),
    );
    add("observation.clip", &[1], &[network.clip()]);
    add("exploration.sigma", &[OUTPUTS], network.sigma());
    for (index, (place, weights, bias)) in network.layers().enumerate() {
        let (inputs, outputs) = (place.inputs, place.outputs);
        let transposed: Vec<f32> = (0..inputs * outputs)
            .map(|at| weights[at % inputs * outputs + at / inputs])
            .collect();
        // The activations between the layers count as members of the sequence.
        let layer = 2 * index;
        add(
            &format!("actor.{layer}.weight"),
            &[outputs, inputs],
            &transposed,
        );
        add(&format!("actor.{layer}.bias"), &[outputs], bias);
    }
    let views: Result<Vec<_>, SafeTensorError> = tensors
        .iter()
        .map(|(name, shape, bytes)| {
            Ok((
                name.as_str(),
                TensorView::new(Dtype::F32, shape.clone(), bytes)?,
            ))
        })
        .collect();
    // One entry only: the order of several would differ from call to call, and with it the file's hash.
    let about = HashMap::from([("format".to_owned(), "pt".to_owned())]);
    safetensors::serialize(views?, Some(about))
}

#[cfg(test)]
mod tests {
    use super::*;
    use policy::Shape;
    use safetensors::SafeTensors;

    #[test]
    fn layers_are_transposed_and_nothing_is_lost() {
        let shape = Shape::new(82, &[2]);
        let flat: Vec<f32> = (0..shape.len()).map(|i| 1.0 + i as f32).collect();
        let network = Network::new(shape, 2.5, flat.clone()).unwrap();
        let bytes = file(&network).unwrap();
        let read = SafeTensors::deserialize(&bytes).unwrap();
        let values = |name: &str| -> Vec<f32> {
            let tensor = read.tensor(name).unwrap();
            let numbers = tensor.data().as_chunks::<4>().0.iter();
            numbers.map(|bytes| f32::from_le_bytes(*bytes)).collect()
        };
        assert_eq!(read.tensor("actor.0.weight").unwrap().shape(), [2, 82]);
        assert_eq!(read.tensor("actor.2.weight").unwrap().shape(), [23, 2]);
        // 187 numbers come first; weight (in 0, out 1) is the one after (in 0, out 0).
        let first = values("actor.0.weight");
        assert_eq!((first[0], first[82]), (flat[187], flat[188]));
        assert_eq!(first[1], flat[189]); // in 1, out 0
        assert_eq!(values("actor.0.bias"), flat[187 + 164..187 + 166]);
        assert_eq!(values("observation.mean"), flat[..82]);
        assert_eq!(values("observation.clip"), [2.5]);
        assert_eq!(values("exploration.sigma"), flat[164..187]);
        let numbers: usize = read.tensors().iter().map(|(_, t)| t.data().len() / 4).sum();
        assert_eq!(numbers, flat.len() + 1); // and the clip
        assert_eq!(file(&network).unwrap(), bytes, "the same bytes every time");
    }
}
