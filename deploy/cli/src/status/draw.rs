//! The dashboard on the screen: four curves, then phase, weights, traffic and processes.

use super::board::{Board, Curve};
use ratatui::Frame;
use ratatui::layout::{Constraint, Layout, Rect};
use ratatui::style::{Color, Style, Stylize};
use ratatui::symbols::Marker;
use ratatui::text::Line;
use ratatui::widgets::{Axis, Block, Chart, Dataset, GraphType, Paragraph};
use terminal::figures;

/// Draws all of it.
pub(super) fn board(frame: &mut Frame<'_>, board: &Board) {
    let [title, upper, lower, facts, hint] = Layout::vertical([
        Constraint::Length(1),
        Constraint::Fill(1),
        Constraint::Fill(1),
        Constraint::Length(7),
        Constraint::Length(1),
    ])
    .areas(frame.area());
    frame.render_widget(heading(board), title);
    let halves =
        |row: Rect| -> [Rect; 2] { Layout::horizontal([Constraint::Fill(1); 2]).areas(row) };
    let [rewards, weights] = halves(upper);
    let [lengths, rates] = halves(lower);
    let (style, task) = (("style", Color::Magenta), ("task", Color::Cyan));
    chart(
        frame,
        rewards,
        "reward",
        &[(style, &board.style), (task, &board.task)],
    );
    let weight = ("style weight", Color::Magenta);
    chart(frame, weights, "weight", &[(weight, &board.style_weight)]);
    let length = ("steps", Color::Green);
    chart(
        frame,
        lengths,
        "episode length",
        &[(length, &board.episode_length)],
    );
    chart(
        frame,
        rates,
        "samples per second",
        &[(("all actors", Color::Yellow), &board.rate)],
    );
    let block = Block::bordered().title("now");
    frame.render_widget(Paragraph::new(now(board)).block(block), facts);
    frame.render_widget(
        Line::from("q to leave; the run does not notice").dark_gray(),
        hint,
    );
}

fn heading(board: &Board) -> Line<'static> {
    let iteration = board.report.map_or_else(
        || board.newest["iteration"].as_u64(),
        |report| Some(report.iteration),
    );
    let mut words = format!("run {}", board.run);
    if let Some(iteration) = iteration {
        words += &format!(" · iteration {iteration}");
        if board.iterations > 0 {
            words += &format!("/{}", board.iterations);
        }
    }
    words += if board.attached {
        " · live"
    } else {
        " · not running"
    };
    Line::from(words).bold()
}

type Named<'a> = ((&'static str, Color), &'a Curve);

fn chart(frame: &mut Frame<'_>, area: Rect, title: &str, curves: &[Named<'_>]) {
    let points = || curves.iter().flat_map(|(_, curve)| curve.iter());
    let span = |values: &mut dyn Iterator<Item = f64>| {
        values.fold(None, |range: Option<[f64; 2]>, x| {
            let [least, most] = range.unwrap_or([x, x]);
            Some([least.min(x), most.max(x)])
        })
    };
    let x = span(&mut points().map(|p| p.0)).unwrap_or([0.0, 1.0]);
    let [least, most] = span(&mut points().map(|p| p.1)).unwrap_or([0.0, 1.0]);
    // A flat line still needs a height.
    let y = [least, most.max(least + 1e-3)];
    let newest: Vec<String> = curves
        .iter()
        .filter_map(|((name, _), curve)| Some(format!("{name} {}", short(curve.last()?.1))))
        .collect();
    let sets = curves
        .iter()
        .map(|((name, colour), curve)| {
            Dataset::default()
                .name(*name)
                .marker(Marker::Braille)
                .graph_type(GraphType::Line)
                .style(Style::new().fg(*colour))
                .data(curve)
        })
        .collect();
    let axis = |[least, most]: [f64; 2]| {
        Axis::default()
            .bounds([least, most])
            .labels([short(least), short(most)])
            .dark_gray()
    };
    let block = Block::bordered().title(format!("{title}: {}", newest.join(", ")));
    let chart = Chart::new(sets)
        .block(block)
        .x_axis(axis(x))
        .y_axis(axis(y))
        .legend_position(None);
    frame.render_widget(chart, area);
}

fn now(board: &Board) -> Vec<Line<'static>> {
    let newest = &board.newest;
    let figure = |name: &str| newest[name].as_f64().map_or_else(|| "-".to_owned(), short);
    let or_dash = |value: Option<f64>| value.map_or_else(|| "-".to_owned(), short);
    let directive = board.directive.as_ref();
    let phase = directive.map_or_else(
        || {
            newest["phase"]
                .as_u64()
                .map_or_else(|| "-".to_owned(), |phase| phase.to_string())
        },
        |directive| directive.phase.to_string(),
    );
    let bounds = directive.and_then(|directive| directive.bounds());
    let bounds = bounds.map_or_else(
        || "-".to_owned(),
        |(lower, upper)| format!("{} to {}", short(lower), short(upper)),
    );
    let actors: Vec<String> = board
        .processes
        .iter()
        .map(|(role, pid)| format!("{role} ({pid})"))
        .collect();
    vec![
        Line::from(format!(
            "phase {phase} · weights {}/{} · breakout rate {} of {} · bounds {bounds} · weights version {}",
            figure("style_weight"),
            figure("task_weight"),
            or_dash(directive.and_then(|directive| directive.breakout_rate())),
            or_dash(directive.map(|directive| directive.threshold)),
            board
                .weights_version
                .map_or_else(|| "-".to_owned(), |version| version.to_string()),
        )),
        Line::from(format!(
            "rmse {} m/s · energy {} J/1000 · hips {} · {}",
            figure("rmse"),
            figure("energy_j"),
            figure("hip_correlation"),
            figures::ends(newest).unwrap_or_default(),
        )),
        Line::from(figures::terms(newest).unwrap_or_default()),
        Line::from(format!(
            "rollouts {} · actors {} · lag {} · dropped {} · stale {} · duplicated {} · waiting {} s · missed here {}",
            figure("rollouts"),
            figure("actors"),
            figure("policy_lag"),
            figure("dropped"),
            figure("stale"),
            figure("duplicated"),
            newest["timing"]["waiting_seconds"]
                .as_f64()
                .map_or_else(|| "-".to_owned(), short),
            board.missed,
        )),
        Line::from(if actors.is_empty() {
            "nobody is alive".to_owned()
        } else {
            actors.join(" · ")
        }),
    ]
}

/// A number in few characters.
fn short(x: f64) -> String {
    match x.abs() {
        size if size >= 100.0 || x.fract() == 0.0 => format!("{x:.0}"),
        size if size >= 10.0 => format!("{x:.1}"),
        _ => format!("{x:.3}"),
    }
}

#[cfg(test)]
mod tests;
