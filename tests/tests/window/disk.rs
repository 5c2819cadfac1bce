//! The window's knowledge of the files on disk: originals, strangers, other programs' writes, projects with their
//! meshes, and the times and contents of saves. Skipped by name if there is no graphics device at all.

#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    reason = "tests fail by panicking and say what they skip"
)]

use std::fs;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use crate::window_rig::Session;
use egui::{Key, Modifiers};
use egui_kittest::kittest::Queryable;
use pliant_app::window::{AppDirectories, KeepOriginal, Source, original_name};
use pliant_editor::Command;
use pliant_tests::{Folder, run};

pub(super) fn open(path: &Path) -> Option<Session> {
    Session::begin_in(Source::File(path.to_owned()), AppDirectories::default())
}

fn ball(folder: &Folder, name: &str, depth: u32) -> PathBuf {
    folder.write_mesh(name, &pliant_mesh::shapes::icosphere(depth))
}

/// A handle at the top, moved upwards.
pub(super) fn edit(session: &mut Session) {
    let top = session.point_of(|positions| *positions.iter().max_by(|a, b| a.y.total_cmp(&b.y)).unwrap());
    session.stroke(top + egui::vec2(0.0, 6.0), top + egui::vec2(0.0, 16.0));
    assert!(!session.harness.state().editor().document().handles().is_empty());
    move_up(session, ".2");
    session.settle();
}

/// Begins to move the selected handle upwards.
pub(super) fn move_up(session: &mut Session, length: &str) {
    session.key(Key::G, Modifiers::NONE);
    session.key(Key::Y, Modifiers::NONE);
    for digit in length.chars() {
        let key = match digit {
            '.' => Key::Period,
            digit => Key::from_name(&digit.to_string()).unwrap(),
        };
        session.key(key, Modifiers::NONE);
    }
    session.key(Key::Enter, Modifiers::NONE);
}

pub(super) fn save(session: &mut Session) {
    session.key(Key::S, Modifiers::COMMAND);
    session.harness.run_steps(2);
}

pub(super) fn says(session: &Session, words: &str) -> bool {
    session.harness.query_all_by_label_contains(words).next().is_some()
}

/// Runs frames until the window shows this text.
#[track_caller]
pub(super) fn await_words(session: &mut Session, words: &str) {
    let start = Instant::now();
    while !says(session, words) {
        assert!(start.elapsed() < Duration::from_secs(60), "{words:?} never comes");
        std::thread::sleep(Duration::from_millis(5));
        session.harness.step();
    }
}

pub(super) fn click(session: &mut Session, label: &str) {
    session.harness.run_steps(2);
    let at = session.harness.get_by_label(label).rect().center();
    for pressed in [true, false] {
        session.pointer(at, Some(pressed));
    }
    session.harness.run_steps(2);
}

#[test]
fn the_original_is_kept_beside_a_stranger_of_its_name_and_the_question_says_so() {
    let folder = Folder::new();
    let file = ball(&folder, "scan.off", 3);
    // This is another model's.
    let stranger = fs::read(ball(&folder, "scan.original.off", 1)).unwrap();
    let scan = fs::read(&file).unwrap();
    let Some(mut session) = open(&file) else { return };
    edit(&mut session);
    save(&mut session);
    await_words(&mut session, "kept beside it as scan.original-2.off");
    click(&mut session, "Save");
    session.settle();
    assert_ne!(fs::read(&file).unwrap(), scan);
    assert_eq!(fs::read(folder.at("scan.original.off")).unwrap(), stranger);
    assert_eq!(fs::read(folder.at("scan.original-2.off")).unwrap(), scan);
    // A project finds its mesh there.
    let project = folder.at("work.pliant");
    session.harness.state_mut().save_project_to(project.clone());
    session.settle();
    let shape = session.shape();
    drop(session);
    let again = open(&project).unwrap();
    assert_eq!(again.shape(), shape);
    assert_eq!(again.harness.state().path(), Some(&*file));
    // A file kept by its content is not kept twice.
    drop(again);
    fs::copy(folder.at("scan.original-2.off"), &file).unwrap();
    let mut session = open(&file).unwrap();
    edit(&mut session);
    save(&mut session);
    await_words(&mut session, "already kept as scan.original-2.off");
    click(&mut session, "Save");
    session.settle();
    assert!(!folder.at("scan.original-3.off").exists());
}

#[test]
fn saves_that_follow_each_other_at_once_keep_one_original() {
    let folder = Folder::new();
    let file = ball(&folder, "scan.off", 3);
    let scan = fs::read(&file).unwrap();
    let Some(mut session) = open(&file) else { return };
    edit(&mut session);
    let project = folder.at("work.pliant");
    let application = session.harness.state_mut();
    application.save_to(file.clone(), KeepOriginal::Yes);
    application.save_project_to(project.clone());
    application.save_to(file.clone(), KeepOriginal::No);
    session.settle();
    assert_eq!(fs::read(original_name(&file)).unwrap(), scan);
    assert_eq!(folder.names(), ["scan.off", "scan.original.off", "work.pliant"]);
    assert!(!session.harness.state().editor().view().unsaved);
    assert_eq!(open(&project).unwrap().shape(), session.shape());
}

#[test]
fn a_file_is_known_by_whatever_path_it_is_opened_and_saved() {
    let folder = Folder::new();
    let file = ball(&folder, "scan.off", 3);
    fs::create_dir(folder.at("sub")).unwrap();
    let scan = fs::read(&file).unwrap();
    let Some(mut session) = open(&folder.at("sub/../scan.off")) else {
        return;
    };
    edit(&mut session);
    session.harness.state_mut().browse_to_save();
    await_words(&mut session, "scan.off");
    session.harness.run_steps(4);
    session.key(Key::Enter, Modifiers::NONE);
    session.settle();
    assert_ne!(fs::read(&file).unwrap(), scan);
    assert_eq!(fs::read(original_name(&file)).unwrap(), scan);
}

#[test]
fn beside_a_changed_file_a_free_name_is_offered() {
    let folder = Folder::new();
    let file = ball(&folder, "scan.off", 3);
    ball(&folder, "scan-2.off", 1);
    let Some(mut session) = open(&file) else { return };
    edit(&mut session);
    let theirs = format!("{}# theirs\n", fs::read_to_string(&file).unwrap());
    fs::write(&file, &theirs).unwrap();
    save(&mut session);
    click(&mut session, "Save");
    await_words(&mut session, "scan.off has changed");
    click(&mut session, "Save beside…");
    // There is no dialog of the system here, so the window shows its own.
    await_words(&mut session, "Save the model as");
    await_words(&mut session, "scan-2.off");
    session.harness.run_steps(4);
    session.key(Key::Enter, Modifiers::NONE);
    session.settle();
    assert_eq!(fs::read_to_string(&file).unwrap(), theirs);
    let model = pliant_tests::open(&folder.at("scan-3.off")).model;
    assert!(model.rest_positions().iter().any(|p| p.y > 1.1));
}

#[test]
fn what_another_program_has_written_is_not_lost_without_a_question() {
    let folder = Folder::new();
    let file = ball(&folder, "scan.off", 3);
    let Some(mut session) = open(&file) else { return };
    edit(&mut session);
    for round in 0..2 {
        // Before the first save, and between two of them; only the content shows it.
        let theirs = format!("{}# round {round}\n", fs::read_to_string(&file).unwrap());
        fs::write(&file, &theirs).unwrap();
        move_up(&mut session, ".1");
        session.settle();
        save(&mut session);
        if round == 0 {
            click(&mut session, "Save");
        }
        await_words(&mut session, "scan.off has changed");
        assert_eq!(fs::read_to_string(&file).unwrap(), theirs);
        session.key(Key::Escape, Modifiers::NONE);
        session.settle();
        assert_eq!(fs::read_to_string(&file).unwrap(), theirs, "nothing was agreed to");
        assert!(session.harness.state().editor().view().unsaved);
        save(&mut session);
        if round == 0 {
            click(&mut session, "Save");
        }
        await_words(&mut session, "scan.off has changed");
        click(&mut session, "Overwrite");
        session.settle();
        assert_ne!(fs::read_to_string(&file).unwrap(), theirs);
        let kept = ["scan.original.off", "scan.original-2.off"][round];
        assert_eq!(
            fs::read_to_string(folder.at(kept)).unwrap(),
            theirs,
            "it stays beside it"
        );
        assert!(!session.harness.state().editor().view().unsaved);
    }
    // A new time alone is no change.
    fs::write(&file, fs::read(&file).unwrap()).unwrap();
    move_up(&mut session, ".1");
    session.settle();
    save(&mut session);
    session.settle();
    assert!(!session.harness.state().editor().view().unsaved);
}

#[test]
fn the_second_window_on_a_project_is_told_that_the_first_has_saved_it() {
    let folder = Folder::new();
    let file = ball(&folder, "scan.off", 3);
    let project = folder.at("work.pliant");
    let Some(mut session) = open(&file) else { return };
    edit(&mut session);
    session.harness.state_mut().save_project_to(project.clone());
    session.settle();
    let mut second = open(&project).unwrap();
    move_up(&mut session, ".1");
    session.settle();
    session.harness.state_mut().save_project_to(project.clone());
    session.settle();
    let first = fs::read(&project).unwrap();
    move_up(&mut second, ".3");
    second.settle();
    second.harness.state_mut().save_project_to(project.clone());
    await_words(&mut second, "work.pliant has changed");
    assert_eq!(fs::read(&project).unwrap(), first);
    assert!(second.harness.state().editor().view().unsaved);
}

#[test]
fn a_project_is_never_saved_without_the_mesh_that_it_needs() {
    let folder = Folder::new();
    let file = ball(&folder, "scan.off", 3);
    let Some(mut session) = open(&file) else { return };
    edit(&mut session);
    session.harness.state_mut().save_to(file.clone(), KeepOriginal::Yes);
    session.settle();
    // The mesh that was read no longer exists, and another one has the name under which it would be kept.
    fs::remove_file(original_name(&file)).unwrap();
    let stranger = fs::read(ball(&folder, "work.source.off", 1)).unwrap();
    let project = folder.at("work.pliant");
    for _ in 0..2 {
        session.harness.state_mut().save_project_to(project.clone());
        session.settle();
        assert!(!session.harness.state().editor().view().unsaved);
        assert_eq!(fs::read(folder.at("work.source.off")).unwrap(), stranger);
        let again = open(&project).unwrap();
        assert_eq!(again.shape(), session.shape());
        move_up(&mut session, ".1");
        session.settle();
    }
    assert!(!folder.at("work.source-3.off").exists(), "one copy is enough");
}

#[test]
fn a_save_waits_until_the_shape_has_settled() {
    let folder = Folder::new();
    let Some(mut session) = Session::with_handle() else {
        return;
    };
    let saved = folder.at("saved.glb");
    session.harness.state_mut().save_to(saved.clone(), KeepOriginal::No);
    session.settle();
    session.key(Key::R, Modifiers::NONE);
    session.key(Key::Y, Modifiers::NONE);
    for digit in "120".chars() {
        session.key(Key::from_name(&digit.to_string()).unwrap(), Modifiers::NONE);
    }
    // Before the solves of this move have ended, and in the middle of it.
    session.key(Key::S, Modifiers::COMMAND);
    let waiting = session.harness.state().waiting_save();
    assert!(waiting.is_some_and(|waiting| waiting.starts_with("saved.glb is saved once")));
    session.key(Key::Enter, Modifiers::NONE);
    session.settle();
    assert!(session.harness.state().waiting_save().is_none());
    assert!(!session.harness.state().editor().view().unsaved);
    let last = folder.at("last.glb");
    session.harness.state_mut().save_to(last.clone(), KeepOriginal::No);
    session.settle();
    assert_eq!(fs::read(&saved).unwrap(), fs::read(&last).unwrap());

    // A save without waiting has the shape of the moment, and later shapes are not saved.
    session.harness.state_mut().command(Command::Undo);
    session.settle();
    session.harness.state_mut().command(Command::Redo);
    session.settle();
    session.key(Key::R, Modifiers::NONE);
    session.key(Key::Num9, Modifiers::NONE);
    session.key(Key::S, Modifiers::COMMAND);
    await_words(&mut session, "Save now");
    click(&mut session, "Save now");
    session.key(Key::Enter, Modifiers::NONE);
    session.settle();
    assert!(session.harness.state().editor().view().unsaved);
}

#[test]
fn save_first_saves_the_project_that_is_open_and_then_goes_on() {
    let folder = Folder::new();
    let file = ball(&folder, "scan.off", 3);
    let other = ball(&folder, "other.off", 2);
    let project = folder.at("work.pliant");
    let Some(mut session) = open(&file) else { return };
    edit(&mut session);
    session.harness.state_mut().save_project_to(project.clone());
    session.settle();
    drop(session);
    let mesh = fs::read(&file).unwrap();
    let mut session = open(&project).unwrap();
    session.harness.state_mut().command(Command::KeepPose);
    move_up(&mut session, ".1");
    session.settle();
    // The model alone does not have all changes.
    let copy = folder.at("copy.off");
    session.harness.state_mut().save_to(copy.clone(), KeepOriginal::No);
    session.settle();
    assert!(copy.exists() && session.harness.state().editor().view().unsaved);
    let shape = session.shape();
    session.harness.state_mut().ask_to_open(other.clone());
    await_words(&mut session, "work.pliant does not have your last changes");
    session.harness.run_steps(2);
    session.key(Key::Enter, Modifiers::NONE);
    session.settle();
    assert_eq!(session.harness.state().path(), Some(&*other));
    assert_eq!(fs::read(&file).unwrap(), mesh);
    let again = open(&project).unwrap();
    assert_eq!(again.shape(), shape);
    assert_eq!(again.harness.state().editor().document().poses().len(), 1);
}

#[test]
fn a_file_that_was_changed_is_reloaded_with_the_edit_on_top() {
    for is_saved_before in [false, true] {
        let folder = Folder::new();
        let file = ball(&folder, "scan.off", 3);
        let Some(mut session) = open(&file) else { return };
        edit(&mut session);
        if is_saved_before {
            session.harness.state_mut().save_to(file.clone(), KeepOriginal::Yes);
            session.settle();
        }
        // Another program moves the whole mesh.
        let theirs = pliant_tests::open(&file).model.rest().positions.clone();
        let lifted: Vec<_> = theirs.iter().map(|p| *p + glam::DVec3::X).collect();
        let mut drawn = pliant_mesh::shapes::icosphere(3);
        drawn.positions = lifted.clone();
        folder.write_mesh("scan.off", &drawn);
        let whole = |session: &Session| {
            let view = session.harness.state().editor().view();
            // Welding has a different order in every shape.
            let mut positions = Vec::new();
            view.model.unwrap().drawn_positions(view.displacements, &mut positions);
            positions
        };
        let before = whole(&session);
        move_up(&mut session, ".1");
        session.settle();
        let moved = whole(&session);
        save(&mut session);
        if !is_saved_before {
            click(&mut session, "Save");
        }
        await_words(&mut session, "scan.off has changed");
        click(&mut session, "Reload with the edit");
        session.settle();
        let again = whole(&session);
        assert_eq!(session.harness.state().editor().document().handles().len(), 1);
        let apart = again
            .iter()
            .zip(&moved)
            .map(|(again, moved)| again.distance(*moved + glam::DVec3::X));
        let apart = apart.fold(0.0, f64::max);
        assert!(apart < 1e-3, "{is_saved_before}: {apart}");
        assert!(before.iter().zip(&moved).any(|(a, b)| a.distance(*b) > 0.05));
        assert!(session.harness.state().editor().view().unsaved);
        // It can also be saved over that file, which stays beside it.
        save(&mut session);
        click(&mut session, "Save");
        session.settle();
        assert!(!session.harness.state().editor().view().unsaved);
        let saved = pliant_tests::open(&file).model.rest().positions.clone();
        assert_eq!(saved.len(), again.len());
    }
}

/// A ball in two halves whose borders don't quite meet.
fn halved_ball() -> pliant_mesh::Drawn {
    let mut ball = pliant_mesh::shapes::icosphere(3);
    let vertices = ball.positions.len();
    let height = |triangle: &[pliant_mesh::DrawnVertex; 3]| {
        let of = |corner: &pliant_mesh::DrawnVertex| ball.positions[corner.index()].y;
        triangle.iter().map(of).sum::<f64>()
    };
    let upper: Vec<bool> = ball.triangles.iter().map(|triangle| height(triangle) > 0.0).collect();
    let raised: Vec<_> = ball.positions.iter().map(|p| *p + 0.005 * glam::DVec3::Y).collect();
    for (triangle, is_upper) in ball.triangles.iter_mut().zip(upper) {
        if is_upper {
            *triangle = triangle.map(|corner| pliant_mesh::DrawnVertex(corner.0 + vertices as u32));
        }
    }
    ball.positions.extend(raised);
    ball.file_vertex_count = ball.positions.len();
    ball.file_vertex = (0..ball.positions.len() as u32).map(pliant_mesh::FileVertex).collect();
    ball
}

#[test]
fn vertices_are_joined_as_the_panel_says_and_the_work_stays() {
    let folder = Folder::new();
    let file = folder.write_mesh("halves.off", &halved_ball());
    let Some(mut session) = open(&file) else { return };
    let parts = |session: &Session| {
        let model = session.harness.state().editor().view().model.unwrap();
        let used = model.topology.components().iter().filter(|part| part.vertex_count > 1);
        used.count()
    };
    assert_eq!(parts(&session), 2);
    edit(&mut session);
    session.page("Scene");
    let (handle, highest) = (session.translation(), highest(&session));
    for (choice, count) in [("within", 1), ("by mesh", 2), ("equal", 2), ("within", 1)] {
        session.harness.get_by_label(choice).click_accesskit();
        session.settle();
        assert_eq!(parts(&session), count, "{choice}");
        assert!(session.translation().distance(handle) < 1e-12, "{choice}");
        // The lower half's motion differs, the handle's place does not.
        assert!((self::highest(&session) - highest).abs() < 1e-9, "{choice}");
        assert!(session.harness.state().editor().view().unsaved, "{choice}");
    }
    // The shape is that of the command line for the edit.
    let edit = session.harness.state().editor().edit_file().unwrap().to_json();
    let edit = folder.write("halves.edit.json", &edit);
    session.harness.state_mut().save_to(file.clone(), KeepOriginal::Yes);
    session.settle();
    let (original, output) = (original_name(&file), folder.at("applied.off"));
    let [apply, of, to] = ["apply", "--edit", "--output"].map(std::ffi::OsStr::new);
    run([
        apply,
        original.as_os_str(),
        of,
        edit.as_os_str(),
        to,
        output.as_os_str(),
    ])
    .done();
    let [seen, applied] = [&file, &output].map(|path| pliant_tests::open(path).model.rest_positions());
    for (seen, applied) in seen.iter().zip(&applied) {
        assert!(seen.distance(*applied) < 1e-6, "{seen} beside {applied}");
    }
}

/// The height of the shape.
fn highest(session: &Session) -> f64 {
    let view = session.harness.state().editor().view();
    let rest = &view.model.unwrap().surface.positions;
    let seen = rest.iter().zip(view.displacements.iter()).map(|(p, d)| p.y + d.y);
    seen.fold(f64::NEG_INFINITY, f64::max)
}
