//! The learner's weights, from the gate to the actors here.

use std::fs;
use std::path::PathBuf;
use std::time::Duration;

use anyhow::{Context, Result, bail};
use hosts::{CallError, Newest, Wanted};
use protocol::{Node, WeightsHeader, WeightsOrder, WeightsPublisher};
use tokio::time::sleep;
use tracing::{info, warn};

use super::{Carrier, PAUSE};

/// Longest that an answer may take: the gate holds it back for five seconds, and a slow line needs its time.
const PATIENCE: Duration = Duration::from_secs(60);
/// Name of the file with what was given to the actors last.
pub(crate) const GIVEN: &str = "given";

impl Carrier {
    /// Gives the actors the newest weights, until they are told to stop; the version with which they were, and the end of
    /// the stream, which is to be kept until they have heard it.
    pub(super) async fn poll(&self, node: &Node) -> Result<(u64, WeightsPublisher)> {
        let mut publisher: Option<(usize, WeightsPublisher)> = None;
        let mut has = Vec::new();
        loop {
            let wanted = Wanted {
                life: self.stay.life.clone(),
                has: has.clone(),
                figures: Some(self.counted.told(self.line.figures())),
            };
            let newest: Newest = match self.line.call("Newest", wanted, PATIENCE).await {
                Ok(newest) => newest,
                Err(CallError::Away(why)) => {
                    if self.counted.away(Some(why.clone())) {
                        warn!(why, "the gate is away");
                    }
                    sleep(PAUSE).await;
                    continue;
                }
                Err(CallError::Refused(why)) => bail!("the gate refuses this host: {why}"),
            };
            if self.counted.away(None) {
                warn!("the gate is back");
            }
            if !newest.fresh {
                continue;
            }
            let header = hosts::weights_of(&newest).context("weights that cannot be read")?;
            let flat = hosts::flat_of(&newest.flat).context("weights that cannot be read")?;
            let given = self.prepare(&header).await?;
            // Another shape of networks needs another stream.
            if publisher.as_ref().is_none_or(|(len, _)| *len != flat.len()) {
                drop(publisher.take());
                let opened = WeightsPublisher::new(node, flat.len());
                publisher = Some((flat.len(), opened.context("opening the weights stream")?));
            }
            has = key(&header);
            self.remember(&has);
            if let Some((_, publisher)) = &publisher {
                publisher.forward(given, &flat)?;
            }
            self.counted.weights(header.version);
            if header.order() == Some(WeightsOrder::SaveThenStop) {
                info!(version = header.version, "the run ends");
                let (_, publisher) = publisher.context("weights were given")?;
                return Ok((header.version, publisher));
            }
        }
    }

    /// Does what the order asks of this host, and says what the actors are to be told: who was told to save or restore
    /// for a version, and has gone on since, is not told again, since that would put later robots into the checkpoint.
    async fn prepare(&self, header: &WeightsHeader) -> Result<WeightsHeader> {
        let again = self.given() == key(header);
        match header.order() {
            Some(WeightsOrder::SaveThenCollect | WeightsOrder::SaveThenStop) => {
                self.expect_robots(header.version);
            }
            Some(WeightsOrder::RestoreThenCollect) => {
                self.expect_robots(header.version);
                if !again {
                    self.bring_robots(header.version).await?;
                }
            }
            Some(WeightsOrder::Collect) | None => {}
        }
        let stays = header.order() == Some(WeightsOrder::SaveThenStop);
        let order = if again && !stays {
            WeightsOrder::Collect as u32
        } else {
            header.order
        };
        Ok(WeightsHeader { order, ..*header })
    }

    fn given_path(&self) -> PathBuf {
        self.folder.path().join(GIVEN)
    }

    fn given(&self) -> Vec<u64> {
        let text = fs::read_to_string(self.given_path()).unwrap_or_default();
        text.split_whitespace()
            .filter_map(|word| word.parse().ok())
            .collect()
    }

    /// Written before the actors are told: killed in between, a checkpoint lacks robots and is passed over, which is
    /// better than one that has later ones.
    fn remember(&self, key: &[u64]) {
        let words: Vec<String> = key.iter().map(u64::to_string).collect();
        if let Err(error) = fs::write(self.given_path(), words.join(" ")) {
            warn!(%error, "what was given to actors is not written down");
        }
    }
}

/// What tells weights from others, as the gate does.
fn key(header: &WeightsHeader) -> Vec<u64> {
    vec![header.learner, header.version, u64::from(header.order)]
}
