//! The version, the licence and the graphics device, and the place to report faults.

use eframe::egui::{self, RichText};

use crate::version::VERSION;
use crate::window::input::file_command::FileCommand;

/// egui's id of its window.
pub const ID: &str = "about window";

/// The address to which faults are reported.
pub const REPORTS: &str = concat!(env!("CARGO_PKG_REPOSITORY"), "/issues");

/// The address of the manual.
pub const MANUAL: &str = concat!(env!("CARGO_PKG_HOMEPAGE"), "/manual");

/// The window.
#[derive(Debug, Default)]
pub struct About {
    /// True if it is open.
    pub open: bool,
}

impl About {
    /// Shows the window, if it is open; `device` is the graphics device in use. Returns the chosen command.
    pub fn show(&mut self, context: &egui::Context, device: &str) -> Option<FileCommand> {
        let mut chosen = None;
        egui::Window::new("About Pliant")
            .id(egui::Id::unique(ID))
            .open(&mut self.open)
            .default_width(380.0)
            .resizable(false)
            .show(context, |ui| {
                let facts = facts(device);
                ui.label(RichText::new("Pliant bends scanned meshes.").strong());
                ui.add_space(4.0);
                egui::Grid::new("about").num_columns(2).show(ui, |ui| {
                    for (name, fact) in &facts {
                        ui.label(RichText::new(*name).weak());
                        ui.add(egui::Label::new(fact).wrap().selectable(true));
                        ui.end_row();
                    }
                });
                ui.add_space(4.0);
                ui.horizontal(|ui| {
                    if ui.button("Report a fault").on_hover_text(REPORTS).clicked() {
                        chosen = Some(FileCommand::Report);
                    }
                    let hover = "Copies these lines, for a report.";
                    if ui.button("Copy").on_hover_text(hover).clicked() {
                        let lines = facts.iter().map(|(name, fact)| format!("{name}: {fact}\n"));
                        ui.ctx().copy_text(lines.collect());
                    }
                });
            });
        chosen
    }
}

/// The lines of the window, each with its name.
fn facts(device: &str) -> [(&'static str, String); 5] {
    [
        ("Version", VERSION.to_owned()),
        ("Licence", env!("CARGO_PKG_LICENSE").to_owned()),
        ("Graphics", device.to_owned()),
        (
            "System",
            format!("{}, {}", std::env::consts::OS, std::env::consts::ARCH),
        ),
        ("Faults", REPORTS.to_owned()),
    ]
}
