//! The window's own dialog for files, by keys and pointer, for a system without one. Skipped by name if there is no
//! graphics device at all.

#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    reason = "tests fail by panicking and say what they skip"
)]

use std::ffi::OsStr;
use std::fs;
use std::time::{Duration, Instant};

use crate::window_rig::{Session, colour_at};
use egui::accesskit::Role;
use egui::{Event, Key, Modifiers, Rect, vec2};
use egui_kittest::kittest::{NodeT, Queryable};
use glam::DVec3;
use pliant_app::window::{AppDirectories, KeepOriginal, Source, original_name};
use pliant_editor::Command;
use pliant_mesh::DrawnVertex;
use pliant_tests::{Folder, run};

/// A folder with two balls, a note and a folder with a third ball, the first of which is open.
fn begin(folder: &Folder) -> Option<Session> {
    let ball = |name: &str, depth| folder.write_mesh(name, &pliant_mesh::shapes::icosphere(depth));
    fs::create_dir(folder.at("old")).unwrap();
    let first = ball("first.off", 2);
    ball("second.off", 3);
    ball("old/third.off", 1);
    folder.write("note.txt", "not a model");
    Session::begin_in(Source::File(first), AppDirectories::default())
}

/// The top of a ball is pulled up over its fixed lower half.
const TOP_EDIT: &str = r#"{
    "version": 1,
    "method": { "name": "bilaplacian" },
    "fixed": { "slab": { "axis": "z", "from": 0, "to": 0.3 } },
    "handles": [ {
        "name": "top",
        "select": { "slab": { "axis": "z", "from": 0.9, "to": 1 } },
        "transform": { "translation": [0, 0, 0.5] }
    } ]
}"#;

#[test]
fn a_file_is_opened_with_an_edit_and_saved_in_its_place() {
    let folder = Folder::new();
    let file = folder.write_mesh("ball.off", &pliant_mesh::shapes::icosphere(3));
    let edit = folder.write("ball.edit.json", TOP_EDIT);
    let source = Source::of(Some(file.clone()), Some(edit.clone()));
    let Some(mut session) = Session::begin_in(source, AppDirectories::default()) else {
        return;
    };
    let view = session.harness.state().editor().view();
    assert_eq!((view.handles.len(), &*view.handles[0].name), (1, "top"));
    let moved = view.displacements.iter().map(|way| way.z).fold(0.0, f64::max);
    assert!((moved - 0.5).abs() < 1e-12, "the edit is made: {moved}");

    // The same edit, chosen for the mesh that is already open.
    let Some(mut again) = Session::begin_in(Source::File(file.clone()), AppDirectories::default()) else {
        return;
    };
    assert!(again.harness.state().editor().view().handles.is_empty());
    again.harness.state_mut().ask_to_open(edit.clone());
    again.settle();
    let shape = again.harness.state().editor().view().displacements.to_vec();
    assert_eq!(shape, session.harness.state().editor().view().displacements.to_vec());
    drop(again);

    session.harness.state_mut().save_to(file.clone(), KeepOriginal::Yes);
    session.settle();
    let output = folder.at("applied.off");
    let (original, apply) = (original_name(&file), OsStr::new("apply"));
    let options = [
        "--edit".as_ref(),
        edit.as_os_str(),
        "--output".as_ref(),
        output.as_os_str(),
    ];
    run([apply, original.as_os_str()].into_iter().chain(options)).done();
    assert_eq!(fs::read(file).unwrap(), fs::read(output).unwrap());
}

#[test]
fn an_exported_edit_is_dropped_on_other_meshes_of_the_same_object() {
    let folder = Folder::new();
    let ball = pliant_mesh::shapes::icosphere(3);
    let count = ball.positions.len() as u32;
    // The same vertices from the last to the first.
    let mut permuted = ball.clone();
    permuted.positions.reverse();
    for vertex in permuted.triangles.iter_mut().flatten() {
        *vertex = DrawnVertex(count - 1 - vertex.0);
    }
    let own = folder.write_mesh("ball.off", &ball);
    let permuted = folder.write_mesh("permuted.off", &permuted);
    let finer = folder.write_mesh("finer.off", &pliant_mesh::shapes::icosphere(4));
    let edit = folder.write("top.json", TOP_EDIT);
    let exported = folder.at("exported.json");
    let mut shapes = Vec::new();
    for (file, edit) in [(own, &edit), (permuted, &exported), (finer, &exported)] {
        let Some(mut session) = Session::begin_in(Source::File(file), AppDirectories::default()) else {
            return;
        };
        session.drop_file(edit);
        if shapes.is_empty() {
            session.harness.state_mut().export_edit(&exported);
            session.settle();
        }
        let view = session.harness.state().editor().view();
        shapes.push((
            view.model.unwrap().surface.positions.to_vec(),
            view.displacements.to_vec(),
        ));
        let said = session.harness.state().headline().unwrap_or_default();
        assert_eq!(said.contains("finds 100% of `top`"), edit == &exported, "{said}");
    }
    let at = |(positions, displacements): &(Vec<DVec3>, Vec<DVec3>), p: DVec3| {
        let each = positions.iter().zip(displacements);
        let nearest = each.min_by(|a, b| a.0.distance(p).total_cmp(&b.0.distance(p)));
        nearest.map_or(DVec3::NAN, |(_, displacement)| *displacement)
    };
    for p in &shapes[0].0 {
        let [own, permuted, finer] = [0, 1, 2].map(|number| at(&shapes[number], *p));
        assert!(own.distance(permuted) < 1e-9, "{p}: {own}, {permuted}");
        assert!(own.distance(finer) < 0.05, "{p}: {own}, {finer}");
    }
}

#[test]
fn a_scan_that_is_inside_out_is_shown_and_saved_facing_outwards() {
    let folder = Folder::new();
    let outwards = pliant_mesh::shapes::icosphere(3);
    let mut inwards = outwards.clone();
    inwards.triangles.iter_mut().for_each(|triangle| triangle.swap(1, 2));
    let wanted = folder.write_mesh("outwards.off", &outwards);
    let file = folder.write_mesh("inwards.off", &inwards);
    let begin = |file| Session::begin_in(Source::File(file), AppDirectories::default());
    let Some(mut session) = begin(wanted) else { return };
    let view = session.harness.state().view_rect();
    // The middle of the view, without the panels' texts.
    let middle = |session: &mut Session| {
        let picture = session.harness.render().unwrap();
        let steps = (-8..=8).flat_map(|x| (-8..=8).map(move |y| vec2(5.0 * x as f32, 5.0 * y as f32)));
        let colours = steps.map(|step| colour_at(&picture, view.center() + step).0);
        colours.collect::<Vec<_>>()
    };
    let faces_outwards = middle(&mut session);
    drop(session);
    let mut session = begin(file.clone()).unwrap();
    assert_ne!(middle(&mut session), faces_outwards, "its inside is shown");
    session.harness.state_mut().command(Command::TurnInsideOut);
    session.settle();
    assert_eq!(middle(&mut session), faces_outwards);
    session.harness.state_mut().save_to(file.clone(), KeepOriginal::Yes);
    session.settle();
    let saved = pliant_tests::open(&file).model;
    assert!(saved.inside_out.is_empty());
    assert_eq!(saved.drawn_triangles(), outwards.triangles);
    assert_eq!(pliant_tests::open(&original_name(&file)).model.inside_out, [0]);
    session.harness.state_mut().command(Command::Undo);
    session.settle();
    assert_ne!(middle(&mut session), faces_outwards);
}

#[test]
fn an_edit_that_can_t_be_read_is_named_and_nothing_is_opened() {
    let folder = Folder::new();
    let file = folder.write_mesh("ball.off", &pliant_mesh::shapes::icosphere(2));
    let edit = folder.write("ball.edit.json", r#"{ "version": 1, "method": { "name": "arab" } }"#);
    let source = Source::of(Some(file), Some(edit));
    let Some(mut session) = Session::start(source, AppDirectories::default()) else {
        return;
    };
    let start = Instant::now();
    // The message, and the button that dismisses it.
    let is_named = |session: &Session| {
        session
            .harness
            .query_all_by_label_contains("ball.edit.json")
            .next()
            .is_some()
    };
    while !is_named(&session) {
        assert!(start.elapsed() < Duration::from_secs(60), "the edit is not named");
        std::thread::sleep(Duration::from_millis(5));
        session.harness.step();
    }
    assert!(session.harness.state().editor().view().model.is_none());
}

/// The place of an entry of the list.
fn row(session: &Session, name: &str) -> Option<Rect> {
    let row = session.harness.query_by_role_and_label(Role::ListBoxOption, name);
    row.map(|row| row.rect())
}

/// Runs frames until an entry is listed.
#[track_caller]
fn await_row(session: &mut Session, name: &str) {
    let start = Instant::now();
    while row(session, name).is_none() {
        assert!(start.elapsed() < Duration::from_secs(60), "{name} never comes");
        std::thread::sleep(Duration::from_millis(5));
        session.harness.step();
    }
}

fn has(session: &Session, label: &str) -> bool {
    session.harness.query_by_label(label).is_some()
}

fn type_text(session: &mut Session, text: &str) {
    session.harness.event(Event::Text(text.to_owned()));
    session.harness.run_steps(2);
}

/// The text of the field of this name.
fn text_of(session: &Session, name: &str) -> String {
    let mut fields = session.harness.get_all_by_label(name);
    let field = fields.find(|node| node.accesskit_node().role() == Role::TextInput);
    field.unwrap().value().unwrap_or_default()
}

fn click(session: &mut Session, label: &str) {
    session.harness.run_steps(2);
    let button = || session.harness.get_by_label(label).rect();
    let at = row(session, label).unwrap_or_else(button).center();
    for pressed in [true, false] {
        session.pointer(at, Some(pressed));
    }
    session.harness.run_steps(2);
}

#[test]
fn a_file_is_found_by_typing_by_arrows_and_by_pointer() {
    let folder = Folder::new();
    let Some(mut session) = begin(&folder) else { return };
    session.harness.state_mut().browse_to_open();
    await_row(&mut session, "second.off");
    let tops = ["old", "first.off", "second.off"].map(|name| row(&session, name).unwrap().top());
    assert!(tops.is_sorted(), "folders come first: {tops:?}");
    assert!(row(&session, "note.txt").is_none());

    // Letters filter, and Enter opens the result.
    type_text(&mut session, "sec");
    assert!(row(&session, "second.off").is_some() && row(&session, "first.off").is_none());
    session.key(Key::Enter, Modifiers::NONE);
    session.settle();
    assert_eq!(session.harness.state().path(), Some(&*folder.at("second.off")));

    // The first arrow chooses the first row, which is the folder.
    session.harness.state_mut().browse_to_open();
    await_row(&mut session, "old");
    session.key(Key::ArrowDown, Modifiers::NONE);
    session.key(Key::Enter, Modifiers::NONE);
    await_row(&mut session, "third.off");
    click(&mut session, "third.off");
    assert_eq!(
        session.harness.state().path(),
        Some(&*folder.at("second.off")),
        "one click chooses"
    );
    click(&mut session, "Open");
    session.settle();
    assert_eq!(session.harness.state().path(), Some(&*folder.at("old/third.off")));

    // Tab completes, and "up" leads out again.
    session.harness.state_mut().browse_to_open();
    await_row(&mut session, "third.off");
    session.key(Key::ArrowUp, Modifiers::ALT);
    await_row(&mut session, "second.off");
    type_text(&mut session, "ol");
    session.key(Key::Tab, Modifiers::NONE);
    await_row(&mut session, "third.off");
    let path = text_of(&session, "Path");
    assert!(path.ends_with(&format!("old{}", std::path::MAIN_SEPARATOR)), "{path}");
    // It moves to the next widget if there is nothing to complete.
    session.key(Key::Tab, Modifiers::NONE);
    assert_eq!(text_of(&session, "Path"), path);
    session.key(Key::Escape, Modifiers::NONE);
    assert!(row(&session, "third.off").is_none());
}

#[test]
fn a_click_on_a_columns_name_sorts_and_a_folder_that_is_gone_is_named() {
    let folder = Folder::new();
    let Some(mut session) = begin(&folder) else { return };
    session.harness.state_mut().browse_to_open();
    await_row(&mut session, "second.off");
    let order = |session: &Session| {
        let [first, second] = ["first.off", "second.off"].map(|name| row(session, name).unwrap().top());
        first < second
    };
    assert!(order(&session), "by name");
    click(&mut session, "Sort by name");
    assert!(!order(&session), "the other way round");
    click(&mut session, "Sort by size");
    assert!(order(&session), "the second has more faces");
    click(&mut session, "Sort by size");
    assert!(!order(&session));

    session.harness.get_by_label("Path").focus();
    session.key(Key::A, Modifiers::COMMAND);
    type_text(&mut session, "/no such place/scan");
    let start = Instant::now();
    while session
        .harness
        .query_by_label_contains("there is no such folder")
        .is_none()
    {
        assert!(start.elapsed() < Duration::from_secs(60), "nothing is said");
        session.harness.step();
    }
    session.key(Key::Enter, Modifiers::NONE);
    assert!(has(&session, "Cancel"), "it stays open");
}

#[test]
fn a_copy_is_saved_under_a_typed_name_and_a_file_in_its_place_is_asked_about_once() {
    let folder = Folder::new();
    let Some(mut session) = begin(&folder) else { return };
    session.harness.state_mut().browse_to_save();
    await_row(&mut session, "second.off");
    assert_eq!(text_of(&session, "Name"), "first.off");
    // The stem is selected: typing keeps the extension.
    type_text(&mut session, "copy");
    assert_eq!(text_of(&session, "Name"), "copy.off");
    session.key(Key::Enter, Modifiers::NONE);
    session.settle();
    let (first, copy) = (folder.at("first.off"), folder.at("copy.off"));
    assert_eq!(fs::read(&first).unwrap(), fs::read(&copy).unwrap(), "nothing was moved");
    assert_eq!(session.harness.state().path(), Some(&*copy));

    let second = fs::read(folder.at("second.off")).unwrap();
    session.harness.state_mut().browse_to_save();
    await_row(&mut session, "second.off");
    click(&mut session, "second.off");
    assert_eq!(text_of(&session, "Name"), "second.off");
    click(&mut session, "Save");
    assert!(has(&session, "Replace second.off?"));
    assert_eq!(fs::read(folder.at("second.off")).unwrap(), second);
    click(&mut session, "Replace");
    session.settle();
    assert!(!has(&session, "Replace second.off?"));
    assert_eq!(fs::read(folder.at("second.off")).unwrap(), fs::read(&first).unwrap());
}

#[test]
fn a_model_is_saved_in_the_format_that_is_chosen_beside_its_name() {
    let folder = Folder::new();
    let Some(mut session) = begin(&folder) else { return };
    session.harness.state_mut().browse_to_save();
    await_row(&mut session, "second.off");
    session.harness.get_by_role_and_label(Role::ComboBox, "Format").click();
    session.harness.run_steps(3);
    click(&mut session, "PLY (.ply)");
    assert_eq!(text_of(&session, "Name"), "first.ply");
    session.key(Key::Enter, Modifiers::NONE);
    session.settle();
    assert!(fs::read(folder.at("first.ply")).unwrap().starts_with(b"ply"));
}
