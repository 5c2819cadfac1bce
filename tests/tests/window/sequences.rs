//! A sequence in the whole window: its frames are shown by a drag along the ruler, a key spreads over a span whose end is
//! dragged, the frames are exported as the command line writes them, and a project brings everything back; skipped by
//! name if there is no graphics device at all.
#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    reason = "tests fail by panicking and say what they skip"
)]

use std::fmt::Write;
use std::path::Path;

use crate::window_rig::Session;
use egui::accesskit::Role;
use egui::{Key, Modifiers, Pos2, pos2};
use egui_kittest::kittest::Queryable;
use glam::{DQuat, DVec3};
use pliant_app::window::{AppDirectories, Source};
use pliant_deform::Method;
use pliant_editor::{Command, Document};
use pliant_mesh::shapes;
use pliant_tests::{Folder, largest_distance, open as open_mesh, run};

/// The number of frames.
const COUNT: usize = 12;

/// Writes the frames of a ball that turns and wanders, by a number of times the usual angle.
fn frames(folder: &Path, times: f64) {
    std::fs::create_dir(folder).unwrap();
    let ball = shapes::icosphere(2);
    for frame in 0..COUNT {
        let t = frame as f64 / COUNT as f64;
        let mut text = String::new();
        for position in &ball.positions {
            let p = DQuat::from_rotation_y(times * t) * *position * (1.0 + 0.05 * t * (5.0 * position.y).sin());
            let p = p + DVec3::new(0.3 * t, 0.0, 0.1 * t);
            writeln!(text, "v {} {} {}", p.x, p.y, p.z).unwrap();
        }
        for corners in &ball.triangles {
            let [a, b, c] = corners.map(|corner| corner.0 + 1);
            writeln!(text, "f {a} {b} {c}").unwrap();
        }
        std::fs::write(folder.join(format!("ball-{frame}.obj")), text).unwrap();
    }
}

fn open(path: &Path) -> Option<Session> {
    Session::begin_in(Source::of(Some(path.to_owned()), None), AppDirectories::default())
}

fn document(session: &Session) -> &Document {
    session.harness.state().editor().document()
}

/// The drawn vertices of the shown shape.
fn shown(session: &Session) -> Vec<DVec3> {
    let view = session.harness.state().editor().view();
    let mut shown = Vec::new();
    view.model.unwrap().drawn_positions(view.displacements, &mut shown);
    shown
}

fn command(session: &mut Session, command: Command) {
    session.harness.state_mut().command(command);
    session.settle();
}

/// The place of a frame on the ruler, as the key at `key` shows it.
fn on_ruler(session: &Session, frame: usize) -> Pos2 {
    let ruler = session
        .harness
        .get_by_role_and_label(Role::Slider, "Shown moment")
        .rect();
    let last = (COUNT - 1) as f32;
    // Some room on both sides, as for all frames.
    let share = (frame as f32 / last + 0.03) / 1.11;
    pos2(ruler.left() + share * ruler.width(), ruler.center().y)
}

/// The middle of the grip at the last frame of the only span.
fn end_of_span(session: &Session) -> Pos2 {
    let label = "Last frame that a key of handle 1 reaches";
    session
        .harness
        .get_by_role_and_label(Role::Slider, label)
        .rect()
        .center()
}

/// The names and the bytes of the files of a folder.
fn bytes(folder: &Path) -> Vec<(String, Vec<u8>)> {
    let entries = std::fs::read_dir(folder).unwrap().map(Result::unwrap);
    let read = |entry: std::fs::DirEntry| {
        let name = entry.file_name().to_string_lossy().into_owned();
        (name, std::fs::read(entry.path()).unwrap())
    };
    let mut files: Vec<_> = entries.map(read).collect();
    files.sort();
    files
}

/// Edits the sequence by the command line.
fn by_command(sequence: &Path, edit: &Path, output: &Path) {
    let [sequence, edit, output] = [sequence, edit, output].map(|path| path.to_str().unwrap());
    let words = ["sequence", sequence, "--edit", edit, "--output", output];
    assert_eq!(run(words).status, 0);
}

#[test]
fn frames_are_scrubbed_keyed_exported_and_kept_in_a_project() {
    let folder = Folder::new();
    let walk = folder.at("walk");
    frames(&walk, 1.0);
    let before = bytes(&walk);
    let Some(mut session) = open(&walk) else { return };
    command(
        &mut session,
        Command::SetMethod(Method::from_name("bilaplacian").unwrap()),
    );
    let top = session.point_of(|positions| *positions.iter().max_by(|a, b| a.y.total_cmp(&b.y)).unwrap());
    session.stroke(top + egui::vec2(0.0, 6.0), top + egui::vec2(0.0, 16.0));
    let own_first = session.shape();
    session.stroke(on_ruler(&session, 0), on_ruler(&session, 6));
    assert_eq!(document(&session).animation().frame(), 6);
    let own = session.shape();
    assert!(own != own_first);
    for key in [Key::G, Key::Y, Key::Num1, Key::Enter] {
        session.key(key, Modifiers::NONE);
    }
    session.settle();
    session.key(Key::I, Modifiers::NONE);
    session.settle();
    let handle = document(&session).handles()[0].id;
    let span = |session: &Session| document(session).animation().keys()[0].span(handle);
    assert_eq!(span(&session), Some([0, COUNT - 1]));
    let lifted = session.shape();
    // The end of the span is dragged from the last frame to the ninth.
    let (end, to) = (end_of_span(&session), on_ruler(&session, 9));
    session.stroke(end, pos2(to.x, end.y));
    assert_eq!(span(&session), Some([0, 9]));
    assert_eq!(session.shape(), lifted);
    command(&mut session, Command::GoToTime(10.0 / 24.0));
    assert_eq!(document(&session).handles()[0].affine().translation, DVec3::ZERO);
    command(&mut session, Command::GoToTime(8.0 / 24.0));
    let eighth = session.shape();
    // The command line's files for the exported edit are the same to the byte.
    let edit = session.harness.state().editor().edit_file().unwrap();
    let edit = folder.write("edit.json", edit.to_json());
    let [own, theirs] = ["own", "theirs"].map(|name| folder.at(name));
    session.harness.state_mut().export_frames(&own);
    session.settle();
    let said = session.harness.state().headline().unwrap_or_default().to_owned();
    assert!(said.starts_with("Saved"), "{said}");
    by_command(&walk, &edit, &theirs);
    let exported = bytes(&own);
    assert!(exported == bytes(&theirs));
    let is_same = |frame: usize| {
        exported.iter().find(|(name, _)| *name == format!("ball-{frame}.obj"))
            == before.iter().find(|(name, _)| *name == format!("ball-{frame}.obj"))
    };
    assert!(is_same(11) && is_same(10) && !is_same(8) && !is_same(6));
    // The frame that was shown is the one that was written.
    let written = open_mesh(&own.join("ball-8.obj")).model.rest_positions();
    let shown = shown(&session);
    let away = largest_distance(&written, &shown);
    assert!(away < 1e-9, "{away}");
    // The path of the body: all frames are followed by a job, and the command line's files are again the same.
    command(&mut session, Command::TogglePath);
    assert!(!session.harness.state().editor().view().wants_following);
    let way = DVec3::new(0.5, 0.0, -0.25);
    command(&mut session, Command::BendPath(8, way));
    let edit = session.harness.state().editor().edit_file().unwrap();
    let edit = folder.write("bent.json", edit.to_json());
    let [bent, theirs] = ["bent", "their-bent"].map(|name| folder.at(name));
    session.harness.state_mut().export_frames(&bent);
    session.settle();
    by_command(&walk, &edit, &theirs);
    assert!(bytes(&bent) == bytes(&theirs));
    // The frame that is shown is carried to where it was written.
    let written = open_mesh(&bent.join("ball-8.obj")).model.rest_positions();
    let motion = session.harness.state().editor().view().body_motion;
    let carried: Vec<DVec3> = shown.iter().map(|place| motion.moved(*place)).collect();
    let away = largest_distance(&written, &carried);
    assert!(motion.moves() && away < 1e-9, "{away}");
    // Nothing is lost in a folder that has something in it.
    session.harness.state_mut().export_frames(&own);
    session.settle();
    let said = session.harness.state().headline().unwrap_or_default().to_owned();
    assert!(said.contains("not empty"), "{said}");
    // A project names the sequence, relative to itself.
    let project = folder.at("lift.pliant");
    session.harness.state_mut().save_project_to(project.clone());
    session.settle();
    assert!(
        std::fs::read_to_string(&project)
            .unwrap()
            .contains("\"sequence\": \"walk\"")
    );
    let keys = document(&session).animation().clone();
    drop(session);
    let mut session = open(&project).unwrap();
    assert_eq!(*document(&session).animation(), keys);
    assert_eq!(document(&session).animation().frames(), Some(COUNT));
    session.settle();
    assert!(largest_distance(&session.shape(), &eighth) < 1e-12);
    assert!(!session.harness.state().editor().view().unsaved);
    assert!(bytes(&walk) == before, "no frame was written over");
}

#[test]
fn another_sequence_leads_a_handle_live_in_the_export_and_in_a_project() {
    let folder = Folder::new();
    let [walk, run] = ["walk", "run"].map(|name| folder.at(name));
    frames(&walk, 1.0);
    frames(&run, 2.0);
    let Some(mut session) = open(&walk) else { return };
    command(
        &mut session,
        Command::SetMethod(Method::from_name("bilaplacian").unwrap()),
    );
    let top = session.point_of(|positions| *positions.iter().max_by(|a, b| a.y.total_cmp(&b.y)).unwrap());
    session.stroke(top + egui::vec2(0.0, 6.0), top + egui::vec2(0.0, 16.0));
    command(&mut session, Command::GoToTime(6.0 / 24.0));
    let own = session.shape();
    // A sequence with another number of frames is refused, and changes nothing.
    let short = folder.at("short");
    frames(&short, 2.0);
    std::fs::remove_file(short.join("ball-0.obj")).unwrap();
    session.harness.state_mut().mix_with(&short.join("ball-3.obj"));
    session.settle();
    let said = session.harness.state().headline().unwrap_or_default().to_owned();
    assert!(said.contains("has 11 frames") && said.contains("has 12"), "{said}");
    assert_eq!(document(&session).animation().mix(), None);
    session.harness.state_mut().mix_with(&run.join("ball-3.obj"));
    session.settle();
    let led = session.shape();
    let mix = (**document(&session).animation().mix().unwrap()).clone();
    assert!(mix.leads(document(&session).handles()[0].id));
    command(
        &mut session,
        Command::SetMix(Some(pliant_editor::HandleMix { share: 0.5, ..mix })),
    );
    let half = session.shape();
    assert!(largest_distance(&led, &own) > 1.5 * largest_distance(&half, &own));
    // The command line's files for the exported edit are the same to the byte, and the shown frame is the written one.
    let edit = session.harness.state().editor().edit_file().unwrap();
    let edit = folder.write("edit.json", edit.to_json());
    let [ours, theirs] = ["ours", "theirs"].map(|name| folder.at(name));
    session.harness.state_mut().export_frames(&ours);
    session.settle();
    by_command(&walk, &edit, &theirs);
    assert!(bytes(&ours) == bytes(&theirs));
    let written = open_mesh(&ours.join("ball-6.obj")).model.rest_positions();
    let away = largest_distance(&written, &shown(&session));
    assert!(away < 1e-9, "{away}");
    // A project names the other sequence, relative to itself, and says so if it is gone.
    let project = folder.at("led.pliant");
    session.harness.state_mut().save_project_to(project.clone());
    session.settle();
    let text = std::fs::read_to_string(&project).unwrap();
    assert!(text.contains("\"sequence\": \"run\""), "{text}");
    let animation = document(&session).animation().clone();
    drop(session);
    let mut session = open(&project).unwrap();
    session.settle();
    assert_eq!(*document(&session).animation(), animation);
    assert!(largest_distance(&session.shape(), &half) < 1e-12);
    drop(session);
    std::fs::rename(&run, folder.at("elsewhere")).unwrap();
    let mut session = open(&project).unwrap();
    session.settle();
    let problem = session.harness.state().editor().view().problem.map(str::to_owned);
    assert!(problem.is_some_and(|problem| problem.contains("run")));
}
