//! Logs: events with fields, to `logs/<process>.log`, and warnings to the console.
//!
//! Separate because every program sets it up the same way. `AMPCO_LOG` (as in `debug` or
//! `info,learner=trace`) changes what the file holds.

use std::fs::{File, OpenOptions};
use std::io::{self, IsTerminal};
use std::path::Path;
use std::sync::Mutex;

use tracing::level_filters::LevelFilter;
use tracing_subscriber::layer::SubscriberExt;
use tracing_subscriber::registry::LookupSpan;
use tracing_subscriber::util::SubscriberInitExt;
use tracing_subscriber::{EnvFilter, Layer, fmt};

/// The environment variable with the filter of the log file.
pub const FILTER: &str = "AMPCO_LOG";

/// Sets the process's log up: all from `info` on to `<logs>/<process>.log`, appended; warnings to
/// standard error, without times, as one who watches reads them. A panic is an event too.
///
/// # Errors
/// When the file cannot be opened, the filter is not one, or a log was set up before.
pub fn init(logs: &Path, process: &str) -> io::Result<()> {
    let file = open(logs, process)?;
    let directives = std::env::var(FILTER).unwrap_or_else(|_| "info".to_owned());
    let filter = EnvFilter::try_new(&directives)
        .map_err(|error| io::Error::other(format!("{FILTER}={directives}: {error}")))?;
    let to_file = fmt::layer()
        .with_ansi(false)
        .with_target(false)
        .with_writer(Mutex::new(file))
        // A full disk would be told on standard error, once for every event.
        .log_internal_errors(false)
        .with_filter(filter);
    tracing_subscriber::registry()
        .with(to_file)
        .with(to_console())
        .try_init()
        .map_err(io::Error::other)?;
    // The event goes to the console as well, so the usual message would say it twice.
    std::panic::set_hook(Box::new(|panic| {
        let place = panic
            .location()
            .map(ToString::to_string)
            .unwrap_or_default();
        let words = panic.payload_as_str().unwrap_or("no message");
        tracing::error!(place, "panic: {words}");
    }));
    Ok(())
}

/// Warnings to standard error and nothing else: for a command that has no run of its own.
///
/// # Errors
/// When a log was set up before.
pub fn init_console() -> io::Result<()> {
    let registry = tracing_subscriber::registry().with(to_console());
    registry.try_init().map_err(io::Error::other)
}

fn to_console<S>() -> impl Layer<S>
where
    S: tracing::Subscriber + for<'a> LookupSpan<'a>,
{
    fmt::layer()
        .with_ansi(io::stderr().is_terminal())
        .without_time()
        .with_target(false)
        .with_writer(io::stderr)
        .with_filter(LevelFilter::WARN)
}

fn open(logs: &Path, process: &str) -> io::Result<File> {
    std::fs::create_dir_all(logs)?;
    let path = logs.join(format!("{process}.log"));
    let opened = OpenOptions::new().append(true).create(true).open(&path);
    opened.map_err(|error| io::Error::new(error.kind(), format!("{}: {error}", path.display())))
}
