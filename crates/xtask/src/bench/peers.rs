//! Other programs on the same edit: what `../shared/peers` can time on this machine, beside Pliant's own row.

use std::path::{Path, PathBuf};
use std::process::Command;

use super::Scale;
use super::table::{Row, folder, measured};
use crate::process::output;

/// A peer timed by a Python script: its package and the script's name.
const SCRIPTS: [(&str, &str, &str); 2] = [
    ("libigl", "igl", "libigl_time.py"),
    ("Blender", "bpy", "blender_time.py"),
];

/// Pliant's row and each peer's, for horse.ply as it is and subdivided.
pub fn rows(scale: Scale) -> Result<Vec<Row>, String> {
    let peers = crate::root().join("../shared/peers");
    let mesh = crate::root().join("../shared/data/scans/horse.ply");
    if !peers.is_dir() || !mesh.is_file() {
        return Ok(vec![said("peers", 0, "not here: ../shared/peers and ../shared/data")]);
    }
    let subdivisions: &[usize] = match scale {
        Scale::Usual => &[0, 1],
        Scale::Full => &[0, 1, 2],
    };
    let mut rows = Vec::new();
    for &level in subdivisions {
        let off = folder().join(format!("horse-{level}.off"));
        match scene(&peers, &mesh, level, &off) {
            None => rows.push(said("Pliant", level, "not installed: pip install numpy trimesh")),
            Some(()) => {
                let all = std::thread::available_parallelism().map_or(1, usize::from);
                let arguments = [off.display().to_string(), all.to_string()];
                for row in measured("pliant-deform", "linear", &arguments)? {
                    rows.push(named("Pliant", level).and(row));
                }
            }
        }
        for (name, package, script) in SCRIPTS {
            rows.push(script_row(&peers, &mesh, level, name, package, script));
        }
        rows.push(cgal(&peers, &off, level));
    }
    Ok(rows)
}

fn named(peer: &str, level: usize) -> Row {
    Row::default().text("peer", peer).number("subdivided", level as f64)
}

fn said(peer: &str, level: usize, sentence: &str) -> Row {
    named(peer, level).text("says", sentence)
}

/// Writes the mesh as the peers see it.
fn scene(peers: &Path, mesh: &Path, level: usize, off: &Path) -> Option<()> {
    if off.exists() {
        return Some(());
    }
    std::fs::create_dir_all(folder()).ok()?;
    let (script, edit) = (peers.join("scene.py"), off.with_extension("edit.json"));
    let words = [script.as_path(), mesh, Path::new(&level.to_string()), off, &edit].map(|p| p.display().to_string());
    output("python3", &words.each_ref().map(String::as_str)).map(|_| ())
}

fn script_row(peers: &Path, mesh: &Path, level: usize, name: &str, package: &str, script: &str) -> Row {
    if output("python3", &["-c", &format!("import {package}, numpy, trimesh")]).is_none() {
        let wanted = if package == "igl" { "libigl scipy" } else { package };
        return said(
            name,
            level,
            &format!("not installed: pip install {wanted} numpy trimesh"),
        );
    }
    let words = [
        peers.join(script).display().to_string(),
        mesh.display().to_string(),
        level.to_string(),
    ];
    match output("python3", &words.each_ref().map(String::as_str)) {
        Some(text) => said(name, level, &last_lines(&text)),
        None => said(name, level, "failed"),
    }
}

/// CGAL's program, built here the first time.
fn cgal(peers: &Path, off: &Path, level: usize) -> Row {
    let program: PathBuf = folder().join("cgal_time");
    if !program.exists() {
        let source = peers.join("cgal_time.cpp");
        let built = Command::new("g++")
            .args(["-O3", "-march=native", "-DNDEBUG"])
            .arg(source)
            .args(["-I/usr/include/eigen3", "-lgmp", "-lmpfr", "-o"])
            .arg(&program)
            .stderr(std::process::Stdio::null())
            .status()
            .is_ok_and(|status| status.success());
        if !built {
            return said(
                "CGAL",
                level,
                "not installed: apt-get install g++ libcgal-dev libeigen3-dev",
            );
        }
    }
    match output(&program.display().to_string(), &[&off.display().to_string()]) {
        Some(text) => said("CGAL", level, &last_lines(&text)),
        None => said("CGAL", level, "failed"),
    }
}

/// What a script says, on one line.
fn last_lines(text: &str) -> String {
    let lines: Vec<&str> = text.lines().map(str::trim).filter(|line| !line.is_empty()).collect();
    lines.join("; ")
}
