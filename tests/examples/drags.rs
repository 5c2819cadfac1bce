//! Seeded drags on every scan, with the frames' times: `drags COUNT [FIRST [METHOD]]`; without METHOD `arap`.
#![allow(clippy::print_stdout, clippy::unwrap_used, reason = "a program that reports")]

use std::time::Instant;

use pliant_tests::trials::{Outcome, Trial, scans};

/// A shorter frame is not noticeable, independent of the others; in milliseconds.
const NOTICED_MS: f64 = 16.0;

fn main() {
    let words: Vec<String> = std::env::args().skip(1).collect();
    let number = |place: usize, otherwise: u64| words.get(place).map_or(otherwise, |word| word.parse().unwrap());
    let (count, first) = (number(0, 1000), number(1, 0));
    let method = words.get(2).map_or("arap", String::as_str);
    let mut subjects = scans();
    let (mut bent, mut refused, mut over) = (0, 0, 0);
    let mut worst = (0.0, String::new());
    for seed in first..first + count {
        let place = (seed % subjects.len() as u64) as usize;
        let subject = &mut subjects[place];
        let trial = Trial::with(seed, &subject.model, Some(method));
        // The first frame is at rest and ends the binding; the check of a frame counts in the next one's time.
        let (mut times, mut last) = (Vec::new(), Instant::now());
        let outcome = trial.drag(subject, &mut |_| {
            times.push(last.elapsed().as_secs_f64() * 1e3);
            last = Instant::now();
        });
        match outcome {
            Outcome::Bent { .. } => bent += 1,
            Outcome::Refused(_) => {
                refused += 1;
                continue;
            }
        }
        times.remove(0);
        times.sort_by(f64::total_cmp);
        let (median, longest) = (times[times.len() / 2], times[times.len() - 1]);
        let ratio = longest / median;
        over += u32::from(ratio > 10.0 && longest > NOTICED_MS);
        if ratio > worst.0 && longest > NOTICED_MS {
            worst = (
                ratio,
                format!(
                    "drag {seed} of {}, {:?}: {longest:.1} ms, median {median:.1} ms",
                    subject.name, trial.method
                ),
            );
        }
    }
    println!("{count} drags by {method}: {bent} bent, {refused} refused, none broken");
    println!(
        "longest frame over its drag's median, of frames over {NOTICED_MS} ms: {:.1} ({}); over ten times: {over}",
        worst.0, worst.1
    );
}
