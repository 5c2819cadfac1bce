//! How long the editor takes for an event on a mesh of 400k triangles, and what a hundred strokes leave in memory.
//!
//! `cargo run --release -p pliant-app --example editor_times`: jobs run in between and are not counted, as in the window,
//! where they run on threads of their own; drawing and uploading are not in it.

#![allow(
    clippy::expect_used,
    clippy::print_stdout,
    reason = "a measurement fails by panicking and prints its table"
)]

use std::sync::Arc;
use std::time::{Duration, Instant};

use glam::{DQuat, DVec2, DVec3};
use pliant_editor::{
    BrushMetric, Button, Command, Depth, Editor, Event, HandleTransform, InlineExecutor, JobKind, Modifiers,
    ObjectAction, PivotPlace, Pointer, RegionAction, StiffnessAction, StiffnessBrush, StrokeShape, ToolMode,
};
use pliant_mesh::{Cancel, Model, Object, Progress, WeldOptions, shapes};

const SIZE_PX: DVec2 = DVec2::new(1280.0, 800.0);

struct Timed {
    editor: Editor,
    jobs: InlineExecutor,
    times: Vec<Duration>,
    binds: bool,
}

impl Timed {
    fn send(&mut self, event: Event) {
        let start = Instant::now();
        self.editor.handle(event);
        self.times.push(start.elapsed());
    }

    fn drain(&mut self) {
        let jobs = self.jobs.clone();
        let next = || {
            if self.binds {
                jobs.run_next()
            } else {
                jobs.run(JobKind::Pick)
            }
        };
        while let Some(done) = next() {
            self.editor.handle(Event::JobDone(done));
        }
    }

    fn stroke(&mut self, way: impl IntoIterator<Item = DVec2>) {
        let at = |position_px| Pointer {
            position_px,
            modifiers: Modifiers::NONE,
        };
        let mut last = DVec2::ZERO;
        for (number, position_px) in way.into_iter().enumerate() {
            last = position_px;
            if number == 0 {
                self.send(Event::PointerPressed(at(position_px), Button::Primary));
            }
            self.send(Event::PointerMoved(at(position_px)));
        }
        self.send(Event::PointerReleased(at(last), Button::Primary));
        self.drain();
    }

    fn command(&mut self, command: Command) {
        self.send(Event::Command(command));
        self.drain();
    }

    fn report(&mut self, what: &str) {
        let mut times = std::mem::take(&mut self.times);
        times.sort();
        let ms = |time: Duration| time.as_secs_f64() * 1e3;
        if let (Some(median), Some(longest)) = (times.get(times.len() / 2), times.last()) {
            println!(
                "{what:<44} median {:>7.2} ms, longest {:>7.2} ms",
                ms(*median),
                ms(*longest)
            );
        }
    }
}

fn line(from: DVec2, to: DVec2) -> impl Iterator<Item = DVec2> {
    (0..=30).map(move |step| from.lerp(to, f64::from(step) / 30.0))
}

fn main() {
    let drawn = shapes::uv_sphere(448, 448);
    let half = drawn.triangles.len() as u32 / 2;
    let objects = [0..half, half..2 * half].map(|triangles| Object {
        triangles: vec![triangles],
        ..Object::default()
    });
    let model = Model::weld(drawn, &WeldOptions::default(), &Progress::new(), &Cancel::new()).expect("it is whole");
    let model = model.with_objects(objects.into());
    println!(
        "{} vertices, {} triangles",
        model.surface.positions.len(),
        model.surface.triangles.len()
    );
    let jobs = InlineExecutor::new();
    let mut timed = Timed {
        editor: Editor::new(Box::new(jobs.clone())),
        jobs,
        times: Vec::new(),
        binds: true,
    };
    timed.editor.handle(Event::Viewport { size_px: SIZE_PX });
    timed.editor.handle(Event::Opened {
        model: Arc::new(model),
        name: "ball".to_owned(),
        beginning: None,
    });
    timed.drain();
    let middle = SIZE_PX * 0.5;
    let across = |y: f64| line(middle + DVec2::new(-150.0, y), middle + DVec2::new(150.0, y));

    for (metric, name) in [
        (BrushMetric::Screen, "as seen"),
        (BrushMetric::Surface, "along the surface"),
    ] {
        for radius_px in [30.0, 100.0] {
            timed.command(Command::SetBrushMetric(metric));
            timed.command(Command::SetBrushRadius(radius_px));
            timed.command(Command::SetTool(ToolMode::PaintFree));
            timed.times.clear();
            timed.stroke(across(radius_px));
            timed.report(&format!("painting {name}, radius {radius_px} px"));
            timed.command(Command::Undo);
            timed.report("undo of it");
        }
    }
    timed.command(Command::SetTool(ToolMode::PaintStiffness));
    for action in [StiffnessAction::Paint, StiffnessAction::Smooth] {
        timed.command(Command::SetStiffnessBrush(StiffnessBrush {
            action,
            ..StiffnessBrush::default()
        }));
        timed.command(Command::SetBrushRadius(40.0));
        timed.times.clear();
        timed.stroke(across(0.0));
        timed.report(&format!("stiffness, {action:?}, radius 40 px"));
    }
    timed.command(Command::Undo);
    timed.times.clear();
    timed.command(Command::Undo);
    timed.report("undo of stiffness");
    timed.command(Command::SetTool(ToolMode::PaintFixed));
    timed.command(Command::SetStrokeShape(StrokeShape::Lasso));
    for depth in [Depth::Visible, Depth::Through] {
        timed.command(Command::SetDepth(depth));
        timed.times.clear();
        let circle = (0..40).map(|step| {
            let angle = f64::from(step) / 40.0 * std::f64::consts::TAU;
            middle + DVec2::new(200.0 * angle.cos(), 200.0 * angle.sin())
        });
        timed.stroke(circle);
        timed.report(&format!("a lasso around most of it, {depth:?}"));
    }
    for action in [
        RegionAction::Grow,
        RegionAction::Shrink,
        RegionAction::SmoothBorder,
        RegionAction::Invert,
        RegionAction::EverythingBut,
        RegionAction::Mirror(0),
    ] {
        timed.times.clear();
        timed.command(Command::Region(action));
        timed.report(&format!("{action:?}"));
        timed.command(Command::Undo);
    }
    // Every other command that goes over the whole mesh, with a large handle that is moved.
    timed.command(Command::ClearRegions);
    timed.command(Command::SetTool(ToolMode::PaintHandle));
    timed.command(Command::SetStrokeShape(StrokeShape::Box));
    timed.command(Command::SetDepth(Depth::Visible));
    timed.stroke([middle - 180.0, middle + 60.0]);
    for (command, name) in [
        (Command::MakeTwin(2), "twin"),
        (Command::Undo, "undo of it"),
        (Command::DuplicateHandle, "split"),
        (Command::Undo, "undo of it"),
        (Command::FrameAll, "frame all"),
        (Command::FrameSelected, "frame selected"),
        (Command::FrameAll, "frame all"),
    ] {
        timed.times.clear();
        timed.command(command);
        timed.report(name);
    }
    let id = timed.editor.view().selected.expect("the box made a handle");
    let moved = HandleTransform::Trs {
        translation: DVec3::new(0.1, 0.0, 0.0),
        rotation: DQuat::IDENTITY,
        scale: DVec3::ONE,
        pivot: None,
    };
    for (command, name) in [
        (Command::SetPivotPlace(id, PivotPlace::Border), "pivot at the border"),
        (Command::SetHandleTransform(id, moved), "a move in numbers"),
        (Command::SetContinuity(id, Some(0.0)), "a hinge"),
        (Command::Undo, "undo of it"),
        (Command::Apply, "apply shape"),
        (Command::Undo, "undo of it"),
        (Command::ResetRegion, "reset region"),
        (Command::Undo, "undo of it"),
        (Command::Objects(ObjectAction::Lock, vec![0]), "lock half"),
        (Command::Undo, "undo of it"),
        (Command::Objects(ObjectAction::Hide, vec![0]), "hide half"),
        (Command::Undo, "undo of it"),
        (Command::ResetShape, "reset shape"),
        (Command::Undo, "undo of it"),
        (Command::DeleteHandle, "delete handle"),
        (Command::Undo, "undo of it"),
        (Command::GoToStep(0), "back to the first step"),
    ] {
        timed.times.clear();
        timed.command(command);
        timed.report(name);
    }
    timed.command(Command::ClearRegions);
    timed.command(Command::SetStrokeShape(StrokeShape::Brush));
    timed.command(Command::SetBrushMetric(BrushMetric::Screen));
    timed.command(Command::SetBrushRadius(30.0));
    // Nothing is bound between these strokes: only the pointer's structure is kept up.
    timed.binds = false;
    let before = timed.editor.history().bytes();
    for stroke in 0..100 {
        let tools = [
            ToolMode::PaintHandle,
            ToolMode::PaintFree,
            ToolMode::PaintFixed,
            ToolMode::PaintStiffness,
        ];
        timed.command(Command::SetTool(tools[stroke % 4]));
        timed.command(Command::SetStiffnessBrush(StiffnessBrush {
            value: 2.0 + stroke as f64,
            ..StiffnessBrush::default()
        }));
        timed.times.clear();
        timed.stroke(across(f64::from(stroke as u32 * 29 % 200) - 100.0));
    }
    let bytes = timed.editor.history().bytes() - before;
    println!(
        "a hundred strokes in the history: {:.1} MB",
        bytes as f64 / f64::from(1 << 20)
    );
    let steps = timed.editor.history().names().1;
    for (step, name) in [(steps - 100, "a hundred strokes back"), (steps, "and forth")] {
        timed.times.clear();
        timed.command(Command::GoToStep(step));
        timed.report(name);
    }
}
