//! A short run over the corpus with a fixed seed: a parser reads or refuses any bytes. Long ones: `cargo run --release
//! --example fuzz -p pliant-io -- SEED COUNT`.
#![allow(clippy::unwrap_used, clippy::expect_used, reason = "a test fails by panicking")]

use std::path::Path;

use crate::fuzzing::{Beside, Chance, Outcome, broken, corpus, exercise};
use pliant_io::Format;

#[test]
fn every_sound_file_is_read_and_no_broken_one_panics() {
    let sound = corpus(&Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/corpus"));
    assert!(sound.len() >= 12);
    let mut chance = Chance(1);
    for file in &sound {
        let beside = Beside(vec![7; 600].into());
        let outcome = exercise(&file.bytes, file.kind, Format::Glb, &beside, || {});
        assert_eq!(outcome, Outcome::Read, "{}", file.name);
    }
    let mut read = 0;
    let runs = 4000;
    for _ in 0..runs {
        let file = chance.of(&sound);
        let bytes = broken(file, &sound, &mut chance);
        let other = *chance.of(&Format::ALL);
        let beside = Beside::of(&sound, &mut chance);
        read += usize::from(exercise(&bytes, file.kind, other, &beside, || {}) == Outcome::Read);
    }
    assert!(
        read > runs / 10 && read < runs,
        "{read} of {runs} broken files were read"
    );
}
