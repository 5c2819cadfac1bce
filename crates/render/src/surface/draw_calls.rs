//! The draw calls of a surface after frustum culling, batched into as few as possible.

use std::ops::Range;

use crate::pipelines::Alpha;
use crate::surface::lod::REDUCED_FROM_TRIANGLES;
use crate::surface::pages::Page;
use crate::{AlphaMode, Detail, Surface, View};

/// Triangles of one page and material that are drawn by one call.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct DrawCall {
    pub(crate) page: usize,
    pub(crate) triangles: Range<u32>,
    /// Position of the first triangle in the surface's draw order.
    pub(crate) first_triangle: u32,
    pub(crate) material: usize,
    pub(crate) alpha: Alpha,
    pub(crate) detail: Detail,
}

/// The rule for neighbouring chunks that share a draw call.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Batching {
    /// All of them.
    Any,
    /// Chunks of the same material.
    PerMaterial,
}

impl Surface {
    /// The number of triangles that remain after frustum culling.
    pub fn drawn_triangles(&self, view: &View) -> usize {
        let draw_calls = self.draw_calls(view, Batching::Any);
        draw_calls.iter().map(|call| call.triangles.len()).sum()
    }

    /// The draw calls for the chunks that may be visible.
    pub(crate) fn draw_calls(&self, view: &View, batching: Batching) -> Vec<DrawCall> {
        let mut draw_calls: Vec<DrawCall> = Vec::new();
        let mut page = 0;
        for (chunk, bounds) in self.chunks.all().iter().zip(&self.bounds) {
            while self
                .pages
                .get(page)
                .is_some_and(|page| page.draw_range().end <= chunk.triangles.start)
            {
                page += 1;
            }
            if !bounds.intersects_frustum(&view.clip_from_world) {
                continue;
            }
            let start = self.pages.get(page).map_or(0, |page| page.draw_range().start);
            let (from, to) = (chunk.triangles.start - start, chunk.triangles.end - start);
            match draw_calls.last_mut() {
                Some(last)
                    if last.page == page
                        && last.triangles.end == from
                        && (batching == Batching::Any || last.material == chunk.material) =>
                {
                    last.triangles.end = to;
                }
                _ => draw_calls.push(DrawCall {
                    page,
                    triangles: from..to,
                    first_triangle: chunk.triangles.start,
                    material: chunk.material,
                    alpha: match chunk.alpha {
                        AlphaMode::Opaque => Alpha::Opaque,
                        AlphaMode::Mask { .. } => Alpha::Mask,
                        AlphaMode::Blend => Alpha::Blend,
                    },
                    detail: Detail::Full,
                }),
            }
        }
        draw_calls
    }

    /// Returns true if [`Detail::Reduced`] draws fewer triangles in `view`: the reduced level exists, no triangle is
    /// hidden, and so much of the surface is visible that the larger triangles do not show.
    pub fn has_reduced(&self, view: &View) -> bool {
        let is_made = self.pages.iter().any(|page| page.reduced().is_some());
        is_made && self.shown.is_none() && self.drawn_triangles(view) >= REDUCED_FROM_TRIANGLES
    }

    /// The draw calls of the reduced level of detail. It has no materials.
    pub(crate) fn reduced_draw_calls(&self) -> Vec<DrawCall> {
        let reduced = self.pages.iter().enumerate();
        let call = |(page, reduced): (usize, &Page)| {
            Some(DrawCall {
                page,
                triangles: 0..reduced.reduced()?.index_count / 3,
                first_triangle: 0,
                material: 0,
                alpha: Alpha::Opaque,
                detail: Detail::Reduced,
            })
        };
        reduced.filter_map(call).collect()
    }
}
