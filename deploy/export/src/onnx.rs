//! The policy as an ONNX model: `observation` `[batch, inputs]` in, `action` `[batch, joints]` out.
//!
//! Separate because the graph is the policy's formula once more, in another language; a test runs it in another
//! runtime and compares. Normalisation and clipping are inside, exploration is not: the action is the mean.
//!
//! ```text
//! observation ─ Sub mean ─ Mul inverse deviation ─ Clip ─ (Gemm ─ Elu)… ─ Gemm ─ action
//! ```

mod message;

use crate::network::Network;
use message::{
    AttributeProto, Dimension, FLOAT, GraphProto, ModelProto, NodeProto, OperatorSetIdProto,
    StringStringEntryProto, TensorProto, TensorShapeProto, TensorType, TypeProto, ValueInfoProto,
};
use policy::OUTPUTS;
use prost::Message;

/// Name of the model's input.
pub const INPUT: &str = "observation";
/// Name of the model's output.
pub const OUTPUT: &str = "action";
/// Version of the operators; every operator used here is unchanged since 13.
pub const OPSET: i64 = 17;
/// Version of the container that goes with it.
const IR_VERSION: i64 = 8;

/// The model with `properties` (key, value) as its metadata.
pub fn model(network: &Network, properties: &[(String, String)]) -> Vec<u8> {
    let model = ModelProto {
        ir_version: IR_VERSION,
        opset_import: vec![OperatorSetIdProto {
            domain: String::new(),
            version: OPSET,
        }],
        producer_name: "ampco".to_owned(),
        producer_version: env!("CARGO_PKG_VERSION").to_owned(),
        graph: Some(graph(network)),
        metadata_props: properties
            .iter()
            .map(|(key, value)| StringStringEntryProto {
                key: key.clone(),
                value: value.clone(),
            })
            .collect(),
    };
    model.encode_to_vec()
}

fn graph(network: &Network) -> GraphProto {
    let inputs = network.inputs();
    let mut graph = GraphProto {
        name: "policy".to_owned(),
        input: vec![value(INPUT, inputs)],
        output: vec![value(OUTPUT, OUTPUTS)],
        ..GraphProto::default()
    };
    graph.constant("mean", &[inputs], network.mean());
    graph.constant("inverse_deviation", &[inputs], network.inverse_deviation());
    graph.constant("least", &[], &[-network.clip()]);
    graph.constant("greatest", &[], &[network.clip()]);
    graph.node("Sub", &[INPUT, "mean"], "centred");
    graph.node("Mul", &["centred", "inverse_deviation"], "scaled");
    graph.node("Clip", &["scaled", "least", "greatest"], "normalised");
    let mut before = "normalised".to_owned();
    for (index, (place, weights, bias)) in network.layers().enumerate() {
        let names = ["weight", "bias", "linear", "elu"].map(|part| format!("{part}_{index}"));
        let [weight_name, bias_name, linear, elu] = names;
        graph.constant(&weight_name, &[place.inputs, place.outputs], weights);
        graph.constant(&bias_name, &[place.outputs], bias);
        let last = index == network.hidden().len();
        let after = if last { OUTPUT.to_owned() } else { linear };
        graph.node("Gemm", &[&before, &weight_name, &bias_name], &after);
        before = after;
        if !last {
            graph.node("Elu", &[&before], &elu);
            let alpha = AttributeProto::float("alpha", 1.0);
            graph.node.last_mut().expect("just added").attribute = vec![alpha];
            before = elu;
        }
    }
    graph
}

impl GraphProto {
    fn constant(&mut self, name: &str, dims: &[usize], values: &[f32]) {
        assert_eq!(
            dims.iter().product::<usize>(),
            values.len(),
            "size of {name}"
        );
        self.initializer.push(TensorProto {
            dims: dims.iter().map(|&dim| dim as i64).collect(),
            data_type: FLOAT,
            name: name.to_owned(),
            raw_data: values.iter().flat_map(|x| x.to_le_bytes()).collect(),
        });
    }

    fn node(&mut self, operator: &str, inputs: &[&str], output: &str) {
        self.node.push(NodeProto {
            input: inputs.iter().map(|&name| name.to_owned()).collect(),
            output: vec![output.to_owned()],
            name: format!("{operator}_{output}"),
            op_type: operator.to_owned(),
            attribute: Vec::new(),
        });
    }
}

/// `[batch, width]`, the batch of any size.
fn value(name: &str, width: usize) -> ValueInfoProto {
    ValueInfoProto {
        name: name.to_owned(),
        r#type: Some(TypeProto {
            tensor_type: Some(TensorType {
                elem_type: FLOAT,
                shape: Some(TensorShapeProto {
                    dim: vec![
                        Dimension::any("batch"),
                        Dimension::of(width.try_into().expect("a small number")),
                    ],
                }),
            }),
        }),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use policy::Shape;

    #[test]
    fn the_graph_is_the_formula_in_order() {
        let shape = Shape::new(5, &[3]);
        let network = Network::new(shape.clone(), 2.5, vec![0.5; shape.len()]).unwrap();
        let bytes = model(&network, &[("run".to_owned(), "walk".to_owned())]);
        let model = ModelProto::decode(bytes.as_slice()).unwrap();
        let graph = model.graph.unwrap();
        let operators: Vec<&str> = graph.node.iter().map(|n| n.op_type.as_str()).collect();
        let shape = |value: &ValueInfoProto| {
            let tensor = value.r#type.as_ref().unwrap().tensor_type.as_ref().unwrap();
            tensor.shape.as_ref().unwrap().dim.clone()
        };
        assert_eq!(shape(&graph.input[0])[1], Dimension::of(5));
        assert_eq!(operators, ["Sub", "Mul", "Clip", "Gemm", "Elu", "Gemm"]);
        // Each node reads what the one before wrote.
        let mut before = INPUT.to_owned();
        for node in &graph.node {
            assert_eq!(node.input[0], before);
            before = node.output[0].clone();
        }
        assert_eq!(before, OUTPUT);
        let limits: Vec<f32> = ["least", "greatest"]
            .iter()
            .map(|name| {
                let held = graph.initializer.iter().find(|held| held.name == *name);
                let bytes = held.unwrap().raw_data.as_slice().try_into().unwrap();
                f32::from_le_bytes(bytes)
            })
            .collect();
        assert_eq!(limits, [-2.5, 2.5]);
        assert_eq!(model.opset_import[0].version, 17);
        assert_eq!(model.metadata_props[0].value, "walk");
    }
}
