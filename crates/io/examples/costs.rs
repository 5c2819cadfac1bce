//! The costs of small files that ask for much: `cargo run --release --example costs -p pliant-io -- [FACTOR] [NAME]`.
//!
//! It prints, for each maker's file at its size and at twice that, times FACTOR: bytes, peak memory, and the seconds
//! for reading, inspecting and saving. With NAME it runs only makers whose names contain it.

#![allow(clippy::print_stdout, clippy::unwrap_used, reason = "an example speaks")]

mod counting;
#[path = "../tests/hostile/mod.rs"]
mod hostile;

use std::sync::atomic::Ordering;
use std::time::Instant;

use counting::{Counting, HELD, PEAK};
use glam::DVec3;
use hostile::{Hostile, MAKERS};
use pliant_io::{Bytes, Format, MorphTarget, Placement, Resolver, Save, read};
use pliant_mesh::{Cancel, Inspection, Progress, WeldOptions};

#[global_allocator]
static ALLOCATOR: Counting = Counting;

struct Beside(Bytes);

impl Resolver for Beside {
    fn read(&self, _: &str) -> Result<Bytes, String> {
        Ok(self.0.clone())
    }
}

fn main() {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let factor: usize = arguments.first().and_then(|text| text.parse().ok()).unwrap_or(1);
    let name = arguments.get(1).map_or("", String::as_str);
    for (called, make, size) in MAKERS.iter().filter(|(called, ..)| called.contains(name)) {
        for size in [size * factor, 2 * size * factor] {
            let file = make(size);
            let bytes = file.bytes.len() + file.beside.len();
            let mut line = format!("{called:<42} {:>9}", bytes);
            for (work, seconds, peak) in costs(&file) {
                line += &format!("  {work} {seconds:>6.2} s {:>7.1} MB", peak as f64 / 1e6);
            }
            println!("{line}");
        }
    }
}

fn costs(file: &Hostile) -> Vec<(&'static str, f64, usize)> {
    let mut out = Vec::new();
    let mut measured = |what, start: Instant| {
        out.push((what, start.elapsed().as_secs_f64(), PEAK.load(Ordering::Relaxed)));
        PEAK.store(HELD.load(Ordering::Relaxed), Ordering::Relaxed);
    };
    PEAK.store(HELD.load(Ordering::Relaxed), Ordering::Relaxed);
    let (progress, cancel) = (Progress::new(), Cancel::new());
    let beside = Beside(file.beside.clone().into());
    let start = Instant::now();
    let opened = read(file.bytes.clone(), file.format, "in", &beside, &progress, &cancel);
    measured("read", start);
    let Ok(opened) = opened else { return out };
    let start = Instant::now();
    let inspection = Inspection::of(opened.drawn.clone(), &WeldOptions::default(), &progress, &cancel).unwrap();
    drop(inspection);
    measured("weld", start);
    let start = Instant::now();
    let looks = opened.scene.appearance();
    opened.scene.objects();
    measured("look", start);
    drop(looks);
    let positions: Vec<DVec3> = opened.drawn.positions.iter().map(|p| *p * 0.5 + DVec3::ONE).collect();
    for format in [file.format, Format::Glb, Format::Gltf, Format::Obj] {
        let name = format!("out.{}", format.extension());
        let save = Save {
            deltas: pliant_io::MorphDeltas::WhereFarOff,
            turned: &[],
            drawn: &opened.drawn,
            positions: &positions,
            format,
            name: &name,
            placement: Placement::OtherFolder,
        };
        let start = Instant::now();
        let saved = opened.scene.save(&save, &progress, &cancel);
        drop(saved);
        measured(format.extension(), start);
    }
    let save = Save {
        deltas: pliant_io::MorphDeltas::WhereFarOff,
        turned: &[],
        drawn: &opened.drawn,
        positions: &positions,
        format: Format::Glb,
        name: "out.glb",
        placement: Placement::OtherFolder,
    };
    let start = Instant::now();
    let _ = opened
        .scene
        .save_as_morph(&save, &MorphTarget { name: "x", weight: 1.0 }, &progress, &cancel);
    measured("morph", start);
    let start = Instant::now();
    let again = read(file.bytes.clone(), file.format, "in", &beside, &progress, &cancel).unwrap();
    opened.scene.differences(&opened.drawn, &again.scene, &again.drawn);
    measured("diff", start);
    out
}
