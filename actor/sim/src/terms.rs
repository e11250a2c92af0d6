//! What a table of terms is: names in the configuration, each with its parameters and its own file.
//!
//! Separate because rewards and gates are listed, set, checked and told alike; what a term measures is its file's alone,
//! and what the terms of a table make together is the table's.

use crate::moment::Moment;
use vocabulary::{Checked, Ramp};

/// A named number of the task, in [0, 1] at every step of every robot.
pub(crate) trait Term {
    /// How much it counts; one that weighs nothing is not looked at.
    fn weight(&self) -> &Ramp<f32>;
    /// Its value after a step.
    fn value(&self, moment: &Moment<'_>) -> f32;
    /// Its value to the power of a weight, as a gate counts it.
    fn raised(&self, moment: &Moment<'_>, weight: f32) -> f32 {
        let value = self.value(moment);
        if weight == 1.0 {
            value
        } else {
            value.powf(weight)
        }
    }
    /// Holds all that moves where it is after a number of samples.
    fn set(&mut self, samples: f64);
    /// Checks every parameter.
    fn validate(&self) -> Checked;
}

/// Most terms of all tables together: as many as the message of a rollout tells.
pub(crate) const MOST: usize = 16;

/// Sums of what the terms came to over the steps since they were last asked for.
#[derive(Clone, Debug, Default)]
pub(crate) struct Sums {
    /// Steps and sum of every term, in the order of the tables.
    of: [(u32, f64); MOST],
}

impl Sums {
    /// Takes one more value in.
    pub(crate) fn add(&mut self, place: usize, value: f32) {
        let (steps, sum) = &mut self.of[place];
        *steps += 1;
        *sum += f64::from(value);
    }

    /// The mean of every term that was looked at, by the names of all of them, and begins anew.
    pub(crate) fn take(&mut self, names: &[&'static str]) -> Vec<(&'static str, f32)> {
        let sums = std::mem::take(self).of;
        let told = names.iter().zip(sums).filter(|(_, (steps, _))| *steps > 0);
        told.map(|(name, (steps, sum))| (*name, (sum / f64::from(steps)) as f32))
            .collect()
    }
}

/// Declares a table: one line per term, its name in the configuration and its type.
macro_rules! table {
    (
        $(#[$table_doc:meta])* $table:ident, $group:literal, from $first:expr;
        $( $(#[$doc:meta])* $name:ident: $term:ty = $default:expr; )*
    ) => {
        $(#[$table_doc])*
        #[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize, schemars::JsonSchema)]
        #[serde(deny_unknown_fields, default)]
        #[schemars(extend("terms" = true))]
        pub struct $table {
            $( $(#[$doc])* #[serde(skip_serializing_if = "Option::is_none")] pub $name: Option<$term>, )*
        }

        impl Default for $table {
            fn default() -> Self {
                Self { $( $name: $default, )* }
            }
        }

        /// Names of the terms in metrics, in the table's order.
        pub(crate) const NAMES: [&str; [$( stringify!($name) ),*].len()] =
            [$( concat!($group, "/", stringify!($name)) ),*];

        impl $table {
            /// Name and weight of the terms that are listed.
            fn weights(&self) -> impl Iterator<Item = (&'static str, &vocabulary::Ramp<f32>)> {
                let listed = [$(
                    self.$name.as_ref().map(|term| (stringify!($name), crate::terms::Term::weight(term))),
                )*];
                listed.into_iter().flatten()
            }

            /// Checks every term; names the first bad parameter.
            pub(crate) fn validate(&self) -> vocabulary::Checked {
                for (name, weight) in self.weights() {
                    let usual = |path: &str, value| {
                        vocabulary::invalid::between(path, value, [0.0, 1e6], "terms are weighed against each other")
                    };
                    vocabulary::invalid::within(name, weight.check("weight", usual))?;
                }
                $( if let Some(term) = &self.$name {
                    let checked = crate::terms::Term::validate(term);
                    vocabulary::invalid::within(stringify!($name), checked)?;
                } )*
                Ok(())
            }

            /// Holds all that moves where it is after a number of samples.
            pub(crate) fn set(&mut self, samples: f64) {
                $( if let Some(term) = &mut self.$name { crate::terms::Term::set(term, samples); } )*
            }

            /// Calls `take` with place among the terms of all tables, weight and term of each that weighs something.
            #[inline]
            fn each(&self, mut take: impl FnMut(usize, f32, &dyn crate::terms::Term)) {
                let mut place = $first;
                $( if let Some(term) = &self.$name {
                    let weight = crate::terms::Term::weight(term).now();
                    if weight != 0.0 {
                        take(place, weight, term);
                    }
                }
                place += 1; )*
                let _all = place;
            }
        }
    };
}

pub(crate) use table;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn means_are_of_the_steps_since_they_were_asked_for() {
        let mut sums = Sums::default();
        for value in [0.25, 0.75] {
            sums.add(0, value);
        }
        sums.add(2, 1.0);
        let names = ["first", "second", "third"];
        assert_eq!(sums.take(&names), [("first", 0.5), ("third", 1.0)]);
        assert_eq!(sums.take(&names), []);
    }
}
