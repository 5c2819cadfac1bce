//! Pliant's app.
