//! Laws of rigid paint: a part that a stroke makes rigid moves as one body, is undone in one step, and is saved with
//! the project and with the edit.
#![allow(clippy::unwrap_used, clippy::expect_used, reason = "tests fail by panicking")]

use crate::rig::{CENTRE_PX, Fingerprint, Rig};
use glam::{DQuat, DVec2, DVec3};
use pliant_deform::RigidMotion;
use pliant_editor::{
    Beginning, Command, EditFile, HandleTransform, MeshReference, Project, Reach, StiffnessAction, StiffnessBrush,
    ToolMode, geometry_hash,
};
use pliant_mesh::shapes;

/// A ball whose front is painted by the stiffness brush with this action.
fn paint(rig: &mut Rig, action: StiffnessAction) {
    rig.command(Command::SetTool(ToolMode::PaintStiffness));
    rig.command(Command::SetStiffnessBrush(StiffnessBrush {
        action,
        ..StiffnessBrush::default()
    }));
    rig.swipe(&[CENTRE_PX, CENTRE_PX + DVec2::new(40.0, 20.0)]);
    rig.drain();
}

fn rigid(rig: &Rig) -> Vec<usize> {
    let field = rig.editor.document().stiffness().unwrap_or_default();
    (0..field.len())
        .filter(|&vertex| field[vertex] == f64::INFINITY)
        .collect()
}

#[test]
fn a_stroke_makes_rigid_or_not_and_nothing_between_and_undo_takes_it_back() {
    let mut rig = Rig::open(shapes::icosphere(4));
    let before = Fingerprint::of(rig.editor.document());
    paint(&mut rig, StiffnessAction::Rigid);
    let field = rig.editor.document().stiffness().unwrap().to_vec();
    assert!(rigid(&rig).len() > 5);
    assert!(field.iter().all(|&own| own == 1.0 || own == f64::INFINITY));
    rig.command(Command::Undo);
    rig.drain();
    assert_eq!(Fingerprint::of(rig.editor.document()), before);
}

#[test]
fn other_strokes_over_rigid_paint_leave_numbers_and_smoothing_leaves_it_rigid() {
    for (action, is_left) in [
        (StiffnessAction::Paint, false),
        (StiffnessAction::Erase, false),
        (StiffnessAction::Smooth, true),
    ] {
        let mut rig = Rig::open(shapes::icosphere(4));
        paint(&mut rig, StiffnessAction::Rigid);
        let first = rigid(&rig);
        paint(&mut rig, action);
        let field = rig.editor.document().stiffness().unwrap_or_default();
        assert!(field.iter().all(|own| *own > 0.0), "{action:?}");
        assert_eq!(rigid(&rig) == first, is_left, "{action:?}");
    }
}

#[test]
fn what_is_painted_rigid_moves_as_one_body() {
    let mut rig = Rig::open(shapes::icosphere(4));
    paint(&mut rig, StiffnessAction::Rigid);
    let body = rigid(&rig);
    // A handle beside it, whose reach covers all of it.
    rig.command(Command::SetTool(ToolMode::PaintHandle));
    rig.swipe(&[CENTRE_PX - DVec2::new(130.0, 60.0), CENTRE_PX - DVec2::new(120.0, 60.0)]);
    rig.drain();
    let id = rig.editor.document().handles()[0].id;
    rig.command(Command::SetReach(id, Reach::Length(1.6)));
    rig.drain();
    rig.command(Command::SetHandleTransform(
        id,
        HandleTransform::Trs {
            translation: DVec3::new(0.3, 0.2, 0.3),
            rotation: DQuat::from_rotation_z(0.7),
            scale: DVec3::ONE,
            pivot: None,
        },
    ));
    rig.drain();
    let displacements = rig.editor.document().from_rest();
    let rest: Vec<DVec3> = body.iter().map(|&vertex| rig.model.surface.positions[vertex]).collect();
    let moved: Vec<DVec3> = body.iter().map(|&vertex| displacements[vertex]).collect();
    assert!(moved.iter().all(|d| d.length() > 1e-3));
    let fit = RigidMotion::fit(&rest, &moved).unwrap();
    for (p, d) in rest.iter().zip(&moved) {
        assert!(fit.displace(*p).distance(*d) < 1e-9, "{p}");
    }
}

#[test]
fn rigid_paint_is_saved_with_the_project_and_with_the_edit() {
    let mut rig = Rig::open(shapes::icosphere(3));
    paint(&mut rig, StiffnessAction::Rigid);
    let field = rig.editor.document().stiffness().unwrap().to_vec();
    let project = rig.editor.snapshot().unwrap().project(MeshReference {
        path: None,
        name: None,
        geometry: geometry_hash(&rig.model),
    });
    let again = Project::parse(&project.to_json()).unwrap();
    let beginning = Beginning::parse(&again.to_json()).unwrap();
    let jobs = pliant_editor::InlineExecutor::new();
    let mut reopened = pliant_editor::Editor::new(Box::new(jobs));
    reopened.handle(pliant_editor::Event::Opened {
        model: std::sync::Arc::clone(&rig.model),
        name: "again".to_owned(),
        beginning: Some(beginning),
    });
    assert_eq!(reopened.document().stiffness().unwrap(), field);

    let text = rig.editor.edit_file().unwrap().to_json();
    assert!(text.contains("\"rigid\"") && !text.contains("null"));
    let edit = EditFile::parse(&text).unwrap();
    assert_eq!(edit.to_json(), text);
    assert_eq!(edit.resolve(&rig.model).unwrap().stiffness, field);
}

#[test]
fn an_edit_says_rigid_by_its_word_and_other_words_are_refused_by_name() {
    let edit = |value: &str| {
        EditFile::parse(&format!(
            r#"{{"version": 1, "method": {{"name": "arap"}}, "stiffness": [{{"select": "all", "value": {value}}}]}}"#
        ))
    };
    assert!(edit("\"rigid\"").is_ok());
    for (value, part) in [("\"stiff\"", "rigid"), ("2000", "or \"rigid\""), ("null", "value")] {
        let refused = edit(value).unwrap_err().to_string();
        assert!(refused.contains(part), "{value}: {refused}");
    }
    let continuity = r#"{"version": 1, "method": {"name": "arap"}, "continuity": "rigid"}"#;
    assert!(EditFile::parse(continuity).is_err());
}
