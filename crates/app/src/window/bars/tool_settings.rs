//! The bar of the tool's settings under the bar of the view: the stroke's shape, the brush, and the stiffness that it
//! paints.

use eframe::egui::{self, ComboBox, RichText};
use pliant_editor::{
    BrushMetric, Command, Correction, CorrectionBrush, Depth, Editor, STIFFNESS_RANGE, StiffnessAction, StiffnessBrush,
    StrokeShape, Symmetry, ToolMode,
};

use super::flow_settings;
use super::share_slider::share;
use crate::window::widgets::command_button::{choices, command_button, command_choice};
use crate::window::widgets::number_field::{dragged, number_field, slid};
use crate::window::widgets::outbox::Outbox;
use crate::window::widgets::row_label::bar_label;

/// The length of a slider, in points: the settings of most tools fit in one row of a small window.
const SLIDER: f32 = 64.0;

/// Shows the settings of the current tool.
pub fn show(ui: &mut egui::Ui, editor: &Editor, commands: &mut Outbox) {
    // The view must not jump from tool to tool: the bar stays as high as it has been at this width.
    let id = egui::Id::unique(("height of the tool's settings", ui.available_width() as i32));
    let height: f32 = ui.data(|data| data.get_temp(id)).unwrap_or_default();
    let shown = ui.horizontal_wrapped(|ui| settings(ui, editor, commands)).response.rect;
    ui.data_mut(|data| data.insert_temp(id, height.max(shown.height())));
    ui.add_space((height - shown.height()).max(0.0));
}

fn settings(ui: &mut egui::Ui, editor: &Editor, commands: &mut Outbox) {
    let view = editor.view();
    ui.spacing_mut().slider_width = SLIDER;
    match view.tool {
        ToolMode::Pose => {
            if command_choice(ui, editor, &Command::ToggleWholeLimb, view.whole_limb) {
                commands.push(Command::ToggleWholeLimb);
            }
        }
        ToolMode::Flow => {
            brush(ui, view.brush_radius_px, view.brush_metric, commands);
            return flow_settings::show(ui, editor, commands);
        }
        ToolMode::PaintStiffness | ToolMode::Correct => {
            brush(ui, view.brush_radius_px, view.brush_metric, commands);
        }
        _ => {
            stroke_shape(ui, editor, commands);
            match view.stroke_shape {
                StrokeShape::Brush => brush(ui, view.brush_radius_px, view.brush_metric, commands),
                StrokeShape::Lasso | StrokeShape::Box => depth(ui, view.depth, commands),
                StrokeShape::Component | StrokeShape::Sketch => {}
                StrokeShape::Crease => {
                    brush_radius(ui, view.brush_radius_px, commands);
                    return curve(ui, editor, commands);
                }
                StrokeShape::Curve | StrokeShape::Spine => return curve(ui, editor, commands),
            }
        }
    }
    symmetry(ui, view.symmetry, commands);
    match view.tool {
        ToolMode::Correct => correction(ui, &view.correction_brush, commands),
        ToolMode::PaintStiffness => stiffness(ui, editor, &view.stiffness_brush, view.pressure, commands),
        _ => {}
    }
}

/// The points of curves.
fn curve(ui: &mut egui::Ui, editor: &Editor, commands: &mut Outbox) {
    if command_choice(ui, editor, &Command::ToggleChain, editor.view().chain) {
        commands.push(Command::ToggleChain);
    }
    for command in [
        Command::DivideCurve,
        Command::RemoveCurvePoints,
        Command::PinCurvePoints,
    ] {
        if command_button(ui, editor, &command) {
            commands.push(command);
        }
    }
}

/// Below this width, in points, the shapes are a list.
const ROOMY: f32 = 620.0;

fn stroke_shape(ui: &mut egui::Ui, editor: &Editor, commands: &mut Outbox) {
    const SHAPES: [StrokeShape; 8] = [
        StrokeShape::Brush,
        StrokeShape::Lasso,
        StrokeShape::Box,
        StrokeShape::Component,
        StrokeShape::Curve,
        StrokeShape::Spine,
        StrokeShape::Crease,
        StrokeShape::Sketch,
    ];
    let present = editor.view().stroke_shape;
    if ui.available_width() < ROOMY {
        let listed = SHAPES.iter().filter_map(|shape| {
            let listed = Command::SetStrokeShape(*shape).listed()?;
            Some((*shape, listed.name, listed.tooltip))
        });
        if let Some(shape) = list(ui, "Shape", present, &listed.collect::<Vec<_>>()) {
            commands.push(Command::SetStrokeShape(shape));
        }
        return;
    }
    ui.spacing_mut().item_spacing.x = 2.0;
    for shape in SHAPES {
        let command = Command::SetStrokeShape(shape);
        if command_choice(ui, editor, &command, present == shape) {
            commands.push(command);
        }
    }
    ui.spacing_mut().item_spacing.x = 8.0;
}

/// The brush's radius.
fn brush_radius(ui: &mut egui::Ui, mut radius_px: f64, commands: &mut Outbox) {
    let label = bar_label(ui, "Radius");
    let slider = number_field(ui, &mut radius_px, |ui, radius_px| {
        let slider = slid(ui, radius_px, 4.0..=200.0, &[("px", 1.0)]);
        ui.add(slider.suffix(" px").fixed_decimals(0))
    });
    let slider = slider
        .labelled_by(label.id)
        .on_hover_text("Sets the size of the brush; [ makes it smaller and ] larger.");
    if slider.changed() {
        commands.push(Command::SetBrushRadius(radius_px));
    }
}

/// The brush's radius, and the measure of distance from its centre.
fn brush(ui: &mut egui::Ui, radius_px: f64, metric: BrushMetric, commands: &mut Outbox) {
    brush_radius(ui, radius_px, commands);
    const METRICS: [(BrushMetric, &str, &str); 4] = [
        (
            BrushMetric::Round,
            "round limbs",
            "Closes round limbs that are thinner than the brush, and fills folds; other limbs behind stay unpainted.",
        ),
        (
            BrushMetric::Screen,
            "visible",
            "Paints everything under the brush that faces you.",
        ),
        (
            BrushMetric::Surface,
            "along surface",
            "Paints everything within the radius along the surface, into folds and around edges, visible or not.",
        ),
        (
            BrushMetric::Through,
            "through",
            "Paints everything under the brush, through to the back of the model.",
        ),
    ];
    if let Some(metric) = list(ui, "Depth", metric, &METRICS) {
        commands.push(Command::SetBrushMetric(metric));
    }
}

/// The depth of a lasso or a box in the model.
fn depth(ui: &mut egui::Ui, depth: Depth, commands: &mut Outbox) {
    const DEPTHS: [(Depth, &str, &str); 2] = [
        (Depth::Visible, "visible", "Paints only the visible surface."),
        (
            Depth::Through,
            "through",
            "Paints everything inside, through to the back of the model.",
        ),
    ];
    if let Some(depth) = list(ui, "Depth", depth, &DEPTHS) {
        commands.push(Command::SetDepth(depth));
    }
}

/// The plane across which both sides are painted.
fn symmetry(ui: &mut egui::Ui, symmetry: Symmetry, commands: &mut Outbox) {
    const PLANES: [(Symmetry, &str, &str); 5] = [
        (Symmetry::None, "off", "Paints and poses one side at a time."),
        (
            Symmetry::Found,
            "found",
            "Paints and poses both sides at once, across the shape's own plane of symmetry.",
        ),
        (Symmetry::Axis(0), "x", "Paints and poses left and right at once."),
        (Symmetry::Axis(1), "y", "Paints and poses above and below at once."),
        (Symmetry::Axis(2), "z", "Paints and poses front and back at once."),
    ];
    if let Some(symmetry) = list(ui, "Symmetry", symmetry, &PLANES) {
        commands.push(Command::SetSymmetry(symmetry));
    }
}

/// A name and a list of choices, each with its meaning; returns another one that is chosen.
fn list<T: Copy + PartialEq>(ui: &mut egui::Ui, name: &str, present: T, choices: &[(T, &str, &str)]) -> Option<T> {
    let label = bar_label(ui, name);
    let mut chosen = None;
    let word = choices.iter().find(|(choice, ..)| *choice == present);
    let shown = ComboBox::from_id_salt(name)
        .selected_text(word.map_or("", |(_, word, _)| word))
        .width(0.0)
        .show_ui(ui, |ui| {
            for (choice, word, meaning) in choices {
                let is_present = *choice == present;
                if ui.selectable_label(is_present, *word).on_hover_text(*meaning).clicked() && !is_present {
                    chosen = Some(*choice);
                }
            }
        });
    let meaning = word.map_or("", |(.., meaning)| meaning);
    shown.response.labelled_by(label.id).on_hover_text(meaning);
    chosen
}

fn correction(ui: &mut egui::Ui, brush: &CorrectionBrush, commands: &mut Outbox) {
    let mut changed = *brush;
    const CORRECTIONS: [(Correction, &str, &str); 3] = [
        (
            Correction::Smooth,
            "Smooth",
            "Smooths bumps and creases and keeps the volume. Shift smooths with every correction brush.",
        ),
        (
            Correction::Relax,
            "Relax",
            "Evens out the triangles and keeps the surface's shape.",
        ),
        (
            Correction::Grab,
            "Grab",
            "Drags the surface with the pointer and keeps the volume.",
        ),
    ];
    if let Some(correction) = choices(ui, brush.correction, &CORRECTIONS) {
        changed.correction = correction;
    }
    if changed.correction != Correction::Grab {
        share(ui, "Strength", &mut changed.strength, "Sets how strongly one dab acts.");
    }
    if changed != *brush {
        commands.push(Command::SetCorrection(changed));
    }
}

fn stiffness(ui: &mut egui::Ui, editor: &Editor, brush: &StiffnessBrush, pressure: Option<f64>, commands: &mut Outbox) {
    let mut changed = *brush;
    const ACTIONS: [(StiffnessAction, &str, &str); 4] = [
        (
            StiffnessAction::Paint,
            "Paint",
            "Changes the stiffness towards the value.",
        ),
        (StiffnessAction::Smooth, "Smooth", "Smooths the painted stiffness."),
        (
            StiffnessAction::Rigid,
            "Rigid",
            "Makes each painted part move as one body, with every method.",
        ),
        (
            StiffnessAction::Erase,
            "Erase",
            "Resets the stiffness to 1, like painting with Ctrl.",
        ),
    ];
    if let Some(action) = choices(ui, brush.action, &ACTIONS) {
        changed.action = action;
    }
    // Rigid or not: no number expresses it.
    if changed.action != StiffnessAction::Rigid {
        stiffness_value(ui, &mut changed);
    }
    ui.menu_button("More", |ui| {
        if changed.action != StiffnessAction::Rigid {
            egui::Grid::new("stiffness").num_columns(2).show(ui, |ui| {
                let says = "Sets the share of the way to the value that one stroke makes. A pen's pressure scales it.";
                share(ui, "Strength", &mut changed.strength, says);
                ui.end_row();
                let says = "Sets the brush's rim: 0 ends sharply, 1 fades from the middle.";
                share(ui, "Falloff", &mut changed.falloff, says);
                ui.end_row();
            });
        }
        if command_button(ui, editor, &Command::ClearStiffness) {
            commands.push(Command::ClearStiffness);
        }
        if pressure.is_some() {
            let pen = RichText::new("A pen's pressure scales the strength.");
            ui.label(pen.weak().small());
        }
    });
    if changed != *brush {
        commands.push(Command::SetStiffnessBrush(changed));
    }
}

/// The painted stiffness.
fn stiffness_value(ui: &mut egui::Ui, brush: &mut StiffnessBrush) {
    let label = bar_label(ui, "Value");
    let speed = 0.02 * brush.value;
    let field = number_field(ui, &mut brush.value, |ui, value| {
        let field = dragged(ui, value, &[]).range(STIFFNESS_RANGE).speed(speed);
        ui.add(field.max_decimals(3))
    });
    field
        .labelled_by(label.id)
        .on_hover_text("Sets the stiffness: 0.001 yields like cloth, 1 is the default, 1000 keeps its shape.");
}
