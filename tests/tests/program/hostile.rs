//! A few hundred hostile cases: a folder with a broken model, edit or project, with links and unrelated files; the
//! program's commands run on it, and the laws hold for any content of the folder.
//!
//! `cargo run --release -p pliant-tests --example hostile -- 0 100000` runs more of them under limits of memory and
//! time, which a test can't set.
#![cfg(unix)]
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use std::collections::BTreeMap;

use pliant_tests::hostile::{Case, Kind, Law, Size, Unmetered, exercise, listen_for_panics};

/// The number of cases of each kind except the rendered one, unless `PLIANT_CASES` gives another.
const CASES: u64 = 50;

/// The number of rendered cases: fewer, because opening a graphics device takes as long as many saves. Without a device
/// they are refused in words.
const DRAWN: u64 = 8;

#[test]
fn three_hundred_hostile_cases_lose_nothing_and_are_refused_in_words() {
    listen_for_panics();
    let here = std::env::current_dir().unwrap();
    let asked = std::env::var("PLIANT_CASES").ok().and_then(|count| count.parse().ok());
    let count = asked.unwrap_or(CASES);
    let mut broken: BTreeMap<Law, Vec<String>> = BTreeMap::new();
    let (mut done, mut refused) = (0, 0);
    for kind in Kind::ALL {
        for seed in 0..if kind == Kind::Render { DRAWN } else { count } {
            let case = Case::new(seed, kind, Size::Small, &[]);
            let folder = tempfile::tempdir().unwrap();
            let result = exercise(&case, folder.path(), &mut Unmetered);
            done += result.done;
            refused += result.refused;
            for violation in result.violations {
                let told = format!("`hostile {seed} 1 {}`: {}", kind.name(), violation.what);
                broken.entry(violation.law).or_default().push(told);
            }
        }
    }
    std::env::set_current_dir(here).unwrap();
    drop(std::panic::take_hook());
    assert!(broken.is_empty(), "{broken:#?}");
    // If all cases were refused, or none, the test would check nothing.
    assert!(done > 300 && refused > 50, "{done} done and {refused} refused");
}
