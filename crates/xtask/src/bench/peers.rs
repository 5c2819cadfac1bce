//! Other programs on the same edit, in the same run: the times of the scripts in `PLIANT_PEERS` on this machine, and
//! Pliant's speed relative to theirs.

use std::path::{Path, PathBuf};
use std::process::Command;

use super::beside;
use super::scale::Scale;
use super::table::{Row, folder, measured};
use crate::process::output;

/// A comparison of a peer's printed time with the columns of Pliant's rows for the same work.
struct Versus {
    /// The beginning of the peer's line.
    line: &'static str,
    /// The word before its milliseconds.
    does: &'static str,
    /// The kind of Pliant's row.
    ours: Ours,
    columns: &'static [&'static str],
}

/// Pliant's own measurements.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
enum Ours {
    Linear,
    Laplacian,
    SpokesAndRims,
    Smooth,
}

const FRAME: &[&str] = &["frame", "drawn", "normals"];
const DRAG: &[&str] = &["frame", "normals"];
const BEGIN: &[&str] = &["order", "bind"];

#[rustfmt::skip]
const VERSUS: [Versus; 15] = [
    Versus { line: "libigl bilaplacian", does: "precompute", ours: Ours::Linear, columns: BEGIN },
    Versus { line: "libigl bilaplacian", does: "precompute", ours: Ours::Linear, columns: &["bind"] },
    Versus { line: "libigl bilaplacian", does: "precompute", ours: Ours::Linear, columns: &["rebind"] },
    Versus { line: "libigl bilaplacian", does: "solve", ours: Ours::Linear, columns: &["substitute3"] },
    Versus { line: "libigl bilaplacian", does: "solve", ours: Ours::Linear, columns: FRAME },
    Versus { line: "blender laplacian-deform", does: "bind", ours: Ours::Linear, columns: BEGIN },
    Versus { line: "blender laplacian-deform", does: "move", ours: Ours::Linear, columns: FRAME },
    Versus { line: "blender laplacian-deform", does: "bind", ours: Ours::Laplacian, columns: &["bind"] },
    Versus { line: "blender laplacian-deform", does: "move", ours: Ours::Laplacian, columns: DRAG },
    Versus { line: "libigl arap", does: "precompute", ours: Ours::SpokesAndRims, columns: BEGIN },
    Versus { line: "libigl arap", does: "iteration", ours: Ours::SpokesAndRims, columns: &["step"] },
    Versus { line: "cgal spokes-and-rims", does: "preprocess", ours: Ours::SpokesAndRims, columns: BEGIN },
    Versus { line: "cgal spokes-and-rims", does: "iteration", ours: Ours::SpokesAndRims, columns: &["step"] },
    Versus { line: "cgal sr-arap", does: "preprocess", ours: Ours::Smooth, columns: BEGIN },
    Versus { line: "cgal sr-arap", does: "iteration", ours: Ours::Smooth, columns: &["step"] },
];

/// One row per comparison, for horse.ply unchanged and subdivided.
pub fn rows(scale: Scale) -> Result<Vec<Row>, String> {
    let peers = beside::peers();
    let mesh = beside::data().join("scans/horse.ply");
    if !peers.is_dir() || !mesh.is_file() {
        return Ok(vec![said(0, "not here: the folders PLIANT_PEERS and PLIANT_DATA")]);
    }
    let subdivisions: &[usize] = match scale {
        Scale::Usual => &[0, 1],
        Scale::Full => &[0, 1, 2],
    };
    let mut rows = Vec::new();
    for &level in subdivisions {
        let off = folder().join(format!("horse-{level}.off"));
        if scene(&peers, &mesh, level, &off).is_none() {
            rows.push(said(level, "not installed: pip install numpy trimesh"));
            continue;
        }
        let mut lines = String::new();
        for peer in [
            script(&peers, &mesh, level, "igl", "libigl_time.py"),
            cgal(&peers, &off),
            script(&peers, &mesh, level, "bpy", "blender_time.py"),
        ] {
            match peer {
                Ok(said) => lines.push_str(&said),
                Err(sentence) => rows.push(said(level, &sentence)),
            }
        }
        rows.extend(compared(&off, level, &lines)?);
    }
    Ok(rows)
}

/// One row for each comparison whose line a peer printed.
fn compared(off: &Path, level: usize, lines: &str) -> Result<Vec<Row>, String> {
    let mut measurements: Vec<(Ours, Row)> = Vec::new();
    let mut rows = Vec::new();
    for versus in &VERSUS {
        let line = lines.lines().find(|line| line.starts_with(versus.line));
        let Some(theirs) = line.and_then(|line| word_after(line, versus.does)) else {
            continue;
        };
        // Blender reports failure only on standard error; then no vertex has moved.
        let found = !line.is_some_and(|line| line.contains("bound False") || line.contains("moved 0.0000"));
        if !measurements.iter().any(|(ours, _)| *ours == versus.ours) {
            measurements.push((versus.ours, versus.ours.measure(off)?));
        }
        let ours = measurements.iter().find(|(ours, _)| *ours == versus.ours);
        let times = |column: &&str| ours.and_then(|(_, row)| row.get(column)?.parse::<f64>().ok());
        let Some(ms) = versus.columns.iter().map(times).sum::<Option<f64>>() else {
            return Err(format!("Pliant's rows have no column for one of {:?}.", versus.columns));
        };
        rows.push(
            Row::default()
                .number("subdivided", level as f64)
                .text("peer", versus.line)
                .text("does", versus.does)
                .text("solved", if found { "yes" } else { "no" })
                .number("ms", theirs)
                .text("Pliant", &format!("{:?}: {}", versus.ours, versus.columns.join(" + ")))
                .number("its_ms", ms)
                .number("times_faster", theirs / ms),
        );
    }
    Ok(rows)
}

impl Ours {
    fn measure(self, off: &Path) -> Result<Row, String> {
        let all = std::thread::available_parallelism().map_or(1, usize::from);
        let arguments = [off.display().to_string(), all.to_string()];
        let (example, further): (_, &[&str]) = match self {
            Self::Linear => ("linear", &[]),
            Self::Laplacian => ("differential", &["laplacian"]),
            Self::SpokesAndRims => ("steps", &["arap", "spokes-and-rims"]),
            Self::Smooth => ("steps", &["arap", "smooth"]),
        };
        let arguments: Vec<String> = arguments
            .into_iter()
            .chain(further.iter().map(|&word| word.to_owned()))
            .collect();
        let rows = measured("pliant-deform", example, &arguments)?;
        rows.into_iter()
            .next()
            .ok_or_else(|| format!("The example {example} printed no row."))
    }
}

/// The number after a word: `word_after("bind 17 ms", "bind")` is 17.
fn word_after(line: &str, word: &str) -> Option<f64> {
    line.split_whitespace().skip_while(|w| *w != word).nth(1)?.parse().ok()
}

fn said(level: usize, sentence: &str) -> Row {
    Row::default().number("subdivided", level as f64).text("says", sentence)
}

/// Writes the mesh in the format that the peers read.
fn scene(peers: &Path, mesh: &Path, level: usize, off: &Path) -> Option<()> {
    if off.exists() {
        return Some(());
    }
    std::fs::create_dir_all(folder()).ok()?;
    let (script, edit) = (peers.join("scene.py"), off.with_extension("edit.json"));
    let words = [script.as_path(), mesh, Path::new(&level.to_string()), off, &edit].map(|p| p.display().to_string());
    output("python3", &words.each_ref().map(String::as_str)).map(|_| ())
}

/// The output of a peer's Python script.
fn script(peers: &Path, mesh: &Path, level: usize, package: &str, script: &str) -> Result<String, String> {
    if output("python3", &["-c", &format!("import {package}, numpy, scipy, trimesh")]).is_none() {
        let wanted = if package == "igl" { "libigl" } else { package };
        return Err(format!("not installed: pip install {wanted} numpy scipy trimesh"));
    }
    let words =
        [peers.join(script), mesh.to_owned(), PathBuf::from(level.to_string())].map(|p| p.display().to_string());
    output("python3", &words.each_ref().map(String::as_str)).ok_or_else(|| format!("{script} failed"))
}

/// The output of CGAL's program, which is built on first use.
fn cgal(peers: &Path, off: &Path) -> Result<String, String> {
    let program: PathBuf = folder().join("cgal_time");
    if !program.exists() {
        let built = Command::new("g++")
            .args(["-O3", "-march=native", "-DNDEBUG"])
            .arg(peers.join("cgal_time.cpp"))
            .args(["-I/usr/include/eigen3", "-lgmp", "-lmpfr", "-o"])
            .arg(&program)
            .stderr(std::process::Stdio::null())
            .status()
            .is_ok_and(|status| status.success());
        if !built {
            return Err("not installed: apt-get install g++ libcgal-dev libeigen3-dev".to_owned());
        }
    }
    output(&program.display().to_string(), &[&off.display().to_string()]).ok_or_else(|| "cgal_time failed".to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_peers_times_are_found_by_the_word_before_them() {
        let line = "libigl bilaplacian n=193934 precompute 9046 ms  solve 184.2 ms";
        assert_eq!(word_after(line, "precompute"), Some(9046.0));
        assert_eq!(word_after(line, "solve"), Some(184.2));
        assert_eq!(word_after(line, "iteration"), None);
    }
}
