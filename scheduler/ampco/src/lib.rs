//! AMPCO's scheduling mathematics (section II of the paper): scalars in, a decision out.
//!
//! Once per iteration the learner reports how its discriminator paid the policy; [`Schedule::observe`] answers with the
//! phase of training and with the [`Rule`] that turns rewards into weights. The crate is pure: no clock, no thread, no
//! file, no random number, and after construction no allocation. The same reports give the same decisions, which is
//! what lets a restarted scheduler rebuild its state from the run's metrics.
//!
//! | equation | item |
//! | --- | --- |
//! | 1, blended reward | [`Weights::blend`] |
//! | 2, weights sum to one | [`Weights`], by construction |
//! | 8, largest reward R* | [`weighting::guidance::Ceiling`] |
//! | 9, Adaptive Imitation Guidance | [`weighting::guidance::task_weight`] |
//! | 9 fed by the task reward (AdaMimic baseline) | [`weighting::adamimic::task_weight`] |
//! | 10, breakout indicator | [`breakout::breaks_out`], with the percentile of [`window::Window::percentile`] |
//! | 11, breakout rate | [`breakout::Indicators::rate`] |
//! | Algorithm 1 | [`breakout::Detector::append`] |
//! | 12, constrained weighting (ROGER) | [`weighting::roger::style_weight`] |
//! | 13, Chebyshev bounds | [`Bounds::around`] and [`bounds::chebyshev_factor`] |
//!
//! Equations 3 to 7 (discriminator losses and style reward) are the learner's, equation 14 (task reward) the simulation's.
//!
//! | symbol | name here | meaning |
//! | --- | --- | --- |
//! | rᴳ | `task_reward` | what the task pays for one transition |
//! | rˢ | `style_reward` | what the discriminator pays for one transition, in \[0, 1\] |
//! | wᴳ, wˢ | `task_weight`, `style_weight` | shares of the two rewards |
//! | R* | `ceiling` | largest reward expected |
//! | r̄ˢ, σˢ | `style_mean`, `style_std` | mean and standard deviation of rˢ over an iteration's batch |
//! | p | `percentile` | a fraction here: 0.95 is the 95th percentile |
//! | 𝓑 | [`window::Window`] | the last W values of r̄ˢ |
//! | P | `boundary` | p-th percentile of 𝓑 before the newest value |
//! | b | `indicator` | whether the newest value exceeds P |
//! | β | `breakout_rate` | share of ones among the last W indicators |
//! | W | `window` | length of both windows, in iterations |
//! | μ, σ (sat) | `mean`, `deviation` | of the reward at convergence |
//! | k, α | [`bounds::chebyshev_factor`], `alpha` | half width of the bounds in standard deviations; share guaranteed inside |
//! | μ upper, μ lower | [`Bounds`] | limits of the style reward in phase II |
//! | t, "episode" of 24 steps | `iteration` | one collection and one update; an *episode* ends with a fall or a time-out |
#![forbid(unsafe_code)]

pub mod arming;
pub mod bounds;
pub mod breakout;
mod config;
mod decision;
mod method;
mod pace;
mod ranks;
mod report;
mod schedule;
pub mod weighting;
mod weights;
pub mod window;

pub use bounds::Bounds;
pub use config::{ArmKind, BoundsSource, PaceKind, ScheduleConfig};
pub use decision::{Decision, Phase, Switch, Warning};
pub use method::{AfterConvergence, Method};
pub use report::{Report, ReportError};
pub use schedule::Schedule;
pub use weighting::guidance::CeilingKind;
pub use weighting::{Granularity, Numbers, Rule, RuleError, Weighting};
pub use weights::Weights;
