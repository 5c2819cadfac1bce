//! Joins two surfaces at their borders [YZX+04, section 5].
//!
//! 1. `choice` finds the borders that belong together, and `line` maps them by arc length.
//! 2. B moves rigidly so that its borders fit A's as well as possible, unless it was placed by hand. So the two halves
//!    of one surface, moved apart in any way, become that surface again.
//! 3. The common border is half way between both, with the points of both (`seam`); its frames are half way between the
//!    frames of both sides (`frames`).
//! 4. Any method bends both sides to it (`bend`), and `split` and `assemble` join them.

mod assemble;
mod bend;
mod choice;
mod chords;
mod frames;
mod line;
mod pair;
mod seam;
mod split;

use glam::{DAffine3, DMat3, DQuat, DVec3};
use pliant_deform::{Budget, Method, RigidMotion};
use pliant_mesh::{Cancel, Distortion, Progress, Surface};

use crate::borders::Borders;
use crate::error::StitchError;
use crate::part::Part;
use crate::shape::NewShape;
use assemble::{Bent, assemble};
use bend::{Bending, RimVertex, Rims};
use choice::Join;
use line::Line;
pub use pair::{MergeError, Pair};
use seam::{Node, Place, seam};

/// The request to join two parts.
#[derive(Clone, Copy, Debug)]
pub struct Joins<'a> {
    /// Vertices that belong together; without pairs the nearest borders are joined.
    pub pairs: &'a [Pair],
    /// The placement of B.
    pub placement: PlacementOfB,
    /// The largest distance from the borders at which each part may bend, as a share of its own diagonal.
    pub reach: f64,
    /// The method that bends both.
    pub method: &'a Method,
}

/// The placement of B before both are bent.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub enum PlacementOfB {
    /// A rigid motion fits its borders to A's as well as possible.
    #[default]
    Fitted,
    /// B is not moved.
    Kept,
}

/// The joined shape and the changes.
#[derive(Clone, Debug)]
pub struct Merged {
    /// The shape: A's vertices in their order, then the points at which B's border cut A's, then B's.
    pub shape: NewShape,
    /// The rigid motion of B.
    pub motion: DAffine3,
    /// The joined borders.
    pub seams: Vec<Seam>,
    /// The bending of each part.
    pub bendings: [PartBending; 2],
}

/// The bending of a part in numbers.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub struct PartBending {
    /// The number of its surface's vertices that moved.
    pub vertices: usize,
    /// The number of triangles that turned over.
    pub flipped: usize,
    /// True if the method converged, or had nothing to do.
    pub has_converged: bool,
}

/// A joined border.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Seam {
    /// The edges of A's border and of B's.
    pub edges: [usize; 2],
    /// Their lengths.
    pub lengths: [f64; 2],
    /// The points of the common border.
    pub points: usize,
    /// The mean and the largest distance between the borders before they were bent.
    pub gap: [f64; 2],
}

/// Points of two borders that are closer than this share of A's diagonal are at one place already.
const TOUCH: f64 = 1e-9;

/// Joins two parts.
///
/// # Errors
/// A part without a border, a pair on none, pairs that contradict each other, a refusal of the method;
/// [`StitchError::Cancelled`].
pub fn merge(
    parts: [&Part<'_>; 2],
    joins: &Joins<'_>,
    budget: Budget,
    progress: &Progress,
    cancel: &Cancel,
) -> Result<Merged, MergeError> {
    let borders = parts.map(|part| Borders::of(part.model));
    for (side, borders) in borders.iter().enumerate() {
        cancel
            .check()
            .map_err(|cancelled| MergeError::of(side, cancelled.into()))?;
        if borders.sound.is_empty() {
            let faulty = !borders.faulty.is_empty();
            let refusal = if faulty {
                borders.refusal(0, parts[side].model)
            } else {
                StitchError::NoBorder
            };
            return Err(MergeError::of(side, refusal));
        }
    }
    let holds = joins.placement == PlacementOfB::Kept;
    let [of_a, of_b] = &borders;
    let mut joined = match joins.pairs.is_empty() {
        true => Join::by_nearness(parts, [of_a, of_b], holds),
        false => Join::by_pairs(parts, [of_a, of_b], joins.pairs)?,
    };
    progress.set(0.1);

    let motion = if holds { None } else { fitted(&joined) };
    let surface_b = moved_surface(&parts[1].model.surface, motion.as_ref());
    for join in &mut joined {
        let points = join.b.vertices.iter().map(|v| surface_b.positions[v.index()]).collect();
        join.b = Line::of(join.b.vertices.clone(), points);
    }
    let diagonal =
        [&parts[0].model, &parts[1].model].map(|model| model.bounds().map_or(0.0, |bounds| bounds.diagonal()));
    let joined: Vec<(Join, Vec<Node>)> = joined
        .into_iter()
        .map(|join| {
            let nodes = seam(&join, TOUCH * diagonal[0]);
            (join, nodes)
        })
        .collect();

    let surfaces = [&parts[0].model.surface, &surface_b];
    let rims = rims(parts, surfaces, &joined);
    let mut positions: [Vec<DVec3>; 2] = Default::default();
    let mut bendings = [PartBending::default(); 2];
    for side in 0..2 {
        let bending = Bending {
            surface: surfaces[side],
            topology: &parts[side].model.topology,
            reach: joins.reach * diagonal[side],
            touch: TOUCH * diagonal[0],
            method: joins.method,
            budget,
            name: ["A", "B"][side],
        };
        let share = 0.1 + 0.4 * side as f32;
        let ways = bending.bent(&rims[side], &progress.part(share, share + 0.4), cancel);
        let (ways, has_converged) = ways.map_err(|error| MergeError::of(side, error))?;
        let rest = &surfaces[side].positions;
        positions[side] = rest.iter().zip(&ways).map(|(rest, way)| *rest + *way).collect();
        let vertices = ways.iter().filter(|way| **way != DVec3::ZERO).count();
        let flipped = match vertices {
            0 => 0,
            _ => Distortion::of(surfaces[side], bending.topology, &positions[side]).flipped_faces,
        };
        bendings[side] = PartBending {
            vertices,
            flipped,
            has_converged,
        };
    }
    let [positions_a, positions_b] = positions;
    let moved = |point: &DVec3| *point + motion.as_ref().map_or(DVec3::ZERO, |motion| motion.displace(*point));
    let turn = motion.as_ref().map_or(DQuat::IDENTITY, RigidMotion::rotation);
    let seams = joined.iter().map(|(join, nodes)| Seam::of(join, nodes)).collect();
    let shape = assemble(
        [
            Bent {
                part: parts[0],
                rest: surfaces[0],
                positions: positions_a,
                drawn: parts[0].drawn.positions.clone(),
                turn: DQuat::IDENTITY,
            },
            Bent {
                part: parts[1],
                rest: surfaces[1],
                positions: positions_b,
                drawn: parts[1].drawn.positions.iter().map(moved).collect(),
                turn,
            },
        ],
        &joined,
    );
    progress.set(1.0);
    Ok(Merged {
        shape,
        motion: motion.map_or(DAffine3::IDENTITY, |motion| affine(&motion)),
        seams,
        bendings,
    })
}

impl Seam {
    fn of(join: &Join, nodes: &[Node]) -> Self {
        let gaps = nodes
            .iter()
            .map(|node| node.on[0].point(&join.a).distance(node.on[1].point(&join.b)));
        let gaps: Vec<f64> = gaps.collect();
        Self {
            edges: [join.a.count(), join.b.count()],
            lengths: [join.a.length(), join.b.length()],
            points: nodes.len(),
            gap: [
                gaps.iter().sum::<f64>() / gaps.len().max(1) as f64,
                gaps.iter().copied().fold(0.0, f64::max),
            ],
        }
    }
}

/// The rigid motion that takes B's borders nearest to A's.
fn fitted(joins: &[Join]) -> Option<RigidMotion> {
    let (mut from, mut to) = (Vec::new(), Vec::new());
    for join in joins {
        for (k, point) in join.a.points.iter().enumerate() {
            from.push(join.b.point(join.map.other(0, join.a.ways[k])));
            to.push(*point);
        }
        for (k, point) in join.b.points.iter().enumerate() {
            from.push(*point);
            to.push(join.a.point(join.map.other(1, join.b.ways[k])));
        }
    }
    choice::fit(&from, &to)
}

fn moved_surface(surface: &Surface, motion: Option<&RigidMotion>) -> Surface {
    let mut moved = surface.clone();
    if let Some(motion) = motion {
        for position in &mut moved.positions {
            *position += motion.displace(*position);
        }
    }
    moved
}

fn affine(motion: &RigidMotion) -> DAffine3 {
    DAffine3::from_mat3_translation(DMat3::from_quat(motion.rotation()), motion.displace(DVec3::ZERO))
}

/// The most handles of a border; each has at least [`LEAST_A_HANDLE`] vertices.
const HANDLES_A_BORDER: usize = 12;

/// The least number of a handle's vertices, if the border has as many.
const LEAST_A_HANDLE: usize = 3;

/// The motion of each vertex on the joined borders of both parts.
fn rims(parts: [&Part<'_>; 2], surfaces: [&Surface; 2], joined: &[(Join, Vec<Node>)]) -> [Rims; 2] {
    let mut rims = [Rims::new(), Rims::new()];
    let mut first = [0, 0];
    for (join, nodes) in joined {
        let lines = [&join.a, &join.b];
        let normals = [0, 1].map(|side| frames::normals(lines[side], surfaces[side], &parts[side].model.topology));
        let turns = frames::turns(join, nodes, [&normals[0], &normals[1]]);
        for side in 0..2 {
            let count = lines[side].count();
            let handles = (count / LEAST_A_HANDLE).clamp(1, HANDLES_A_BORDER);
            for node in nodes {
                if let Place::Vertex(v) = node.on[side] {
                    let rim = RimVertex {
                        way: node.target - lines[side].points[v],
                        turn: turns[side][v],
                        handle: (first[side] + v * handles / count) as u16,
                    };
                    rims[side].insert(lines[side].vertices[v], rim);
                }
            }
            first[side] += handles;
        }
    }
    rims
}
