//! The displacements of an instance's elements by a new target.

use glam::DVec3;
use pliant_mesh::Drawn;
use rayon::prelude::*;

use crate::gltf::document::Document;
use crate::gltf::geometry::primitive::Primitive;
use crate::gltf::geometry::{Instance, Pieces};
use crate::gltf::save::changes::{InstanceChange, Semantic, changes};
use crate::gltf::save::patch::cannot_hold;
use crate::save::course::Course;
use crate::save::moved::Moved;
use crate::save::{MorphAnimation, MorphDeltas};
use crate::{Format, SaveError};

/// The number of elements for one task.
const CHUNK: usize = 1 << 12;

/// A target to be added.
pub(super) struct NewTarget {
    pub name: String,
    /// The weight by which it is applied by default.
    pub weight: f64,
    /// Its displacements of each instance.
    pub of_instances: Vec<Deltas>,
}

/// An instance's displacements, by attribute in the order of [`Semantic::ALL`]; empty for an attribute that does not
/// change.
#[derive(Clone, PartialEq, Debug, Default)]
pub(super) struct Deltas([Vec<[f32; 4]>; 3]);

impl Deltas {
    /// The displacements by a change of a primitive's elements.
    pub fn of_change(
        document: &Document,
        primitive: &Primitive,
        change: &InstanceChange,
        format: Format,
    ) -> Result<Self, SaveError> {
        let mut out = Self::default();
        for (semantic, ways) in Semantic::ALL.into_iter().zip(&mut out.0) {
            let change = change.of(semantic);
            let Some(base) = semantic.accessor(primitive).filter(|_| !change.is_empty()) else {
                continue;
            };
            let layout = document.layout(base).map_err(|what| cannot_hold(what, format))?;
            let rest = layout.floats::<3>(document);
            *ways = vec![[0.0; 4]; layout.count];
            for &(element, new) in change {
                ways[element as usize] = difference(new, rest[element as usize]);
            }
        }
        out.check()?;
        Ok(out)
    }

    /// The displacements of an attribute.
    pub fn of(&self, place: usize) -> &[[f32; 4]] {
        &self.0[place]
    }

    /// Refuses numbers that single precision can't hold.
    fn check(&self) -> Result<(), SaveError> {
        let is_bad = |way: &[f32; 4]| !way.iter().all(|number| number.is_finite());
        match self.0.iter().find_map(|ways| ways.iter().position(is_bad)) {
            Some(element) => Err(SaveError::NotFinite {
                file_vertex: element as u32,
            }),
            None => Ok(()),
        }
    }
}

fn difference(new: [f32; 4], rest: [f32; 3]) -> [f32; 4] {
    [new[0] - rest[0], new[1] - rest[1], new[2] - rest[2], 0.0]
}

/// For each target of an animation, the displacements of each instance.
///
/// Positions are linear in the weights. Normals and tangents are not, so theirs are those that fit the carried ones of
/// all frames best: as the weights' columns are orthogonal, the least squares are a mean for each target.
pub(super) fn of_animation(
    (document, meshes, pieces): (&Document, &[Vec<Primitive>], &Pieces),
    drawn: &Drawn,
    animation: &MorphAnimation<'_>,
    format: Format,
    course: &Course<'_>,
) -> Result<Vec<Vec<Deltas>>, SaveError> {
    let mut of_targets: Vec<Vec<Deltas>> = Vec::new();
    for target in animation.targets {
        let of_instances = pieces
            .instances
            .iter()
            .map(|instance| positions(instance, drawn, target));
        of_targets.push(of_instances.collect::<Result<_, SaveError>>()?);
    }
    let carried = [Semantic::Normal, Semantic::Tangent];
    let primitive = |instance: &Instance| &meshes[instance.mesh][instance.primitive];
    let mut instances = pieces.instances.iter();
    if !instances.any(|instance| carried.iter().any(|own| own.accessor(primitive(instance)).is_some())) {
        return Ok(of_targets);
    }
    let rests = rests(document, meshes, pieces, format)?;
    let sizes = animation.column_sizes();
    for (frame, weights) in animation.weights.iter().enumerate() {
        let part = |frame: usize| frame as f32 / animation.weights.len() as f32;
        let course = course.part(part(frame), part(frame + 1));
        let shape = animation.shape(&drawn.positions, weights);
        let moved = Moved::of(drawn, &shape, &[], format)?;
        let changes = changes(document, meshes, pieces, &moved, MorphDeltas::Stay, &course)?;
        let shares: Vec<f32> = (weights.iter().zip(&sizes))
            // f32 is the precision of the stored displacements.
            .map(|(weight, size)| (weight / size) as f32)
            .collect();
        for (of_instances, &share) in of_targets.iter_mut().zip(&shares) {
            for ((deltas, change), rest) in of_instances.iter_mut().zip(&changes).zip(&rests) {
                deltas.add(change, rest, share);
            }
        }
    }
    for deltas in of_targets.iter().flatten() {
        deltas.check()?;
    }
    Ok(of_targets)
}

/// The displacements of an instance's positions by a target, in the mesh's own space.
fn positions(instance: &Instance, drawn: &Drawn, target: &[DVec3]) -> Result<Deltas, SaveError> {
    let linear = instance.pose.linear();
    let mut deltas = Deltas::default();
    let vertices = instance.vertices.start as usize..instance.vertices.end as usize;
    if target[vertices.clone()].iter().all(|way| *way == DVec3::ZERO) {
        return Ok(deltas);
    }
    for (element, vertex) in vertices.enumerate() {
        // Vertices that a skin flattens do not change: their moves can't be brought back through it. f32 begins here.
        let by = linear
            .at(element)
            .map_or(DVec3::ZERO, |linear| linear.mesh_from_world * target[vertex]);
        let by = by.as_vec3();
        if !by.is_finite() {
            let file_vertex = drawn.file_vertex[vertex].0;
            return Err(SaveError::NotFinite { file_vertex });
        }
        deltas.0[0].push(by.extend(0.0).to_array());
    }
    Ok(deltas)
}

/// The displacements of each instance by a sum of targets.
pub(super) fn mixed(of_targets: &[Vec<Deltas>], shares: &[f64]) -> Vec<Deltas> {
    let count = of_targets.first().map_or(0, Vec::len);
    let mut out = vec![Deltas::default(); count];
    let parts = of_targets.iter().zip(shares).filter(|(_, share)| **share != 0.0);
    for (of_instances, &share) in parts {
        for (sum, deltas) in out.iter_mut().zip(of_instances) {
            for (sum, ways) in sum.0.iter_mut().zip(&deltas.0).filter(|(_, ways)| !ways.is_empty()) {
                sum.resize(ways.len(), [0.0; 4]);
                let elements = sum.par_iter_mut().with_min_len(CHUNK).zip(ways);
                elements.for_each(|(sum, way)| (0..3).for_each(|lane| sum[lane] += share as f32 * way[lane]));
            }
        }
    }
    out
}

/// The stored normals and tangents of an instance.
type Rest = [Vec<[f32; 3]>; 2];

fn rests(
    document: &Document,
    meshes: &[Vec<Primitive>],
    pieces: &Pieces,
    format: Format,
) -> Result<Vec<Rest>, SaveError> {
    let stored = |accessor: Option<usize>| -> Result<Vec<[f32; 3]>, SaveError> {
        let Some(accessor) = accessor else {
            return Ok(Vec::new());
        };
        let layout = document.layout(accessor).map_err(|what| cannot_hold(what, format))?;
        Ok(layout.floats::<3>(document))
    };
    let of_instance = |instance: &Instance| {
        let primitive = &meshes[instance.mesh][instance.primitive];
        Ok([stored(primitive.normal)?, stored(primitive.tangent)?])
    };
    pieces.instances.iter().map(of_instance).collect()
}

impl Deltas {
    /// Adds a share of the changes of normals and tangents.
    fn add(&mut self, change: &InstanceChange, rest: &Rest, share: f32) {
        let of_semantics = [&change.normal, &change.tangent];
        for ((ways, change), rest) in self.0[1..].iter_mut().zip(of_semantics).zip(rest) {
            if share == 0.0 || change.is_empty() {
                continue;
            }
            ways.resize(rest.len(), [0.0; 4]);
            // The elements ascend, so the ways of each block are one slice.
            let blocks = ways.par_chunks_mut(CHUNK).enumerate();
            blocks.for_each(|(block, ways)| {
                let (first, end) = (block * CHUNK, block * CHUNK + ways.len());
                let start = change.partition_point(|(element, _)| (*element as usize) < first);
                let own = change[start..].iter().map(|(element, new)| (*element as usize, *new));
                for (element, new) in own.take_while(|(element, _)| *element < end) {
                    let way = difference(new, rest[element]);
                    let sum = &mut ways[element - first];
                    (0..3).for_each(|lane| sum[lane] += share * way[lane]);
                }
            });
        }
    }
}
