//! The time that the editor takes for an event on a mesh of 400k triangles, and the memory that a hundred strokes keep:
//! one JSON object a line.
//!
//! `cargo run --release -p pliant-app --example editor_times`: every stroke and command is done [`ROUNDS`] times. Jobs
//! run in between and are not counted, as in the window, where they run on threads of their own; drawing and uploading
//! are not included.

#![allow(
    clippy::expect_used,
    clippy::print_stdout,
    reason = "a measurement fails by panicking and prints its table"
)]

use std::sync::Arc;
use std::time::{Duration, Instant};

use glam::{DQuat, DVec2, DVec3};
use pliant_deform::{Bilaplacian, Method};
use pliant_editor::{
    BrushMetric, Button, Command, Depth, Editor, Event, HandleTransform, InlineExecutor, JobKind, Modifiers,
    ObjectAction, PivotPlace, Pointer, RegionAction, StiffnessAction, StiffnessBrush, StrokeShape, ToolMode,
};
use pliant_mesh::{Cancel, Model, Object, Progress, WeldOptions, shapes};

const SIZE_PX: DVec2 = DVec2::new(1280.0, 800.0);
const ROUNDS: usize = 3;

struct Timed {
    editor: Editor,
    jobs: InlineExecutor,
    times: Vec<Duration>,
    /// The timed actions, in the order in which they first came.
    noted: Vec<(String, Vec<Duration>)>,
    binds: bool,
}

impl Timed {
    fn send(&mut self, event: Event) {
        let start = Instant::now();
        self.editor.handle(event);
        self.times.push(start.elapsed());
    }

    fn drain(&mut self) {
        let (jobs, binds) = (self.jobs.clone(), self.binds);
        let next = || {
            if binds {
                jobs.run_next()
            } else {
                jobs.run(JobKind::Pick)
            }
        };
        while let Some(done) = next() {
            // Taking a result is the window's work, too.
            self.send(Event::JobDone(done));
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

    /// Keeps the times since the last note under a name.
    fn note(&mut self, what: &str) {
        let times = std::mem::take(&mut self.times);
        match self.noted.iter_mut().find(|(known, _)| known == what) {
            Some((_, all)) => all.extend(times),
            None => self.noted.push((what.to_owned(), times)),
        }
    }

    /// Does one thing and keeps its time.
    fn time(&mut self, what: &str, command: Command) {
        self.times.clear();
        self.command(command);
        self.note(what);
    }

    fn report(&mut self) {
        for (what, mut times) in std::mem::take(&mut self.noted) {
            times.sort();
            if let (Some(median), Some(longest)) = (times.get(times.len() / 2), times.last()) {
                println!(
                    "{{\"event\": \"{what}\", \"times\": {}, \"median_ms\": {:.3}, \"longest_ms\": {:.2}}}",
                    times.len(),
                    ms(*median),
                    ms(*longest)
                );
            }
        }
    }

    /// The file again, before any edit.
    fn open(&mut self, model: &Arc<Model>) {
        self.editor.handle(Event::Opened {
            model: Arc::clone(model),
            name: "ball".to_owned(),
            beginning: None,
        });
        self.drain();
    }
}

fn ms(time: Duration) -> f64 {
    time.as_secs_f64() * 1e3
}

/// The memory that the process holds, in megabytes, if the system reports it.
fn resident_mb() -> Option<f64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find_map(|line| line.strip_prefix("VmRSS:"))?;
    let kilobytes: f64 = line.trim().trim_end_matches("kB").trim().parse().ok()?;
    Some(kilobytes / 1024.0)
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
    let model = Arc::new(model.with_objects(objects.into()));
    let jobs = InlineExecutor::new();
    let mut timed = Timed {
        editor: Editor::new(Box::new(jobs.clone())),
        jobs,
        times: Vec::new(),
        noted: Vec::new(),
        binds: true,
    };
    timed.editor.handle(Event::Viewport { size_px: SIZE_PX });
    // This comes first, while there is no freed memory that would be used again.
    hundred_strokes(&mut timed, &model);
    timed.binds = true;
    timed.open(&model);
    // Jobs are not counted, so this takes the fastest method.
    timed.command(Command::SetMethod(Method::from(Bilaplacian::default())));
    for _ in 0..ROUNDS {
        strokes(&mut timed);
        regions(&mut timed);
        handles(&mut timed);
        timed.command(Command::GoToStep(1));
    }
    timed.report();
}

fn across(y: f64) -> impl Iterator<Item = DVec2> {
    let middle = SIZE_PX * 0.5;
    line(middle + DVec2::new(-150.0, y), middle + DVec2::new(150.0, y))
}

/// Painting with every kind of brush, and undoing it.
fn strokes(timed: &mut Timed) {
    timed.command(Command::SetStrokeShape(StrokeShape::Brush));
    for (metric, name) in [
        (BrushMetric::Screen, "visible"),
        (BrushMetric::Surface, "along surface"),
        (BrushMetric::Through, "through"),
    ] {
        for radius_px in [30.0, 100.0] {
            timed.command(Command::SetBrushMetric(metric));
            timed.command(Command::SetBrushRadius(radius_px));
            timed.command(Command::SetTool(ToolMode::PaintFree));
            timed.times.clear();
            timed.stroke(across(radius_px));
            timed.note(&format!("painting {name}, radius {radius_px} px"));
            timed.time("undo of painting", Command::Undo);
        }
    }
    timed.command(Command::SetBrushMetric(BrushMetric::Screen));
    timed.command(Command::SetTool(ToolMode::PaintStiffness));
    for action in [StiffnessAction::Paint, StiffnessAction::Smooth] {
        timed.command(Command::SetStiffnessBrush(StiffnessBrush {
            action,
            ..StiffnessBrush::default()
        }));
        timed.command(Command::SetBrushRadius(40.0));
        timed.times.clear();
        timed.stroke(across(0.0));
        timed.note(&format!("stiffness, {action:?}, radius 40 px"));
    }
    timed.command(Command::Undo);
    timed.time("undo of stiffness", Command::Undo);
}

/// A lasso around most of it, and the commands for the region as a whole.
fn regions(timed: &mut Timed) {
    timed.command(Command::SetTool(ToolMode::PaintFixed));
    timed.command(Command::SetStrokeShape(StrokeShape::Lasso));
    for depth in [Depth::Visible, Depth::Through] {
        timed.command(Command::SetDepth(depth));
        timed.times.clear();
        let circle = (0..200).map(|step| {
            let angle = f64::from(step) / 200.0 * std::f64::consts::TAU;
            SIZE_PX * 0.5 + DVec2::new(200.0 * angle.cos(), 200.0 * angle.sin())
        });
        timed.stroke(circle);
        timed.note(&format!("a lasso of 200 corners, {depth:?}"));
    }
    for action in [
        RegionAction::Grow,
        RegionAction::Shrink,
        RegionAction::SmoothBorder,
        RegionAction::FillParts,
        RegionAction::Invert,
        RegionAction::EverythingBut,
        RegionAction::Mirror(0),
    ] {
        timed.time(&format!("{action:?}"), Command::Region(action));
        timed.time("undo of it", Command::Undo);
    }
}

/// Every other command that visits the whole mesh, with a large handle that is moved.
fn handles(timed: &mut Timed) {
    let middle = SIZE_PX * 0.5;
    timed.command(Command::ClearRegions);
    timed.command(Command::SetTool(ToolMode::PaintHandle));
    timed.command(Command::NewHandle);
    timed.command(Command::SetStrokeShape(StrokeShape::Box));
    timed.command(Command::SetDepth(Depth::Visible));
    timed.stroke([middle - 180.0, middle + 60.0]);
    let id = timed.editor.view().selected.expect("the box made a handle");
    let moved = HandleTransform::Trs {
        translation: DVec3::new(0.1, 0.0, 0.0),
        rotation: DQuat::IDENTITY,
        scale: DVec3::ONE,
        pivot: None,
    };
    for (command, name) in [
        (Command::MakeTwin(2), "twin"),
        (Command::Undo, "undo of it"),
        (Command::DuplicateHandle, "split"),
        (Command::Undo, "undo of it"),
        (Command::FrameAll, "frame all"),
        (Command::FrameSelected, "frame selected"),
        (Command::FrameAll, "frame all"),
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
        (Command::ClearRegions, "clear regions"),
        (Command::Undo, "undo of it"),
        (Command::GoToStep(1), "back to the first step"),
        (Command::GoToStep(4), "three steps forth"),
    ] {
        timed.time(name, command);
    }
}

/// The memory of a hundred strokes in the history and in the process.
fn hundred_strokes(timed: &mut Timed, model: &Arc<Model>) {
    timed.open(model);
    timed.command(Command::SetStrokeShape(StrokeShape::Brush));
    timed.command(Command::SetBrushMetric(BrushMetric::Screen));
    timed.command(Command::SetBrushRadius(30.0));
    // Nothing is bound between these strokes: only the pointer's structure is updated.
    timed.binds = false;
    // The first stroke allocates the brush's own memory.
    timed.stroke(across(0.0));
    timed.command(Command::Undo);
    let resident = resident_mb();
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
        timed.stroke(across(f64::from(stroke as u32 * 29 % 200) - 100.0));
    }
    let grown = resident
        .zip(resident_mb())
        .map_or(f64::NAN, |(before, after)| after - before);
    let steps = timed.editor.history().names().1;
    assert_eq!(steps, 100, "every stroke paints something");
    let bytes = timed.editor.history().bytes() as f64 / f64::from(1 << 20);
    timed.time("a hundred strokes back", Command::GoToStep(0));
    timed.time("a hundred strokes forth", Command::GoToStep(steps));
    timed.report();
    println!("{{\"strokes\": {steps}, \"history_mb\": {bytes:.2}, \"resident_mb\": {grown:.1}}}");
}
