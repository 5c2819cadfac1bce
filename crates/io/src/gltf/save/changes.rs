//! The new numbers of moved and of turned vertices, in each node's own space.

use std::collections::BTreeMap;

use glam::{DMat3, DVec3, Vec3, Vec4};
use pliant_mesh::{Cancelled, DrawnVertex};
use rayon::prelude::*;

use crate::SaveError;
use crate::gltf::appearance;
use crate::gltf::document::Document;
use crate::gltf::geometry::primitive::Primitive;
use crate::gltf::geometry::{Instance, Pieces};
use crate::gltf::save::target_turns;
use crate::save::MorphDeltas;
use crate::save::course::Course;
use crate::save::frames::{Frames, carried_normal, carried_tangent};
use crate::save::moved::Moved;

/// An attribute that follows the deformation.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(crate) enum Semantic {
    Position,
    Normal,
    Tangent,
}

impl Semantic {
    pub const ALL: [Self; 3] = [Self::Position, Self::Normal, Self::Tangent];

    /// The attribute's name in a primitive.
    pub const fn key(self) -> &'static str {
        match self {
            Self::Position => "POSITION",
            Self::Normal => "NORMAL",
            Self::Tangent => "TANGENT",
        }
    }

    /// The count of numbers in an element.
    pub const fn lanes(self) -> usize {
        match self {
            Self::Position | Self::Normal => 3,
            Self::Tangent => 4,
        }
    }

    /// The accessor that a primitive names for it.
    pub fn accessor(self, primitive: &Primitive) -> Option<usize> {
        match self {
            Self::Position => primitive.position,
            Self::Normal => primitive.normal,
            Self::Tangent => primitive.tangent,
        }
    }
}

/// Elements whose stored bits change, and their new values, ascending; numbers beyond an attribute's own are 0.
pub(crate) type Change = Vec<(u32, [f32; 4])>;

/// The changes of an instance's attributes.
#[derive(Clone, PartialEq, Debug, Default)]
pub(crate) struct InstanceChange {
    pub position: Change,
    pub normal: Change,
    pub tangent: Change,
    /// The turn of each element's deltas in morph targets; `None` if they stay.
    pub target_turns: Option<Vec<DMat3>>,
}

impl InstanceChange {
    pub fn of(&self, semantic: Semantic) -> &Change {
        match semantic {
            Semantic::Position => &self.position,
            Semantic::Normal => &self.normal,
            Semantic::Tangent => &self.tangent,
        }
    }

    pub fn is_empty(&self) -> bool {
        Semantic::ALL.iter().all(|&semantic| self.of(semantic).is_empty())
    }
}

/// The number of vertices for one task.
const CHUNK: usize = 1 << 13;

/// The number of vertices between two checks for cancellation.
const BLOCK: usize = 1 << 17;

/// The changes of every instance, in their order.
pub(crate) fn changes(
    document: &Document,
    meshes: &[Vec<Primitive>],
    pieces: &Pieces,
    moved: &Moved<'_>,
    deltas: MorphDeltas,
    course: &Course<'_>,
) -> Result<Vec<InstanceChange>, SaveError> {
    let has_normals = pieces.instances.iter().any(|instance| {
        let primitive = &meshes[instance.mesh][instance.primitive];
        let has_targets = deltas != MorphDeltas::Stay && !primitive.targets.is_empty();
        primitive.normal.is_some() || primitive.tangent.is_some() || has_targets
    });
    course.reach(0, 1)?;
    let (of_frames, course) = course.split(if has_normals { 0.7 } else { 0.0 });
    let frames = has_normals
        .then(|| moved.frames(&appearance::world_normals(document, meshes, pieces), &of_frames))
        .transpose()?;
    let mut turns = match &frames {
        Some(frames) => target_turns::turns(document, meshes, pieces, moved, frames, deltas),
        None => Vec::new(),
    };
    turns.resize(pieces.instances.len(), None);
    let all = moved.positions.len().max(1) as f32;
    let of_instance = |(instance, turns): (&Instance, Option<Vec<DMat3>>)| {
        let [from, to] = [instance.vertices.start, instance.vertices.end].map(|vertex| vertex as f32 / all);
        instance_change(
            document,
            meshes,
            instance,
            moved,
            (frames.as_ref(), turns),
            &course.part(from, to),
        )
    };
    pieces.instances.iter().zip(turns).map(of_instance).collect()
}

fn instance_change(
    document: &Document,
    meshes: &[Vec<Primitive>],
    instance: &Instance,
    moved: &Moved<'_>,
    (frames, target_turns): (Option<&Frames>, Option<Vec<DMat3>>),
    course: &Course<'_>,
) -> Result<InstanceChange, SaveError> {
    let vertex = |element: u32| DrawnVertex(instance.vertices.start + element);
    let count = instance.vertices.end - instance.vertices.start;
    course.reach(0, 1)?;
    let changes = |element: &u32| moved.moves(vertex(*element)) || moved.turns(vertex(*element));
    let elements: Vec<u32> = (0..count).filter(changes).collect();
    if elements.is_empty() {
        return Ok(InstanceChange::default());
    }
    let primitive = &meshes[instance.mesh][instance.primitive];
    // Vertices that a skin flattens do not change: their moves can't be brought back through it.
    let linear = instance.pose.linear();
    let elements: Vec<u32> = elements
        .into_iter()
        .filter(|&e| linear.at(e as usize).is_some())
        .collect();
    let stored = |accessor: Option<usize>| appearance::attribute::<4>(document, instance, accessor);
    let positions = stored(primitive.position).unwrap_or_default();
    let turns = target_turns.as_deref();
    let shifts = turns.map(|turns| target_turns::shifts(document, primitive, instance, turns));
    let normals = stored(primitive.normal);
    let tangents = stored(primitive.tangent);

    let [of_positions, of_normals, of_tangents] =
        [(0.0, 0.3), (0.3, 0.6), (0.6, 1.0)].map(|(from, to)| course.part(from, to));
    let position = changed(&elements, &positions, &of_positions, |element, stored| {
        // The displacement, not the position, is transformed back, so that no digits are lost far from the origin. f32
        // begins here.
        let v = vertex(element).index();
        let way = moved.positions[v] - moved.drawn.positions[v];
        let by = linear
            .at(element as usize)
            .map_or(DVec3::ZERO, |linear| linear.mesh_from_world * way);
        let by = by - shifts.as_ref().map_or(DVec3::ZERO, |shifts| shifts[element as usize]);
        if by == DVec3::ZERO {
            return Vec4::from_array(stored);
        }
        (xyz(stored) + by).as_vec3().extend(0.0)
    })?;
    if let Some(&(element, _)) = position.iter().find(|(_, new)| !new.iter().all(|x| x.is_finite())) {
        return Err(SaveError::NotFinite {
            file_vertex: moved.drawn.file_vertex[vertex(element).index()].0,
        });
    }
    let gradient = |element: u32| -> Option<DMat3> {
        let world = frames?.gradient(vertex(element))?;
        let linear = linear.at(element as usize)?;
        Some(linear.mesh_from_world * world * linear.world_from_mesh)
    };
    let normal = normals.as_deref().unwrap_or_default();
    let normal = changed(&elements, normal, &of_normals, |element, stored| {
        let carried = match gradient(element) {
            Some(gradient) => carried_normal(gradient, xyz(stored)).as_vec3().extend(0.0),
            None => Vec4::from_array(stored),
        };
        if moved.turns(vertex(element)) {
            (-carried.truncate()).extend(0.0)
        } else {
            carried
        }
    })?;
    let tangent = tangents.as_deref().unwrap_or_default();
    let tangent = changed(&elements, tangent, &of_tangents, |element, stored| {
        let carried = match gradient(element) {
            Some(gradient) => {
                let up = normals
                    .as_ref()
                    .map_or(DVec3::ZERO, |normals| xyz(normals[element as usize]));
                let new_up = carried_normal(gradient, up);
                carried_tangent(gradient, up, new_up, xyz(stored))
                    .as_vec3()
                    .extend(stored[3])
            }
            None => Vec4::from_array(stored),
        };
        // The bitangent, which is the normal × the tangent by this sign, stays along the texture.
        let sign = if moved.turns(vertex(element)) { -1.0 } else { 1.0 };
        carried.truncate().extend(sign * carried.w)
    })?;
    Ok(InstanceChange {
        position,
        normal,
        tangent,
        target_turns,
    })
}

/// The elements for which `new` gives other bits than the stored ones, perhaps none.
fn changed(
    elements: &[u32],
    stored: &[[f32; 4]],
    course: &Course<'_>,
    new: impl Fn(u32, [f32; 4]) -> Vec4 + Sync,
) -> Result<Change, Cancelled> {
    let mut out = Change::new();
    if stored.is_empty() {
        return Ok(out);
    }
    let of_element = |&element: &u32| {
        let old = *stored.get(element as usize)?;
        let new = new(element, old).to_array();
        (new.map(f32::to_bits) != old.map(f32::to_bits)).then_some((element, new))
    };
    for (number, block) in elements.chunks(BLOCK).enumerate() {
        course.reach(number * BLOCK, elements.len())?;
        out.par_extend(block.par_iter().with_min_len(CHUNK).filter_map(of_element));
    }
    Ok(out)
}

fn xyz([x, y, z, _]: [f32; 4]) -> DVec3 {
    Vec3::new(x, y, z).as_dvec3()
}

/// The accessors' elements before the edit, decoded once, to compare changes.
#[derive(Default)]
pub(crate) struct Rest(BTreeMap<usize, (Vec<[f32; 4]>, f32)>);

impl Rest {
    /// Returns true if two changes of one accessor are the same except for the rounding of different nodes' transforms.
    pub fn comes_to_the_same(&mut self, document: &Document, accessor: usize, a: &Change, b: &Change) -> bool {
        if a == b {
            return true;
        }
        let (stored, tolerance) = self.0.entry(accessor).or_insert_with(|| {
            let stored = document
                .layout(accessor)
                .map_or_else(|_| Vec::new(), |layout| layout.floats(document));
            let finite = stored.as_flattened().iter().filter(|x| x.is_finite());
            let size = finite.fold(0.0_f32, |most, x| most.max(x.abs()));
            (stored, 4.0 * f32::EPSILON * size)
        });
        let tolerance = *tolerance;
        let is_near = |a: [f32; 4], b: [f32; 4]| {
            a.iter()
                .zip(b)
                .all(|(x, y)| x.to_bits() == y.to_bits() || (x - y).abs() <= tolerance)
        };
        // Both are ascending: each step takes the next element of either or both; the other side's value is the stored
        // one.
        let (mut a, mut b) = (a.iter().peekable(), b.iter().peekable());
        loop {
            let next = |side: Option<&&(u32, [f32; 4])>| side.map_or(u32::MAX, |(element, _)| *element);
            let element = next(a.peek()).min(next(b.peek()));
            let Some(&stored) = stored.get(element as usize) else {
                return a.peek().is_none() && b.peek().is_none();
            };
            let new_a = a
                .next_if(|(other, _)| *other == element)
                .map_or(stored, |(_, new)| *new);
            let new_b = b
                .next_if(|(other, _)| *other == element)
                .map_or(stored, |(_, new)| *new);
            if !is_near(new_a, new_b) {
                return false;
            }
        }
    }
}
