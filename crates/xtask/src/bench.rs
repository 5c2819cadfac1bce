//! `cargo xtask bench`: measurements as tables, on creatures of several sizes.

use std::path::{Path, PathBuf};
use std::process::Stdio;

use crate::assets::{creature_of, glb};
use crate::process::{cargo, succeed, target_folder};

/// How large the meshes get.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Scale {
    /// Up to 600 thousand triangles.
    Usual,
    /// Up to 5 million.
    Full,
}

/// One table. Later parts add theirs to [`SECTIONS`].
struct Section {
    name: &'static str,
    title: &'static str,
    print: fn(Scale) -> Result<(), String>,
}

const SECTIONS: &[Section] = &[Section {
    name: "frames",
    title: "Binding and drag frames: `pliant apply --frames 60 --report` of assets/creature.edit.json, milliseconds",
    print: frames,
}];

/// Builds Pliant and prints the sections that `names` asks for, or all.
///
/// # Errors
/// One sentence naming an unknown section or what failed.
pub fn bench(names: &[String], scale: Scale) -> Result<(), String> {
    if let Some(name) = names
        .iter()
        .find(|name| SECTIONS.iter().all(|section| section.name != name.as_str()))
    {
        let known = SECTIONS
            .iter()
            .map(|section| section.name)
            .collect::<Vec<_>>()
            .join(", ");
        return Err(format!("There is no section `{name}`; there are: {known}."));
    }
    succeed(&mut cargo(&[
        "build",
        "--locked",
        "--release",
        "--package",
        "pliant-app",
        "--bin",
        "pliant",
    ]))?;
    for section in SECTIONS
        .iter()
        .filter(|section| names.is_empty() || names.iter().any(|name| name == section.name))
    {
        println!("\n{}: {}", section.name, section.title);
        (section.print)(scale)?;
    }
    Ok(())
}

/// A row for every size and for one and all threads.
fn frames(scale: Scale) -> Result<(), String> {
    let columns = [
        "free_vertices",
        "load_ms",
        "order_ms",
        "bind_ms",
        "median_ms",
        "p95_ms",
        "max_ms",
        "normals_ms",
    ];
    print!("{:>9} {:>7}", "triangles", "threads");
    columns.iter().for_each(|column| print!(" {column:>13}"));
    println!();
    let sizes: &[usize] = match scale {
        Scale::Usual => &[60_000, 200_000, 600_000],
        Scale::Full => &[60_000, 200_000, 600_000, 5_000_000],
    };
    let all = std::thread::available_parallelism().map_or(1, usize::from);
    let folder = target_folder().join("bench");
    for &triangles in sizes {
        let file = creature(&folder, triangles)?;
        for threads in [1, all] {
            let report = folder.join("report.json");
            apply(&file, &folder.join("edited.glb"), &report, threads)?;
            let text =
                std::fs::read_to_string(&report).map_err(|e| format!("{} can't be read: {e}.", report.display()))?;
            print!("{triangles:>9} {threads:>7}");
            for column in columns {
                match number(&text, column) {
                    Some(value) => print!(" {value:>13.2}"),
                    None => print!(" {:>13}", "-"),
                }
            }
            println!();
        }
    }
    Ok(())
}

/// The creature at one size, made once and kept.
fn creature(folder: &Path, triangles: usize) -> Result<PathBuf, String> {
    let path = folder.join(format!("creature-{triangles}.glb"));
    if !path.exists() {
        let mesh = creature_of(triangles)?;
        std::fs::create_dir_all(folder)
            .and_then(|()| std::fs::write(&path, glb::write(&mesh, "creature")))
            .map_err(|e| format!("{} can't be written: {e}.", path.display()))?;
    }
    Ok(path)
}

fn apply(file: &Path, output: &Path, report: &Path, threads: usize) -> Result<(), String> {
    let mut command = cargo(&[
        "run",
        "--locked",
        "--quiet",
        "--release",
        "--package",
        "pliant-app",
        "--bin",
        "pliant",
    ]);
    command
        .args(["--", "apply"])
        .arg(file)
        .args(["--edit", "assets/creature.edit.json", "--frames", "60"]);
    command
        .arg("--output")
        .arg(output)
        .arg("--report")
        .arg(report)
        .args(["--threads", &threads.to_string()]);
    succeed(command.stdout(Stdio::null()))
}

/// The number behind the first member of this name in a report of our own.
fn number(report: &str, name: &str) -> Option<f64> {
    let (_, rest) = report.split_once(&format!("\"{name}\""))?;
    let rest = rest.trim_start().strip_prefix(':')?.trim_start();
    let end = rest
        .find(|c: char| !matches!(c, '0'..='9' | '.' | '-' | '+' | 'e' | 'E'))
        .unwrap_or(rest.len());
    rest[..end].parse().ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_found_by_name() {
        let report = "{\"bind_ms\" : 150.25,\n \"frames\": {\"median_ms\":9e-1}}";
        assert_eq!(number(report, "bind_ms"), Some(150.25));
        assert_eq!(number(report, "median_ms"), Some(0.9));
        assert_eq!(number(report, "max_ms"), None);
        assert_eq!(number(report, "frames"), None);
    }
}
