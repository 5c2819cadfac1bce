//! The steps of the document: a click goes back or forth to one; their memory.

use eframe::egui::{self, RichText, ScrollArea};
use pliant_editor::{Command, Editor, HISTORY_BYTES};

use crate::window::widgets::outbox::Outbox;

/// Shows the steps.
pub fn show(ui: &mut egui::Ui, editor: &Editor, commands: &mut Outbox) {
    let (names, done) = editor.history().names();
    let row_height = ui.text_style_height(&egui::TextStyle::Body) + 4.0;
    ScrollArea::vertical()
        .id_salt("history")
        .max_height(140.0)
        .stick_to_bottom(true)
        .show_rows(ui, row_height, names.len() + 1, |ui, rows| {
            for row in rows {
                let name = if row == 0 { "Opened" } else { names[row - 1] };
                let text = RichText::new(name);
                let text = if row > done { text.weak() } else { text };
                let step = egui::Button::selectable(row == done, text).truncate();
                if ui.add(step).clicked() && row != done {
                    commands.push(Command::GoToStep(row));
                }
            }
        });
    let megabytes = |bytes: usize| bytes as f64 / f64::from(1 << 20);
    let used = format!(
        "{:.1} of {:.0} MB kept for undo",
        megabytes(editor.history().bytes()),
        megabytes(HISTORY_BYTES)
    );
    ui.label(RichText::new(used).weak().small())
        .on_hover_text("Beyond that limit, the oldest steps are dropped.");
}
