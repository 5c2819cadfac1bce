//! The bar of the tool's settings under the bar of the view: the stroke's shape, the brush, and the stiffness that it
//! paints.

use eframe::egui::{self, Color32, ComboBox, RichText};
use pliant_editor::{
    BrushMetric, Command, Correction, CorrectionBrush, Depth, Editor, STIFFNESS_RANGE, StiffnessAction, StiffnessBrush,
    StrokeShape, Symmetry, ToolMode, stiffness_colour,
};

use crate::window::widgets::command_button::{choices_in_bar, command_button, command_choice};
use crate::window::widgets::name_before::name_before;
use crate::window::widgets::number_field::{dragged, number_field, slid};
use crate::window::widgets::outbox::Outbox;

/// The length of a slider, in points: the settings of most tools fit in one row of a small window.
const SLIDER: f32 = 84.0;

/// Shows the settings of the current tool.
pub fn show(ui: &mut egui::Ui, editor: &Editor, commands: &mut Outbox) {
    let view = editor.view();
    ui.spacing_mut().slider_width = SLIDER;
    ui.horizontal_wrapped(|ui| {
        if view.tool != ToolMode::Pose {
            stroke_shape(ui, editor, commands);
            ui.separator();
        }
        match view.stroke_shape {
            _ if view.tool == ToolMode::Pose => {}
            StrokeShape::Brush => brush(ui, view.brush_radius_px, view.brush_metric, commands),
            StrokeShape::Lasso | StrokeShape::Box => depth(ui, view.depth, commands),
            StrokeShape::Component => {}
        }
        symmetry(ui, view.symmetry, commands);
    });
    ui.horizontal_wrapped(|ui| match view.tool {
        ToolMode::Correct => correction(ui, &view.correction_brush, commands),
        ToolMode::PaintStiffness => stiffness(ui, editor, &view.stiffness_brush, view.pressure, commands),
        _ => {}
    });
}

fn stroke_shape(ui: &mut egui::Ui, editor: &Editor, commands: &mut Outbox) {
    ui.spacing_mut().item_spacing.x = 2.0;
    for shape in [
        StrokeShape::Brush,
        StrokeShape::Lasso,
        StrokeShape::Box,
        StrokeShape::Component,
    ] {
        let command = Command::SetStrokeShape(shape);
        if command_choice(ui, editor, &command, editor.view().stroke_shape == shape) {
            commands.push(command);
        }
    }
    ui.spacing_mut().item_spacing.x = 8.0;
}

/// The brush's radius, and the measure of distance from its centre.
fn brush(ui: &mut egui::Ui, mut radius_px: f64, metric: BrushMetric, commands: &mut Outbox) {
    let label = name_before(ui, "Radius");
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
    let label = name_before(ui, name);
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
    if let Some(correction) = choices_in_bar(ui, brush.correction, &CORRECTIONS) {
        changed.correction = correction;
    }
    if changed.correction != Correction::Grab {
        share(ui, "Strength", &mut changed.strength, "Sets how strongly one dab acts.");
    }
    if changed != *brush {
        commands.push(Command::SetCorrection(changed));
    }
}

/// A share from 0 to 1.
fn share(ui: &mut egui::Ui, name: &str, value: &mut f64, hover: &str) {
    let label = name_before(ui, name);
    let slider = number_field(ui, value, |ui, value| {
        let slider = slid(ui, value, 0.0..=1.0, &[]).fixed_decimals(2);
        ui.add(slider)
    });
    slider.labelled_by(label.id).on_hover_text(hover);
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
    if let Some(action) = choices_in_bar(ui, brush.action, &ACTIONS) {
        changed.action = action;
    }
    // Rigid or not: no number expresses it.
    if changed.action != StiffnessAction::Rigid {
        stiffness_numbers(ui, &mut changed);
    }
    if changed != *brush {
        commands.push(Command::SetStiffnessBrush(changed));
    }
    legend(ui);
    if command_button(ui, editor, &Command::ClearStiffness) {
        commands.push(Command::ClearStiffness);
    }
    if pressure.is_some() {
        let pen = RichText::new("A pen's pressure scales the strength.");
        ui.label(pen.weak().small());
    }
}

/// The painted stiffness, the strength of one stroke, and its falloff.
fn stiffness_numbers(ui: &mut egui::Ui, brush: &mut StiffnessBrush) {
    let label = name_before(ui, "Value");
    let speed = 0.02 * brush.value;
    let field = number_field(ui, &mut brush.value, |ui, value| {
        let field = dragged(ui, value, &[]).range(STIFFNESS_RANGE).speed(speed);
        ui.add(field.max_decimals(3))
    });
    field
        .labelled_by(label.id)
        .on_hover_text("Sets the stiffness: 0.001 yields like cloth, 1 is the default, 1000 keeps its shape.");
    let says = "Sets the share of the way to the value that one stroke makes. A pen's pressure scales it.";
    share(ui, "Strength", &mut brush.strength, says);
    let says = "Sets the brush's rim: 0 ends sharply, 1 fades from the middle.";
    share(ui, "Falloff", &mut brush.falloff, says);
}

/// The meaning of the colours: from 0.001 to 1000, and rigid.
fn legend(ui: &mut egui::Ui) {
    const SIZE: egui::Vec2 = egui::vec2(190.0, 24.0);
    const RIGID: f32 = 24.0;
    const BAR: f32 = 9.0;
    const STEPS: usize = 60;
    let (rect, _) = ui.allocate_exact_size(SIZE, egui::Sense::hover());
    let painter = ui.painter();
    let width = SIZE.x - RIGID - 16.0;
    let bar = rect.top()..=rect.top() + BAR;
    for step in 0..STEPS {
        let [from, to] = [step, step + 1].map(|step| rect.left() + width * step as f32 / STEPS as f32);
        let decades = 6.0 * (step as f64 + 0.5) / STEPS as f64 - 3.0;
        let [red, green, blue, _] = stiffness_colour(10_f64.powf(decades));
        let piece = egui::Rect::from_x_y_ranges(from..=to + 0.5, bar.clone());
        painter.rect_filled(piece, 0.0, Color32::from_rgb(red, green, blue));
    }
    let [red, green, blue, _] = stiffness_colour(f64::INFINITY);
    let rigid = egui::Rect::from_x_y_ranges(rect.right() - RIGID..=rect.right(), bar);
    painter.rect_filled(rigid, 0.0, Color32::from_rgb(red, green, blue));
    let font = egui::TextStyle::Small.resolve(ui.style());
    let colour = ui.visuals().weak_text_color();
    for (x, text, align) in [
        (rect.left(), "0.001", egui::Align2::LEFT_TOP),
        (rect.left() + 0.5 * width, "1", egui::Align2::CENTER_TOP),
        (rect.left() + width, "1000", egui::Align2::RIGHT_TOP),
        (rigid.center().x, "rigid", egui::Align2::CENTER_TOP),
    ] {
        let at = egui::pos2(x, rect.top() + BAR + 2.0);
        painter.text(at, align, text, font.clone(), colour);
    }
}
