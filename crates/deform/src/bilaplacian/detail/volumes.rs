//! Displacement volumes: the prism between a triangle of the base and that of the surface keeps its volume [BK03].
//!
//! Normal displacements are where iteration begins. Then each prism tells which height it lacks for its volume of rest,
//! each vertex moves along the base's normal by the mean of what its prisms lack, weighted by what they gain from it, and
//! so on: Cimmino's iteration for one linear equation a prism. Every vertex moves at once, so the result does not depend
//! on their order. What alternates from vertex to vertex leaves the volumes as they are, and stays as it began.
//!
//! Over a triangle of corners b the displacements o vary linearly, and the triangle with corners b + s o has the area
//! vector A(s). So with m the mean of o the volume is m · ∫ A ds, and along the normals n the heights h_i change it by
//! about n_i · ∫ A ds / 3 each.

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
    /// For each row where its entries of `corners` begin; one more at the end.
    starts: Vec<u32>,
    /// Three times a prism's place, plus the corner at which the row is.
    corners: Vec<u32>,
    /// The most that the iterations change each row's height.
    most: Vec<f64>,
    room: Room,
}

/// A prism's corners as local vertices of the base, and their rows, [`NONE`] where fairing left the vertex.
#[derive(Clone, Copy, Debug)]
struct Prism {
    locals: [u32; 3],
    rows: [u32; 3],
}

/// What is kept from frame to frame, so that none allocates it.
#[derive(Clone, Debug, Default)]
struct Room {
    offsets: Vec<DVec3>,
    normals: Vec<DVec3>,
    lacks: Vec<Lack>,
    /// What the iterations add along the normals, and the same before it is smoothed.
    heights: Vec<f64>,
    rough: Vec<f64>,
}

/// What a prism lacks.
#[derive(Clone, Copy, Debug, Default)]
struct Lack {
    height: f64,
    /// By how much a height at each corner adds to the volume; 0 where the prism is folded there.
    gains: [f64; 3],
    /// What a gain has to exceed to count in full.
    least: f64,
}

/// The most that a height changes in an iteration, in units of the prism's longest displacement: where a prism is folded
/// its volume hardly depends on its heights.
const STEP: f64 = 0.5;

/// The most that all iterations change a height, in units of the longest displacement around it at rest: where the base
/// is bent more sharply than its details are high, no heights give the volumes of rest.
const MOST: f64 = 0.5;

/// How much of each height is taken from its neighbours in an iteration. What alternates from vertex to vertex hardly
/// changes a volume, so nothing else would hold it back.
const SMOOTHING: f64 = 0.5;

/// A prism that gains less than this share of its triangles' area by its heights is folded or stands upright.
const UPRIGHT: f64 = 0.03;

impl Volumes {
    /// Of the base's faces.
    pub fn of(base: &Base, iterations: u32, triangles: &[[SurfaceVertex; 3]], topology: &Topology) -> Self {
        let mut row_of = vec![NONE; base.vertices.len()];
        for (row, &local) in base.rows.iter().enumerate().filter(|(row, _)| base.is_faired[*row]) {
            row_of[local as usize] = row as u32;
        }
        let mut numbers: Vec<u32> = Vec::new();
        let mut is_taken = vec![false; triangles.len()];
        for (row, &local) in base.rows.iter().enumerate() {
            if base.is_faired[row] {
                let vertex = SurfaceVertex(base.vertices[local as usize]);
                numbers.extend(
                    topology
                        .faces(vertex, triangles)
                        .filter(|&face| !std::mem::replace(&mut is_taken[face as usize], true)),
                );
            }
        }
        let prism = |&number: &u32| {
            let corners = triangles[number as usize].map(|corner| base.vertices.partition_point(|&v| v < corner.0));
            Prism {
                locals: corners.map(|local| local as u32),
                rows: corners.map(|local| row_of[local]),
            }
        };
        let prisms: Vec<Prism> = numbers.par_iter().with_min_len(CHUNK).map(prism).collect();
        let mut starts = vec![0; base.rows.len() + 1];
        for row in prisms.iter().flat_map(|prism| prism.rows).filter(|&row| row != NONE) {
            starts[row as usize + 1] += 1;
        }
        for row in 0..base.rows.len() {
            starts[row + 1] += starts[row];
        }
        let mut next = starts.clone();
        let mut corners = vec![0; starts[base.rows.len()] as usize];
        for (place, prism) in prisms.iter().enumerate() {
            for (corner, &row) in prism.rows.iter().enumerate().filter(|(_, row)| **row != NONE) {
                corners[next[row as usize] as usize] = (3 * place + corner) as u32;
                next[row as usize] += 1;
            }
        }
        let frames = Frames::of(base, triangles, topology);
        let offsets = frames.at_rest();
        let volume = |prism: &Prism| measure(prism, &base.rest, offsets).volume;
        let around = |row: usize| corners[starts[row] as usize..starts[row + 1] as usize].iter();
        let length = |row: &u32| offsets.get(*row as usize).map_or(0.0, |offset| offset.length());
        let longest = |row: usize| {
            let rows = around(row).flat_map(|&entry| &prisms[entry as usize / 3].rows);
            rows.map(length).fold(0.0, f64::max)
        };
        let most = (0..base.rows.len())
            .into_par_iter()
            .with_min_len(CHUNK)
            .map(|row| MOST * longest(row))
            .collect();
        Self {
            volumes: prisms.par_iter().with_min_len(CHUNK).map(volume).collect(),
            frames,
            iterations,
            prisms,
            starts,
            corners,
            most,
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
            normals,
            lacks,
            heights,
            rough,
        } = &mut room;
        heights.clear();
        heights.resize(base.rows.len(), 0.0);
        (0..base.rows.len())
            .into_par_iter()
            .with_min_len(CHUNK)
            .map(|row| self.frames.turned(base, row, posed, turns))
            .unzip_into_vecs(offsets, normals);
        for _ in 0..self.iterations {
            self.prisms
                .par_iter()
                .zip(&self.volumes)
                .with_min_len(CHUNK)
                .map(|(prism, &volume)| lack(prism, volume, posed, offsets, normals))
                .collect_into_vec(lacks);
            let next = |row: usize| (heights[row] + self.mean(row, lacks)).clamp(-self.most[row], self.most[row]);
            (0..base.rows.len())
                .into_par_iter()
                .with_min_len(CHUNK)
                .map(next)
                .collect_into_vec(rough);
            (&mut *offsets, &mut *heights, &*normals)
                .into_par_iter()
                .enumerate()
                .with_min_len(CHUNK)
                .for_each(|(row, (offset, height, &normal))| {
                    let next = rough[row] + SMOOTHING * (self.beside(row, rough) - rough[row]);
                    *offset += normal * (next - *height);
                    *height = next;
                });
        }
        self.room = room;
    }

    /// The mean of the heights around a row; its own where it has no prism.
    #[inline]
    fn beside(&self, row: usize, heights: &[f64]) -> f64 {
        let own = &self.corners[self.starts[row] as usize..self.starts[row + 1] as usize];
        if own.is_empty() {
            return heights[row];
        }
        // The corner's own height is left out; where fairing left a corner its height is 0.
        let others = own.iter().map(|&entry| {
            let rows = &self.prisms[entry as usize / 3].rows;
            let all: f64 = rows.iter().filter_map(|&row| heights.get(row as usize)).sum();
            all - heights[row]
        });
        others.sum::<f64>() / (2 * own.len()) as f64
    }

    /// The mean of what the prisms around a row lack.
    #[inline]
    fn mean(&self, row: usize, lacks: &[Lack]) -> f64 {
        let (mut sum, mut weight) = (0.0, 0.0);
        for &entry in &self.corners[self.starts[row] as usize..self.starts[row + 1] as usize] {
            let lack = &lacks[entry as usize / 3];
            let gain = lack.gains[entry as usize % 3];
            sum += gain * lack.height;
            weight += gain + lack.least;
        }
        if weight > 0.0 { sum / weight } else { 0.0 }
    }
}

/// A prism, measured.
struct Measured {
    volume: f64,
    /// ∫ A ds.
    area: DVec3,
    /// The mean of the base's area and the surface's.
    size: f64,
    /// The longest displacement.
    longest: f64,
}

#[inline]
fn measure(prism: &Prism, posed: &[DVec3], offsets: &[DVec3]) -> Measured {
    let [a, b, c] = prism.locals.map(|local| posed[local as usize]);
    let displacements = prism
        .rows
        .map(|row| offsets.get(row as usize).copied().unwrap_or(DVec3::ZERO));
    let [p, q, r] = displacements;
    let (u, v) = (b - a, c - a);
    let (u_top, v_top) = (u + (q - p), v + (r - p));
    let (bottom, top) = (u.cross(v), u_top.cross(v_top));
    let area = (bottom + top) / 6.0 + (u.cross(v_top) + u_top.cross(v)) / 12.0;
    Measured {
        volume: (p + q + r).dot(area) / 3.0,
        area,
        size: 0.25 * (bottom.length() + top.length()),
        longest: displacements.iter().map(|d| d.length()).fold(0.0, f64::max),
    }
}

#[inline]
fn lack(prism: &Prism, volume: f64, posed: &[DVec3], offsets: &[DVec3], normals: &[DVec3]) -> Lack {
    let now = measure(prism, posed, offsets);
    let gains = prism.rows.map(|row| {
        normals
            .get(row as usize)
            .map_or(0.0, |normal| (normal.dot(now.area) / 3.0).max(0.0))
    });
    let gain: f64 = gains.iter().sum();
    let least = UPRIGHT * now.size;
    let square = gain * gain + least * least;
    let height = if square > 0.0 {
        (volume - now.volume) * gain / square
    } else {
        0.0
    };
    let most = STEP * now.longest;
    Lack {
        height: height.clamp(-most, most),
        gains,
        least: least / 3.0,
    }
}
