//! The section read, written and refused.

use super::*;

fn parse(text: &str) -> Result<ScheduleConfig, toml::de::Error> {
    toml::from_str(text)
}

#[test]
fn an_empty_section_is_the_paper() {
    let config = parse("").unwrap();
    assert_eq!(config, ScheduleConfig::default());
    assert_eq!(config.validate(), Ok(()));
}

#[test]
fn methods_are_written_as_presets_write_them() {
    let method = |text: &str| parse(text).unwrap().method;
    assert_eq!(
        method("method = { amp = { style_weight = 0.7 } }"),
        Method::Amp { style_weight: 0.7 }
    );
    assert_eq!(method("method = 'adamimic'"), Method::AdaMimic);
    assert_eq!(
        method("method = { amp_roger = { lower = 0.2, upper = 0.4 } }"),
        Method::AmpRoger {
            lower: 0.2,
            upper: 0.4
        }
    );
    assert_eq!(
        method("method = 'ampco_without_aig'"),
        Method::AmpcoWithoutAig
    );
    assert_eq!(
        method("method = 'ampco_without_roger'"),
        Method::AmpcoWithoutRoger
    );
}

#[test]
fn knobs_are_written_in_words_and_unknown_ones_are_refused() {
    let config = parse(
        "arm = 'after_rise'\nceiling = 'running_max'\nbounds_from = 'window'\ngranularity = 'mean'",
    )
    .unwrap();
    assert_eq!(config.arm, ArmKind::AfterRise);
    assert_eq!(config.ceiling, CeilingKind::RunningMax);
    assert_eq!(config.bounds_from, BoundsSource::Window);
    assert_eq!(config.granularity, Granularity::Mean);
    assert!(parse("windw = 5").is_err());
    assert!(parse("method = { amp = { style_weight = 0.7, colour = 1 } }").is_err());
}

#[test]
fn a_configuration_survives_being_written() {
    let config = ScheduleConfig {
        method: Method::AmpRoger {
            lower: 0.25,
            upper: 0.5,
        },
        ..Default::default()
    };
    assert_eq!(parse(&toml::to_string(&config).unwrap()).unwrap(), config);
}

#[test]
fn bad_values_are_named_with_a_remedy() {
    let refused = |text: &str| parse(text).unwrap().validate().unwrap_err();
    for (text, field) in [
        ("window = 1", "window"),
        ("percentile = 95.0", "percentile"),
        ("percentile = nan", "percentile"),
        ("alpha = 1.0", "alpha"),
        ("smoothing = 0.0", "smoothing"),
        (
            "method = { amp = { style_weight = 1.2 } }",
            "method.amp.style_weight",
        ),
        (
            "method = { amp_roger = { lower = 0.4, upper = 0.4 } }",
            "method.amp_roger.upper",
        ),
        (
            "method = { amp_roger = { lower = nan, upper = 0.4 } }",
            "method.amp_roger.lower",
        ),
    ] {
        assert_eq!(refused(text).path, field, "{text}");
    }
    assert_eq!(
        refused("percentile = 95.0").to_string(),
        "percentile = 95.0 is not usable: write it as a fraction between 0 and 1; the paper's 95th percentile is 0.95"
    );
}
