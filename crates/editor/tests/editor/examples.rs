//! Examples in the window's program: kept, weighed, renamed, removed, undone, saved.
#![allow(clippy::unwrap_used, reason = "tests fail by panicking")]

use std::sync::Arc;

use crate::animation::go_to;
use crate::project::{reopened, saved};
use crate::rig::{Fingerprint, Rig};
use glam::DVec3;
use pliant_deform::ExampleShape;
use pliant_editor::{
    Command, Document, Event, HandleTransform, JobKind, KeyId, KeyRow, MeshReference, Project, geometry_hash,
};
use pliant_mesh::shapes;

fn moved_up(height: f64) -> HandleTransform {
    HandleTransform::Trs {
        translation: DVec3::Z * height,
        rotation: glam::DQuat::IDENTITY,
        scale: DVec3::ONE,
        pivot: None,
    }
}

/// A ball with a handle that was pulled out, kept as an example and moved back.
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

/// The ball's vertices, each a tenth of the radius higher.
fn lifted(rig: &Rig, name: &str) -> ExampleShape {
    ExampleShape {
        name: name.to_owned(),
        displacements: Arc::new(vec![DVec3::Z * 0.1; rig.model.surface.positions.len()]),
    }
}

#[test]
fn a_shape_that_is_brought_is_one_step_and_stands_where_its_file_has_it() {
    let mut rig = with_example();
    let id = rig.editor.document().handles()[0].id;
    rig.command(Command::SetHandleTransform(id, moved_up(0.3)));
    rig.drain();
    // The rest shape is no longer the file's.
    rig.command(Command::Apply);
    rig.drain();
    let before = Fingerprint::of(rig.editor.document());
    let seen = Arc::clone(rig.editor.document().from_file());
    for name in ["Smile", "Smile", ""] {
        rig.command(Command::AddExample(lifted(&rig, name)));
        rig.drain();
    }
    let document = rig.editor.document();
    assert_eq!(*document.from_file(), seen, "an example moved something");
    let examples = document.examples().unwrap();
    let names: Vec<&str> = examples.shapes.iter().map(|shape| &*shape.name).collect();
    assert_eq!(names, ["example 1", "Smile", "Smile 1", "example 2"]);
    assert_eq!(weights(document), [Some(0.0); 4]);
    // The rest shape is given by its displacements from the file's.
    let places = document.rest().iter().zip(&*examples.shapes[1].displacements);
    let away = places.map(|(rest, own)| (*rest + *own).distance(DVec3::Z * 0.1));
    assert!(away.fold(0.0, f64::max) < 1e-12);
    assert!(document.rest().iter().any(|rest| rest.length() > 0.1));
    assert_eq!(rig.editor.view().undo, Some("Add example"));
    for _ in 0..3 {
        rig.command(Command::Undo);
        rig.drain();
    }
    assert_eq!(Fingerprint::of(rig.editor.document()), before);
    assert_eq!(weights(rig.editor.document()), [Some(0.0)]);
}

#[test]
fn keys_of_weights_are_keys_of_their_own() {
    let mut rig = with_example();
    rig.command(Command::KeyWeights);
    go_to(&mut rig, 0.5);
    rig.command(Command::SetExampleWeight(0, Some(1.0)));
    rig.drain();
    let full = rig.largest_displacement();
    rig.command(Command::KeyWeights);
    rig.drain();
    assert_eq!(rig.largest_displacement(), full);
    let selected: Vec<KeyId> = rig.editor.view().selected_keys.iter().copied().collect();
    assert_eq!(selected, [KeyId::new(KeyRow::Weights, 0.5)]);
    let keys = rig.editor.document().animation().keys();
    assert!(
        keys.iter()
            .all(|key| key.handles().count() == 0 && key.strength().is_none())
    );
    let keyed: Vec<_> = keys
        .iter()
        .map(|key| (key.time, key.weights().unwrap().to_vec()))
        .collect();
    assert_eq!(keyed, [(0.0, vec![Some(0.0)]), (0.5, vec![Some(1.0)])]);
    for (time, expected) in [(0.0, 0.0), (0.25, 0.5), (0.5, 1.0)] {
        go_to(&mut rig, time);
        let weight = weights(rig.editor.document())[0].unwrap();
        assert!((weight - expected).abs() < 1e-12, "{time}: {weight}");
        // The handle has no key, and stays.
        assert!(!rig.editor.document().handles()[0].is_displaced());
    }
    let again = reopened(&rig, &saved(&rig));
    assert_eq!(again.editor.document().animation(), rig.editor.document().animation());
    rig.command(Command::SelectKeys(vec![KeyId::new(KeyRow::Weights, 0.5)]));
    rig.command(Command::DeleteKeys);
    rig.drain();
    assert_eq!(rig.editor.document().animation().keys().len(), 1);
    assert_eq!(weights(rig.editor.document()), [Some(0.0)]);
}

#[test]
fn a_shape_of_another_mesh_is_refused() {
    let mut rig = with_example();
    let mut other = lifted(&rig, "other");
    Arc::make_mut(&mut other.displacements).pop();
    let command = Command::AddExample(other);
    assert!(
        rig.editor
            .unavailable_because(&command)
            .unwrap()
            .contains("another mesh")
    );
    rig.command(command);
    assert_eq!(weights(rig.editor.document()).len(), 1);
    rig.choose("arap");
    let command = Command::AddExample(lifted(&rig, "Smile"));
    assert!(rig.editor.unavailable_because(&command).unwrap().contains("Cloth"));
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
    assert!(refused(&rig).contains("Cloth"));
    rig.choose("shells");
    rig.drain();
    assert!(refused(&rig).contains("bent"));
}
