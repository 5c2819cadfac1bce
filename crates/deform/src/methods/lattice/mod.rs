//! Free-form deformation by a lattice [SP86]: d(p) = Σ_ijk B_i(x) B_j(y) B_k(z) D_ijk, tensor products of B-spline or
//! Bernstein functions over a box around the moving part. With the displacements D of the control points the field fits
//! the handles in the least-squares sense; among such D they have the least norm or the least bending [HHK92].
//!
//! Parts: `brought` has a person's lattice, or makes one; `basis` has the functions of one axis, `grid` their products,
//! `fit` solves for the control points. Frames are those of `space::field`.

mod basis;
mod brought;
mod declaration;
mod fit;
mod grid;
mod options;

pub(crate) use self::declaration::DECLARATION;
pub use self::options::{Lattice, LatticeBasis, LatticeNorm};
