//! Tangent planes at vertices: the angles around each vertex, scaled to a full turn, and the rotations between a
//! triangle's plane and those of its corners [ZMT06, KCPS13].

use std::f64::consts::TAU;
use std::hint::black_box;
use std::ops::Range;

use glam::DVec2;
use pliant_mesh::{Surface, SurfaceVertex, Topology};

use crate::chart::Chart;
use crate::hinges::{Hinges, corner_at, last, next};
use crate::plane::{rotation_between, turned, turned_back};

/// The corners around each vertex.
#[derive(Clone, Debug)]
pub(crate) struct Fans {
    /// The start of each vertex's corners, and the end of the last one's.
    offsets: Vec<u32>,
    /// The corners of each vertex, counterclockwise.
    corners: Vec<u32>,
    /// The direction at which each of them begins, in the plane of its vertex.
    starts: Vec<f64>,
    /// Angle on the surface over angle in the plane of a vertex, less 1: 0 at borders.
    bends: Vec<f64>,
    /// How each triangle's plane fits to those of its corners.
    fits: Vec<Fit>,
}

/// How a triangle's plane fits to the tangent planes of its corners: one line of the processor's memory.
#[derive(Clone, Copy, Debug)]
#[repr(align(64))]
struct Fit {
    /// The rotations from the triangle's plane to those of its corners, in the middles of the corners.
    rotations: [DVec2; 3],
    /// By how much the rotation at a corner's last edge is more than that at its first: the part of the vertex's angle
    /// defect that the corner takes. In single precision: it is a small part of the rotation.
    twists: [f32; 3],
}

/// The corner into which a direction at a vertex leads.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Wedge {
    pub corner: u32,
    /// The direction of its middle in the plane of the vertex, but for the last corner of an open fan.
    pub middle: f64,
    /// Whether it is the last corner of an open fan, beyond which there is no surface.
    pub is_last_of_open: bool,
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
            bends: Vec::with_capacity(count),
            fits: vec![
                Fit {
                    rotations: [DVec2::X; 3],
                    twists: [0.0; 3],
                };
                charts.len()
            ],
        };
        fans.offsets.push(0);
        for vertex in (0..count as u32).map(SurfaceVertex) {
            match topology.faces(vertex, &surface.triangles).next() {
                Some(first) => fans.add(corner_at(surface, first, vertex), hinges, charts),
                None => fans.bends.push(0.0),
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
            let fit = &mut self.fits[corner as usize / 3];
            fit.rotations[k] = rotation_between(middle, here);
            fit.twists[k] = ((scale - 1.0) * angle) as f32;
            self.corners.push(corner);
            self.starts.push(scale * start);
            start += angle;
        }
        self.bends.push(scale.recip() - 1.0);
    }

    /// The corners at a vertex, counterclockwise.
    #[inline(always)]
    pub fn corners(&self, vertex: usize) -> &[u32] {
        &self.corners[self.offsets[vertex] as usize..self.offsets[vertex + 1] as usize]
    }

    /// The rotation from a corner's triangle to the tangent plane of its vertex.
    #[inline(always)]
    pub fn rotation(&self, corner: u32) -> DVec2 {
        self.fits[corner as usize / 3].rotations[corner as usize % 3]
    }

    /// By how much that rotation is more along the corner's last edge than along its first.
    #[inline(always)]
    pub fn twist(&self, corner: u32) -> f64 {
        f64::from(self.fits[corner as usize / 3].twists[corner as usize % 3])
    }

    /// Brings what is known of some triangles near to the processor, in the order in which it is stored.
    pub fn read_ahead(&self, triangles: Range<usize>) {
        black_box(self.fits[triangles].iter().map(|fit| fit.rotations[0].x).sum::<f64>());
    }

    /// The twists of a triangle's corners.
    #[inline(always)]
    pub fn twists(&self, triangle: usize) -> [f64; 3] {
        self.fits[triangle].twists.map(f64::from)
    }

    /// Angle on the surface over angle in the plane of a vertex, less 1: 0 at borders.
    #[inline(always)]
    pub fn bend(&self, vertex: usize) -> f64 {
        self.bends[vertex]
    }

    /// The rotations from a triangle to the tangent planes of its vertices, in the middles of its corners.
    #[inline(always)]
    pub fn rotations(&self, triangle: usize) -> [DVec2; 3] {
        self.fits[triangle].rotations
    }

    /// The wedge into which the direction at an angle in the plane of a vertex leads; `None` if it is bare.
    #[inline(always)]
    pub fn wedge(&self, vertex: usize, angle: f64) -> Option<Wedge> {
        let corners = self.offsets[vertex] as usize..self.offsets[vertex + 1] as usize;
        let starts = &self.starts[corners.clone()];
        // Counted without branches, which would be guessed wrong as often as not.
        let begun: usize = starts.iter().map(|&start| usize::from(start <= angle)).sum();
        let place = begun.saturating_sub(1);
        let start = *starts.get(place)?;
        let until = starts.get(place + 1).copied().unwrap_or(TAU);
        Some(Wedge {
            corner: self.corners[corners.start + place],
            middle: 0.5 * (start + until),
            is_last_of_open: self.bends[vertex] == 0.0 && place + 1 == starts.len(),
        })
    }

    /// The way that begins at a vertex of a border with `direction`, at `angle` in its plane, in the last of its corners,
    /// or that of no length. A direction that leaves the surface is projected to the border's nearer edge.
    pub fn way_at_border(&self, vertex: usize, direction: DVec2, angle: f64, charts: &[Chart]) -> Way {
        let corners = self.corners(vertex);
        let (first, end) = (corners[0], corners[corners.len() - 1]);
        let still = Way {
            corner: first,
            direction: DVec2::ZERO,
        };
        if direction == DVec2::ZERO {
            return still;
        }
        let start = self.starts[self.offsets[vertex + 1] as usize - 1];
        if angle - start > charts[end as usize / 3].angle(end as usize % 3) {
            return self
                .along_border(vertex, direction, (first, end), charts)
                .unwrap_or(still);
        }
        Way {
            corner: end,
            direction: turned_back(self.rotation(end), direction),
        }
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
