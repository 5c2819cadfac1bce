//! `pliant sequence`: an edit of a sequence of shapes.

mod keys;
mod morphs;
mod take;
mod ways;
