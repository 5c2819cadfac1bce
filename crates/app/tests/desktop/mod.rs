//! The program's real window on a virtual display of its own, driven by a slow hand's pointer and keys.
#![allow(dead_code, reason = "each test file uses the verbs it needs")]
#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    clippy::print_stderr,
    reason = "tests fail by panicking and say what they skip"
)]

use std::io::{BufRead, BufReader, Write as _};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::thread::sleep;
use std::time::{Duration, Instant};

pub const PLIANT: &str = env!("CARGO_BIN_EXE_pliant");
pub const SIZE: (i32, i32) = (1024, 700);
/// Software drawing of a frame takes about a tenth of a second: act like a slow hand.
pub const PAUSE: Duration = Duration::from_millis(250);

/// The time limit of any action on a busy machine.
pub const PATIENCE: Duration = Duration::from_secs(60);

/// A copy of the sample in a folder. The project's own one stays out of reach: on a busy machine an answer may come too
/// late for its question, and Enter then saves over the open file.
pub fn sample_in(folder: &Path) -> PathBuf {
    let copy = folder.join("bar.glb");
    let own = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../assets/bar.glb");
    std::fs::copy(own, &copy).unwrap();
    copy
}

/// A process that ends with its owner.
pub struct Running(Child);

impl Drop for Running {
    fn drop(&mut self) {
        let _ = self.0.kill();
        let _ = self.0.wait();
    }
}

/// A display, a window manager if there is one, and the program's window on it.
pub struct Desktop {
    display: String,
    window: String,
    program: Option<Running>,
    /// Settings and recovered work of the session, apart from the person's own.
    home: tempfile::TempDir,
    _manager: Option<Running>,
    _server: Running,
    /// The folder for pictures and their number, for inspection: `PLIANT_SHOTS` names a folder.
    shots: Option<PathBuf>,
    shot: std::cell::Cell<u32>,
    /// Two at once would be slower than the time limits.
    _turn: MutexGuard<'static, ()>,
}

static TURN: Mutex<()> = Mutex::new(());

impl Desktop {
    /// The window with a file open; `None`, reported by name, if a tool is missing.
    pub fn open(file: &Path) -> Option<Self> {
        let turn = TURN.lock().unwrap_or_else(PoisonError::into_inner);
        let (server, display) = display()?;
        let home = tempfile::tempdir().unwrap();
        let manager = Command::new("openbox")
            .env("DISPLAY", &display)
            .stdout(Stdio::null())
            .stderr(Stdio::null())
            .spawn();
        sleep(PAUSE);
        let mut desktop = Self {
            display,
            window: String::new(),
            program: None,
            home,
            _manager: manager.ok().map(Running),
            _server: server,
            shots: std::env::var_os("PLIANT_SHOTS").map(PathBuf::from),
            shot: std::cell::Cell::new(0),
            _turn: turn,
        };
        desktop.start(file);
        Some(desktop)
    }

    /// Starts the program again, with the settings and the work of the last run, at a known place and size.
    pub fn start(&mut self, file: &Path) {
        self.launch(file);
        self.xdotool(&["windowmove", &self.window, "0", "0"]);
        self.xdotool(&["windowsize", &self.window, &SIZE.0.to_string(), &SIZE.1.to_string()]);
        self.xdotool(&["windowfocus", &self.window]);
    }

    /// The same, as large as the program makes its window.
    pub fn launch(&mut self, file: &Path) {
        self.program = None;
        let program = Command::new(PLIANT)
            .arg(file)
            .env("DISPLAY", &self.display)
            .env("XDG_CONFIG_HOME", self.home.path())
            .env("XDG_STATE_HOME", self.home.path())
            .env_remove("WAYLAND_DISPLAY")
            .stdin(Stdio::null())
            .stdout(Stdio::null())
            .stderr(Stdio::null())
            .spawn()
            .expect("the program was just built");
        self.program = Some(Running(program));
        self.window = self.wait_for_window();
    }

    /// Waits until the window's width in pixels is one that `fits`.
    pub fn wait_for_width(&self, fits: impl Fn(i32) -> bool) {
        let start = Instant::now();
        loop {
            let geometry = self.xdotool(&["getwindowgeometry", "--shell", &self.window]);
            let width = geometry
                .lines()
                .find_map(|line| line.strip_prefix("WIDTH=")?.parse().ok());
            if width.is_some_and(&fits) {
                return;
            }
            assert!(start.elapsed() < PATIENCE, "the window stays as it is: {geometry}");
            sleep(PAUSE);
        }
    }

    /// Asks the window manager to let the window fill the screen; `false`, reported by name, if no window manager can.
    pub fn maximise(&self) -> bool {
        let states = ["-i", "-r", &self.window, "-b", "add,maximized_vert,maximized_horz"];
        let asked = Command::new("wmctrl")
            .args(states)
            .env("DISPLAY", &self.display)
            .status();
        let is_asked = asked.is_ok_and(|status| status.success());
        if !is_asked || self._manager.is_none() {
            eprintln!("skipped: the real window (no wmctrl or no openbox)");
        }
        is_asked && self._manager.is_some()
    }

    /// The settings as stored.
    pub fn settings(&self) -> serde_json::Value {
        let file = self.home.path().join("pliant").join("settings.json");
        let text = std::fs::read_to_string(file).unwrap_or_default();
        serde_json::from_str(&text).unwrap_or_default()
    }

    /// Asks the window manager to close the window; `false`, reported by name, if no window manager can.
    pub fn close(&self) -> bool {
        let asked = Command::new("wmctrl")
            .args(["-i", "-c", &self.window])
            .env("DISPLAY", &self.display)
            .status();
        let is_asked = asked.is_ok_and(|status| status.success());
        if !is_asked {
            eprintln!("skipped: the real window (no wmctrl)");
        }
        is_asked
    }

    /// Waits until the program has ended by itself.
    pub fn wait_for_end(&mut self) {
        let start = Instant::now();
        let program = self.program.as_mut().unwrap();
        while program.0.try_wait().unwrap().is_none() {
            assert!(start.elapsed() < PATIENCE, "the program goes on");
            sleep(PAUSE);
        }
    }

    /// Ends the program like `kill -9`.
    pub fn kill(&mut self) {
        self.program = None;
        let start = Instant::now();
        while !self
            .xdotool(&["search", "--onlyvisible", "--name", "^Pliant"])
            .is_empty()
        {
            assert!(start.elapsed() < Duration::from_secs(20), "the window stays");
            sleep(PAUSE);
        }
    }

    /// The recoverable work of sessions.
    pub fn left_behind(&self) -> Vec<PathBuf> {
        let folder = self.home.path().join("pliant").join("recovery");
        let entries = std::fs::read_dir(folder).into_iter().flatten().flatten();
        entries
            .map(|entry| entry.path())
            .filter(|path| path.extension().is_some_and(|extension| extension == "pliant"))
            .collect()
    }

    /// Keeps a picture of the screen, if requested.
    pub fn shoot(&self, what: &str) {
        let Some(folder) = &self.shots else { return };
        self.shot.set(self.shot.get() + 1);
        let picture = folder.join(format!("{:02}-{what}.png", self.shot.get()));
        let _ = Command::new("import")
            .args(["-window", "root"])
            .arg(picture)
            .env("DISPLAY", &self.display)
            .status();
    }

    /// Runs a command by its name in the palette.
    pub fn command(&self, name: &str) {
        self.key("F1");
        sleep(PAUSE);
        self.xdotool(&["type", "--delay", "15", name]);
        sleep(2 * PAUSE);
        self.key("Return");
        sleep(2 * PAUSE);
    }

    /// Types keys one by one.
    pub fn keys(&self, keys: &[&str]) {
        for key in keys {
            self.xdotool(&["key", key]);
            sleep(Duration::from_millis(120));
        }
        sleep(PAUSE);
    }

    pub fn wait_for_window(&self) -> String {
        let start = Instant::now();
        loop {
            let found = self.xdotool(&["search", "--onlyvisible", "--name", "^Pliant"]);
            if let Some(window) = found.lines().next() {
                return window.to_owned();
            }
            assert!(start.elapsed() < PATIENCE, "no window came up");
            sleep(PAUSE);
        }
    }

    /// Waits until the window's title says so.
    pub fn wait_for_title(&self, title: &str) {
        let start = Instant::now();
        while self
            .xdotool(&["search", "--name", &format!("^Pliant.*{title}")])
            .is_empty()
        {
            assert!(start.elapsed() < PATIENCE, "no title says {title}: {}", self.titles());
            sleep(PAUSE);
        }
    }

    /// The titles of the visible windows.
    fn titles(&self) -> String {
        let windows = self.xdotool(&["search", "--onlyvisible", "--name", "."]);
        let titles = windows.lines().map(|window| self.xdotool(&["getwindowname", window]));
        titles.collect::<Vec<_>>().join(" ").replace('\n', ";")
    }

    pub fn xdotool(&self, arguments: &[&str]) -> String {
        let output = Command::new("xdotool")
            .args(arguments)
            .env("DISPLAY", &self.display)
            .output()
            .unwrap();
        String::from_utf8_lossy(&output.stdout).into_owned()
    }

    pub fn move_to(&self, x: i32, y: i32) {
        self.xdotool(&["mousemove", "--window", &self.window, &x.to_string(), &y.to_string()]);
    }

    /// Presses the left button at one point, goes to the other in steps, and releases it.
    pub fn drag(&self, from: (i32, i32), to: (i32, i32)) {
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

    pub fn key(&self, key: &str) {
        self.xdotool(&["key", key]);
        sleep(PAUSE);
    }

    pub fn type_text(&self, text: &str) {
        self.xdotool(&["type", "--delay", "20", text]);
        sleep(PAUSE);
    }

    /// Puts text onto the display's clipboard, as another program does; `false`, reported by name, if there is none.
    pub fn copy_elsewhere(&self, text: &str) -> bool {
        // It stays in the background until another program owns the clipboard.
        let started = Command::new("xclip")
            .args(["-selection", "clipboard", "-in"])
            .env("DISPLAY", &self.display)
            .stdin(Stdio::piped())
            .stdout(Stdio::null())
            .stderr(Stdio::null())
            .spawn();
        let Ok(mut xclip) = started else {
            eprintln!("skipped: the clipboard (xclip is not installed: apt install xclip)");
            return false;
        };
        let mut input = xclip.stdin.take().unwrap();
        input.write_all(text.as_bytes()).unwrap();
        drop(input);
        assert!(xclip.wait().unwrap().success());
        true
    }

    /// Waits until another program can paste this text.
    pub fn wait_for_clipboard(&self, text: &str) {
        let start = Instant::now();
        loop {
            let mut xclip = Command::new("xclip");
            let pasted = xclip.args(["-selection", "clipboard", "-out"]);
            let pasted = pasted.env("DISPLAY", &self.display).output().unwrap().stdout;
            if pasted == text.as_bytes() {
                return;
            }
            let pasted = String::from_utf8_lossy(&pasted);
            assert!(start.elapsed() < PATIENCE, "the clipboard has {pasted:?}");
            sleep(PAUSE);
        }
    }

    /// Types a path into the question that appears if the system has no file dialog, and waits for the file.
    pub fn answer_with(&self, key: &str, question: &str, path: &Path) {
        self.key(key);
        self.wait_for_title(question);
        self.answer(path);
        self.wait_for_file(path);
    }

    /// The open project, saved by its command under another name.
    pub fn project(&self, folder: &Path, name: &str) -> serde_json::Value {
        let path = folder.join(name).with_extension("pliant");
        self.command("save project as");
        self.wait_for_title("Save the project as");
        self.answer(&path);
        self.wait_for_file(&path);
        serde_json::from_str(&std::fs::read_to_string(path).unwrap()).unwrap()
    }

    /// The same once `holds` accepts it: the requested work takes time.
    pub fn project_once(
        &self,
        folder: &Path,
        name: &str,
        holds: impl Fn(&serde_json::Value) -> bool,
    ) -> serde_json::Value {
        let start = Instant::now();
        loop {
            let project = self.project(folder, name);
            if holds(&project) {
                return project;
            }
            assert!(start.elapsed() < PATIENCE, "{name} never comes to be: {project:#}");
            std::fs::remove_file(folder.join(name).with_extension("pliant")).unwrap();
            sleep(PAUSE);
        }
    }

    pub fn wait_for_file(&self, path: &Path) {
        self.wait_until(path, Path::exists);
    }

    /// Waits until `holds` accepts a file.
    pub fn wait_until(&self, path: &Path, holds: impl Fn(&Path) -> bool) {
        let start = Instant::now();
        while !holds(path) {
            assert!(
                start.elapsed() < PATIENCE,
                "{} was not written: {}",
                path.display(),
                self.titles()
            );
            sleep(PAUSE);
        }
    }

    /// Types a path into the shown question.
    pub fn answer(&self, path: &Path) {
        sleep(2 * PAUSE);
        self.key("ctrl+a");
        self.type_text(&path.to_string_lossy());
        self.key("Return");
        sleep(4 * PAUSE);
    }
}

/// A virtual display of its own; `None`, reported by name, if a tool or a device is missing.
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
