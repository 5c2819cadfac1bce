//! Pliant's editor.
