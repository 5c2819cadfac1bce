//! The crossings of a grid's lines with the cage.

use glam::{DVec3, USizeVec3};

use super::mesh::CageMesh;

/// A grid of nodes around a cage. Its offset keeps its lines from vertices and edges of the cage except by accident.
#[derive(Clone, Copy, Debug)]
pub(super) struct GridFrame {
    pub low: DVec3,
    pub step: f64,
    pub counts: USizeVec3,
}

/// The point at which a line meets a face.
#[derive(Clone, Copy, Debug)]
pub(super) struct Crossing {
    /// The position along the line, in steps from its first node.
    pub at: f64,
    pub face: u32,
    /// The weights of the face's corners.
    pub barycentric: [f64; 3],
}

/// The crossings of all lines along each axis, in order.
#[derive(Debug)]
pub(super) struct Crossings {
    lines: [Vec<Vec<Crossing>>; 3],
}

/// The distance by which the grid begins before the cage, in steps: three numbers without a common measure.
const BEFORE: DVec3 = DVec3::new(1.371_71, 1.413_73, 1.293_17);

impl GridFrame {
    /// Makes a grid around a cage.
    pub fn around(cage: &CageMesh, step: f64) -> Self {
        let low = cage.vertices.iter().copied().fold(DVec3::INFINITY, DVec3::min);
        let high = cage.vertices.iter().copied().fold(DVec3::NEG_INFINITY, DVec3::max);
        let low = low - BEFORE * step;
        Self {
            low,
            step,
            counts: ((high - low) / step).ceil().as_usizevec3() + 2,
        }
    }

    /// A point in steps from the first node.
    pub fn steps(&self, point: DVec3) -> DVec3 {
        (point - self.low) / self.step
    }

    pub fn number(&self, node: USizeVec3) -> usize {
        node.x + self.counts.x * (node.y + self.counts.y * node.z)
    }

    pub fn count(&self) -> usize {
        self.counts.element_product()
    }

    fn line(&self, axis: usize, node: USizeVec3) -> usize {
        let (first, second) = ((axis + 1) % 3, (axis + 2) % 3);
        node[first] + self.counts[first] * node[second]
    }
}

impl Crossings {
    pub fn of(cage: &CageMesh, frame: &GridFrame) -> Self {
        let lines = [0, 1, 2].map(|axis| {
            let (first, second) = ((axis + 1) % 3, (axis + 2) % 3);
            let mut lines = vec![Vec::new(); frame.counts[first] * frame.counts[second]];
            for (number, face) in cage.faces.iter().enumerate() {
                let corners = cage.corners(number).map(|corner| frame.steps(corner));
                let low = corners[0].min(corners[1]).min(corners[2]).floor().as_usizevec3();
                let high = corners[0].max(corners[1]).max(corners[2]).ceil().as_usizevec3();
                for i in low[first]..=high[first] {
                    for j in low[second]..=high[second] {
                        let line = [i as f64, j as f64];
                        if let Some(barycentric) = met(face, corners.map(|c| [c[first], c[second]]), line) {
                            let at = (0..3).map(|k| corners[k][axis] * barycentric[k]).sum();
                            lines[i + frame.counts[first] * j].push(Crossing {
                                at,
                                face: number as u32,
                                barycentric,
                            });
                        }
                    }
                }
            }
            for line in &mut lines {
                line.sort_by(|a, b| a.at.total_cmp(&b.at));
            }
            lines
        });
        Self { lines }
    }

    /// The crossings of the line along an axis through a node, in order.
    pub fn along(&self, frame: &GridFrame, axis: usize, node: USizeVec3) -> &[Crossing] {
        &self.lines[axis][frame.line(axis, node)]
    }
}

/// The weights of a projected face's corners at a point in it; `None` outside. Two faces decide alike about a point at
/// their shared edge.
pub(super) fn met(face: &[u32; 3], corners: [[f64; 2]; 3], point: [f64; 2]) -> Option<[f64; 3]> {
    let area = |k: usize| {
        let (a, b) = ((k + 1) % 3, (k + 2) % 3);
        let (low, high, sign) = if face[a] < face[b] { (a, b, 1.0) } else { (b, a, -1.0) };
        let [from, to] = [corners[low], corners[high]];
        let area = (to[0] - from[0]) * (point[1] - from[1]) - (to[1] - from[1]) * (point[0] - from[0]);
        (sign * area, (area >= 0.0) == (sign > 0.0))
    };
    let areas = [area(0), area(1), area(2)];
    let is_in = areas.iter().all(|(_, left)| *left) || areas.iter().all(|(_, left)| !*left);
    let sum: f64 = areas.iter().map(|(area, _)| area).sum();
    (is_in && sum != 0.0).then(|| areas.map(|(area, _)| area / sum))
}
