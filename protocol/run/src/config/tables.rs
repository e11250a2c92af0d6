//! Tables of TOML as trees: their leaves by path, and one laid over another.

use std::collections::BTreeMap;

use toml::{Table, Value};

/// Marks every leaf of a table with its origin.
pub(super) fn mark(
    table: &Table,
    prefix: &str,
    origin: &str,
    origins: &mut BTreeMap<String, String>,
) {
    let mut leaves = BTreeMap::new();
    collect(table, prefix, &mut leaves);
    origins.extend(leaves.into_keys().map(|path| (path, origin.to_owned())));
}

/// Every leaf of a table by its dotted path.
pub(super) fn collect(table: &Table, prefix: &str, leaves: &mut BTreeMap<String, Value>) {
    for (name, value) in table {
        let path = format!("{prefix}{name}");
        match value {
            Value::Table(inner) if !inner.is_empty() => collect(inner, &format!("{path}."), leaves),
            _ => {
                leaves.insert(path, value.clone());
            }
        }
    }
}

/// Lays `over` on top of `base`, table by table.
pub(super) fn merge_tables(base: &mut Table, over: Table) {
    for (name, value) in over {
        match (base.get_mut(&name), value) {
            (Some(Value::Table(inner)), Value::Table(value)) => merge_tables(inner, value),
            (_, value) => {
                base.insert(name, value);
            }
        }
    }
}
