//! The coefficients of the bi-Laplacian's energy.

use crate::Discretisation;

/// ½ ∫ k_s |∇d|² + k_b |∇ⁿ d|², whose operator is A = k_s (−L) + k_b (−L)(−M⁻¹ L)ⁿ⁻¹: a membrane at n = 1, a thin plate
/// at n = 2 [BS08, equation 8].
#[derive(Clone, Copy, PartialEq, Debug)]
pub(crate) struct PlateEnergy {
    /// n: the power of L, from 1 to 3.
    pub power: u32,
    /// k_b, without a unit: lengths are measured in sizes of the bending part.
    pub bending: f64,
    /// k_s, in the same measure.
    pub stretching: f64,
    /// The discretisation of L.
    pub discretisation: Discretisation,
}

impl PlateEnergy {
    /// The energy whose operator is ± Lⁿ alone, with cotangents.
    pub fn of_power(power: u32) -> Self {
        Self {
            power,
            bending: 1.0,
            stretching: 0.0,
            discretisation: Discretisation::CotangentArea,
        }
    }
}
