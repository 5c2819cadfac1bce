//! The flow tool's settings: the brush, play and pause, the forces, and the dye's way into the file.

use std::ops::RangeInclusive;

use eframe::egui;
use glam::DVec3;
use pliant_editor::{Command, Editor, FlowAction, FlowOptions, UpAxis};

use super::share_slider::share;
use crate::window::widgets::command_button::{choices, command_button, icon_choice, play_choice};
use crate::window::widgets::icon::Glyph;
use crate::window::widgets::number_field::{number_field, slid};
use crate::window::widgets::outbox::Outbox;
use crate::window::widgets::row_label::bar_label;

/// Shows the settings.
pub fn show(ui: &mut egui::Ui, editor: &Editor, commands: &mut Outbox) {
    play(ui, editor, commands);
    brush(ui, editor, commands);
    ui.menu_button("Dye", |ui| {
        for command in [Command::KeepDye, Command::ClearDye, Command::RemoveKeptDye] {
            if command_button(ui, editor, &command) {
                commands.push(command);
                ui.close();
            }
        }
    })
    .response
    .on_hover_text("Keeps the dye as vertex colours, or removes it.");
}

fn play(ui: &mut egui::Ui, editor: &Editor, commands: &mut Outbox) {
    if play_choice(ui, editor, &Command::PlayFlow, editor.view().is_playing) {
        commands.push(Command::PlayFlow);
    }
    // Its picture says it, and the bar of a small window has one row.
    if icon_choice(ui, editor, &Command::StepFlow, false, Glyph::StepForward, None) {
        commands.push(Command::StepFlow);
    }
}

fn brush(ui: &mut egui::Ui, editor: &Editor, commands: &mut Outbox) {
    let brush = &editor.view().flow_brush;
    const ACTIONS: [(FlowAction, &str, &str); 4] = [
        (
            FlowAction::PourAndPush,
            "Pour and push",
            "Pours colour, and moves the fluid as fast as the stroke.",
        ),
        (FlowAction::Pour, "Pour", "Pours colour."),
        (
            FlowAction::Push,
            "Push",
            "Moves the fluid as fast as the stroke, like painting with Shift.",
        ),
        (FlowAction::Wash, "Wash", "Washes colour away, like painting with Ctrl."),
    ];
    let mut changed = *brush;
    if let Some(action) = choices(ui, brush.action, &ACTIONS) {
        changed.action = action;
    }
    let label = bar_label(ui, "Colour");
    ui.color_edit_button_srgb(&mut changed.colour)
        .labelled_by(label.id)
        .on_hover_text("Sets the colour of the dye.");
    ui.menu_button("More", |ui| {
        egui::Grid::new("flow brush").num_columns(2).show(ui, |ui| {
            for (name, value, says) in [
                (
                    "Strength",
                    &mut changed.strength,
                    "Sets the share of colour and speed that the fluid gets. A pen's pressure scales it.",
                ),
                (
                    "Falloff",
                    &mut changed.falloff,
                    "Sets the brush's rim: 0 ends sharply, 1 fades from the middle.",
                ),
            ] {
                share(ui, name, value, says);
                ui.end_row();
            }
            forces(ui, editor, commands);
        });
    });
    if changed != *brush {
        commands.push(Command::SetFlowBrush(changed));
    }
}

/// The directions of gravity, by name, in a file with this axis up.
fn named_directions(up: UpAxis) -> [(&'static str, DVec3); 6] {
    let (up, front) = match up {
        UpAxis::Y => (DVec3::Y, DVec3::Z),
        UpAxis::Z => (DVec3::Z, DVec3::NEG_Y),
    };
    [
        ("down", -up),
        ("up", up),
        ("left", DVec3::NEG_X),
        ("right", DVec3::X),
        ("back", -front),
        ("front", front),
    ]
}

fn forces(ui: &mut egui::Ui, editor: &Editor, commands: &mut Outbox) {
    let options = *editor.document().flow_options();
    let camera = editor.view().camera;
    let size = camera.scale;
    let [(_, down), ..] = named_directions(camera.up);
    // A gravity of 0 keeps the direction in which it is set next.
    let id = egui::Id::unique("direction of the flow's gravity");
    let kept: DVec3 = ui.data(|data| data.get_temp(id)).unwrap_or(down);
    let direction = options.gravity.try_normalize().unwrap_or(kept);
    ui.data_mut(|data| data.insert_temp(id, direction));

    let mut strength = options.gravity.length();
    let says = "Sets the acceleration of dyed fluid, in units per second squared.";
    let gravity = force(ui, "Gravity", &mut strength, 0.0..=5.0 * size, says);
    commands.adjust(&gravity, || {
        Command::SetFlowOptions(FlowOptions {
            gravity: direction * strength,
            ..options
        })
    });
    ui.end_row();
    if let Some(towards) = directions(ui, direction, editor) {
        ui.data_mut(|data| data.insert_temp(id, towards));
        commands.push(Command::SetFlowOptions(FlowOptions {
            gravity: towards * strength,
            ..options
        }));
    }
    ui.end_row();
    let mut viscosity = options.viscosity;
    let says = "Sets how much neighbouring places move alike, in squared units per second.";
    let slider = force(ui, "Viscosity", &mut viscosity, 0.0..=0.02 * size * size, says);
    commands.adjust(&slider, || {
        Command::SetFlowOptions(FlowOptions { viscosity, ..options })
    });
    ui.end_row();
    let mut confinement = options.confinement;
    let says = "Gives small swirls their energy back, per second.";
    let slider = force(ui, "Swirls", &mut confinement, 0.0..=20.0, says);
    commands.adjust(&slider, || {
        Command::SetFlowOptions(FlowOptions { confinement, ..options })
    });
}

/// The slider of a force, finer near 0.
fn force(ui: &mut egui::Ui, name: &str, value: &mut f64, range: RangeInclusive<f64>, says: &str) -> egui::Response {
    let label = bar_label(ui, name);
    let least = 1e-4 * range.end();
    let slider = number_field(ui, value, |ui, value| {
        let slider = slid(ui, value, range, &[]).logarithmic(true).smallest_positive(least);
        ui.add(slider.clamping(egui::SliderClamping::Never).max_decimals(4))
    });
    *value = value.max(0.0);
    slider.labelled_by(label.id).on_hover_text(says)
}

/// The direction of gravity; returns another one that is chosen.
fn directions(ui: &mut egui::Ui, present: DVec3, editor: &Editor) -> Option<DVec3> {
    let label = bar_label(ui, "Towards");
    let directions = named_directions(editor.view().camera.up);
    let name = directions
        .iter()
        .find(|(_, direction)| direction.distance(present) < 1e-9);
    let mut chosen = None;
    let list = egui::ComboBox::from_id_salt("direction of gravity")
        .selected_text(name.map_or("other", |(name, _)| name))
        .width(0.0)
        .show_ui(ui, |ui| {
            for (name, direction) in directions {
                if ui.selectable_label(direction == present, name).clicked() {
                    chosen = Some(direction);
                }
            }
            let says = "The direction that points down on the screen now.";
            if ui
                .selectable_label(false, "down on the screen")
                .on_hover_text(says)
                .clicked()
            {
                chosen = Some(-editor.view().camera.axes().y_axis);
            }
        });
    let says = "Sets the direction in which dyed fluid falls.";
    list.response.labelled_by(label.id).on_hover_text(says);
    chosen
}
