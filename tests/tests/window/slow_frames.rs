//! Input that arrives within one slow frame goes to the widget that had the pointer and the keyboard at that moment,
//! and Escape in a field reverts the typed text. Skipped by name if there is no graphics device at all.

#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    reason = "tests fail by panicking and say what they skip"
)]

use std::fs;

use crate::disk::{await_words, edit, open};
use crate::window_rig::Session;
use egui::{Event, Key, Modifiers, PointerButton, vec2};
use egui_kittest::kittest::Queryable;
use glam::DVec3;
use pliant_editor::ToolMode;
use pliant_tests::Folder;

/// Presses and releases a key that types a text.
fn typed(key: Key, text: &str) -> Vec<Event> {
    let stroke = |pressed| Event::Key {
        key,
        physical_key: None,
        pressed,
        repeat: false,
        modifiers: Modifiers::NONE,
    };
    let text = (!text.is_empty()).then(|| Event::Text(text.to_owned()));
    [stroke(true)].into_iter().chain(text).chain([stroke(false)]).collect()
}

/// Turns the camera by a drag with the middle button.
fn turn_view(session: &mut Session) {
    let before = *session.harness.state().editor().view().camera;
    let middle = session.harness.state().view_rect().center();
    for (pos, pressed) in [(middle, true), (middle + vec2(30.0, 0.0), false)] {
        let button = Event::PointerButton {
            pos,
            button: PointerButton::Middle,
            pressed,
            modifiers: Modifiers::NONE,
        };
        session.in_one_frame([Event::PointerMoved(pos), button]);
    }
    assert_ne!(*session.harness.state().editor().view().camera, before);
}

#[test]
fn what_a_field_takes_is_no_shortcut_however_slow_the_frames_are() {
    let Some(mut session) = Session::with_handle() else {
        return;
    };
    // A late result may change the height of a bar. A camera that still frames everything would frame it anew; one that
    // was turned stays where it is.
    turn_view(&mut session);
    let state = |session: &Session| {
        let view = session.harness.state().editor().view();
        (view.tool, *view.camera)
    };
    let before = state(&session);
    session.click_into("Move");
    let keys = [typed(Key::Period, "."), typed(Key::Num2, "2"), typed(Key::Enter, "")].concat();
    session.in_one_frame(keys);
    assert_eq!(session.translation().x, 0.2, "the field took what was typed");
    assert_eq!(state(&session), before, "and nobody else did");

    // A key after Enter is a shortcut again, even within the same slow frame.
    session.click_into("Move");
    session.in_one_frame([typed(Key::Num0, "0"), typed(Key::Enter, ""), typed(Key::Num2, "2")].concat());
    assert_eq!(session.translation().x, 0.0);
    assert_eq!(session.harness.state().editor().view().tool, ToolMode::PaintFree);
}

#[test]
fn escape_in_a_number_field_takes_the_typed_number_back() {
    let Some(mut session) = Session::with_handle() else {
        return;
    };
    for is_slow in [false, true] {
        session.click_into("Move");
        if is_slow {
            session.in_one_frame([typed(Key::Num5, "5"), typed(Key::Escape, "")].concat());
        } else {
            for event in [typed(Key::Num5, "5"), typed(Key::Escape, "")].concat() {
                session.in_one_frame([event]);
            }
        }
        assert_eq!(session.translation(), DVec3::ZERO);
        // Nor does it later: focusing the field and leaving it again types nothing.
        session.click_into("Move");
        session.in_one_frame(typed(Key::Enter, ""));
        assert_eq!(session.translation(), DVec3::ZERO);
        assert_eq!(session.harness.state().editor().document().handles().len(), 1);
    }
}

#[test]
fn a_click_and_what_is_typed_into_the_palette_after_it_may_come_in_one_frame() {
    let Some(mut session) = Session::with_handle() else {
        return;
    };
    // Resizing the region follows the pointer; the click confirms it, and only then does the palette open.
    session.key(Key::E, Modifiers::NONE);
    let at = session.harness.state().view_rect().center();
    session.pointer(at, None);
    assert!(session.harness.state().editor().is_acting());
    let button = |pressed| Event::PointerButton {
        pos: at,
        button: PointerButton::Primary,
        pressed,
        modifiers: Modifiers::NONE,
    };
    let click = [button(true), button(false)];
    let palette = [typed(Key::F1, ""), typed(Key::W, "w"), typed(Key::I, "i")].concat();
    session.in_one_frame(click.into_iter().chain(palette));
    assert!(
        !session.harness.state().editor().is_acting(),
        "the click was for the view"
    );
    let field = session.harness.get_by_label("Command");
    assert_eq!(field.value().as_deref(), Some("wi"), "and the letters for the palette");
}

#[test]
fn a_name_and_enter_after_it_may_come_in_one_frame_even_before_the_folder_is_read() {
    let folder = Folder::new();
    let file = folder.write_mesh("ball.off", &pliant_mesh::shapes::icosphere(3));
    let before = fs::read(&file).unwrap();
    let Some(mut session) = open(&file) else { return };
    edit(&mut session);
    for (name, is_read) in [("r", true), ("a", false)] {
        session.key(Key::S, Modifiers::COMMAND | Modifiers::SHIFT);
        // There is no dialog of the system here, so the window shows its own.
        await_words(&mut session, "Save the model as");
        if is_read {
            await_words(&mut session, ".off");
        }
        let key = Key::from_name(&name.to_uppercase()).unwrap();
        session.in_one_frame([typed(key, name), typed(Key::Enter, "")].concat());
        session.settle();
        let saved = folder.at(&format!("{name}.off"));
        assert!(saved.is_file(), "{name}");
        assert_eq!(fs::read(&file).unwrap(), before, "the suggested name is not the answer");
    }
}
