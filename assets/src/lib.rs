//! The sample that Pliant opens with, a crate of its own so that whatever embeds it can be published.
//!
//! ```
//! assert!(pliant_assets::CREATURE.starts_with(b"glTF"));
//! ```

/// A creature of 61 thousand triangles, as a glTF binary.
pub const CREATURE: &[u8] = include_bytes!("../creature.glb");
