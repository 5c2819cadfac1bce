//! Handle bases.

/// What the handles' transforms do to each vertex that is solved for: B_h = −A_ff⁻¹ A_fh [q 1] (Botsch & Kobbelt 2004).
///
/// The columns are those of q = (p − centre_h) / radius_h and the constant, so the displacement of a row's vertex is
/// Σ_h radius_h (A_h − I) b_h.xyz + b_h.w t_h, where A_h is the linear part of the handle's transform and t_h what it
/// does to the handle's centre. Stored in f32, which costs 1e-7 of the handle's motion.
#[derive(Clone, Debug, Default)]
pub struct HandleBases {
    vertices: Vec<u32>,
    handle_count: usize,
    rows: Vec<[f32; 4]>,
}

impl HandleBases {
    /// The surface vertices that are solved for, ascending: one a row.
    pub fn vertices(&self) -> &[u32] {
        &self.vertices
    }
    /// How many handles a row has.
    pub fn handle_count(&self) -> usize {
        self.handle_count
    }
    /// Row-major: `handle_count` entries (x, y, z, constant) a row.
    pub fn rows(&self) -> &[[f32; 4]] {
        &self.rows
    }
    /// The share that handle `handle` has in each row's vertex: about 1 beside it, 0 at what is fixed.
    pub fn weight(&self, row: usize, handle: usize) -> f32 {
        self.rows[row * self.handle_count + handle][3]
    }
}
