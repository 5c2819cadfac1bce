//! The behaviour of single parts that nothing holds, and the continuity of each handle: in the document, its history
//! and its files.
#![allow(clippy::unwrap_used, clippy::expect_used, reason = "a test that can't go on fails")]

use std::sync::Arc;

use crate::rig::{CENTRE_PX, Rig};
use glam::DVec3;
use pliant_deform::{Loose, Method};
use pliant_editor::{Beginning, Command, EditFile, Event, MeshReference, StrokeShape, ToolMode, geometry_hash};
use pliant_mesh::{SurfaceVertex, shapes};

/// A large ball before the eye, and a small one behind it.
fn two_balls() -> Rig {
    let mut small = shapes::icosphere(2);
    for position in &mut small.positions {
        *position = *position * 0.2 + DVec3::new(0.0, 0.0, -1.5);
    }
    let mut rig = Rig::open(shapes::together(&[shapes::icosphere(3), small]));
    rig.command(Command::SetMethod(Method::from_name("bilaplacian").unwrap()));
    rig.drain();
    rig
}

#[test]
fn each_loose_part_does_what_it_is_told_and_files_keep_it() {
    let mut rig = two_balls();
    rig.command(Command::SetStrokeShape(StrokeShape::Component));
    rig.paint(ToolMode::PaintHandle, &[CENTRE_PX]);
    rig.drain();
    // Only the small ball is so far behind.
    let behind = rig.model.surface.positions.iter().position(|p| p.z < -1.1).unwrap();
    let small = rig.model.topology.component(SurfaceVertex(behind as u32));
    let way = |rig: &Rig| rig.editor.document().from_file()[behind];
    assert_eq!(rig.editor.loose_components(), [small]);
    rig.move_by('x', ".3");
    rig.drain();
    assert!((way(&rig) - DVec3::new(0.3, 0.0, 0.0)).length() < 1e-9, "it follows");
    rig.command(Command::SetLoosePart(small, Some(Loose::Rest)));
    rig.drain();
    assert_eq!(way(&rig), DVec3::ZERO);
    rig.command(Command::SetLoose(Loose::Rest));
    rig.command(Command::SetLoosePart(small, Some(Loose::Bend)));
    rig.drain();
    assert!(
        (way(&rig) - DVec3::new(0.3, 0.0, 0.0)).length() < 1e-9,
        "it bends along with what moves as one"
    );
    let colours = |rig: &Rig| {
        let mut colours = Vec::new();
        rig.editor.region_colours(&mut colours);
        colours
    };
    let before = colours(&rig);
    rig.command(Command::LightPart(Some(small)));
    for (vertex, (now, before)) in (0..).zip(colours(&rig).iter().zip(&before)) {
        let is_lit = rig.model.topology.component(SurfaceVertex(vertex)) == small;
        assert_eq!(now != before, is_lit, "the part is lit up, and nothing else");
    }
    rig.command(Command::LightPart(None));
    assert!(colours(&rig) == before);
    let last = rig.fingerprint();
    let edit = rig.editor.edit_file().unwrap();
    assert_eq!((edit.loose, edit.loose_parts.len()), (Loose::Rest, 1));
    let again = EditFile::parse(&edit.to_json()).unwrap();
    assert_eq!(again.resolve(&rig.model).unwrap().loose_parts, [(small, Loose::Bend)]);
    assert_eq!(edit, again);
    for _ in 0..3 {
        rig.undo();
        rig.drain();
    }
    assert!((way(&rig) - DVec3::new(0.3, 0.0, 0.0)).length() < 1e-9);
    assert!(rig.editor.document().loose_parts().is_empty());
    for _ in 0..3 {
        rig.redo();
        rig.drain();
    }
    assert_eq!(last, rig.fingerprint());
    reopened(&mut rig);
    assert_eq!(last, rig.fingerprint());
    assert_eq!(rig.editor.document().loose_parts().get(&small), Some(&Loose::Bend));
    rig.command(Command::SetLoosePart(99, Some(Loose::Bend)));
    assert!(
        rig.editor
            .view()
            .problem
            .is_some_and(|sentence| sentence.contains("2 parts"))
    );
}

#[test]
fn each_handle_has_its_own_joint_and_files_keep_it() {
    let mut rig = two_balls();
    rig.paint_handle();
    rig.drain();
    rig.move_by('z', ".3");
    rig.drain();
    let smooth = rig.drawn();
    let id = rig.editor.view().selected.unwrap();
    rig.command(Command::SetContinuity(id, Some(0.0)));
    rig.drain();
    let hinge = rig.drawn();
    assert!(smooth != hinge, "a hinge bends otherwise");
    rig.assert_as_meant("a hinge");
    let edit = rig.editor.edit_file().unwrap();
    assert_eq!(edit.handles[0].continuity, Some(0.0));
    let text = edit.to_json();
    let first = rig.fingerprint();
    reopened(&mut rig);
    assert_eq!(first, rig.fingerprint());
    rig.undo();
    rig.drain();
    // The edit alone gives the same shape, and its handle can be made smooth again.
    rig.editor.handle(Event::Opened {
        model: Arc::clone(&rig.model),
        name: "again".to_owned(),
        beginning: Some(Beginning::parse(&text).unwrap()),
    });
    rig.drain();
    assert!(farthest(&rig.drawn(), &hinge) < 1e-9);
    let id = rig.editor.view().selected.unwrap();
    rig.command(Command::SetContinuity(id, None));
    rig.drain();
    assert!(farthest(&rig.drawn(), &smooth) < 1e-9);
    rig.command(Command::SetContinuity(id, Some(7.0)));
    assert!(
        rig.editor
            .view()
            .problem
            .is_some_and(|sentence| sentence.contains("hinge"))
    );
}

/// The largest distance of drawn positions.
fn farthest(a: &[[u64; 3]], b: &[[u64; 3]]) -> f64 {
    let place = |bits: &[u64; 3]| DVec3::from_array(bits.map(f64::from_bits));
    a.iter()
        .zip(b)
        .map(|(a, b)| place(a).distance(place(b)))
        .fold(0.0, f64::max)
}

/// The project of the open document, opened again.
fn reopened(rig: &mut Rig) {
    let reference = MeshReference {
        name: None,
        path: None,
        geometry: geometry_hash(&rig.model),
    };
    let text = rig.editor.snapshot().unwrap().project(reference).to_json();
    rig.editor.handle(Event::Opened {
        model: Arc::clone(&rig.model),
        name: "again".to_owned(),
        beginning: Some(Beginning::parse(&text).unwrap()),
    });
    rig.drain();
}

#[test]
fn a_turn_counts_on_past_half_a_turn_by_keys_by_the_pointer_and_by_numbers() {
    let mut rig = two_balls();
    rig.paint_handle();
    rig.drain();
    let id = rig.editor.view().selected.unwrap();
    let counted = |rig: &Rig| rig.editor.document().handle(id).unwrap().turn_deg;
    for total in [200.0, 400.0] {
        rig.type_keys("rz200");
        rig.key(pliant_editor::Key::Enter);
        rig.drain();
        assert!(
            (counted(&rig) - DVec3::new(0.0, 0.0, total)).length() < 1e-6,
            "{}",
            counted(&rig)
        );
    }
    rig.undo();
    assert!((counted(&rig).z - 200.0).abs() < 1e-6);
    rig.command(Command::SetTurn(id, DVec3::new(0.0, 0.0, 270.0)));
    rig.drain();
    assert_eq!(counted(&rig), DVec3::new(0.0, 0.0, 270.0));
    let affine = rig.editor.document().handle(id).unwrap().affine();
    assert!((affine.matrix3 * DVec3::X - DVec3::NEG_Y).length() < 1e-9);
    let first = rig.fingerprint();
    reopened(&mut rig);
    assert_eq!(first, rig.fingerprint());
    rig.command(Command::ResetHandle);
    rig.drain();
    assert_eq!(counted(&rig), DVec3::ZERO);
}
