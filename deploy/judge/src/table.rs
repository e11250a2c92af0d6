//! The columns of an evaluation: one list, for the terminal and for Markdown.

use super::report::Row;
use vocabulary::Cause;

/// A column: its heading, its unit, and how a row fills it.
pub(super) struct Column {
    pub(super) name: &'static str,
    pub(super) unit: &'static str,
    pub(super) value: fn(&Row) -> String,
}

const fn column(name: &'static str, unit: &'static str, value: fn(&Row) -> String) -> Column {
    Column { name, unit, value }
}

/// From left to right.
pub(super) const COLUMNS: [Column; 25] = [
    column("scenario", "", |row| row.name.clone()),
    column("survival", "%", |row| {
        digits(100.0 * row.outcome.survival, 1)
    }),
    column("rmse", "m/s", |row| digits(row.outcome.rmse, 3)),
    column("settled", "m/s", |row| or_dash(row.outcome.rmse_settled, 3)),
    column("off", "m/s", |row| or_dash(row.outcome.off, 3)),
    column("lateral", "m/s", |row| digits(row.outcome.rmse_lateral, 3)),
    column("yaw", "rad/s", |row| digits(row.outcome.rmse_yaw_rate, 3)),
    column("yaw settled", "rad/s", |row| {
        or_dash(row.outcome.rmse_yaw_rate_settled, 3)
    }),
    column("yaw off", "rad/s", |row| {
        or_dash(row.outcome.off_yaw_rate, 3)
    }),
    column("energy", "J/1000", |row| digits(row.outcome.energy_j, 0)),
    column("transport", "", |row| {
        or_dash(row.outcome.cost_of_transport, 2)
    }),
    column("style", "", |row| digits(row.outcome.style_reward, 3)),
    column("hips", "", |row| or_dash(row.outcome.hip_correlation, 2)),
    column("stride", "Hz", |row| or_dash(row.outcome.stride_rate_hz, 2)),
    column("reference", "Hz", |row| {
        or_dash(row.reference.as_ref().map(|clip| clip.stride_rate_hz), 2)
    }),
    column("duty", "", |row| or_dash(row.outcome.duty_factor, 2)),
    column("double", "%", |row| percent(row.outcome.double_support)),
    column("flight", "%", |row| percent(row.outcome.flight_share)),
    column("clear", "cm", |row| centimetres(row.outcome.foot_clearance)),
    column("slip", "cm/stride", |row| {
        centimetres(row.outcome.slip_per_stride)
    }),
    column("symmetry", "", |row| or_dash(row.outcome.step_symmetry, 2)),
    column("saturated", "%", |row| {
        percent(row.outcome.torque_saturated_share)
    }),
    column("speed", "%", |row| {
        digits(100.0 * f64::from(row.outcome.joint_speed_peak), 0)
    }),
    column("ended", "", ended),
    column("gait", "", |row| row.outcome.gait.clone()),
];

/// What the columns mean, for whoever reads a report.
pub(super) const LEGEND: &str = "\
- survival: episodes that had all their time. Everything else is measured until their end.
- rmse: root mean squared planar velocity error (III-F); settled: without the first two seconds after a start
  or a new command; lateral: its sideways part; yaw: of the yaw rate, and that of settled robots.
- off, yaw off: how far a settled robot's mean velocity over whole strides is off its command, mean over robots. A pelvis
  sways within a stride, a person's too: that is in rmse and not in here.
- energy: positive mechanical work of a robot per 1,000 control steps (20 s), without exploration noise;
  transport: the same per weight and way.
- style: the discriminator's reward (Eq. 7), 0 to 1.
- hips: correlation of left and right hip pitch, −1 a walk, +1 a hop.
- stride, reference: strides per second of the robot, and of the reference motion nearest to the command.
- duty: share of time that a foot is down; double: share of time that both are, flight: that none is.
- clear: mean height of a foot's sole in swing; slip: way of a foot on the ground per stride.
- symmetry: 1 both feet step alike, 0 one foot always leads.
- saturated: share of steps in which some joint gives all the torque it has; speed: greatest share of any joint's
  velocity limit.
- ended: how many episodes ended before their time, and why: a fall, straying from the command, a fault of the physics.
- gait: stand, walk, run or turn where settled robots do what they are told, forward, aside and in turning; else
  what they do instead.";

/// Episodes that ended before their time, by cause.
fn ended(row: &Row) -> String {
    let early = [Cause::Fall, Cause::Stray, Cause::Fault];
    let counts = early.map(|cause| (row.outcome.ends.by(cause), cause.name()));
    let some = counts.into_iter().filter(|(count, _)| *count > 0);
    let words: Vec<String> = some
        .map(|(count, name)| format!("{count} {name}"))
        .collect();
    if words.is_empty() {
        "-".to_owned()
    } else {
        words.join(", ")
    }
}

fn digits(number: f64, digits: usize) -> String {
    format!("{number:.digits$}")
}

fn or_dash(number: Option<f64>, digits: usize) -> String {
    number.map_or_else(|| "-".to_owned(), |number| self::digits(number, digits))
}

fn percent(share: Option<f64>) -> String {
    or_dash(share.map(|share| 100.0 * share), 1)
}

fn centimetres(metres: Option<f64>) -> String {
    or_dash(metres.map(|metres| 100.0 * metres), 1)
}

/// A table for the terminal: the first and the last column to the left, numbers to the right.
pub(super) fn text(rows: &[Row]) -> String {
    let mut lines: Vec<Vec<String>> = vec![
        COLUMNS
            .iter()
            .map(|column| column.name.to_owned())
            .collect(),
        COLUMNS
            .iter()
            .map(|column| column.unit.to_owned())
            .collect(),
    ];
    lines.extend(rows.iter().map(cells));
    let widths: Vec<usize> = (0..COLUMNS.len())
        .map(|i| lines.iter().map(|line| line[i].chars().count()).max())
        .map(Option::unwrap_or_default)
        .collect();
    let lines: Vec<String> = lines.iter().map(|line| joined(line, &widths)).collect();
    lines.join("\n")
}

fn joined(cells: &[String], widths: &[usize]) -> String {
    let last = cells.len() - 1;
    let padded: Vec<String> = cells
        .iter()
        .zip(widths)
        .enumerate()
        .map(|(i, (cell, &width))| match i {
            0 => format!("{cell:<width$}"),
            _ if i == last => cell.clone(),
            _ => format!("{cell:>width$}"),
        })
        .collect();
    padded.join("  ").trim_end().to_owned()
}

/// A table for Markdown.
pub(super) fn markdown(rows: &[Row]) -> String {
    let heading = |column: &Column| match column.unit {
        "" => column.name.to_owned(),
        unit => format!("{}, {unit}", column.name),
    };
    let headings: Vec<String> = COLUMNS.iter().map(heading).collect();
    let last = COLUMNS.len() - 1;
    let rule = |i: usize| if i == 0 || i == last { "---" } else { "---:" };
    let rules: Vec<&str> = (0..COLUMNS.len()).map(rule).collect();
    let mut lines = vec![
        format!("| {} |", headings.join(" | ")),
        format!("| {} |", rules.join(" | ")),
    ];
    lines.extend(
        rows.iter()
            .map(|row| format!("| {} |", cells(row).join(" | "))),
    );
    lines.join("\n")
}

fn cells(row: &Row) -> Vec<String> {
    COLUMNS.iter().map(|column| (column.value)(row)).collect()
}
