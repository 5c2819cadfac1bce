//! The whole application without a window, driven like a person.
#![allow(dead_code, reason = "each test file uses the verbs it needs")]
#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    clippy::print_stderr,
    reason = "tests fail by panicking and say what they skip"
)]

use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::{Duration, Instant};

use egui::accesskit::Role;
use egui::{Event, Key, Modifiers, PointerButton, Pos2, pos2, vec2};
use egui_kittest::Harness;
use egui_kittest::kittest::{NodeT, Queryable};
use glam::DVec3;
use pliant_app::window::{AppDirectories, Application, Source};

/// A file that another program drops onto the window.
#[derive(Debug)]
struct Dropped(PathBuf);

impl egui::DroppedFile for Dropped {
    fn path(&self) -> &Path {
        &self.0
    }

    fn bytes(&self) -> Result<Vec<u8>, String> {
        std::fs::read(&self.0).map_err(|error| error.to_string())
    }
}

/// The pixels of a point of the window, on each side: few, because drawing in software takes most of a session's time.
pub const PIXELS_PER_POINT: f32 = 0.5;

/// The colour at a place of the window in its picture.
pub fn colour_at(picture: &image::RgbaImage, place: Pos2) -> image::Rgba<u8> {
    let [x, y] = (place * PIXELS_PER_POINT).into();
    *picture.get_pixel(x as u32, y as u32)
}

/// Drives the application like a person.
pub struct Session {
    pub harness: Harness<'static, Application>,
}

impl Session {
    /// The application with the sample open; `None` without a graphics device.
    pub fn begin() -> Option<Self> {
        Self::begin_in(Source::Sample, AppDirectories::default())
    }

    /// The application of a person with these folders, with `source` open; `None` without a graphics device.
    pub fn begin_in(source: Source, places: AppDirectories) -> Option<Self> {
        let mut session = Self::start(source, places)?;
        session.settle();
        Some(session)
    }

    /// The same when the window has just appeared.
    pub fn start(source: Source, places: AppDirectories) -> Option<Self> {
        if let Err(error) = pliant_render::Headless::new() {
            eprintln!("skipped: the window's session ({error})");
            return None;
        }
        let harness = Harness::builder()
            .with_size(vec2(1000.0, 700.0))
            .with_pixels_per_point(PIXELS_PER_POINT)
            .with_max_steps(64)
            .wgpu()
            .build_eframe(move |context| {
                Application::with_places(context, source, &places).expect("the device was just there")
            });
        Some(Self { harness })
    }

    /// Lets frames pass until no work is running.
    #[track_caller]
    pub fn settle(&mut self) {
        let start = Instant::now();
        self.harness.step();
        while !self.harness.state().is_settled() {
            assert!(
                start.elapsed() < Duration::from_secs(120),
                "still busy: {}",
                self.status()
            );
            std::thread::sleep(Duration::from_millis(5));
            self.harness.step();
        }
        self.harness.step();
    }

    /// Lets frames pass until `is_done` holds, such as for work that begins only after other work has ended.
    #[track_caller]
    pub fn wait_until(&mut self, is_done: impl Fn(&Self) -> bool) {
        let start = Instant::now();
        while !is_done(self) {
            assert!(
                start.elapsed() < Duration::from_secs(120),
                "still {}, {:?}",
                self.status(),
                self.harness.state().headline()
            );
            std::thread::sleep(Duration::from_millis(5));
            self.harness.step();
        }
    }

    /// The same, and then until no work is running.
    #[track_caller]
    pub fn settle_when(&mut self, is_done: impl Fn(&Self) -> bool) {
        self.wait_until(is_done);
        self.settle();
    }

    pub fn status(&self) -> String {
        self.harness.state().editor().view().status
    }

    /// The place in the window of the middle of the vertices that `choose` selects.
    pub fn point_of(&self, choose: impl Fn(&[DVec3]) -> DVec3) -> Pos2 {
        let application = self.harness.state();
        let view = application.editor().view();
        let positions: Vec<DVec3> = view
            .model
            .unwrap()
            .surface
            .positions
            .iter()
            .zip(view.displacements.iter())
            .map(|(&p, &d)| p + d)
            .collect();
        let seen = view
            .camera
            .project(choose(&positions), view.viewport_px)
            .expect("it is before the eye");
        let corner = application.view_rect().min;
        pos2(corner.x + seen.x as f32, corner.y + seen.y as f32)
    }

    pub fn pointer(&mut self, position: Pos2, pressed: Option<bool>) {
        self.harness.event(Event::PointerMoved(position));
        if let Some(pressed) = pressed {
            let modifiers = Modifiers::NONE;
            self.harness.event(Event::PointerButton {
                pos: position,
                button: PointerButton::Primary,
                pressed,
                modifiers,
            });
        }
        self.harness.step();
    }

    pub fn stroke(&mut self, from: Pos2, to: Pos2) {
        self.pointer(from, None);
        self.pointer(from, Some(true));
        for step in 1..=4 {
            self.pointer(from + (to - from) * (step as f32 / 4.0), None);
        }
        self.pointer(to, Some(false));
        self.settle();
    }

    pub fn key(&mut self, key: Key, modifiers: Modifiers) {
        self.harness.key_press_modifiers(modifiers, key);
        self.harness.step();
        self.settle_if_idle();
    }

    /// Drops a file onto the window.
    pub fn drop_file(&mut self, path: &Path) {
        let file = Arc::new(Dropped(path.to_owned()));
        self.harness.input_mut().dropped_files.push(file);
        self.settle();
    }

    /// A modal transform is active after G, R, S: only a confirmed one settles.
    pub fn settle_if_idle(&mut self) {
        self.harness.step();
    }

    /// Opens the palette and types there.
    pub fn palette(&mut self, text: &str) {
        self.key(Key::F1, Modifiers::NONE);
        self.harness.event(Event::Text(text.to_owned()));
        self.harness.run_steps(2);
    }

    pub fn shape(&self) -> Vec<DVec3> {
        self.harness.state().editor().view().displacements.to_vec()
    }
}

impl Session {
    /// Sends all events within one frame, like on a slow machine, and then lets frames pass until the work is done.
    pub fn in_one_frame(&mut self, events: impl IntoIterator<Item = Event>) {
        self.harness.input_mut().events.extend(events);
        self.harness.run_steps(24);
    }

    /// The sample with one handle at its top, which stays selected.
    pub fn with_handle() -> Option<Self> {
        let mut session = Self::begin()?;
        let top = session.point_of(|positions| *positions.iter().max_by(|a, b| a.y.total_cmp(&b.y)).unwrap());
        session.stroke(top + vec2(0.0, 6.0), top + vec2(0.0, 16.0));
        assert_eq!(session.harness.state().editor().document().handles().len(), 1);
        Some(session)
    }

    pub fn translation(&self) -> DVec3 {
        self.harness.state().editor().document().handles()[0]
            .affine()
            .translation
    }

    /// Shows a page of the panel.
    pub fn page(&mut self, name: &str) {
        let tab = self.harness.get_by_role_and_label(Role::Tab, name);
        tab.click();
        self.harness.run_steps(3);
    }

    /// Clicks into the first of the fields behind a label, which then takes typed digits.
    pub fn click_into(&mut self, label: &str) {
        let field = self
            .harness
            .get_all_by_label(label)
            .find(|node| node.accesskit_node().role() == Role::SpinButton);
        let middle = field.expect("the panel has the field").rect().center();
        for pressed in [true, false] {
            self.pointer(middle, Some(pressed));
        }
        self.harness.run_steps(2);
    }
}
