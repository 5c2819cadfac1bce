//! The source of a picture, and whether it can be shown for a new request.

use pliant_editor::Look;
use pliant_render::{Detail, Samples};

use crate::window::viewport::backdrop::Backdrop;
use crate::window::viewport::shown::{Colours, ShadowKey};

/// The source of the picture in the texture.
#[derive(Clone, PartialEq)]
pub struct DrawnKey {
    pub pixels_per_point: f32,
    pub shape: usize,
    pub colours: Colours,
    pub materials_revision: u64,
    pub rims: u64,
    pub shown: usize,
    pub shadow: Option<ShadowKey>,
    pub overlay: u64,
    pub camera: u64,
    pub look: Look,
    /// True if the regions' colours are faded.
    pub is_faded: bool,
    pub size_px: [u32; 2],
    pub samples: Samples,
    pub detail: Detail,
    pub backdrop: Backdrop,
}

impl DrawnKey {
    /// Returns true if this picture is as good as the requested one: of the same state, with as many samples, and as
    /// large, or as large as the view, `full_px`.
    pub fn serves(&self, wanted: &Self, full_px: [u32; 2]) -> bool {
        let same = Self {
            size_px: wanted.size_px,
            samples: wanted.samples,
            detail: wanted.detail,
            ..self.clone()
        };
        let is_as_detailed = self.detail == wanted.detail || self.detail == Detail::Full;
        let is_as_large = self.size_px == wanted.size_px || self.size_px == full_px;
        same == *wanted && is_as_large && is_as_detailed && self.samples.count() >= wanted.samples.count()
    }
}
