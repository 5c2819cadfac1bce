//! Displacement volumes: the prism between a triangle of the base and that of the surface keeps its volume [BK03].
//!
//! Normal displacements are where iteration begins. Then the prisms around a vertex tell which volume they lack, and the
//! vertex moves along the surface's normal until its ring would have it, if all of the ring moved as far: with A the sum
//! of the ring's area vectors by A Σ lack / |A|². The surface has a normal also where the base shrinks to a line. As
//! neighbours move about as far, two corrections leave some percent of what was lacking, and a third only sharpens what
//! differs from vertex to vertex; iteration ends there.
//!
//! Over a triangle of corners b the displacements o vary linearly, and the triangle with corners b + s o has the area
//! vector A(s). So with m the mean of o the volume is m · ∫ A ds.

use glam::{DMat3, DVec3};
use pliant_mesh::{SurfaceVertex, Topology};
use rayon::prelude::*;

use super::base::Base;
use super::donors::NONE;
use super::frames::Frames;
use crate::operators::CHUNK;

/// The prisms over the base, and the frames that the iteration begins with.
#[derive(Debug)]
pub(crate) struct Volumes {
    frames: Frames,
    iterations: u32,
    prisms: Vec<Prism>,
    /// At rest, from the displacements at rest.
    volumes: Vec<f64>,
    /// For each row where its entries of `around` begin; one more at the end.
    starts: Vec<u32>,
    /// The places of the prisms around the rows.
    around: Vec<u32>,
    /// Of each row: what limits it.
    limits: Vec<Limit>,
    room: Room,
}

/// A prism's corners as local vertices of the base, and their rows; the row behind the last where fairing left the
/// vertex.
#[derive(Clone, Copy, Debug)]
struct Prism {
    locals: [u32; 3],
    rows: [u32; 3],
}

/// What limits a row's height.
#[derive(Clone, Copy, Debug, Default)]
struct Limit {
    /// The most that the corrections change it.
    most: f64,
    /// A ring of less than this squared area hardly has a normal, and counts in part.
    least_square: f64,
}

/// What is kept from frame to frame, so that none allocates it.
#[derive(Clone, Debug, Default)]
struct Room {
    /// One more than there are rows: the last one is zero.
    offsets: Vec<DVec3>,
    lacks: Vec<Lack>,
    /// What the corrections have added.
    heights: Vec<f64>,
}

/// The volume that a prism lacks, and the area vector of its triangle of the surface.
#[derive(Clone, Copy, Debug, Default)]
struct Lack {
    volume: f64,
    area: DVec3,
}

/// The most that all corrections change a height, in units of the longest displacement around it at rest: where the base
/// is bent more sharply than its details are high, no heights give the volumes of rest.
const MOST: f64 = 0.5;

/// A ring with less than this share of its area at rest is folded.
const FOLDED: f64 = 0.1;

/// Corrections end with one whose root mean square is below this share of the largest heights'.
const SMALL: f64 = 0.2;

impl Volumes {
    /// Of the base's faces.
    pub fn of(base: &Base, iterations: u32, triangles: &[[SurfaceVertex; 3]], topology: &Topology) -> Self {
        let count = base.rows.len();
        let mut row_of = vec![count as u32; base.vertices.len()];
        for (row, &local) in base.rows.iter().enumerate().filter(|(row, _)| base.is_faired[*row]) {
            row_of[local as usize] = row as u32;
        }
        let mut local_of = vec![NONE; base.vertices.last().map_or(0, |&last| last as usize + 1)];
        for (local, &vertex) in (0..).zip(&base.vertices) {
            local_of[vertex as usize] = local;
        }
        let mut prisms: Vec<Prism> = Vec::new();
        let mut is_taken = vec![false; triangles.len()];
        for (row, &local) in base.rows.iter().enumerate() {
            if !base.is_faired[row] {
                continue;
            }
            let vertex = SurfaceVertex(base.vertices[local as usize]);
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
            .map(|prism| measure(prism, &base.rest, &offsets))
            .collect();
        let limit = |row: usize| {
            let around = || around[starts[row] as usize..starts[row + 1] as usize].iter();
            let rows = around().flat_map(|&place| prisms[place as usize].rows);
            let longest = rows.map(|row| offsets[row as usize].length()).fold(0.0, f64::max);
            let area: f64 = around().map(|&place| measured[place as usize].area.length()).sum();
            Limit {
                most: MOST * longest,
                least_square: (FOLDED * area).powi(2),
            }
        };
        Self {
            limits: (0..count).into_par_iter().with_min_len(CHUNK).map(limit).collect(),
            volumes: measured.iter().map(|measured| measured.volume).collect(),
            frames,
            iterations,
            prisms,
            starts,
            around,
            room: Room::default(),
        }
    }

    /// What the last frame added to a row's displacement from the base.
    #[inline]
    pub fn change(&self, row: usize) -> DVec3 {
        self.room.offsets[row] - self.frames.at_rest()[row]
    }

    /// Displaces the bent base.
    pub fn frame(&mut self, base: &Base, posed: &[DVec3], turns: &[DMat3]) {
        let mut room = std::mem::take(&mut self.room);
        let Room {
            offsets,
            lacks,
            heights,
        } = &mut room;
        let count = base.rows.len();
        offsets.resize(count + 1, DVec3::ZERO);
        offsets[..count]
            .par_iter_mut()
            .enumerate()
            .with_min_len(CHUNK)
            .for_each(|(row, offset)| *offset = self.frames.turned(base, row, posed, turns));
        heights.clear();
        heights.resize(count, 0.0);
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
            if self.correct(lacks, &mut offsets[..count], heights) {
                break;
            }
        }
        self.room = room;
    }

    /// Moves every row along the surface's normal; whether that was the last correction.
    fn correct(&self, lacks: &[Lack], offsets: &mut [DVec3], heights: &mut [f64]) -> bool {
        let chunk = |(chunk, (offsets, heights)): (usize, (&mut [DVec3], &mut [f64]))| {
            let (mut moved, mut all) = (0.0, 0.0);
            for (place, (offset, height)) in offsets.iter_mut().zip(heights).enumerate() {
                let row = chunk * CHUNK + place;
                let (mut volume, mut area) = (0.0, DVec3::ZERO);
                for &prism in &self.around[self.starts[row] as usize..self.starts[row + 1] as usize] {
                    let lack = &lacks[prism as usize];
                    volume += lack.volume;
                    area += lack.area;
                }
                let Limit { most, least_square } = self.limits[row];
                let square = area.length_squared();
                if square == 0.0 {
                    continue;
                }
                let size = square.sqrt();
                let next = (*height + volume * size / (square + least_square)).clamp(-most, most);
                *offset += area * ((next - *height) / size);
                moved += (next - *height).powi(2);
                all += most * most;
                *height = next;
            }
            (moved, all)
        };
        let sums: Vec<(f64, f64)> = offsets
            .par_chunks_mut(CHUNK)
            .zip(heights.par_chunks_mut(CHUNK))
            .enumerate()
            .map(chunk)
            .collect();
        let (moved, all) = sums.iter().fold((0.0, 0.0), |sum, own| (sum.0 + own.0, sum.1 + own.1));
        moved <= SMALL * SMALL * all
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
