//! Meshes with holes, and new meshes made by hand, as the window makes them by the engine.

use std::collections::BTreeSet;
use std::sync::Arc;

use glam::{DAffine3, DVec3};
use pliant_deform::Budget;
use pliant_editor::{Event, MeshChange, StitchRequest};
use pliant_mesh::{Cancel, Drawn, DrawnVertex, FileVertex, Model, SurfaceVertex, shapes};

use super::{Fingerprint, Rig, weld};

/// A ball without its triangles below a plane: it has one hole.
pub fn bowl() -> Drawn {
    let mut ball = shapes::icosphere(3);
    let height = ball.positions.clone();
    ball.triangles
        .retain(|corners| corners.iter().any(|corner| height[corner.index()].y > -0.6));
    used(ball)
}

/// Meshes with holes, of several classes.
pub fn open_shapes() -> Vec<(&'static str, Drawn)> {
    let lid = shapes::moved(&bowl(), DAffine3::from_translation(DVec3::X * 2.5));
    vec![
        ("a bowl", bowl()),
        ("a tube", used(shapes::tube(16, 12, 2.0))),
        ("a sheet", shapes::grid(16, 16)),
        ("two bowls", shapes::together(&[bowl(), lid])),
        ("a bowl with broken triangles", shapes::broken(&bowl())),
    ]
}

/// The same without unused vertices.
pub fn used(shape: Drawn) -> Drawn {
    let is_used: BTreeSet<u32> = shape.triangles.iter().flatten().map(|corner| corner.0).collect();
    let number: Vec<u32> = is_used.iter().copied().collect();
    let place = |old: DrawnVertex| DrawnVertex(number.binary_search(&old.0).unwrap() as u32);
    Drawn {
        positions: number.iter().map(|&old| shape.positions[old as usize]).collect(),
        triangles: shape.triangles.iter().map(|corners| corners.map(place)).collect(),
        file_vertex: (0..number.len() as u32).map(FileVertex).collect(),
        file_vertex_count: number.len(),
        ..Drawn::default()
    }
}

/// The present shape of the surface, to be changed by hand.
pub fn present(request: &StitchRequest, model: &Model) -> Drawn {
    let surface = &model.surface;
    let shown = surface.positions.iter().zip(request.displacements());
    let count = surface.positions.len();
    let drawn = |vertex: SurfaceVertex| DrawnVertex(vertex.0);
    Drawn {
        positions: shown.map(|(rest, displacement)| *rest + *displacement).collect(),
        triangles: surface.triangles.iter().map(|corners| corners.map(drawn)).collect(),
        file_vertex: (0..count as u32).map(FileVertex).collect(),
        file_vertex_count: count,
        ..Drawn::default()
    }
}

/// Closes every hole by a fan around a point beside its middle, where no other vertex is.
pub fn closed(mut shape: Drawn, model: &Model) -> Drawn {
    for rim in model.topology.boundary_loops() {
        let apex = DrawnVertex(shape.positions.len() as u32);
        let sum: DVec3 = rim.iter().map(|vertex| shape.positions[vertex.index()]).sum();
        let beside = DVec3::new(0.031, 0.071, 0.113);
        shape.positions.push(sum / rim.len() as f64 + beside);
        shape.file_vertex.push(FileVertex(apex.0));
        for (place, from) in rim.iter().enumerate() {
            let to = rim[(place + 1) % rim.len()];
            shape.triangles.push([DrawnVertex(from.0), DrawnVertex(to.0), apex]);
        }
    }
    shape.file_vertex_count = shape.positions.len();
    shape
}

/// Gives the editor the mesh that it has asked for, made by hand.
pub fn answer(rig: &mut Rig) {
    answer_with(rig, |shape| (*weld(shape)).clone());
}

/// The same with the model that `model` makes of the new shape.
pub fn answer_with(rig: &mut Rig, model: impl FnOnce(Drawn) -> Model) {
    let request = rig.editor.take_stitch().expect("a change was asked for");
    let shape = new_shape(&request, &rig.model);
    let made = request.onto(Arc::new(model(shape)), None, Budget::default(), &Cancel::new());
    rig.send(Event::Stitched(Ok(Box::new(made.unwrap()))));
    follow(rig);
    rig.drain();
}

fn new_shape(request: &StitchRequest, model: &Model) -> Drawn {
    let shape = present(request, model);
    match &request.change {
        MeshChange::Delete(vertices) => {
            let gone: BTreeSet<u32> = vertices.iter().map(|vertex| vertex.0).collect();
            let mut left = shape;
            left.triangles
                .retain(|corners| !corners.iter().any(|corner| gone.contains(&corner.0)));
            used(left)
        }
        MeshChange::Append(_) => {
            let beside = DAffine3::from_translation(DVec3::X * 2.2);
            shapes::together(&[shape, shapes::moved(&bowl(), beside)])
        }
        _ => closed(shape, model),
    }
}

/// The rig's own mesh is the editor's.
pub fn follow(rig: &mut Rig) {
    rig.model = Arc::clone(rig.editor.view().model.unwrap());
}

/// The document and its mesh.
pub fn state(rig: &Rig) -> (Fingerprint, *const Model) {
    (rig.fingerprint(), Arc::as_ptr(rig.editor.view().model.unwrap()))
}
