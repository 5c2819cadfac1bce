//! The real window under a virtual display, driven by real pointer and key events: paint, drag, save, and find the
//! shape that the command line makes of the exported edit.
//!
//! Skipped by name where Xvfb, xdotool or a graphics device is missing.

#![cfg(target_os = "linux")]
#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    clippy::print_stderr,
    reason = "tests fail by panicking and say what they skip"
)]

use std::io::{BufRead, BufReader};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::thread::sleep;
use std::time::{Duration, Instant};

use pliant_app::engine::{self, Loaded};
use pliant_app::watch::Watch;
use pliant_editor::method_title;
use pliant_mesh::WeldOptions;

const PLIANT: &str = env!("CARGO_BIN_EXE_pliant");
const SIZE: (i32, i32) = (1280, 800);
/// Software drawing of a frame takes about a tenth of a second: act like a slow hand.
const PAUSE: Duration = Duration::from_millis(250);

/// A process that ends with its owner.
struct Running(Child);

impl Drop for Running {
    fn drop(&mut self) {
        let _ = self.0.kill();
        let _ = self.0.wait();
    }
}

/// A display, a window manager where there is one, and the program's window on it.
struct Desktop {
    display: String,
    window: String,
    _program: Running,
    /// Settings and recovered work of the session, apart from the person's own.
    _home: tempfile::TempDir,
    _manager: Option<Running>,
    _server: Running,
}

impl Desktop {
    fn open(file: &Path) -> Option<Self> {
        let (server, display) = display()?;
        let home = tempfile::tempdir().unwrap();
        let start = |program: &str, arguments: &[&Path]| {
            let mut command = Command::new(program);
            command
                .args(arguments)
                .env("DISPLAY", &display)
                .env("XDG_CONFIG_HOME", home.path())
                .env("XDG_STATE_HOME", home.path())
                .env_remove("WAYLAND_DISPLAY");
            command
                .stdin(Stdio::null())
                .stdout(Stdio::null())
                .stderr(Stdio::null())
                .spawn()
                .ok()
                .map(Running)
        };
        let manager = start("openbox", &[]);
        sleep(PAUSE);
        let program = start(PLIANT, &[file]).expect("the program was just built");
        let mut desktop = Self {
            display,
            window: String::new(),
            _program: program,
            _home: home,
            _manager: manager,
            _server: server,
        };
        desktop.window = desktop.wait_for_window();
        desktop.xdotool(&["windowmove", &desktop.window, "0", "0"]);
        desktop.xdotool(&["windowsize", &desktop.window, &SIZE.0.to_string(), &SIZE.1.to_string()]);
        desktop.xdotool(&["windowfocus", &desktop.window]);
        Some(desktop)
    }

    fn wait_for_window(&self) -> String {
        let start = Instant::now();
        loop {
            let found = self.xdotool(&["search", "--onlyvisible", "--name", "^Pliant"]);
            if let Some(window) = found.lines().next() {
                return window.to_owned();
            }
            assert!(start.elapsed() < Duration::from_secs(60), "no window came up");
            sleep(PAUSE);
        }
    }

    /// Waits until the window's title says so.
    fn wait_for_title(&self, title: &str) {
        let start = Instant::now();
        while self
            .xdotool(&["search", "--name", &format!("^Pliant.*{title}")])
            .is_empty()
        {
            assert!(start.elapsed() < Duration::from_secs(60), "no title says {title}");
            sleep(PAUSE);
        }
    }

    fn xdotool(&self, arguments: &[&str]) -> String {
        let output = Command::new("xdotool")
            .args(arguments)
            .env("DISPLAY", &self.display)
            .output()
            .unwrap();
        String::from_utf8_lossy(&output.stdout).into_owned()
    }

    fn move_to(&self, x: i32, y: i32) {
        self.xdotool(&["mousemove", "--window", &self.window, &x.to_string(), &y.to_string()]);
    }

    /// Presses the left button at one point, goes to the other in steps, and lets go.
    fn drag(&self, from: (i32, i32), to: (i32, i32)) {
        self.move_to(from.0, from.1);
        sleep(PAUSE);
        self.xdotool(&["mousedown", "1"]);
        sleep(PAUSE);
        for step in 1..=5 {
            self.move_to(from.0 + (to.0 - from.0) * step / 5, from.1 + (to.1 - from.1) * step / 5);
            sleep(Duration::from_millis(120));
        }
        self.xdotool(&["mouseup", "1"]);
        sleep(PAUSE);
    }

    fn key(&self, key: &str) {
        self.xdotool(&["key", key]);
        sleep(PAUSE);
    }

    fn type_text(&self, text: &str) {
        self.xdotool(&["type", "--delay", "20", text]);
        sleep(PAUSE);
    }

    /// Types a path into the question that comes up where the system has no file dialog, and waits for the file.
    fn answer_with(&self, key: &str, question: &str, path: &Path) {
        let start = Instant::now();
        self.key(key);
        self.wait_for_title(question);
        sleep(2 * PAUSE);
        self.key("ctrl+a");
        self.type_text(&path.to_string_lossy());
        self.key("Return");
        while !path.exists() {
            assert!(
                start.elapsed() < Duration::from_secs(60),
                "{} was not written",
                path.display()
            );
            sleep(PAUSE);
        }
    }

    /// Saves the model and exports the edit: the command line must make the same of the edit, to `tolerance` diagonals.
    fn saves_what_the_engine_makes(&self, sample: &Path, folder: &Path, name: &str, tolerance: f64) {
        let [saved, edit, applied] =
            ["saved.glb", "edit.json", "applied.glb"].map(|end| folder.join(format!("{name}-{end}")));
        self.answer_with("ctrl+shift+s", "Save the model as", &saved);
        self.wait_for_title(&format!("{name}-saved.glb"));
        self.answer_with("ctrl+e", "Export the edit", &edit);
        sleep(PAUSE);
        let exported = std::fs::read_to_string(&edit).unwrap();
        assert!(exported.contains(&format!("\"{name}\"")), "{exported}");
        let status = Command::new(PLIANT)
            .args([
                "apply".as_ref(),
                sample.as_os_str(),
                "--edit".as_ref(),
                edit.as_os_str(),
                "--output".as_ref(),
                applied.as_os_str(),
            ])
            .status()
            .unwrap();
        assert!(status.success());
        let (rest, saved, applied) = (load(sample), load(&saved), load(&applied));
        let size = rest.model.bounds().unwrap().diagonal();
        assert!(farthest(&rest, &saved) > 0.01 * size, "{name}: the drag bent nothing");
        let apart = farthest(&saved, &applied) / size;
        assert!(
            apart <= tolerance,
            "{name}: the window's shape is {apart} from the engine's"
        );
    }
}

/// A virtual display of its own; `None`, said by name, where a tool or a device is missing.
fn display() -> Option<(Running, String)> {
    if Command::new("xdotool").arg("version").output().is_err() {
        eprintln!("skipped: the real window (no xdotool)");
        return None;
    }
    if let Err(error) = pliant_render::Headless::new() {
        eprintln!("skipped: the real window ({error})");
        return None;
    }
    let server = Command::new("Xvfb")
        .args(["-displayfd", "1", "-screen", "0", "1400x900x24", "-nolisten", "tcp"])
        .stdin(Stdio::null())
        .stdout(Stdio::piped())
        .stderr(Stdio::null())
        .spawn();
    let Ok(mut server) = server else {
        eprintln!("skipped: the real window (no Xvfb)");
        return None;
    };
    let mut number = String::new();
    BufReader::new(server.stdout.take().unwrap())
        .read_line(&mut number)
        .unwrap();
    Some((Running(server), format!(":{}", number.trim())))
}

fn load(path: &Path) -> Loaded {
    engine::load(path, &WeldOptions::default(), &Watch::default()).unwrap()
}

/// The largest distance between two files' drawn vertices.
fn farthest(a: &Loaded, b: &Loaded) -> f64 {
    let positions = |loaded: &Loaded| loaded.model.drawn.positions.clone();
    positions(a)
        .iter()
        .zip(positions(b))
        .map(|(a, b)| a.distance(b))
        .fold(0.0, f64::max)
}

#[test]
fn pointer_and_keys_make_the_shape_that_the_engine_says() {
    let sample = PathBuf::from(env!("CARGO_MANIFEST_DIR"))
        .join("../../assets/bar.glb")
        .canonicalize()
        .unwrap();
    let Some(desktop) = Desktop::open(&sample) else { return };
    let folder = tempfile::tempdir().unwrap();
    desktop.wait_for_title("bar.glb");
    sleep(8 * PAUSE);

    // The view's middle is the bar's, wherever the panels end: the 3D view takes the window less the panel.
    let (middle_x, middle_y) = ((SIZE.0 - 270) / 2, SIZE.1 / 2 + 20);
    desktop.drag((middle_x - 6, middle_y), (middle_x + 6, middle_y + 4));
    sleep(4 * PAUSE);
    desktop.key("g");
    for step in 1..=6 {
        desktop.move_to(middle_x + 6 + 10 * step, middle_y - 12 * step);
        sleep(Duration::from_millis(120));
    }
    desktop.xdotool(&["click", "1"]);
    sleep(8 * PAUSE);

    // ARAP, with which a document begins: the window's descent followed the hand, the command line's starts at rest.
    desktop.saves_what_the_engine_makes(&sample, folder.path(), "arap", 1e-3);
    // A linear method has one answer, whichever way it was come to.
    desktop.key("F1");
    desktop.type_text(&format!("Method: {}", method_title("bilaplacian")));
    desktop.key("Return");
    sleep(8 * PAUSE);
    desktop.saves_what_the_engine_makes(&sample, folder.path(), "bilaplacian", 1e-6);
}
