//! Laws of the project format: an opened project is the saved one, to the bit, after any actions.
#![allow(clippy::unwrap_used, clippy::expect_used, reason = "a test that can't go on fails")]

use std::sync::Arc;

use crate::rig::{CENTRE_PX, Random, Rig, VIEWPORT_PX, weld};
use glam::DVec2;
use pliant_deform::{Loose, Method};
use pliant_editor::{
    Beginning, Command, EditError, Editor, Event, GizmoPart, InlineExecutor, Key, MeshReference, Project, Reach, Tips,
    ToolMode, geometry_hash,
};
use pliant_mesh::{Drawn, shapes};

pub fn saved(rig: &Rig) -> String {
    let mesh = MeshReference {
        name: None,
        path: Some("scan.glb".to_owned()),
        geometry: geometry_hash(&rig.model),
    };
    rig.editor.snapshot().unwrap().project(mesh).to_json()
}

pub fn reopened(rig: &Rig, text: &str) -> Rig {
    opened(rig, Beginning::parse(text).unwrap())
}

/// The same model with this beginning.
pub fn opened(rig: &Rig, beginning: Beginning) -> Rig {
    let jobs = InlineExecutor::new();
    let mut editor = Editor::new(Box::new(jobs.clone()));
    editor.handle(Event::Viewport { size_px: VIEWPORT_PX });
    editor.handle(Event::Opened {
        model: Arc::clone(&rig.model),
        name: "again".to_owned(),
        beginning: Some(beginning),
    });
    let mut other = Rig::of(editor, jobs, Arc::clone(&rig.model));
    assert_eq!(other.editor.view().problem, None);
    other.drain();
    other
}

fn meshes() -> Vec<(&'static str, Drawn)> {
    vec![
        ("sphere", shapes::icosphere(3)),
        ("tube", shapes::tube(16, 12, 3.0)),
        ("broken", shapes::broken(&shapes::icosphere(2))),
        ("soup", shapes::soup(&shapes::torus(16, 8))),
    ]
}

#[test]
fn a_project_goes_on_from_the_shape_that_a_stroke_has_kept() {
    let mut rig = Rig::open(shapes::icosphere(3));
    rig.choose("bilaplacian");
    rig.paint_handle();
    rig.drain();
    rig.move_by('x', ".2");
    rig.drain();
    let beside = CENTRE_PX + DVec2::new(-60.0, -70.0);
    rig.paint(ToolMode::PaintStiffness, &[beside, beside + DVec2::new(12.0, 0.0)]);
    rig.drain();
    assert!(rig.editor.document().kept().is_some());
    let again = reopened(&rig, &saved(&rig));
    assert_eq!(saved(&again), saved(&rig));
    let mut both = [rig, again];
    for rig in &mut both {
        let id = rig.editor.document().handles()[0].id;
        rig.command(Command::SelectHandle(id));
        rig.move_by('y', ".05");
        rig.drain();
    }
    assert!(both[0].drawn() == both[1].drawn());
}

#[test]
fn what_was_saved_is_what_is_opened_to_the_bit() {
    for (name, drawn) in meshes() {
        let mut random = Random(7);
        let mut rig = Rig::open(drawn);
        for step in 0..24 {
            match random.below(8) {
                0..3 => {
                    let mode =
                        [ToolMode::PaintHandle, ToolMode::PaintFree, ToolMode::PaintFixed][random.below(3) as usize];
                    rig.paint(mode, &[random.position_px(), random.position_px()]);
                }
                3 => {
                    rig.drag(GizmoPart::Centre, DVec2::new(20.0, 10.0 * random.unit()));
                }
                4 => {
                    rig.type_keys("ry40");
                    rig.key(Key::Enter);
                }
                5 => rig.command(
                    [
                        Command::Apply,
                        Command::NewHandle,
                        Command::SetMethod(Method::from_name("arap").unwrap()),
                        Command::SetLoose(Loose::Rest),
                        Command::SetTips(Tips::Held),
                    ][random.below(5) as usize]
                        .clone(),
                ),
                6 => {
                    let field = (0..rig.model.surface.positions.len()).map(|v| 1.0 + (v % 5) as f64);
                    rig.command(Command::SetStiffness(field.collect()));
                }
                _ => {
                    if let Some(id) = rig.editor.view().selected {
                        let first = rig.editor.document().handles()[0].id;
                        let reach = if step % 2 == 0 { Reach::Length } else { Reach::Creased };
                        rig.command(Command::SetReach(id, reach(0.4)));
                        rig.command(Command::SetParent(id, Some(first)));
                    }
                }
            }
            rig.drain();
            let text = saved(&rig);
            let again = reopened(&rig, &text);
            assert!(rig.fingerprint() == again.fingerprint(), "{name} {step}");
            assert_eq!(
                rig.editor.document_hash(),
                again.editor.document_hash(),
                "{name} {step}"
            );
            assert_eq!(rig.editor.document().method(), again.editor.document().method());
            assert_eq!(rig.editor.view().camera, again.editor.view().camera);
            assert!(rig.editor.roles() == again.editor.roles(), "{name} {step}");
            assert!(!again.editor.view().unsaved);
            assert_eq!(saved(&again), text, "{name} {step}: the same text");
        }
        assert!(rig.editor.document().is_applied() || !rig.editor.document().handles().is_empty());
    }
}

#[test]
fn a_project_that_is_kept_in_the_middle_of_a_drag_opens_with_what_was_dragged() {
    let mut rig = Rig::open(shapes::icosphere(3));
    rig.paint_handle();
    rig.drain();
    let from_px = rig.grip(GizmoPart::Arrow(1)).unwrap();
    rig.press(from_px);
    rig.move_to(from_px + DVec2::new(0.0, -50.0));
    let text = saved(&rig);
    rig.drain();
    let again = reopened(&rig, &text);
    assert_eq!(again.editor.document().handles(), rig.editor.document().handles());
    assert!(again.editor.document().from_rest() == rig.editor.document().from_rest());
}

#[test]
fn what_a_project_can_not_be_is_refused_in_a_sentence() {
    let mut rig = Rig::open(shapes::icosphere(3));
    rig.paint(ToolMode::PaintHandle, &[CENTRE_PX]);
    rig.drain();
    let text = saved(&rig);
    let other = weld(shapes::icosphere(2));
    let refused = Beginning::parse(&text).unwrap().resolve(&other).unwrap_err();
    assert!(matches!(refused, EditError::OtherMesh { .. }), "{refused}");
    for (from, to, word) in [
        ("\"version\": 1", "\"version\": 2", "version"),
        ("\"settled\"", "\"setled\"", "setled"),
        ("\"next_handle\": 1", "\"next_handle\": 0", "next_handle"),
        ("\"next_handle\": 1", "\"next_handle\": -1", "next_handle is -1"),
        (
            "\"settled\":",
            "\"version\": 1, \"settled\":",
            "`version` appears twice in the project",
        ),
        ("\"arap\"", "\"arab\"", "arab"),
        ("\"found\"", "{\"radii\": -3.0}", "reach"),
        ("\"loose\": \"follow\"", "\"loose\": \"fly\"", "fly"),
    ] {
        assert!(text.contains(from), "{from}");
        let refused = Project::parse(&text.replacen(from, to, 1))
            .map(Beginning::from)
            .and_then(|project| project.resolve(&rig.model));
        assert!(refused.as_ref().unwrap_err().to_string().contains(word), "{refused:?}");
    }
    // Cut off anywhere, it is refused without a panic.
    for end in (0..text.len()).step_by(97) {
        assert!(Beginning::parse(&text[..end]).is_err());
    }
    // A handle's name comes from the file: the sentence stays short for a name of any length.
    let mut named: serde_json::Value = serde_json::from_str(&text).unwrap();
    named["handles"][0]["name"] = "é\u{1b}".repeat(1500).into();
    let with = |member: &str, value: serde_json::Value| {
        let mut wrong = named.clone();
        match member {
            "next_handle" => wrong[member] = value,
            _ => wrong["handles"][0][member] = value,
        }
        wrong
    };
    let beyond = rig.model.drawn.vertex_count();
    for wrong in [
        with("next_handle", 0.into()),
        with("soft", (-1.0).into()),
        with("vertices", serde_json::json!([[beyond, beyond]])),
    ] {
        let refused = Project::parse(&wrong.to_string())
            .map(Beginning::from)
            .and_then(|project| project.resolve(&rig.model));
        let said = refused.unwrap_err().to_string();
        assert!(said.contains("éé") || said.contains("é é"), "{said}");
        assert!(
            said.chars().count() < 300 && !said.chars().any(char::is_control),
            "{said:?}"
        );
    }
    // A vertex beyond the mesh's.
    let count = rig.model.drawn.vertex_count();
    let mut value: serde_json::Value = serde_json::from_str(&text).unwrap();
    value["handles"][0]["vertices"][0][1] = count.into();
    let refused = Project::parse(&value.to_string())
        .map(Beginning::from)
        .and_then(|project| project.resolve(&rig.model));
    assert!(refused.unwrap_err().to_string().contains(&count.to_string()));
}

/// The format refuses it, so no document may have it.
#[test]
fn no_handle_is_flattened_by_a_number_that_is_typed() {
    let mut rig = Rig::open(shapes::icosphere(3));
    rig.paint_handle();
    rig.drain();
    rig.type_keys("s0");
    rig.key(Key::Enter);
    assert!(rig.editor.view().problem.is_some_and(|said| said.contains("flatten")));
    rig.type_keys("s0.5");
    rig.key(Key::Enter);
    rig.drain();
    assert_eq!(rig.editor.view().problem, None);
    let text = saved(&rig);
    assert_eq!(
        reopened(&rig, &text).editor.document().handles(),
        rig.editor.document().handles()
    );
    assert!(text.contains("\"scale\""));
}
