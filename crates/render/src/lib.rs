//! Pliant's render.
