//! Displacement volumes: the prism between a triangle of the base and that of the surface keeps its volume [BK03].
//!
//! Iteration begins with normal displacements. Then the vertex scales its displacement o by the volume that the prisms
//! around it lack, as if all of the ring scaled by as much: with A the sum of the ring's area vectors, by 1 + Σ lack /
//! (o · A). So details keep their direction, and no normal of the base is needed, which does not exist where the base
//! shrinks to a line. As neighbours scale by about as much, two corrections leave some percent of the lack, and further
//! ones only sharpen differences from vertex to vertex; iteration ends there. Over a thin sheet, whose base is hardly
//! more than a line, prisms give no information, and little or nothing is corrected.
//!
//! Over a triangle of corners b the displacements o vary linearly, and the triangle with corners b + s o has the area
//! vector A(s). So with m the mean of o the volume is m · ∫ A ds.

use glam::{DMat3, DVec3};
use pliant_mesh::SurfaceVertex;
use rayon::prelude::*;

use super::base::Base;
use super::donors::NONE;
use super::frames::Frames;
use super::sheets::Sheets;
use crate::numerical::rows::CHUNK;
use crate::region::boundary_problem::BoundaryProblem;

/// The prisms over the base, and the frames that the iteration begins with.
#[derive(Debug)]
pub(crate) struct Volumes {
    frames: Frames,
    iterations: u32,
    prisms: Vec<Prism>,
    /// The prisms at rest, from the displacements at rest.
    volumes: Vec<f64>,
    /// The start of each row's entries of `around`; one more at the end.
    starts: Vec<u32>,
    /// The places of the prisms around the rows.
    around: Vec<u32>,
    /// For each row the least o · A, squared, that counts in full: a ring with less is folded or hardly displaced.
    least_squares: Vec<f64>,
    /// The weight of each row's correction, from [`Sheets::bodies`].
    bodies: Vec<f64>,
    room: Room,
}

/// A prism's corners as local vertices of the base, and their rows; one row after the last if fairing left the vertex.
#[derive(Clone, Copy, Debug)]
struct Prism {
    locals: [u32; 3],
    rows: [u32; 3],
}

/// Buffers kept from frame to frame, so that no frame allocates them.
#[derive(Clone, Debug, Default)]
struct Room {
    /// The displacements as the base turns them.
    turned: Vec<DVec3>,
    /// The scaled displacements; one more than there are rows, the last one zero.
    offsets: Vec<DVec3>,
    lacks: Vec<Lack>,
    /// The excess of the scales over 1.
    growths: Vec<f64>,
    /// The same before they are smoothed; one more than there are rows, the last one zero.
    rough: Vec<f64>,
}

/// The volume that a prism lacks, and the area vector of its triangle of the surface.
#[derive(Clone, Copy, Debug, Default)]
struct Lack {
    volume: f64,
    area: DVec3,
}

/// The largest growth or shrinkage of a displacement, as a share of it: if the base's radius of bending is less than
/// the height of its details, no scales give the volumes of rest.
const MOST: f64 = 0.4;

/// The share of each scale that comes from its neighbours in a correction: neighbours with different scales crumple the
/// surface.
const SMOOTHING: f64 = 0.5;

/// If o · A counts, it is at least this share of the largest value that a ring's area and longest displacement at rest
/// allow.
const FOLDED: f64 = 0.1;

/// Corrections end with one whose root mean square is below this.
const SMALL: f64 = 0.05;

impl Volumes {
    /// The prisms of the base's faces.
    pub fn of(base: &Base, sheets: Option<&Sheets>, iterations: u32, problem: &BoundaryProblem<'_>) -> Self {
        let (triangles, topology) = (&problem.surface.triangles, problem.topology);
        let count = base.patch.rows.len();
        let mut row_of = vec![count as u32; base.patch.vertices.len()];
        for (row, &local) in base
            .patch
            .rows
            .iter()
            .enumerate()
            .filter(|(row, _)| base.is_faired[*row])
        {
            row_of[local as usize] = row as u32;
        }
        let mut local_of = vec![NONE; base.patch.vertices.last().map_or(0, |&last| last as usize + 1)];
        for (local, &vertex) in (0..).zip(&base.patch.vertices) {
            local_of[vertex as usize] = local;
        }
        let mut prisms: Vec<Prism> = Vec::new();
        let mut is_taken = vec![false; triangles.len()];
        for (row, &local) in base.patch.rows.iter().enumerate() {
            if !base.is_faired[row] {
                continue;
            }
            let vertex = SurfaceVertex(base.patch.vertices[local as usize]);
            for face in topology.faces(vertex, triangles) {
                if !std::mem::replace(&mut is_taken[face as usize], true) {
                    let locals = triangles[face as usize].map(|corner| local_of[corner.index()]);
                    let rows = locals.map(|local| row_of[local as usize]);
                    prisms.push(Prism { locals, rows });
                }
            }
        }
        let own_rows = |prism: &Prism| prism.rows.into_iter().filter(move |&row| (row as usize) < count);
        let mut starts = vec![0; count + 1];
        for row in prisms.iter().flat_map(own_rows) {
            starts[row as usize + 1] += 1;
        }
        for row in 0..count {
            starts[row + 1] += starts[row];
        }
        let mut next = starts.clone();
        let mut around = vec![0; starts[count] as usize];
        for (place, prism) in (0..).zip(&prisms) {
            for row in own_rows(prism) {
                around[next[row as usize] as usize] = place;
                next[row as usize] += 1;
            }
        }
        let frames = Frames::of(base, triangles, topology);
        let mut offsets = frames.at_rest().to_vec();
        offsets.push(DVec3::ZERO);
        let measured: Vec<Lack> = prisms
            .par_iter()
            .with_min_len(CHUNK)
            .map(|prism| measure(prism, &base.patch.rest, &offsets))
            .collect();
        let least_square = |row: usize| {
            let around = || around[starts[row] as usize..starts[row + 1] as usize].iter();
            let rows = around().flat_map(|&place| prisms[place as usize].rows);
            let longest = rows.map(|row| offsets[row as usize].length()).fold(0.0, f64::max);
            let area: f64 = around().map(|&place| measured[place as usize].area.length()).sum();
            (FOLDED * area * longest).powi(2)
        };
        Self {
            least_squares: (0..count)
                .into_par_iter()
                .with_min_len(CHUNK)
                .map(least_square)
                .collect(),
            volumes: measured.iter().map(|measured| measured.volume).collect(),
            bodies: sheets.map_or_else(|| vec![1.0; count], |sheets| sheets.bodies(base)),
            frames,
            iterations,
            prisms,
            starts,
            around,
            room: Room::default(),
        }
    }

    /// The last frame's addition to a row's displacement from the base.
    #[inline]
    pub fn change(&self, row: usize) -> DVec3 {
        self.room.offsets[row] - self.frames.at_rest()[row]
    }

    /// Displaces the bent base.
    pub fn frame(&mut self, base: &Base, posed: &[DVec3], turns: &[DMat3]) {
        let mut room = std::mem::take(&mut self.room);
        let Room {
            turned,
            offsets,
            lacks,
            growths,
            rough,
        } = &mut room;
        let count = base.patch.rows.len();
        (0..count)
            .into_par_iter()
            .with_min_len(CHUNK)
            .map(|row| self.frames.turned(base, row, posed, turns))
            .collect_into_vec(turned);
        offsets.clone_from(turned);
        offsets.push(DVec3::ZERO);
        growths.clear();
        growths.resize(count, 0.0);
        rough.resize(count + 1, 0.0);
        for _ in 0..self.iterations {
            self.prisms
                .par_iter()
                .zip(&self.volumes)
                .with_min_len(CHUNK)
                .map(|(prism, &volume)| {
                    let now = measure(prism, posed, offsets);
                    Lack {
                        volume: volume - now.volume,
                        ..now
                    }
                })
                .collect_into_vec(lacks);
            self.grow(turned, lacks, growths, &mut rough[..count]);
            if self.smooth(rough, turned, &mut offsets[..count], growths) {
                break;
            }
        }
        self.room = room;
    }

    /// Finds the growth of every row that gives its ring the volume of rest.
    fn grow(&self, turned: &[DVec3], lacks: &[Lack], growths: &[f64], rough: &mut [f64]) {
        let rows = rough.par_iter_mut().zip(turned).enumerate();
        rows.with_min_len(CHUNK).for_each(|(row, (rough, turned))| {
            let (mut volume, mut area) = (0.0, DVec3::ZERO);
            for &prism in self.around(row) {
                let lack = &lacks[prism as usize];
                volume += lack.volume;
                area += lack.area;
            }
            let gain = turned.dot(area);
            let square = gain * gain + self.least_squares[row];
            let growth = if square > 0.0 { volume * gain / square } else { 0.0 };
            *rough = self.bodies[row] * (growths[row] + growth).clamp(-MOST, MOST);
        });
    }

    /// Scales every row by its smoothed growth; returns whether that was the last correction.
    fn smooth(&self, rough: &[f64], turned: &[DVec3], offsets: &mut [DVec3], growths: &mut [f64]) -> bool {
        let chunk = |(chunk, (offsets, growths)): (usize, (&mut [DVec3], &mut [f64]))| {
            let mut moved = 0.0;
            for (place, (offset, growth)) in offsets.iter_mut().zip(growths).enumerate() {
                let row = chunk * CHUNK + place;
                let around = self.around(row);
                // Every prism has the row itself and two beside it; rows that fairing left do not grow.
                let mut ring = 0.0;
                for &prism in around {
                    let [a, b, c] = self.prisms[prism as usize].rows.map(|row| rough[row as usize]);
                    ring += a + b + c;
                }
                let count = around.len().max(1) as f64;
                let beside = (ring - count * rough[row]) / (2.0 * count);
                let next = rough[row] + SMOOTHING * (beside - rough[row]);
                *offset = turned[row] + turned[row] * next;
                moved += (next - *growth).powi(2);
                *growth = next;
            }
            moved
        };
        let sums: Vec<f64> = offsets
            .par_chunks_mut(CHUNK)
            .zip(growths.par_chunks_mut(CHUNK))
            .enumerate()
            .map(chunk)
            .collect();
        sums.iter().sum::<f64>() <= SMALL * SMALL * turned.len() as f64
    }

    /// The places of the prisms around a row.
    #[inline]
    fn around(&self, row: usize) -> &[u32] {
        &self.around[self.starts[row] as usize..self.starts[row + 1] as usize]
    }
}

/// A prism's volume and the area vector of its triangle of the surface.
#[inline]
fn measure(prism: &Prism, posed: &[DVec3], offsets: &[DVec3]) -> Lack {
    let [a, b, c] = prism.locals.map(|local| posed[local as usize]);
    let [p, q, r] = prism.rows.map(|row| offsets[row as usize]);
    let (u, v) = (b - a, c - a);
    let (u_top, v_top) = (u + (q - p), v + (r - p));
    let (bottom, top) = (u.cross(v), u_top.cross(v_top));
    let mean = (bottom + top) / 6.0 + (u.cross(v_top) + u_top.cross(v)) / 12.0;
    Lack {
        volume: (p + q + r).dot(mean) / 3.0,
        area: top * 0.5,
    }
}
