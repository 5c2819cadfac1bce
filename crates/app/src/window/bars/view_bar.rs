//! The bar over the view: undo and redo at the left, the choices of the view at the right.

use eframe::egui::{self, Align, Layout};
use pliant_editor::{Command, Editor, Shading};

use crate::window::widgets::command_button::icon_choice;
use crate::window::widgets::icon::Glyph;
use crate::window::widgets::outbox::Outbox;

/// Below this width the choices show only their icons.
const ROOMY: f32 = 480.0;

/// Shows the bar. Commands are added to `commands`.
pub fn show(ui: &mut egui::Ui, editor: &Editor, commands: &mut Outbox) {
    let look = editor.view().look;
    let is_roomy = ui.available_width() >= ROOMY;
    let mut offer = |ui: &mut egui::Ui, (command, glyph, label): (Command, Glyph, &str), chosen: bool| {
        let label = (is_roomy && !label.is_empty()).then_some(label);
        if icon_choice(ui, editor, &command, chosen, glyph, label) {
            commands.push(command);
        }
    };
    ui.horizontal(|ui| {
        ui.spacing_mut().item_spacing.x = 4.0;
        offer(ui, (Command::Undo, Glyph::Undo2, ""), false);
        offer(ui, (Command::Redo, Glyph::Redo2, ""), false);
        ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
            // From the right to the left.
            offer(
                ui,
                (Command::ToggleWireframe, Glyph::Grid3x3, "Wireframe"),
                look.wireframe,
            );
            offer(
                ui,
                (Command::ToggleRegions, Glyph::Highlighter, "Regions"),
                look.regions,
            );
            ui.separator();
            for (shading, glyph, label) in [
                (Shading::Material, Glyph::SwatchBook, "Material"),
                (Shading::Clay, Glyph::Droplet, "Clay"),
            ] {
                let command = Command::SetShading(shading);
                offer(ui, (command, glyph, label), look.shading == shading);
            }
        });
    });
}
