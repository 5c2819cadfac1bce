//! Triharmonic radial basis functions [BK05]: d(p) = Σ_k c_k |p − x_k|³ + a + B p, through the displacements of the
//! handles and of the fixed vertices. It has the least ∫ |∇³ d|² of all fields through these.
//!
//! Parts: `centres` chooses the x_k among the constraints, `system` solves for the effect of each handle's affine
//! motions on the coefficients, and `kernel` evaluates sums of the kernel and their gradients. Frames are those of
//! `space::field`.

mod centres;
mod constraints;
mod declaration;
mod directions;
mod kernel;
mod options;
mod system;

pub(crate) use self::declaration::DECLARATION;
pub use self::options::Rbf;
