//! Laws of the work pose: everything returns to the bit, paint stays, and corrections turn back with the surface.
#![allow(clippy::unwrap_used, clippy::expect_used, reason = "tests fail by panicking")]

use crate::project::{reopened, saved};
use crate::rig::{CENTRE_PX, Rig};
use glam::{DQuat, DVec2, DVec3};
use pliant_deform::METHODS;
use pliant_editor::{
    Command, Correction, CorrectionBrush, HandleId, HandleTransform, MeshReference, NamedView, Paint, Reach, ToolMode,
    geometry_hash,
};
use pliant_mesh::shapes;

/// A ball with a handle in front, moved aside.
fn bent(method: &str) -> Rig {
    let mut rig = Rig::open(shapes::icosphere(4));
    rig.choose(method);
    rig.paint_handle();
    rig.drain();
    rig.command(Command::SetReach(HandleId(0), Reach::Length(0.7)));
    rig.drain();
    rig.move_by('x', ".1");
    rig.drain();
    rig
}

fn turn(rig: &mut Rig, degrees: f64) {
    let transform = HandleTransform::Trs {
        translation: DVec3::new(0.0, 0.3, 0.1),
        rotation: DQuat::from_rotation_z(degrees.to_radians()),
        scale: DVec3::ONE,
        pivot: None,
    };
    rig.command(Command::SetHandleTransform(HandleId(0), transform));
    rig.drain();
}

fn stroke(rig: &mut Rig, mode: ToolMode, from: DVec2, to: DVec2) {
    rig.command(Command::SetTool(mode));
    rig.command(Command::SetBrushRadius(24.0));
    rig.swipe(&[from, to]);
    rig.drain();
}

#[test]
fn everything_returns_to_the_bit_by_every_method_and_undo_goes_through_both_doors() {
    for declaration in METHODS {
        let mut rig = bent(declaration.name);
        let seen = rig.drawn();
        let transforms = |rig: &Rig| {
            let handles = rig.editor.document().handles().iter();
            handles
                .map(|handle| (handle.transform, handle.turn_deg))
                .collect::<Vec<_>>()
        };
        let placed = transforms(&rig);
        rig.command(Command::WorkPose);
        assert!(rig.editor.document().is_in_work_pose());
        assert!(rig.drawn() == seen, "{}: the beginning moves nothing", declaration.name);
        turn(&mut rig, 40.0);
        let posed = rig.drawn();
        assert!(posed != seen, "{}", declaration.name);
        rig.command(Command::WorkPose);
        rig.drain();
        assert!(!rig.editor.document().is_in_work_pose());
        assert!(rig.drawn() == seen, "{}: it returns", declaration.name);
        assert_eq!(transforms(&rig), placed, "{}", declaration.name);
        assert_eq!(rig.editor.history().undo_name(), Some("Return from work pose"));
        rig.undo();
        assert!(
            rig.editor.document().is_in_work_pose() && rig.drawn() == posed,
            "{}",
            declaration.name
        );
        rig.redo();
        assert!(
            !rig.editor.document().is_in_work_pose() && rig.drawn() == seen,
            "{}",
            declaration.name
        );
    }
}

#[test]
fn paint_stays_and_handles_made_in_it_are_where_their_vertices_were() {
    let mut rig = bent("bilaplacian");
    let seen = rig.drawn();
    rig.command(Command::WorkPose);
    turn(&mut rig, 60.0);
    rig.command(Command::NewHandle);
    stroke(
        &mut rig,
        ToolMode::PaintHandle,
        CENTRE_PX + DVec2::new(-70.0, -75.0),
        CENTRE_PX + DVec2::new(-50.0, -80.0),
    );
    let new = rig.editor.document().handles()[1].id;
    let own = rig.count(Paint::Handle(new));
    assert!(own > 3, "{own}");
    rig.command(Command::WorkPose);
    rig.drain();
    assert!(rig.drawn() == seen, "no vertex is elsewhere");
    assert_eq!(rig.count(Paint::Handle(new)), own);
    // Both handles move on from there: the new one by a hair, and nothing jumps.
    let before = rig.editor.document().from_file().to_vec();
    let handle = rig.editor.document().handle(new).unwrap();
    let moved = match handle.transform {
        HandleTransform::Trs {
            translation,
            rotation,
            scale,
            pivot,
        } => HandleTransform::Trs {
            translation: translation + DVec3::X * 1e-6,
            rotation,
            scale,
            pivot,
        },
        other => other,
    };
    rig.command(Command::SetHandleTransform(new, moved));
    rig.drain();
    let after = rig.editor.document().from_file();
    let farthest = before
        .iter()
        .zip(&**after)
        .map(|(a, b)| a.distance(*b))
        .fold(0.0, f64::max);
    assert!(farthest < 1e-5, "{farthest}");
}

#[test]
fn a_correction_turns_back_with_the_surface_and_every_other_vertex_keeps_its_bits() {
    let quarter = 90.0;
    let grab = |rig: &mut Rig, by: DVec2| {
        rig.command(Command::SetTool(ToolMode::Correct));
        rig.command(Command::SetCorrection(CorrectionBrush {
            correction: Correction::Grab,
            ..CorrectionBrush::default()
        }));
        rig.command(Command::SetBrushRadius(8.0));
        rig.swipe(&[CENTRE_PX, CENTRE_PX + by]);
        rig.drain();
    };
    // The whole ball is turned about the axis to the eye, so that a pull to the right is one downwards at rest.
    let mut rig = Rig::open(shapes::icosphere(4));
    rig.command(Command::View(NamedView::Front));
    rig.choose("bilaplacian");
    rig.paint_handle();
    rig.command(Command::Region(pliant_editor::RegionAction::FillParts));
    rig.drain();
    let seen = rig.editor.document().from_file().to_vec();
    rig.command(Command::WorkPose);
    let transform = HandleTransform::Trs {
        translation: DVec3::ZERO,
        rotation: DQuat::from_rotation_z(f64::to_radians(quarter)),
        scale: DVec3::ONE,
        pivot: Some(DVec3::ZERO),
    };
    rig.command(Command::SetHandleTransform(HandleId(0), transform));
    rig.drain();
    let posed = rig.editor.document().from_file().to_vec();
    grab(&mut rig, DVec2::new(12.0, 0.0));
    let pulled = rig.editor.document().from_file().to_vec();
    rig.command(Command::WorkPose);
    rig.drain();
    let back = rig.editor.document().from_file();
    let (mut moved, mut most) = (0, 0.0_f64);
    for vertex in 0..back.len() {
        let pull = pulled[vertex] - posed[vertex];
        if pull == DVec3::ZERO {
            assert_eq!(back[vertex], seen[vertex]);
            continue;
        }
        moved += 1;
        let wanted = DQuat::from_rotation_z(-f64::to_radians(quarter)) * pull;
        let error = (back[vertex] - seen[vertex]).distance(wanted);
        most = most.max(error / pull.length());
    }
    assert!(moved > 10, "{moved}");
    assert!(most < 1e-6, "{most}");
}

#[test]
fn files_get_the_shape_without_the_work_pose_and_nothing_changes_the_way_back() {
    let mut rig = bent("arap");
    let seen = rig.editor.document().from_file().clone();
    let project = |rig: &Rig| {
        let reference = MeshReference {
            path: None,
            name: None,
            geometry: geometry_hash(&rig.model),
        };
        rig.editor.snapshot().unwrap().project(reference).document_hash()
    };
    let before = project(&rig);
    rig.command(Command::WorkPose);
    turn(&mut rig, 30.0);
    assert_eq!(rig.editor.lasting_shape(), seen);
    assert_eq!(project(&rig), before);
    for command in [
        Command::Apply,
        Command::ResetShape,
        Command::ResetRegion,
        Command::ClearRegions,
        Command::SetStrength(0.5),
    ] {
        let why = rig.editor.unavailable_because(&command);
        assert!(why.is_some_and(|why| why.contains("work pose")), "{command:?}");
    }
}

#[test]
fn a_project_opens_in_its_work_pose_and_still_returns_to_the_bit() {
    for method in ["bilaplacian", "arap"] {
        let mut rig = bent(method);
        let seen = rig.drawn();
        let (outside, before) = (saved(&rig), rig.editor.document().clone());
        rig.command(Command::WorkPose);
        turn(&mut rig, 40.0);
        let (posed, text) = (rig.drawn(), saved(&rig));
        let mut again = reopened(&rig, &text);
        assert!(again.editor.document().is_in_work_pose(), "{method}");
        assert!(!again.editor.view().unsaved, "{method}");
        let place = |bits: &[u64; 3]| DVec3::from_array(bits.map(f64::from_bits));
        let apart = posed
            .iter()
            .zip(&again.drawn())
            .map(|(a, b)| place(a).distance(place(b)))
            .fold(0.0, f64::max);
        // An iterative method may end a little elsewhere than after the drag.
        let most = if method == "arap" { 1e-2 } else { 0.0 };
        assert!(apart <= most, "{method}: {apart}");
        again.command(Command::WorkPose);
        again.drain();
        assert!(again.drawn() == seen, "{method}: it returns");
        assert_eq!(again.editor.document().handles(), before.handles(), "{method}");
        // Commands bend the file outside the work pose.
        let setup = |text: &str| {
            pliant_editor::Beginning::parse(text)
                .unwrap()
                .resolve(&rig.model)
                .unwrap()
        };
        assert!(setup(&text) == setup(&outside), "{method}");
    }
}
