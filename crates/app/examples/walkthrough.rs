//! The pictures of the walk-through in `docs/first-edit.md`, taken from the whole application without a display.
//!
//! `cargo run --release -p pliant-app --example walkthrough -- FOLDER` follows the page on the built-in sample, and
//! writes a picture of each step to FOLDER, and the moving picture of the README, `drag.gif`.

#![allow(
    clippy::expect_used,
    clippy::unwrap_used,
    clippy::print_stdout,
    reason = "a tool of the documentation fails by panicking and says what it wrote"
)]

use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use egui::{Event, Key, Modifiers, PointerButton, Pos2, pos2, vec2};
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable;
use glam::DVec3;
use pliant_app::window::{AppDirectories, Application, Source};
use pliant_deform::Method;
use pliant_editor::{BrushMetric, Command, RegionAction, StiffnessBrush, StrokeShape, ToolMode};

struct Walk {
    harness: Harness<'static, Application>,
    folder: PathBuf,
    number: usize,
}

impl Walk {
    fn settle(&mut self) {
        let start = Instant::now();
        self.harness.step();
        while !self.harness.state().is_settled() {
            assert!(start.elapsed() < Duration::from_secs(120), "it never settles");
            std::thread::sleep(Duration::from_millis(5));
            self.harness.step();
        }
        // The smooth picture of a view at rest, and widgets' animations.
        std::thread::sleep(Duration::from_millis(350));
        self.harness.run_steps(8);
    }

    fn shoot(&mut self, name: &str) {
        self.settle();
        self.picture(name);
    }

    fn picture(&mut self, name: &str) {
        self.number += 1;
        let path = self.folder.join(format!("{:02}-{name}.png", self.number));
        let image = self.harness.render().expect("the device draws");
        // Small enough for a page.
        let small = image::imageops::resize(&image, 800, 500, image::imageops::FilterType::Triangle);
        small.save(&path).expect("the folder takes it");
        println!("{}", path.display());
    }

    /// The view's pixel for the vertex that `choose` picks.
    fn point(&self, choose: impl Fn(&[DVec3]) -> DVec3) -> Pos2 {
        let view = self.harness.state().editor().view();
        let model = view.model.unwrap();
        let positions: Vec<DVec3> = model
            .surface
            .positions
            .iter()
            .zip(view.displacements.iter())
            .map(|(&p, &d)| p + d)
            .collect();
        let seen = view.camera.project(choose(&positions), view.viewport_px).unwrap();
        self.harness.state().view_rect().min + vec2(seen.x as f32, seen.y as f32)
    }

    fn pointer(&mut self, at: Pos2, pressed: Option<bool>) {
        self.harness.event(Event::PointerMoved(at));
        if let Some(pressed) = pressed {
            self.harness.event(Event::PointerButton {
                pos: at,
                button: PointerButton::Primary,
                pressed,
                modifiers: Modifiers::NONE,
            });
        }
        self.harness.step();
    }

    fn stroke(&mut self, way: &[Pos2]) {
        self.pointer(way[0], None);
        self.pointer(way[0], Some(true));
        for &at in &way[1..] {
            self.pointer(at, None);
        }
        self.pointer(way[way.len() - 1], Some(false));
        self.settle();
    }

    fn keys(&mut self, keys: &[Key]) {
        for &key in keys {
            self.harness.key_press_modifiers(Modifiers::NONE, key);
            self.harness.step();
        }
    }

    fn command(&mut self, command: Command) {
        self.harness.state_mut().command(command);
        self.harness.step();
    }
}

fn mean<'a>(positions: impl Iterator<Item = &'a DVec3>) -> DVec3 {
    let (count, sum) = positions.fold((0.0, DVec3::ZERO), |(count, sum), p| (count + 1.0, sum + *p));
    sum / count
}

/// The window on the sample, as it is when Pliant is new.
fn open(folder: &Path) -> Walk {
    let own = tempfile::tempdir().unwrap();
    let places = AppDirectories {
        settings: Some(own.path().join("settings.json")),
        recovery: None,
        pictures: None,
    };
    let harness = Harness::builder()
        .with_size(vec2(1280.0, 800.0))
        .with_max_steps(64)
        .wgpu()
        .build_eframe(move |context| {
            Application::with_places(context, Source::Sample, &places).expect("there is a graphics device")
        });
    Walk {
        harness,
        folder: folder.to_owned(),
        number: 0,
    }
}

/// The width of the moving picture in pixels.
const FILM_WIDTH: u32 = 440;

/// The largest change of a channel that the moving picture leaves out: repeated pixels take no bytes.
const HELD: u8 = 6;

/// A spine is drawn through the tail, and its end is dragged up and back.
fn film(folder: &Path) {
    let mut walk = open(folder);
    walk.settle();
    walk.command(Command::SetStrokeShape(StrokeShape::Spine));
    let along = |walk: &Walk, share: f64| {
        walk.point(move |positions| {
            let lowest = positions.iter().map(|p| p.z).fold(f64::INFINITY, f64::min);
            let from = lowest + 0.02 + share * 0.46;
            mean(positions.iter().filter(|p| (p.z - from).abs() < 0.02))
        })
    };
    let way: Vec<Pos2> = (0..8).map(|step| along(&walk, 1.0 - f64::from(step) / 7.2)).collect();
    walk.stroke(&way);
    let end = way[7];
    let mut frames = Vec::new();
    let mut shoot = |walk: &mut Walk| {
        walk.harness.run_steps(6);
        let mut image = walk.harness.render().expect("the device draws");
        let view = walk.harness.state().view_rect();
        let [x, y, width, height] = [view.left(), view.top(), view.width(), view.height()].map(|px| px as u32);
        let view = image::imageops::crop(&mut image, x, y, width, height).to_image();
        let small = [FILM_WIDTH, FILM_WIDTH * height / width];
        let filter = image::imageops::FilterType::Triangle;
        frames.push(image::imageops::resize(&view, small[0], small[1], filter));
    };
    walk.pointer(end, None);
    walk.pointer(end, Some(true));
    for step in 0..16 {
        let angle = f64::from(step) / 16.0 * std::f64::consts::TAU;
        let way = vec2(-40.0 * (1.0 - angle.cos()) as f32, -90.0 * (1.0 - angle.cos()) as f32);
        walk.pointer(end + way + vec2(25.0 * angle.sin() as f32, 0.0), None);
        shoot(&mut walk);
    }
    let path = folder.join("drag.gif");
    write_film(&path, frames);
    println!("{}", path.display());
}

/// Writes the frames as a GIF that repeats.
fn write_film(path: &Path, mut frames: Vec<image::RgbaImage>) {
    leave_out_repetitions(&mut frames);
    let [width, height] = [frames[0].width(), frames[0].height()].map(|side| u16::try_from(side).unwrap());
    let file = std::fs::File::create(path).unwrap();
    let mut encoder = gif::Encoder::new(file, width, height, &[]).unwrap();
    encoder.set_repeat(gif::Repeat::Infinite).unwrap();
    for frame in frames {
        let mut frame = gif::Frame::from_rgba_speed(width, height, &mut frame.into_raw(), 10);
        // In hundredths of a second. Transparent pixels show the frames before, which stay.
        frame.delay = 11;
        frame.dispose = gif::DisposalMethod::Keep;
        encoder.write_frame(&frame).unwrap();
    }
}

/// Makes the pixels of each frame transparent that look like those before, which then stay.
fn leave_out_repetitions(frames: &mut [image::RgbaImage]) {
    let Some((first, later)) = frames.split_first_mut() else {
        return;
    };
    let mut shown = first.clone();
    for frame in later {
        for (pixel, before) in frame.pixels_mut().zip(shown.pixels_mut()) {
            let mut channels = pixel.0.iter().zip(&before.0);
            if channels.all(|(now, before)| now.abs_diff(*before) <= HELD) {
                *pixel = image::Rgba([0; 4]);
            } else {
                *before = *pixel;
            }
        }
    }
}

fn main() {
    let folder = PathBuf::from(std::env::args_os().nth(1).expect("give a folder"));
    std::fs::create_dir_all(&folder).unwrap();
    film(&folder);
    let mut walk = open(&folder);
    walk.shoot("opened");

    let head = walk.point(|positions| mean(positions.iter().filter(|p| p.y > 0.87 && p.z > 0.28)));
    walk.command(Command::SetBrushMetric(BrushMetric::Through));
    walk.command(Command::SetBrushRadius(100.0));
    let strokes: Vec<Pos2> = (0..5).map(|step| head + vec2(35.0 * step as f32 - 70.0, 0.0)).collect();
    walk.stroke(&strokes);
    walk.shoot("handle");

    walk.keys(&[Key::G, Key::X, Key::Num0, Key::Period, Key::Num1, Key::Enter]);
    walk.keys(&[Key::R, Key::Y, Key::Num4, Key::Num0, Key::Enter]);
    walk.shoot("dragged");

    walk.command(Command::SetTool(ToolMode::PaintStiffness));
    walk.command(Command::SetStiffnessBrush(StiffnessBrush {
        value: 100.0,
        ..StiffnessBrush::default()
    }));
    let body = walk.point(|positions| {
        let mean = mean(positions.iter());
        *positions
            .iter()
            .max_by(|a, b| {
                (a.z - (a.x - mean.x).abs() - (a.y - mean.y).abs())
                    .total_cmp(&(b.z - (b.x - mean.x).abs() - (b.y - mean.y).abs()))
            })
            .unwrap()
    });
    walk.command(Command::SetBrushRadius(50.0));
    walk.stroke(&[body, body + vec2(30.0, 12.0), body + vec2(60.0, 0.0)]);
    walk.shoot("stiffness");

    walk.command(Command::SetTool(ToolMode::PaintFixed));
    walk.command(Command::SetStrokeShape(StrokeShape::Lasso));
    let rect = walk.harness.state().view_rect();
    let lasso: Vec<Pos2> = (0..24)
        .map(|step| {
            let angle = step as f32 / 24.0 * std::f32::consts::TAU;
            pos2(rect.center().x, rect.bottom() - 170.0) + vec2(190.0 * angle.cos(), 90.0 * angle.sin())
        })
        .collect();
    walk.pointer(lasso[0], None);
    walk.pointer(lasso[0], Some(true));
    for &at in &lasso[1..20] {
        walk.pointer(at, None);
    }
    walk.picture("lasso");
    walk.pointer(lasso[20], Some(false));
    walk.shoot("fixed");

    walk.command(Command::SetStrokeShape(StrokeShape::Brush));
    walk.command(Command::SetTool(ToolMode::PaintHandle));
    walk.command(Command::Region(RegionAction::Grow));
    walk.command(Command::SetMethod(Method::from_name("primo").unwrap()));
    walk.settle();
    walk.keys(&[Key::R, Key::Z, Key::Minus, Key::Num2, Key::Num0, Key::Enter]);
    walk.shoot("another-method");

    walk.harness.key_press(Key::F1);
    walk.harness.run_steps(3);
    walk.harness.event(Event::Text("mir".to_owned()));
    walk.harness.run_steps(4);
    walk.picture("palette");
    walk.harness.key_press(Key::Escape);
    walk.harness.run_steps(3);

    walk.harness.get_by_label("Region").click();
    walk.harness.run_steps(4);
    walk.picture("region-menu");
    walk.harness.key_press(Key::Escape);
    walk.harness.run_steps(3);

    walk.harness.get_by_label("Window").click();
    walk.harness.run_steps(4);
    walk.harness.get_by_label("Light or dark").click();
    walk.shoot("light");
}
