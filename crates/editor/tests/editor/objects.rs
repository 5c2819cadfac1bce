//! Objects of the file: hidden ones are neither picked nor painted but still move, locked ones keep their positions.
#![allow(clippy::unwrap_used, clippy::expect_used, reason = "a test that can't go on fails")]

use std::sync::Arc;

use crate::rig::{CENTRE_PX, Rig};
use glam::DVec3;
use pliant_deform::Role;
use pliant_editor::{
    Beginning, Command, Event, MeshReference, ObjectAction, Paint, RegionAction, SmallParts, StrokeShape, ToolMode,
    geometry_hash,
};
use pliant_mesh::{Drawn, Object, SurfaceVertex, shapes};

/// A ball within a larger one, two objects of one file; the outer is in two materials.
fn nested() -> (Drawn, Vec<Object>) {
    let (mut inner, outer) = (shapes::icosphere(3), shapes::icosphere(3));
    inner.positions.iter_mut().for_each(|p| *p *= 0.5);
    let count = inner.triangles.len() as u32;
    let object = |name: &str, material: &str, triangles| Object {
        name: name.to_owned(),
        material: material.to_owned(),
        triangles: std::iter::once(triangles).collect(),
    };
    let objects = vec![
        object("inner", "skin", 0..count),
        object("outer", "skin", count..count + count / 2),
        object("outer", "cloth", count + count / 2..2 * count),
    ];
    (shapes::together(&[inner, outer]), objects)
}

const OUTER: [u32; 2] = [1, 2];

fn open() -> Rig {
    let (drawn, objects) = nested();
    Rig::open_with_objects(drawn, objects)
}

fn objects(rig: &mut Rig, action: ObjectAction, objects: &[u32]) {
    rig.command(Command::Objects(action, objects.to_vec()));
    rig.drain();
}

/// The distance of the point under the view's middle from the balls' middle.
fn met(rig: &Rig) -> Option<f64> {
    Some(rig.editor.pick(CENTRE_PX)?.point.length())
}

#[test]
fn rays_meet_what_is_shown_and_undo_shows_it_again() {
    let mut rig = open();
    let first = rig.fingerprint();
    assert!(met(&rig).unwrap() > 0.9);
    objects(&mut rig, ObjectAction::Hide, &OUTER);
    assert!(met(&rig).unwrap() < 0.51, "the outer one is looked through");
    assert_eq!(rig.editor.view().undo, Some("Hide 2 objects"));
    let shown = rig.editor.shown_triangles().unwrap();
    assert_eq!(shown.iter().filter(|&&shown| shown).count(), shown.len() / 2);
    objects(&mut rig, ObjectAction::Hide, &[0]);
    assert_eq!(met(&rig), None);
    objects(&mut rig, ObjectAction::Solo, &OUTER);
    assert!(met(&rig).unwrap() > 0.9);
    objects(&mut rig, ObjectAction::Solo, &OUTER);
    assert!(rig.editor.shown_triangles().is_none(), "once more shows everything");
    for _ in 0..4 {
        rig.undo();
        rig.drain();
    }
    assert_eq!(first, rig.fingerprint());
    assert!(met(&rig).unwrap() > 0.9 && rig.editor.shown_triangles().is_none());
    rig.redo();
    rig.drain();
    assert!(met(&rig).unwrap() < 0.51);
}

#[test]
fn what_is_hidden_takes_no_paint_of_any_tool_and_moves_along() {
    let mut rig = open();
    let is_outer = |rig: &Rig, vertex: usize| rig.model.surface.positions[vertex].length() > 0.9;
    objects(&mut rig, ObjectAction::Hide, &OUTER);
    rig.command(Command::SetStrokeShape(StrokeShape::Lasso));
    rig.command(Command::SetDepth(pliant_editor::Depth::Through));
    rig.paint(
        ToolMode::PaintFixed,
        &[(-300.0, -300.0), (300.0, -300.0), (300.0, 300.0), (-300.0, 300.0)]
            .map(|(x, y)| CENTRE_PX + glam::DVec2::new(x, y)),
    );
    rig.drain();
    let painted = |rig: &Rig, paint: Paint| -> Vec<usize> {
        (0..rig.model.surface.positions.len())
            .filter(|&vertex| rig.editor.document().paint()[vertex] == paint)
            .collect()
    };
    let fixed = painted(&rig, Paint::Fixed);
    assert!(!fixed.is_empty() && fixed.iter().all(|&vertex| !is_outer(&rig, vertex)));
    rig.command(Command::Region(RegionAction::Invert));
    rig.command(Command::Region(RegionAction::EverythingBut));
    assert!(
        (0..rig.model.surface.positions.len())
            .all(|v| !is_outer(&rig, v) || rig.editor.document().paint()[v] == Paint::Bare)
    );
    rig.command(Command::ClearRegions);
    // The whole outer ball is a loose part around the inner one's handle: it follows, visible or not.
    rig.command(Command::SetStrokeShape(StrokeShape::Component));
    rig.paint(ToolMode::PaintHandle, &[CENTRE_PX]);
    let id = rig.editor.view().selected.unwrap();
    rig.command(Command::SetReach(id, pliant_editor::Reach::Length(2.0)));
    rig.drain();
    rig.move_by('x', ".2");
    rig.drain();
    let moved = rig.editor.document().from_file();
    assert!(
        moved.iter().all(|d| d.distance(DVec3::new(0.2, 0.0, 0.0)) < 1e-9),
        "{:?}",
        moved[0]
    );
}

#[test]
fn what_is_locked_stays_where_it_is_whatever_is_painted_on_it() {
    let mut rig = open();
    rig.command(Command::SetStrokeShape(StrokeShape::Component));
    rig.paint(ToolMode::PaintHandle, &[CENTRE_PX]);
    rig.drain();
    rig.move_by('x', ".1");
    rig.drain();
    let before = rig.drawn();
    objects(&mut rig, ObjectAction::Lock, &[2]);
    assert!(before == rig.drawn(), "locking moves nothing");
    let locked: Vec<usize> = (0..rig.editor.roles().len())
        .filter(|&vertex| rig.editor.roles()[vertex] == Role::Fixed)
        .collect();
    let cloth = rig.model.triangles_of_objects(|object| object == 2);
    for (vertex, is_cloth) in rig.model.vertices_of_triangles(&cloth).into_iter().enumerate() {
        assert!(!is_cloth || locked.contains(&vertex));
    }
    rig.move_by('y', ".1");
    rig.drain();
    let after = rig.drawn();
    assert!(before != after, "the rest of the handle moves");
    for (drawn, surface) in rig.model.drawn.surface_vertices().enumerate() {
        let is_locked = surface.is_some_and(|vertex| locked.contains(&vertex.index()));
        assert!(!is_locked || before[drawn] == after[drawn]);
    }
    // A handle with all vertices locked gives a message and stays.
    objects(&mut rig, ObjectAction::Lock, &[1]);
    let before = rig.fingerprint();
    rig.move_by('z', ".3");
    rig.drain();
    assert!(rig.editor.view().problem.unwrap().contains("locked object"));
    assert_eq!(before, rig.fingerprint());
    // A brush gives a message too.
    rig.command(Command::SetStrokeShape(StrokeShape::Brush));
    rig.paint(ToolMode::PaintFixed, &[CENTRE_PX]);
    assert!(rig.editor.view().problem.unwrap().contains("locked"));
    assert_eq!(before, rig.fingerprint());
}

#[test]
fn a_part_is_isolated_under_the_pointer_and_a_project_keeps_what_is_hidden_and_locked() {
    let mut rig = open();
    rig.move_to(CENTRE_PX);
    rig.type_keys("/");
    rig.drain();
    assert!(met(&rig).unwrap() > 0.9);
    let shown = rig.editor.shown_triangles().unwrap();
    assert_eq!(
        shown.iter().filter(|&&shown| shown).count(),
        shown.len() / 2,
        "the outer part alone"
    );
    rig.type_keys("/");
    rig.drain();
    assert!(rig.editor.shown_triangles().is_none());
    rig.type_keys("h");
    rig.drain();
    objects(&mut rig, ObjectAction::Lock, &[0]);
    let access = rig.editor.document().access().clone();
    assert!(access.hidden.len() == 1 && access.locked.len() == 1);
    let reference = MeshReference {
        name: None,
        path: None,
        geometry: geometry_hash(&rig.model),
    };
    let project = rig.editor.snapshot().unwrap().project(reference);
    let text = project.to_json();
    assert!(
        text.contains("\"outer\"") && text.contains("\"locked\": true"),
        "{text}"
    );
    let first = rig.fingerprint();
    rig.editor.handle(Event::Opened {
        model: Arc::clone(&rig.model),
        name: "again".to_owned(),
        beginning: Some(Beginning::parse(&text).unwrap()),
    });
    rig.drain();
    assert_eq!(*rig.editor.document().access(), access);
    assert_eq!(first, rig.fingerprint());
    assert!(rig.editor.shown_triangles().is_some());
    // The command line fixes locked objects.
    let setup = Beginning::parse(&text).unwrap().resolve(&rig.model).unwrap();
    assert!(setup.roles.iter().all(|role| *role == Role::Fixed));
    let broken = text.replace("\"object\": 0", "\"object\": 9");
    let refused = Beginning::parse(&broken).unwrap().resolve(&rig.model).unwrap_err();
    assert!(refused.to_string().contains("number 9"), "{refused}");
}

/// A ball with debris around it: two parts of 42 vertices, one of them in the ball's path, and twenty of 12.
fn with_debris() -> Drawn {
    let ball = shapes::icosphere(4);
    let mut parts = vec![ball];
    for (number, at) in [DVec3::new(0.0, 1.2, 0.0), DVec3::new(0.0, -1.2, 0.0)]
        .into_iter()
        .enumerate()
    {
        let mut bit = shapes::icosphere(1);
        bit.positions
            .iter_mut()
            .for_each(|p| *p = 0.05 * (1.0 + number as f64) * *p + at);
        parts.push(bit);
    }
    for number in 0..20 {
        let angle = f64::from(number);
        let mut bit = shapes::icosphere(0);
        let at = 1.4 * DVec3::new(angle.cos(), 0.0, angle.sin());
        bit.positions.iter_mut().for_each(|p| *p = 0.01 * *p + at);
        parts.push(bit);
    }
    shapes::together(&parts)
}

#[test]
fn small_parts_are_hidden_and_held_still_by_their_size() {
    let mut rig = Rig::open_with_objects(with_debris(), Vec::new());
    let shown = |rig: &Rig| {
        let shown = rig.editor.shown_triangles();
        shown.map_or(rig.model.drawn.triangle_count(), |shown| {
            shown.iter().filter(|&&shown| shown).count()
        })
    };
    let (ball, middle, tiny) = (20 * 256, 2 * 80, 20 * 20);
    assert_eq!(shown(&rig), ball + middle + tiny);
    rig.command(Command::ToggleSmallShown);
    rig.drain();
    assert_eq!(
        shown(&rig),
        ball + middle,
        "12 of 2562 vertices are less than a hundredth, 42 are not"
    );
    let set = |rig: &mut Rig, change: &dyn Fn(&mut SmallParts)| {
        let mut small = rig.editor.document().access().small;
        change(&mut small);
        rig.command(Command::SetSmallParts(small));
        rig.drain();
    };
    set(&mut rig, &|small| small.share = 0.05);
    assert_eq!(shown(&rig), ball);
    assert_eq!(rig.editor.view().undo, Some("Size of small parts"));
    let roles = |rig: &Rig| {
        let edit = rig.editor.edit_file().unwrap();
        Beginning::from(edit).resolve(&rig.model).unwrap().roles
    };
    // All of the ball except a spot is free, and small parts are fixed all the same once they are locked.
    rig.command(Command::ShowEverything);
    rig.drain();
    rig.command(Command::SetStrokeShape(StrokeShape::Brush));
    rig.paint(ToolMode::PaintFixed, &[CENTRE_PX]);
    assert_eq!(rig.editor.view().problem, None);
    rig.command(Command::Region(RegionAction::EverythingBut));
    assert_eq!(rig.editor.view().problem, None);
    rig.paint(ToolMode::PaintHandle, &[CENTRE_PX]);
    rig.drain();
    assert_eq!(shown(&rig), ball + middle + tiny);
    let is_small = rig.model.small_parts(0.05);
    let fixed_of_small = |rig: &Rig| {
        let small: Vec<bool> = (0..)
            .zip(roles(rig))
            .filter(|(vertex, _)| is_small[rig.model.topology.component(SurfaceVertex(*vertex)) as usize])
            .map(|(_, role)| role == Role::Fixed)
            .collect();
        assert_eq!(small.len(), 2 * 42 + 20 * 12);
        small.iter().filter(|is_fixed| **is_fixed).count()
    };
    assert_eq!(fixed_of_small(&rig), 0);
    set(&mut rig, &|small| (small.hidden, small.locked) = (true, true));
    assert_eq!(fixed_of_small(&rig), 2 * 42 + 20 * 12);
    rig.command(Command::ShowEverything);
    rig.drain();
    assert_eq!(
        fixed_of_small(&rig),
        2 * 42 + 20 * 12,
        "what is seen again is still held"
    );
    // A project keeps it; an invalid share is refused.
    let reference = MeshReference {
        name: None,
        path: None,
        geometry: geometry_hash(&rig.model),
    };
    let text = rig.editor.snapshot().unwrap().project(reference).to_json();
    let again = Beginning::parse(&text).unwrap().resolve(&rig.model).unwrap();
    assert_eq!(again.roles, roles(&rig));
    let broken = text.replace("\"share\": 0.05", "\"share\": 5");
    let refused = Beginning::parse(&broken).unwrap().resolve(&rig.model).unwrap_err();
    assert!(refused.to_string().contains("small_parts"), "{refused}");
    for _ in 0..9 {
        rig.command(Command::Undo);
    }
    rig.drain();
    assert_eq!(shown(&rig), ball + middle + tiny);
    assert!(!rig.editor.document().access().small.locked);
}
