//! A short measurement of messages, whole.

use super::*;

#[test]
fn percentiles_of_a_hundred_times() {
    let times: Vec<Duration> = (1..=100).map(Duration::from_micros).collect();
    assert_eq!(micros(percentile(&times, 0.50)), 51.0); // half are below it
    assert_eq!(micros(percentile(&times, 0.99)), 100.0);
}

#[test]
fn a_short_run_measures_something_of_everything_and_leaves_nothing() {
    let bench = IpcBench {
        wakes: 20,
        messages: 20,
        adoptions: 5,
    };
    let figures = bench.run().unwrap();
    for key in [
        "wake_p50_us",
        "wake_p99_us",
        "gigabytes_per_second",
        "adoption_ms",
    ] {
        assert!(figures[key].as_f64().unwrap() > 0.0, "{key} in {figures}");
    }
    let folder = std::env::temp_dir().join(format!("ampco-bench-{}", std::process::id()));
    assert!(!folder.exists());
}
