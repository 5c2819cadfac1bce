//! The visible parts of a binding: the weights of the selected handle, and the smooth base.
#![allow(clippy::unwrap_used, clippy::expect_used, reason = "a test that can't go on fails")]

use std::sync::Arc;

use crate::rig::{CENTRE_PX, Rig};
use glam::{DVec2, DVec3};
use pliant_deform::{Method, OptionValue, Role};
use pliant_editor::{Command, Event, JobKind, Key, Shading, ToolMode, UpAxis};
use pliant_mesh::shapes;

fn tube() -> Rig {
    let mut rig = Rig::open(shapes::tube(16, 24, 3.0));
    // The tube stands along Z. These tests paint its end.
    rig.command(Command::SetUp(UpAxis::Y));
    rig
}

fn set(rig: &mut Rig, method: &str, option: &str, value: &'static str) {
    let method = Method::from_name(method).unwrap();
    let method = method.with([(option, OptionValue::Name(value))]).unwrap();
    rig.command(Command::SetMethod(method));
    rig.drain();
}

fn why_not(rig: &Rig, command: &Command) -> String {
    rig.editor.unavailable_because(command).unwrap_or_default().into_owned()
}

#[test]
fn the_weights_are_those_of_the_selected_handle_and_follow_method_and_options() {
    let show = Command::SetShading(Shading::Weights);
    let mut rig = tube();
    assert!(why_not(&rig, &show).contains("No handle is selected"));
    rig.choose("poisson");
    rig.paint_handle();
    rig.command(Command::NewHandle);
    rig.paint(ToolMode::PaintHandle, &[CENTRE_PX + DVec2::new(0.0, 90.0)]);
    rig.drain();
    assert_eq!(rig.editor.document().handles().len(), 2);
    assert_eq!(rig.editor.view().weights, None, "nobody asked");
    rig.command(show.clone());
    rig.drain();
    let mut seen: Vec<Arc<Vec<f64>>> = Vec::new();
    for _ in 0..2 {
        rig.command(Command::NextHandle);
        rig.drain();
        let view = rig.editor.view();
        let ids = rig.editor.document().handles().iter().map(|handle| handle.id);
        let selected = ids.into_iter().position(|id| Some(id) == view.selected).unwrap();
        let weights = view.weights.expect("the method has some");
        for (weight, role) in weights.iter().zip(rig.editor.roles()) {
            match role {
                Role::Handle(handle) => {
                    let own = if usize::from(*handle) == selected { 1.0 } else { 0.0 };
                    assert_eq!(*weight, own);
                }
                Role::Fixed => assert_eq!(*weight, 0.0),
                Role::Free => assert!((0.0..=1.0).contains(weight), "{weight}"),
            }
        }
        assert!(weights.iter().any(|weight| 0.1 < *weight && *weight < 0.9));
        seen.push(Arc::clone(weights));
    }
    assert_ne!(seen[0], seen[1]);
    set(&mut rig, "poisson", "propagation", "harmonic");
    let by_one = rig.editor.view().weights.unwrap().to_vec();
    set(&mut rig, "poisson", "propagation", "geodesic");
    assert_ne!(*rig.editor.view().weights.unwrap().as_ref(), by_one);
    // Without weights nothing is shown, and the reason names the method.
    rig.choose("arap");
    assert_eq!(rig.editor.view().weights, None);
    assert!(
        why_not(&rig, &show).contains("\"Limbs\" uses no weights"),
        "{}",
        why_not(&rig, &show)
    );
    rig.undo();
    rig.drain();
    assert!(rig.editor.view().weights.is_some());
    rig.command(Command::Deselect);
    assert_eq!(rig.editor.view().weights, None);
}

#[test]
fn the_smooth_base_is_shown_in_place_of_the_surface_and_nothing_else_changes() {
    let mut rig = tube();
    assert!(why_not(&rig, &Command::ToggleBase).contains("not bound yet"));
    rig.choose("bilaplacian");
    rig.paint_handle();
    rig.drain();
    assert!(why_not(&rig, &Command::ToggleBase).contains("option Detail"));
    set(&mut rig, "bilaplacian", "detail", "normal-displacements");
    rig.type_keys("gz.3");
    rig.key(Key::Enter);
    rig.drain();
    let before = (rig.fingerprint(), rig.drawn());
    rig.command(Command::ToggleBase);
    rig.drain();
    let view = rig.editor.view();
    assert!(!Arc::ptr_eq(view.drawn, view.displacements));
    let mut faired = 0;
    for ((base, shape), role) in view.drawn.iter().zip(view.displacements.iter()).zip(rig.editor.roles()) {
        match role {
            Role::Free => faired += usize::from(base != shape),
            _ => assert_eq!(base, shape, "what is held is where the shape has it"),
        }
    }
    assert!(faired > 10, "{faired}");
    assert_eq!((rig.fingerprint(), rig.drawn()), before);
    // If there is none, the surface is shown.
    rig.choose("arap");
    let view = rig.editor.view();
    assert!(Arc::ptr_eq(view.drawn, view.displacements));
    assert_eq!(
        rig.editor.unavailable_because(&Command::ToggleBase),
        None,
        "it can be turned off"
    );
    rig.command(Command::ToggleBase);
    rig.drain();
    assert!(!rig.editor.view().look.base);
}

/// The drawn base.
fn base(rig: &Rig) -> Arc<Vec<DVec3>> {
    let view = rig.editor.view();
    assert!(!Arc::ptr_eq(view.drawn, view.displacements), "the base is drawn");
    Arc::clone(view.drawn)
}

#[test]
fn the_smooth_base_bends_with_the_edit_and_rests_with_it() {
    let mut rig = tube();
    rig.choose("bilaplacian");
    rig.paint_handle();
    set(&mut rig, "bilaplacian", "detail", "deformation-transfer");
    rig.command(Command::ToggleBase);
    rig.drain();
    let at_rest = base(&rig);
    rig.type_keys("gz.3");
    rig.drain();
    let dragged = base(&rig);
    assert_ne!(dragged, at_rest, "it bends while the handle is moved");
    rig.key(Key::Enter);
    rig.drain();
    assert_eq!(base(&rig), dragged);
    rig.type_keys("rx40");
    rig.key(Key::Enter);
    rig.drain();
    let turned = base(&rig);
    assert_ne!(turned, dragged);
    rig.undo();
    rig.drain();
    assert_eq!(base(&rig), dragged, "one step back");
    rig.undo();
    rig.drain();
    assert_eq!(base(&rig), at_rest, "all handles rest");
    rig.command(Command::Redo);
    rig.drain();
    rig.command(Command::Redo);
    rig.drain();
    assert_eq!(base(&rig), turned);
    set(&mut rig, "bilaplacian", "detail", "none");
    let view = rig.editor.view();
    assert!(Arc::ptr_eq(view.drawn, view.displacements), "there is no base");
    rig.undo();
    rig.drain();
    assert_eq!(base(&rig), turned);
    // After applying, the bent surface is another one with another base, at rest again.
    rig.command(Command::Apply);
    rig.drain();
    let view = rig.editor.view();
    for ((base, shape), role) in view.drawn.iter().zip(view.displacements.iter()).zip(rig.editor.roles()) {
        assert!(
            *role == Role::Free || base == shape,
            "what is held is where the shape has it"
        );
    }
    assert_ne!(base(&rig), at_rest);
}

#[test]
fn a_base_that_is_looked_up_along_a_drag_is_not_thrown_away_for_a_newer_one() {
    let mut rig = tube();
    rig.choose("bilaplacian");
    rig.paint_handle();
    set(&mut rig, "bilaplacian", "detail", "normal-displacements");
    rig.command(Command::ToggleBase);
    rig.drain();
    rig.type_keys("gz.1");
    rig.drain();
    let before = base(&rig);
    rig.type_keys("2");
    let first = rig.jobs.take(JobKind::Inspect).unwrap();
    rig.type_keys("3");
    rig.send(Event::JobDone(first.run()));
    let on_the_way = base(&rig);
    assert_ne!(on_the_way, before, "what ran is shown");
    rig.drain();
    assert_ne!(base(&rig), on_the_way, "the newest follows");
}
