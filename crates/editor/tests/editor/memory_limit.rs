//! A person's limit on the memory of bindings, and the new bindings after its change.
#![allow(clippy::unwrap_used, clippy::expect_used, reason = "a test that can't go on fails")]

use crate::rig::Rig;
use pliant_editor::{Command, Event, HandleId, Reach};
use pliant_mesh::shapes;

/// A ball of 40,962 vertices, most of which are free, with a handle that was moved.
fn open() -> Rig {
    let mut rig = Rig::open(shapes::icosphere(6));
    rig.choose("bilaplacian");
    rig.paint_handle();
    rig.command(Command::SetReach(HandleId(0), Reach::Length(2.5)));
    rig.drain();
    rig.move_by('x', ".2");
    rig.drain();
    rig
}

/// Allows bindings this many bytes. Returns whether something is bound again.
fn allow(rig: &mut Rig, most: Option<u64>) -> bool {
    rig.send(Event::Memory(most));
    let is_bound_anew = !rig.editor.view().settled;
    rig.drain();
    is_bound_anew
}

fn says_so(rig: &Rig) -> bool {
    let warnings = rig.editor.warnings();
    warnings.iter().any(|warning| warning.contains("Laplacian's factor"))
}

/// Allows less and less, until another factor is chosen, and returns that number of bytes.
fn scarce(rig: &mut Rig) -> u64 {
    let free = rig.editor.view().counts.free as u64;
    let most = (1..40).rev().map(|share| 50 * share * free);
    let mut most = most.skip_while(|most| !allow(rig, Some(*most)));
    most.next()
        .expect("another factor is chosen before the least is reached")
}

#[test]
fn less_memory_binds_anew_by_another_factor_and_bends_the_same() {
    let mut rig = open();
    assert!(!says_so(&rig));
    let most = scarce(&mut rig);
    assert!(says_so(&rig), "{:?}", rig.editor.view().problem);
    assert_eq!(rig.editor.most_memory(), Some(most));
    let mut plenty = open();
    for rig in [&mut rig, &mut plenty] {
        rig.move_by('y', ".3");
        rig.drain();
        rig.assert_as_meant("by either factor");
        assert!(rig.largest_displacement() > 0.3, "{}", rig.largest_displacement());
    }
    let shapes = [&rig, &plenty].map(|rig| rig.editor.document().from_file().to_vec());
    let apart = shapes[0].iter().zip(&shapes[1]).map(|(a, b)| a.distance(*b));
    let apart = apart.fold(0.0, f64::max);
    assert!(apart < 2e-6, "{apart:e}");
    // A limit that selects the same factor binds nothing.
    assert!(!allow(&mut rig, Some(most - 1)));
    assert!(allow(&mut rig, None) && !says_so(&rig));
    assert!(!allow(&mut rig, Some(1 << 40)));
    assert!(!allow(&mut rig, None));
}

#[test]
fn what_was_refused_is_tried_again_with_more_and_the_refusal_is_gone() {
    let mut rig = open();
    allow(&mut rig, Some(1000));
    let refusal = rig
        .editor
        .view()
        .problem
        .expect("a thousand bytes are not enough")
        .to_owned();
    assert!(refusal.contains("memory"), "{refusal}");
    rig.move_by('y', ".3");
    rig.drain();
    // This is not enough either, and the message comes again.
    assert!(allow(&mut rig, Some(2000)));
    assert!(rig.editor.view().problem.is_some());
    assert!(allow(&mut rig, None));
    assert_eq!(rig.editor.view().problem, None);
    rig.assert_as_meant("with what there is");
}

#[test]
fn another_file_is_bound_with_what_was_allowed_before() {
    let mut rig = open();
    let most = scarce(&mut rig);
    rig.send(Event::Opened {
        model: std::sync::Arc::clone(&rig.model),
        name: "again".to_owned(),
        beginning: None,
    });
    rig.drain();
    rig.choose("bilaplacian");
    rig.paint_handle();
    rig.command(Command::SetReach(HandleId(0), Reach::Length(2.5)));
    rig.drain();
    assert!(says_so(&rig));
    assert_eq!(rig.editor.most_memory(), Some(most));
}
