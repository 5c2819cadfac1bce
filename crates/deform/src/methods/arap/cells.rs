//! An ARAP energy as one stencil a cell, for any choice of its edges.
//!
//! With displacements d, D_v = d_v − d_i over a cell's ring and B_i = Σ_v D_v G_ivᵀ, a cell's matrix is S_i = S⁰_i +
//! B_i and its energy
//!
//! E_i = ¼ Σ_v w_iv |D_v|² − ⟨R_i − 1, S_i⟩,
//!
//! which is ½ Σ w |e' − R_i e|² multiplied out, so that only differences of displacements and R_i − 1 enter: it is zero
//! at rest to the last bit and keeps its digits near rest. Its gradient is
//!
//! dE/dd_i = −Σ_v w_iv D_v + (R_i − 1) Σ_v (G_iv − G_vi) − Σ_v (R_v − R_i) G_vi,
//!
//! so a solver gathers over the ring twice: positions for the matrices, rotations for the gradient. If cells bend, Z
//! (see `bending`) replaces R − 1 here, and w, G_iv and G_vi have grown by their cells' 1 + β. `rims` and `spokes`
//! define G, S⁰ and w. The edges that the sums over both ends count wrongly are all constrained; `constant` corrects
//! them.

use glam::DVec3;

use super::barrier::Facing;
use super::bend::Bend;
pub(crate) use super::bend::Quad;

/// The stencils of a domain's cells.
#[derive(Debug, Default)]
pub(crate) struct Cells {
    /// The start of each cell's entries; one more at the end.
    pub offsets: Vec<u32>,
    /// The local vertices around the cells.
    pub ends: Vec<u32>,
    /// G_iv and w_iv of each entry.
    pub towards: Vec<Quad>,
    /// G_vi of each entry of a solved cell, times 1 + β_v. **f32**: they enter the gradient alone, and only multiply
    /// differences of turns.
    pub back: Vec<[f32; 3]>,
    /// w_iv of each entry of a solved cell, **f32** for the gradient of cells whose turns are given.
    pub weights: Vec<f32>,
    /// Σ_v (1 + β_i) G_iv − (1 + β_v) G_vi of each solved cell.
    pub own: Vec<DVec3>,
    /// S⁰'s entries xx, xy, xz, yy, yz, zz of each cell.
    pub rest: Vec<[f64; 6]>,
    /// Pairs of constrained vertices whose squared difference also enters the energy, with its factor.
    pub constant: Vec<(u32, u32, f64)>,
    /// The bending term of each cell, or none.
    pub bending: Vec<Bend>,
    /// The barrier of each cell, or none.
    pub barriers: Vec<Facing>,
    /// ½ Σ w |e|² of the rest shape.
    pub scale: f64,
}

impl Cells {
    /// The entries of a cell.
    #[inline(always)]
    pub fn around(&self, cell: usize) -> std::ops::Range<usize> {
        self.offsets[cell] as usize..self.offsets[cell + 1] as usize
    }

    /// The unit of length of single-precision fields, about the model's size.
    pub fn unit(&self) -> f64 {
        if self.scale > 0.0 { self.scale.sqrt() } else { 1.0 }
    }

    /// The number of cells.
    pub fn count(&self) -> usize {
        self.rest.len()
    }

    /// Appends the cell with these entries: the end, its rest edge e_iv, G_iv, G_vi and w_iv; `is_solved` ones come
    /// first. `firmness` is its 1 + β, and is in the weights and in G_vi already.
    pub fn push(&mut self, entries: &[Entry], rest: [f64; 6], solved: Solved, firmness: f64) {
        if self.offsets.is_empty() {
            self.offsets.push(0);
        }
        for entry in entries {
            self.ends.push(entry.end);
            self.towards.push(quad(entry.towards, entry.weight));
            if solved == Solved::Yes {
                self.back.push(entry.back.as_vec3().to_array());
                self.weights.push(entry.weight as f32);
            }
        }
        if solved == Solved::Yes {
            let own = entries.iter().map(|entry| entry.towards * firmness - entry.back);
            self.own.push(own.sum());
        }
        self.rest.push(rest);
        self.offsets.push(self.ends.len() as u32);
    }

    /// Appends another part's cells.
    pub fn append(&mut self, part: Self) {
        if self.offsets.is_empty() {
            self.offsets.push(0);
        }
        let start = self.ends.len() as u32;
        self.offsets
            .extend(part.offsets.iter().skip(1).map(|&offset| start + offset));
        self.ends.extend(part.ends);
        self.towards.extend(part.towards);
        self.back.extend(part.back);
        self.weights.extend(part.weights);
        self.own.extend(part.own);
        self.rest.extend(part.rest);
        self.bending.extend(part.bending);
        self.barriers.extend(part.barriers);
        self.scale += part.scale;
    }
}

/// The state of a cell's vertex in the solve.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(crate) enum Solved {
    /// It is solved for.
    Yes,
    /// It is constrained.
    No,
}

/// An edge of a cell.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Entry {
    /// The other local vertex.
    pub end: u32,
    /// G_iv.
    pub towards: DVec3,
    /// G_vi.
    pub back: DVec3,
    /// w_iv.
    pub weight: f64,
}

/// Adds `weight` e eᵀ to a symmetric matrix.
pub(crate) fn add_square(sum: &mut [f64; 6], weight: f64, e: DVec3) {
    for (own, product) in sum
        .iter_mut()
        .zip([e.x * e.x, e.x * e.y, e.x * e.z, e.y * e.y, e.y * e.z, e.z * e.z])
    {
        *own += weight * product;
    }
}

/// A vector and one more number.
#[inline(always)]
pub(crate) fn quad(v: DVec3, fourth: f64) -> Quad {
    [v.x, v.y, v.z, fourth]
}

/// The vector of a quad.
#[inline(always)]
pub(crate) fn vector(q: Quad) -> DVec3 {
    DVec3::new(q[0], q[1], q[2])
}

/// a − b.
#[inline(always)]
pub(crate) fn minus(a: Quad, b: Quad) -> Quad {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2], a[3] - b[3]]
}
