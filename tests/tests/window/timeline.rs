//! The timeline in the whole window: keys are set, dragged and undone, the moment is dragged along the ruler, ghosts are
//! drawn, and the animation is exported; skipped by name if there is no graphics device at all.
#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    reason = "tests fail by panicking and say what they skip"
)]

use crate::disk::{await_words, click, says};
use crate::window_rig::Session;
use egui::accesskit::Role;
use egui::{Key, Modifiers, Pos2};
use egui_kittest::kittest::Queryable;
use pliant_deform::Method;
use pliant_editor::{Beginning, Command, Document, KeyId};
use pliant_engine::{Animate, EditJob, ExistingFrames, MORPH_TOLERANCE, animate, files::Staging, memory, watch::Watch};
use pliant_tests::{Folder, assets};

fn document(session: &Session) -> &Document {
    session.harness.state().editor().document()
}

fn times(session: &Session) -> Vec<f64> {
    document(session)
        .animation()
        .keys()
        .iter()
        .map(|key| key.time)
        .collect()
}

fn command(session: &mut Session, command: Command) {
    session.harness.state_mut().command(command);
    session.settle();
}

/// The middle of a key's mark in the row of all handles.
fn mark(session: &Session, time: f64) -> Pos2 {
    let label = format!("Key of all at {time:.3} s");
    session
        .harness
        .get_by_role_and_label(Role::CheckBox, &label)
        .rect()
        .center()
}

/// A handle with keys at frames 0 and 12, of which the second is shown, in a window with the timeline.
fn keyed() -> Option<Session> {
    let mut session = Session::with_handle()?;
    command(
        &mut session,
        Command::SetMethod(Method::from_name("bilaplacian").unwrap()),
    );
    session.key(Key::T, Modifiers::NONE);
    session.settle();
    assert!(session.harness.state().editor().view().look.timeline);
    session.key(Key::I, Modifiers::NONE);
    command(&mut session, Command::GoToTime(0.5));
    for key in [Key::G, Key::Y, Key::Num1, Key::Enter] {
        session.key(key, Modifiers::NONE);
    }
    session.settle();
    session.key(Key::I, Modifiers::NONE);
    session.settle();
    assert_eq!(times(&session), [0.0, 0.5]);
    Some(session)
}

#[test]
fn keys_are_dragged_and_the_ruler_shows_the_moment_under_the_pointer() {
    let Some(mut session) = keyed() else { return };
    let (first, second) = (mark(&session, 0.0), mark(&session, 0.5));
    let half = second - first;
    // A drag along the ruler, above the rows, shows the surface on its way, and is one step.
    let up = session
        .harness
        .get_by_role_and_label(Role::Slider, "Shown moment")
        .rect()
        .center()
        .y;
    let on_ruler = |at: Pos2| egui::pos2(at.x, up);
    let steps = session.harness.state().editor().history().names().1;
    let end = session.shape();
    session.stroke(on_ruler(second), on_ruler(first + half * 0.5));
    assert_eq!(document(&session).animation().time(), 0.25);
    assert_eq!(session.harness.state().editor().history().names().1, steps + 1);
    assert!(session.shape() != end);
    let half_way = session.translation().y;
    assert!(half_way > 0.0 && half_way < 1.0, "{half_way}");
    // Twice as far along the rows is twice as late.
    session.stroke(second, second + half);
    assert_eq!(times(&session), [0.0, 1.0]);
    let selected = session.harness.state().editor().view().selected_keys;
    let handle = document(&session).handles()[0].id;
    assert!(selected.iter().eq([&KeyId::new(handle, 1.0)]));
    assert!(session.translation().y < half_way, "the surface follows its keys");
    session.key(Key::Z, Modifiers::COMMAND);
    session.settle();
    assert_eq!(times(&session), [0.0, 0.5]);
    assert_eq!(session.translation().y, half_way);
    // Delete belongs to the keys under the pointer, not to the handle.
    let beside = mark(&session, 0.5);
    session.pointer(beside, None);
    for pressed in [true, false] {
        session.pointer(beside, Some(pressed));
    }
    session.key(Key::Delete, Modifiers::NONE);
    session.settle();
    assert_eq!(times(&session), [0.0]);
    assert_eq!(document(&session).handles().len(), 1);
}

#[test]
fn ghosts_are_drawn_and_it_plays_until_it_is_paused() {
    let Some(mut session) = keyed() else { return };
    command(&mut session, Command::GoToTime(0.25));
    command(&mut session, Command::ToggleSkins);
    // Their jobs begin after the solve has ended.
    session.wait_until(|session| session.harness.state().editor().view().skins.len() == 2);
    session.key(Key::P, Modifiers::NONE);
    let mut seen = Vec::new();
    for _ in 0..400 {
        session.harness.step();
        let time = document(&session).animation().time();
        if seen.last() != Some(&time) {
            seen.push(time);
        }
        if seen.len() > 4 {
            break;
        }
        std::thread::sleep(std::time::Duration::from_millis(5));
    }
    assert!(seen.len() > 4, "it plays: {seen:?}");
    let fps = document(&session).animation().fps();
    let steps = seen.windows(2).map(|pair| (pair[1] - pair[0]) * fps);
    assert!(
        steps.into_iter().all(|step| (step - 1.0).abs() < 1e-9 || step < 0.0),
        "no frame is left out: {seen:?}"
    );
    session.key(Key::P, Modifiers::NONE);
    session.settle();
    assert_eq!(session.harness.state().editor().history().undo_name(), Some("Play"));
    // At rest nothing is drawn.
    std::thread::sleep(std::time::Duration::from_millis(400));
    session.harness.run_steps(8);
    let drawings = session.harness.state().drawings();
    session.harness.run_steps(20);
    assert_eq!(session.harness.state().drawings(), drawings);
}

#[test]
fn the_animation_is_exported_as_the_command_line_writes_it() {
    let Some(mut session) = keyed() else { return };
    command(&mut session, Command::SetFps(8.0));
    // The strength has a row and a key of its own.
    command(&mut session, Command::SetStrength(0.5));
    click(&mut session, "Key strength");
    session.settle();
    session
        .harness
        .get_by_role_and_label(Role::CheckBox, "Key of the strength, 50 %, at 0.500 s");
    let folder = Folder::new();
    let (cache, edit) = (
        folder.at("wave.pc2"),
        session.harness.state().editor().edit_file().unwrap(),
    );
    session.harness.state_mut().export_animation(&cache);
    session.settle();
    let said = session.harness.state().headline().unwrap_or_default().to_owned();
    assert!(said.starts_with("Saved"), "{said}");
    let bytes = std::fs::read(&cache).unwrap();
    assert_eq!(&bytes[..11], b"POINTCACHE2");
    let frames = u32::from_le_bytes(bytes[28..32].try_into().unwrap());
    assert_eq!(frames, 5);
    // The command line's file for the exported edit is the same to the byte.
    let mesh = assets().join("creature.glb");
    let (edit_path, written) = (folder.write("edit.json", edit.to_json()), folder.at("cli.pc2"));
    let beginning = Beginning::from(edit);
    let animation = Animate {
        job: EditJob {
            file: &mesh,
            edit: &beginning,
            edit_path: &edit_path,
            output: &written,
            report: None,
            weld: None,
            budget: memory::budget(),
        },
        name: "wave",
        tolerance: MORPH_TOLERANCE,
        fps: 8.0,
        frames: ExistingFrames::Keep,
    };
    animate(&animation, &Watch::default(), &Staging::default()).unwrap();
    assert!(std::fs::read(&written).unwrap() == bytes);
    // A refusal is a sentence and leaves nothing.
    let wrong = folder.at("wave.txt");
    session.harness.state_mut().export_animation(&wrong);
    session.settle();
    let said = session.harness.state().headline().unwrap_or_default().to_owned();
    assert!(said.contains(".txt"), "{said}");
    assert!(!wrong.exists());
    // A format with one shape in a file gets a file for each frame.
    session.harness.state_mut().export_animation(&folder.at("wave.stl"));
    session.settle();
    assert!(folder.at("wave-0000.stl").exists() && !folder.at("wave.stl").exists());
}

#[test]
fn numbered_files_replace_others_only_after_a_question() {
    let Some(mut session) = keyed() else { return };
    command(&mut session, Command::SetFps(2.0));
    let folder = Folder::new();
    let (frames, last) = (folder.at("wave-##.off"), folder.at("wave-01.off"));
    std::fs::write(&last, "somebody's").unwrap();
    for (answer, is_replaced) in [("Cancel", false), ("Replace", true)] {
        session.harness.state_mut().export_animation(&frames);
        await_words(&mut session, "Replace 1 file?");
        assert!(says(&session, "wave-01.off"));
        assert!(
            !folder.at("wave-00.off").exists(),
            "nothing is written before the answer"
        );
        click(&mut session, answer);
        session.settle();
        assert_eq!(std::fs::read(&last).unwrap() != b"somebody's", is_replaced, "{answer}");
        assert_eq!(folder.at("wave-00.off").exists(), is_replaced, "{answer}");
    }
}
