//! The `[observation]` section: a list of terms for the policy, one for the critic, one for the discriminator.
//!
//! ```toml
//! [observation.actor]
//! terms = ["angular_velocity", "gravity", "command", "joint_position", "joint_velocity", "previous_action"]
//! past = 4                                  # frames before the present one, of every term
//! [observation.actor.term.joint_velocity]   # what is otherwise of one term
//! scale = 0.05
//! clip = 30.0
//! [observation.critic]
//! terms = ["actor", "linear_velocity", "height", "friction", "foot_forces"]
//! ```

use crate::table::{Entry, Table};
use crate::tables::{Critic, Tables};
use crate::term::Term;
use crate::terms::{self, ACTOR, PAPER_ACTOR, PAPER_DISCRIMINATOR, TERMS};
use schemars::JsonSchema;
use serde::{Deserialize, Deserializer, Serialize};
use std::collections::BTreeMap;
use vocabulary::invalid::{positive, require};
use vocabulary::{Checked, Invalid, Section, invalid};
use wording::nearest;

/// Most past frames of a term: two thirds of a second.
const MOST_PAST: usize = 32;

const TWICE: &str = "it is in the list already: name it once";
const UNLISTED: &str = "name it in terms, or leave its table out";

/// The `[observation]` section. The defaults are the paper's lists (Section III-A).
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
#[schemars(extend("terms" = true))]
pub struct ObservationConfig {
    /// What the policy sees, with the noise of Table I.
    pub actor: SeenList,
    /// What the critic sees: `"actor"`, first if at all, is all that the policy sees and as it sees it; every other term
    /// is the truth. Default `["actor"]`.
    pub critic: SeenList,
    /// What the discriminator sees of every state. `discriminator.frames` says of how many.
    pub discriminator: JudgedList,
}

/// Terms that policy or critic see, in order.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
pub struct SeenList {
    /// Names of its terms.
    pub terms: Vec<String>,
    /// Frames before the present one that are seen of every term. Default 0. At an episode's start the first frame
    /// stands for those before it.
    pub past: usize,
    /// What is otherwise of single terms, by name.
    #[serde(skip_serializing_if = "BTreeMap::is_empty")]
    pub term: BTreeMap<String, SeenTerm>,
}

/// How one term is seen: noise is added, then it is cut to its clip, then multiplied by its scale.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct SeenTerm {
    /// What a quantity in its unit is multiplied by. Default 1.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub scale: Option<f32>,
    /// Uniform noise, ± this, in its unit; widens what Table I says of it. Default 0.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub noise: Option<f32>,
    /// It is cut to ± this, in its unit. Default: it is not.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub clip: Option<f32>,
    /// Frames before the present one. Default: those of the list.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub past: Option<usize>,
}

/// Terms that the discriminator sees, in order: such as reference motion has too.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
pub struct JudgedList {
    /// Names of its terms.
    pub terms: Vec<String>,
    /// What is otherwise of single terms, by name.
    #[serde(skip_serializing_if = "BTreeMap::is_empty")]
    pub term: BTreeMap<String, JudgedTerm>,
}

/// How the discriminator sees one term. Noise would be the clue by which it knows the simulation.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct JudgedTerm {
    /// What a quantity in its unit is multiplied by. Default 1.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub scale: Option<f32>,
    /// It is cut to ± this, in its unit, before that. Default: it is not.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub clip: Option<f32>,
}

impl From<JudgedTerm> for SeenTerm {
    fn from(JudgedTerm { scale, clip }: JudgedTerm) -> Self {
        Self {
            scale,
            clip,
            ..Self::default()
        }
    }
}

/// The section as it is written: each list has defaults of its own.
#[derive(Default, Deserialize)]
#[serde(deny_unknown_fields, default)]
struct Given {
    actor: GivenSeen,
    critic: GivenSeen,
    discriminator: GivenJudged,
}

#[derive(Default, Deserialize)]
#[serde(deny_unknown_fields, default)]
struct GivenSeen {
    terms: Option<Vec<String>>,
    past: usize,
    term: BTreeMap<String, SeenTerm>,
}

#[derive(Default, Deserialize)]
#[serde(deny_unknown_fields, default)]
struct GivenJudged {
    terms: Option<Vec<String>>,
    term: BTreeMap<String, JudgedTerm>,
}

impl<'de> Deserialize<'de> for ObservationConfig {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        Given::deserialize(deserializer).map(Into::into)
    }
}

impl From<Given> for ObservationConfig {
    fn from(given: Given) -> Self {
        let seen = |list: GivenSeen, default: &[&str]| SeenList {
            terms: list.terms.unwrap_or_else(|| owned(default)),
            past: list.past,
            term: list.term,
        };
        Self {
            actor: seen(given.actor, &PAPER_ACTOR),
            critic: seen(given.critic, &[ACTOR]),
            discriminator: JudgedList {
                terms: given
                    .discriminator
                    .terms
                    .unwrap_or_else(|| owned(&PAPER_DISCRIMINATOR)),
                term: given.discriminator.term,
            },
        }
    }
}

impl Default for ObservationConfig {
    fn default() -> Self {
        Given::default().into()
    }
}

fn owned(names: &[&str]) -> Vec<String> {
    names.iter().map(|name| (*name).to_owned()).collect()
}

impl Section for ObservationConfig {
    const NAME: &'static str = "observation";

    fn validate(&self) -> Checked {
        self.tables().map(|_| ())
    }
}

impl ObservationConfig {
    /// The lists made ready.
    ///
    /// # Errors
    /// The first value that cannot be used.
    pub fn tables(&self) -> Result<Tables, Invalid> {
        let actor = at("actor", table(&self.actor, 0, &known(|_| true), |_| None))?;
        let critic = at("critic", self.critic())?;
        let judged = SeenList {
            terms: self.discriminator.terms.clone(),
            past: 0,
            term: self
                .discriminator
                .term
                .iter()
                .map(|(name, term)| (name.clone(), (*term).into()))
                .collect(),
        };
        let discriminator = at(
            "discriminator",
            table(&judged, 0, &known(Term::is_of_motion), |term| {
                let lack = "reference motion has no such thing";
                (!term.is_of_motion()).then_some(lack)
            }),
        )?;
        Ok(Tables::new(actor, critic, discriminator))
    }

    /// The critic's list, unless it is the actor's.
    fn critic(&self) -> Result<Option<Critic>, Invalid> {
        let list = &self.critic;
        let place = list.terms.iter().position(|name| name == ACTOR);
        require(
            place.is_none_or(|place| place == 0),
            "terms",
            &list.terms,
            "put \"actor\" first, or leave it out",
        )?;
        let sees_actor = place.is_some();
        if let Some(again) = list.terms.iter().skip(1).position(|name| name == ACTOR) {
            let path = format!("terms[{}]", again + 1);
            return Err(Invalid::new(path, ACTOR, TWICE));
        }
        let own = SeenList {
            terms: list.terms[usize::from(sees_actor)..].to_vec(),
            ..list.clone()
        };
        if sees_actor && own.terms.is_empty() {
            if let Some(name) = own.term.keys().next() {
                return Err(Invalid::new(format!("term.{name}"), name, UNLISTED));
            }
            require(
                own.past == 0,
                "past",
                own.past,
                "it is of terms of the critic's own, of which there are none: give [observation.actor] past frames, or \
                 list terms beside \"actor\"",
            )?;
            return Ok(None);
        }
        let mut names = known(|_| true);
        names.insert(0, ACTOR);
        let own = table(&own, usize::from(sees_actor), &names, |_| None)?;
        Ok(Some(Critic { sees_actor, own }))
    }
}

/// One list made ready, whose first term is that many in the list as it is written; `names` are those that it may hold,
/// and `refuse` says what is wrong with a term, if something is.
fn table(
    list: &SeenList,
    first: usize,
    names: &[&str],
    refuse: impl Fn(&Term) -> Option<&'static str>,
) -> Result<Table, Invalid> {
    require(
        !list.terms.is_empty(),
        "terms",
        &list.terms,
        "name at least one term",
    )?;
    past("past", list.past)?;
    let mut entries: Vec<Entry> = Vec::with_capacity(list.terms.len());
    for (i, name) in list.terms.iter().enumerate() {
        let path = format!("terms[{}]", first + i);
        let bad = |remedy: String| Invalid::new(path.clone(), name, remedy);
        let term = terms::named(name).ok_or_else(|| bad(nearest::remedy(name, names)))?;
        if let Some(lack) = refuse(term) {
            return Err(bad(format!("{lack}; known: {}", nearest::names(names))));
        }
        if entries.iter().any(|other| other.term.name == term.name) {
            return Err(bad(TWICE.to_owned()));
        }
        let given = list.term.get(name).copied().unwrap_or_default();
        at(&format!("term.{name}"), check(&given))?;
        entries.push(Entry {
            term,
            scale: given.scale.unwrap_or(1.0),
            noise: given.noise.unwrap_or(0.0),
            clip: given.clip,
            past: given.past.unwrap_or(list.past),
        });
    }
    for name in list.term.keys() {
        let listed: Vec<&str> = list.terms.iter().map(String::as_str).collect();
        let remedy = match nearest::remedy(name, &listed) {
            known if known.starts_with("known") => UNLISTED.to_owned(),
            close => format!("{close} Else {UNLISTED}"),
        };
        require(
            listed.contains(&name.as_str()),
            &format!("term.{name}"),
            name,
            remedy,
        )?;
    }
    Ok(Table::of(entries))
}

fn check(term: &SeenTerm) -> Checked {
    positive("scale", term.scale.unwrap_or(1.0))?;
    invalid::at_least("noise", term.noise.unwrap_or(0.0), 0.0)?;
    positive("clip", term.clip.unwrap_or(1.0))?;
    past("past", term.past.unwrap_or(0))
}

fn past(path: &str, past: usize) -> Checked {
    let remedy = format!("use 0 to {MOST_PAST} frames");
    require(past <= MOST_PAST, path, past, remedy)
}

/// Names of all terms that are fit for a list.
fn known(fit: impl Fn(&Term) -> bool) -> Vec<&'static str> {
    let terms = TERMS.iter().filter(|term| fit(term));
    terms.map(|term| term.name).collect()
}

/// A result inside a table of the section.
fn at<T>(table: &str, result: Result<T, Invalid>) -> Result<T, Invalid> {
    result.map_err(|invalid| invalid.inside(table))
}

#[cfg(test)]
mod tests;
