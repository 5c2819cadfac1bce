//! The messages of this session, in order, to read again and copy.

use std::time::SystemTime;

use eframe::egui::{self, RichText, ScrollArea};

/// The number of sentences that are kept.
const MOST: usize = 500;

/// The number of sentences that come to the log again in every frame while they are shown.
const STANDING: usize = 3;

/// egui's id of its window.
pub const ID: &str = "log window";

/// The log.
#[derive(Debug, Default)]
pub struct Log {
    lines: Vec<String>,
    /// True if its window is open.
    pub open: bool,
}

impl Log {
    /// Adds a sentence, unless it is one of the last ones: several may be shown at a time.
    pub fn say(&mut self, sentence: &str) {
        let sentence: String = sentence.chars().filter(|letter| !pliant_io::steers(*letter)).collect();
        let sentence = &*sentence;
        let mut last = self.lines.iter().rev().take(STANDING);
        let is_again = last.any(|line| line.ends_with(sentence));
        if is_again || sentence.is_empty() {
            return;
        }
        let seconds = SystemTime::now()
            .duration_since(SystemTime::UNIX_EPOCH)
            .map_or(0, |since| since.as_secs());
        let (hours, minutes) = (seconds / 3600 % 24, seconds / 60 % 60);
        self.lines.push(format!("{hours:02}:{minutes:02} UTC  {sentence}"));
        if self.lines.len() > MOST {
            self.lines.remove(0);
        }
    }

    /// Shows its window, if that is open.
    pub fn show(&mut self, context: &egui::Context) {
        let mut open = self.open;
        egui::Window::new("Log")
            .id(egui::Id::unique(ID))
            .open(&mut open)
            .default_width(520.0)
            .show(context, |ui| {
                if ui.button("Copy all").clicked() {
                    ui.ctx().copy_text(self.lines.join("\n"));
                }
                ui.separator();
                ScrollArea::vertical()
                    .max_height(300.0)
                    .auto_shrink(false)
                    .stick_to_bottom(true)
                    .show(ui, |ui| {
                        if self.lines.is_empty() {
                            ui.label(RichText::new("There are no messages yet.").weak());
                        }
                        for line in &self.lines {
                            ui.add(
                                egui::Label::new(RichText::new(line).monospace().small())
                                    .wrap()
                                    .selectable(true),
                            );
                        }
                    });
            });
        self.open = open;
    }
}
