//! The time that the window's thread is busy, and the time of a drag from the pointer to the GPU's buffers: one JSON
//! object a line.
//!
//! `cargo run --release -p pliant-app --example window_times -- FILE [REACH]`: opens FILE in the whole application
//! without a display, paints a handle on its highest part, drags it for 60 pointer moves and runs the menus' commands.
//! Drawing itself is left out, because a software device draws on the processor.

#![allow(
    clippy::expect_used,
    clippy::print_stdout,
    reason = "a measurement fails by panicking and prints its table"
)]

use std::time::{Duration, Instant};

use egui::{Event, Key, Modifiers, PointerButton, Pos2, pos2, vec2};
use egui_kittest::Harness;
use glam::DVec3;
use pliant_app::window::{Application, Source};
use pliant_deform::{Bilaplacian, Method};
use pliant_editor::{Command, CutPlane, KeptSide, MeshChange, ObjectAction, Paint, Reach, RegionAction, Shading};

struct Session {
    harness: Harness<'static, Application>,
}

impl Session {
    fn settle(&mut self) {
        self.harness.step();
        while !self.harness.state().is_settled() {
            std::thread::sleep(Duration::from_millis(1));
            self.harness.step();
        }
    }

    fn move_to(&mut self, position: Pos2) {
        self.harness.event(Event::PointerMoved(position));
    }

    fn press(&mut self, position: Pos2, pressed: bool) {
        let (button, modifiers) = (PointerButton::Primary, Modifiers::NONE);
        self.harness.event(Event::PointerButton {
            pos: position,
            button,
            pressed,
            modifiers,
        });
        self.harness.step();
    }

    /// Returns true if the shape in the buffers has the handle at the pointer's place: an earlier move's result does
    /// not.
    fn shows_handle(&self, size: f64) -> bool {
        let application = self.harness.state();
        let document = application.editor().document();
        let held = |paint: &Paint| matches!(paint, Paint::Handle(_));
        let (Some(shown), Some(vertex), [handle, ..], Some(model)) = (
            application.shown_displacements(),
            document.paint().iter().position(held),
            document.handles(),
            application.editor().view().model,
        ) else {
            return false;
        };
        let rest = model.surface.positions[vertex];
        let wanted = handle.affine().transform_point3(rest) - rest;
        shown[vertex].distance(wanted) < 1e-9 * size
    }

    fn longest(&mut self, what: &str) {
        let longest = self.harness.state_mut().take_longest_frame();
        println!("{{\"doing\": \"{what}\", \"longest_frame_ms\": {:.1}}}", ms(longest));
    }
}

fn ms(duration: Duration) -> f64 {
    duration.as_secs_f64() * 1e3
}

fn main() {
    let file = std::env::args_os().nth(1).expect("give a file");
    let harness = Harness::builder()
        .with_size(vec2(1280.0, 800.0))
        .with_max_steps(64)
        .wgpu()
        .build_eframe(|context| Application::new(context, Source::File(file.into())).expect("a graphics device"));
    let mut session = Session { harness };
    session.settle();
    session.longest("opening");

    let (top, vertex_count, size) = {
        let application = session.harness.state();
        let view = application.editor().view();
        let positions = &view.model.expect("the file opened").surface.positions;
        let highest = positions
            .iter()
            .max_by(|a, b| a.y.total_cmp(&b.y))
            .expect("the file has vertices");
        let seen = view.camera.project(*highest, view.viewport_px).expect("it is framed");
        let corner = application.view_rect().min;
        let size = view
            .model
            .and_then(|model| model.bounds())
            .expect("it has vertices")
            .diagonal();
        (
            pos2(corner.x + seen.x as f32, corner.y + seen.y as f32 + 8.0),
            positions.len(),
            size,
        )
    };
    session.move_to(top);
    session.harness.step();
    session.press(top, true);
    for step in 1..=8 {
        session.move_to(top + vec2(0.0, 2.0 * step as f32));
        session.harness.step();
    }
    session.press(top + vec2(0.0, 16.0), false);
    session.longest("painting a handle");
    let start = Instant::now();
    session.settle();
    let bound_ms = ms(start.elapsed());
    session.longest("while it binds");

    // The second argument (a share of the diagonal) sets how much of the surface comes along.
    if let Some(reach) = std::env::args().nth(2).and_then(|share| share.parse::<f64>().ok()) {
        let application = session.harness.state_mut();
        let handle = application
            .editor()
            .document()
            .handles()
            .first()
            .expect("the stroke made a handle")
            .id;
        application.command(Command::SetReach(handle, Reach::Length(reach * size)));
        session.settle();
        session.longest("widening the region");
    }
    session.harness.key_press(Key::G);
    session.harness.step();
    let mut latencies = Vec::new();
    for step in 1..=60 {
        let drawn_before = session.harness.state().drawing_time();
        let start = Instant::now();
        session.move_to(top + vec2(1.5 * step as f32, -(step as f32)));
        session.harness.step();
        while !session.shows_handle(size) {
            assert!(
                start.elapsed() < Duration::from_secs(20),
                "the surface does not follow move {step}: {}",
                session.harness.state().editor().view().status
            );
            session.harness.step();
        }
        let drawing = session.harness.state().drawing_time() - drawn_before;
        latencies.push(start.elapsed().saturating_sub(drawing));
    }
    session.longest("dragging");
    session.harness.key_press(Key::Enter);
    session.settle();
    let free = session.harness.state().editor().view().counts.free;
    session.harness.key_press_modifiers(Modifiers::COMMAND, Key::Z);
    session.settle();
    session.longest("committing and undoing");
    menus(&mut session);
    mesh_changes(&mut session);
    latencies.sort();
    println!(
        "{{\"vertices\": {vertex_count}, \"free\": {}, \"region_and_bind_ms\": {bound_ms:.1}, \"pointer_to_buffers_ms\": {:.2}, \"p95_ms\": {:.2}}}",
        free,
        ms(latencies[30]),
        ms(latencies[57])
    );
}

/// Changes of the mesh, undone and redone: a cut through the middle, then the hole filled.
fn mesh_changes(session: &mut Session) {
    let application = session.harness.state();
    let model = application.editor().view().model.expect("a file is open");
    let middle = model.bounds().expect("it has vertices").centre();
    let plane = CutPlane {
        normal: DVec3::Y,
        distance: middle.y,
    };
    let cut = Command::ChangeMesh(MeshChange::Cut(plane, KeptSide::Negative, Vec::new()));
    for (command, name) in [(cut, "cut"), (Command::FillHoles, "fill")] {
        let steps = [
            (command, ""),
            (Command::Undo, "undo of a "),
            (Command::Redo, "redo of a "),
        ];
        for (command, of) in steps {
            session.harness.state_mut().take_longest_frame();
            session.harness.state_mut().command(command);
            session.settle();
            session.longest(&format!("{of}{name}"));
        }
    }
}

/// Every kind of command in a menu, each until all its jobs have ended.
fn menus(session: &mut Session) {
    let commands = [
        Command::Region(RegionAction::Grow),
        Command::Region(RegionAction::Invert),
        Command::Undo,
        Command::Region(RegionAction::EverythingBut),
        Command::Undo,
        Command::Redo,
        Command::Undo,
        Command::MakeTwin(0),
        Command::Undo,
        Command::DuplicateHandle,
        Command::Undo,
        Command::SetShading(Shading::Material),
        Command::SetShading(Shading::Curvature),
        Command::SetShading(Shading::Zebra),
        Command::SetShading(Shading::Clay),
        Command::ToggleFlat,
        Command::ToggleWireframe,
        Command::ToggleWireframe,
        Command::ToggleFlat,
        Command::ToggleBorders,
        Command::ToggleRegions,
        Command::ToggleRegions,
        Command::FrameSelected,
        Command::FrameAll,
        Command::Objects(ObjectAction::Lock, vec![0]),
        Command::Undo,
        Command::Objects(ObjectAction::Hide, vec![0]),
        Command::Undo,
        Command::SetMethod(Method::from(Bilaplacian::default())),
        Command::Apply,
        Command::ResetShape,
        Command::ClearRegions,
        Command::GoToStep(0),
    ];
    let mut longest: Vec<(Duration, String)> = Vec::new();
    for command in commands {
        let name = format!("{command:?}");
        session.harness.state_mut().take_longest_frame();
        session.harness.state_mut().command(command);
        session.settle();
        longest.push((session.harness.state_mut().take_longest_frame(), name));
    }
    session.harness.state_mut().command(Command::CompareMethods);
    session.settle();
    longest.push((
        session.harness.state_mut().take_longest_frame(),
        "views of all methods".to_owned(),
    ));
    longest.sort();
    for (time, name) in longest.iter().rev().take(6) {
        println!("{{\"doing\": \"{name}\", \"longest_frame_ms\": {:.1}}}", ms(*time));
    }
}
