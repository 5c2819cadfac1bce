//! The version of Pliant.

/// The version and the commit it was built from, e.g. "0.1.0 (1a2b3c4d5e)".
pub const VERSION: &str = concat!(env!("CARGO_PKG_VERSION"), " (", env!("PLIANT_COMMIT"), ")");
