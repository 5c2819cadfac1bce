//! The limit of memory for binding: the machine's free memory, or a number that the person chooses.

use eframe::egui::{self, RichText};

use crate::window::files::settings::{MostMemory, SettingsFile};
use crate::window::widgets::number_field::{dragged, number_field};

/// egui's id of its window.
pub const ID: &str = "memory window";

/// The first suggestion, in bytes.
const FIRST: u64 = 8_000_000_000;

/// The possible values, in gigabytes.
const RANGE_GB: std::ops::RangeInclusive<f64> = 0.1..=4096.0;

/// The choice.
#[derive(Debug, Default)]
pub struct MemoryWindow {
    /// True if it is open.
    pub open: bool,
    /// The number while it is being dragged: it takes effect on release.
    dragged_gb: Option<f64>,
}

impl MemoryWindow {
    /// Shows the window, if it is open; true when the choice changes.
    pub fn show(&mut self, context: &egui::Context, settings: &mut SettingsFile) -> bool {
        let before = settings.get().memory;
        let mut most = before;
        let Self { open, dragged_gb } = self;
        egui::Window::new("Memory")
            .id(egui::Id::unique(ID))
            .open(open)
            .default_width(360.0)
            .resizable(false)
            .show(context, |ui| choose(ui, &mut most, dragged_gb));
        if most != before {
            settings.change(|settings| settings.memory = most);
        }
        most != before
    }
}

fn choose(ui: &mut egui::Ui, most: &mut Option<MostMemory>, dragged_gb: &mut Option<f64>) {
    ui.label("Memory for binding, beside the mesh:");
    if ui.radio(most.is_none(), "All free memory").clicked() {
        *most = None;
    }
    ui.horizontal(|ui| {
        if ui.radio(most.is_some(), "At most").clicked() && most.is_none() {
            *most = Some(MostMemory(FIRST));
        }
        ui.add_enabled_ui(most.is_some(), |ui| {
            let chosen_gb = most.map_or(FIRST, |most| most.0) as f64 / 1e9;
            let mut shown_gb = dragged_gb.unwrap_or(chosen_gb);
            let field = number_field(ui, &mut shown_gb, |ui, shown_gb| {
                ui.add(
                    dragged(ui, shown_gb, &[("GB", 1.0)])
                        .range(RANGE_GB)
                        .speed(0.1)
                        .max_decimals(1)
                        .suffix(" GB"),
                )
            });
            field.widget_info(|| egui::WidgetInfo::labeled(egui::Role::SpinButton, true, "Most memory in GB"));
            if field.dragged() {
                *dragged_gb = Some(shown_gb);
            } else if dragged_gb.take().is_some() || field.changed() {
                *most = Some(MostMemory((shown_gb * 1e9) as u64));
            }
        });
    });
    let note = "A larger system is solved with less memory in more time, or refused. All free memory means 16 GiB at \
                most.";
    ui.label(RichText::new(note).weak().small());
}
