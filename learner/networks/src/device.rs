//! Between slices and tensors. The devices are named here once: the CPU, with and without a record of derivatives.

use burn::tensor::{Device, Tensor, TensorData};

/// The CPU; tensors on it keep no record.
pub fn plain_device() -> Device {
    Device::flex()
}

/// The CPU; what is computed from tracked weights on it can be differentiated.
pub fn tracked_device() -> Device {
    Device::flex().autodiff()
}

/// Rows as a tensor `[n, columns]`, without copying.
///
/// # Panics
/// If the numbers do not make whole rows.
pub fn tensor(rows: Vec<f32>, columns: usize, device: &Device) -> Tensor<2> {
    let count = rows.len() / columns;
    assert_eq!(count * columns, rows.len(), "whole rows of {columns}");
    Tensor::from_data(TensorData::new(rows, [count, columns]), device)
}

/// The numbers of a tensor, row by row; nothing of its record is kept.
pub fn values<const D: usize>(tensor: Tensor<D>) -> Vec<f32> {
    tensor
        .inner()
        .into_data()
        .try_into_vec()
        .expect("every tensor here is of f32 in main memory")
}
