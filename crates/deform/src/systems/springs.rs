//! Soft constraints: a spring from each vertex of a soft handle to its target.
//!
//! In (A + W) d = W c a soft handle's vertices are solved like free ones, with W on the diagonal. The targets c come
//! after the vertices in every field, so that W (c − d) is a difference like those along edges: zero on constants to
//! the last bit.

/// The springs of all soft handles, handle by handle, and of stiff parts.
#[derive(Debug, Default)]
pub(crate) struct Springs {
    locals: Vec<u32>,
    /// W_i, by spring.
    strengths: Vec<f64>,
    /// The sum of W by local vertex, 0 without a spring; empty if there are no springs.
    diagonal: Vec<f64>,
}

impl Springs {
    /// The number of springs.
    pub fn len(&self) -> usize {
        self.locals.len()
    }

    /// Springs of these strengths at the local vertices `locals`, of `vertex_count`.
    pub fn add(&mut self, vertex_count: usize, locals: &[u32], strengths: &[f64]) {
        self.diagonal.resize(vertex_count, 0.0);
        for (&local, &strength) in locals.iter().zip(strengths) {
            self.locals.push(local);
            self.strengths.push(strength);
            self.diagonal[local as usize] += strength;
        }
    }

    /// The first `count` springs at `vertex_count` local vertices.
    pub fn first(&self, count: usize, vertex_count: usize) -> Self {
        let mut first = Self::default();
        if count > 0 {
            first.add(vertex_count, &self.locals[..count], &self.strengths[..count]);
        }
        first
    }

    /// The vertex of a spring.
    pub fn local(&self, spring: usize) -> u32 {
        self.locals[spring]
    }

    /// The vertices of all springs.
    pub fn locals(&self) -> &[u32] {
        &self.locals
    }

    /// W_i of a spring.
    pub fn strength(&self, spring: usize) -> f64 {
        self.strengths[spring]
    }

    /// The sum of W at a local vertex.
    pub fn diagonal(&self, local: u32) -> f64 {
        self.diagonal.get(local as usize).copied().unwrap_or(0.0)
    }
}
