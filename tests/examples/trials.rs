//! Seeded trials on every scan, with counts: `trials COUNT [FIRST [METHOD]]`; without METHOD any.
#![allow(clippy::print_stdout, clippy::unwrap_used, reason = "a program that reports")]

use std::collections::BTreeMap;
use std::panic::{AssertUnwindSafe, catch_unwind};

use pliant_deform::Bilaplacian;
use pliant_tests::trials::{Outcome, Regularised, Trial, scans};

fn main() {
    let words: Vec<String> = std::env::args().skip(1).collect();
    let number = |place: usize, otherwise: u64| words.get(place).map_or(otherwise, |word| word.parse().unwrap());
    let (count, first) = (number(0, 1000), number(1, 0));
    let mut subjects = scans();
    let mut counts = BTreeMap::<String, [usize; 4]>::new();
    let (mut solved, mut peak_mb) = (0, 0.0);
    for seed in first..first + count {
        let place = (seed % subjects.len() as u64) as usize;
        let trial = Trial::with(seed, &subjects[place].model, words.get(2).map(String::as_str));
        let kind = match trial.method.options::<Bilaplacian>() {
            Some(options) => format!("bilaplacian order {}", options.order.number()),
            None => trial.method.name().to_owned(),
        };
        let name = subjects[place].name.clone();
        let subject = &mut subjects[place];
        let column = match catch_unwind(AssertUnwindSafe(|| trial.run(subject))) {
            Ok(Outcome::Bent {
                regularised,
                solved_count,
            }) => {
                solved += solved_count;
                usize::from(regularised == Regularised::Yes)
            }
            Ok(Outcome::Refused(sentence)) => {
                println!("trial {seed}, {name}, {:?}: {sentence}", trial.method);
                2
            }
            Err(_) => {
                println!("trial {seed}, {name}, {:?}: BROKEN", trial.method);
                3
            }
        };
        counts.entry(kind).or_default()[column] += 1;
        let now_mb = resident_peak_mb();
        if now_mb > 1.25 * peak_mb {
            println!(
                "trial {seed}, {name}, {:?}: at most {now_mb:.0} MB so far",
                trial.method
            );
            peak_mb = now_mb;
        }
    }
    println!(
        "{:<24}{:>8}{:>13}{:>9}{:>8}",
        "method", "bent", "regularised", "refused", "broken"
    );
    let mut sum = [0; 4];
    for (kind, row) in &counts {
        println!("{kind:<24}{:>8}{:>13}{:>9}{:>8}", row[0], row[1], row[2], row[3]);
        for (sum, count) in sum.iter_mut().zip(row) {
            *sum += count;
        }
    }
    println!("{:<24}{:>8}{:>13}{:>9}{:>8}", "all", sum[0], sum[1], sum[2], sum[3]);
    println!("{} vertices solved for in the mean", solved / (sum[0] + sum[1]).max(1));
    assert_eq!(sum[3], 0, "{} trials broke", sum[3]);
}

/// The most memory that this process has held; 0 if the system doesn't report it.
fn resident_peak_mb() -> f64 {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"));
    let kilobytes = line.and_then(|line| line.split_whitespace().next()?.parse::<f64>().ok());
    kilobytes.map_or(0.0, |kb| kb / 1024.0)
}
