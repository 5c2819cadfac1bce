//! Holes are filled in the window: the result is the command line's, one step of the history, kept by a project, and
//! saved beside the original. Skipped by name if there is no graphics device at all.

#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    reason = "tests fail by panicking and say what they skip"
)]

use std::collections::BTreeSet;
use std::f64::consts::PI;
use std::ffi::{OsStr, OsString};
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use crate::bending::{differences, picture};
use crate::window_rig::Session;
use egui::{Key, Modifiers, vec2};
use glam::{DAffine3, DQuat, DVec3};
use pliant_app::window::{AppDirectories, KeepOriginal, Source, original_name};
use pliant_editor::{
    Command, CutCurve, CutPlane, CutSight, HandleTransform, KeptSide, MergeSettings, MeshChange, Paint, Placement,
};
use pliant_mesh::{Drawn, DrawnVertex, Model, SurfaceVertex, shapes};
use pliant_tests::{Folder, bare_edit, open, run};

/// A ball with a hole at its side.
fn bowl() -> Drawn {
    let mut ball = shapes::icosphere(4);
    let at = ball.positions.clone();
    ball.triangles
        .retain(|corners| corners.iter().any(|corner| at[corner.index()].x < 0.8));
    ball
}

/// The bowl as a file of this format.
fn bowl_file(folder: &Folder, format: &str) -> PathBuf {
    let off = folder.write_mesh("bowl.off", &bowl());
    let file = folder.at(&format!("bowl.{format}"));
    if format != "off" {
        folder.apply(&off, &bare_edit(), &file, &[]).done();
    }
    file
}

fn begin(file: &Path) -> Option<Session> {
    Session::begin_in(Source::File(file.to_owned()), AppDirectories::default())
}

fn model(session: &Session) -> Arc<Model> {
    Arc::clone(session.harness.state().editor().view().model.unwrap())
}

fn holes(session: &Session) -> usize {
    model(session).topology.boundary_loops().len()
}

fn command(session: &mut Session, command: Command) {
    session.harness.state_mut().command(command);
    session.settle();
}

#[test]
fn a_filled_shape_is_the_command_lines_and_undo_and_redo_change_the_picture() {
    for format in ["off", "obj", "ply", "stl", "glb", "gltf", "3mf", "usdz"] {
        let folder = Folder::new();
        let file = bowl_file(&folder, format);
        let Some(mut session) = begin(&file) else { return };
        let (original, bytes) = (model(&session), fs::read(&file).unwrap());
        command(&mut session, Command::FillHoles);
        assert_eq!(holes(&session), 0, "{format}");
        let state = session.harness.state();
        let headline = state.headline().unwrap_or_default();
        assert!(headline.starts_with("Filled 1 hole with "), "{format}: {headline}");
        assert!(state.editor().view().unsaved, "{format}");
        assert_eq!(fs::read(&file).unwrap(), bytes, "{format}: the file stays");

        command(&mut session, Command::Undo);
        assert!(Arc::ptr_eq(&model(&session), &original), "{format}");
        assert!(!session.harness.state().editor().view().unsaved, "{format}");
        command(&mut session, Command::Redo);
        assert_eq!(holes(&session), 0, "{format}");

        let (saved, by_command) = (
            folder.at(&format!("saved.{format}")),
            folder.at(&format!("cli.{format}")),
        );
        session.harness.state_mut().save_to(saved.clone(), KeepOriginal::No);
        session.settle();
        let words = [
            OsStr::new("fill"),
            file.as_os_str(),
            "--output".as_ref(),
            by_command.as_os_str(),
        ];
        run(words).done();
        let [ours, theirs] = [&saved, &by_command].map(|path| open(path).model);
        assert_eq!(ours.drawn_triangles(), theirs.drawn_triangles(), "{format}");
        assert_eq!(ours.rest_positions(), theirs.rest_positions(), "{format}");
        if format != "gltf" {
            assert_eq!(fs::read(&saved).unwrap(), fs::read(&by_command).unwrap(), "{format}");
        }
    }
}

#[test]
fn undoing_a_change_of_the_mesh_shows_the_former_picture_with_its_bend_and_regions() {
    let folder = Folder::new();
    let Some(mut session) = begin(&bowl_file(&folder, "off")) else {
        return;
    };
    let top = session.point_of(|positions| *positions.iter().max_by(|a, b| a.z.total_cmp(&b.z)).unwrap());
    session.stroke(top + vec2(0.0, 6.0), top + vec2(0.0, 16.0));
    for key in [Key::G, Key::Z, Key::Num0, Key::Period, Key::Num5, Key::Enter] {
        session.key(key, Modifiers::NONE);
    }
    let before = picture(&mut session);
    command(&mut session, Command::FillHoles);
    command(&mut session, Command::ClearRegions);
    let after = picture(&mut session);
    assert!(differences(&session, &before, &after) > 500, "the regions are gone");
    for _ in 0..2 {
        command(&mut session, Command::Undo);
        command(&mut session, Command::Undo);
        let undone = picture(&mut session);
        assert_eq!(differences(&session, &before, &undone), 0);
        command(&mut session, Command::Redo);
        command(&mut session, Command::Redo);
    }
    let redone = picture(&mut session);
    assert_eq!(differences(&session, &after, &redone), 0);
}

#[test]
fn a_filled_bent_shape_keeps_its_handle_in_the_project_and_is_saved_beside_its_original() {
    let folder = Folder::new();
    let file = bowl_file(&folder, "ply");
    let bytes = fs::read(&file).unwrap();
    let Some(mut session) = begin(&file) else { return };
    let top = session.point_of(|positions| *positions.iter().max_by(|a, b| a.z.total_cmp(&b.z)).unwrap());
    session.stroke(top + vec2(0.0, 6.0), top + vec2(0.0, 16.0));
    for key in [Key::G, Key::Z, Key::Num0, Key::Period, Key::Num2, Key::Enter] {
        session.key(key, Modifiers::NONE);
    }
    session.settle();
    command(&mut session, Command::FillHoles);
    assert_eq!(holes(&session), 0);
    let hash = |session: &Session| session.harness.state().editor().document_hash().unwrap();
    let document = hash(&session);
    assert_eq!(session.harness.state().editor().document().handles().len(), 1);

    let project = folder.at("bowl.pliant");
    session.harness.state_mut().save_project_to(project.clone());
    session.settle();
    let again = begin(&project).unwrap();
    assert_eq!(
        hash(&again),
        document,
        "the project opens with the same document on the same mesh"
    );
    assert_eq!(holes(&again), 0);
    drop(again);

    session.harness.state_mut().save_to(file.clone(), KeepOriginal::Yes);
    session.settle();
    assert_eq!(
        fs::read(original_name(&file)).unwrap(),
        bytes,
        "the original is beside it"
    );
    let saved = open(&file).model;
    assert!(saved.topology.boundary_loops().is_empty());
    assert_eq!(saved.rest_positions(), model(&session).rest_positions());

    // The former mesh comes back and bends on.
    command(&mut session, Command::Undo);
    assert_eq!(holes(&session), 1);
    assert!(
        session.harness.state().editor().view().unsaved,
        "the file has the other shape now"
    );
    for key in [Key::G, Key::Z, Key::Num0, Key::Period, Key::Num1, Key::Enter] {
        session.key(key, Modifiers::NONE);
    }
    session.settle();
    let other = folder.at("open.ply");
    session.harness.state_mut().save_to(other.clone(), KeepOriginal::No);
    session.settle();
    assert_eq!(open(&other).model.topology.boundary_loops().len(), 1);
}

#[test]
fn a_shape_without_a_hole_is_refused_in_the_engines_words_and_the_view_goes_to_the_place() {
    for (shape, has_place) in [(shapes::icosphere(3), false), (shapes::grid(9, 9), true)] {
        let folder = Folder::new();
        let file = folder.write_mesh("shape.off", &shape);
        let refused = run([
            OsStr::new("fill"),
            file.as_os_str(),
            "--output".as_ref(),
            folder.at("out.off").as_os_str(),
        ]);
        let Some(mut session) = begin(&file) else { return };
        let before = model(&session);
        let camera = *session.harness.state().editor().view().camera;
        command(&mut session, Command::FillHoles);
        let view = session.harness.state().editor().view();
        let problem = view.problem.unwrap_or_default().to_owned();
        assert!(
            !problem.is_empty() && refused.err.contains(&problem),
            "{problem} / {}",
            refused.err
        );
        assert!(Arc::ptr_eq(&model(&session), &before));
        let place = problem.split_once("at vertex ").map(|(_, rest)| rest);
        assert_eq!(place.is_some(), has_place, "{problem}");
        let Some(place) = place else {
            assert_eq!(*view.camera, camera);
            continue;
        };
        let vertex: usize = place.split(' ').next().unwrap().parse().unwrap();
        let seen = view.camera.project(shape.positions[vertex], view.viewport_px).unwrap();
        let off = (seen / view.viewport_px - 0.5).abs().max_element();
        assert!(off < 0.1 && view.camera.distance < 0.5 * camera.distance, "{off}");
    }
}

#[test]
fn cuts_and_bridges_are_the_command_lines_to_the_byte() {
    let folder = Folder::new();
    let lid = shapes::moved(&bowl(), DAffine3::from_axis_angle(DVec3::Y, PI));
    let lid = shapes::moved(&lid, DAffine3::from_translation(DVec3::X * 3.0));
    let file = folder.write_mesh("two.off", &shapes::together(&[bowl(), lid]));
    let Some(mut session) = begin(&file) else { return };
    let model = model(&session);
    let rims = model.topology.boundary_loops();
    let number = |vertex| model.first_file_vertex(vertex).0.to_string();
    let ends = [rims[0][0], rims[1][0]];
    let deleted = [3, 40, 41, 500].map(SurfaceVertex);
    let selector = folder.write(
        "delete.json",
        format!("{{\"vertices\": [{}]}}", deleted.map(number).join(", ")),
    );
    let plane = CutPlane {
        normal: DVec3::new(0.3, 1.0, -0.2),
        distance: 0.25,
    };
    let ring = [
        [0.4, 0.1, -0.9],
        [-0.1, 0.45, -0.9],
        [-0.4, -0.1, -0.9],
        [0.1, -0.4, -0.9],
    ];
    let ring_file = folder.write(
        "ring.json",
        format!("{{\"version\": 1, \"points\": {ring:?}, \"closed\": true}}"),
    );
    let ring = CutCurve {
        points: ring.map(DVec3::from_array).to_vec(),
        is_closed: true,
        sight: CutSight::Normals,
    };
    let words = |words: &[&str]| words.iter().map(|word| OsString::from(*word)).collect::<Vec<_>>();
    let cut = |side, keep| {
        let command = words(&["cut", "--plane", "0.3,1,-0.2,0.25", "--keep", keep]);
        (MeshChange::Cut(plane, side, Vec::new()), command)
    };
    let cases = [
        cut(KeptSide::Positive, "positive"),
        cut(KeptSide::Negative, "negative"),
        cut(KeptSide::Both, "both"),
        (MeshChange::CutAlong(ring, KeptSide::Negative, Vec::new()), {
            let mut command = words(&["cut", "--keep", "negative", "--curve"]);
            command.push(ring_file.into_os_string());
            command
        }),
        (
            MeshChange::Bridge(ends),
            words(&["bridge", "--borders", &number(ends[0]), &number(ends[1])]),
        ),
        (
            MeshChange::Delete(deleted.to_vec()),
            vec!["cut".into(), "--delete".into(), selector.into_os_string()],
        ),
    ];
    for (number, (change, mut arguments)) in cases.into_iter().enumerate() {
        let case = format!("{change:?}");
        let (saved, by_command) = (
            folder.at(&format!("saved-{number}.off")),
            folder.at(&format!("cli-{number}.off")),
        );
        command(&mut session, Command::ChangeMesh(change));
        let problem = session.harness.state().editor().view().problem;
        assert_eq!(problem, None, "{case}");
        session.harness.state_mut().save_to(saved.clone(), KeepOriginal::No);
        session.settle();
        arguments.splice(1..1, [file.clone().into_os_string()]);
        arguments.extend(["--output".into(), by_command.clone().into_os_string()]);
        run(arguments).done();
        assert_eq!(fs::read(&saved).unwrap(), fs::read(&by_command).unwrap(), "{case}");
        command(&mut session, Command::Undo);
    }
    // A plane that misses is refused in the engine's words.
    let beside = CutPlane {
        normal: DVec3::Y,
        distance: 9.0,
    };
    command(
        &mut session,
        Command::ChangeMesh(MeshChange::Cut(beside, KeptSide::Both, Vec::new())),
    );
    let problem = session
        .harness
        .state()
        .editor()
        .view()
        .problem
        .unwrap_or_default()
        .to_owned();
    let out = folder.at("none.off");
    let arguments = words(&[
        "cut",
        &file.to_string_lossy(),
        "--plane",
        "0,1,0,9",
        "--output",
        &out.to_string_lossy(),
    ]);
    let refused = run(arguments).err;
    assert!(
        !problem.is_empty() && refused.contains(&problem),
        "{problem} / {refused}"
    );
}

/// A ball, cut in two by a wavy line: the halves of one surface, as two files.
fn halves(folder: &Folder) -> [PathBuf; 2] {
    let ball = shapes::icosphere(4);
    let at = ball.positions.clone();
    let is_left = |corners: &&[DrawnVertex; 3]| {
        let middle: DVec3 = corners.iter().map(|corner| at[corner.index()]).sum::<DVec3>() / 3.0;
        middle.x < 0.13 * (3.0 * middle.y).sin()
    };
    [true, false].map(|left| {
        let mut half = ball.clone();
        half.triangles.retain(|corners| is_left(&corners) == left);
        folder.write_mesh(if left { "left.off" } else { "right.off" }, &used(&half))
    })
}

/// The same without unused vertices.
fn used(shape: &Drawn) -> Drawn {
    let is_used: BTreeSet<u32> = shape.triangles.iter().flatten().map(|corner| corner.0).collect();
    let numbers: Vec<u32> = is_used.into_iter().collect();
    let place = |old: DrawnVertex| DrawnVertex(numbers.binary_search(&old.0).unwrap() as u32);
    Drawn {
        positions: numbers.iter().map(|&old| shape.positions[old as usize]).collect(),
        triangles: shape.triangles.iter().map(|corners| corners.map(place)).collect(),
        ..Drawn::default()
    }
}

fn append(session: &mut Session, file: &Path) {
    session.harness.state_mut().append(file.to_owned());
    session.settle();
    assert_eq!(session.harness.state().editor().view().problem, None);
}

#[test]
fn two_halves_are_appended_and_merged_to_the_shape_that_they_were_cut_from() {
    let folder = Folder::new();
    let [left, right] = halves(&folder);
    let ball = shapes::icosphere(4);
    for placement in [Placement::Fitted, Placement::Kept] {
        let Some(mut session) = begin(&left) else { return };
        append(&mut session, &right);
        let editor = session.harness.state().editor();
        let handle = editor.document().handles()[0].clone();
        assert_eq!((&*handle.name, holes(&session)), ("right", 2));
        let beside = model(&session);
        if placement == Placement::Kept {
            // Back to its place: the borders touch.
            let right = open(&right).model;
            let there = right.surface.positions.iter().sum::<DVec3>() / right.surface.positions.len() as f64;
            let transform = HandleTransform::Trs {
                translation: there - handle.pivot,
                rotation: DQuat::IDENTITY,
                scale: DVec3::ONE,
                pivot: None,
            };
            command(&mut session, Command::SetHandleTransform(handle.id, transform));
        }
        let settings = MergeSettings {
            placement,
            ..MergeSettings::default()
        };
        command(&mut session, Command::SetMerge(settings));
        command(&mut session, Command::Merge);
        let view = session.harness.state().editor().view();
        assert_eq!(view.problem, None, "{placement:?}");
        let merged = model(&session);
        let topology = &merged.topology;
        let faults = topology.non_manifold_edges() + topology.misoriented_edges() + topology.boundary_loops().len();
        assert_eq!((faults, topology.components().len()), (0, 1), "{placement:?}");
        assert_eq!(merged.surface.positions.len(), ball.positions.len(), "{placement:?}");
        for position in &ball.positions {
            let near = |other: &DVec3| other.distance(*position) < 1e-6;
            assert!(merged.surface.positions.iter().any(near), "{placement:?}: {position}");
        }
        // The handle keeps its vertices, which may have moved, and turns about their middle.
        let document = session.harness.state().editor().document();
        assert_eq!(document.handles().len(), 1, "{placement:?}");
        let painted = document.paint().iter().zip(&merged.surface.positions);
        let held = painted.filter(|(paint, _)| **paint == Paint::Handle(handle.id));
        let held: Vec<DVec3> = held.map(|(_, position)| *position).collect();
        let middle = held.iter().sum::<DVec3>() / held.len() as f64;
        let pivot = document.handles()[0].pivot;
        assert!(pivot.distance(middle) < 1e-9, "{placement:?}: {pivot} is not {middle}");
        command(&mut session, Command::Undo);
        assert!(Arc::ptr_eq(&model(&session), &beside));
        command(&mut session, Command::Redo);
        assert!(Arc::ptr_eq(&model(&session), &merged));
    }
}

#[test]
fn an_appended_part_is_cut_alone_by_a_drag_and_merged() {
    let folder = Folder::new();
    let file = folder.write_mesh("bowl.off", &used(&bowl()));
    let Some(mut session) = begin(&file) else { return };
    let count = model(&session).surface.positions.len();
    append(&mut session, &file);
    command(&mut session, Command::FrameAll);
    command(&mut session, Command::CutAlongLine(KeptSide::Positive));
    let [left, right] = [f64::min, f64::max].map(|end: fn(f64, f64) -> f64| {
        session.point_of(|positions| {
            let x = positions.iter().map(|at| at.x).reduce(end).unwrap();
            DVec3::new(x, 0.0, 0.0)
        })
    });
    session.stroke(left, right);
    session.settle();
    let editor = session.harness.state().editor();
    assert_eq!(editor.view().problem, None);
    let (now, document) = (model(&session), editor.document());
    let held: Vec<DVec3> = document
        .paint()
        .iter()
        .zip(&now.surface.positions)
        .filter(|(paint, _)| matches!(paint, Paint::Handle(_)))
        .map(|(_, at)| *at)
        .collect();
    let all = now.surface.positions.len();
    assert_eq!(all - held.len(), count, "the open file's own part stays whole");
    assert!(held.len() < 3 * count / 4, "the appended one is cut");
    let middle = held.iter().sum::<DVec3>() / held.len() as f64;
    assert!(document.handles()[0].pivot.distance(middle) < 1e-9);
    command(&mut session, Command::Merge);
    assert_eq!(session.harness.state().editor().view().problem, None);
    assert_eq!(model(&session).topology.components().len(), 1);
}

#[test]
fn a_mirrored_copy_of_a_half_closes_it_and_faces_outwards() {
    let folder = Folder::new();
    let half = {
        let mut ball = shapes::uv_sphere(24, 32);
        let at = ball.positions.clone();
        let middle = |corners: &[DrawnVertex; 3]| corners.iter().map(|corner| at[corner.index()].z).sum::<f64>();
        ball.triangles.retain(|corners| middle(corners) > 0.0);
        folder.write_mesh("half.off", &used(&ball))
    };
    let Some(mut session) = begin(&half) else { return };
    append(&mut session, &half);
    command(&mut session, Command::MirrorPart(2));
    let handle = session.harness.state().editor().document().handles()[0].clone();
    // A little apart from the first half, whose border is at z = 0.
    let own = open(&half).model;
    let middle = own.surface.positions.iter().sum::<DVec3>() / own.surface.positions.len() as f64;
    let to = middle * DVec3::new(1.0, 1.0, -1.0) - DVec3::Z * 0.05;
    let HandleTransform::Trs {
        rotation, scale, pivot, ..
    } = handle.transform
    else {
        panic!("{:?}", handle.transform)
    };
    let transform = HandleTransform::Trs {
        translation: to - handle.pivot,
        rotation,
        scale,
        pivot,
    };
    command(&mut session, Command::SetHandleTransform(handle.id, transform));
    command(&mut session, Command::Merge);
    assert_eq!(session.harness.state().editor().view().problem, None);
    let merged = model(&session);
    let topology = &merged.topology;
    let faults = topology.non_manifold_edges() + topology.misoriented_edges() + topology.boundary_loops().len();
    assert_eq!((faults, topology.components().len()), (0, 1));
    let at = |vertex: SurfaceVertex| merged.surface.positions[vertex.index()];
    let volume = |corners: &[SurfaceVertex; 3]| at(corners[0]).dot(at(corners[1]).cross(at(corners[2]))) / 6.0;
    let volume: f64 = merged.surface.triangles.iter().map(volume).sum();
    assert!((3.9..4.6).contains(&volume), "a ball's volume, outwards: {volume}");
}
