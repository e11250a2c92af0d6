//! Failures and the exit status that scripts see: 2 for what was typed, 1 for all else.

use std::process::ExitCode;

use run::{ConfigError, FolderError};

/// Something that the user can mend by typing something else.
#[derive(Debug)]
pub struct Usage(String);

impl std::fmt::Display for Usage {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(&self.0)
    }
}

impl std::error::Error for Usage {}

/// A [`Usage`] failure as an `anyhow` error.
pub fn usage(words: impl Into<String>) -> anyhow::Error {
    Usage(words.into()).into()
}

/// 2 when the arguments or the configuration are wrong, else 1.
pub fn exit_code(error: &anyhow::Error) -> ExitCode {
    if is_usage(error) {
        ExitCode::from(2)
    } else {
        ExitCode::FAILURE
    }
}

fn is_usage(error: &anyhow::Error) -> bool {
    error.chain().any(|cause| {
        cause.is::<Usage>()
            || matches!(
                cause.downcast_ref(),
                Some(FolderError::Name(_) | FolderError::Missing { .. })
            )
            // A full disk is not the user's spelling.
            || cause
                .downcast_ref::<ConfigError>()
                .is_some_and(|error| !matches!(error, ConfigError::Write { .. }))
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use anyhow::Context;
    use std::path::Path;

    #[test]
    fn what_was_typed_is_told_from_what_failed() {
        assert!(is_usage(&usage("no")));
        let misspelt = run::Config::parse("x = ", "a file").context("reading");
        assert!(is_usage(&misspelt.unwrap_err()));
        let missing = run::Folder::find(Path::new("/nonexistent"), "walk").context("looking");
        assert!(is_usage(&missing.unwrap_err()));
        assert!(!is_usage(&anyhow::anyhow!("the learner died")));
    }
}
