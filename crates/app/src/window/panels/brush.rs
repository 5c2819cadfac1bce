//! The settings of the tool: the stroke's shape, the brush, and the stiffness that it paints.

use eframe::egui::{self, Color32, DragValue, RichText, Slider};
use pliant_editor::{
    BrushMetric, Command, Correction, CorrectionBrush, Depth, Editor, STIFFNESS_RANGE, StiffnessAction, StiffnessBrush,
    StrokeShape, Symmetry, ToolMode, stiffness_colour,
};

use crate::window::widgets::command_button::{choices, command_button, command_choice};
use crate::window::widgets::number_field::number_field;
use crate::window::widgets::outbox::Outbox;
use crate::window::widgets::row_label::row_label;

/// Shows the settings of the current tool.
pub fn show(ui: &mut egui::Ui, editor: &Editor, commands: &mut Outbox) {
    let view = editor.view();
    ui.horizontal_wrapped(|ui| {
        for shape in [
            StrokeShape::Brush,
            StrokeShape::Lasso,
            StrokeShape::Box,
            StrokeShape::Component,
        ] {
            let command = Command::SetStrokeShape(shape);
            if command_choice(ui, editor, &command, view.stroke_shape == shape) {
                commands.push(command);
            }
        }
    });
    egui::Grid::new("brush")
        .num_columns(2)
        .spacing([8.0, 4.0])
        .show(ui, |ui| match view.stroke_shape {
            StrokeShape::Brush => brush_rows(ui, view.brush_radius_px, view.brush_metric, commands),
            StrokeShape::Lasso | StrokeShape::Box => depth_row(ui, view.depth, commands),
            StrokeShape::Component => {}
        });
    egui::Grid::new("symmetry")
        .num_columns(2)
        .spacing([8.0, 4.0])
        .show(ui, |ui| symmetry_row(ui, view.symmetry, commands));
    if view.tool == ToolMode::Correct {
        ui.add_space(4.0);
        correction(ui, &view.correction_brush, commands);
    }
    if view.tool == ToolMode::PaintStiffness {
        ui.add_space(4.0);
        stiffness(ui, editor, &view.stiffness_brush, view.pressure, commands);
    }
}

/// The brush's radius, and the measure of distance from its centre.
fn brush_rows(ui: &mut egui::Ui, mut radius_px: f64, metric: BrushMetric, commands: &mut Outbox) {
    let label = row_label(ui, "Radius");
    let slider = number_field(ui, &mut radius_px, |ui, radius_px| {
        let slider = Slider::new(radius_px, 4.0..=200.0).suffix(" px").fixed_decimals(0);
        ui.add(slider.update_while_editing(false))
    });
    let slider = slider
        .labelled_by(label.id)
        .on_hover_text("Sets the size of the brush; [ makes it smaller and ] larger.");
    if slider.changed() {
        commands.push(Command::SetBrushRadius(radius_px));
    }
    ui.end_row();
    row_label(ui, "Depth");
    const METRICS: [(BrushMetric, &str, &str); 3] = [
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
    if let Some(metric) = choices(ui, metric, &METRICS) {
        commands.push(Command::SetBrushMetric(metric));
    }
    ui.end_row();
}

/// The depth of a lasso or a box in the model.
fn depth_row(ui: &mut egui::Ui, depth: Depth, commands: &mut Outbox) {
    row_label(ui, "Depth");
    const DEPTHS: [(Depth, &str, &str); 2] = [
        (Depth::Visible, "visible", "Paints only the visible surface."),
        (
            Depth::Through,
            "through",
            "Paints everything inside, through to the back of the model.",
        ),
    ];
    if let Some(depth) = choices(ui, depth, &DEPTHS) {
        commands.push(Command::SetDepth(depth));
    }
    ui.end_row();
}

/// The plane across which both sides are painted.
fn symmetry_row(ui: &mut egui::Ui, symmetry: Symmetry, commands: &mut Outbox) {
    row_label(ui, "Symmetry");
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
    if let Some(symmetry) = choices(ui, symmetry, &PLANES) {
        commands.push(Command::SetSymmetry(symmetry));
    }
    ui.end_row();
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
        egui::Grid::new("correction")
            .num_columns(2)
            .spacing([8.0, 4.0])
            .show(ui, |ui| {
                share_row(ui, "Strength", &mut changed.strength, "Sets how strongly one dab acts.")
            });
    }
    if changed != *brush {
        commands.push(Command::SetCorrection(changed));
    }
}

/// A share from 0 to 1.
fn share_row(ui: &mut egui::Ui, name: &str, value: &mut f64, hover: &str) {
    let label = row_label(ui, name);
    let slider = number_field(ui, value, |ui, value| {
        let slider = Slider::new(value, 0.0..=1.0).fixed_decimals(2);
        ui.add(slider.update_while_editing(false))
    });
    slider.labelled_by(label.id).on_hover_text(hover);
    ui.end_row();
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
        stiffness_rows(ui, &mut changed);
    }
    if changed != *brush {
        commands.push(Command::SetStiffnessBrush(changed));
    }
    legend(ui);
    ui.horizontal(|ui| {
        if command_button(ui, editor, &Command::ClearStiffness) {
            commands.push(Command::ClearStiffness);
        }
        let pen = match pressure {
            Some(_) => "A pen's pressure scales the strength.",
            None => "No pen pressure is reported.",
        };
        ui.label(RichText::new(pen).weak().small());
    });
}

/// The painted stiffness, the strength of one stroke, and its falloff.
fn stiffness_rows(ui: &mut egui::Ui, brush: &mut StiffnessBrush) {
    egui::Grid::new("stiffness")
        .num_columns(2)
        .spacing([8.0, 4.0])
        .show(ui, |ui| {
            let label = row_label(ui, "Value");
            let speed = 0.02 * brush.value;
            let field = number_field(ui, &mut brush.value, |ui, value| {
                let field = DragValue::new(value).range(STIFFNESS_RANGE).speed(speed);
                ui.add(field.max_decimals(3).update_while_editing(false))
            });
            field
                .labelled_by(label.id)
                .on_hover_text("Sets the stiffness: 0.001 yields like cloth, 1 is the default, 1000 keeps its shape.");
            ui.end_row();
            for (name, value, hover) in [
                (
                    "Strength",
                    &mut brush.strength,
                    "Sets the share of the way to the value that one stroke makes.",
                ),
                (
                    "Falloff",
                    &mut brush.falloff,
                    "Sets the brush's rim: 0 ends sharply, 1 fades from the middle.",
                ),
            ] {
                share_row(ui, name, value, hover);
            }
        });
}

/// The meaning of the colours: from 0.001 to 1000, and rigid.
fn legend(ui: &mut egui::Ui) {
    let width = (ui.available_width() - 40.0).min(240.0);
    let (rect, _) = ui.allocate_exact_size(egui::vec2(width, 10.0), egui::Sense::hover());
    const STEPS: usize = 60;
    for step in 0..STEPS {
        let [from, to] = [step, step + 1].map(|step| rect.left() + width * step as f32 / STEPS as f32);
        let decades = 6.0 * (step as f64 + 0.5) / STEPS as f64 - 3.0;
        let [red, green, blue, _] = stiffness_colour(10_f64.powf(decades));
        let bar = egui::Rect::from_x_y_ranges(from..=to + 0.5, rect.y_range());
        ui.painter().rect_filled(bar, 0.0, Color32::from_rgb(red, green, blue));
    }
    let font = egui::TextStyle::Small.resolve(ui.style());
    let colour = ui.visuals().weak_text_color();
    let (labels, _) = ui.allocate_exact_size(egui::vec2(width, 12.0), egui::Sense::hover());
    for (share, text, align) in [
        (0.0, "0.001", egui::Align2::LEFT_TOP),
        (0.5, "1", egui::Align2::CENTER_TOP),
        (1.0, "1000", egui::Align2::RIGHT_TOP),
    ] {
        let at = egui::pos2(labels.left() + width * share, labels.top());
        ui.painter().text(at, align, text, font.clone(), colour);
    }
    let [red, green, blue, _] = stiffness_colour(f64::INFINITY);
    let swatch = egui::Rect::from_min_size(
        egui::pos2(rect.right() + 10.0, rect.top()),
        egui::vec2(22.0, rect.height()),
    );
    ui.painter()
        .rect_filled(swatch, 0.0, Color32::from_rgb(red, green, blue));
    let at = egui::pos2(swatch.center().x, labels.top());
    ui.painter().text(at, egui::Align2::CENTER_TOP, "rigid", font, colour);
}
