//! Headers as they are sent: field by field, and checked where they come in.

use prost::bytes::Bytes;
use protocol::{
    MAX_HIDDEN_LAYERS, MAX_NAME, MAX_TERMS, RolloutHeader, SentPrint, TermMean, WeightsHeader,
};

use crate::lean::{put, take};
use crate::messages::{Delivery, Newest};

/// Why a message is none that a host of this version sends.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{what}: {got} where {expected} were expected")]
pub struct SentError {
    /// What is counted.
    pub what: &'static str,
    /// How many were expected, at most.
    pub expected: usize,
    /// How many there are.
    pub got: usize,
}

fn counted(what: &'static str, expected: usize, got: usize) -> Result<(), SentError> {
    if got == expected {
        return Ok(());
    }
    Err(SentError {
        what,
        expected,
        got,
    })
}

/// Seconds of a rollout's header.
const SECONDS: usize = 5;

/// A rollout on its way, of the stay `life`.
pub fn sent_rollout(life: &str, header: &RolloutHeader, rows: Vec<u8>) -> Delivery {
    let terms = header.terms.iter().map(TermMean::parts);
    Delivery {
        life: life.to_owned(),
        actor: header.actor,
        environments: header.environments,
        steps: header.steps,
        incarnation: header.incarnation,
        sequence: header.sequence,
        learner: header.learner,
        policy_version: header.policy_version,
        seconds: vec![
            header.observation_seconds,
            header.physics_seconds,
            header.inference_seconds,
            header.waiting_seconds,
            header.collect_seconds,
        ],
        terms: terms.clone().map(|(name, _)| name.to_vec()).collect(),
        means: terms.map(|(_, mean)| mean).collect(),
        lists: header.lists.numbers().to_vec(),
        rows: Bytes::from(rows),
    }
}

/// The header that was sent.
///
/// # Errors
/// Counts that no header has.
pub fn rollout_of(sent: &Delivery) -> Result<RolloutHeader, SentError> {
    counted("seconds of a rollout", SECONDS, sent.seconds.len())?;
    counted("terms of a rollout", MAX_TERMS, sent.terms.len())?;
    counted("means of terms", MAX_TERMS, sent.means.len())?;
    let mut terms = [TermMean::default(); MAX_TERMS];
    for ((term, name), mean) in terms.iter_mut().zip(&sent.terms).zip(&sent.means) {
        counted("bytes of a term's name", MAX_NAME, name.len())?;
        let name = name.as_slice().try_into().expect("its length was checked");
        *term = TermMean::from_parts(name, *mean);
    }
    Ok(RolloutHeader {
        actor: sent.actor,
        environments: sent.environments,
        steps: sent.steps,
        observation_seconds: sent.seconds[0],
        incarnation: sent.incarnation,
        sequence: sent.sequence,
        learner: sent.learner,
        policy_version: sent.policy_version,
        physics_seconds: sent.seconds[1],
        inference_seconds: sent.seconds[2],
        waiting_seconds: sent.seconds[3],
        collect_seconds: sent.seconds[4],
        terms,
        lists: lists_of(&sent.lists)?,
    })
}

/// Weights on their way; `flat` is what [`sent_flat`] made of the numbers.
pub fn sent_weights(header: &WeightsHeader, flat: Bytes) -> Newest {
    Newest {
        fresh: true,
        learner: header.learner,
        version: header.version,
        samples: header.samples,
        order: header.order,
        hidden: header.hidden().to_vec(),
        environments: header.environments,
        steps: header.steps,
        lockstep: header.is_lockstep(),
        observation_clip: header.observation_clip,
        lists: header.lists.numbers().to_vec(),
        flat,
    }
}

/// The header that was sent.
///
/// # Errors
/// Counts that no header has.
pub fn weights_of(sent: &Newest) -> Result<WeightsHeader, SentError> {
    let layers = sent.hidden.len();
    if layers > MAX_HIDDEN_LAYERS {
        counted("hidden layers", MAX_HIDDEN_LAYERS, layers)?;
    }
    let mut hidden = [0; MAX_HIDDEN_LAYERS];
    hidden[..layers].copy_from_slice(&sent.hidden);
    Ok(WeightsHeader {
        learner: sent.learner,
        version: sent.version,
        samples: sent.samples,
        order: sent.order,
        layers: layers as u32,
        hidden,
        environments: sent.environments,
        steps: sent.steps,
        lockstep: u32::from(sent.lockstep),
        observation_clip: sent.observation_clip,
        lists: lists_of(&sent.lists)?,
    })
}

/// Numbers as they are sent.
pub fn sent_flat(flat: &[f32]) -> Bytes {
    let mut bytes = Vec::new();
    put(&mut bytes, flat);
    Bytes::from(bytes)
}

/// The numbers that were sent.
///
/// # Errors
/// A length that is not one of whole numbers.
pub fn flat_of(bytes: &[u8]) -> Result<Vec<f32>, SentError> {
    let whole = bytes.len() / 4;
    counted("bytes of weights", 4 * whole, bytes.len())?;
    let mut numbers = vec![0.0; whole];
    take(&mut { bytes }, &mut numbers);
    Ok(numbers)
}

fn lists_of(numbers: &[u64]) -> Result<SentPrint, SentError> {
    let expected = SentPrint::default().numbers().len();
    SentPrint::from_numbers(numbers).ok_or(SentError {
        what: "numbers of the lists' print",
        expected,
        got: numbers.len(),
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;
    use prost::Message;
    use protocol::{Lists, RolloutLayout, WeightsOrder};

    fn header() -> RolloutHeader {
        RolloutHeader {
            actor: 3,
            environments: 2,
            steps: 4,
            observation_seconds: 0.1,
            incarnation: u64::MAX - 1,
            sequence: 9,
            learner: 77,
            policy_version: 5,
            physics_seconds: 0.2,
            inference_seconds: 0.3,
            waiting_seconds: 0.4,
            collect_seconds: 0.5,
            terms: TermMean::of([("reward/track", 0.25), ("gate/upright", f32::NAN)]),
            lists: Lists::default().into(),
        }
    }

    #[test]
    fn a_rollouts_header_comes_back_as_it_was() {
        let sent = sent_rollout("life", &header(), vec![1, 2, 3]);
        let bytes = sent.encode_to_vec();
        let back = Delivery::decode(bytes.as_slice()).unwrap();
        let read = rollout_of(&back).unwrap();
        // A NaN is not equal to itself; the words are.
        assert_eq!(format!("{read:?}"), format!("{:?}", header()));
        assert_eq!(back.rows.as_ref(), [1, 2, 3]);
    }

    #[test]
    fn weights_come_back_as_they_were() {
        let layout = RolloutLayout {
            environments: 64,
            steps: 24,
            lists: Lists::default(),
        };
        let order = WeightsOrder::SaveThenCollect;
        let header = WeightsHeader {
            learner: 12,
            ..WeightsHeader::new(9, order, &[256, 128], 2.5, layout, true).after(4_608)
        };
        let flat = [1.0, -0.0, f32::MIN_POSITIVE];
        let sent = sent_weights(&header, sent_flat(&flat));
        let back = Newest::decode(sent.encode_to_vec().as_slice()).unwrap();
        assert_eq!(weights_of(&back), Ok(header));
        let bits = |numbers: &[f32]| numbers.iter().map(|n| n.to_bits()).collect::<Vec<_>>();
        assert_eq!(bits(&flat_of(&back.flat).unwrap()), bits(&flat));
        let said = flat_of(&[0; 7]).unwrap_err().to_string();
        assert_eq!(said, "bytes of weights: 7 where 4 were expected");
    }

    #[test]
    fn counts_that_no_header_has_are_refused() {
        let sound = sent_rollout("life", &header(), Vec::new());
        let spoil: [fn(&mut Delivery); 5] = [
            |sent| sent.seconds.truncate(4),
            |sent| sent.terms.truncate(3),
            |sent| sent.means.push(1.0),
            |sent| sent.terms[2].push(0),
            |sent| sent.lists.truncate(1),
        ];
        for spoil in spoil {
            let mut sent = sound.clone();
            spoil(&mut sent);
            assert!(rollout_of(&sent).is_err());
        }
        let deep = Newest {
            hidden: vec![8; MAX_HIDDEN_LAYERS + 1],
            lists: sound.lists,
            ..Newest::default()
        };
        assert!(weights_of(&deep).is_err());
    }

    proptest! {
        #[test]
        fn no_bytes_make_it_panic(bytes in proptest::collection::vec(any::<u8>(), 0..2000)) {
            if let Ok(sent) = Delivery::decode(bytes.as_slice()) {
                let _ = rollout_of(&sent);
            }
            if let Ok(sent) = Newest::decode(bytes.as_slice()) {
                let _ = (weights_of(&sent), flat_of(&sent.flat));
            }
        }
    }
}
