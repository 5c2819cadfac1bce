//! The examples that guide or teach the method: a list with a weight each.

use eframe::egui::{self, RichText, ScrollArea, SliderClamping};
use pliant_deform::{AttachmentKind, LARGEST_WEIGHT};
use pliant_editor::{Command, Editor};

use crate::window::input::file_command::FileCommand;
use crate::window::widgets::command_button::command_button;
use crate::window::widgets::name_label::name_label;
use crate::window::widgets::number_field::{number_field, slid};
use crate::window::widgets::outbox::Outbox;

/// Shows the list, if the method takes examples.
///
/// `morph_targets` are the names of the file's own.
pub fn show(ui: &mut egui::Ui, editor: &Editor, morph_targets: &[String], commands: &mut Outbox) {
    let mut declared = editor.document().method().declaration().attachments.iter();
    if !declared.any(|own| own.kind == AttachmentKind::Shapes) {
        return;
    }
    ui.horizontal_wrapped(|ui| {
        if command_button(ui, editor, &Command::KeepExample) {
            commands.push(Command::KeepExample);
        }
        let says = "Adds another pose of the same mesh, with the same vertices and triangles, as an example.";
        if ui.button("Add from file…").on_hover_text(says).clicked() {
            commands.push_file(FileCommand::AddExample);
        }
        if !morph_targets.is_empty() {
            ui.menu_button(FileCommand::AddMorphTarget(String::new()).name(), |ui| {
                ScrollArea::vertical().show(ui, |ui| {
                    for target in morph_targets {
                        if ui.button(target).clicked() {
                            commands.push_file(FileCommand::AddMorphTarget(target.clone()));
                        }
                    }
                });
            })
            .response
            .on_hover_text("Adds a morph target of the file as an example.");
        }
    });
    let Some(examples) = editor.document().examples() else {
        return;
    };
    let they_bend = editor.document().method().examples_bend();
    let are_weighed = they_bend && examples.weights.iter().flatten().any(|weight| *weight != 0.0);
    if are_weighed && editor.document().handles().iter().any(|handle| handle.soft.is_none()) {
        let says = "Hard handles keep their vertices in place at any weight: delete them, or make them soft, to blend \
                    freely.";
        ui.label(RichText::new(says).weak().small());
    }
    for (place, (shape, weight)) in examples.shapes.iter().zip(&examples.weights).enumerate() {
        let found = editor.example_weights().get(place).copied();
        ui.push_id(("example", place), |ui| {
            let label = ui.horizontal(|ui| {
                let (label, renamed) = name_label(ui, "the example", place, &shape.name, false);
                let label = label.on_hover_text("Double-click to rename.").id;
                if let Some(name) = renamed {
                    commands.push(Command::RenameExample(place, name));
                }
                if they_bend {
                    let mut is_free = weight.is_none();
                    let says = "The solver finds the weight that suits the handles best.";
                    if ui.checkbox(&mut is_free, "found").on_hover_text(says).changed() {
                        let fixed = Some(found.unwrap_or(0.0).clamp(-LARGEST_WEIGHT, LARGEST_WEIGHT));
                        commands.push(Command::SetExampleWeight(place, if is_free { None } else { fixed }));
                    }
                }
                let remove = ui.button("Remove").on_hover_text(format!("Removes {}.", shape.name));
                if remove.clicked() {
                    commands.push(Command::RemoveExample(place));
                }
                label
            });
            let label = label.inner;
            let (without, range, says) = match they_bend {
                true => (
                    0.0,
                    -0.5..=1.5,
                    "Sets the weight: 0 is the rest shape, 1 is the example, and larger weights exaggerate it",
                ),
                false => (
                    1.0,
                    0.0..=2.0,
                    "Sets the share of its wrinkles to add: 0 is none, 1 is as in the example",
                ),
            };
            let mut shown = weight.or(found.filter(|_| they_bend)).unwrap_or(without);
            let slider = number_field(ui, &mut shown, |ui, shown| {
                let slider = slid(ui, shown, range, &[]).clamping(SliderClamping::Never);
                ui.add_enabled(weight.is_some() || !they_bend, slider.fixed_decimals(2))
            });
            let slider = slider
                .labelled_by(label)
                .on_hover_text(format!("{says}; double-click the number to type one."))
                .on_disabled_hover_text("The solver finds this weight: clear \"found\" to set it yourself.");
            commands.adjust(&slider, || {
                let weight = if shown.is_finite() { shown } else { without };
                Command::SetExampleWeight(place, Some(weight.clamp(-LARGEST_WEIGHT, LARGEST_WEIGHT)))
            });
        });
    }
}
