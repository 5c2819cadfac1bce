//! Examples in the window's program: kept, weighed, renamed, removed, undone, saved.
#![allow(clippy::unwrap_used, reason = "tests fail by panicking")]

mod rig;

use glam::DVec3;
use pliant_editor::{Command, Document, Event, HandleTransform, JobKind, MeshReference, Project, geometry_hash};
use pliant_mesh::shapes;
use rig::{Fingerprint, Rig};

fn moved_up(height: f64) -> HandleTransform {
    HandleTransform::Trs {
        translation: DVec3::Z * height,
        rotation: glam::DQuat::IDENTITY,
        scale: DVec3::ONE,
        pivot: None,
    }
}

/// A ball with a handle that was pulled out, kept as an example and put back.
fn with_example() -> Rig {
    let mut rig = Rig::open(shapes::icosphere(3));
    rig.choose("shells");
    rig.paint_handle();
    rig.drain();
    let id = rig.editor.document().handles()[0].id;
    rig.command(Command::SetHandleTransform(id, moved_up(0.4)));
    rig.drain();
    assert!(rig.largest_displacement() > 0.3);
    rig.command(Command::KeepExample);
    rig.drain();
    rig.command(Command::SetHandleTransform(id, HandleTransform::IDENTITY));
    rig.drain();
    rig
}

fn weights(document: &Document) -> Vec<Option<f64>> {
    document
        .examples()
        .map_or_else(Vec::new, |examples| examples.weights.clone())
}

#[test]
fn a_kept_pose_moves_nothing_and_its_weight_brings_it_back_without_binding_anew() {
    let mut rig = with_example();
    assert_eq!(weights(rig.editor.document()), [Some(0.0)]);
    assert!(rig.largest_displacement() < 1e-6);
    // The handle would hold its vertices.
    let id = rig.editor.document().handles()[0].id;
    rig.command(Command::SelectHandle(id));
    rig.command(Command::DeleteHandle);
    rig.drain();
    for weight in [0.5, 1.0] {
        rig.send(Event::Adjust(Command::SetExampleWeight(0, Some(weight))));
        let waiting = rig.jobs.waiting();
        assert!(
            waiting.contains(&JobKind::Solve) && !waiting.contains(&JobKind::Bind),
            "{waiting:?}"
        );
        rig.drain();
    }
    rig.send(Event::Adjusted);
    rig.drain();
    let document = rig.editor.document();
    let example = &document.examples().unwrap().shapes[0].displacements;
    let error = document
        .from_rest()
        .iter()
        .zip(&**example)
        .map(|(a, b)| a.distance(*b))
        .fold(0.0, f64::max);
    assert!(error < 1e-3, "{error}");
    // All of the drag is one step.
    rig.command(Command::Undo);
    rig.drain();
    assert_eq!(weights(rig.editor.document()), [Some(0.0)]);
    assert!(rig.largest_displacement() < 1e-6);
}

#[test]
fn each_change_of_the_list_is_one_step_that_is_undone_and_redone() {
    let mut rig = with_example();
    let steps = [
        Command::SetExampleWeight(0, Some(0.5)),
        Command::SetExampleWeight(0, None),
        Command::RenameExample(0, "bump".to_owned()),
        Command::RemoveExample(0),
    ];
    for step in steps {
        let before = Fingerprint::of(rig.editor.document());
        let attachments = rig.editor.document().attachments().clone();
        rig.command(step.clone());
        rig.drain();
        let after = rig.editor.document().attachments().clone();
        assert!(attachments != after, "{step:?}");
        rig.command(Command::Undo);
        rig.drain();
        assert_eq!(Fingerprint::of(rig.editor.document()), before, "{step:?}");
        assert_eq!(*rig.editor.document().attachments(), attachments, "{step:?}");
        rig.command(Command::Redo);
        rig.drain();
        assert_eq!(*rig.editor.document().attachments(), after, "{step:?}");
    }
    assert!(rig.editor.document().examples().is_none());
    rig.command(Command::RemoveExample(0));
    assert!(rig.editor.unavailable_because(&Command::RemoveExample(0)).is_some());
}

#[test]
fn a_project_and_an_edit_hold_the_examples() {
    let mut rig = with_example();
    rig.command(Command::SetExampleWeight(0, Some(0.25)));
    rig.drain();
    let mesh = MeshReference {
        path: None,
        name: None,
        geometry: geometry_hash(&rig.model),
    };
    let project = rig.editor.snapshot().unwrap().project(mesh).to_json();
    let setup = pliant_editor::Beginning::from(Project::parse(&project).unwrap())
        .resolve(&rig.model)
        .unwrap();
    assert_eq!(setup.examples(), rig.editor.document().examples());
    let edit = rig.editor.edit_file().unwrap();
    let again = pliant_editor::EditFile::parse(&edit.to_json())
        .unwrap()
        .resolve(&rig.model)
        .unwrap();
    assert_eq!(again.examples(), rig.editor.document().examples());
    assert!(!edit.changes_nothing());
}

#[test]
fn another_rest_shape_leaves_examples_the_shapes_that_they_are() {
    let mut rig = with_example();
    let absolute = |document: &Document| -> Vec<DVec3> {
        let example = &document.examples().unwrap().shapes[0].displacements;
        example
            .iter()
            .zip(document.rest())
            .map(|(own, rest)| *own + *rest)
            .collect()
    };
    let before = absolute(rig.editor.document());
    let id = rig.editor.document().handles()[0].id;
    rig.command(Command::SetHandleTransform(id, moved_up(-0.2)));
    rig.drain();
    for command in [Command::Apply, Command::ResetShape, Command::Undo] {
        rig.command(command.clone());
        rig.drain();
        let apart = absolute(rig.editor.document())
            .iter()
            .zip(&before)
            .map(|(a, b)| a.distance(*b))
            .fold(0.0, f64::max);
        assert!(apart < 1e-12, "{command:?}: {apart}");
    }
}

#[test]
fn keeping_is_refused_with_a_reason_where_it_can_not_be() {
    let mut rig = Rig::open(shapes::icosphere(2));
    rig.choose("arap");
    let refused = |rig: &Rig| {
        rig.editor
            .unavailable_because(&Command::KeepExample)
            .unwrap()
            .into_owned()
    };
    assert!(refused(&rig).contains("Discrete shells"));
    rig.choose("shells");
    rig.drain();
    assert!(refused(&rig).contains("bent"));
}
