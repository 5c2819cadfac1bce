//! Places on the mesh that an edit was made on, by which its sets and fields are found on another mesh.
//!
//! An edit that the window exports names vertices by number. Another scan of the same object has other vertices, so the
//! edit also has a sample of the first mesh' vertices, each with its number, place and normal ([`Places`]). On a mesh with
//! the same vertices the numbers count, and the places are not looked at. On any other mesh each vertex belongs to the
//! sets of the place nearest to it whose normal agrees (`matched.rs`), and fields are interpolated between places
//! (`blend.rs`); the result is an edit by the other mesh' own numbers (`placed_edit.rs`).
//!
//! The sample is dense at the borders of sets and coarse elsewhere (`sample.rs`). It is checked on its own mesh: vertices
//! that it would give to the wrong set are added until there are none. Triangles would interpolate better than points, but
//! a set's border alone needs as many of them, with three numbers each.

mod blend;
mod matched;
mod recorded;
mod sample;
mod stored;

pub(in crate::format) use matched::{Oriented, PlaceTree};
pub(in crate::format) use recorded::Recorded;
pub(in crate::format) use sample::{Meaning, Painted, sample};
pub use stored::Places;
