//! Element-wise loops over rows of columns, each one pass over memory.
//!
//! Separate from the burn operations that call them because these are plain arithmetic on slices. `pulp` compiles every
//! loop for AVX-512, AVX2 and any machine, and enters the best one.

use crate::{Activation, elu::elu};
use pulp::Arch;

/// `values[row][column] = activation(values[row][column] + bias[column])`
pub(crate) fn activate(values: &mut [f32], bias: &[f32], activation: Activation) {
    fn rows(values: &mut [f32], bias: &[f32], f: impl Fn(f32) -> f32) {
        Arch::new().dispatch(
            #[inline(always)]
            || {
                for row in values.chunks_exact_mut(bias.len()) {
                    for (value, bias) in row.iter_mut().zip(bias) {
                        *value = f(*value + bias);
                    }
                }
            },
        );
    }
    match activation {
        Activation::Identity => rows(
            values,
            bias,
            #[inline(always)]
            |x| x,
        ),
        Activation::Elu => rows(values, bias, elu),
        Activation::Relu => rows(
            values,
            bias,
            // NaN fails the comparison and passes on.
            #[inline(always)]
            |x| if x < 0.0 { 0.0 } else { x },
        ),
    }
}

/// Derivative of [`activate`]: `gradient` becomes that of the sums, and its columns' totals that of the bias.
///
/// The derivative is found from the output y: ELU's is y + 1 below zero, ReLU's 0; 1 above.
pub(crate) fn differentiate(
    outputs: &[f32],
    gradient: &mut [f32],
    bias_gradient: &mut [f32],
    activation: Activation,
) {
    fn rows(outputs: &[f32], gradient: &mut [f32], totals: &mut [f32], slope: impl Fn(f32) -> f32) {
        let columns = totals.len();
        Arch::new().dispatch(
            #[inline(always)]
            || {
                let rows = gradient.chunks_exact_mut(columns);
                for (gradient, outputs) in rows.zip(outputs.chunks_exact(columns)) {
                    for ((gradient, output), total) in
                        gradient.iter_mut().zip(outputs).zip(totals.iter_mut())
                    {
                        *gradient *= slope(*output);
                        *total += *gradient;
                    }
                }
            },
        );
    }
    match activation {
        Activation::Identity => rows(
            outputs,
            gradient,
            bias_gradient,
            #[inline(always)]
            |_| 1.0,
        ),
        Activation::Elu => rows(
            outputs,
            gradient,
            bias_gradient,
            #[inline(always)]
            |y| if y > 0.0 { 1.0 } else { y + 1.0 },
        ),
        Activation::Relu => rows(
            outputs,
            gradient,
            bias_gradient,
            #[inline(always)]
            |y| if y > 0.0 { 1.0 } else { 0.0 },
        ),
    }
}

/// `values[row][column]` where `outputs[row][column] > 0`, else 0.
///
/// All bits or none: of a choice the compiler makes a store under a mask, many times slower with AVX2 on some machines.
pub(crate) fn gate(values: &mut [f32], outputs: &[f32]) {
    Arch::new().dispatch(
        #[inline(always)]
        || {
            for (value, output) in values.iter_mut().zip(outputs) {
                let kept = if *output > 0.0 { u32::MAX } else { 0 };
                *value = f32::from_bits(value.to_bits() & kept);
            }
        },
    );
}

/// The same with one row of values for all rows: `gated[row][column] = row[column]` where the output is above zero.
pub(crate) fn gate_row(row: &[f32], outputs: &[f32], gated: &mut Vec<f32>) {
    gated.reserve(outputs.len());
    Arch::new().dispatch(
        #[inline(always)]
        || {
            for outputs in outputs.chunks_exact(row.len()) {
                gated.extend(
                    row.iter()
                        .zip(outputs)
                        .map(|(value, output)| if *output > 0.0 { *value } else { 0.0 }),
                );
            }
        },
    );
}

/// Derivative of [`gate_row`]: for each column the sum of the gradient over rows whose output is above zero.
pub(crate) fn gate_totals(gradient: &[f32], outputs: &[f32], totals: &mut [f32]) {
    let columns = totals.len();
    Arch::new().dispatch(
        #[inline(always)]
        || {
            let rows = gradient.chunks_exact(columns);
            for (gradient, outputs) in rows.zip(outputs.chunks_exact(columns)) {
                for ((gradient, output), total) in
                    gradient.iter().zip(outputs).zip(totals.iter_mut())
                {
                    *total += if *output > 0.0 { *gradient } else { 0.0 };
                }
            }
        },
    );
}

/// `sum[i] += addend[i]`
pub(crate) fn accumulate(sum: &mut [f32], addend: &[f32]) {
    Arch::new().dispatch(
        #[inline(always)]
        || {
            for (sum, addend) in sum.iter_mut().zip(addend) {
                *sum += addend;
            }
        },
    );
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn activations_by_hand() {
        let run = |activation| {
            let mut values = [1.0, -3.0, 0.5, 2.0];
            activate(&mut values, &[0.5, 1.0], activation);
            values
        };
        // sums: 1.5, −2, 1, 3;  e⁻² − 1 = −0.8646647
        assert_eq!(run(Activation::Identity), [1.5, -2.0, 1.0, 3.0]);
        assert_eq!(run(Activation::Relu), [1.5, 0.0, 1.0, 3.0]);
        let elu = run(Activation::Elu);
        assert!((elu[1] + 0.864_664_7).abs() < 1e-6 && elu[0] == 1.5);
    }

    #[test]
    fn derivatives_by_hand() {
        // outputs of two rows; the second column's first row is below zero at e⁻² − 1: slope e⁻² = 0.1353353
        let outputs = [1.5, -0.864_664_7, 1.0, 3.0];
        let mut gradient = [1.0, 10.0, 2.0, 3.0];
        let mut bias = [0.0; 2];
        differentiate(&outputs, &mut gradient, &mut bias, Activation::Elu);
        assert!((gradient[1] - 1.353_353).abs() < 1e-5);
        assert!((bias[0] - 3.0).abs() < 1e-6 && (bias[1] - 4.353_353).abs() < 1e-5);
        let mut gradient = [1.0, 10.0, 2.0, 3.0];
        let mut bias = [0.0; 2];
        differentiate(&outputs, &mut gradient, &mut bias, Activation::Relu);
        assert_eq!((gradient, bias), ([1.0, 0.0, 2.0, 3.0], [3.0, 3.0]));
    }

    #[test]
    fn gates_by_hand() {
        let outputs = [0.0, 2.0, 0.1, 0.0];
        let mut values = [1.0, 2.0, 3.0, 4.0];
        gate(&mut values, &outputs);
        assert_eq!(values, [0.0, 2.0, 3.0, 0.0]);
        let mut gated = Vec::new();
        gate_row(&[5.0, 6.0], &outputs, &mut gated);
        assert_eq!(gated, [0.0, 6.0, 5.0, 0.0]);
        let mut totals = [0.0; 2];
        gate_totals(&[1.0, 2.0, 3.0, 4.0], &outputs, &mut totals);
        assert_eq!(totals, [3.0, 2.0]);
    }
}
