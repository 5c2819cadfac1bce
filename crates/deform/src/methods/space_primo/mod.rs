//! Rigid cells of space [BPWG07]: the space around the shape is cut into cubes, each of which moves rigidly and is
//! elastically joined to those with which it shares a face; the surface follows.
//!
//! E = ½ Σ w_ij ∫ |T_i x − T_j x|² over the common faces (the mean over the face, w_ij its area over the distance of
//! the cells' centres, times the painted stiffness). That is the energy of coupled prisms with cubes instead of prisms,
//! so their descent solves it (`primo::bodies`): translations are eliminated, rotations descend by a quasi-Newton
//! method on the factored Gauss–Newton matrix, and the energy never rises.
//!
//! The cells are an octree that is fine where the surface is and coarse inside (`octree`, over the small cubes of
//! `grid`), as fine as the option `cells` allows. The whole surface determines the inside (`inside`), so that a part is
//! full at the border of the fixed one, and its cells are held there. An open sheet has no cells inside. Parts whose
//! cells touch no others are joined at their nearest cells. The cells of constrained vertices are tied to their handle,
//! or to the fixed ground, by stiff springs (`coupling`), softer ones for soft handles. A vertex takes the mean of the
//! motions of the cells around it, with the weights (1 − d²/R²)³, R being 1½ sides of a small cell, so that the surface
//! stays smooth (`weights`); the remaining errors of constrained vertices are blended out (`space::blend`), so that
//! hard handles are met exactly.

mod coupling;
mod declaration;
mod grid;
mod inside;
mod octree;
mod options;
mod overlap;
mod weights;

pub(crate) use self::declaration::DECLARATION;
pub use self::options::SpacePrimo;
