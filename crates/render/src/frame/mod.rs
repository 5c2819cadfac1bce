//! The contents of one frame beside its surfaces: a view, a style, a grid and overlays.

pub(crate) mod grid;
pub(crate) mod image;
pub(crate) mod overlay;
pub(crate) mod palette;
pub(crate) mod style;
pub(crate) mod view;
