//! Policy weights: the learner's newest policy, and what the actors are to do with it.
//!
//! Separate because it is the one message that orders: a rollout is the answer to it. The newest
//! wins, and an actor that comes late still gets it. The flat layout of the numbers belongs to the
//! crates `networks` and `policy`; here they are only carried.

use std::fmt;
use std::time::Duration;

use iceoryx2::prelude::ZeroCopySend;

use crate::error::PortError;
use crate::port::{Publisher, Received, Subscriber, Wake};
use crate::presence::Node;
use crate::rollout::{RolloutLayout, SentPrint};
use crate::stream::{self, Spec, Stream};

/// Most hidden layers that a header can describe.
pub const MAX_HIDDEN_LAYERS: usize = 6;

/// What an actor does on receiving weights.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u32)]
pub enum WeightsOrder {
    /// Collect a rollout.
    Collect = 0,
    /// Save the fleet for checkpoint `version`, then collect.
    SaveThenCollect = 1,
    /// Restore the fleet of checkpoint `version`, then collect.
    RestoreThenCollect = 2,
    /// Save the fleet for checkpoint `version`, then end.
    SaveThenStop = 3,
}

/// Which weights these are, and what to do with them.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, ZeroCopySend)]
#[type_name("ampco.WeightsHeader")]
pub struct WeightsHeader {
    /// Incarnation of the learner; filled by [`WeightsPublisher::broadcast`].
    pub learner: u64,
    /// Version of the weights: iterations done.
    pub version: u64,
    /// Samples that the learner has used, those of all actors of all iterations: the run's one clock, by
    /// which everything that changes over a run is read. Set with [`Self::after`].
    pub samples: u64,
    /// A [`WeightsOrder`] as a number; read it with [`Self::order`].
    pub order: u32,
    /// How many entries of `hidden` count.
    pub layers: u32,
    /// Widths of the hidden layers; read them with [`Self::hidden`].
    pub hidden: [u32; MAX_HIDDEN_LAYERS],
    /// N of the rollouts wanted.
    pub environments: u32,
    /// T of the rollouts wanted.
    pub steps: u32,
    /// 1: collect one rollout and wait for the next version. 0: keep collecting with the newest.
    pub lockstep: u32,
    /// What normalised observations are cut to, ±: the weights mean nothing without it.
    pub observation_clip: f32,
    /// What the rows of the rollouts wanted hold; the weights are as wide as it says.
    pub lists: SentPrint,
}

impl WeightsHeader {
    /// Header of version `version`; the learner's incarnation is filled in when it is sent.
    ///
    /// # Panics
    /// With more than [`MAX_HIDDEN_LAYERS`] hidden layers: a configuration is refused earlier.
    pub fn new(
        version: u64,
        order: WeightsOrder,
        hidden: &[usize],
        observation_clip: f32,
        layout: RolloutLayout,
        lockstep: bool,
    ) -> Self {
        assert!(
            hidden.len() <= MAX_HIDDEN_LAYERS,
            "{} hidden layers, a header holds {MAX_HIDDEN_LAYERS}",
            hidden.len()
        );
        let mut widths = [0; MAX_HIDDEN_LAYERS];
        for (width, &neurons) in widths.iter_mut().zip(hidden) {
            *width = neurons as u32;
        }
        Self {
            learner: 0,
            version,
            samples: 0,
            order: order as u32,
            layers: hidden.len() as u32,
            hidden: widths,
            environments: layout.environments as u32,
            steps: layout.steps as u32,
            lockstep: u32::from(lockstep),
            observation_clip,
            lists: layout.lists.into(),
        }
    }

    /// With the run's clock at `samples`.
    #[must_use]
    pub fn after(self, samples: u64) -> Self {
        Self { samples, ..self }
    }

    /// What to do; `None` for a number that this version does not know.
    pub fn order(&self) -> Option<WeightsOrder> {
        Some(match self.order {
            0 => WeightsOrder::Collect,
            1 => WeightsOrder::SaveThenCollect,
            2 => WeightsOrder::RestoreThenCollect,
            3 => WeightsOrder::SaveThenStop,
            _ => return None,
        })
    }

    /// Widths of the hidden layers, from the input on.
    pub fn hidden(&self) -> &[u32] {
        &self.hidden[..(self.layers as usize).min(MAX_HIDDEN_LAYERS)]
    }

    /// How the rollouts wanted differ from those of a layout, in words; none if they do not.
    pub fn unlike(&self, layout: &RolloutLayout) -> Option<String> {
        let (environments, steps) = (self.environments as usize, self.steps as usize);
        if (environments, steps) != (layout.environments, layout.steps) {
            return Some(format!(
                "{environments} environments by {steps} steps, not {} by {}",
                layout.environments, layout.steps
            ));
        }
        self.lists.difference(&layout.lists)
    }

    /// Whether each version is answered by exactly one rollout.
    pub fn is_lockstep(&self) -> bool {
        self.lockstep != 0
    }
}

/// The stream of weights.
#[derive(Debug)]
pub(crate) enum WeightsStream {}

impl Stream for WeightsStream {
    type Item = f32;
    type Header = WeightsHeader;
    const SPEC: Spec = stream::WEIGHTS;
}

/// The learner's end. There is one per run.
#[derive(Debug)]
pub struct WeightsPublisher {
    port: Publisher<WeightsStream>,
    len: usize,
    learner: u64,
}

impl WeightsPublisher {
    /// Opens the stream for policies of `len` numbers; fails with [`PortError::Taken`] while
    /// another learner lives.
    pub fn new(node: &Node, len: usize) -> Result<Self, PortError> {
        Ok(Self {
            // Overflow is on: a send never waits.
            port: Publisher::open(node, len, Duration::ZERO)?,
            len,
            learner: node.incarnation(),
        })
    }

    /// Copies `flat` into shared memory and wakes every actor. Never waits for a reader; who comes
    /// later gets it on this process's next tick.
    ///
    /// # Errors
    /// As [`Self::forward`].
    pub fn broadcast(&self, header: WeightsHeader, flat: &[f32]) -> Result<(), PortError> {
        let learner = self.learner;
        self.forward(WeightsHeader { learner, ..header }, flat)
    }

    /// As [`Self::broadcast`], of the learner that the header names: for one who carries weights from elsewhere.
    ///
    /// # Errors
    /// [`PortError::Length`] where `flat` does not have as many numbers as this end was opened for.
    pub fn forward(&self, header: WeightsHeader, flat: &[f32]) -> Result<(), PortError> {
        if flat.len() != self.len {
            return Err(PortError::Length {
                stream: WeightsStream::SPEC.name,
                expected: self.len,
                got: flat.len(),
            });
        }
        let mut loan = self.port.loan(self.len)?;
        *loan.user_header_mut() = header;
        loan.payload_mut().copy_from_slice(flat);
        // No reader is no loss: the history keeps the newest.
        self.port.send(loan)?;
        Ok(())
    }
}

/// An actor's end, or a monitor's.
#[derive(Debug)]
pub struct WeightsSubscriber {
    port: Subscriber<WeightsStream>,
}

impl WeightsSubscriber {
    /// Opens the stream.
    pub fn new(node: &Node) -> Result<Self, PortError> {
        let port = Subscriber::open(node)?;
        Ok(Self { port })
    }

    /// The newest weights, if some came since the last call. Copies nothing: load them into the
    /// policy and drop the guard.
    pub fn newest(&self) -> Result<Option<Weights>, PortError> {
        Ok(self.port.newest()?.map(|sample| Weights { sample }))
    }

    /// Sleeps until weights were sent, `timeout` is over, or this process should stop; ticks.
    pub fn wait(&self, timeout: Duration) -> Result<Wake, PortError> {
        self.port.wait(timeout)
    }
}

/// Weights being read in shared memory.
pub struct Weights {
    sample: Received<WeightsStream>,
}

impl fmt::Debug for Weights {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter
            .debug_struct("Weights")
            .field("header", self.header())
            .finish_non_exhaustive()
    }
}

impl Weights {
    /// Which weights these are, and what to do.
    pub fn header(&self) -> &WeightsHeader {
        self.sample.user_header()
    }

    /// The numbers, in the flat layout of the policy.
    pub fn flat(&self) -> &[f32] {
        self.sample.payload()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rollout::Lists;

    fn layout() -> RolloutLayout {
        RolloutLayout {
            environments: 64,
            steps: 24,
            lists: Lists::default(),
        }
    }

    #[test]
    fn a_header_says_back_what_it_was_made_of() {
        let order = WeightsOrder::RestoreThenCollect;
        let header =
            WeightsHeader::new(9, order, &[256, 128, 64], 2.5, layout(), true).after(4_608);
        assert_eq!(header.order(), Some(order));
        assert_eq!((header.version, header.samples), (9, 4_608));
        assert_eq!(header.hidden(), [256, 128, 64]);
        assert_eq!(header.observation_clip, 2.5);
        assert_eq!(header.unlike(&layout()), None);
        let larger = RolloutLayout {
            environments: 65,
            ..layout()
        };
        let said = header.unlike(&larger).unwrap();
        assert_eq!(said, "64 environments by 24 steps, not 65 by 24");
        let config: observation::ObservationConfig = Default::default();
        let blind = observation::ObservationConfig {
            critic: observation::SeenList {
                terms: vec!["height".to_owned()],
                ..config.critic
            },
            ..config
        };
        let other = RolloutLayout {
            lists: (&blind.tables().unwrap()).into(),
            ..layout()
        };
        let said = header.unlike(&other).unwrap();
        assert!(said.contains("observation.critic lacks height"), "{said}");
        assert!(header.is_lockstep());
    }

    #[test]
    fn an_unknown_order_is_no_order() {
        let header = WeightsHeader {
            order: 4,
            ..WeightsHeader::default()
        };
        assert_eq!(header.order(), None);
    }
}
