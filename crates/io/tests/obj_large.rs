//! How long a large OBJ file takes: run with `--ignored --nocapture`.
#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    clippy::print_stderr,
    reason = "a measurement speaks"
)]

mod text;

use std::fmt::Write;
use std::time::Instant;

use glam::DVec3;
use pliant_io::Format;
use text::{moved, open, save, save_as};

/// A wavy sheet of n × n vertices, as scanners write them.
fn sheet(n: usize) -> String {
    let mut text = String::new();
    for k in 0..n * n {
        let (x, y) = ((k % n) as f64 / n as f64, (k / n) as f64 / n as f64);
        writeln!(text, "v {x:.6} {y:.6} {:.6}", (x * 20.0).sin() * (y * 17.0).cos() * 0.1).unwrap();
    }
    for k in (0..n * (n - 1)).filter(|k| k % n + 1 < n) {
        let [a, b, c, d] = [k + 1, k + 2, k + n + 2, k + n + 1];
        write!(text, "f {a} {b} {c}\nf {a} {c} {d}\n").unwrap();
    }
    text
}

#[test]
#[ignore = "a measurement"]
fn a_million_triangles_take_about_a_second() {
    let text = sheet(708);
    let megabytes = text.len() as f64 / 1e6;
    let start = Instant::now();
    let opened = open(text.as_bytes(), Format::Obj);
    let read_s = start.elapsed().as_secs_f64();
    let positions = moved(&opened, |_| true, |p| p + DVec3::new(0.1, 0.2, 0.3) * p.x);
    eprintln!(
        "{} triangles, {megabytes:.0} MB: read in {read_s:.2} s",
        opened.drawn.triangles.len()
    );
    let start = Instant::now();
    let bytes = save(&opened, &positions);
    eprintln!(
        "every vertex moved: {:.0} MB saved in {:.2} s",
        bytes.len() as f64 / 1e6,
        start.elapsed().as_secs_f64()
    );
    for format in [Format::Ply, Format::Stl, Format::Off, Format::Obj] {
        let bytes = save_as(&opened, &positions, format).files.swap_remove(0).bytes;
        let start = Instant::now();
        let again = open(&bytes, format);
        let (count, read_s) = (again.drawn.triangles.len(), start.elapsed().as_secs_f64());
        eprintln!(
            "{format}: {count} triangles, {:.0} MB: read in {read_s:.2} s",
            bytes.len() as f64 / 1e6
        );
    }
    assert!(read_s < 5.0);
}
