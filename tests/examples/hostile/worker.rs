//! The child: it runs cases by their numbers, and reports each command before it runs and each case's end.

use std::ffi::OsString;
use std::io::{BufRead as _, Write as _};
use std::path::Path;
use std::sync::atomic::Ordering::Relaxed;

use pliant_tests::hostile::{Case, Kind, Meter, Size, Used, exercise, listen_for_panics};
use serde_json::json;

use crate::counting::{HELD, LIMIT, PEAK, cpu_ms};

/// The memory limit of the commands, in addition to the process's earlier memory.
const MEMORY: usize = 2 << 30;

/// Works until standard input ends. A case is a line: its number, its kind, and the changes to leave out.
pub fn work(scratch: &Path) {
    listen_for_panics();
    for line in std::io::stdin().lock().lines() {
        let line = line.unwrap();
        let mut words = line.split_whitespace();
        let seed = words.next().unwrap().parse().unwrap();
        let kind = Kind::of_name(words.next().unwrap()).unwrap();
        let without: Vec<usize> = words.map(|word| word.parse().unwrap()).collect();
        // A case's own making is not limited.
        LIMIT.store(usize::MAX, Relaxed);
        let case = Case::new(seed, kind, Size::Full, &without);
        let _ = std::env::set_current_dir(scratch);
        for folder in ["case", "twin", "shape"] {
            let _ = std::fs::remove_dir_all(scratch.join(folder));
        }
        let result = exercise(&case, scratch, &mut Process::default());
        let violations: Vec<_> = result
            .violations
            .iter()
            .map(|violation| json!([format!("{:?}", violation.law), violation.what]))
            .collect();
        tell(&format!(
            "END {}",
            json!({
                "class": case.class, "bytes": case.byte_count(), "mutations": case.mutation_count, "done": result.done,
                "refused": result.refused, "peak": result.worst.peak, "cpu_ms": result.worst.cpu_ms,
                "violations": violations,
            })
        ));
    }
}

/// Measures this process: its allocated memory, and its processor time.
#[derive(Default)]
struct Process {
    held: usize,
    cpu_ms: u64,
}

impl Meter for Process {
    fn begin(&mut self, words: &[OsString]) {
        let words: Vec<_> = words.iter().map(|word| word.to_string_lossy()).collect();
        tell(&format!("RUN {}", json!(words)));
        self.held = HELD.load(Relaxed);
        PEAK.store(self.held, Relaxed);
        LIMIT.store(self.held + MEMORY, Relaxed);
        self.cpu_ms = cpu_ms("self").unwrap_or(0);
    }

    fn end(&mut self) -> Used {
        LIMIT.store(usize::MAX, Relaxed);
        Used {
            peak: PEAK.load(Relaxed).saturating_sub(self.held) as u64,
            cpu_ms: cpu_ms("self").unwrap_or(0).saturating_sub(self.cpu_ms),
        }
    }
}

fn tell(line: &str) {
    let mut out = std::io::stdout().lock();
    let _ = writeln!(out, "{line}").and_then(|()| out.flush());
}
