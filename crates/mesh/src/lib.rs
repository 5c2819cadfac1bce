//! Pliant's mesh.
