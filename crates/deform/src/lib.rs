//! Pliant's deform.
