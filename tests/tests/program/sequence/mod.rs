//! `pliant sequence`: an edit of a sequence of shapes.

mod keys;
mod take;
mod ways;
