//! Free-form deformation by a lattice [SP86]: d(p) = Σ_ijk B_i(x) B_j(y) B_k(z) D_ijk, tensor products of B-spline or
//! Bernstein functions over a box around what moves. The displacements D of the control points are those with which the
//! field fits the handles in the least-squares sense, and of these the ones of least norm or least bending [HHK92].
//!
//! Parts: `brought` has the lattice that a person gives, or makes one; `basis` has the functions of one axis, `grid` their products, `fit` solves for the control points. Frames are
//! those of `space::field`.

mod basis;
mod brought;
mod declaration;
mod fit;
mod grid;
mod options;

pub(crate) use self::declaration::DECLARATION;
pub use self::options::{Lattice, LatticeBasis, LatticeNorm};
