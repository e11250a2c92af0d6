//! What serde's complaints say: names between backticks, and a path that may end in the misspelt one.

/// The names between backticks: serde lists an unknown field and then the known ones.
pub(super) fn quoted_names(message: &str) -> Vec<&str> {
    message.split('`').skip(1).step_by(2).collect()
}

/// The path reported for an unknown field may or may not end in the field itself.
pub(super) fn misspelt_path(path: &str, field: &str) -> String {
    if path.is_empty() || path == field {
        field.to_owned()
    } else if path.ends_with(&format!(".{field}")) {
        path.to_owned()
    } else {
        format!("{}.{field}", path.trim_end_matches(".?"))
    }
}
