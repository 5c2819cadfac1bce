//! Laws of corrections by hand: smoothing removes bumps and keeps the volume, relaxing evens triangles within the
//! surface, a grab follows the pointer; each is a step that undo takes back, and the next drag continues from the
//! visible shape.
#![allow(clippy::unwrap_used, clippy::expect_used, reason = "tests fail by panicking")]

use crate::rig;
use crate::rig::{CENTRE_PX, Fingerprint, Rig, VIEWPORT_PX};
use glam::{DVec2, DVec3};
use pliant_deform::Method;
use pliant_editor::{
    Beginning, Carries, Command, Correction, CorrectionBrush, Document, Key, MeshReference, NamedView, Project,
    Symmetry, ToolMode, geometry_hash,
};
use pliant_mesh::{Distortion, Drawn, SurfaceVertex, shapes};

/// A ball with bumps as small as its triangles.
fn bumpy() -> Drawn {
    let mut drawn = shapes::icosphere(5);
    for (number, p) in drawn.positions.iter_mut().enumerate() {
        *p *= 1.0 + 0.02 * ((number * 7919) % 13) as f64 / 13.0;
    }
    drawn
}

fn opened(drawn: Drawn, correction: Correction) -> Rig {
    let mut rig = Rig::open(drawn);
    rig.command(Command::View(NamedView::Front));
    rig.command(Command::SetTool(ToolMode::Correct));
    rig.command(Command::SetCorrection(CorrectionBrush {
        correction,
        ..CorrectionBrush::default()
    }));
    rig.command(Command::SetBrushRadius(70.0));
    rig.drain();
    rig
}

/// Back and forth over the middle.
fn stroke(rig: &mut Rig) {
    let way: Vec<DVec2> = (0..24)
        .map(|step| CENTRE_PX + DVec2::new(f64::from(step % 6) * 5.0 - 12.0, 0.0))
        .collect();
    rig.swipe(&way);
    rig.drain();
}

fn positions(rig: &Rig) -> Vec<DVec3> {
    let shape = rig.editor.document().from_file();
    rig.model
        .surface
        .positions
        .iter()
        .zip(&**shape)
        .map(|(p, d)| *p + *d)
        .collect()
}

/// The vertices moved by a stroke in front.
fn moved(document: &Document) -> Vec<usize> {
    let shape = document.from_file();
    (0..shape.len())
        .filter(|&vertex| shape[vertex] != DVec3::ZERO)
        .collect()
}

/// The distances of vertices from the mean of their neighbours, along the outward direction and across it.
fn roughness(rig: &Rig, positions: &[DVec3], vertices: &[usize]) -> [f64; 2] {
    let of = |&vertex: &usize| {
        let neighbours = rig.model.topology.neighbours(SurfaceVertex(vertex as u32));
        let mean = neighbours.iter().map(|v| positions[v.index()]).sum::<DVec3>() / neighbours.len() as f64;
        let (off, out) = (mean - positions[vertex], positions[vertex].normalize());
        [off.dot(out).powi(2), off.reject_from(out).length_squared()]
    };
    let all: Vec<[f64; 2]> = vertices.iter().map(of).collect();
    [0, 1].map(|k| (all.iter().map(|pair| pair[k]).sum::<f64>() / all.len() as f64).sqrt())
}

#[test]
fn smoothing_takes_bumps_away_and_keeps_the_volume() {
    let mut rig = opened(bumpy(), Correction::Smooth);
    let before = positions(&rig);
    stroke(&mut rig);
    let (after, met) = (positions(&rig), moved(rig.editor.document()));
    assert!(met.len() > 40 && met.len() < before.len() / 2, "{}", met.len());
    let inner: Vec<usize> = met
        .iter()
        .copied()
        .filter(|&v| after[v].truncate().length() < 0.12)
        .collect();
    assert!(inner.len() > 10);
    let [rough, smooth] = [&before, &after].map(|shape| roughness(&rig, shape, &inner)[0]);
    assert!(smooth < 0.5 * rough, "{rough} {smooth}");
    let volume = Distortion::of(&rig.model.surface, &rig.model.topology, &after).volume_ratio;
    // The smoothed cap is a hundredth of the ball: its mean height stays to a thousandth of the radius.
    assert!((volume - 1.0).abs() < 1e-4, "{volume}");
}

#[test]
fn relaxing_evens_triangles_within_the_surface() {
    let mut drawn = shapes::icosphere(5);
    for (number, p) in drawn.positions.iter_mut().enumerate() {
        let side = DVec3::new(((number * 31) % 7) as f64 - 3.0, ((number * 17) % 5) as f64 - 2.0, 1.0);
        *p = (*p + p.cross(side).normalize_or_zero() * 0.008).normalize();
    }
    let mut rig = opened(drawn, Correction::Relax);
    let before = positions(&rig);
    stroke(&mut rig);
    let (after, met) = (positions(&rig), moved(rig.editor.document()));
    let inner: Vec<usize> = met
        .iter()
        .copied()
        .filter(|&v| after[v].truncate().length() < 0.12)
        .collect();
    let [uneven, even] = [&before, &after].map(|shape| roughness(&rig, shape, &inner)[1]);
    assert!(even < 0.5 * uneven, "{uneven} {even}");
    for vertex in met {
        assert!(
            (after[vertex].length() - 1.0).abs() < 5e-4,
            "{}",
            after[vertex].length()
        );
    }
}

#[test]
fn a_grab_takes_the_surface_along_with_the_pointer_and_keeps_the_volume() {
    let mut rig = opened(shapes::icosphere(5), Correction::Grab);
    let before = positions(&rig);
    let camera = *rig.editor.view().camera;
    let gripped = before
        .iter()
        .copied()
        .reduce(|a, b| if a.z > b.z { a } else { b })
        .unwrap();
    let grip_px = camera.project(gripped, VIEWPORT_PX).unwrap();
    let way_px = DVec2::new(24.0, -10.0);
    rig.swipe(&[grip_px, grip_px + way_px]);
    rig.drain();
    let after = positions(&rig);
    let vertex = before.iter().position(|p| *p == gripped).unwrap();
    let seen = camera.project(after[vertex], VIEWPORT_PX).unwrap();
    assert!(seen.distance(grip_px + way_px) < 1.0, "{seen} {grip_px}");
    let volume = Distortion::of(&rig.model.surface, &rig.model.topology, &after).volume_ratio;
    assert!((volume - 1.0).abs() < 2e-3, "{volume}");
    let behind = before
        .iter()
        .zip(&after)
        .filter(|(p, _)| p.z < -0.5)
        .map(|(a, b)| a.distance(*b));
    assert!(behind.fold(0.0, f64::max) < 0.02 * gripped.distance(after[vertex]));
}

#[test]
fn a_grab_pulled_far_beyond_its_radius_folds_nothing() {
    let mut rig = opened(shapes::icosphere(5), Correction::Grab);
    rig.command(Command::SetBrushRadius(25.0));
    let volume_of = |rig: &Rig| {
        let after = positions(rig);
        Distortion::of(&rig.model.surface, &rig.model.topology, &after).volume_ratio
    };
    // From the rim outwards, by six radii: a single step turns the tip inside out.
    let camera = *rig.editor.view().camera;
    let rim = camera.project(DVec3::new(0.95, 0.0, 0.2), VIEWPORT_PX).unwrap();
    rig.swipe(&[rim, rim + DVec2::new(60.0, 0.0), rim + DVec2::new(150.0, 0.0)]);
    rig.drain();
    assert!((volume_of(&rig) - 1.0).abs() < 0.02, "{}", volume_of(&rig));
    let found = rig.editor.intersections();
    assert!(found.is_some_and(|found| found.is_empty()), "{found:?}");
}

#[test]
fn each_is_one_step_and_escape_and_undo_leave_nothing() {
    for correction in [Correction::Smooth, Correction::Relax, Correction::Grab] {
        let mut rig = opened(bumpy(), correction);
        let before = Fingerprint::of(rig.editor.document());
        rig.press(CENTRE_PX);
        rig.move_to(CENTRE_PX + DVec2::new(15.0, 5.0));
        rig.key(Key::Escape);
        rig.drain();
        assert_eq!(Fingerprint::of(rig.editor.document()), before, "{correction:?}");
        stroke(&mut rig);
        let done = Fingerprint::of(rig.editor.document());
        assert_ne!(done, before, "{correction:?}");
        rig.command(Command::Undo);
        rig.drain();
        assert_eq!(Fingerprint::of(rig.editor.document()), before, "{correction:?}");
        rig.command(Command::Redo);
        rig.drain();
        assert_eq!(Fingerprint::of(rig.editor.document()), done, "{correction:?}");
    }
}

#[test]
fn the_next_drag_goes_on_from_what_was_corrected_and_a_project_keeps_it() {
    let mut rig = opened(bumpy(), Correction::Grab);
    rig.swipe(&[CENTRE_PX, CENTRE_PX + DVec2::new(20.0, 0.0)]);
    rig.drain();
    let corrected = rig.editor.document().from_rest().to_vec();
    let project = rig.editor.snapshot().unwrap().project(MeshReference {
        path: None,
        name: None,
        geometry: geometry_hash(&rig.model),
    });
    let beginning = Beginning::parse(&Project::parse(&project.to_json()).unwrap().to_json()).unwrap();
    let mut again = pliant_editor::Editor::new(Box::new(pliant_editor::InlineExecutor::new()));
    again.handle(pliant_editor::Event::Opened {
        model: std::sync::Arc::clone(&rig.model),
        name: "again".to_owned(),
        beginning: Some(beginning),
    });
    assert_eq!(again.document().from_rest(), corrected);

    // A handle at the top, hardly moved: vertices far from it keep their correction.
    rig.command(Command::SetTool(ToolMode::PaintHandle));
    rig.command(Command::SetBrushRadius(20.0));
    let camera = *rig.editor.view().camera;
    let top_px = camera.project(DVec3::new(0.0, 0.93, 0.4), VIEWPORT_PX).unwrap();
    rig.swipe(&[top_px, top_px + DVec2::new(2.0, 0.0)]);
    rig.drain();
    rig.move_by('y', ".01");
    rig.drain();
    let shape = rig.editor.document().from_rest();
    let furthest = corrected
        .iter()
        .zip(shape)
        .map(|(a, b)| a.distance(*b))
        .fold(0.0, f64::max);
    assert!(furthest < 0.015, "nothing jumps: {furthest}");
    let most = corrected.iter().map(|d| d.length()).fold(0.0, f64::max);
    assert!(
        shape.iter().any(|d| d.length() > 0.9 * most),
        "the correction is still seen"
    );
}

#[test]
fn with_symmetry_both_sides_are_corrected_alike() {
    for correction in [Correction::Smooth, Correction::Grab] {
        let mut drawn = shapes::icosphere(4);
        for p in &mut drawn.positions {
            let wave = 0.02 * (9.0 * p.y).sin() * (11.0 * p.z).sin() * (12.0 * p.x.abs()).sin();
            *p *= 1.0 + wave;
        }
        let mut rig = opened(drawn, correction);
        rig.command(Command::SetSymmetry(Symmetry::Axis(0)));
        rig.drain();
        let camera = *rig.editor.view().camera;
        let side_px = camera.project(DVec3::new(0.5, 0.1, 0.85), VIEWPORT_PX).unwrap();
        rig.swipe(&[side_px, side_px + DVec2::new(12.0, 6.0), side_px]);
        rig.swipe(&[side_px, side_px + DVec2::new(12.0, 6.0)]);
        rig.drain();
        let shape = rig.editor.document().from_rest();
        let key = |p: DVec3| (p * 1e6).round().to_array().map(|c| c as i64);
        let of: std::collections::BTreeMap<_, DVec3> = rig
            .model
            .surface
            .positions
            .iter()
            .zip(shape)
            .map(|(p, d)| (key(*p), *d))
            .collect();
        let mirrored = DVec3::new(-1.0, 1.0, 1.0);
        let most = shape.iter().map(|d| d.length()).fold(0.0, f64::max);
        assert!(most > 1e-3, "{correction:?} {most}");
        for (p, d) in rig.model.surface.positions.iter().zip(shape) {
            assert!(
                of[&key(*p * mirrored)].distance(*d * mirrored) < 1e-9,
                "{correction:?} {p}"
            );
        }
    }
}

/// The front of a ball is grabbed, or not, while a handle at its top is moved by `methods[0]`, and `methods[1]`
/// continues.
fn bent_by(methods: [&str; 2], is_corrected: bool) -> (Rig, Vec<DVec3>) {
    let mut rig = opened(shapes::icosphere(4), Correction::Grab);
    rig.choose(methods[0]);
    rig.paint(ToolMode::PaintHandle, &[CENTRE_PX + DVec2::new(0.0, -150.0)]);
    rig.drain();
    rig.move_by('y', ".2");
    rig.drain();
    let before = rig.editor.document().from_file().to_vec();
    if is_corrected {
        rig.command(Command::SetTool(ToolMode::Correct));
        rig.swipe(&[
            CENTRE_PX,
            CENTRE_PX + DVec2::new(20.0, 0.0),
            CENTRE_PX + DVec2::new(40.0, 0.0),
        ]);
        rig.drain();
    }
    let after = rig.editor.document().from_file().to_vec();
    let by_hand = after
        .iter()
        .zip(&before)
        .map(|(after, before)| *after - *before)
        .collect();
    rig.choose(methods[1]);
    rig.drain();
    (rig, by_hand)
}

#[test]
fn corrections_by_hand_are_carried_along_by_every_other_method() {
    for methods in [
        ["arap", "bilaplacian"],
        ["bilaplacian", "arap"],
        ["bilaplacian", "shells"],
    ] {
        let (mut corrected, by_hand) = bent_by(methods, true);
        let (plain, _) = bent_by(methods, false);
        assert!(by_hand.iter().any(|way| way.length() > 0.02), "{methods:?}");
        let size = corrected.model.bounds().unwrap().diagonal();
        let compare = |corrected: &Rig, by_hand: &[DVec3]| {
            let shapes = [corrected, &plain].map(|rig| rig.editor.document().from_file());
            let apart = shapes[0].iter().zip(&**shapes[1]).zip(by_hand);
            let apart = apart.map(|((corrected, plain), by_hand)| (*corrected - *plain).distance(*by_hand));
            apart.fold(0.0, f64::max) / size
        };
        assert!(compare(&corrected, &by_hand) < rig::ITERATED, "{methods:?}");
        // The project and the edit take the command line's path: the method is chosen when they are read.
        let shape = corrected.editor.document().from_file().clone();
        corrected.undo();
        corrected.drain();
        let document = corrected.editor.document();
        let geometry = geometry_hash(&corrected.model);
        let mesh = MeshReference {
            path: None,
            name: None,
            geometry,
        };
        let project = Project::of(document, &corrected.model, None, mesh);
        let edit = corrected.editor.edit_file().unwrap();
        for mut beginning in [Beginning::from(project), Beginning::from(edit)] {
            beginning.set_method(Method::from_name(methods[1]).unwrap());
            let kept = beginning.resolve(&corrected.model).unwrap().kept.unwrap();
            let corrections = kept.shape.corrections.as_ref().unwrap();
            let apart = corrections.iter().zip(&by_hand).map(|(a, b)| a.distance(*b));
            assert!(apart.fold(0.0, f64::max) < 1e-12 * size);
            assert_eq!(kept.shape.carries, Carries::Corrections);
        }
        corrected.redo();
        corrected.drain();
        assert_eq!(*corrected.editor.document().from_file(), shape, "to the bit");
    }
}
