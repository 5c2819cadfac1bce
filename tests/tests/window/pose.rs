//! The pose brush, the panel's key and the menu of a right click in the whole window; skipped by name if there is no
//! graphics device at all.
#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    clippy::print_stderr,
    reason = "tests fail by panicking and say what they skip"
)]

use crate::window_rig::Session;
use egui::{Event, Key, Modifiers, PointerButton, Pos2, vec2};
use egui_kittest::kittest::Queryable;
use glam::DVec3;
use pliant_editor::{Command, NamedView, ToolMode};
use pliant_tests::{Folder, assets, open, run};

/// The place of the tip of the sample's tail in the view.
fn tail(session: &Session) -> Pos2 {
    session.point_of(|positions| {
        let near = positions.iter().min_by(|a, b| a.z.total_cmp(&b.z)).unwrap();
        let around: Vec<DVec3> = positions.iter().filter(|p| p.distance(*near) < 0.15).copied().collect();
        let middle = around.iter().sum::<DVec3>() / around.len() as f64;
        // The tail is bent, so its middle may be beside it.
        let from_middle = |p: &&DVec3| p.distance_squared(middle);
        *around
            .iter()
            .min_by(|a, b| from_middle(a).total_cmp(&from_middle(b)))
            .unwrap()
    })
}

#[test]
fn from_a_fresh_start_a_limb_is_posed_and_saved_as_a_morph_target_in_five_actions() {
    let Some(mut session) = Session::begin() else { return };
    for command in [Command::View(NamedView::Right), Command::FrameAll] {
        session.harness.state_mut().command(command);
        session.settle();
    }
    session.key(Key::Num7, Modifiers::NONE);
    assert_eq!(session.harness.state().editor().view().tool, ToolMode::Pose);
    let from = tail(&session);
    session.stroke(from, from - vec2(20.0, 90.0));
    session.settle();
    let editor = session.harness.state().editor();
    assert_eq!(editor.document().handles().len(), 1, "{}", editor.view().status);
    assert!(editor.document().handles()[0].turn_deg.length() > 5.0);
    assert_eq!(editor.history().undo_name(), Some("Turn handle 1"));
    let shape = session.shape();
    assert!(shape.iter().any(|d| d.length() > 0.05));
    let held = shape.iter().filter(|d| **d == DVec3::ZERO).count();
    assert!(held > shape.len() / 2, "the body is held: {held} of {}", shape.len());

    let folder = Folder::new();
    let saved = folder.path().join("raised tail.glb");
    session.harness.state_mut().save_morph_to(saved.clone());
    session.settle();
    assert_eq!(
        session.harness.state().headline().map(|said| said.contains("Saved")),
        Some(true)
    );
    assert!(
        session.harness.state().editor().view().unsaved,
        "the work itself is not saved with it"
    );
    let info = run(["info".into(), saved.clone().into_os_string()]).done();
    assert!(info.out.contains("1 morph target"), "{}", info.out);
    // The target's weight is 1, so that other programs show the visible shape.
    let mut bent = Vec::new();
    open(&assets().join("creature.glb"))
        .model
        .drawn_positions(&shape, &mut bent);
    let seen = open(&saved).model.rest_positions();
    assert_eq!(seen.len(), bent.len());
    let apart = seen.iter().zip(&bent).map(|(p, q)| p.distance(*q));
    assert!(apart.fold(0.0, f64::max) < 1e-5);

    session.key(Key::Z, Modifiers::COMMAND);
    session.settle();
    assert!(session.harness.state().editor().document().handles().is_empty());
}

#[test]
fn n_shows_and_hides_the_panel_but_not_where_somebody_types() {
    let Some(mut session) = Session::begin() else { return };
    let wide = session.harness.state().view_rect().width();
    session.key(Key::N, Modifiers::NONE);
    session.harness.run_steps(2);
    assert!(session.harness.state().view_rect().width() > wide + 150.0);
    session.palette("n");
    session.key(Key::N, Modifiers::NONE);
    session.key(Key::Escape, Modifiers::NONE);
    session.harness.run_steps(2);
    assert!(session.harness.state().view_rect().width() > wide + 150.0);
    session.key(Key::N, Modifiers::NONE);
    session.harness.run_steps(2);
    assert!((session.harness.state().view_rect().width() - wide).abs() < 1.0);
}

#[test]
fn a_right_click_on_a_handle_opens_its_menu_and_a_click_beside_it_paints_nothing() {
    let Some(mut session) = Session::with_handle() else {
        return;
    };
    let at =
        session.point_of(|positions| *positions.iter().max_by(|a, b| a.y.total_cmp(&b.y)).unwrap()) + vec2(0.0, 8.0);
    session.harness.state_mut().command(Command::Deselect);
    session.pointer(at, None);
    for pressed in [true, false] {
        session.harness.event(Event::PointerButton {
            pos: at,
            button: PointerButton::Secondary,
            pressed,
            modifiers: Modifiers::NONE,
        });
        session.harness.step();
    }
    session.harness.run_steps(3);
    assert!(
        session.harness.state().editor().view().selected.is_some(),
        "what was clicked is selected"
    );
    // This is the menu's only item that is not also in the panel.
    let is_open = |session: &Session| {
        let listed = session.harness.query_all_by_label_contains("Select all handles");
        listed.count() > 0
    };
    assert!(is_open(&session));
    let steps = session.harness.state().editor().history().names().1;
    // The place is far from the menu, whose height is half the view's.
    let beside = session.harness.state().view_rect().right_bottom() - vec2(30.0, 30.0);
    // A click is short; a stroke of the tests takes longer.
    session.pointer(beside, None);
    session.pointer(beside, Some(true));
    session.pointer(beside, Some(false));
    session.settle();
    assert_eq!(session.harness.state().editor().history().names().1, steps);
    assert!(!is_open(&session), "it is closed");
}

#[test]
fn the_original_is_drawn_while_its_key_is_held() {
    let Some(mut session) = Session::with_handle() else {
        return;
    };
    for key in [Key::G, Key::X, Key::Num0, Key::Period, Key::Num1, Key::Enter] {
        session.key(key, Modifiers::NONE);
    }
    session.settle();
    let bent = session.shape();
    let shown = |session: &mut Session| {
        for _ in 0..200 {
            session.harness.step();
            std::thread::sleep(std::time::Duration::from_millis(5));
        }
        session.harness.state().shown_displacements().unwrap().to_vec()
    };
    session.harness.key_down(Key::O);
    assert!(shown(&mut session).iter().all(|d| *d == DVec3::ZERO));
    session.harness.key_up(Key::O);
    assert_eq!(shown(&mut session), bent);
}
