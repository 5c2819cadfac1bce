//! The Hessian's part that the Laplacian does not see, by mixed finite elements [SGWJ18], on curved triangles [SJWG20].
//!
//! At an inner vertex i the mean Hessian H_i of f over M_ii is −Σ_t A_t ∇φ_i ∇fᵀ / M_ii over the triangles t around i,
//! φ_i being i's hat function. The triangles' gradients are compared in the plane into which the ring unrolls, its angles
//! stretched to 2π. Its trace is (M⁻¹ L f)_i; with the trace-free part
//!
//! H_i = ½ tr(H_i) I + [a b; b −a], |H_i|² = ½ tr(H_i)² + 2 a² + 2 b²,
//!
//! which on a plane is zero for linear functions alone, while the trace is zero for all harmonic ones. The rows here
//! give M_ii a and M_ii b. At a border vertex there is no such mean [SGWJ18, section 4]; there they are M_ii / (√2 ℓ)
//! times the change of the gradient from the first triangle of the fan to the last, ℓ apart, so that 2 (a² + b²) is
//! |H t|² along the border t.

use pliant_mesh::{SurfaceVertex, cotangents};
use rayon::prelude::*;

use super::Laplacian;
use super::mollification::lack;
use super::triangulation::Triangulation;
use crate::numerical::rows::{CHUNK, place_in};

/// The surroundings of a vertex.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub(crate) enum RingKind {
    /// No single fan: its Hessian is unknown.
    #[default]
    Unknown,
    /// Triangles all around.
    Closed,
    /// A border vertex, and its two neighbours along the border, by local number.
    Fan([u32; 2]),
}

/// M a and M b as linear functions, one pair of rows for each full row of a Laplacian.
#[derive(Debug)]
pub(crate) struct RingHessian {
    kinds: Vec<RingKind>,
    /// The first entry of each local vertex; entries are in the order of the Laplacian's neighbours.
    offsets: Vec<usize>,
    /// The coefficients of each neighbour in the vertex' own rows; its own is minus their sum.
    own: Vec<[f64; 2]>,
    /// The coefficients of the vertex in each neighbour's rows.
    back: Vec<[f64; 2]>,
    /// The coefficients of each vertex in its own rows.
    diagonal: Vec<[f64; 2]>,
}

/// A triangle around a vertex: the two neighbours, the lengths to them, and the length between them.
#[derive(Clone, Copy)]
struct Spoke {
    ends: [u32; 2],
    lengths: [f64; 2],
    angle: f64,
    area: f64,
}

impl RingHessian {
    /// The Hessian for the full rows of `laplacian`, which has the same triangulation.
    pub fn of(triangulation: &Triangulation, laplacian: &Laplacian) -> Self {
        let count = laplacian.vertices().len();
        let mut offsets = vec![0];
        for local in 0..count {
            offsets.push(offsets[local] + laplacian.neighbours(local).len());
        }
        let rows: Vec<(RingKind, Vec<[f64; 2]>)> = (0..count)
            .into_par_iter()
            .with_min_len(CHUNK)
            .map(|local| row(triangulation, laplacian, local))
            .collect();
        let kinds = rows.iter().map(|(kind, _)| *kind).collect();
        let own: Vec<[f64; 2]> = rows.into_iter().flat_map(|(_, row)| row).collect();
        let diagonal = (0..count)
            .map(|local| {
                let sum = |k: usize| {
                    -own[offsets[local]..offsets[local + 1]]
                        .iter()
                        .map(|e| e[k])
                        .sum::<f64>()
                };
                [sum(0), sum(1)]
            })
            .collect();
        let mut back = vec![[0.0; 2]; own.len()];
        for local in 0..count {
            for (place, &other) in laplacian.neighbours(local).iter().enumerate() {
                let other = other as usize;
                if let Some(there) = place_in(laplacian.neighbours(other), &(local as u32)) {
                    back[offsets[local] + place] = own[offsets[other] + there];
                }
            }
        }
        Self {
            kinds,
            offsets,
            own,
            back,
            diagonal,
        }
    }

    /// The surroundings of each local vertex.
    pub fn kinds(&self) -> &[RingKind] {
        &self.kinds
    }

    /// The coefficients of a local vertex' neighbours in its rows.
    pub fn own(&self, local: usize) -> &[[f64; 2]] {
        &self.own[self.offsets[local]..self.offsets[local + 1]]
    }

    /// The coefficients of a local vertex in its neighbours' rows.
    pub fn back(&self, local: usize) -> &[[f64; 2]] {
        &self.back[self.offsets[local]..self.offsets[local + 1]]
    }

    /// The coefficients of a local vertex in its own rows.
    pub fn diagonal(&self, local: usize) -> [f64; 2] {
        self.diagonal[local]
    }

    /// M a and M b for f at a local vertex.
    #[inline]
    pub fn row<const K: usize>(&self, laplacian: &Laplacian, local: usize, f: &[[f64; K]]) -> [[f64; K]; 2] {
        let own = f[local];
        let mut sums = [[0.0; K]; 2];
        for (&other, entry) in laplacian.neighbours(local).iter().zip(self.own(local)) {
            let other = f[other as usize];
            for k in 0..K {
                let change = other[k] - own[k];
                sums[0][k] += entry[0] * change;
                sums[1][k] += entry[1] * change;
            }
        }
        sums
    }
}

/// A vertex' kind and its rows.
fn row(triangulation: &Triangulation, laplacian: &Laplacian, local: usize) -> (RingKind, Vec<[f64; 2]>) {
    let neighbours = laplacian.neighbours(local);
    let mut entries = vec![[0.0; 2]; neighbours.len()];
    let unknown = |entries| (RingKind::Unknown, entries);
    let Some(mut spokes) = spokes(triangulation, laplacian, local) else {
        return unknown(entries);
    };
    let Some(is_closed) = chain(&mut spokes) else {
        return unknown(entries);
    };
    let place = |vertex: u32| place_in(neighbours, &vertex).unwrap_or(0);
    let whole: f64 = spokes.iter().map(|spoke| spoke.angle).sum();
    let stretch = if is_closed { std::f64::consts::TAU / whole } else { 1.0 };
    let mut start = 0.0;
    let unrolled: Vec<Unrolled> = spokes
        .iter()
        .map(|spoke| {
            let middle = start + 0.5 * stretch * spoke.angle;
            start += stretch * spoke.angle;
            Unrolled::of(spoke, middle)
        })
        .collect();
    if is_closed {
        for (spoke, flat) in spokes.iter().zip(&unrolled) {
            for (end, gradient) in spoke.ends.into_iter().zip(flat.gradients) {
                let entry = &mut entries[place(end)];
                let [x, y] = flat.own();
                entry[0] -= 0.5 * spoke.area * (x * gradient[0] - y * gradient[1]);
                entry[1] -= 0.5 * spoke.area * (x * gradient[1] + y * gradient[0]);
            }
        }
        let share = triangulation.share();
        entries.iter_mut().flatten().for_each(|value| *value *= share);
        return (RingKind::Closed, entries);
    }
    let (first, last) = (&unrolled[0], &unrolled[unrolled.len() - 1]);
    let kind = RingKind::Fan([spokes[0].ends[0], spokes[spokes.len() - 1].ends[1]]);
    let apart: f64 = unrolled.windows(2).map(|pair| pair[0].apart(&pair[1])).sum();
    let inverse_area = laplacian.inverse_areas()[local];
    if apart > 0.0 && inverse_area > 0.0 {
        let factor = std::f64::consts::FRAC_1_SQRT_2 / (apart * inverse_area);
        for (spoke, flat, sign) in [(spokes[0], first, -1.0), (spokes[spokes.len() - 1], last, 1.0)] {
            for (end, gradient) in spoke.ends.into_iter().zip(flat.gradients) {
                let entry = &mut entries[place(end)];
                entry[0] += sign * factor * gradient[0];
                entry[1] += sign * factor * gradient[1];
            }
        }
    }
    (kind, entries)
}

/// A triangle in the plane, the vertex at the origin.
struct Unrolled {
    /// The gradients of the two ends' hat functions.
    gradients: [[f64; 2]; 2],
    centre: [f64; 2],
}

impl Unrolled {
    /// The triangle with its bisector in the direction `middle`.
    fn of(spoke: &Spoke, middle: f64) -> Self {
        let end = |length: f64, angle: f64| [length * angle.cos(), length * angle.sin()];
        let [p, q] = [
            end(spoke.lengths[0], middle - 0.5 * spoke.angle),
            end(spoke.lengths[1], middle + 0.5 * spoke.angle),
        ];
        let twice = 2.0 * spoke.area;
        Self {
            gradients: [[q[1] / twice, -q[0] / twice], [-p[1] / twice, p[0] / twice]],
            centre: [(p[0] + q[0]) / 3.0, (p[1] + q[1]) / 3.0],
        }
    }

    /// The gradient of the vertex' own hat function.
    fn own(&self) -> [f64; 2] {
        let [p, q] = self.gradients;
        [-(p[0] + q[0]), -(p[1] + q[1])]
    }

    fn apart(&self, other: &Self) -> f64 {
        (self.centre[0] - other.centre[0]).hypot(self.centre[1] - other.centre[1])
    }
}

/// The triangles around a vertex; `None` if one has a vertex twice, or a neighbour has more than two of them.
fn spokes(triangulation: &Triangulation, laplacian: &Laplacian, local: usize) -> Option<Vec<Spoke>> {
    let vertex = SurfaceVertex(laplacian.vertices()[local]);
    let neighbours = laplacian.neighbours(local);
    let mut spokes = Vec::with_capacity(neighbours.len());
    let mut is_sound = !neighbours.is_empty();
    let mut counts = vec![0_u8; neighbours.len()];
    triangulation.for_each_face(vertex, |face| {
        let corners = triangulation.corners(face);
        let own: Vec<usize> = (0..3).filter(|&corner| corners[corner] == vertex).collect();
        let [own] = own[..] else {
            is_sound = false;
            return;
        };
        let [first, second] = [(own + 1) % 3, (own + 2) % 3];
        let places = [first, second].map(|corner| {
            let number = laplacian.local(corners[corner].0).map(|local| local as u32);
            number.and_then(|number| place_in(neighbours, &number))
        });
        let [Some(p), Some(q)] = places else {
            is_sound = false;
            return;
        };
        is_sound &= p != q;
        counts[p] = counts[p].saturating_add(1);
        counts[q] = counts[q].saturating_add(1);
        let lengths = triangulation.lengths(face);
        let longer = lack(lengths).max(0.0);
        let lengths = lengths.map(|length| length + longer);
        let cotangents = cotangents(lengths);
        let angle = 1.0_f64.atan2(cotangents[own]);
        let legs = [lengths[second], lengths[first]];
        spokes.push(Spoke {
            ends: [neighbours[p], neighbours[q]],
            lengths: legs,
            angle,
            area: 0.5 * legs[0] * legs[1] * angle.sin(),
        });
    });
    let is_sound = is_sound && counts.iter().all(|&count| count <= 2) && spokes.iter().all(|s| s.area > 0.0);
    (is_sound && !spokes.is_empty()).then_some(spokes)
}

/// Sorts the triangles around the vertex, each turned so that its second neighbour is the next one's first; returns
/// whether they go all around, `None` if they are not one fan.
fn chain(spokes: &mut [Spoke]) -> Option<bool> {
    let uses = |vertex: u32, spokes: &[Spoke]| spokes.iter().filter(|spoke| spoke.ends.contains(&vertex)).count();
    let mut ends: Vec<(usize, usize)> = Vec::new();
    for (number, spoke) in spokes.iter().enumerate() {
        for (side, &end) in spoke.ends.iter().enumerate() {
            if uses(end, spokes) == 1 {
                ends.push((number, side));
            }
        }
    }
    let is_closed = match ends.len() {
        0 => true,
        2 => false,
        _ => return None,
    };
    let (first, side) = ends.first().copied().unwrap_or((0, 0));
    spokes.swap(0, first);
    if side == 1 {
        spokes[0].turn();
    }
    for place in 1..spokes.len() {
        let last = spokes[place - 1].ends[1];
        let next = (place..spokes.len()).find(|&other| spokes[other].ends.contains(&last))?;
        spokes.swap(place, next);
        if spokes[place].ends[1] == last {
            spokes[place].turn();
        }
    }
    let begins = spokes[0].ends[0] == spokes[spokes.len() - 1].ends[1];
    (begins == is_closed).then_some(is_closed)
}

impl Spoke {
    fn turn(&mut self) {
        self.ends.swap(0, 1);
        self.lengths.swap(0, 1);
    }
}
