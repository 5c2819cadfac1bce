//! Golden pictures: a small picture for every shading and overlay, compared with the checked one. They are bound to
//! Mesa's software device, whose pictures are equal on every machine bit for bit; on other devices the tests are
//! skipped.
//!
//! `PLIANT_KEEP_PICTURES=1 cargo test -p pliant-render --test golden` replaces the pictures; check them before
//! committing.
#![allow(clippy::unwrap_used, clippy::expect_used, reason = "a test may fail by panicking")]

mod materials;
#[path = "../rig/mod.rs"]
mod rig;
mod shadings;

use std::path::Path;

use pliant_render::{Frame, Grid, Overlay, Renderer, Samples, Shading, Style, Surface, SurfaceData, View, region};
use rig::{SIZE_PX, Shape, golden, oblique_view};

/// The parts of a picture beside its surface; most pictures use the default style and view.
struct Shot<'a> {
    view: View,
    style: Style,
    grid: Option<&'a Grid>,
    overlays: &'a [Overlay],
}

impl Default for Shot<'_> {
    fn default() -> Self {
        Self {
            view: oblique_view(),
            style: Style::default(),
            grid: None,
            overlays: &[],
        }
    }
}

impl Shot<'_> {
    fn of(shading: Shading) -> Self {
        Self {
            style: Style {
                shading,
                ..Style::default()
            },
            ..Self::default()
        }
    }

    /// Draws the picture and compares it with the golden one.
    fn compare(&self, renderer: &mut Renderer, name: &str, surface: &Surface) {
        let frame = Frame {
            view: &self.view,
            style: &self.style,
            surfaces: &[surface],
            grid: self.grid,
            overlays: self.overlays,
        };
        let image = renderer.draw_to_image(SIZE_PX, Samples::Four, &frame).unwrap();
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/golden");
        golden::compare(renderer, &folder, name, &image);
    }
}

/// The ring, a third of it in a region colour.
fn painted_ring(renderer: &Renderer) -> Surface {
    let ring = Shape::open_ring(48, 20);
    let regions: Vec<[u8; 4]> = ring
        .positions
        .iter()
        .map(|p| match p {
            [x, ..] if *x > 0.55 => region::HANDLE,
            [x, ..] if *x > -0.35 => region::FREE,
            _ => region::FIXED,
        })
        .collect();
    let data = SurfaceData {
        regions: Some(&regions),
        ..ring.data()
    };
    Surface::new(renderer.gpu(), &data).unwrap()
}
