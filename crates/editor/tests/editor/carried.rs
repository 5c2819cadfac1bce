//! Hidden and locked objects and the methods' examples stay when the mesh is filled, cut or joined, as far as their
//! triangles do; what can't stay is named.

use std::sync::Arc;

use glam::{DAffine3, DVec3};
use pliant_deform::{Attachment, Budget, ExampleShape};
use pliant_editor::{Command, Document, MeshChange, ObjectAction};
use pliant_mesh::{Cancel, Drawn, DrawnVertex, Model, Object, SurfaceVertex, shapes};

use crate::rig::new_mesh::{answer, answer_with, bowl, closed, follow, present};
use crate::rig::{Rig, weld};

/// A new shape whose triangles are in the order of these numbers, each of which is an object.
fn in_objects(mut shape: Drawn, number: impl Fn(DrawnVertex, DVec3) -> usize) -> Model {
    let at = shape.positions.clone();
    let of = |corners: &[DrawnVertex; 3]| number(corners[0], at[corners[0].index()]);
    shape.triangles.sort_by_key(of);
    let numbers: Vec<usize> = shape.triangles.iter().map(of).collect();
    let runs = numbers.chunk_by(|a, b| a == b).scan(0, |start, run| {
        let begin = *start;
        *start += run.len() as u32;
        Some(object(begin..*start))
    });
    let runs = runs.collect();
    Arc::unwrap_or_clone(weld(shape)).with_objects(runs)
}

fn is_left(at: DVec3) -> usize {
    usize::from(at.x < 1.25)
}

fn object(run: std::ops::Range<u32>) -> Object {
    Object {
        triangles: vec![run],
        ..Object::default()
    }
}

#[test]
fn hidden_and_locked_objects_stay_so_and_what_is_appended_is_shown() {
    let left = bowl();
    let right = shapes::moved(&bowl(), DAffine3::from_translation(DVec3::X * 2.5));
    let count = left.triangles.len() as u32;
    let objects = [0..count, count..2 * count].map(object);
    let mut rig = Rig::open_with_objects(shapes::together(&[left, right]), objects.to_vec());
    rig.command(Command::Objects(ObjectAction::Hide, vec![0]));
    rig.command(Command::Objects(ObjectAction::Lock, vec![1]));
    rig.drain();
    rig.command(Command::FillHoles);
    answer_with(&mut rig, |shape| in_objects(shape, |_, at| is_left(at)));
    let of = |document: &Document| {
        let access = document.access();
        let numbers = |of: &std::collections::BTreeSet<u32>| of.iter().copied().collect::<Vec<_>>();
        (numbers(&access.hidden), numbers(&access.locked))
    };
    assert_eq!(
        of(rig.editor.document()),
        (vec![1], vec![0]),
        "the left one comes second now"
    );

    let count = rig.model.surface.positions.len();
    rig.command(Command::ChangeMesh(MeshChange::Append("third".to_owned())));
    answer_with(&mut rig, |shape| {
        in_objects(shape, |corner, at| if corner.index() < count { is_left(at) } else { 2 })
    });
    assert_eq!(of(rig.editor.document()), (vec![1], vec![0]), "the third is shown");
}

/// The displacements of the only example.
fn example(document: &Document) -> Arc<Vec<DVec3>> {
    let found = document.attachments().values().find_map(|own| match own {
        Attachment::Shapes(examples) => examples.shapes.first(),
        _ => None,
    });
    Arc::clone(&found.unwrap().displacements)
}

#[test]
fn examples_go_on_in_new_triangles_and_rest_in_an_appended_part() {
    let way = DVec3::new(0.1, -0.2, 0.05);
    let mut rig = Rig::open(bowl());
    rig.choose("shells");
    let count = rig.model.surface.positions.len();
    rig.command(Command::AddExample(ExampleShape {
        name: "moved".to_owned(),
        displacements: Arc::new(vec![way; count]),
    }));
    rig.drain();
    // A new vertex in the middle of what moves as a whole moves as well.
    rig.command(Command::FillHoles);
    answer(&mut rig);
    let after = example(rig.editor.document());
    assert!(after.len() > count);
    let farthest = after.iter().map(|own| own.distance(way)).fold(0.0, f64::max);
    assert!(farthest < 1e-9, "{farthest}");
    assert!(
        after[..count].iter().all(|own| *own == way),
        "old vertices keep theirs to the bit"
    );

    let count = rig.model.surface.positions.len();
    rig.command(Command::ChangeMesh(MeshChange::Append("lid".to_owned())));
    answer(&mut rig);
    let after = example(rig.editor.document());
    assert!(after[..count].iter().all(|own| own.distance(way) < 1e-9));
    assert!(after.len() > count && after[count..].iter().all(|own| *own == DVec3::ZERO));
}

#[test]
fn a_handle_that_goes_with_its_last_vertex_is_named() {
    let mut rig = Rig::open(bowl());
    rig.paint_handle();
    rig.drain();
    let name = rig.editor.document().handles()[0].name.clone();
    rig.command(Command::DeleteRegion);
    let request = rig.editor.take_stitch().unwrap();
    let MeshChange::Delete(vertices) = &request.change else {
        panic!("{:?}", request.change)
    };
    let gone: Vec<SurfaceVertex> = vertices.clone();
    let mut shape = present(&request, &rig.model);
    shape
        .triangles
        .retain(|corners| !corners.iter().any(|corner| gone.contains(&SurfaceVertex(corner.0))));
    let made = request.onto(
        weld(crate::rig::new_mesh::used(shape)),
        None,
        Budget::default(),
        &Cancel::new(),
    );
    let lost = made.unwrap().lost().join(" ");
    assert!(lost.contains(&name), "{lost}");
}

#[test]
fn the_way_back_to_the_former_mesh_keeps_the_later_edit() {
    for (case, shape) in crate::rig::new_mesh::open_shapes() {
        let mut rig = Rig::open(shape);
        rig.paint_handle();
        rig.move_by('x', "0.3");
        rig.drain();
        let bent = rig.editor.document().from_file().to_vec();
        let before = Arc::clone(&rig.model);
        rig.command(Command::FillHoles);
        let request = rig.editor.take_stitch().unwrap();
        let new = weld(closed(present(&request, &rig.model), &rig.model));
        let made = request.onto(new, None, Budget::default(), &Cancel::new()).unwrap();
        let former = made.former().clone();
        rig.send(pliant_editor::Event::Stitched(Ok(Box::new(made))));
        follow(&mut rig);
        rig.drain();
        let back = former.restore(&rig.editor.snapshot().unwrap()).unwrap();
        assert!(Arc::ptr_eq(back.model(), &before), "{case}");
        assert!(
            back.displacements()
                .iter()
                .zip(&bent)
                .all(|(now, then)| now.distance(*then) < 1e-9),
            "{case}"
        );
    }
}
