//! Puts broken files through every parser: `cargo run --release --example fuzz -p pliant-io -- SEED COUNT [KIND..]
//! [FILE..]`.
//!
//! It begins from the test corpus and from FILEs, of the KINDs alone if extensions such as `3mf` are given. COUNT may be
//! FIRST..END, because runs have numbers by which each can be repeated alone. It reports panics, runs beyond 5 s, and
//! the bytes that reading allocated, and keeps the files that caused them; it ends with status 1 after a panic, a slow
//! run or an allocation beyond 64 times the file. A slow run is repeated at once, and the shorter time counts: on a busy
//! machine a thread may have to wait. After 10 s of processor time a run that does not end is reported by its number,
//! and the program ends.

#![allow(clippy::print_stdout, clippy::print_stderr, reason = "an example speaks")]
#![allow(clippy::unwrap_used, clippy::expect_used, reason = "it measures, and fails loudly")]

mod counting;
#[path = "../tests/io/fuzzing/mod.rs"]
mod fuzzing;

use std::collections::BTreeMap;
use std::ops::Range;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;
use std::process::ExitCode;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::{Duration, Instant};

use counting::{Counting, LARGEST, cpu_ms};
use fuzzing::{Beside, Chance, Kind, Outcome, Sound, broken, corpus, exercise};
use pliant_io::Format;

/// Reading may allocate this many bytes at once for each byte of the file.
const MOST_GROWTH: usize = 64;

/// Bytes that any run may allocate at once: buffers of fixed size, and files of a few bytes.
const ANYWAY: usize = 1 << 20;

const SLOW: Duration = Duration::from_secs(5);

#[global_allocator]
static ALLOCATOR: Counting = Counting;

/// The run that is under way, for the watchdog.
static RUN: AtomicU64 = AtomicU64::new(0);

#[derive(Default)]
struct Tally {
    runs: u64,
    read: u64,
    panics: u64,
    slow: u64,
    /// Runs in which reading allocated more at once than the limit.
    large: u64,
    /// The largest single allocation in bytes per byte of the file, for files above the smallest size that counts.
    growth: f64,
    longest: Duration,
}

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let number = |text: &str| text.parse::<u64>().ok();
    let seed = arguments.first().and_then(|text| number(text));
    let runs = arguments.get(1).and_then(|text| match text.split_once("..") {
        None => Some(0..number(text)?),
        Some((first, end)) => Some(number(first)?..number(end)?),
    });
    let (Some(seed), Some(runs)) = (seed, runs) else {
        eprintln!("fuzz SEED COUNT|FIRST..END [KIND..] [FILE..]");
        return ExitCode::from(2);
    };
    let count = runs.end.saturating_sub(runs.start);
    let mut sound = corpus(&Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/corpus"));
    let (kinds, files): (Vec<&String>, Vec<&String>) = arguments[2..]
        .iter()
        .partition(|argument| Format::EXTENSIONS.contains(&argument.as_str()));
    for path in files {
        let format = Format::of_name(path).expect("a file of a known kind");
        sound.push(Sound {
            name: path.clone(),
            kind: Kind::Mesh(Format::ALL.iter().position(|other| *other == format).unwrap()),
            bytes: std::fs::read(path).expect("a file that can be read"),
        });
    }
    let is_wanted = |file: &Sound| match file.kind {
        Kind::Mesh(format) => kinds.iter().any(|kind| *kind == Format::EXTENSIONS[format]),
        Kind::Image => false,
    };
    if !kinds.is_empty() {
        sound.retain(is_wanted);
    }
    std::thread::spawn(|| {
        let mut last = (0, 0);
        let begin = Instant::now();
        loop {
            std::thread::sleep(Duration::from_millis(500));
            let run = RUN.load(Ordering::Relaxed);
            // On a busy machine the clock goes on while the run waits for the processor.
            let spent = cpu_ms("self").unwrap_or(begin.elapsed().as_millis() as u64);
            if run != last.0 {
                last = (run, spent);
            } else if run > 0 && u128::from(spent - last.1) > 2 * SLOW.as_millis() {
                // Runs are stored counted from 1.
                eprintln!("run {} does not end", run - 1);
                std::process::abort();
            }
        }
    });
    let tallies = fuzz(seed, runs, &sound);
    let mut is_clean = true;
    println!(
        "{:<6} {:>9} {:>9} {:>7} {:>5} {:>6} {:>9} {:>11}",
        "kind", "runs", "read", "panics", "slow", "large", "growth", "longest_ms"
    );
    for (kind, tally) in &tallies {
        is_clean &= tally.panics + tally.slow + tally.large == 0;
        println!(
            "{kind:<6} {:>9} {:>9} {:>7} {:>5} {:>6} {:>9.1} {:>11.1}",
            tally.runs,
            tally.read,
            tally.panics,
            tally.slow,
            tally.large,
            tally.growth,
            tally.longest.as_secs_f64() * 1e3
        );
    }
    println!("seed {seed}, {count} runs over {} sound files", sound.len());
    if is_clean { ExitCode::SUCCESS } else { ExitCode::FAILURE }
}

/// Each run has a seed of its own, so that one of them can be repeated alone.
fn fuzz(seed: u64, runs: Range<u64>, sound: &[Sound]) -> BTreeMap<String, Tally> {
    let mut tallies: BTreeMap<String, Tally> = BTreeMap::new();
    for run in runs {
        RUN.store(run + 1, Ordering::Relaxed);
        let mut chance = Chance(seed.wrapping_mul(0x1_0000_0001).wrapping_add(run));
        let file = chance.of(sound);
        let bytes = broken(file, sound, &mut chance);
        let other = *chance.of(&Format::ALL);
        let beside = Beside::of(sound, &mut chance);
        let kind = match file.kind {
            Kind::Mesh(format) => Format::ALL[format].extension().to_owned(),
            Kind::Image => "image".to_owned(),
        };
        let keep = |what: String| {
            let kept = std::env::temp_dir().join(format!("fuzz-{seed}-{run}-{}", file.name.replace('/', "_")));
            eprintln!("run {run} ({}) {what}; its file is {}", file.name, kept.display());
            let _ = std::fs::write(kept, &bytes);
        };
        let once = || {
            LARGEST.store(0, Ordering::Relaxed);
            let mut largest = 0;
            let start = Instant::now();
            let outcome = catch_unwind(AssertUnwindSafe(|| {
                exercise(&bytes, file.kind, other, &beside, || {
                    largest = LARGEST.load(Ordering::Relaxed)
                })
            }));
            (outcome, largest, start.elapsed())
        };
        let tally = tallies.entry(kind).or_default();
        let (outcome, largest, mut took) = once();
        if took > SLOW {
            let (.., again) = once();
            keep(format!(
                "took {:.1} s, and {:.3} s again",
                took.as_secs_f64(),
                again.as_secs_f64()
            ));
            took = took.min(again);
        }
        tally.runs += 1;
        tally.longest = tally.longest.max(took);
        tally.slow += u64::from(took > SLOW);
        // The neighbour counts as part of the file. An image's unpacked size is not measured: a plain image packs to
        // almost nothing.
        let size = (bytes.len() + beside.0.len()).max(1);
        if file.kind != Kind::Image {
            tally.growth = tally.growth.max(largest as f64 / size as f64);
            if largest > (MOST_GROWTH * size).max(ANYWAY) {
                tally.large += 1;
                keep(format!("allocated {largest} bytes at once for a file of {size}"));
            }
        }
        match outcome {
            Ok(outcome) => tally.read += u64::from(outcome == Outcome::Read),
            Err(_) => {
                tally.panics += 1;
                keep("panicked".to_owned());
            }
        }
    }
    tallies
}
