//! Examples in the whole window: a pose kept by the palette, blended by dragging its slider, undone as one step. Skipped
//! by name if there is no graphics device at all.
#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    dead_code,
    reason = "tests fail by panicking and do not need every verb of the rig"
)]

mod window_rig;

use egui::accesskit::Role;
use egui::{Key, Modifiers, vec2};
use egui_kittest::kittest::{NodeT, Queryable};
use glam::DVec3;
use pliant_editor::{Command, HandleTransform};
use window_rig::Session;

fn weights(session: &Session) -> Vec<Option<f64>> {
    let document = session.harness.state().editor().document();
    document
        .examples()
        .map_or_else(Vec::new, |examples| examples.weights.clone())
}

fn largest(shape: &[DVec3]) -> f64 {
    shape.iter().map(|d| d.length()).fold(0.0, f64::max)
}

#[test]
fn a_pose_is_kept_and_its_slider_blends_it_live_in_one_step() {
    let Some(mut session) = Session::with_handle() else {
        return;
    };
    session.palette("method: discrete shells");
    session.key(Key::Enter, Modifiers::NONE);
    session.settle();
    let id = session.harness.state().editor().document().handles()[0].id;
    let size = session
        .harness
        .state()
        .editor()
        .view()
        .model
        .unwrap()
        .bounds()
        .unwrap()
        .diagonal();
    let up = HandleTransform::Trs {
        translation: DVec3::Y * 0.1 * size,
        rotation: glam::DQuat::IDENTITY,
        scale: DVec3::ONE,
        pivot: None,
    };
    session.harness.state_mut().command(Command::SetHandleTransform(id, up));
    session.settle();
    let posed = largest(&session.shape());
    session.palette("keep this pose");
    session.key(Key::Enter, Modifiers::NONE);
    session.settle();
    assert_eq!(weights(&session), [Some(0.0)], "{}", session.status());
    // Without handles the weight alone moves it.
    session
        .harness
        .state_mut()
        .command(Command::SetHandleTransform(id, HandleTransform::IDENTITY));
    session.harness.state_mut().command(Command::DeleteHandle);
    session.settle();
    assert!(largest(&session.shape()) < 1e-3 * posed, "{}", session.status());

    let is_weight = |label: Option<String>| label.is_some_and(|label| label == "Weight of example 1");
    let slider = |session: &Session| {
        let mut sliders = session.harness.get_all_by_role(Role::Slider);
        let slider = sliders.find(|node| is_weight(node.accesskit_node().label()));
        let slider = slider.expect("the panel has the slider");
        slider.scroll_to_me();
        slider.rect()
    };
    slider(&session);
    session.harness.run_steps(8);
    let slider = slider(&session);
    let at = |share: f32| slider.left_center() + vec2(slider.width() * share, 0.0);
    session.pointer(at(0.25), None);
    session.pointer(at(0.25), Some(true));
    let mut before = 0.0;
    for share in [0.4, 0.6, 0.8] {
        session.pointer(at(share), None);
        session.settle();
        let weight = weights(&session)[0].unwrap();
        assert!(weight > before, "{share}: {weight}");
        before = weight;
        let ratio = largest(&session.shape()) / posed;
        assert!((ratio - weight).abs() < 0.2, "{share}: {ratio} {weight}");
    }
    session.pointer(at(0.8), Some(false));
    session.settle();
    session.key(Key::Z, Modifiers::COMMAND);
    session.settle();
    assert_eq!(weights(&session), [Some(0.0)]);
    session.key(Key::Z, Modifiers::COMMAND | Modifiers::SHIFT);
    session.settle();
    assert_eq!(weights(&session), [Some(before)]);
    session.harness.get_by_label("Remove").click();
    session.harness.run_steps(2);
    session.settle();
    assert!(weights(&session).is_empty());
}
