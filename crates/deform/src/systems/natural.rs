//! The thin plate with natural boundaries: the squared Hessian where stiffness varies and at free borders.
//!
//! |Δd|² and |∇²d|² differ by boundary terms alone (and by K |∇d|² where the surface curves), so on a closed, evenly
//! stiff surface they give one shape. Where stiffness jumps, or a border is free, they do not: the Laplacian does not
//! see harmonic d, so a soft band balloons on a stiff rest, and free borders curl [SGWJ18, SJWG20]. So the energy is
//!
//! ½ k_b ∫ s₀ |Δd|² + (s − s₀) |∇²d|²,
//!
//! s₀ being the least stiffness of the component, and 0 if a border of it is free. Without paint, and with all borders
//! held, that is the operator without this term, to the last bit.

use crate::Laplacian;
use crate::operators::hessian::RingHessian;

/// The trace-free part of the squared Hessian, ½ Σ w (a² + b²) / M.
#[derive(Debug)]
pub(crate) struct NaturalTerm {
    pub hessian: RingHessian,
    /// w = 2 k_b (s − s₀) of each local vertex.
    pub weights: Vec<f64>,
}

impl NaturalTerm {
    /// w / M of a local vertex.
    #[inline]
    pub fn density(&self, laplacian: &Laplacian, local: usize) -> f64 {
        self.weights[local] * laplacian.inverse_areas()[local]
    }

    /// w / M times M a and M b of K functions at a local vertex.
    pub fn stress<const K: usize>(&self, laplacian: &Laplacian, local: usize, d: &[[f64; K]]) -> [[f64; K]; 2] {
        match self.density(laplacian, local) {
            0.0 => [[0.0; K]; 2],
            density => self
                .hessian
                .row(laplacian, local, d)
                .map(|row| row.map(|value| density * value)),
        }
    }

    /// The gradient of the term at a local vertex, given the stress at all local vertices.
    #[inline]
    pub fn force<const K: usize>(&self, laplacian: &Laplacian, local: usize, stress: &[[[f64; K]; 2]]) -> [f64; K] {
        let own = self.hessian.diagonal(local);
        let of = |stress: &[[f64; K]; 2], [a, b]: [f64; 2]| -> [f64; K] {
            std::array::from_fn(|k| a * stress[0][k] + b * stress[1][k])
        };
        let mut sum = of(&stress[local], own);
        for (&other, entry) in laplacian.neighbours(local).iter().zip(self.hessian.back(local)) {
            let part = of(&stress[other as usize], *entry);
            for k in 0..K {
                sum[k] += part[k];
            }
        }
        sum
    }
}
