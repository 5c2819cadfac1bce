//! Parts that are turned inside out: one command turns them and turns them back, undo works, projects and edits keep
//! them, and nothing bends.
#![allow(clippy::unwrap_used, clippy::expect_used, reason = "a test that can't go on fails")]

use std::collections::BTreeSet;
use std::sync::Arc;

use crate::rig::Rig;
use pliant_editor::{Beginning, Command, Editor, Event, InlineExecutor, MeshReference, ObjectAction, geometry_hash};
use pliant_mesh::{Drawn, shapes};

/// Two adjacent balls, the smaller one inside out.
fn balls() -> Drawn {
    let (mut inwards, large) = (shapes::icosphere(2), shapes::icosphere(3));
    for triangle in &mut inwards.triangles {
        triangle.swap(1, 2);
    }
    for position in &mut inwards.positions {
        position.x += 3.0;
    }
    shapes::together(&[large, inwards])
}

fn turned(rig: &Rig) -> Vec<u32> {
    rig.editor.document().inside_out().iter().copied().collect()
}

#[test]
fn what_faces_inwards_is_turned_or_else_all_that_is_shown_and_undo_takes_it_back() {
    let mut rig = Rig::open(balls());
    let before = rig.fingerprint();
    assert_eq!(rig.model.inside_out, [1]);
    rig.command(Command::TurnInsideOut);
    assert_eq!(turned(&rig), [1]);
    assert_eq!(rig.editor.view().undo, Some("Turn 1 part inside out"));
    assert!(rig.editor.view().unsaved);
    rig.command(Command::TurnInsideOut);
    assert!(turned(&rig).is_empty(), "once more turns it back");
    rig.undo();
    assert_eq!(turned(&rig), [1]);
    rig.undo();
    assert_eq!(rig.fingerprint(), before);
    rig.redo();
    assert_eq!(turned(&rig), [1]);

    // An isolated part, facing inwards or outwards.
    rig.command(Command::Isolate);
    rig.drain();
    if let Some(part) = rig.editor.document().access().isolated {
        let wanted: BTreeSet<u32> = BTreeSet::from([1])
            .symmetric_difference(&BTreeSet::from([part]))
            .copied()
            .collect();
        rig.command(Command::TurnInsideOut);
        assert_eq!(**rig.editor.document().inside_out(), wanted);
    }

    let mut sheet = shapes::grid(3, 3);
    sheet.positions.iter_mut().for_each(|position| position.x += 3.0);
    let mut rig = Rig::open(shapes::together(&[shapes::icosphere(2), sheet]));
    rig.command(Command::TurnInsideOut);
    assert_eq!(
        turned(&rig),
        [0, 1],
        "an open sheet has no inside, and is turned with all"
    );
    rig.undo();
    rig.command(Command::Objects(ObjectAction::Hide, vec![0]));
    rig.drain();
    rig.command(Command::TurnInsideOut);
    assert!(turned(&rig).is_empty(), "all is hidden");
}

#[test]
fn a_bend_does_not_change_by_it_and_projects_and_edits_keep_it() {
    let mut rig = Rig::open(balls());
    rig.paint_handle();
    rig.move_by('y', "0.2");
    rig.drain();
    let bent = rig.drawn();
    rig.command(Command::TurnInsideOut);
    rig.drain();
    assert_eq!(rig.drawn(), bent);
    rig.move_by('y', "0.1");
    rig.drain();
    rig.undo();
    rig.drain();
    assert_eq!(rig.drawn(), bent);

    let project = rig.editor.snapshot().unwrap().project(MeshReference {
        path: None,
        name: None,
        geometry: geometry_hash(&rig.model),
    });
    let edit = rig.editor.edit_file().unwrap();
    for text in [project.to_json(), edit.to_json()] {
        let mut again = Editor::new(Box::new(InlineExecutor::new()));
        again.handle(Event::Opened {
            model: Arc::clone(&rig.model),
            name: "again".to_owned(),
            beginning: Some(Beginning::parse(&text).unwrap()),
        });
        assert_eq!(
            again.document().inside_out(),
            rig.editor.document().inside_out(),
            "{text}"
        );
    }
}
