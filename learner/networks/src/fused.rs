//! Products, bias, activation and their derivatives as single burn operations.
//!
//! Composed of burn's own operations, a layer's bias and ELU read and write its activations about ten times, more work
//! than the matrix product's on this kind of machine. Here each direction is one pass, in place where burn allows it.
//!
//! Compiled for burn's CPU backend only; another backend needs an implementation of [`FusedOps`] and [`FusedBackward`].

use crate::product::{Matrix, product as multiply};
use crate::{Activation, kernels};
use burn::backend::autodiff::{
    checkpoint::{base::Checkpointer, strategy::CheckpointStrategy},
    grads::Gradients,
    ops::{Backward, Ops, OpsKind},
};
use burn::backend::flex::FlexTensor;
use burn::backend::tensor::FloatTensor;
use burn::backend::{Autodiff, Backend, Dispatch, Flex, TensorMetadata, backend_extension};
use burn::tensor::{Tensor, TensorData};

/// `left · right`; left `[n, inner]`, right `[inner, columns]`, either of them possibly a transpose.
pub fn product(left: Tensor<2>, right: Tensor<2>) -> Tensor<2> {
    Tensor::from_dispatch(Dispatch::product(
        left.into_dispatch(),
        right.into_dispatch(),
    ))
}

/// `activation(sums + bias)`; sums `[n, columns]`, bias `[columns]`.
pub fn activate(sums: Tensor<2>, bias: Tensor<1>, activation: Activation) -> Tensor<2> {
    Tensor::from_dispatch(Dispatch::activate(
        sums.into_dispatch(),
        bias.into_dispatch(),
        activation,
    ))
}

/// `values` where `outputs > 0`, else 0; values `[n, columns]` or one row `[1, columns]` for all, outputs `[n, columns]`.
///
/// `outputs` count as constants: a ReLU's derivative changes nowhere but at its kink.
pub fn gate(values: Tensor<2>, outputs: Tensor<2>) -> Tensor<2> {
    Tensor::from_dispatch(Dispatch::gate(
        values.into_dispatch(),
        outputs.into_dispatch(),
    ))
}

/// The operations, on tensors with and without a record of derivatives.
#[backend_extension(Flex, Autodiff)]
pub trait FusedOps: Backend {
    /// See [`product`].
    fn product(left: FloatTensor<Self>, right: FloatTensor<Self>) -> FloatTensor<Self>;
    /// See [`activate`].
    fn activate(
        sums: FloatTensor<Self>,
        bias: FloatTensor<Self>,
        activation: Activation,
    ) -> FloatTensor<Self>;
    /// See [`gate`].
    fn gate(values: FloatTensor<Self>, outputs: FloatTensor<Self>) -> FloatTensor<Self>;
}

/// Their derivatives, on tensors without a record.
pub trait FusedBackward: Backend {
    /// Gradients of the sums and of the bias, from outputs and their gradient.
    fn activate_backward(
        outputs: FloatTensor<Self>,
        gradient: FloatTensor<Self>,
        activation: Activation,
    ) -> (FloatTensor<Self>, FloatTensor<Self>);
    /// Gradient of the values; one row if there was one row.
    fn gate_backward(
        gradient: FloatTensor<Self>,
        outputs: FloatTensor<Self>,
        one_row: bool,
    ) -> FloatTensor<Self>;
}

impl FusedOps for Flex {
    fn product(left: FlexTensor, right: FlexTensor) -> FlexTensor {
        let (left, right) = (matrix(&left), matrix(&right));
        let shape = [left.rows(), right.columns()];
        FlexTensor::from_data(TensorData::new(multiply(left, right), shape))
    }

    fn activate(mut sums: FlexTensor, bias: FlexTensor, activation: Activation) -> FlexTensor {
        assert!(sums.is_contiguous(), "a product's result is contiguous");
        kernels::activate(sums.storage_mut(), bias.storage(), activation);
        sums
    }

    fn gate(mut values: FlexTensor, outputs: FlexTensor) -> FlexTensor {
        let values_shape = values.shape();
        let [rows, columns] = outputs.shape().dims();
        assert!(outputs.is_contiguous(), "a layer's output is contiguous");
        if values_shape.dims() == [rows, columns] {
            values = values.to_contiguous();
            kernels::gate(values.storage_mut(), outputs.storage());
            return values;
        }
        assert_eq!(values_shape.dims(), [1, columns], "one row for all rows");
        let row = values.to_contiguous();
        let mut gated = Vec::new();
        let row = row.as_slice::<f32>().expect("f32, made contiguous above");
        kernels::gate_row(row, outputs.storage(), &mut gated);
        FlexTensor::from_data(TensorData::new(gated, [rows, columns]))
    }
}

impl FusedBackward for Flex {
    fn activate_backward(
        outputs: FlexTensor,
        gradient: FlexTensor,
        activation: Activation,
    ) -> (FlexTensor, FlexTensor) {
        let [_, columns] = outputs.shape().dims();
        let mut gradient = gradient.to_contiguous();
        let mut bias = vec![0.0; columns];
        kernels::differentiate(
            outputs.storage(),
            gradient.storage_mut(),
            &mut bias,
            activation,
        );
        let bias = FlexTensor::from_data(TensorData::new(bias, [columns]));
        (gradient, bias)
    }

    fn gate_backward(gradient: FlexTensor, outputs: FlexTensor, one_row: bool) -> FlexTensor {
        let mut gradient = gradient.to_contiguous();
        if !one_row {
            kernels::gate(gradient.storage_mut(), outputs.storage());
            return gradient;
        }
        let [_, columns] = outputs.shape().dims();
        let mut totals = vec![0.0; columns];
        kernels::gate_totals(gradient.storage(), outputs.storage(), &mut totals);
        FlexTensor::from_data(TensorData::new(totals, [1, columns]))
    }
}

/// A tensor of two dimensions as it lies in memory.
fn matrix(tensor: &FlexTensor) -> Matrix<'_> {
    let layout = tensor.layout();
    let strides = <[isize; 2]>::try_from(layout.strides()).expect("two dimensions");
    let strides =
        strides.map(|stride| usize::try_from(stride).expect("nothing flipped is multiplied here"));
    let values = &tensor.storage()[layout.start_offset()..];
    Matrix::new(values, tensor.shape().dims(), strides)
}

/// The step back through [`product`]:  dL = dY·Rᵀ,  dR = Lᵀ·dY.
#[derive(Debug)]
struct Product;

impl<B: FusedOps> Backward<B, 2> for Product {
    type State = [FloatTensor<B>; 2];

    fn backward(self, ops: Ops<Self::State, 2>, grads: &mut Gradients, _: &mut Checkpointer) {
        let ([left_node, right_node], [left, right]) = (ops.parents, ops.state);
        let gradient = grads.consume::<B>(&ops.node);
        if let Some(node) = left_node {
            let left = B::product(gradient.clone(), B::float_transpose(right));
            grads.register::<B>(node.id, left);
        }
        if let Some(node) = right_node {
            let right = B::product(B::float_transpose(left), gradient);
            grads.register::<B>(node.id, right);
        }
    }
}

/// The step back through [`activate`].
#[derive(Debug)]
struct Activate(Activation);

impl<B: FusedBackward> Backward<B, 2> for Activate {
    type State = FloatTensor<B>;

    fn backward(self, ops: Ops<Self::State, 2>, grads: &mut Gradients, _: &mut Checkpointer) {
        let [sums, bias] = ops.parents;
        let gradient = grads.consume::<B>(&ops.node);
        let (sums_gradient, bias_gradient) = B::activate_backward(ops.state, gradient, self.0);
        if let Some(node) = sums {
            grads.register::<B>(node.id, sums_gradient);
        }
        if let Some(node) = bias {
            grads.register::<B>(node.id, bias_gradient);
        }
    }
}

/// The step back through [`gate`], and whether its values were one row.
#[derive(Debug)]
struct Gate(bool);

impl<B: FusedBackward> Backward<B, 1> for Gate {
    type State = FloatTensor<B>;

    fn backward(self, ops: Ops<Self::State, 1>, grads: &mut Gradients, _: &mut Checkpointer) {
        let [values] = ops.parents;
        let gradient = grads.consume::<B>(&ops.node);
        if let Some(node) = values {
            grads.register::<B>(node.id, B::gate_backward(gradient, ops.state, self.0));
        }
    }
}

impl<B: FusedOps + FusedBackward, C: CheckpointStrategy> FusedOps for Autodiff<B, C> {
    fn product(left: FloatTensor<Self>, right: FloatTensor<Self>) -> FloatTensor<Self> {
        let (left, left_node) = left.into_parts();
        let (right, right_node) = right.into_parts();
        let product = B::product(left.clone(), right.clone());
        match Product
            .prepare::<C>([left_node, right_node])
            .compute_bound()
            .stateful()
        {
            OpsKind::Tracked(prep) => prep.finish([left, right], product),
            OpsKind::UnTracked(prep) => prep.finish(product),
        }
    }

    fn activate(
        sums: FloatTensor<Self>,
        bias: FloatTensor<Self>,
        activation: Activation,
    ) -> FloatTensor<Self> {
        let (sums, sums_node) = sums.into_parts();
        let (bias, bias_node) = bias.into_parts();
        let outputs = B::activate(sums, bias, activation);
        match Activate(activation)
            .prepare::<C>([sums_node, bias_node])
            .compute_bound()
            .stateful()
        {
            OpsKind::Tracked(prep) => prep.finish(outputs.clone(), outputs),
            OpsKind::UnTracked(prep) => prep.finish(outputs),
        }
    }

    fn gate(values: FloatTensor<Self>, outputs: FloatTensor<Self>) -> FloatTensor<Self> {
        let (values, values_node) = values.into_parts();
        let outputs = outputs.into_primitive();
        let one_row = values.shape() != outputs.shape();
        let gated = B::gate(values, outputs.clone());
        match Gate(one_row)
            .prepare::<C>([values_node])
            .compute_bound()
            .stateful()
        {
            OpsKind::Tracked(prep) => prep.finish(outputs, gated),
            OpsKind::UnTracked(prep) => prep.finish(gated),
        }
    }
}
