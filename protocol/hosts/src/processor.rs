//! What a processor can do, as far as numbers depend on it.
//!
//! Programs are built for the machine that builds them, and libraries choose by what they find: the same bits come only
//! of equal sets. Whoever joins with another set is told so; it learns all the same.

/// The features of this processor that this program is built for (`+`) or may find at run time, in a fixed order.
pub fn features() -> Vec<String> {
    let mut found = Vec::new();
    macro_rules! look {
        ($($name:tt),*) => {
            $(
                if cfg!(target_feature = $name) {
                    found.push(concat!("+", $name).to_owned());
                }
                #[cfg(target_arch = "x86_64")]
                if std::arch::is_x86_feature_detected!($name) {
                    found.push($name.to_owned());
                }
            )*
        };
    }
    look!(
        "sse4.2",
        "avx",
        "avx2",
        "fma",
        "f16c",
        "bmi2",
        "avx512f",
        "avx512bw",
        "avx512cd",
        "avx512dq",
        "avx512vl",
        "avx512vnni",
        "avx512bf16",
        "avx512fp16"
    );
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_a_program_is_built_for_is_there() {
        let found = features();
        let built = found.iter().filter_map(|name| name.strip_prefix('+'));
        if cfg!(target_arch = "x86_64") {
            for name in built {
                assert!(found.iter().any(|other| other == name), "{name}");
            }
        }
        assert_eq!(found, features());
    }
}
