//! Pliant's io.
