//! A value, or one that moves as samples come in.
//!
//! Written `2.0`, or `{ from = 2.0, to = 4.0, samples = [1.5e6, 2.1e6] }`. Samples are those of the whole group that the
//! learner has used, so that all that moves over a run is read by one clock.

use crate::invalid::{Checked, Invalid};
use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::de::value::{MapAccessDeserializer, SeqAccessDeserializer};
use serde::de::{Deserializer, Error, IntoDeserializer, MapAccess, SeqAccess, Visitor};
use serde::{Deserialize, Serialize};
use std::borrow::Cow;
use std::fmt;
use std::marker::PhantomData;

/// A value of the configuration that may move as samples come in.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[serde(untagged)]
pub enum Ramp<T> {
    /// It stays.
    Constant(T),
    /// It goes from one value to another.
    Moving(Way<T>),
}

/// From where to where a value goes, and when.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Way<T> {
    /// Its value until the first number of samples.
    pub from: T,
    /// Its value from the second on.
    pub to: T,
    /// Samples at which it begins to move, and at which it has arrived.
    pub samples: [f64; 2],
}

/// What can go in a straight line.
pub trait Blend: Copy {
    /// Between two values, exact at both ends: `part` 0 is `from`, 1 is `to`.
    fn blend(from: Self, to: Self, part: f32) -> Self;
}

impl Blend for f32 {
    fn blend(from: Self, to: Self, part: f32) -> Self {
        from * (1.0 - part) + to * part
    }
}

impl Blend for [f32; 2] {
    fn blend(from: Self, to: Self, part: f32) -> Self {
        std::array::from_fn(|end| f32::blend(from[end], to[end], part))
    }
}

impl<T: Copy> Ramp<T> {
    /// A value that goes from one to another.
    pub fn moving(from: T, to: T, samples: [f64; 2]) -> Self {
        Self::Moving(Way { from, to, samples })
    }

    /// The value before any sample: of one that stays, that one; [`Ramp::set`] makes it that of a later moment.
    pub fn now(&self) -> T {
        match self {
            Self::Constant(value) => *value,
            Self::Moving(way) => way.from,
        }
    }

    /// The samples between which it moves, if it does.
    pub fn samples(&self) -> Option<[f64; 2]> {
        match self {
            Self::Constant(_) => None,
            Self::Moving(way) => Some(way.samples),
        }
    }

    /// Whether it moves at all.
    pub fn moves(&self) -> bool {
        matches!(self, Self::Moving(_))
    }

    /// Checks every value that it takes at an end, and that its samples are in order. Between its ends it takes none
    /// that is less or more.
    pub fn check(&self, path: &str, check: impl Fn(&str, T) -> Checked) -> Checked {
        let way = match self {
            Self::Constant(value) => return check(path, *value),
            Self::Moving(way) => way,
        };
        check(&format!("{path}.from"), way.from)?;
        check(&format!("{path}.to"), way.to)?;
        let [begins, arrives] = way.samples;
        if begins >= 0.0 && begins <= arrives && arrives.is_finite() {
            return Ok(());
        }
        Err(Invalid::new(
            format!("{path}.samples"),
            way.samples,
            "give two numbers of samples from 0 on, the lesser first",
        ))
    }
}

impl<T: Blend> Ramp<T> {
    /// The value after a number of samples, on a straight line.
    pub fn at(&self, samples: f64) -> T {
        match self {
            Self::Constant(value) => *value,
            Self::Moving(way) => T::blend(way.from, way.to, progress(way.samples, samples)),
        }
    }

    /// Holds the value that it has after a number of samples.
    pub fn set(&mut self, samples: f64) {
        *self = Self::Constant(self.at(samples));
    }
}

impl Ramp<f32> {
    /// The value after a number of samples, on a straight line of its logarithm; both ends positive.
    pub fn at_logarithmic(&self, samples: f64) -> f32 {
        let way = match self {
            Self::Constant(value) => return *value,
            Self::Moving(way) => way,
        };
        match progress(way.samples, samples) {
            0.0 => way.from,
            1.0 => way.to,
            part => way.from * (way.to / way.from).powf(part),
        }
    }
}

/// How much of the way between two numbers of samples is gone, 0 to 1.
fn progress([begins, arrives]: [f64; 2], samples: f64) -> f32 {
    if samples <= begins {
        0.0
    } else if samples >= arrives {
        1.0
    } else {
        ((samples - begins) / (arrives - begins)) as f32
    }
}

impl<T> From<T> for Ramp<T> {
    fn from(value: T) -> Self {
        Self::Constant(value)
    }
}

impl<T: Default> Default for Ramp<T> {
    fn default() -> Self {
        Self::Constant(T::default())
    }
}

impl<T: JsonSchema> JsonSchema for Ramp<T> {
    fn schema_name() -> Cow<'static, str> {
        format!("Ramp_of_{}", T::schema_name()).into()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        let value = generator.subschema_for::<T>();
        let way = generator.subschema_for::<Way<T>>();
        json_schema!({ "anyOf": [value, way] })
    }
}

// By hand: serde's untagged choice would say of a misspelt key only that nothing fits.
impl<'de, T: Deserialize<'de>> Deserialize<'de> for Ramp<T> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(Either(PhantomData))
    }
}

struct Either<T>(PhantomData<T>);

impl<'de, T: Deserialize<'de>> Visitor<'de> for Either<T> {
    type Value = Ramp<T>;

    fn expecting(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str("a value, or { from = …, to = …, samples = [begin, end] }")
    }

    fn visit_f64<E: Error>(self, value: f64) -> Result<Self::Value, E> {
        T::deserialize(value.into_deserializer()).map(Ramp::Constant)
    }

    fn visit_i64<E: Error>(self, value: i64) -> Result<Self::Value, E> {
        T::deserialize(value.into_deserializer()).map(Ramp::Constant)
    }

    fn visit_u64<E: Error>(self, value: u64) -> Result<Self::Value, E> {
        T::deserialize(value.into_deserializer()).map(Ramp::Constant)
    }

    fn visit_seq<A: SeqAccess<'de>>(self, values: A) -> Result<Self::Value, A::Error> {
        T::deserialize(SeqAccessDeserializer::new(values)).map(Ramp::Constant)
    }

    fn visit_map<A: MapAccess<'de>>(self, keys: A) -> Result<Self::Value, A::Error> {
        Way::deserialize(MapAccessDeserializer::new(keys)).map(Ramp::Moving)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[derive(Debug, PartialEq, Serialize, Deserialize)]
    struct Section {
        kernel: Ramp<f32>,
        forward: Ramp<[f32; 2]>,
    }

    fn read(text: &str) -> Result<Section, String> {
        toml::from_str(text).map_err(|error: toml::de::Error| error.message().to_owned())
    }

    #[test]
    fn a_value_goes_in_a_straight_line_and_stays_where_it_arrives() {
        let kernel = Ramp::moving(2.0, 6.0, [1e6, 3e6]);
        let at = [0.0, 1e6, 1.5e6, 2e6, 3e6, 9e9].map(|samples| kernel.at(samples));
        assert_eq!(at, [2.0, 2.0, 3.0, 4.0, 6.0, 6.0]);
        let range = Ramp::moving([0.4, 1.2], [-0.4, 2.0], [0.0, 2.0]);
        assert_eq!(range.at(1.0), [0.0, 1.6]);
        // Halfway on the logarithmic line: √(0.6·0.2) = 0.3464.
        let sigma = Ramp::moving(0.6_f32, 0.2, [1e6, 3e6]);
        assert!((sigma.at_logarithmic(2e6) - 0.346_41).abs() < 1e-5);
        assert_eq!(
            [0.0, 9e9].map(|samples| sigma.at_logarithmic(samples)),
            [0.6, 0.2]
        );
        // A step: the first value until then, the second after.
        let step = Ramp::moving(1.0_f32, 5.0, [7.0, 7.0]);
        assert_eq!([7.0, 7.5].map(|samples| step.at(samples)), [1.0, 5.0]);
        assert_eq!(
            [7.0, 7.5].map(|samples| step.at_logarithmic(samples)),
            [1.0, 5.0]
        );
    }

    #[test]
    fn one_that_was_set_holds() {
        let mut kernel = Ramp::moving(2.0, 6.0, [1e6, 3e6]);
        assert_eq!((kernel.now(), kernel.moves()), (2.0, true));
        kernel.set(2e6);
        assert_eq!(
            (kernel.now(), kernel.moves(), kernel.at(9e9)),
            (4.0, false, 4.0)
        );
    }

    #[test]
    fn both_spellings_are_read_and_written_back() {
        let text = "kernel = 2.5\nforward = [0.0, 1.0]\n";
        let section = read(text).unwrap();
        assert_eq!(section.kernel, Ramp::Constant(2.5));
        assert_eq!(read(&toml::to_string(&section).unwrap()).unwrap(), section);
        let text = "kernel = { from = 1, to = 2.0, samples = [0, 1e6] }\n\
                    forward = { from = [0.0, 1.0], to = [0, 2], samples = [1e6, 2e6] }";
        let section = read(text).unwrap();
        assert_eq!(section.kernel, Ramp::moving(1.0, 2.0, [0.0, 1e6]));
        assert_eq!(section.forward.at(1.5e6), [0.0, 1.5]);
        assert_eq!(read(&toml::to_string(&section).unwrap()).unwrap(), section);
    }

    #[test]
    fn what_is_neither_is_told_by_its_name() {
        let kernel =
            |value: &str| read(&format!("forward = [0, 1]\nkernel = {value}")).unwrap_err();
        assert!(kernel("\"sharp\"").contains("samples = [begin, end]"));
        assert!(kernel("{ from = 1, two = 2, samples = [0, 1] }").contains("`two`"));
        assert!(kernel("{ from = 1, samples = [0, 1] }").contains("`to`"));
        assert!(kernel("[1.0, 2.0]").contains("expected f32"));
    }

    #[test]
    fn both_ends_are_checked_and_the_order_of_the_samples() {
        let positive = |path: &str, value: f32| {
            let refused = || Invalid::new(path.to_owned(), value, "give more than 0");
            if value > 0.0 { Ok(()) } else { Err(refused()) }
        };
        let path = |ramp: Ramp<f32>| ramp.check("kernel", positive).unwrap_err().path;
        assert_eq!(path(Ramp::Constant(0.0)), "kernel");
        assert_eq!(path(Ramp::moving(-1.0, 1.0, [0.0, 1.0])), "kernel.from");
        assert_eq!(path(Ramp::moving(1.0, -1.0, [0.0, 1.0])), "kernel.to");
        for samples in [
            [2.0, 1.0],
            [-1.0, 1.0],
            [0.0, f64::INFINITY],
            [f64::NAN, 1.0],
        ] {
            assert_eq!(path(Ramp::moving(1.0, 2.0, samples)), "kernel.samples");
        }
        assert_eq!(
            Ramp::moving(1.0, 2.0, [1.0, 1.0]).check("kernel", positive),
            Ok(())
        );
    }
}
