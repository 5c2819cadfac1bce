//! The worst cases of each kind.

use std::collections::BTreeMap;

use pliant_tests::hostile::Kind;
use serde_json::Value;

#[derive(Default)]
pub struct Table(BTreeMap<String, Row>);

#[derive(Default)]
struct Row {
    cases: u64,
    done: u64,
    refused: u64,
    broken: u64,
    /// Peak bytes, the files' bytes, the case's number.
    memory: (u64, u64, u64),
    /// Milliseconds, the files' bytes, the case's number.
    time: (u64, u64, u64),
}

impl Table {
    /// Counts a case with the result `end`.
    pub fn add(&mut self, kind: Kind, number: u64, end: &Value) {
        let class = end["class"].as_str().unwrap_or("ended");
        let count = |name: &str| end[name].as_u64().unwrap_or(0);
        let row = self.0.entry(format!("{} {class}", kind.name())).or_default();
        row.cases += 1;
        row.done += count("done");
        row.refused += count("refused");
        row.broken += u64::from(end["violations"].as_array().is_some_and(|list| !list.is_empty()));
        row.memory = row.memory.max((count("peak"), count("bytes"), number));
        row.time = row.time.max((count("cpu_ms"), count("bytes"), number));
    }

    /// Prints a line for each kind and class, and their sums.
    pub fn print(&self) {
        println!(
            "{:<24} {:>8} {:>8} {:>8} {:>7} | {:>8} {:>9} {:>9} | {:>8} {:>9} {:>9}",
            "kind and class",
            "cases",
            "done",
            "refused",
            "broken",
            "peak_kB",
            "of_bytes",
            "case",
            "cpu_ms",
            "of_bytes",
            "case"
        );
        let mut all = Row::default();
        for (name, row) in &self.0 {
            row.print(name);
            all.cases += row.cases;
            all.done += row.done;
            all.refused += row.refused;
            all.broken += row.broken;
            all.memory = all.memory.max(row.memory);
            all.time = all.time.max(row.time);
        }
        all.print("all");
        println!("{} commands were run and judged", all.done + all.refused);
    }
}

impl Row {
    fn print(&self, name: &str) {
        let (peak, peak_bytes, peak_case) = self.memory;
        let (cpu, cpu_bytes, cpu_case) = self.time;
        println!(
            "{name:<24} {:>8} {:>8} {:>8} {:>7} | {:>8} {:>9} {:>9} | {:>8} {:>9} {:>9}",
            self.cases,
            self.done,
            self.refused,
            self.broken,
            peak / 1024,
            peak_bytes,
            peak_case,
            cpu,
            cpu_bytes,
            cpu_case
        );
    }
}
