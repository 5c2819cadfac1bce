//! Tangent planes at vertices: the angles around each vertex, scaled to a full turn, and the rotations between a
//! triangle's plane and those of its corners [ZMT06, KCPS13].

use std::f64::consts::TAU;

use glam::DVec2;
use pliant_mesh::{Surface, SurfaceVertex, Topology};

use crate::chart::Chart;
use crate::crossings::Crossings;
use crate::hinges::{Hinges, WALL, corner_at, last, next};
use crate::plane::{rotation_between, small_rotation, turned, turned_back};

/// The corners around each vertex.
#[derive(Clone, Debug)]
pub(crate) struct Fans {
    /// The start of each vertex's corners, and the end of the last one's.
    offsets: Vec<u32>,
    /// The corners of each vertex, counterclockwise.
    corners: Vec<u32>,
    /// The direction at which each of them begins, in the plane of its vertex.
    starts: Vec<f64>,
    /// Angle in the plane of a vertex over angle on the surface: 1 at borders.
    scales: Vec<f64>,
    /// The rotations from each triangle's plane to that of each of its corners, in the middle of the corner.
    rotations: Vec<[DVec2; 3]>,
    /// By how much the rotation at a corner's last edge is more than that at its first: the part of the vertex's angle
    /// defect that the corner takes.
    twists: Vec<[f64; 3]>,
}

/// Where a direction at a vertex leads.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Way {
    /// The corner of the triangle that it enters.
    pub corner: u32,
    /// The direction in the plane of that triangle.
    pub direction: DVec2,
}

impl Fans {
    /// For a surface that has one fan at each vertex.
    pub fn of(surface: &Surface, topology: &Topology, hinges: &Hinges, charts: &[Chart]) -> Self {
        let count = surface.positions.len();
        let mut fans = Self {
            offsets: Vec::with_capacity(count + 1),
            corners: Vec::with_capacity(3 * charts.len()),
            starts: Vec::with_capacity(3 * charts.len()),
            scales: Vec::with_capacity(count),
            rotations: vec![[DVec2::X; 3]; charts.len()],
            twists: vec![[0.0; 3]; charts.len()],
        };
        fans.offsets.push(0);
        for vertex in (0..count as u32).map(SurfaceVertex) {
            match topology.faces(vertex, &surface.triangles).next() {
                Some(first) => fans.add(corner_at(surface, first, vertex), hinges, charts),
                None => fans.scales.push(1.0),
            }
            fans.offsets.push(fans.corners.len() as u32);
        }
        fans
    }

    /// Lays out the fan of a corner.
    fn add(&mut self, corner: u32, hinges: &Hinges, charts: &[Chart]) {
        let (fan, is_closed) = hinges.fan(corner);
        let angle = |&corner: &u32| charts[corner as usize / 3].angle(corner as usize % 3);
        let total: f64 = fan.iter().map(angle).sum();
        let scale = if is_closed && total > 0.0 { TAU / total } else { 1.0 };
        let mut start = 0.0;
        for corner in fan {
            let (chart, k) = (&charts[corner as usize / 3], corner as usize % 3);
            let angle = chart.angle(k);
            // The middles of both agree, so that neither side of the triangle is preferred.
            let middle = turned(DVec2::from_angle(0.5 * angle), chart.edge((k + 2) % 3));
            let here = DVec2::from_angle(scale * (start + 0.5 * angle));
            self.rotations[corner as usize / 3][k] = rotation_between(middle, here);
            self.twists[corner as usize / 3][k] = (scale - 1.0) * angle;
            self.corners.push(corner);
            self.starts.push(scale * start);
            start += angle;
        }
        self.scales.push(scale);
    }

    /// The corners at a vertex, counterclockwise.
    #[inline]
    pub fn corners(&self, vertex: usize) -> &[u32] {
        &self.corners[self.offsets[vertex] as usize..self.offsets[vertex + 1] as usize]
    }

    /// The rotation from a corner's triangle to the tangent plane of its vertex.
    #[inline]
    pub fn rotation(&self, corner: u32) -> DVec2 {
        self.rotations[corner as usize / 3][corner as usize % 3]
    }

    /// The rotation from a corner's triangle to the tangent plane of its vertex for vectors that come along the ray of
    /// points at which the barycentric coordinates of the next and the last corner have the ratio of `after` to
    /// `before`. So rays along an edge have the same rotation in both of its triangles, and a field that is interpolated
    /// with these rotations is continuous across edges.
    #[inline]
    pub fn rotation_along(&self, corner: u32, after: f64, before: f64) -> DVec2 {
        let both = after + before;
        let share = if both > 0.0 { before / both - 0.5 } else { 0.0 };
        let twist = self.twists[corner as usize / 3][corner as usize % 3];
        turned(small_rotation(share * twist), self.rotation(corner))
    }

    /// A vector at the vertex of each of a triangle's corners as it is in the triangle's plane, along the first edge of
    /// the corner and along its last one: to the next corner and to the one before.
    #[inline]
    pub fn at_edges(&self, triangle: usize, vectors: [DVec2; 3]) -> [[DVec2; 2]; 3] {
        std::array::from_fn(|k| {
            let middle = turned_back(self.rotations[triangle][k], vectors[k]);
            let half = small_rotation(0.5 * self.twists[triangle][k]);
            [turned(half, middle), turned_back(half, middle)]
        })
    }

    /// The rotations from a triangle to the tangent planes of its vertices, in the middles of its corners.
    #[inline]
    pub fn rotations(&self, triangle: usize) -> [DVec2; 3] {
        self.rotations[triangle]
    }

    /// The place among a vertex's corners of that into which the direction at an angle in its plane leads; 0 if it is
    /// bare.
    #[inline]
    pub fn sector(&self, vertex: usize, angle: f64) -> usize {
        let starts = &self.starts[self.offsets[vertex] as usize..self.offsets[vertex + 1] as usize];
        // Counted without branches, which would be guessed wrong as often as not.
        let begun: usize = starts.iter().map(|&start| usize::from(start <= angle)).sum();
        begun.saturating_sub(1)
    }

    /// The way that begins at a vertex with `direction`, at `angle` in its plane and so in `sector`. A direction that
    /// leaves the surface at a border is projected to the border's nearer edge. `None` if the vertex is bare or the
    /// direction points straight off the border.
    #[inline]
    pub fn way(
        &self,
        vertex: usize,
        (direction, angle, place): (DVec2, f64, usize),
        crossings: &Crossings,
        charts: &[Chart],
    ) -> Option<Way> {
        let corners = self.corners(vertex);
        let (&first, &end) = (corners.first()?, corners.last()?);
        let starts = &self.starts[self.offsets[vertex] as usize..][..corners.len()];
        let (corner, start) = (corners[place], starts[place]);
        let until = match starts.get(place + 1) {
            Some(until) => *until,
            None if crossings.beside(next(end)) == WALL => {
                let angle_there = charts[end as usize / 3].angle(end as usize % 3);
                if angle - start > angle_there {
                    return self.along_border(vertex, direction, (first, end), charts);
                }
                start + angle_there
            }
            None => TAU,
        };
        // Angles at the vertex are scaled. The triangle's rotation is that of the corner's middle.
        let off_middle = angle - 0.5 * (start + until);
        let unscaled = small_rotation(off_middle * (self.scales[vertex].recip() - 1.0));
        Some(Way {
            corner,
            direction: turned(unscaled, turned_back(self.rotation(corner), direction)),
        })
    }

    /// The way along the first or the last edge of an open fan, on which the direction's projection is larger.
    fn along_border(&self, vertex: usize, direction: DVec2, (first, end): (u32, u32), charts: &[Chart]) -> Option<Way> {
        let chart_of = |corner: u32| &charts[corner as usize / 3];
        let total = self.starts[self.offsets[vertex + 1] as usize - 1] + chart_of(end).angle(end as usize % 3);
        let (on_first, on_last) = (direction.x, direction.dot(DVec2::from_angle(total)));
        if on_first.max(on_last) <= 0.0 {
            return None;
        }
        Some(if on_first >= on_last {
            let edge = chart_of(first).edge(last(first) as usize % 3).normalize();
            Way {
                corner: first,
                direction: edge * on_first,
            }
        } else {
            let edge = -chart_of(end).edge(next(end) as usize % 3).normalize();
            Way {
                corner: end,
                direction: edge * on_last,
            }
        })
    }
}
