//! A command as it is typed.

use std::str::FromStr;

/// vx, vy (m/s, heading frame) and yaw rate (rad/s).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Command(pub [f32; 3]);

impl FromStr for Command {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let numbers: Result<Vec<f32>, _> =
            text.split(',').map(|part| part.trim().parse()).collect();
        match numbers.as_deref() {
            Ok(&[forward, left, yaw]) if [forward, left, yaw].iter().all(|x| x.is_finite()) => {
                Ok(Self([forward, left, yaw]))
            }
            _ => Err("expected three numbers, as in 0.8,0,0".to_owned()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_command_is_three_finite_numbers() {
        assert_eq!("0.8, 0,-0.5".parse(), Ok(Command([0.8, 0.0, -0.5])));
        for text in ["", "0.8", "0.8,0", "0.8,0,0,0", "a,b,c", "inf,0,0"] {
            assert!(text.parse::<Command>().is_err(), "{text:?}");
        }
    }
}
