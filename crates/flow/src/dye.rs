//! Dye at vertices and between them.

use crate::fluid::Fluid;
use crate::trace::Ends;

/// Dye at a vertex: red, green and blue, multiplied by the coverage, and the coverage, each from 0 to 1.
pub(crate) type Dye = [f64; 4];

/// The larger value of each channel; of two that are numbers, in one instruction, unlike [`f64::max`].
#[inline(always)]
pub(crate) fn larger(a: Dye, b: Dye) -> Dye {
    std::array::from_fn(|k| if a[k] > b[k] { a[k] } else { b[k] })
}

/// The smaller value of each channel.
#[inline(always)]
pub(crate) fn smaller(a: Dye, b: Dye) -> Dye {
    std::array::from_fn(|k| if a[k] < b[k] { a[k] } else { b[k] })
}

/// The dye at the end of a way.
#[inline(always)]
pub(crate) fn dye_at(fluid: &Fluid<'_>, ends: &Ends, i: usize, dye: &[Dye]) -> Dye {
    let [a, b, c] = fluid.corners(ends.triangles[i] as usize).map(|corner| dye[corner]);
    let [u, v, w] = [0, 1, 2].map(|k| ends.weights[k][i]);
    std::array::from_fn(|k| u * a[k] + v * b[k] + w * c[k])
}
