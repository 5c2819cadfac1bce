//! The panel beside the view: handles, brush, how the surface bends, and what is to be known about the file.

use eframe::egui::{self, Color32, ComboBox, DragValue, RichText, ScrollArea, Slider};
use pliant_deform::{Loose, Method};
use pliant_editor::{Command, Editor, Handle, HandleTransform, Reach};

use super::command_button::command_button;
use super::notes::Notes;
use super::status::thousands;

/// Shows the panel; commands for the editor are added to `commands`.
pub fn show(ui: &mut egui::Ui, editor: &Editor, notes: &Notes, commands: &mut Vec<Command>) {
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

fn handles(ui: &mut egui::Ui, editor: &Editor, commands: &mut Vec<Command>) {
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

fn selected_handle(ui: &mut egui::Ui, handle: &Handle, commands: &mut Vec<Command>) {
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
        if ui.add(field).on_hover_text(hover).changed() {
            commands.push(Command::SetReach(handle.id, make(value)));
        }
        ui.end_row();
        if let HandleTransform::Trs {
            mut translation,
            rotation,
            scale,
            pivot,
        } = handle.transform
        {
            ui.label("Moved by");
            let mut changed = false;
            ui.horizontal(|ui| {
                ui.spacing_mut().item_spacing.x = 2.0;
                for axis in translation.as_mut() {
                    changed |= ui.add(DragValue::new(axis).speed(0.01).max_decimals(4)).changed();
                }
            });
            ui.end_row();
            if changed {
                commands.push(Command::SetHandleTransform(
                    handle.id,
                    HandleTransform::Trs {
                        translation,
                        rotation,
                        scale,
                        pivot,
                    },
                ));
            }
        }
    });
}

fn brush(ui: &mut egui::Ui, editor: &Editor, commands: &mut Vec<Command>) {
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

fn bending(ui: &mut egui::Ui, editor: &Editor, commands: &mut Vec<Command>) {
    ui.heading("Bending");
    let document = editor.document();
    ComboBox::from_label("method")
        .selected_text(document.method().name())
        .show_ui(ui, |ui| {
            for &name in Method::NAMES {
                let chosen = document.method().name() == name;
                if ui
                    .selectable_label(chosen, name)
                    .on_hover_text(when_to_use(name))
                    .clicked()
                    && !chosen
                    && let Some(method) = Method::from_name(name)
                {
                    commands.push(Command::SetMethod(method));
                }
            }
        });
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

/// A sentence on when a method is the one to take.
fn when_to_use(method: &str) -> &'static str {
    match method {
        "bilaplacian" => "Bends like a thin plate, at once: for small turns and smooth bulges.",
        "arap" => "Keeps every neighbourhood as rigid as it can, step by step: for large turns and long drags.",
        _ => "",
    }
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
