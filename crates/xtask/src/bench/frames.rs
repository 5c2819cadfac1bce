//! Binding and drag frames, from the command line's own report: the times for which a user waits.

use std::path::Path;
use std::process::Stdio;

use super::meshes::{creature_glb, sizes};
use super::scale::Scale;
use super::table::{Row, folder, release};
use crate::process::succeed;

const COLUMNS: [&str; 8] = [
    "free_vertices",
    "load_ms",
    "order_ms",
    "bind_ms",
    "median_ms",
    "p95_ms",
    "max_ms",
    "normals_ms",
];

/// One row per size, for one and for all threads.
pub fn rows(scale: Scale) -> Result<Vec<Row>, String> {
    let all = std::thread::available_parallelism().map_or(1, usize::from);
    let mut rows = Vec::new();
    for &vertices in sizes(scale) {
        // A closed surface has about two triangles per vertex.
        let triangles = 2 * vertices;
        let file = creature_glb(triangles)?;
        for threads in [1, all] {
            let report = folder().join("report.json");
            apply(&file, &folder().join("edited.glb"), &report, threads)?;
            let text =
                std::fs::read_to_string(&report).map_err(|e| format!("{} can't be read: {e}.", report.display()))?;
            let mut row = Row::default()
                .number("triangles", triangles as f64)
                .number("threads", threads as f64);
            for column in COLUMNS {
                row = match number(&text, column) {
                    Some(value) => row.number(column, value),
                    None => row.text(column, "-"),
                };
            }
            rows.push(row);
        }
    }
    Ok(rows)
}

fn apply(file: &Path, output: &Path, report: &Path, threads: usize) -> Result<(), String> {
    let mut command = release("pliant-app", ["--bin", "pliant"]);
    command
        .arg("apply")
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

/// The number of the first member with this name in a report.
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
