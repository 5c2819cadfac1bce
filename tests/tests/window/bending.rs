//! A person's work on a bent shape, by pointer and keyboard: its strength, the warning if it passes through itself,
//! kept poses, and the opened shape beside it. Skipped by name if there is no graphics device at all.

#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    reason = "tests fail by panicking and say what they skip"
)]

use std::time::{Duration, Instant};

use crate::window_rig::{Session, colour_at};
use egui::accesskit::Role;
use egui::{Key, Modifiers, Pos2, Rect, pos2, vec2};
use egui_kittest::kittest::{NodeT, Queryable};
use glam::{DQuat, DVec3};
use pliant_editor::{Command, Document, HandleTransform};

/// The sample with a moved handle at its top, in a window that is high enough for the whole panel.
fn bent(translation: DVec3, turn_rad: f64) -> Option<Session> {
    let mut session = Session::with_handle()?;
    session.harness.set_size(vec2(1000.0, 1500.0));
    session.harness.run();
    let id = session.harness.state().editor().view().selected.unwrap();
    let transform = HandleTransform::Trs {
        translation,
        rotation: DQuat::from_rotation_y(turn_rad),
        scale: DVec3::ONE,
        pivot: None,
    };
    session
        .harness
        .state_mut()
        .command(Command::SetHandleTransform(id, transform));
    session.settle();
    Some(session)
}

fn document(session: &Session) -> &Document {
    session.harness.state().editor().document()
}

fn slider(session: &Session) -> Rect {
    let mut nodes = session.harness.get_all_by_label("Strength");
    let slider = nodes.find(|node| node.accesskit_node().role() == Role::Slider);
    slider.expect("the panel has the slider").rect()
}

/// Moves the focus to the first field of the handle's translation.
fn focus_move(session: &Session) {
    let mut fields = session.harness.get_all_by_label("Move");
    let field = fields.find(|node| node.accesskit_node().role() == Role::SpinButton);
    field.unwrap().focus();
}

#[test]
fn numbers_are_typed_as_sums_with_commas_and_units_and_refused_in_words() {
    let Some(mut session) = Session::with_handle() else {
        return;
    };
    let start = session.translation();
    assert_eq!(start, DVec3::ZERO);
    let mut x = 0.0;
    for (text, value) in [
        ("2*5", 10.0),
        ("1/4", 0.25),
        ("-5 cm", -0.05),
        ("0,5", 0.5),
        ("5 apples", 0.5),
    ] {
        focus_move(&session);
        session.harness.run_steps(2);
        session.key(Key::A, Modifiers::COMMAND);
        session.harness.event(egui::Event::Text(text.to_owned()));
        session.key(Key::Enter, Modifiers::NONE);
        session.settle();
        x = session.translation().x;
        assert!((x - value).abs() < 1e-12, "{text}: {x}");
    }
    assert_eq!(x, 0.5);
    let said = session.harness.state().headline().unwrap();
    assert!(said.contains("5 apples") && said.contains("type one like"), "{said}");
}

#[test]
fn the_strength_is_dragged_and_typed_and_what_is_moved_next_goes_on_from_it() {
    let Some(mut session) = bent(DVec3::X * 0.05, 1.0) else {
        return;
    };
    let whole = session.shape();
    let before = document(&session).handles()[0].clone();
    // Across the slider from its right end to its middle: one step of the history.
    let place = slider(&session);
    session.stroke(
        pos2(place.right() - 4.0, place.center().y),
        pos2(place.left() + 0.5 * place.width(), place.center().y),
    );
    let strength = document(&session).strength();
    assert!(strength > 0.2 && strength < 0.8, "{strength}");
    assert_eq!(session.harness.state().editor().view().undo, Some("Change strength"));
    let handle = document(&session).handles()[0].clone();
    assert!((handle.turn_deg.y - before.turn_deg.y * strength).abs() < 1e-6);
    assert_ne!(session.shape(), whole);
    session.key(Key::Z, Modifiers::COMMAND);
    session.settle();
    assert_eq!(session.shape(), whole);
    assert_eq!(document(&session).strength(), 1.0);

    // Typed into its number.
    session.click_into("Strength");
    session.harness.event(egui::Event::Text("0".to_owned()));
    session.key(Key::Enter, Modifiers::NONE);
    session.settle();
    assert_eq!(document(&session).strength(), 0.0);
    assert!(session.shape().iter().all(|displacement| *displacement == DVec3::ZERO));

    // From the palette, then by G, X and a number: the shown state is the whole.
    session.palette("half strength");
    session.key(Key::Enter, Modifiers::NONE);
    session.settle();
    assert_eq!(document(&session).strength(), 0.5);
    for key in [Key::G, Key::X, Key::Num0, Key::Period, Key::Num0, Key::Num1, Key::Enter] {
        session.key(key, Modifiers::NONE);
    }
    session.settle();
    assert_eq!(document(&session).strength(), 1.0);
    assert!((session.translation().x - document(&session).handles()[0].pivot.x).is_finite());
    let HandleTransform::Trs { translation, .. } = document(&session).handles()[0].transform else {
        panic!("it was moved, turned and scaled");
    };
    assert!(translation.distance(DVec3::X * 0.035) < 1e-9, "{translation}");
}

/// Lets frames pass until the search for self-intersections is done.
fn await_intersections(session: &mut Session) {
    let start = Instant::now();
    while session.harness.state().editor().intersections().is_none() {
        assert!(start.elapsed() < Duration::from_secs(60), "it was never looked for");
        std::thread::sleep(Duration::from_millis(10));
        session.harness.step();
    }
}

#[test]
fn a_shape_that_passes_through_itself_is_told_and_shown() {
    let Some(mut session) = bent(DVec3::ZERO, 0.0) else {
        return;
    };
    assert!(
        session.harness.state().editor().intersections().is_none(),
        "nothing is bent"
    );
    let height = session
        .harness
        .state()
        .editor()
        .view()
        .model
        .unwrap()
        .bounds()
        .unwrap()
        .extent()
        .y;
    let id = session.harness.state().editor().view().selected.unwrap();
    let down = HandleTransform::Trs {
        translation: DVec3::new(0.0, -0.6 * height, 0.0),
        rotation: DQuat::IDENTITY,
        scale: DVec3::ONE,
        pivot: None,
    };
    session
        .harness
        .state_mut()
        .command(Command::SetHandleTransform(id, down));
    session.settle();
    await_intersections(&mut session);
    let found = session.harness.state().editor().intersections().unwrap().clone();
    let sentence = found.sentence().expect("the head went through the body");
    session.harness.run_steps(2);
    session.harness.get_by_label(&sentence);
    let before = *session.harness.state().editor().view().camera;
    let button = if found.places.len() == 1 { "Go there" } else { "Go to 1" };
    let middle = session.harness.get_by_label(button).rect().center();
    for pressed in [true, false] {
        session.pointer(middle, Some(pressed));
    }
    session.harness.run_steps(2);
    let after = *session.harness.state().editor().view().camera;
    let places = found.places[0].segments.as_flattened();
    let nearest = places
        .iter()
        .map(|p| p.distance(after.target))
        .fold(f64::INFINITY, f64::min);
    assert!(nearest < 0.2 * height, "{nearest}");
    assert!(after.distance < before.distance);
    // After undo there is nothing to report.
    session.key(Key::Z, Modifiers::COMMAND);
    session.settle();
    assert!(session.harness.query_by_label(&sentence).is_none());
}

fn click(session: &mut Session, label: &str) {
    let middle = session.harness.get_by_label(label).rect().center();
    for pressed in [true, false] {
        session.pointer(middle, Some(pressed));
    }
    session.settle();
}

#[test]
fn a_pose_is_kept_and_taken_again() {
    let Some(mut session) = bent(DVec3::X * 0.05, 0.4) else {
        return;
    };
    click(&mut session, "Keep pose");
    let kept = document(&session).handles()[0].affine();
    session.key(Key::G, Modifiers::ALT);
    session.settle();
    assert!(!document(&session).is_displaced());
    click(&mut session, "Apply pose 1");
    assert_eq!(document(&session).handles()[0].affine(), kept);
    assert!(document(&session).is_displaced());
    session
        .harness
        .state_mut()
        .command(Command::RenamePose(0, "bow".to_owned()));
    session.harness.run_steps(2);
    click(&mut session, "Remove bow");
    assert!(document(&session).poses().is_empty());
}

/// The window's picture at its full smoothness.
pub fn picture(session: &mut Session) -> image::RgbaImage {
    session.settle();
    let start = Instant::now();
    let mut before = session.harness.render().unwrap();
    let mut alike = 0;
    loop {
        assert!(start.elapsed() < Duration::from_secs(60), "it never comes to rest");
        std::thread::sleep(Duration::from_millis(400));
        session.harness.run_steps(3);
        let picture = session.harness.render().unwrap();
        // Borders become smooth a while after the last input, and on a busy machine the original's data comes late.
        alike = if picture == before { alike + 1 } else { 0 };
        if alike >= 3 && start.elapsed() > Duration::from_secs(2) {
            return picture;
        }
        before = picture;
    }
}

/// The area of the view, in square points, in which two pictures differ, without the text over its top and its corner.
pub fn differences(session: &Session, a: &image::RgbaImage, b: &image::RgbaImage) -> usize {
    let view = session.harness.state().view_rect();
    let inner = Rect::from_min_max(view.min + vec2(60.0, 130.0), view.max - vec2(60.0, 60.0));
    let (columns, rows) = (
        inner.left() as usize..inner.right() as usize,
        inner.top() as usize..inner.bottom() as usize,
    );
    let places = columns.flat_map(|x| rows.clone().map(move |y| pos2(x as f32, y as f32)));
    let differ = |place: &Pos2| {
        let pair = colour_at(a, *place).0.into_iter().zip(colour_at(b, *place).0);
        pair.into_iter().any(|(a, b)| a.abs_diff(b) > 24)
    };
    places.filter(differ).count()
}

#[test]
fn the_original_is_seen_beside_the_present_shape_and_through_it() {
    let Some(mut session) = bent(DVec3::new(0.3, 0.1, 0.0), 0.0) else {
        return;
    };
    session.harness.state_mut().command(Command::Deselect);
    // Its lines are marks on the present shape.
    await_intersections(&mut session);
    let present = picture(&mut session);
    session.harness.state_mut().command(Command::ToggleOriginal);
    let original = picture(&mut session);
    session.harness.state_mut().command(Command::ToggleOriginal);
    let apart = differences(&session, &present, &original);
    assert!(apart > 500, "{apart}");

    session.key(Key::O, Modifiers::ALT);
    session.settle();
    let view = session.harness.state().view_rect();
    for (end, shown, other) in [(view.right(), &original, &present), (view.left(), &present, &original)] {
        let line = session
            .harness
            .get_by_label("Line between before and after")
            .rect()
            .center();
        session.stroke(line, pos2(end, line.y));
        let split = picture(&mut session);
        let counts = [shown, other].map(|picture| differences(&session, &split, picture));
        assert!(
            counts[0] < apart / 50 && counts[1] > apart / 2,
            "{counts:?} of {apart} at {end}"
        );
    }
    assert_eq!(document(&session).handles().len(), 1, "the line is no stroke");

    // A ghost is between both.
    session.key(Key::O, Modifiers::SHIFT);
    let ghost = picture(&mut session);
    for shape in [&present, &original] {
        let count = differences(&session, &ghost, shape);
        assert!(count > apart / 8, "{count} of {apart}");
    }
    session.key(Key::O, Modifiers::SHIFT);
    let again = picture(&mut session);
    let count = differences(&session, &again, &present);
    assert!(count < apart / 50, "{count} of {apart}");
}
