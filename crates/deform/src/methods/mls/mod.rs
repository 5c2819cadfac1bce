//! Moving least squares [SMW06] in space: each point p moves by the transformation that best fits the motions of the
//! handles and of the fixed vertices, with weights that fall off with their distance from p.
//!
//! min over T of Σ_i w_i(p) |T x_i − y_i|², T affine, a similarity or rigid; the points x_i are samples of the handles
//! and of the fixed vertices, and y_i are their targets. Three things differ from the paper:
//!
//! - The points of one handle share one weight, W = 1/δᶠ with δ the distance to the *nearest* of all its vertices and f
//!   the exponent `falloff`; its samples share it by their own 1/dᶠ. So the weight tends to infinity at each of the
//!   handle's vertices, not only at its samples, and a handle does not pull more because it has more vertices.
//! - A handle moves affinely, so each sample is a small cloud of points around it, with the covariance η² I, that moves
//!   with the handle. Handles of one vertex or on one plane turn and stretch their surroundings, and no fit is ever
//!   singular.
//! - A soft handle has W = 1/(δ² + ε²)^(f/2), which stays finite: ε² is [`points::SOFT`]² over its weight.
//!
//! As every handle moves affinely, all sums over its points are moments that do not depend on its motion: a weight, a
//! vector and a symmetric matrix for each vertex and handle (`moments`), computed once. Affine fits are linear in the
//! handles' motions, so that a frame is a product (`affine`). For the others a frame is a fit at each vertex from a few
//! of these moments (`fit`, `bound`), and so is its derivative.
//!
//! The samples of handles with more than [`points::MOST`] vertices are spread evenly. Such a handle is met between its
//! samples if the fitted transformations contain its motion; if it is stretched and the fit is rigid, the error of the
//! surface around it may be its stretch times the distance between two samples.

mod affine;
mod bound;
mod declaration;
mod fit;
mod moments;
mod options;
mod points;

pub(crate) use self::declaration::DECLARATION;
pub use self::options::{Mls, MlsTransforms};
