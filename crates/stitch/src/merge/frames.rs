//! The turns of a border's vertices: from each side's frame to the frame between both [YZX+04, section 5].
//!
//! A frame has the tangent of the border and the normal of the surface. Each side turns half of the way. Where the
//! borders coincide already, nothing turns: the surfaces meet there as before.

use glam::{DMat3, DQuat, DVec3};
use pliant_mesh::{Surface, SurfaceVertex, Topology};

use super::choice::Join;
use super::line::Line;
use super::seam::{Node, Place};

/// The rounds in which a turn takes the mean of its neighbours along the border: the normals of scans are noisy.
const SMOOTHING: usize = 6;

/// The normal of the surface at each vertex of a line, by area.
pub(crate) fn normals(line: &Line, surface: &Surface, topology: &Topology) -> Vec<DVec3> {
    let normal = |&vertex: &SurfaceVertex| {
        let faces = topology.faces(vertex, &surface.triangles);
        let areas = faces.map(|face| {
            let [a, b, c] = surface.corners(face as usize);
            (b - a).cross(c - a)
        });
        areas.sum::<DVec3>().normalize_or_zero()
    };
    line.vertices.iter().map(normal).collect()
}

/// The turn of each vertex of both lines.
pub(crate) fn turns(join: &Join, nodes: &[Node], normals: [&[DVec3]; 2]) -> [Vec<DQuat>; 2] {
    let lines = [&join.a, &join.b];
    let count = nodes.len();
    let tangent = |side: usize, k: usize| {
        let [before, after] = [nodes[(k + count - 1) % count], nodes[(k + 1) % count]];
        (after.on[side].point(lines[side]) - before.on[side].point(lines[side])).normalize_or_zero()
    };
    let normal = |side: usize, k: usize| match nodes[k].on[side] {
        Place::Vertex(v) => normals[side][v],
        Place::Edge(v, share) => {
            let next = (v + 1) % lines[side].count();
            normals[side][v].lerp(normals[side][next], share).normalize_or_zero()
        }
    };
    let turns: [Vec<DQuat>; 2] = [0, 1].map(|side| {
        let raw: Vec<DQuat> = (0..count)
            .map(|k| {
                let between = frame(tangent(0, k) + tangent(1, k), normal(0, k) + normal(1, k));
                let own = frame(tangent(side, k), normal(side, k));
                let (Some(between), Some(own)) = (between, own) else {
                    return DQuat::IDENTITY;
                };
                let turn = DQuat::from_mat3(&(between * own.transpose())).normalize();
                let gap = nodes[k].on[0].point(lines[0]).distance(nodes[k].on[1].point(lines[1]));
                let edge = lines[side].length() / lines[side].count() as f64;
                DQuat::IDENTITY.slerp(turn, (gap / edge).min(1.0))
            })
            .collect();
        smoothed(raw)
    });
    [0, 1].map(|side| {
        let mut own = vec![DQuat::IDENTITY; lines[side].count()];
        for (k, node) in nodes.iter().enumerate() {
            if let Place::Vertex(v) = node.on[side] {
                own[v] = turns[side][k];
            }
        }
        own
    })
}

/// The orthonormal frame of a tangent and a normal, if they determine one.
fn frame(tangent: DVec3, normal: DVec3) -> Option<DMat3> {
    let tangent = tangent.try_normalize()?;
    // Two sides that face in opposite directions have no frame between them.
    let normal = (normal.length() > 0.2)
        .then(|| normal - tangent * normal.dot(tangent))?
        .try_normalize()?;
    Some(DMat3::from_cols(tangent, normal, tangent.cross(normal)))
}

/// The turns, each averaged with its neighbours.
fn smoothed(mut turns: Vec<DQuat>) -> Vec<DQuat> {
    let count = turns.len();
    for _ in 0..SMOOTHING {
        let mean = |k: usize| {
            let [before, own, after] = [turns[(k + count - 1) % count], turns[k], turns[(k + 1) % count]];
            let alike = |turn: DQuat| if turn.dot(own) < 0.0 { -turn } else { turn };
            (own * 2.0 + alike(before) + alike(after)).normalize()
        };
        turns = (0..count).map(mean).collect();
    }
    turns
}
