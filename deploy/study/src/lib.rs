//! The paper's study (III-D to III-F, IV): which runs it takes, what is measured of each, and what may be said of all.
//!
//! Pure: study files, lines of metrics and answers of evaluations come in as data, tables, figures and pages go out as
//! text. `ampco study` reads, runs and writes. Separate from the runs because a comparison is judged by how it was
//! computed, and all of that is here.
//!
//! | subject | file |
//! | --- | --- |
//! | a study file, and the runs that it asks for | [`file`](mod@file), [`matrix`] |
//! | the metrics of III-F over one run | [`metric`], [`measure`] |
//! | what a policy did without exploration noise | [`judged`], [`gait`], [`pareto`] |
//! | what is kept of a run when its lines are gone | [`told`], [`record`] |
//! | what the scheduler cost (II-B) | [`overhead`] |
//! | mean, deviation, coefficient of variation | [`statistics`] |
//! | Wilcoxon's signed-rank test, exact | [`wilcoxon`] |
//! | an interval of the median difference; p-values of several tests | [`bootstrap`], [`holm`] |
//! | the paper's own figures | [`paper`] |
//! | runs together: methods, and methods against each other | [`results`], [`compare`] |
//! | what of the paper the runs support | [`claims`] |
//! | Tables III and IV, Figures 3 and 4, one page, CSV | [`report`] |
//! | how long a study still takes | [`outlook`] |
#![forbid(unsafe_code)]

pub mod bootstrap;
pub mod claims;
pub mod compare;
pub mod file;
pub mod gait;
pub mod holm;
pub mod judged;
pub mod matrix;
pub mod measure;
pub mod metric;
pub mod outlook;
pub mod overhead;
pub mod paper;
pub mod pareto;
pub mod record;
pub mod report;
pub mod results;
pub mod statistics;
pub mod told;
pub mod wilcoxon;

pub use file::{Budget, Evaluation, FileError, StudyFile};
pub use judged::{Judged, Judgement};
pub use matrix::{Cell, Entry};
pub use measure::{Figures, Line, Measured};
pub use metric::Metric;
pub use overhead::{Benchmark, Overhead};
pub use record::Record;
pub use results::{Results, Run, State};
pub use told::Told;
