//! Morph targets that turn with the surface.
//!
//! A target's deltas are displacements from the former surface: where that turns far, a smile points through the cheek.
//! So the deltas of a mesh turn with it if any of them would otherwise be wrong by more than [`MOST_OFF`] degrees,
//! unless the save chooses. Targets that are applied by default keep the shape: the base takes up the difference.

use std::collections::BTreeSet;

use glam::{DMat3, DVec3, Vec3};
use pliant_mesh::DrawnVertex;
use rayon::prelude::*;

use crate::gltf::document::Document;
use crate::gltf::geometry::primitive::Primitive;
use crate::gltf::geometry::{Instance, Pieces};
use crate::save::MorphDeltas;
use crate::save::frames::Frames;
use crate::save::moved::Moved;

/// The largest error of deltas, in degrees.
const MOST_OFF: f64 = 30.0;

/// For each instance, the turn of each element's deltas, in the mesh's space; `None` if they stay.
pub(crate) fn turns(
    document: &Document,
    meshes: &[Vec<Primitive>],
    pieces: &Pieces,
    moved: &Moved<'_>,
    frames: &Frames,
    deltas: MorphDeltas,
) -> Vec<Option<Vec<DMat3>>> {
    if deltas == MorphDeltas::Stay {
        return Vec::new();
    }
    let of_instance = |instance: &Instance| {
        let primitive = &meshes[instance.mesh][instance.primitive];
        let mut vertices = instance.vertices.clone().map(DrawnVertex);
        let is_turned = !primitive.targets.is_empty() && vertices.any(|vertex| frames.gradient(vertex).is_some());
        is_turned.then(|| turns_of_instance(instance, moved, frames))
    };
    let turns: Vec<Option<Vec<DMat3>>> = pieces.instances.iter().map(of_instance).collect();
    // All primitives that a node shows turn, or none, so that they don't part.
    let place = |instance: &Instance| (instance.node, instance.copy);
    let pairs = || pieces.instances.iter().zip(&turns);
    let turning: BTreeSet<(usize, usize)> = pairs()
        .filter_map(|(instance, turns)| Some((instance, turns.as_ref()?)))
        .filter(|(instance, turns)| {
            deltas == MorphDeltas::Turn || are_off(document, &meshes[instance.mesh][instance.primitive], turns)
        })
        .map(|(instance, _)| place(instance))
        .collect();
    let instances = pieces.instances.iter();
    let kept = instances
        .zip(turns)
        .map(|(instance, turns)| turns.filter(|_| turning.contains(&place(instance))));
    kept.collect()
}

fn turns_of_instance(instance: &Instance, moved: &Moved<'_>, frames: &Frames) -> Vec<DMat3> {
    let linear = instance.pose.linear();
    let of_vertex = |vertex: u32| {
        let vertex = DrawnVertex(vertex);
        let gradient = frames.gradient(vertex).filter(|_| moved.moves(vertex))?;
        let linear = linear.at((vertex.0 - instance.vertices.start) as usize)?;
        // The turn as seen in world space: in the mesh's own space, which a skin or a node may shear, it is not a
        // rotation.
        Some(linear.mesh_from_world * rotation(gradient)? * linear.world_from_mesh)
    };
    let turns = instance.vertices.clone().into_par_iter();
    turns
        .map(|vertex| of_vertex(vertex).unwrap_or(DMat3::IDENTITY))
        .collect()
}

/// The rotation nearest to a gradient (its polar factor, by Newton's iteration); `None` if the gradient mirrors or
/// flattens.
fn rotation(gradient: DMat3) -> Option<DMat3> {
    if gradient.determinant() <= 0.0 {
        return None;
    }
    let mut rotation = gradient;
    for _ in 0..40 {
        let next = (rotation + rotation.inverse().transpose()) * 0.5;
        let change = (next - rotation)
            .to_cols_array()
            .into_iter()
            .fold(0.0, |most: f64, x| most.max(x.abs()));
        rotation = next;
        if change < 1e-12 {
            break;
        }
    }
    rotation.is_finite().then_some(rotation)
}

/// Returns true if a delta of the primitive's targets turns too far to stay.
fn are_off(document: &Document, primitive: &Primitive, turns: &[DMat3]) -> bool {
    let least = 1.0 + 2.0 * MOST_OFF.to_radians().cos();
    let is_far = |turn: &DMat3| turn.x_axis.x + turn.y_axis.y + turn.z_axis.z < least;
    let positions = primitive.targets.iter().filter_map(|target| target.position);
    positions
        .filter_map(|accessor| document.layout(accessor).ok())
        .any(|layout| {
            let ways = layout.floats::<3>(document);
            turns
                .iter()
                .zip(&ways)
                .any(|(turn, way)| *way != [0.0; 3] && is_far(turn))
        })
}

/// The distance by which the targets that an instance applies by default, once turned, would move each element: the
/// base goes back by it.
pub(crate) fn shifts(document: &Document, primitive: &Primitive, instance: &Instance, turns: &[DMat3]) -> Vec<DVec3> {
    let mut shifts = vec![DVec3::ZERO; turns.len()];
    for &(target, weight) in &instance.weights {
        let Some(layout) = primitive.targets[target]
            .position
            .and_then(|accessor| document.layout(accessor).ok())
        else {
            continue;
        };
        for ((shift, turn), way) in shifts.iter_mut().zip(turns).zip(layout.floats::<3>(document)) {
            let way = Vec3::from_array(way).as_dvec3();
            *shift += (*turn * way - way) * weight;
        }
    }
    shifts
}
