//! What is on the screen, read back as text.

use super::*;
use ratatui::Terminal;
use ratatui::backend::TestBackend;
use serde_json::json;

/// What is on a screen of 120 columns.
fn text(known: &Board) -> String {
    let mut terminal = Terminal::new(TestBackend::new(120, 30)).unwrap();
    terminal.draw(|frame| board(frame, known)).unwrap();
    let buffer = terminal.backend().buffer();
    let cells: Vec<&str> = buffer.content().iter().map(|cell| cell.symbol()).collect();
    let rows = cells.chunks(usize::from(buffer.area.width));
    rows.map(|row| row.concat() + "\n").collect()
}

#[test]
fn an_empty_run_is_drawn() {
    let shown = text(&Board::default());
    assert!(shown.contains("not running"), "{shown}");
    assert!(shown.contains("nobody is alive"), "{shown}");
}

#[test]
fn figures_and_processes_are_on_the_screen() {
    let mut known = Board {
        run: "walk".to_owned(),
        iterations: 500,
        attached: true,
        processes: vec![("actor-0".to_owned(), "71".to_owned())],
        ..Board::default()
    };
    for iteration in 1..=40 {
        known.take(json!({
            "iteration": iteration, "style_mean": 0.25, "task_mean": f64::from(iteration) / 100.0,
            "phase": 1, "dropped": 3, "policy_lag": 0.5, "timing": { "samples_per_second": 2150.0 },
        }));
    }
    let shown = text(&known);
    for part in [
        "run walk · iteration 40/500 · live",
        "style 0.250, task 0.400",
        "samples per second: all actors 2150",
        "phase 1",
        "dropped 3",
        "lag 0.500",
        "actor-0 (71)",
    ] {
        assert!(shown.contains(part), "{part} in\n{shown}");
    }
    // The curve of the task climbs: some of it is drawn in dots.
    assert!(
        shown
            .chars()
            .any(|c| ('\u{2801}'..='\u{28ff}').contains(&c)),
        "{shown}"
    );
}
