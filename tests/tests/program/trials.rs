//! The first of the seeded trials on every scan: random options, methods and handles.
//!
//! `cargo run --release -p pliant-tests --example trials -- 1000` runs more of them.

use pliant_tests::trials::{Outcome, Trial, scans};

#[test]
fn sixty_trials_end_in_a_sound_shape_or_in_a_refusal_with_a_place() {
    let mut subjects = scans();
    let count = subjects.len() as u64;
    let (mut bent, mut refused) = (0, Vec::new());
    for seed in 0..if count > 0 { 60 } else { 0 } {
        let subject = &mut subjects[(seed % count) as usize];
        let trial = Trial::new(seed, &subject.model);
        match trial.run(subject) {
            // A trial that solves only a handful of vertices would check nothing.
            Outcome::Bent { solved_count, .. } => {
                let share = solved_count as f64 / subject.model.surface.positions.len() as f64;
                bent += u32::from(solved_count > 100 || share > 0.1);
            }
            Outcome::Refused(sentence) => refused.push(format!("{} {:?}: {sentence}", subject.name, trial.method)),
        }
    }
    // Refusing every trial, or solving almost nothing, must not pass.
    assert!(count == 0 || bent > 30, "{bent} {refused:#?}");
}
