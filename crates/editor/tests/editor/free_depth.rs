//! Handles that are free along the direction of sight.

use std::sync::Arc;

use glam::{DVec2, DVec3};
use pliant_editor::{
    Beginning, Command, EditError, EditFile, Event, GizmoPart, HandleId, Key, MeshReference, NamedView, Paint, Start,
    ToolMode, Until, geometry_hash,
};
use pliant_mesh::{Cancel, Progress, shapes};

use crate::curve_strokes::{curve, px};
use crate::project::{reopened, saved};
use crate::rig::{CENTRE_PX, ITERATED, Rig, VIEWPORT_PX};

/// The pull of the handle, on the screen.
const PULL_PX: DVec2 = DVec2::new(320.0, -220.0);

/// A bar along x that is seen from its near end, which is a handle; the far one is fixed.
fn bar() -> Rig {
    let edit = r#"{"version": 1, "method": {"name": "arap"},
        "fixed": {"slab": {"axis": "x", "from": 0, "to": 0.1}},
        "handles": [{"name": "hand", "select": {"slab": {"axis": "x", "from": 0.95, "to": 1}}}]}"#;
    let mut rig = Rig::open(shapes::bar(8, 2, 2));
    rig.send(Event::Opened {
        model: Arc::clone(&rig.model),
        name: "bar".to_owned(),
        beginning: Some(EditFile::parse(edit).unwrap().into()),
    });
    rig.command(Command::View(NamedView::Right));
    rig.command(Command::FrameAll);
    rig.command(Command::SelectHandle(HandleId(0)));
    rig.drain();
    rig
}

/// Pulls the selected handle in the plane of the screen.
fn pull(rig: &mut Rig, by_px: DVec2) {
    rig.move_to(CENTRE_PX);
    rig.type_keys("g");
    rig.move_to(CENTRE_PX + 0.5 * by_px);
    rig.drain();
    rig.move_to(CENTRE_PX + by_px);
    rig.drain();
    rig.key(Key::Enter);
    rig.drain();
}

/// The place of the handle's pivot on the screen.
fn seen_px(rig: &Rig) -> DVec2 {
    let view = rig.editor.view();
    view.camera.project(view.handles[0].centre(), VIEWPORT_PX).unwrap()
}

fn farthest(a: &[DVec3], b: &[DVec3]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a.distance(*b)).fold(0.0, f64::max)
}

#[test]
fn a_handle_that_is_free_in_depth_stays_under_the_pointer_and_comes_round() {
    let (mut held, mut free) = (bar(), bar());
    free.command(Command::FreeOrHoldDepth);
    for rig in [&mut held, &mut free] {
        let from_px = seen_px(rig);
        pull(rig, PULL_PX);
        let apart_px = seen_px(rig).distance(from_px + PULL_PX);
        assert!(apart_px < 0.5, "{apart_px}");
    }
    let [of_held, of_free] = [&held, &free].map(|rig| rig.editor.view().descent.unwrap().energy);
    assert!(of_free < of_held, "{of_free} and {of_held}");
    // The visible handle is where its vertices are.
    let document = free.editor.document();
    let affine = document.handles()[0].affine();
    for (vertex, rest) in free.model.surface.positions.iter().enumerate() {
        if document.paint()[vertex] == Paint::Handle(document.handles()[0].id) {
            let apart = (*rest + document.from_rest()[vertex]).distance(affine.transform_point3(*rest));
            assert!(apart < 1e-9, "{apart:e}");
        }
    }
}

#[test]
fn an_arm_that_is_seen_from_its_hand_swings_back_as_the_hand_is_pulled_aside() {
    let along = |is_free: bool| {
        let mut rig = bar();
        rig.command(Command::ToggleProjection);
        if is_free {
            rig.command(Command::FreeOrHoldDepth);
        }
        pull(&mut rig, PULL_PX);
        rig.editor.view().handles[0].centre().x
    };
    let (held, free) = (along(false), along(true));
    assert!(free < held - 0.1, "{free} and {held}");
}

#[test]
fn every_step_with_a_free_handle_is_undone_and_redone_to_the_bit() {
    let mut rig = bar();
    let mut states = vec![rig.fingerprint()];
    rig.command(Command::FreeOrHoldDepth);
    states.push(rig.fingerprint());
    pull(&mut rig, PULL_PX);
    states.push(rig.fingerprint());
    // Another method chooses another depth.
    rig.choose("bilaplacian");
    states.push(rig.fingerprint());
    pull(&mut rig, DVec2::new(-30.0, 60.0));
    states.push(rig.fingerprint());
    rig.command(Command::FreeOrHoldDepth);
    states.push(rig.fingerprint());
    for state in states.iter().rev().skip(1) {
        rig.undo();
        assert!(rig.fingerprint() == *state);
    }
    for state in states.iter().skip(1) {
        rig.redo();
        assert!(rig.fingerprint() == *state);
    }
}

#[test]
fn the_free_direction_is_that_of_sight_at_the_last_move() {
    let mut rig = bar();
    rig.command(Command::FreeOrHoldDepth);
    let direction = |rig: &Rig| rig.editor.view().handles[0].free_along.unwrap();
    assert!(direction(&rig).dot(DVec3::NEG_X) > 0.99);
    rig.command(Command::View(NamedView::Front));
    assert!(direction(&rig).dot(DVec3::NEG_X) > 0.99);
    assert!(rig.drag(GizmoPart::Arrow(1), DVec2::new(0.0, -40.0)));
    let view = rig.editor.view();
    let sight = view.camera.towards_eye(view.handles[0].centre());
    assert!(direction(&rig).dot(-sight) > 1.0 - 1e-12);
}

#[test]
fn an_exported_edit_and_a_project_keep_the_freedom_and_give_the_shape() {
    for method in ["bilaplacian", "arap"] {
        let mut rig = bar();
        rig.choose(method);
        rig.command(Command::FreeOrHoldDepth);
        pull(&mut rig, PULL_PX);
        let shown = rig.editor.document().from_rest().to_vec();
        let edit = rig.editor.edit_file().unwrap();
        let read = EditFile::parse(&edit.to_json()).unwrap();
        assert!(read.handles[0].free_along.is_some());
        let setup = read.resolve(&rig.model).unwrap();
        let (progress, cancel) = (Progress::new(), Cancel::new());
        let ordering = setup.method.ordering(&rig.model.topology, &progress, &cancel).unwrap();
        let bound = setup.problem(&rig.model).bind(ordering.as_ref(), &progress, &cancel);
        let mut bound = bound.unwrap();
        let start = match &setup.kept {
            Some(kept) => Start::Kept(kept.clone()),
            None => Start::Shape(Arc::new(vec![DVec3::ZERO; shown.len()])),
        };
        let bent = start
            .bend(&mut bound, &setup.targets_at(1.0), Until::End, &cancel)
            .unwrap();
        let apart = farthest(&bent.shown, &shown) / rig.model.bounds().unwrap().diagonal();
        assert!(apart < ITERATED, "{method}: {apart:e}");
        if method == "bilaplacian" {
            assert!(apart < 1e-9, "{apart:e}");
        }
        let mesh = MeshReference {
            name: None,
            path: Some("bar.off".to_owned()),
            geometry: geometry_hash(&rig.model),
        };
        let text = rig.editor.snapshot().unwrap().project(mesh).to_json();
        let handles = rig.editor.document().handles().to_vec();
        assert!(handles[0].free_along.is_some());
        rig.send(Event::Opened {
            model: Arc::clone(&rig.model),
            name: "bar".to_owned(),
            beginning: Some(Beginning::parse(&text).unwrap()),
        });
        rig.drain();
        assert_eq!(rig.editor.document().handles(), handles, "{method}");
        let again = rig.editor.document().from_rest();
        assert_eq!(
            farthest(again, &shown),
            0.0,
            "{method}: a project has the shape to the bit"
        );
    }
}

#[test]
fn a_free_direction_is_refused_beside_a_line_and_without_length() {
    let edit = |members: &str| {
        let text =
            format!(r#"{{"version": 1, "method": {{"name": "arap"}}, "handles": [{{"name": "hand", {members}}}]}}"#);
        EditFile::parse(&text)
    };
    let of = |refused: Result<EditFile, EditError>| refused.unwrap_err().to_string();
    let said = of(edit(r#""select": "all", "free_along": [0, 0, 0]"#));
    assert!(
        said.contains("handles[0].free_along") && said.contains("not all 0"),
        "{said}"
    );
    let line = r#""curve": {"points": [[0, 0, 0], [1, 0, 0]]}, "free_along": [0, 0, 1]"#;
    let said = of(edit(line));
    assert!(said.contains("`free_along`"), "{said}");
    assert!(of(edit(r#""select": "all", "free_along": 3"#)).contains("handles[0].free_along"));
    assert_eq!(
        edit(r#""select": "all", "free_along": [0, 0, 2]"#).unwrap().handles[0].free_along,
        Some(DVec3::Z * 2.0)
    );
}

/// A bar along x, seen from its near end, whose nearer half follows a curve through it.
fn bar_along_curve(method: &str) -> Rig {
    let edit = r#"{"version": 1, "method": {"name": "arap"},
        "fixed": {"slab": {"axis": "x", "from": 0, "to": 0.1}},
        "handles": [{"name": "hand", "select": {"slab": {"axis": "x", "from": 0.6, "to": 1}},
            "curve": {"points": [[5, 0.2, 1], [6.5, 1, 1], [8, 1.8, 1]]}}]}"#;
    let mut rig = bar();
    rig.send(Event::Opened {
        model: Arc::clone(&rig.model),
        name: "bar".to_owned(),
        beginning: Some(EditFile::parse(edit).unwrap().into()),
    });
    rig.choose(method);
    rig.command(Command::View(NamedView::Right));
    rig.command(Command::FrameAll);
    rig.command(Command::SetTool(ToolMode::Select));
    rig.command(Command::SelectHandle(HandleId(0)));
    rig.drain();
    rig
}

/// Drags the last point of the curve in the plane of the screen. Returns where it was left.
fn drag_last_point(rig: &mut Rig, by_px: DVec2) -> DVec2 {
    let from_px = px(rig, *curve(rig).moved().last().unwrap());
    rig.move_to(from_px);
    rig.press(from_px);
    for share in [0.5, 1.0] {
        rig.move_to(from_px + share * by_px);
        rig.drain();
    }
    rig.release(from_px + by_px);
    rig.drain();
    from_px + by_px
}

#[test]
fn a_curves_point_that_is_free_in_depth_stays_under_the_pointer_and_lowers_the_energy() {
    for (method, is_chain) in [
        ("bilaplacian", false),
        ("arap", false),
        ("arap", true),
        ("shells", false),
    ] {
        let case = format!("{method} {is_chain}");
        let [held, free] = [false, true].map(|is_free| {
            let mut rig = bar_along_curve(method);
            if is_chain {
                rig.command(Command::ToggleChain);
            }
            if is_free {
                rig.command(Command::FreeOrHoldDepth);
            }
            let before = curve(&rig);
            // A straight chain reaches nothing farther.
            let to_px = drag_last_point(&mut rig, if is_chain { DVec2::new(120.0, 220.0) } else { PULL_PX });
            let moved = curve(&rig);
            assert!(
                rig.editor.document().is_settled() && rig.editor.view().problem.is_none(),
                "{case}"
            );
            let apart_px = px(&rig, *moved.moved().last().unwrap()).distance(to_px);
            assert!(apart_px < 1.0, "{case}: {apart_px}");
            if is_chain {
                for (one, other) in before.moved().windows(2).zip(moved.moved().windows(2)) {
                    let apart = one[0].distance(one[1]) - other[0].distance(other[1]);
                    assert!(apart.abs() < 1e-9, "{case}: {apart:e}");
                }
            }
            rig
        });
        let depth = |rig: &Rig| curve(rig).moved()[2].x;
        let energy = |rig: &Rig| {
            let edit = rig.editor.edit_file().unwrap();
            let setup = edit.resolve(&rig.model).unwrap();
            let (progress, cancel) = (Progress::new(), Cancel::new());
            let ordering = setup.method.ordering(&rig.model.topology, &progress, &cancel).unwrap();
            let bound = setup.problem(&rig.model).bind(ordering.as_ref(), &progress, &cancel);
            let start = Start::Shape(Arc::new(rig.editor.document().from_rest().to_vec()));
            let mut bound = bound.unwrap();
            let bent = start.bend(&mut bound, &setup.targets_at(1.0), Until::End, &cancel);
            bent.unwrap().step.energy
        };
        let (of_held, of_free) = (energy(&held), energy(&free));
        assert!(of_free < of_held, "{case}: {of_free} {of_held}");
        assert!((depth(&free) - depth(&held)).abs() > 0.01, "{case}: {}", depth(&free));
    }
}

#[test]
fn a_drag_of_a_free_point_is_one_step_that_is_undone_and_redone_to_the_bit() {
    for method in ["bilaplacian", "arap"] {
        let mut rig = bar_along_curve(method);
        rig.command(Command::FreeOrHoldDepth);
        let mut states = vec![rig.fingerprint()];
        for _ in 0..2 {
            drag_last_point(&mut rig, 0.5 * PULL_PX);
            states.push(rig.fingerprint());
        }
        for state in states.iter().rev().skip(1) {
            rig.undo();
            assert!(rig.fingerprint() == *state, "{method}");
        }
        for state in states.iter().skip(1) {
            rig.redo();
            assert!(rig.fingerprint() == *state, "{method}");
        }
        // The point is held where it was found, also in a project.
        let text = saved(&rig);
        assert_eq!(reopened(&rig, &text).fingerprint(), rig.fingerprint(), "{method}");
    }
}
