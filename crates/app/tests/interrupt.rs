//! Ctrl-C: the program stops within a second and leaves neither OUT nor anything else.

#![cfg(unix)]
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use std::fmt::Write as _;
use std::fs;
use std::os::unix::process::ExitStatusExt;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

use pliant_mesh::shapes;

#[test]
fn ctrl_c_stops_within_a_second_and_leaves_nothing() {
    let folder = tempfile::tempdir().unwrap();
    let sheet = shapes::grid(500, 500);
    let mut text = format!("OFF\n{} {} 0\n", sheet.positions.len(), sheet.triangles.len());
    for p in &sheet.positions {
        writeln!(text, "{} {} {}", p.x, p.y, p.z).unwrap();
    }
    for [a, b, c] in &sheet.triangles {
        writeln!(text, "3 {} {} {}", a.0, b.0, c.0).unwrap();
    }
    let slab = |from: f64, to: f64| format!(r#"{{"slab": {{"axis": "longest", "from": {from}, "to": {to}}}}}"#);
    let edit = format!(
        r#"{{"version": 1, "method": {{"name": "bilaplacian"}}, "fixed": {},
            "handles": [{{"select": {}, "transform": {{"translation": [0, 0, 1]}}}}]}}"#,
        slab(0.0, 0.05),
        slab(0.95, 1.0)
    );
    let at = |name: &str| folder.path().join(name);
    fs::write(at("sheet.off"), text).unwrap();
    fs::write(at("edit.json"), edit).unwrap();

    // At several moments of its work: reading, ordering, factoring. OUT as it was must stay in any of them.
    for wait_ms in [100, 400, 1000] {
        fs::write(at("out.off"), "as it was").unwrap();
        let program = Command::new(env!("CARGO_BIN_EXE_pliant"))
            .current_dir(folder.path())
            .args([
                "apply",
                "sheet.off",
                "--edit",
                "edit.json",
                "--output",
                "out.off",
                "--frames",
                "100000",
            ])
            .stderr(Stdio::piped())
            .spawn()
            .unwrap();
        std::thread::sleep(Duration::from_millis(wait_ms));
        let start = Instant::now();
        let sent = Command::new("kill")
            .args(["-INT", &program.id().to_string()])
            .status()
            .unwrap();
        assert!(sent.success());
        let ended = program.wait_with_output().unwrap();
        // Half a second of patience and the rest for a busy machine.
        assert!(
            start.elapsed() < Duration::from_secs(2),
            "it took {:?}",
            start.elapsed()
        );
        // On a busy machine the signal may come before the program listens, and ends it as it ends any.
        if ended.status.signal() != Some(2) {
            assert_eq!(ended.status.code(), Some(1));
            let said = String::from_utf8(ended.stderr).unwrap();
            assert!(said.lines().count() == 1 && said.contains("stopped"), "{said:?}");
        }
        assert_eq!(fs::read_to_string(at("out.off")).unwrap(), "as it was");
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 3);
    }
}
