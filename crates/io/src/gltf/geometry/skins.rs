//! Skins: the places where joints put the vertices of a mesh, in the nodes' stored pose.
//!
//! A vertex's transform is Σ wⱼ Jⱼ Bⱼ / Σ wⱼ over its joints: J is the joint's world transform and B its inverse bind
//! matrix. The node that shows the mesh has no influence.

use std::sync::Arc;

use glam::{DAffine3, DMat3, DMat4, DVec3};
use rayon::prelude::*;

use crate::gltf::document::Document;
use crate::gltf::document::json::At;
use crate::gltf::geometry::primitive::Primitive;

/// The number of vertices for one task.
const CHUNK: usize = 1 << 13;

/// A skin in its stored pose: for each joint, the transform of the vertices bound to it.
pub(crate) type Skin = Arc<Vec<DAffine3>>;

/// The skin of a node's mesh; `None` if the node names none. `world` has the world transform of each node.
///
/// # Errors
/// The reason why the skin can't be read, as the end of a sentence.
pub(crate) fn of_node(document: &Document, node: At, world: &[DAffine3]) -> Result<Option<Skin>, String> {
    let json = &document.json;
    let list = json.member(json.root(), "skins");
    let skins: Vec<At> = list.into_iter().flat_map(|list| json.elements(list)).collect();
    let Some(skin) = document.index(node, "skin", skins.len(), || "it".to_owned())? else {
        return Ok(None);
    };
    let what = || format!("skin {skin}");
    let joints = json.member(skins[skin], "joints");
    let joints = joints.into_iter().flat_map(|joints| json.elements(joints));
    let joints: Vec<usize> = joints
        .map(|joint| document.index_at(joint, world.len(), || format!("{} names node", what())))
        .collect::<Result<_, _>>()?;
    let matrices = document.index(skins[skin], "inverseBindMatrices", document.accessors.len(), what)?;
    let world_from_joints = joints.iter().map(|&joint| world[joint]);
    let Some(matrices) = matrices else {
        return Ok(Some(Arc::new(world_from_joints.collect())));
    };
    let layout = document.layout(matrices)?;
    if layout.lanes != 16 || layout.count < joints.len() {
        return Err(format!(
            "accessor {matrices} does not have a matrix for each joint of {}",
            what()
        ));
    }
    let matrices = layout.floats::<16>(document);
    let bound = world_from_joints.zip(matrices).map(|(world_from_joint, matrix)| {
        let joint_from_mesh = DMat4::from_cols_array(&matrix.map(f64::from));
        world_from_joint * DAffine3::from_mat4(joint_from_mesh)
    });
    Ok(Some(Arc::new(bound.collect())))
}

/// The transform of each of a primitive's `count` vertices; `None` if the primitive isn't bound to joints. A vertex
/// without a weight gets a transform without inverse, to its mesh's origin, by glTF's formula.
///
/// # Errors
/// Joints and weights that can't be read, as the end of a sentence.
pub(crate) fn transforms(
    document: &Document,
    primitive: &Primitive,
    skin: &Skin,
    count: usize,
) -> Result<Option<Vec<DAffine3>>, String> {
    if primitive.influences.is_empty() {
        return Ok(None);
    }
    let mut sums = vec![(DMat3::ZERO, DVec3::ZERO, 0.0); count];
    for &(joints, weights) in &primitive.influences {
        let [of_joints, of_weights] = [joints, weights].map(|accessor| document.layout(accessor));
        let (of_joints, of_weights) = (of_joints?, of_weights?);
        if of_joints.count != count || of_weights.count != count {
            return Err(format!(
                "accessors {joints} and {weights} don't have one element for each vertex"
            ));
        }
        let (joints, weights) = (of_joints.floats::<4>(document), of_weights.floats::<4>(document));
        let wrong = joints.par_iter().zip(&weights).find_map_first(|(joints, weights)| {
            let mut pairs = joints.iter().zip(weights);
            // A joint without a weight may be any number.
            pairs.find_map(|(joint, weight)| (*weight != 0.0 && *joint as usize >= skin.len()).then_some(*joint))
        });
        if let Some(joint) = wrong {
            return Err(format!(
                "a vertex names joint {joint}, but there are only {}",
                skin.len()
            ));
        }
        sums.par_iter_mut()
            .zip(joints.par_iter().zip(&weights))
            .with_min_len(CHUNK)
            .for_each(|((linear, translation, sum), (joints, weights))| {
                for (joint, weight) in joints.iter().zip(weights).filter(|(_, weight)| **weight != 0.0) {
                    let (joint, weight) = (&skin[*joint as usize], f64::from(*weight));
                    *linear += joint.matrix3 * weight;
                    *translation += joint.translation * weight;
                    *sum += weight;
                }
            });
    }
    let mean = |(linear, translation, sum): (DMat3, DVec3, f64)| match sum.recip() {
        share if share.is_finite() => DAffine3 {
            matrix3: linear * share,
            translation: translation * share,
        },
        _ => DAffine3 {
            matrix3: DMat3::ZERO,
            translation: DVec3::ZERO,
        },
    };
    Ok(Some(sums.into_iter().map(mean).collect()))
}
