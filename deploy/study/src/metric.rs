//! The three metrics of III-F, and which way is better.

/// What a method is judged by.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Metric {
    /// Root of the mean squared planar velocity error, m/s.
    Rmse,
    /// Positive mechanical work of one robot in 1,000 control steps, J: E = Σₜ Σᵢ max(0, τ·q̇)·dt.
    Energy,
    /// Mean style reward rˢ of the run's own discriminator, in \[0, 1\].
    Style,
}

impl Metric {
    /// In the order of the paper's tables.
    pub const ALL: [Self; 3] = [Self::Rmse, Self::Energy, Self::Style];

    /// Its name in files.
    pub fn key(self) -> &'static str {
        match self {
            Self::Rmse => "rmse",
            Self::Energy => "energy_j",
            Self::Style => "style",
        }
    }

    /// Its heading in the paper's tables.
    pub fn heading(self) -> &'static str {
        match self {
            Self::Rmse => "RMSE Velocity Tracking (m/s)",
            Self::Energy => "Energy Consumption (J)",
            Self::Style => "Discriminator Reward",
        }
    }

    /// Its name within a sentence.
    pub fn words(self) -> &'static str {
        match self {
            Self::Rmse => "velocity error",
            Self::Energy => "energy",
            Self::Style => "discriminator reward",
        }
    }

    /// Whether `a` is better than `b`.
    pub fn better(self, a: f64, b: f64) -> bool {
        match self {
            Self::Rmse | Self::Energy => a < b,
            Self::Style => a > b,
        }
    }

    /// A value with the digits of the paper's tables, and thousands as it writes them.
    pub fn written(self, value: f64) -> String {
        match self {
            _ if !value.is_finite() => "–".to_owned(),
            Self::Energy if value.abs() >= 1000.0 => format!("{:.2}k", value / 1000.0),
            Self::Energy => format!("{value:.0}"),
            Self::Rmse | Self::Style => format!("{value:.3}"),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn less_error_and_energy_and_more_style_are_better() {
        assert!(Metric::Rmse.better(0.1, 0.2) && Metric::Energy.better(1.0, 2.0));
        assert!(Metric::Style.better(0.2, 0.1) && !Metric::Style.better(0.1, 0.1));
    }

    #[test]
    fn values_are_written_as_the_paper_does() {
        assert_eq!(Metric::Rmse.written(0.2884), "0.288");
        assert_eq!(Metric::Energy.written(11_300.0), "11.30k");
        assert_eq!(Metric::Energy.written(812.4), "812");
        assert_eq!(Metric::Style.written(f64::NAN), "–");
    }
}
