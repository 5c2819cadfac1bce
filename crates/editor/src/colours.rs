//! The colours of regions and handles on the surface.

use pliant_deform::Role;

use crate::document::{HandleId, Paint};
use crate::editor::Editor;

/// The colour of a stiffness, sRGB with alpha: blue where it gives way (0.001), grey at 1, red where it is firm (1000).
pub fn stiffness_colour(stiffness: f64) -> [u8; 4] {
    const SOFT: [f64; 3] = [58.0, 118.0, 214.0];
    const PLAIN: [f64; 3] = [196.0, 196.0, 192.0];
    const FIRM: [f64; 3] = [206.0, 66.0, 44.0];
    let decades = stiffness.max(f64::MIN_POSITIVE).log10() / 3.0;
    // What is near 1 is told apart, too.
    let share = decades.abs().min(1.0).sqrt();
    let end = if decades < 0.0 { SOFT } else { FIRM };
    let [r, g, b] = std::array::from_fn(|i| (PLAIN[i] + (end[i] - PLAIN[i]) * share).round() as u8);
    [r, g, b, 255]
}

impl Editor {
    /// The colour of each surface vertex by what it does, sRGB with alpha, replacing `out`: handles in their own
    /// colours, the free region blue, what is held still grey, and darker where that was painted.
    ///
    /// To be fetched again when [`SceneView::regions_revision`](crate::SceneView::regions_revision) has grown.
    pub fn region_colours(&self, out: &mut Vec<[u8; 4]>) {
        const FREE: [u8; 4] = [96, 150, 222, 255];
        const STILL: [u8; 4] = [178, 178, 178, 96];
        const FIXED: [u8; 4] = [112, 112, 116, 255];
        if self.mode == crate::ToolMode::PaintStiffness {
            out.clear();
            let count = self.document.paint.len();
            match &self.document.stiffness {
                Some(field) => out.extend(field.iter().map(|&value| stiffness_colour(value))),
                None => out.resize(count, stiffness_colour(1.0)),
            }
            return;
        }
        let largest = self
            .document
            .handles
            .iter()
            .map(|handle| usize::from(handle.id.0) + 1)
            .max()
            .unwrap_or(0);
        let mut of_handle = vec![STILL; largest];
        for handle in &self.document.handles {
            if handle.visible {
                of_handle[usize::from(handle.id.0)] = handle.colour;
            }
        }
        out.clear();
        out.extend(
            self.document
                .paint
                .iter()
                .enumerate()
                .map(|(vertex, paint)| match *paint {
                    Paint::Fixed => FIXED,
                    Paint::Free => FREE,
                    Paint::Handle(HandleId(id)) => of_handle.get(usize::from(id)).copied().unwrap_or(STILL),
                    Paint::Bare => match self.engine.region.roles.get(vertex) {
                        Some(Role::Free) => FREE,
                        _ => STILL,
                    },
                }),
        );
    }
}
