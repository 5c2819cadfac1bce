//! Ctrl-C: the program stops with one sentence and leaves neither OUT nor any other file, at every stage.

#![cfg(unix)]
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use std::fmt::Write as _;
use std::fs::{self, File};
use std::io::Read;
use std::path::Path;
use std::process::{Command, Stdio};
use std::sync::mpsc;
use std::time::Duration;

use pliant_mesh::shapes;
use rustix::fs::{Mode, OFlags};
use rustix::process::{Pid, Signal, kill_process};
use rustix::pty::{OpenptFlags, grantpt, openpt, ptsname, unlockpt};

/// The stages of the progress line, in this order. A stage that is too short to be shown is interrupted in the next.
const STAGES: [&str; 5] = ["reading", "welding", "ordering", "binding", "bending"];

/// The time limit of one run on the slowest machine: a program that hangs is ended, and the test fails.
const DEADLINE: Duration = Duration::from_secs(300);

#[test]
fn ctrl_c_at_any_stage_ends_with_one_sentence_and_leaves_nothing() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    write_sheet(&at("sheet.off"));
    let slab = |from: f64, to: f64| format!(r#"{{"slab": {{"axis": "longest", "from": {from}, "to": {to}}}}}"#);
    let edit = format!(
        r#"{{"version": 1, "method": {{"name": "bilaplacian"}}, "fixed": {},
            "handles": [{{"select": {}, "transform": {{"translation": [0, 0, 1]}}}}]}}"#,
        slab(0.0, 0.05),
        slab(0.95, 1.0)
    );
    fs::write(at("edit.json"), edit).unwrap();

    for stage in STAGES {
        fs::write(at("out.off"), "as it was").unwrap();
        let (status, said) = interrupted_at(stage, folder.path());
        assert_eq!(status, Some(1), "{stage}: {said:?}");
        let sentence = said.rsplit("\x1b[K").next().unwrap();
        assert!(
            sentence.lines().count() == 1 && sentence.starts_with("pliant: the command was stopped"),
            "{stage}: {said:?}"
        );
        assert_eq!(fs::read_to_string(at("out.off")).unwrap(), "as it was", "{stage}");
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 3, "{stage}");
    }
}

/// A mesh that takes a moment in every stage.
fn write_sheet(path: &Path) {
    let sheet = shapes::grid(500, 500);
    let mut text = format!("OFF\n{} {} 0\n", sheet.positions.len(), sheet.triangles.len());
    for p in &sheet.positions {
        writeln!(text, "{} {} {}", p.x, p.y, p.z).unwrap();
    }
    for [a, b, c] in &sheet.triangles {
        writeln!(text, "3 {} {} {}", a.0, b.0, c.0).unwrap();
    }
    fs::write(path, text).unwrap();
}

/// Runs `pliant apply` on a terminal and sends SIGINT when the progress line says `stage`, or a later stage if this one
/// was too short to be shown. Returns the exit status and all text on the terminal.
fn interrupted_at(stage: &str, folder: &Path) -> (Option<i32>, String) {
    let (mut terminal, program_side) = open_terminal();
    let mut program = Command::new(env!("CARGO_BIN_EXE_pliant"))
        .current_dir(folder)
        .args(["apply", "sheet.off", "--edit", "edit.json", "--output", "out.off"])
        .args(["--frames", "100000"])
        .stderr(program_side)
        .spawn()
        .unwrap();
    let process = Pid::from_child(&program);
    let (ended, wait_for_end) = mpsc::channel::<()>();
    let watchdog = std::thread::spawn(move || {
        if wait_for_end.recv_timeout(DEADLINE) == Err(mpsc::RecvTimeoutError::Timeout) {
            let _ = kill_process(process, Signal::KILL);
        }
    });

    let from = STAGES.iter().position(|&known| known == stage).unwrap();
    let awaited = &STAGES[from..];
    let mut said = String::new();
    let mut bytes = [0; 4096];
    let mut is_sent = false;
    // Linux ends with an error when the program has closed its side, other systems with an empty read.
    while let Ok(count @ 1..) = terminal.read(&mut bytes) {
        said.push_str(&String::from_utf8_lossy(&bytes[..count]));
        if !is_sent && awaited.iter().any(|word| said.contains(word)) {
            kill_process(process, Signal::INT).unwrap();
            is_sent = true;
        }
    }
    drop(ended);
    watchdog.join().unwrap();
    assert!(is_sent, "it ended before it said {stage:?}: {said:?}");
    (program.wait().unwrap().code(), said)
}

/// A pseudo-terminal: our side, and the program's.
fn open_terminal() -> (File, Stdio) {
    let ours = openpt(OpenptFlags::RDWR | OpenptFlags::NOCTTY).unwrap();
    grantpt(&ours).unwrap();
    unlockpt(&ours).unwrap();
    let name = ptsname(&ours, Vec::new()).unwrap();
    let flags = OFlags::RDWR | OFlags::NOCTTY | OFlags::CLOEXEC;
    let program_side = rustix::fs::open(name.as_c_str(), flags, Mode::empty()).unwrap();
    (ours.into(), program_side.into())
}
