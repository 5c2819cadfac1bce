//! The colours of regions and handles on the surface.

use pliant_deform::Role;

use crate::document::{HandleId, Paint};
use crate::editor::Editor;

impl Editor {
    /// The colour of each surface vertex by what it does, sRGB with alpha, replacing `out`: handles in their own
    /// colours, the free region blue, what is held still grey, and darker where that was painted.
    ///
    /// To be fetched again when [`SceneView::regions_revision`](crate::SceneView::regions_revision) has grown.
    pub fn region_colours(&self, out: &mut Vec<[u8; 4]>) {
        const FREE: [u8; 4] = [96, 150, 222, 255];
        const STILL: [u8; 4] = [178, 178, 178, 96];
        const FIXED: [u8; 4] = [112, 112, 116, 255];
        let largest = self
            .document
            .handles
            .iter()
            .map(|handle| usize::from(handle.id.0) + 1)
            .max()
            .unwrap_or(0);
        let mut of_handle = vec![STILL; largest];
        for handle in &self.document.handles {
            of_handle[usize::from(handle.id.0)] = handle.colour;
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
