//! One small picture of each mark that the editor draws over the surface, compared with a reference that a person has
//! checked: rims of regions, the brush's ring, gizmos, legends. Skipped by name if there is no graphics device.
//!
//! `PLIANT_KEEP_PICTURES=1 cargo test -p pliant-tests --test marks` makes the current pictures the references; look at
//! them.

#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    reason = "tests fail by panicking and say what they skip"
)]

#[path = "../../crates/render/tests/rig/golden.rs"]
mod golden;

use std::path::Path;
use std::sync::Arc;

use glam::DVec2;
use pliant_editor::{
    Button, Command, Editor, Event, GizmoMode, GizmoPart, HandleId, InlineExecutor, Modifiers, NamedView, Pointer,
    Reach, Shading, ToolMode,
};
use pliant_io::Appearance;
use pliant_mesh::{Cancel, Model, Progress, WeldOptions, shapes};
use pliant_picture::drawing::{self, Drawing, Field, Scale};
use pliant_picture::{legend, painting};
use pliant_render::{Frame, Headless, Image, Renderer, Samples};

/// The view's size in points, and the picture's pixels per point.
const VIEWPORT_PX: DVec2 = DVec2::new(480.0, 360.0);
const PIXELS_PER_POINT: f64 = 0.5;
const CENTRE_PX: DVec2 = DVec2::new(240.0, 180.0);

/// The program with a ball open, seen from the front, and its renderer.
struct Stage {
    editor: Editor,
    jobs: InlineExecutor,
    model: Arc<Model>,
    renderer: Renderer,
}

impl Stage {
    fn open() -> Option<Self> {
        let renderer = match Headless::new() {
            Ok(headless) => headless.renderer,
            Err(error) => {
                #[expect(clippy::print_stderr, reason = "a skipped test says so")]
                {
                    eprintln!("skipped: pictures ({error})");
                }
                return None;
            }
        };
        let drawn = shapes::icosphere(4);
        let model = Model::weld(drawn, &WeldOptions::default(), &Progress::new(), &Cancel::new()).unwrap();
        let jobs = InlineExecutor::new();
        let mut stage = Self {
            editor: Editor::new(Box::new(jobs.clone())),
            jobs,
            model: Arc::new(model),
            renderer,
        };
        stage.editor.handle(Event::Viewport { size_px: VIEWPORT_PX });
        stage.editor.handle(Event::Opened {
            model: Arc::clone(&stage.model),
            name: "a ball".to_owned(),
            beginning: None,
        });
        stage.command(Command::View(NamedView::Front));
        stage.drain();
        Some(stage)
    }

    fn drain(&mut self) {
        while let Some(done) = self.jobs.run_next() {
            self.editor.handle(Event::JobDone(done));
        }
    }

    fn command(&mut self, command: Command) {
        self.editor.handle(Event::Command(command));
        self.drain();
    }

    fn point_at(&mut self, position_px: DVec2) {
        self.editor.handle(Event::PointerMoved(at(position_px)));
    }

    fn paint(&mut self, tool: ToolMode, position_px: DVec2) {
        self.command(Command::SetTool(tool));
        self.point_at(position_px);
        self.editor
            .handle(Event::PointerPressed(at(position_px), Button::Primary));
        self.editor
            .handle(Event::PointerReleased(at(position_px), Button::Primary));
        self.drain();
    }

    /// A ball with a handle in the middle and no other marks: the pointer is away.
    fn with_handle(radius_px: f64) -> Option<Self> {
        let mut stage = Self::open()?;
        stage.command(Command::SetBrushRadius(radius_px));
        stage.paint(ToolMode::PaintHandle, CENTRE_PX);
        stage.editor.handle(Event::PointerLeft);
        Some(stage)
    }

    /// The view with its marks, as the window draws it.
    fn picture(&mut self) -> Image {
        let view = self.editor.view();
        let drawing = Drawing::new(&self.model, Appearance::default(), Default::default());
        let pose = drawing.pose(&self.model, view.displacements);
        let mut surface = drawing.upload(&self.renderer, &pose).unwrap();
        let mut colours = Vec::new();
        self.editor.region_colours(&mut colours);
        let colours = drawing::drawn_colours(&self.model, &colours);
        surface.update_regions(self.renderer.gpu(), &colours).unwrap();
        let outlines = drawing::outlines(&self.editor, &self.model);
        surface.update_lines(self.renderer.gpu(), &outlines).unwrap();
        let frame = Frame {
            view: &drawing::view(view.camera, view.viewport_px, drawing.centre()),
            style: &drawing::style(&view.look, PIXELS_PER_POINT as f32),
            surfaces: &[&surface],
            grid: None,
            overlays: &drawing::overlays(&view, drawing.centre(), PIXELS_PER_POINT as f32),
        };
        let size_px = (VIEWPORT_PX * PIXELS_PER_POINT).to_array().map(|side| side as u32);
        self.renderer.draw_to_image(size_px, Samples::Four, &frame).unwrap()
    }

    fn compare(&mut self, name: &str) {
        let image = self.picture();
        compare(&self.renderer, name, &image);
    }
}

fn at(position_px: DVec2) -> Pointer {
    Pointer {
        position_px,
        modifiers: Modifiers::NONE,
    }
}

fn compare(renderer: &Renderer, name: &str, image: &Image) {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("golden");
    golden::compare(renderer, &folder, name, image);
}

#[test]
fn a_handle_is_outlined_on_any_shading() {
    let Some(mut stage) = Stage::with_handle(60.0) else {
        return;
    };
    stage.command(Command::SetReach(HandleId(0), Reach::Length(0.0)));
    stage.command(Command::Deselect);
    stage.compare("rim-of-handle");
    stage.command(Command::SetShading(Shading::Zebra));
    stage.compare("rim-on-zebra");
}

#[test]
fn the_line_where_the_free_region_meets_what_is_held_is_drawn() {
    let Some(mut stage) = Stage::open() else { return };
    stage.command(Command::SetBrushRadius(80.0));
    stage.paint(ToolMode::PaintFree, CENTRE_PX);
    stage.editor.handle(Event::PointerLeft);
    stage.compare("rim-of-held");
}

#[test]
fn the_brush_s_ring_lies_on_the_surface() {
    let Some(mut stage) = Stage::open() else { return };
    stage.command(Command::SetTool(ToolMode::PaintHandle));
    stage.command(Command::SetBrushRadius(60.0));
    // Near the ball's silhouette, where the ring tilts with the surface.
    stage.point_at(CENTRE_PX + DVec2::new(70.0, -40.0));
    stage.compare("brush-ring");
}

#[test]
fn every_gizmo() {
    let Some(mut stage) = Stage::with_handle(24.0) else {
        return;
    };
    stage.command(Command::View(NamedView::ThreeQuarter));
    // It is faded while a brush is active.
    stage.command(Command::SetTool(ToolMode::Select));
    for (mode, name) in [
        (GizmoMode::Move, "gizmo-move"),
        (GizmoMode::Turn, "gizmo-turn"),
        (GizmoMode::Scale, "gizmo-scale"),
    ] {
        stage.command(Command::SetGizmo(mode));
        stage.compare(name);
    }
    // The part under the pointer is brighter: here the square that moves in a plane.
    stage.command(Command::SetGizmo(GizmoMode::Move));
    let square = stage
        .editor
        .view()
        .gizmo
        .iter()
        .find(|shape| shape.part == GizmoPart::Square(2))
        .unwrap();
    let corners: Vec<_> = square.triangles.iter().flatten().copied().collect();
    let middle = corners.iter().sum::<glam::DVec3>() / corners.len() as f64;
    let position_px = stage.editor.view().camera.project(middle, VIEWPORT_PX).unwrap();
    stage.point_at(position_px);
    stage.compare("gizmo-plane");
}

#[test]
fn a_gizmo_keeps_its_size_however_far_it_is() {
    let Some(mut stage) = Stage::with_handle(24.0) else {
        return;
    };
    stage.command(Command::SetGizmo(GizmoMode::Move));
    let extent = |stage: &Stage| {
        let view = stage.editor.view();
        let lines = view.gizmo.iter().flat_map(|shape| &shape.lines).flatten();
        let seen: Vec<DVec2> = lines.map(|&p| view.camera.project(p, VIEWPORT_PX).unwrap()).collect();
        let low = seen.iter().copied().reduce(DVec2::min).unwrap();
        let high = seen.iter().copied().reduce(DVec2::max).unwrap();
        high - low
    };
    let near = extent(&stage);
    for _ in 0..6 {
        stage.editor.handle(Event::Wheel {
            pointer: at(CENTRE_PX),
            lines: -1.0,
        });
    }
    let far = extent(&stage);
    assert!((near - far).length() < 0.05 * near.length(), "{near} {far}");
    stage.compare("gizmo-far");
}

#[test]
fn legends() {
    let Some(stage) = Stage::open() else { return };
    for (field, name) in [
        (Field::Stretch, "legend-stretch"),
        (Field::Curvature, "legend-curvature"),
    ] {
        let mut image = Image {
            width: 100,
            height: 140,
            rgba: [72, 76, 82, 255].repeat(100 * 140),
        };
        let scale = Scale::of(field, &stage.model);
        let legend = legend::picture(&stage.renderer, &scale, 0.6).unwrap();
        painting::composite(&mut image, &legend, [3; 2]);
        compare(&stage.renderer, name, &image);
    }
}
