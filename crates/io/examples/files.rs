//! The speed of reading and saving: `files FILE [KIND..]` prints a JSON object a line for FILE and for the same mesh as
//! each KIND (obj, ply, ..), which is written beside it: megabytes a second, and those of a plain read of the file,
//! medians of several rounds. `cargo xtask bench files` makes a table of them.
//!
//! The time of saving is that of making the file's bytes in its own format with every vertex moved, without writing
//! them to disk. Memory is in multiples of the file, which is included: the peak while the file was read, inspected
//! (`pliant info`) and opened for editing, and the memory held once it is open.

#![allow(
    clippy::print_stdout,
    clippy::expect_used,
    reason = "an example speaks, and fails loudly"
)]

mod counting;

use std::path::{Path, PathBuf};
use std::sync::atomic::Ordering;
use std::time::Instant;

use counting::{Counting, HELD, PEAK};

use glam::DVec3;
use pliant_io::{Bytes, Format, Placement, Resolver, Save, SceneAndDrawn, read};
use pliant_mesh::{Cancel, Inspection, Model, Progress, WeldOptions};

#[global_allocator]
static ALLOCATOR: Counting = Counting;

/// Bench files have no neighbours.
struct Alone;

impl Resolver for Alone {
    fn read(&self, _: &str) -> Result<Bytes, String> {
        Err("it stands alone".to_owned())
    }
}

/// The number of rounds of each measurement; the median counts.
const ROUNDS: usize = 3;

fn main() {
    let mut arguments = std::env::args().skip(1);
    let first = PathBuf::from(arguments.next().expect("files FILE [KIND..]"));
    let mut paths = vec![first.clone()];
    for kind in arguments {
        let path = first.with_extension(&kind);
        if !path.exists() {
            convert(&first, &path);
        }
        paths.push(path);
    }
    paths.iter().for_each(|path| measure(path));
}

fn convert(from: &Path, to: &Path) {
    let name = |path: &Path| path.file_name().unwrap_or_default().to_string_lossy().into_owned();
    let format = |path: &Path| Format::of_name(&name(path)).expect("a file of a known kind");
    let bytes = std::fs::read(from).expect("a file that can be read");
    let opened = open(bytes, format(from), &name(from));
    let saved = opened.scene.save(
        &Save {
            deltas: pliant_io::MorphDeltas::WhereFarOff,
            turned: &[],
            drawn: &opened.drawn,
            positions: &opened.drawn.positions,
            format: format(to),
            name: &name(to),
            placement: Placement::OtherFolder,
        },
        &Progress::new(),
        &Cancel::new(),
    );
    let saved = saved.expect("a mesh that every kind holds");
    std::fs::write(to, &saved.files[0].bytes).expect("a folder that can be written");
}

fn measure(path: &Path) {
    let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
    let format = Format::of_name(&name).expect("a file of a known kind");
    let plain_s = median(|| {
        let start = Instant::now();
        std::hint::black_box(std::fs::read(path).expect("a file that can be read"));
        start.elapsed().as_secs_f64()
    });
    let mut opened = None;
    let read_s = median(|| {
        opened = None;
        let start = Instant::now();
        let bytes = std::fs::read(path).expect("a file that can be read");
        opened = Some(open(bytes, format, &name));
        start.elapsed().as_secs_f64()
    });
    let opened = opened.expect("it was read just now");
    let by = DVec3::new(0.01, 0.02, 0.03);
    let positions: Vec<DVec3> = opened.drawn.positions.iter().map(|p| *p + by).collect();
    let save_s = median(|| {
        let start = Instant::now();
        let save = Save {
            deltas: pliant_io::MorphDeltas::WhereFarOff,
            turned: &[],
            drawn: &opened.drawn,
            positions: &positions,
            format,
            name: &name,
            placement: Placement::OtherFolder,
        };
        std::hint::black_box(
            opened
                .scene
                .save(&save, &Progress::new(), &Cancel::new())
                .expect("a file that can be saved"),
        );
        start.elapsed().as_secs_f64()
    });
    drop((opened, positions));
    let size = std::fs::metadata(path).map_or(0, |metadata| metadata.len());
    let read_again = || open(std::fs::read(path).expect("a file that can be read"), format, &name);
    let welding = WeldOptions::default();
    let (triangles, read_peak, _) = memory(|| {
        let opened = read_again();
        (opened.drawn.triangles.len(), opened)
    });
    let (look_s, look_peak, _) = memory(|| {
        let opened = read_again();
        let start = Instant::now();
        let inspection = Inspection::of(opened.drawn, &welding, &Progress::new(), &Cancel::new());
        (start.elapsed().as_secs_f64(), (opened.scene, inspection))
    });
    let (weld_s, edit_peak, edit_held) = memory(|| {
        let opened = read_again();
        let start = Instant::now();
        let model = Model::weld(opened.drawn, &welding, &Progress::new(), &Cancel::new());
        (start.elapsed().as_secs_f64(), (opened.scene, model))
    });
    let (megabytes, of_file) = (size as f64 / 1e6, |bytes: usize| bytes as f64 / size as f64);
    println!(
        "{{\"file\":\"{name}\",\"megabytes\":{megabytes:.1},\"triangles\":{triangles},\"plain_mb_s\":{:.0},\"load_mb_s\":{:.0},\"save_mb_s\":{:.0},\"survey_ms\":{:.0},\"weld_ms\":{:.0},\"read_peak\":{:.2},\"survey_peak\":{:.2},\"open_peak\":{:.2},\"open_held\":{:.2}}}",
        megabytes / plain_s,
        megabytes / read_s,
        megabytes / save_s,
        look_s * 1e3,
        weld_s * 1e3,
        of_file(read_peak),
        of_file(look_peak),
        of_file(edit_peak),
        of_file(edit_held),
    );
}

/// The first result of `work`, the most bytes that it held at once, and the bytes that its second result holds at the
/// end.
fn memory<T, Kept>(work: impl FnOnce() -> (T, Kept)) -> (T, usize, usize) {
    let before = HELD.load(Ordering::Relaxed);
    PEAK.store(before, Ordering::Relaxed);
    let (told, kept) = work();
    let (peak, held) = (PEAK.load(Ordering::Relaxed), HELD.load(Ordering::Relaxed));
    drop(kept);
    (told, peak.saturating_sub(before), held.saturating_sub(before))
}

fn open(bytes: Vec<u8>, format: Format, name: &str) -> SceneAndDrawn {
    read(bytes, format, name, &Alone, &Progress::new(), &Cancel::new()).expect("a sound file")
}

fn median(mut once: impl FnMut() -> f64) -> f64 {
    let mut times: Vec<f64> = (0..ROUNDS).map(|_| once()).collect();
    times.sort_by(f64::total_cmp);
    times[ROUNDS / 2]
}
