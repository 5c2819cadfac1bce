//! The background of the surface in the window: dim in the dark theme, pale in the light one, with visible lines.

use eframe::egui::Visuals;
use pliant_render::{Background, Grid};

/// A theme's backdrop.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Backdrop {
    Dark,
    Light,
}

/// Lines on the light backdrop, sRGB with straight alpha.
const DARK_LINES: [u8; 3] = [58, 62, 70];
/// Factors of the axes' colours and of their alpha on the light backdrop: dark and nearly opaque, with hues that are
/// still distinct.
const DARK_AXES: [f32; 4] = [0.48, 0.48, 0.48, 1.3];

impl Backdrop {
    pub fn of(visuals: &Visuals) -> Self {
        match visuals.dark_mode {
            true => Self::Dark,
            false => Self::Light,
        }
    }

    pub fn background(self) -> Background {
        match self {
            Self::Dark => Background::default(),
            Self::Light => Background::Gradient {
                top: [204, 208, 214],
                bottom: [150, 154, 161],
            },
        }
    }

    /// The grid in colours that are visible on this backdrop.
    pub fn grid(self, mut grid: Grid) -> Grid {
        if self == Self::Light {
            grid.colour[..3].copy_from_slice(&DARK_LINES);
            for (byte, factor) in grid
                .axis_colours
                .iter_mut()
                .flat_map(|colour| colour.iter_mut().zip(DARK_AXES))
            {
                *byte = (f32::from(*byte) * factor) as u8;
            }
        }
        grid
    }
}
