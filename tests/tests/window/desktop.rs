//! The window among other programs: the file manager, the browser, the list of recent files; its menus by keys and by
//! the right button. Skipped by name if there is no graphics device at all.

#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    reason = "tests fail by panicking and say what they skip"
)]

use std::fs;
use std::path::PathBuf;
use std::sync::{Arc, Mutex};

use crate::window_rig::Session;
use egui::accesskit::Role;
use egui::{Event, Key, Modifiers, PointerButton, Pos2, Rect, vec2};
use egui_kittest::Node;
use egui_kittest::kittest::{NodeT, Queryable};
use glam::{DQuat, DVec3};
use pliant_app::window::{AppDirectories, Desktop, Elsewhere, KeepOriginal, Source};
use pliant_editor::{Command, HandleTransform, Paint, ToolMode};
use pliant_tests::Folder;

fn ball(folder: &Folder) -> PathBuf {
    folder.write_mesh("ball.off", &pliant_mesh::shapes::icosphere(3))
}

#[track_caller]
fn click(session: &mut Session, label: &str) {
    // A menu's labels end with their keys.
    let is_meant = |node: &Node<'_>| node.accesskit_node().label().is_some_and(|own| own.starts_with(label));
    let button = session.harness.query_all_by_role(Role::Button).find(is_meant);
    button.unwrap_or_else(|| panic!("there is no {label}")).click();
    session.harness.run_steps(4);
}

fn has(session: &Session, label: &str) -> bool {
    session.harness.query_all_by_label_contains(label).next().is_some()
}

/// Opens a menu and chooses a command.
#[track_caller]
fn choose(session: &mut Session, menu: &str, command: &str) {
    click(session, menu);
    click(session, command);
}

fn right_click(session: &mut Session, at: Pos2) {
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
    session.harness.run_steps(4);
}

#[test]
fn the_desktop_shows_the_folder_the_manual_and_the_place_for_faults() {
    let folder = Folder::new();
    let file = ball(&folder);
    let Some(mut session) = Session::begin_in(Source::File(file.clone()), AppDirectories::default()) else {
        return;
    };
    let shown: Arc<Mutex<Vec<Elsewhere>>> = Arc::default();
    let told = Arc::clone(&shown);
    session.harness.state_mut().set_desktop(Desktop::new(move |elsewhere| {
        told.lock().unwrap().push(elsewhere.clone());
        match elsewhere {
            Elsewhere::Page(address) => Err(format!("no browser opens {address}")),
            Elsewhere::File(_) => Ok(()),
        }
    }));
    let last = |session: &mut Session| {
        session.wait_until(|_| !shown.lock().unwrap().is_empty());
        shown.lock().unwrap().pop()
    };
    choose(&mut session, "File", "Show in folder");
    assert_eq!(last(&mut session), Some(Elsewhere::File(file)));
    // After a save the message offers the same for the saved file.
    let copy = folder.at("copy.off");
    session.harness.state_mut().save_to(copy.clone(), KeepOriginal::No);
    session.settle();
    click(&mut session, "Show in folder");
    assert_eq!(last(&mut session), Some(Elsewhere::File(copy)));

    choose(&mut session, "Help", "Manual");
    assert!(matches!(last(&mut session), Some(Elsewhere::Page(address)) if address.contains("manual")));
    session.wait_until(|session| has(session, "no browser opens"));
    choose(&mut session, "Help", "About Pliant");
    for fact in [env!("CARGO_PKG_VERSION"), "MIT OR Apache-2.0", "/issues"] {
        assert!(has(&session, fact), "{fact}");
    }
    click(&mut session, "Report a fault");
    assert!(matches!(last(&mut session), Some(Elsewhere::Page(address)) if address.ends_with("/issues")));
    session.key(Key::Escape, Modifiers::NONE);
    session.harness.run_steps(3);
    assert!(!has(&session, "MIT OR Apache-2.0"));
}

#[test]
fn the_sample_is_opened_from_the_menu_and_is_in_no_folder() {
    let folder = Folder::new();
    let file = ball(&folder);
    let Some(mut session) = Session::begin_in(Source::File(file), AppDirectories::default()) else {
        return;
    };
    choose(&mut session, "File", "New from sample");
    session.settle();
    assert_eq!(session.harness.state().editor().file_name(), "creature.glb");
    assert_eq!(session.harness.state().path(), None);
    choose(&mut session, "File", "Show in folder");
    assert!(session.harness.state().headline().unwrap().contains("save it first"));
}

#[test]
fn a_recent_file_has_a_small_picture_from_its_opening_on() {
    let folder = Folder::new();
    let file = ball(&folder);
    let places = AppDirectories {
        settings: Some(folder.at("settings.json")),
        pictures: Some(folder.at("pictures")),
        ..AppDirectories::default()
    };
    let Some(mut session) = Session::begin_in(Source::File(file.clone()), places.clone()) else {
        return;
    };
    let pictures = |folder: &Folder| {
        let entries = fs::read_dir(folder.at("pictures")).into_iter().flatten().flatten();
        let paths = entries.map(|entry| entry.path());
        let is_picture = |path: &PathBuf| path.extension().is_some_and(|ending| ending == "png");
        paths.filter(is_picture).collect::<Vec<_>>()
    };
    session.wait_until(|_| !pictures(&folder).is_empty());
    let place = pictures(&folder).remove(0);
    let picture = image::open(&place).unwrap().into_rgba8();
    assert_eq!(picture.dimensions(), (192, 144));
    let corner = *picture.get_pixel(3, 3);
    let middle = *picture.get_pixel(96, 72);
    assert_ne!(corner, middle, "the ball is in the middle");
    // Eleven more files push the first one out of the list, and its picture out of the folder.
    for number in 0..11 {
        let other = folder.write_mesh(&format!("{number}.off"), &pliant_mesh::shapes::icosphere(1));
        session.harness.state_mut().open(other);
        session.settle();
    }
    session.wait_until(|_| !place.exists() && pictures(&folder).len() <= 10);
    drop(session);
    let Some(mut session) = Session::begin_in(Source::Sample, places) else {
        return;
    };
    click(&mut session, "File");
    click(&mut session, "Open recent");
    assert!(has(&session, "10.off") && !has(&session, "ball.off"));
}

#[test]
fn menus_open_by_keys_and_the_arrows_go_through_them() {
    let Some(mut session) = Session::begin() else { return };
    session.key(Key::F10, Modifiers::NONE);
    session.harness.run_steps(3);
    assert!(has(&session, "Save model as…"), "F10 opens the first menu");
    session.key(Key::ArrowRight, Modifiers::NONE);
    session.harness.run_steps(4);
    assert!(has(&session, "Turn inside out"), "the arrow opens the next");
    assert!(!has(&session, "Save model as…"));
    session.key(Key::Escape, Modifiers::NONE);
    session.harness.run_steps(3);
    assert!(!has(&session, "Turn inside out"));
    session.key(Key::V, Modifiers::ALT);
    session.harness.run_steps(3);
    assert!(has(&session, "Frame all"));
    let before = session.harness.state().editor().view().camera_revision;
    session.harness.state_mut().command(Command::StepView([1, 0]));
    session.key(Key::ArrowDown, Modifiers::NONE);
    session.key(Key::Enter, Modifiers::NONE);
    session.harness.run_steps(3);
    assert!(
        session.harness.state().editor().view().camera_revision > before + 1,
        "the first command is done"
    );
    assert!(!has(&session, "Show everything"), "and the menu is closed");
}

#[test]
fn a_right_click_offers_what_fits_the_place() {
    let Some(mut session) = Session::with_handle() else {
        return;
    };
    let top = session.point_of(|positions| *positions.iter().max_by(|a, b| a.y.total_cmp(&b.y)).unwrap());
    right_click(&mut session, top + vec2(0.0, 8.0));
    assert!(has(&session, "Rename") && has(&session, "Delete handle"));
    click(&mut session, "Rename");
    let field = session
        .harness
        .get_by_role_and_label(Role::TextInput, "Name of the handle");
    field.focus();
    session.harness.run_steps(2);
    session.key(Key::A, Modifiers::COMMAND);
    session.harness.event(Event::Text("horn".to_owned()));
    session.harness.step();
    session.key(Key::Enter, Modifiers::NONE);
    session.harness.run_steps(3);
    assert_eq!(session.harness.state().editor().document().handles()[0].name, "horn");

    // A region that is painted beside it.
    session
        .harness
        .state_mut()
        .command(Command::SetTool(ToolMode::PaintFixed));
    let middle = session.harness.state().view_rect().center();
    session.stroke(middle, middle + vec2(6.0, 0.0));
    let fixed = |session: &Session| {
        let paint = session.harness.state().editor().document().paint().iter();
        paint.filter(|paint| **paint == Paint::Fixed).count()
    };
    let count = fixed(&session);
    assert!(count > 0);
    session.harness.state_mut().command(Command::SetTool(ToolMode::Select));
    right_click(&mut session, middle);
    assert!(has(&session, "Fixed part") && !has(&session, "Rename"));
    click(&mut session, "Clear this region");
    session.settle();
    assert_eq!(fixed(&session), 0);
    assert_eq!(
        session.harness.state().editor().view().tool,
        ToolMode::Select,
        "the tool stays"
    );

    // The bare surface: the command is for the clicked place, though the pointer is on the menu.
    right_click(&mut session, middle);
    assert!(!has(&session, "Fixed part"));
    click(&mut session, "Isolate part");
    session.settle();
    assert!(session.harness.state().editor().document().access().isolated.is_some());
}

#[test]
fn an_object_is_locked_from_the_palette_while_the_pointer_is_on_it() {
    let Some(mut session) = Session::begin() else { return };
    let middle = session.harness.state().view_rect().center();
    session.pointer(middle, None);
    session.palette("lock object");
    session.key(Key::Enter, Modifiers::NONE);
    session.settle();
    assert_eq!(session.harness.state().editor().document().access().locked.len(), 1);
}

#[test]
fn a_drag_ends_when_the_window_loses_the_focus_with_the_button_down() {
    let Some(mut session) = Session::begin() else { return };
    let middle = session.harness.state().view_rect().center();
    session.pointer(middle, None);
    session.pointer(middle, Some(true));
    session.pointer(middle + vec2(5.0, 0.0), None);
    // A stroke begins once the structure that finds what is under the pointer is there.
    session.wait_until(|session| session.harness.state().editor().is_acting());
    session.harness.event(Event::WindowFocused(false));
    session.harness.run_steps(3);
    assert!(!session.harness.state().editor().is_acting());
    session.harness.event(Event::WindowFocused(true));
    session.settle();
    let steps = session.harness.state().editor().history().names().1;
    session.pointer(middle + vec2(90.0, 40.0), None);
    session.settle();
    assert_eq!(
        session.harness.state().editor().history().names().1,
        steps,
        "moving paints nothing"
    );
}

#[test]
fn long_names_of_poses_end_before_their_buttons() {
    let Some(mut session) = Session::with_handle() else {
        return;
    };
    session.harness.state_mut().command(Command::KeepPose);
    let name = "the pose of a very tired dancer after the last performance of the season";
    session
        .harness
        .state_mut()
        .command(Command::RenamePose(0, name.to_owned()));
    session.harness.run_steps(4);
    let label = session.harness.get_by_label(name).rect();
    for verb in ["Apply", "Update", "Remove"] {
        let button = session.harness.get_by_label(&format!("{verb} {name}")).rect();
        assert!(label.right() <= button.left(), "{label:?} {verb} {button:?}");
        assert!(button.right() <= 1000.0);
    }
}

#[test]
fn undo_back_to_the_saved_state_is_saved() {
    let folder = Folder::new();
    let Some(mut session) = Session::with_handle() else {
        return;
    };
    session
        .harness
        .state_mut()
        .save_to(folder.at("saved.glb"), KeepOriginal::No);
    session.settle();
    let unsaved = |session: &Session| session.harness.state().editor().view().unsaved;
    assert!(!unsaved(&session));
    session
        .harness
        .state_mut()
        .command(Command::SetTool(ToolMode::PaintFixed));
    let middle = session.harness.state().view_rect().center();
    session.stroke(middle, middle + vec2(6.0, 0.0));
    assert!(unsaved(&session));
    session.key(Key::Z, Modifiers::COMMAND);
    session.settle();
    assert!(!unsaved(&session));
}

#[test]
fn a_double_click_on_a_number_replaces_all_of_it() {
    let Some(mut session) = Session::with_handle() else {
        return;
    };
    let id = session.harness.state().editor().view().selected.unwrap();
    let transform = HandleTransform::Trs {
        translation: DVec3::new(-0.125, 0.0, 0.0),
        rotation: DQuat::IDENTITY,
        scale: DVec3::ONE,
        pivot: None,
    };
    session
        .harness
        .state_mut()
        .command(Command::SetHandleTransform(id, transform));
    session.settle();
    let field = session.harness.get_all_by_label("Move");
    let mut fields = field.filter(|node| node.accesskit_node().role() == Role::SpinButton);
    // Beside the sign, where a word begins.
    let place = fields.next().unwrap().rect().center() + vec2(8.0, 0.0);
    drop(fields);
    session.pointer(place, None);
    // By the harness's own time its frames are too far apart for a double click.
    let clicks = [true, false, true, false].map(|pressed| Event::PointerButton {
        pos: place,
        button: PointerButton::Primary,
        pressed,
        modifiers: Modifiers::NONE,
    });
    session.harness.input_mut().events.extend(clicks);
    for frame in 0..12 {
        session.harness.input_mut().time = Some(1000.0 + 0.02 * f64::from(frame));
        session.harness.step();
    }
    session.harness.input_mut().time = None;
    session.harness.event(Event::Text("2".to_owned()));
    session.harness.step();
    session.key(Key::Enter, Modifiers::NONE);
    session.settle();
    assert_eq!(session.translation(), DVec3::new(2.0, 0.0, 0.0));
}

#[test]
fn keys_are_in_groups_and_found_by_name_or_key() {
    let Some(mut session) = Session::begin() else { return };
    session.palette("keys");
    session.key(Key::Enter, Modifiers::NONE);
    session.harness.run_steps(2);
    let has_row = |session: &Session, name: &str| {
        let label = format!("Key for {name}");
        session.harness.query_by_label(&label).is_some()
    };
    assert!(has(&session, "Edit") && has_row(&session, "Undo"));
    let search = |session: &mut Session, text: &str| {
        session
            .harness
            .get_by_role_and_label(Role::TextInput, "Search keys")
            .focus();
        session.harness.run_steps(2);
        session.key(Key::A, Modifiers::COMMAND);
        session.harness.event(Event::Text(text.to_owned()));
        session.harness.run_steps(2);
    };
    search(&mut session, "twin");
    assert!(has_row(&session, "Twin across x") && !has_row(&session, "Undo"));
    search(&mut session, "ctrl+z");
    assert!(has_row(&session, "Undo") && !has_row(&session, "Twin across x"));
    search(&mut session, "nothing at all");
    assert!(has(&session, "No command has this name or key."));
}

#[test]
fn the_status_line_never_overlaps_itself() {
    let folder = Folder::new();
    let Some(mut session) = Session::with_handle() else {
        return;
    };
    for size in [vec2(1280.0, 800.0), vec2(1024.0, 700.0), vec2(800.0, 600.0)] {
        session.harness.set_size(size);
        session.harness.run_steps(4);
        for is_saving in [false, true] {
            if is_saving {
                // A save that waits for the end of a stroke adds its sentence and two buttons.
                let middle = session.harness.state().view_rect().center();
                session.pointer(middle, None);
                session.pointer(middle, Some(true));
                session
                    .harness
                    .state_mut()
                    .save_to(folder.at("waiting.glb"), KeepOriginal::No);
                session.harness.run_steps(2);
            }
            let nodes = [Role::Label, Role::Button].into_iter();
            let nodes = nodes.flat_map(|role| session.harness.query_all_by_role(role));
            // The panel has rows below its end, which are hidden.
            let line = size.y - 26.0..=size.y;
            let in_line = nodes.filter(|node| line.contains(&node.rect().min.y) && line.contains(&node.rect().max.y));
            let mut places: Vec<(Rect, String)> = in_line
                .map(|node| (node.rect(), node.accesskit_node().label().unwrap_or_default()))
                .collect();
            assert!(!places.is_empty());
            places.sort_by(|a, b| a.0.min.x.total_cmp(&b.0.min.x));
            for pair in places.windows(2) {
                assert!(pair[0].0.max.x <= pair[1].0.min.x + 0.5, "{pair:?} in {size:?}");
            }
            assert!(
                places.iter().all(|(place, _)| place.max.x <= size.x),
                "{places:?} in {size:?}"
            );
            if is_saving {
                session.key(Key::Escape, Modifiers::NONE);
                let middle = session.harness.state().view_rect().center();
                session.pointer(middle, Some(false));
                session.settle();
            }
        }
    }
}

#[test]
fn a_work_pose_is_left_by_its_reminder() {
    let Some(mut session) = Session::with_handle() else {
        return;
    };
    let seen = session.shape();
    choose(&mut session, "Edit", "Work pose");
    assert!(session.harness.state().editor().document().is_in_work_pose());
    let id = session.harness.state().editor().view().selected.unwrap();
    let transform = HandleTransform::Trs {
        translation: DVec3::Y * 0.2,
        rotation: DQuat::IDENTITY,
        scale: DVec3::ONE,
        pivot: None,
    };
    session
        .harness
        .state_mut()
        .command(Command::SetHandleTransform(id, transform));
    session.settle();
    assert_ne!(session.shape(), seen);
    click(&mut session, "Return");
    session.settle();
    assert_eq!(session.shape(), seen);
    assert!(!has(&session, "Return"));
}
