//! A few of the trials of the example `kills`, with the program as it is built for tests.

#![cfg(unix)]
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

#[path = "../examples/kills/trial.rs"]
mod trial;

use std::path::Path;

use trial::{Rig, Tally};

#[test]
fn killed_at_any_moment_or_two_at_once_a_save_leaves_the_old_state_or_the_new_one() {
    let mut rig = Rig::new(Path::new(env!("CARGO_BIN_EXE_pliant")), 7).unwrap();
    let mut tally = Tally::default();
    rig.kills(30, &mut tally).unwrap();
    rig.pairs(20, &mut tally).unwrap();
    assert_eq!(tally.old + tally.new, 50);
}
