//! The flow on the surface: poured, pushed, played, paused, undone, kept as colours, stored in a project.
#![allow(clippy::unwrap_used, reason = "tests fail by panicking")]

use std::sync::Arc;

use crate::rig::{CENTRE_PX, Rig};
use glam::{DVec2, DVec3};
use pliant_deform::Budget;
use pliant_editor::{
    Beginning, Command, Dye, Event, FlowAction, FlowBrush, FlowOptions, Fluid, JobKind, Key, MeshReference, Project,
    ToolMode, geometry_hash,
};
use pliant_flow::FlowError;
use pliant_mesh::{Cancel, Progress, shapes};

const SPACE: Key = Key::Character(' ');

/// A sphere and the flow tool.
fn sphere() -> Rig {
    let mut rig = Rig::open(shapes::icosphere(4));
    rig.command(Command::SetTool(ToolMode::Flow));
    rig.command(Command::SetBrushRadius(60.0));
    rig
}

fn fluid(rig: &Rig) -> Fluid {
    rig.editor.document().fluid().clone()
}

fn pour(rig: &mut Rig, way_px: &[DVec2]) {
    rig.swipe(way_px);
}

/// A stroke to the right through the middle of the view.
fn to_the_right() -> Vec<DVec2> {
    (-5..=5)
        .map(|step| CENTRE_PX + DVec2::new(12.0 * f64::from(step), 0.0))
        .collect()
}

/// Takes so many steps of the flow that plays.
fn steps(rig: &mut Rig, count: usize) {
    for _ in 0..count {
        assert!(rig.run(JobKind::Flow), "no step waits");
    }
}

/// The mean position of the dye.
fn middle(rig: &Rig, fluid: &Fluid) -> DVec3 {
    let dyes = fluid.dye.as_ref().unwrap();
    let positions = &rig.model.surface.positions;
    let weighed = dyes
        .iter()
        .zip(positions)
        .map(|(dye, position)| *position * f64::from(dye[3]));
    let whole: f64 = dyes.iter().map(|dye| f64::from(dye[3])).sum();
    weighed.sum::<DVec3>() / whole
}

/// The number of vertices that are shown in a colour.
fn coloured(rig: &Rig) -> usize {
    let mut colours = Vec::new();
    rig.editor.region_colours(&mut colours);
    colours.iter().filter(|colour| colour[3] > 0).count()
}

#[test]
fn a_stroke_pours_its_colour_and_pushes_its_own_way_as_one_step() {
    let mut rig = sphere();
    let brush = FlowBrush {
        colour: [255, 0, 0],
        ..rig.editor.view().flow_brush
    };
    rig.command(Command::SetFlowBrush(brush));
    pour(&mut rig, &to_the_right());
    assert_eq!(rig.editor.view().undo, Some("Pour"));
    let poured = fluid(&rig);
    let dyes = poured.dye.as_ref().unwrap();
    assert!(dyes.contains(&[1.0, 0.0, 0.0, 1.0]));
    assert!(
        dyes.iter()
            .all(|[red, green, blue, coverage]| red == coverage && *green == 0.0 && *blue == 0.0)
    );
    let right = rig.editor.view().camera.axes().x_axis;
    let velocities = poured.velocity.as_ref().unwrap();
    let moved = velocities
        .iter()
        .map(|velocity| DVec3::from_array(velocity.map(f64::from)));
    let along: Vec<f64> = moved.map(|velocity| velocity.dot(right)).collect();
    assert!(along.iter().all(|speed| *speed >= 0.0) && along.iter().any(|speed| *speed > 0.1));
    for (velocity, triangle) in velocities.iter().zip(0..) {
        let velocity = DVec3::from_array(velocity.map(f64::from));
        let normal = pliant_mesh::face_normal(rig.model.surface.corners(triangle));
        assert!(
            velocity.dot(normal).abs() <= 1e-6 * velocity.length(),
            "the velocity leaves the surface"
        );
    }
    assert!(coloured(&rig) > 20);
    rig.command(Command::Undo);
    assert_eq!(fluid(&rig), Fluid::default());
    assert_eq!(coloured(&rig), 0);
    rig.command(Command::Redo);
    assert_eq!(fluid(&rig), poured);
}

#[test]
fn a_stretch_of_play_carries_the_dye_and_is_one_step_to_the_bit() {
    let mut rig = sphere();
    pour(&mut rig, &to_the_right());
    let before = fluid(&rig);
    let revision = rig.editor.view().regions_revision;
    rig.key(SPACE);
    assert!(rig.editor.view().is_playing);
    steps(&mut rig, 20);
    assert_eq!(fluid(&rig), before, "the document waits for the pause");
    assert!(rig.editor.view().regions_revision > revision, "the colours move");
    rig.key(SPACE);
    assert!(!rig.editor.is_settled(), "the stretch has not ended");
    rig.drain();
    assert!(rig.editor.is_settled() && !rig.editor.view().is_playing);
    let after = fluid(&rig);
    let right = rig.editor.view().camera.axes().x_axis;
    let way = (middle(&rig, &after) - middle(&rig, &before)).dot(right);
    assert!(way > 0.05, "the dye has moved {way} to the right");
    assert_eq!(rig.editor.view().undo, Some("Flow"));
    rig.command(Command::Undo);
    assert_eq!(fluid(&rig), before);
    rig.command(Command::Redo);
    assert_eq!(fluid(&rig), after);
    // At rest nothing changes and nothing is computed.
    let revision = rig.editor.view().regions_revision;
    rig.move_to(CENTRE_PX);
    rig.drain();
    assert!(rig.jobs.waiting().is_empty());
    assert_eq!(rig.editor.view().regions_revision, revision);
}

#[test]
fn the_same_play_gives_the_same_bits_and_goes_on_after_a_pause() {
    let play = || {
        let mut rig = sphere();
        pour(&mut rig, &to_the_right());
        for _ in 0..2 {
            rig.key(SPACE);
            // The third step is under way when it pauses.
            steps(&mut rig, 2);
            rig.key(SPACE);
            rig.drain();
        }
        fluid(&rig)
    };
    assert_eq!(play(), play());
    let mut rig = sphere();
    pour(&mut rig, &to_the_right());
    for _ in 0..6 {
        rig.command(Command::StepFlow);
        rig.drain();
    }
    assert_eq!(fluid(&rig), play(), "single steps go on where the last one ended");
}

/// The dyes of every step of the recording, from its start.
fn replayed(rig: &Rig) -> Vec<Vec<Dye>> {
    let recording = rig.editor.flow_recording().unwrap();
    let mut frames = Vec::new();
    let each = |step: usize, dyes: &[Dye]| {
        assert_eq!(step, frames.len());
        frames.push(dyes.to_vec());
        Ok::<(), FlowError>(())
    };
    let (progress, cancel) = (Progress::new(), Cancel::new());
    recording.replay(Budget::default(), (&progress, &cancel), each).unwrap();
    assert_eq!(frames.len(), recording.steps() + 1);
    frames
}

/// Dye as the document has it.
fn rounded(dyes: &[Dye]) -> Vec<Dye> {
    let round = |value: f32| (value * 65535.0).round() / 65535.0;
    dyes.iter().map(|dye| dye.map(round)).collect()
}

#[test]
fn a_recording_gives_the_bits_of_what_was_played_under_brushes_and_changing_forces() {
    let mut rig = sphere();
    pour(&mut rig, &to_the_right());
    let start = fluid(&rig).dye.unwrap();
    assert!(rig.editor.flow_recording().is_none(), "nothing was played");
    rig.key(SPACE);
    steps(&mut rig, 3);
    rig.press(CENTRE_PX);
    steps(&mut rig, 2);
    rig.release(CENTRE_PX);
    rig.command(Command::SetFlowOptions(FlowOptions {
        gravity: DVec3::new(0.0, -9.81, 0.0),
        confinement: 1.0,
        viscosity: 0.001,
    }));
    steps(&mut rig, 3);
    rig.key(SPACE);
    rig.drain();
    let first = fluid(&rig).dye.unwrap();
    let frames = replayed(&rig);
    assert_eq!(frames[0], *start);
    assert_eq!(rounded(frames.last().unwrap()), *first);

    // A pause and a single step go on; a stretch without a trace leaves none in it.
    rig.command(Command::StepFlow);
    rig.drain();
    rig.key(SPACE);
    steps(&mut rig, 2);
    rig.command(Command::Undo);
    rig.drain();
    let longer = replayed(&rig);
    assert_eq!(longer.len(), frames.len() + 1);
    assert_eq!(longer[..frames.len()], frames);
    assert_eq!(rounded(longer.last().unwrap()), *fluid(&rig).dye.unwrap());

    // Another change of the fluid ends it, another change of the document does not.
    rig.paint_handle();
    assert!(rig.editor.flow_recording().is_some());
    rig.command(Command::SetTool(ToolMode::Flow));
    pour(&mut rig, &to_the_right()[..3]);
    assert!(rig.editor.flow_recording().is_none());
    rig.command(Command::StepFlow);
    rig.drain();
    assert_eq!(replayed(&rig).len(), 2);
    assert_eq!(rounded(replayed(&rig).last().unwrap()), *fluid(&rig).dye.unwrap());
    rig.command(Command::Undo);
    assert!(rig.editor.flow_recording().is_none());
}

#[test]
fn a_recording_has_the_dye_over_the_kept_one_on_the_shape_on_which_it_flowed() {
    let mut rig = sphere();
    pour(&mut rig, &to_the_right());
    rig.command(Command::KeepDye);
    rig.paint_handle();
    rig.move_by('y', "0.5");
    rig.drain();
    assert!(rig.largest_displacement() > 0.4);
    rig.command(Command::SetTool(ToolMode::Flow));
    pour(&mut rig, &to_the_right()[..4]);
    rig.drain();
    rig.key(SPACE);
    steps(&mut rig, 4);
    rig.key(SPACE);
    rig.drain();
    // Another shape comes after it.
    rig.command(Command::SetTool(ToolMode::PaintHandle));
    rig.move_by('y', "0.5");
    let last = replayed(&rig).pop().unwrap();
    let flowed = fluid(&rig);
    let kept_under = flowed.kept.as_ref().unwrap();
    let shown = flowed.dye.as_ref().unwrap().iter().zip(kept_under.iter());
    for ([.., coverage], ([.., dye], [.., kept])) in last.iter().zip(shown) {
        let wanted = dye + (1.0 - dye) * kept;
        assert!((coverage - wanted).abs() < 2e-5, "{coverage} is not {wanted}");
    }
    let kept = fluid(&rig).kept.unwrap();
    for dyes in replayed(&rig) {
        let is_covered = dyes.iter().zip(kept.iter()).all(|(dye, kept)| dye[3] >= kept[3] - 1e-6);
        assert!(is_covered, "kept dye was lost");
    }
}

#[test]
fn undo_while_it_plays_ends_the_stretch_without_a_trace_and_nothing_before_it() {
    let mut rig = sphere();
    pour(&mut rig, &to_the_right());
    let before = fluid(&rig);
    let shown = coloured(&rig);
    rig.key(SPACE);
    steps(&mut rig, 5);
    rig.command(Command::Undo);
    assert!(!rig.editor.view().is_playing);
    rig.drain();
    assert_eq!(fluid(&rig), before);
    assert_eq!(coloured(&rig), shown);
    assert_eq!(rig.editor.view().undo, Some("Pour"));
    // A step that was under way does not count for the next stretch.
    rig.key(SPACE);
    steps(&mut rig, 5);
    rig.command(Command::Undo);
    rig.command(Command::StepFlow);
    rig.drain();
    let once = fluid(&rig);
    rig.command(Command::Undo);
    rig.command(Command::StepFlow);
    rig.drain();
    assert_eq!(fluid(&rig), once);
}

#[test]
fn a_brush_acts_on_the_playing_flow_even_at_rest_and_other_edits_have_their_own_steps() {
    let mut rig = sphere();
    rig.key(SPACE);
    steps(&mut rig, 1);
    rig.press(CENTRE_PX);
    steps(&mut rig, 3);
    rig.release(CENTRE_PX);
    rig.paint_handle();
    steps(&mut rig, 2);
    rig.command(Command::PauseFlow);
    rig.drain();
    assert!(fluid(&rig).has_dye());
    let names = ["Flow", "Paint handle 1"];
    for name in names {
        let undo = rig.editor.view().undo.unwrap().to_owned();
        assert!(undo.eq_ignore_ascii_case(name), "{undo}");
        rig.command(Command::Undo);
    }
    assert_eq!(rig.editor.view().undo, None);
    assert_eq!(fluid(&rig), Fluid::default());
}

#[test]
fn gravity_pulls_dye_down_and_bad_forces_change_nothing() {
    let mut rig = sphere();
    let brush = FlowBrush {
        action: FlowAction::Pour,
        ..rig.editor.view().flow_brush
    };
    rig.command(Command::SetFlowBrush(brush));
    pour(&mut rig, &[CENTRE_PX]);
    assert!(fluid(&rig).velocity.is_none());
    let options = FlowOptions {
        gravity: DVec3::new(0.0, -9.81, 0.0),
        ..FlowOptions::default()
    };
    rig.command(Command::SetFlowOptions(options));
    rig.command(Command::SetFlowOptions(FlowOptions {
        viscosity: -1.0,
        ..options
    }));
    rig.command(Command::SetFlowOptions(FlowOptions {
        confinement: f64::NAN,
        ..options
    }));
    assert_eq!(*rig.editor.document().flow_options(), options);
    let before = middle(&rig, &fluid(&rig)).y;
    rig.key(SPACE);
    steps(&mut rig, 15);
    rig.key(SPACE);
    rig.drain();
    assert!(middle(&rig, &fluid(&rig)).y < before - 0.02);
}

#[test]
fn kept_dye_stays_and_more_flows_over_it() {
    let mut rig = sphere();
    pour(&mut rig, &to_the_right());
    let shown = coloured(&rig);
    let poured = fluid(&rig).dye.unwrap();
    rig.command(Command::KeepDye);
    let kept = fluid(&rig);
    assert_eq!(kept.kept.as_ref(), Some(&poured));
    assert!(kept.dye.is_none() && kept.velocity.is_none());
    assert_eq!(coloured(&rig), shown, "it looks as before");
    assert!(rig.editor.unavailable_because(&Command::KeepDye).is_some());
    rig.key(SPACE);
    steps(&mut rig, 2);
    assert!(rig.editor.unavailable_because(&Command::RemoveKeptDye).is_some());
    assert_eq!(coloured(&rig), shown);
    rig.key(SPACE);
    rig.drain();
    assert_eq!(fluid(&rig), kept, "a clear fluid that rests does so after play");
    rig.command(Command::RemoveKeptDye);
    assert_eq!(coloured(&rig), 0);
    rig.command(Command::Undo);
    rig.command(Command::Undo);
    assert_eq!(fluid(&rig).dye, Some(poured));
}

#[test]
fn a_project_has_the_fluid_to_the_bit() {
    let mut rig = sphere();
    pour(&mut rig, &to_the_right());
    rig.command(Command::KeepDye);
    pour(&mut rig, &to_the_right()[..4]);
    rig.command(Command::SetFlowOptions(FlowOptions {
        viscosity: 0.01,
        confinement: 2.0,
        gravity: DVec3::NEG_Z,
    }));
    rig.command(Command::StepFlow);
    rig.drain();
    let mesh = MeshReference {
        path: None,
        name: None,
        geometry: geometry_hash(&rig.model),
    };
    let text = rig.editor.snapshot().unwrap().project(mesh).to_json();
    let project = Project::parse(&text).unwrap();
    let (before, options) = (fluid(&rig), *rig.editor.document().flow_options());
    let hash = rig.editor.document_hash();
    let mut again = Rig::open(shapes::icosphere(4));
    again.send(Event::Opened {
        model: Arc::clone(&rig.model),
        name: "again".to_owned(),
        beginning: Some(Beginning::Project(Box::new(project))),
    });
    again.drain();
    assert_eq!(again.editor.view().problem, None);
    assert_eq!(
        (fluid(&again), *again.editor.document().flow_options()),
        (before, options)
    );
    assert_eq!(again.editor.document_hash(), hash);
}

#[test]
fn a_file_without_triangles_and_a_stopped_flow_are_refused_in_words() {
    let mut rig = sphere();
    pour(&mut rig, &to_the_right());
    let before = fluid(&rig);
    rig.key(SPACE);
    // It is being prepared.
    rig.command(Command::CancelJobs);
    rig.drain();
    assert!(!rig.editor.view().is_playing);
    assert_eq!(fluid(&rig), before);
    rig.key(SPACE);
    steps(&mut rig, 2);
    rig.command(Command::CancelJobs);
    rig.drain();
    assert!(!rig.editor.view().is_playing);
    assert_eq!(rig.editor.view().undo, Some("Flow"));

    let mut points = shapes::icosphere(2);
    points.triangles.clear();
    let points = Rig::open(points);
    let why = points.editor.unavailable_because(&Command::PlayFlow).unwrap();
    assert!(why.contains("points"), "{why}");
}
