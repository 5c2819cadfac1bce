//! The matrices that the bending term adds to a cell, and their effect on its matrix and rotation (see `bending`).

/// Four numbers: a vector and one more.
pub(crate) type Quad = [f64; 4];

/// A cell's matrices; symmetric ones are xx, xy, xz, yy, yz, zz.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Bend {
    /// β K.
    pub hold: [f64; 6],
    /// 1 + ν K N: R is fitted to S⁰ + B times this.
    pub gain: [f64; 6],
    /// 1 / (1 + β).
    pub share: f64,
}

impl Bend {
    /// B β K and half its product with B, by which the energy is smaller; B becomes the matrix to which R is fitted.
    #[inline(always)]
    pub fn bear(&self, b: &mut [Quad; 3]) -> ([Quad; 3], f64) {
        let forces = times(b, &self.hold);
        let mut products = [0.0; 4];
        for (force, b) in forces.iter().zip(b.iter()) {
            for row in 0..4 {
                products[row] += force[row] * b[row];
            }
        }
        *b = times(b, &self.gain);
        (forces, 0.5 * (products[0] + products[1] + products[2]))
    }

    /// Z = −dE/dB / (1 + β), from R − 1 and the result of `bear`: if everything turns alike it is R − 1 again, for
    /// every β.
    #[inline(always)]
    pub fn pull(&self, turn: &[Quad; 3], forces: &[Quad; 3]) -> [Quad; 3] {
        let mut pull = times(turn, &self.gain);
        for (pull, force) in pull.iter_mut().zip(forces) {
            for row in 0..4 {
                pull[row] = (pull[row] + force[row]) * self.share;
            }
        }
        pull
    }
}

/// m a, by columns. Plain loops: a closure would not be compiled for the pass's vectors.
#[inline(always)]
fn times(m: &[Quad; 3], &[xx, xy, xz, yy, yz, zz]: &[f64; 6]) -> [Quad; 3] {
    let columns = [[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]];
    let mut product = [[0.0; 4]; 3];
    for (own, [x, y, z]) in product.iter_mut().zip(columns) {
        for row in 0..4 {
            own[row] = m[0][row] * x + m[1][row] * y + m[2][row] * z;
        }
    }
    product
}
