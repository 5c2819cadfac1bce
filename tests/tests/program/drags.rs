//! Random drags over every scan by every method: always finite, handles at their targets, no step raising the energy.
//!
//! `cargo run --release -p pliant-tests --example drags -- 1000` runs more of them and prints the frames' times.

use pliant_deform::METHODS;
use pliant_tests::trials::{Outcome, Trial, scans};

#[test]
fn a_hundred_and_twenty_drags_end_in_a_sound_shape_or_in_a_refusal_with_a_place() {
    let mut subjects = scans();
    let count = subjects.len() as u64;
    let (mut bent, mut refused) = (0, Vec::new());
    for seed in 0..if count > 0 { 120 } else { 0 } {
        let subject = &mut subjects[(seed % count) as usize];
        let method = METHODS[(seed / count) as usize % METHODS.len()].name;
        let trial = Trial::with(seed, &subject.model, Some(method));
        let mut frames = 0;
        match trial.drag(subject, &mut |_| frames += 1) {
            Outcome::Bent { .. } => bent += u32::from(frames > 10),
            Outcome::Refused(sentence) => refused.push(format!("{} {:?}: {sentence}", subject.name, trial.method)),
        }
    }
    // Refusing every drag must not pass.
    assert!(count == 0 || bent > 80, "{bent} {refused:#?}");
}
