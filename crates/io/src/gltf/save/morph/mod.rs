//! Edits saved as morph targets: the shape does not change, and each primitive of the edited meshes gets displacements
//! to the edited shape, or to the shapes of an animation.
//!
//! Everything with one weight per target gets more of them: the mesh's weights and names, the weights of its nodes, and
//! their animations.

mod animated;
mod animation;
mod deltas;
mod maker;
mod nodes;
mod ways;
mod weights;

use crate::gltf::document::Document;
use crate::gltf::geometry::Pieces;
use crate::gltf::geometry::primitive::Primitive;
use crate::gltf::save::changes::{InstanceChange, changes};
use crate::gltf::save::copy_on_write::{self, MeshCopy};
use crate::gltf::save::patch::Patched;
use crate::gltf::save::turned_triangles::Turned;
use crate::save::animation::Unsigned;
use crate::save::course::Course;
use crate::save::moved::Moved;
use crate::save::{MorphAnimation, MorphDeltas, MorphTarget};
use crate::{Format, SaveError};
use animation::WeightCourse;
use deltas::{Deltas, NewTarget};
use maker::TargetMaker;

/// The document with the changes as a morph target.
pub(crate) fn with_target<'a>(
    document: &'a Document,
    meshes: &[Vec<Primitive>],
    pieces: &Pieces,
    changes: &[InstanceChange],
    target: &MorphTarget<'_>,
    format: Format,
    course: &Course<'_>,
) -> Result<Patched<'a>, SaveError> {
    let (of_plan, course) = course.split(0.3);
    let copies = planned(document, meshes, pieces, changes, &of_plan)?;
    let instances = pieces.instances.iter().zip(changes);
    let deltas = instances.map(|(instance, change)| {
        let primitive = &meshes[instance.mesh][instance.primitive];
        Deltas::of_change(document, primitive, change, format)
    });
    let targets = [NewTarget {
        name: target.name.to_owned(),
        weight: target.weight,
        of_instances: deltas.collect::<Result<_, SaveError>>()?,
    }];
    TargetMaker::new(document, meshes, &targets, None, format).finished(&copies, changes, &course)
}

/// The document with an animation of morph targets. `moved` is the shape at rest.
pub(crate) fn with_animation<'a>(
    document: &'a Document,
    meshes: &[Vec<Primitive>],
    pieces: &Pieces,
    moved: &Moved<'_>,
    animation: &MorphAnimation<'_>,
    format: Format,
    course: &Course<'_>,
) -> Result<Patched<'a>, SaveError> {
    let (of_deltas, course) = course.split(0.7);
    let of_instances = deltas::of_animation((document, meshes, pieces), moved.drawn, animation, format, &of_deltas)?;
    let Unsigned { weights, shares } = animation.unsigned();
    let named = animation.target_names().into_iter().zip(&shares);
    let targets: Vec<NewTarget> = named
        .map(|(name, shares)| NewTarget {
            name,
            weight: 0.0,
            of_instances: deltas::mixed(&of_instances, shares),
        })
        .collect();
    drop(of_instances);
    let course_of_weights = WeightCourse {
        name: animation.name,
        times: animation.times,
        weights: &weights,
        holds: animation.holds,
    };
    let (of_plan, course) = course.split(0.3);
    // Nodes that share a mesh need meshes of their own if any of their targets differ. Those of a shape with all
    // targets, by weights in no simple proportion, differ then too.
    let mixed = animation.mixed(&moved.drawn.positions);
    let mixed = Moved::of(moved.drawn, &mixed, &[], format)?;
    let mixed = changes(
        document,
        meshes,
        pieces,
        &mixed,
        MorphDeltas::Stay,
        &of_plan.part(0.0, 0.5),
    )?;
    let copies = planned(document, meshes, pieces, &mixed, &of_plan.part(0.5, 1.0))?;
    TargetMaker::new(document, meshes, &targets, Some(course_of_weights), format).finished(&copies, &mixed, &course)
}

/// The meshes that the changes need.
fn planned(
    document: &Document,
    meshes: &[Vec<Primitive>],
    pieces: &Pieces,
    changes: &[InstanceChange],
    course: &Course<'_>,
) -> Result<Vec<MeshCopy>, SaveError> {
    let hashes = copy_on_write::hashes(changes);
    let unturned = Turned::new();
    let copies = copy_on_write::plan_meshes(document, meshes, pieces, (changes, &unturned), &hashes, course)?;
    Ok(copies)
}
