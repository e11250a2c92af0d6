//! `ampco status --watch`: looks and draws four times a second until it is left.

use std::io::IsTerminal;
use std::time::Duration;

use anyhow::{Context, Result};
use protocol::Shutdown;
use ratatui::DefaultTerminal;
use ratatui::crossterm::event::{self, Event, KeyCode, KeyEvent, KeyModifiers};
use run::{Folder, RunConfig};
use terminal::failure::usage;

use super::board::{Board, Watcher};
use super::draw;

/// Time between two looks.
const EVERY: Duration = Duration::from_millis(250);

pub(super) fn run(folder: Folder) -> Result<()> {
    if !std::io::stdout().is_terminal() {
        return Err(usage(
            "--watch draws on a terminal and this is none; use `ampco status` or --json",
        ));
    }
    let config: RunConfig = folder.config()?.section()?;
    let mut board = Board {
        run: folder.name(),
        iterations: config.iterations,
        ..Board::default()
    };
    let shutdown = Shutdown::on_signals()?;
    let mut watcher = Watcher::new(folder, shutdown.clone());
    let mut terminal = ratatui::try_init().context("taking over the terminal")?;
    let done = watch(&mut terminal, &mut watcher, &mut board, &shutdown);
    ratatui::restore();
    done
}

fn watch(
    terminal: &mut DefaultTerminal,
    watcher: &mut Watcher,
    board: &mut Board,
    shutdown: &Shutdown,
) -> Result<()> {
    while !shutdown.requested() {
        watcher.look(board)?;
        terminal.draw(|frame| draw::board(frame, board))?;
        if event::poll(EVERY)?
            && let Event::Key(key) = event::read()?
            && leaves(key)
        {
            break;
        }
    }
    Ok(())
}

/// q, Escape or Ctrl-C, which a terminal that is drawn on hands over as a key.
fn leaves(key: KeyEvent) -> bool {
    let control = key.modifiers.contains(KeyModifiers::CONTROL);
    matches!(key.code, KeyCode::Char('q') | KeyCode::Esc)
        || (control && key.code == KeyCode::Char('c'))
}
