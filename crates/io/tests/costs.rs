//! Small files that ask for much: their costs grow in proportion to their bytes, and stay within a stated budget.
//!
//! This is the only test in its program, because it counts the allocations of all threads.
#![allow(clippy::unwrap_used, clippy::expect_used, reason = "a test fails by panicking")]

#[path = "../examples/counting/mod.rs"]
mod counting;
mod hostile;

use std::sync::atomic::Ordering;

use counting::{ALLOCATED, Counting, HELD, PEAK};
use glam::DVec3;
use hostile::{Hostile, MAKERS};
use pliant_io::{Bytes, Format, MorphTarget, Placement, ReadError, Resolver, Save, SceneAndDrawn, read};
use pliant_mesh::{Cancel, Inspection, Progress, WeldOptions};

#[global_allocator]
static ALLOCATOR: Counting = Counting;

struct Beside(Bytes);

impl Resolver for Beside {
    fn read(&self, _: &str) -> Result<Bytes, String> {
        Ok(self.0.clone())
    }
}

fn opened(file: &Hostile, cancel: &Cancel) -> Result<SceneAndDrawn, ReadError> {
    let beside = Beside(file.beside.clone().into());
    read(file.bytes.clone(), file.format, "in", &beside, &Progress::new(), cancel)
}

/// The bytes that reading, inspecting and saving allocate in all, and hold at most.
fn cost(file: &Hostile) -> [usize; 2] {
    let before = ALLOCATED.load(Ordering::Relaxed);
    let held = HELD.load(Ordering::Relaxed);
    PEAK.store(held, Ordering::Relaxed);
    let cancel = Cancel::new();
    if let Ok(opened) = opened(file, &cancel) {
        drop(opened.scene.appearance());
        drop(opened.scene.objects());
        let inspection = Inspection::of(opened.drawn.clone(), &WeldOptions::default(), &Progress::new(), &cancel);
        drop(inspection.unwrap());
        let positions: Vec<DVec3> = opened.drawn.positions.iter().map(|p| *p * 0.5 + DVec3::ONE).collect();
        for (format, placement) in [
            (file.format, Placement::SameFile),
            (Format::Glb, Placement::OtherFolder),
            (Format::Obj, Placement::OtherFolder),
        ] {
            let save = Save {
                deltas: pliant_io::MorphDeltas::WhereFarOff,
                turned: &[],
                drawn: &opened.drawn,
                positions: &positions,
                format,
                name: "out",
                placement,
            };
            let _ = opened.scene.save(&save, &Progress::new(), &cancel);
        }
        let save = Save {
            deltas: pliant_io::MorphDeltas::WhereFarOff,
            turned: &[],
            drawn: &opened.drawn,
            positions: &positions,
            format: Format::Glb,
            name: "out",
            placement: Placement::OtherFolder,
        };
        let target = MorphTarget { name: "x", weight: 1.0 };
        let _ = opened.scene.save_as_morph(&save, &target, &Progress::new(), &cancel);
        drop(opened.scene.differences(&opened.drawn, &opened.scene, &opened.drawn));
    }
    [
        ALLOCATED.load(Ordering::Relaxed) - before,
        PEAK.load(Ordering::Relaxed) - held,
    ]
}

/// Files in which one line, face, record or mesh is as long as the file, with the number of cancellation checks while
/// reading them.
const LONG: [(&str, usize); 8] = [
    ("primitives of one accessor", 100),
    ("a face of many corners, OBJ", 6),
    ("a face of many corners, OFF", 6),
    ("a face of many corners, PLY", 6),
    ("polygons of 256 corners", 6),
    ("materials and groups, OBJ", 6),
    ("solids, STL", 6),
    ("elements, PLY", 6),
];

#[test]
fn what_a_file_costs_grows_as_its_bytes_do() {
    // The threads, and everything that is made once.
    cost(&hostile::many_primitives(10));
    let mut faults = Vec::new();
    for (name, make, size) in MAKERS {
        let (small, large) = (make(size), make(2 * size));
        let [[all, most], [all_of_twice, most_of_twice]] = [&small, &large].map(cost);
        if all_of_twice > 3 * all + (4 << 20) {
            faults.push(format!(
                "{name}: {all} bytes are allocated, and {all_of_twice} for a file twice as large"
            ));
        }
        for (file, most) in [(small, most), (large, most_of_twice)] {
            let bytes = file.bytes.len() + file.beside.len();
            if most > 200 * bytes + (600 << 20) {
                faults.push(format!("{name}: {most} bytes are held for a file of {bytes}"));
            }
        }
    }
    for (name, looks) in LONG {
        let (.., make, size) = MAKERS.into_iter().find(|(other, ..)| *other == name).unwrap();
        let refused = opened(&make(10 * size), &Cancel::after_looks(looks));
        if !matches!(refused, Err(ReadError::Cancelled(_))) {
            faults.push(format!("{name}: it is read to its end however often it is cancelled"));
        }
    }
    assert!(faults.is_empty(), "{faults:#?}");
}
