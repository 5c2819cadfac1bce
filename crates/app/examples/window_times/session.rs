//! The whole application without a display, and the times of its frames.

use std::time::{Duration, Instant};

use egui::{Event, Modifiers, PointerButton, Pos2, vec2};
use egui_kittest::Harness;
use glam::DVec3;
use pliant_app::window::{Application, Source};
use pliant_editor::{Command, Paint};

pub struct Session {
    pub harness: Harness<'static, Application>,
    /// The times of all frames since the last row, drawing included.
    whole: Vec<Duration>,
    /// The most processor time that the window's thread has used in a frame since the last row, drawing included.
    busiest: Option<Duration>,
}

impl Session {
    /// Opens a file and waits until it is shown.
    pub fn open(file: &str) -> Self {
        let file = file.into();
        let harness = Harness::builder()
            .with_size(vec2(1280.0, 800.0))
            .with_max_steps(64)
            .wgpu()
            .build_eframe(|context| Application::new(context, Source::File(file)).expect("a graphics device"));
        let mut session = Self {
            harness,
            whole: Vec::new(),
            busiest: None,
        };
        session.settle();
        session
    }

    /// A frame.
    pub fn step(&mut self) {
        let (start, used_before) = (Instant::now(), processor_time());
        self.harness.step();
        self.whole.push(start.elapsed());
        let used = processor_time().zip(used_before).map(|(now, before)| now - before);
        self.busiest = self.busiest.max(used);
    }

    /// Frames until all jobs have ended and the camera stands still.
    pub fn settle(&mut self) {
        self.step();
        let is_busy = |application: &Application| !application.is_settled() || application.editor().view().is_animating;
        while is_busy(self.harness.state()) {
            std::thread::sleep(Duration::from_millis(1));
            self.step();
        }
    }

    pub fn move_to(&mut self, position: Pos2) {
        self.harness.event(Event::PointerMoved(position));
    }

    pub fn press(&mut self, position: Pos2, pressed: bool) {
        let (button, modifiers) = (PointerButton::Primary, Modifiers::NONE);
        self.harness.event(Event::PointerButton {
            pos: position,
            button,
            pressed,
            modifiers,
        });
        self.step();
    }

    /// A drag of `count` pointer moves, a frame each.
    pub fn drag(&mut self, count: usize, way: impl Fn(f32) -> Pos2) {
        self.move_to(way(0.0));
        self.step();
        self.press(way(0.0), true);
        for move_number in 1..=count {
            self.move_to(way(move_number as f32 / count as f32));
            self.step();
        }
        self.press(way(1.0), false);
    }

    /// The place in the window of a point of the scene.
    pub fn place_of(&self, point: DVec3) -> Pos2 {
        let application = self.harness.state();
        let view = application.editor().view();
        let seen = view.camera.project(point, view.viewport_px).expect("it is framed");
        application.view_rect().min + vec2(seen.x as f32, seen.y as f32)
    }

    /// Gives a command and waits until its jobs have ended.
    pub fn command(&mut self, command: Command) {
        self.harness.state_mut().command(command);
        self.settle();
    }

    /// Forgets the frames so far.
    pub fn begin_row(&mut self) {
        self.harness.state_mut().take_longest_frame();
        self.whole.clear();
        self.busiest = None;
    }

    /// The longest frame since the last row, without drawing.
    pub fn longest_frame(&mut self) -> Duration {
        self.harness.state_mut().take_longest_frame()
    }

    /// Returns true if the shape in the buffers has the handle at the pointer's place: an earlier move's result does
    /// not.
    pub fn shows_handle(&self, size: f64) -> bool {
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

    /// Prints the longest frame since the last row: the window's thread without drawing, and with it, which tells
    /// something on a real device alone. `busiest_ms` is the thread's own processor time, which leaves out what it waits
    /// while the system runs other threads on its core.
    pub fn row(&mut self, what: &str) {
        let longest = self.longest_frame();
        self.whole.sort();
        let [median, whole] = match self.whole.len() {
            0 => [Duration::ZERO; 2],
            count => [self.whole[count / 2], self.whole[count - 1]],
        };
        self.whole.clear();
        let busiest = self.busiest.take().map_or(serde_json::Value::Null, |used| {
            ((ms(used) * 10.0).round() / 10.0).into()
        });
        println!(
            "{{\"doing\": \"{what}\", \"longest_frame_ms\": {:.1}, \"busiest_ms\": {busiest}, \"drawn_median_ms\": {:.2}, \"drawn_longest_ms\": {:.1}}}",
            ms(longest),
            ms(median),
            ms(whole)
        );
    }
}

pub fn ms(duration: Duration) -> f64 {
    duration.as_secs_f64() * 1e3
}

/// The processor time that the calling thread has used so far, where the system tells it (Linux).
fn processor_time() -> Option<Duration> {
    let told = std::fs::read_to_string("/proc/thread-self/schedstat").ok()?;
    told.split_whitespace().next()?.parse().ok().map(Duration::from_nanos)
}
