//! Deformation by a cage: d(p) = Σ λ_i(p) D_i, with coordinates λ of p in a coarse closed triangle mesh around the
//! region. The handles drive the cage: its vertices' displacements are the smoothest among those whose field fits the
//! handles in the least-squares sense.
//!
//! `voxels` and `offset` make the cage, and `brought` checks one that a person gives. `mean_value` [JSW05], `harmonic`
//! [JMD+07] and `green` [LLC08] give the coordinates; `fit` solves for the cage's vertices, and `green_fit` and
//! `green_steps` do where the faces' normals follow them.

mod balance;
mod bound;
mod brought;
mod by_hand;
mod chosen;
mod conformal;
mod crossings;
mod declaration;
mod fit;
mod green;
mod green_fit;
mod green_steps;
mod green_table;
mod harmonic;
mod lane_rows;
mod linear;
mod mean_value;
mod mean_value_at;
mod mesh;
mod moved_cage;
mod offset;
mod options;
mod outside;
pub mod parts;
mod rows;
mod stored_field;
mod stretched;
mod voxels;

pub(crate) use self::declaration::DECLARATION;
pub use self::options::{Cage, CageCoordinates};
