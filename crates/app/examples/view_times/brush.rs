//! Brush strokes across the mesh: the time that a pointer event occupies the window's thread until the new colours are
//! queued for the device.

use std::sync::Arc;

use glam::{DVec2, DVec3};
use pliant_editor::{
    BrushMetric, Button, Command, Editor, Event, InlineExecutor, JobKind, Modifiers, Pointer, ToolMode,
};
use pliant_mesh::Model;
use pliant_picture::drawing::{self, Drawing};
use pliant_render::{RenderError, Renderer, Surface};

use crate::{SIZE_PX, median, timed};

/// One row per brush: members of a JSON object.
pub fn rows(
    model: &Arc<Model>,
    drawing: &Drawing,
    renderer: &Renderer,
    surface: &mut Surface,
) -> Result<Vec<String>, RenderError> {
    let rest = vec![DVec3::ZERO; model.surface.positions.len()];
    surface.update_shape(renderer.gpu(), &drawing.pose(model, &rest).data())?;
    let jobs = InlineExecutor::new();
    let mut editor = Editor::new(Box::new(jobs.clone()));
    let size_px = DVec2::new(f64::from(SIZE_PX[0]), f64::from(SIZE_PX[1]));
    editor.handle(Event::Viewport { size_px });
    editor.handle(Event::Opened {
        model: Arc::clone(model),
        name: "ring".to_owned(),
        beginning: None,
    });
    let mut rows = Vec::new();
    for (tool, metric, name) in [
        (ToolMode::PaintFree, BrushMetric::Screen, "front"),
        (ToolMode::PaintFree, BrushMetric::Through, "through"),
        (ToolMode::PaintFree, BrushMetric::Surface, "along"),
        (ToolMode::PaintStiffness, BrushMetric::Screen, "stiffness"),
    ] {
        for radius_px in [30.0, 100.0] {
            editor.handle(Event::Command(Command::SetTool(tool)));
            editor.handle(Event::Command(Command::SetBrushMetric(metric)));
            editor.handle(Event::Command(Command::SetBrushRadius(radius_px)));
            while let Some(done) = jobs.run(JobKind::Pick) {
                editor.handle(Event::JobDone(done));
            }
            let mut by_surface = Vec::new();
            editor.region_colours(&mut by_surface);
            let mut colours = drawing::drawn_colours(model, &by_surface);
            surface.update_regions(renderer.gpu(), &colours)?;
            let (mut handling, mut colouring, mut whole) = (Vec::new(), Vec::new(), Vec::new());
            let mut vertices = 0;
            for event in stroke(&editor, model) {
                let known = editor.view().regions_revision;
                let is_dab = matches!(event, Event::PointerMoved(_));
                let (ms, ()) = timed(|| editor.handle(event));
                let (colour_ms, uploaded) = timed(|| match editor.recoloured_since(known) {
                    Some(recoloured) => {
                        vertices += recoloured.len();
                        let ranges = drawing::recolour(model, recoloured, editor.region_colour(), &mut colours);
                        surface.update_some_regions(renderer.gpu(), &colours, &ranges)
                    }
                    None => {
                        editor.region_colours(&mut by_surface);
                        colours = drawing::drawn_colours(model, &by_surface);
                        surface.update_regions(renderer.gpu(), &colours)
                    }
                });
                uploaded?;
                if is_dab {
                    handling.push(ms);
                    colouring.push(colour_ms);
                }
                whole.push(ms + colour_ms);
            }
            let longest = whole.iter().copied().fold(0.0, f64::max);
            let end = whole.last().copied().unwrap_or_default();
            rows.push(format!(
                "\"brush\": \"{name}\", \"radius_px\": {radius_px}, \"dab_ms\": {:.2}, \"colour_ms\": {:.2}, \
                 \"longest_ms\": {longest:.1}, \"letting_go_ms\": {end:.1}, \"vertices\": {vertices}",
                median(handling),
                median(colouring),
            ));
            editor.handle(Event::Command(Command::Undo));
        }
    }
    Ok(rows)
}

/// A press at the place of the mesh nearest to the eye, thirty moves of ten points back and forth, and a release.
fn stroke(editor: &Editor, model: &Model) -> Vec<Event> {
    let view = editor.view();
    let eye = view.camera.eye();
    let towards = |p: &DVec3| eye.distance_squared(*p);
    let positions = model.surface.positions.iter();
    let nearest = positions.min_by(|a, b| towards(a).total_cmp(&towards(b)));
    let middle_px = nearest.and_then(|&p| view.camera.project(p, view.viewport_px));
    let at = |step: u32| Pointer {
        position_px: middle_px.unwrap_or_default() + DVec2::X * 10.0 * (f64::from(step) - 15.0).abs(),
        modifiers: Modifiers::NONE,
    };
    let mut events = vec![Event::PointerPressed(at(15), Button::Primary)];
    events.extend((0..=30).map(|step| Event::PointerMoved(at(step))));
    events.push(Event::PointerReleased(at(30), Button::Primary));
    events
}
