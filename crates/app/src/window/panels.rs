//! The panel beside the view: handles, brush, how the surface bends, and what is to be known about the file.

use eframe::egui::{self, Color32, DragValue, RichText, ScrollArea, Slider};
use pliant_deform::Loose;
use pliant_editor::{Command, Editor, Handle, HandleTransform, Reach, SOFT_RANGE};

use super::command_button::command_button;
use super::method_panel;
use super::notes::Notes;
use super::outbox::Outbox;
use super::status::thousands;

/// Shows the panel; commands for the editor are added to `commands`.
pub fn show(ui: &mut egui::Ui, editor: &Editor, notes: &Notes, commands: &mut Outbox) {
    ScrollArea::vertical().show(ui, |ui| {
        ui.add_space(6.0);
        handles(ui, editor, commands);
        ui.separator();
        brush(ui, editor, commands);
        ui.separator();
        bending(ui, editor, commands);
        ui.separator();
        about_file(ui, editor, notes);
    });
}

fn handles(ui: &mut egui::Ui, editor: &Editor, commands: &mut Outbox) {
    let view = editor.view();
    ui.heading("Handles");
    if view.handles.is_empty() {
        ui.label(RichText::new("Paint on the surface what you want to move.").weak());
    }
    for handle in view.handles {
        ui.horizontal(|ui| {
            let [red, green, blue, _] = handle.colour;
            let (swatch, _) = ui.allocate_exact_size(egui::vec2(12.0, 12.0), egui::Sense::hover());
            ui.painter()
                .rect_filled(swatch, 3.0, Color32::from_rgb(red, green, blue));
            let selected = view.selected == Some(handle.id);
            if ui.selectable_label(selected, &handle.name).clicked() {
                commands.push(if selected {
                    Command::Deselect
                } else {
                    Command::SelectHandle(handle.id)
                });
            }
        });
    }
    if let Some(handle) = view.handles.iter().find(|handle| view.selected == Some(handle.id)) {
        selected_handle(ui, handle, commands);
    }
    ui.horizontal_wrapped(|ui| {
        for command in [Command::NewHandle, Command::ResetHandle, Command::DeleteHandle] {
            if command_button(ui, editor, &command) {
                commands.push(command);
            }
        }
    });
}

fn selected_handle(ui: &mut egui::Ui, handle: &Handle, commands: &mut Outbox) {
    ui.add_space(2.0);
    egui::Grid::new("handle").num_columns(2).show(ui, |ui| {
        ui.label("Reach");
        let (mut value, suffix, most, make): (f64, _, _, fn(f64) -> Reach) = match handle.reach {
            Reach::Radii(radii) => (radii, " radii", 50.0, Reach::Radii),
            Reach::Length(length) => (length, "", f64::MAX, Reach::Length),
        };
        let field = DragValue::new(&mut value)
            .range(0.05..=most)
            .speed(0.05)
            .max_decimals(3)
            .suffix(suffix);
        let hover = "How far along the surface this handle takes the surface along.";
        let field = ui.add(field.update_while_editing(false)).on_hover_text(hover);
        commands.adjust(&field, || Command::SetReach(handle.id, make(value)));
        ui.end_row();
        softness(ui, handle, commands);
        ui.end_row();
        if let HandleTransform::Trs {
            mut translation,
            rotation,
            scale,
            pivot,
        } = handle.transform
        {
            ui.label("Moved by");
            ui.horizontal(|ui| {
                ui.spacing_mut().item_spacing.x = 2.0;
                for axis in 0..3 {
                    let field = DragValue::new(&mut translation[axis]).speed(0.01).max_decimals(4);
                    let field = ui.add(field.update_while_editing(false));
                    commands.adjust(&field, || {
                        let transform = HandleTransform::Trs {
                            translation,
                            rotation,
                            scale,
                            pivot,
                        };
                        Command::SetHandleTransform(handle.id, transform)
                    });
                }
            });
            ui.end_row();
        }
    });
}

/// Whether the handle holds its vertices or only pulls at them, and how firmly.
fn softness(ui: &mut egui::Ui, handle: &Handle, commands: &mut Outbox) {
    let mut is_soft = handle.soft.is_some();
    let hover = "A soft handle pulls at its part of the surface instead of holding it.";
    if ui.checkbox(&mut is_soft, "Soft").on_hover_text(hover).changed() {
        commands.push(Command::SetSoft(handle.id, is_soft.then_some(1.0)));
    }
    if let Some(mut weight) = handle.soft {
        let speed = 0.02 * weight;
        let field = DragValue::new(&mut weight)
            .range(SOFT_RANGE)
            .speed(speed)
            .update_while_editing(false);
        let hover = "Its weight: at 1 the handle and the surface give way to each other; the larger, the firmer.";
        let field = ui.add(field).on_hover_text(hover);
        commands.adjust(&field, || Command::SetSoft(handle.id, Some(weight)));
    }
}

fn brush(ui: &mut egui::Ui, editor: &Editor, commands: &mut Outbox) {
    ui.heading("Brush");
    let mut radius_px = editor.view().brush_radius_px;
    let slider = Slider::new(&mut radius_px, 4.0..=200.0)
        .suffix(" px")
        .fixed_decimals(0)
        .text("radius");
    if ui
        .add(slider)
        .on_hover_text("[ and ] make it smaller and larger.")
        .changed()
    {
        commands.push(Command::SetBrushRadius(radius_px));
    }
}

fn bending(ui: &mut egui::Ui, editor: &Editor, commands: &mut Outbox) {
    ui.heading("Bending");
    method_panel::show(ui, editor, commands);
    let document = editor.document();
    ui.horizontal(|ui| {
        ui.label("Loose parts");
        for (name, loose, hover) in [
            (
                "follow",
                Loose::Follow,
                "Parts that nothing holds move along with the surface beside them.",
            ),
            ("rest", Loose::Rest, "Parts that nothing holds stay where they are."),
        ] {
            if ui
                .selectable_label(document.loose() == loose, name)
                .on_hover_text(hover)
                .clicked()
            {
                commands.push(Command::SetLoose(loose));
            }
        }
    });
    ui.horizontal_wrapped(|ui| {
        for command in [Command::Apply, Command::ResetShape, Command::ClearRegions] {
            if command_button(ui, editor, &command) {
                commands.push(command);
            }
        }
    });
}

fn about_file(ui: &mut egui::Ui, editor: &Editor, notes: &Notes) {
    ui.heading("File");
    let Some(model) = editor.view().model else {
        ui.label(RichText::new("Nothing is open.").weak());
        return;
    };
    ui.label(format!(
        "{} vertices, {} triangles",
        thousands(model.drawn.file_vertex_count),
        thousands(model.surface.triangles.len())
    ));
    for note in &notes.about_file {
        ui.add(egui::Label::new(RichText::new(note).weak().small()).wrap());
    }
}
