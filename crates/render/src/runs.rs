//! Which of a surface's triangles a picture draws, in as few calls as may be.

use std::ops::Range;

use crate::lod::REDUCED_FROM_TRIANGLES;
use crate::pages::Page;
use crate::pipelines::Alpha;
use crate::{AlphaMode, Detail, Surface, View};

/// Triangles of one page that are drawn by one call: page, places within the page, what they are made of.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Run {
    pub(crate) page: usize,
    pub(crate) triangles: Range<u32>,
    /// The place in the surface's drawing order of the first one.
    pub(crate) first_place: u32,
    pub(crate) material: usize,
    pub(crate) alpha: Alpha,
    pub(crate) detail: Detail,
}

/// Which neighbouring chunks may be drawn by one call.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Joining {
    /// All.
    Any,
    /// Those of one material.
    OneMaterial,
}

impl Surface {
    /// How many of the triangles a picture of `view` draws; the others lie in chunks that can't be seen.
    pub fn drawn_triangles(&self, view: &View) -> usize {
        let runs = self.runs(view, Joining::Any);
        runs.iter().map(|run| run.triangles.len()).sum()
    }

    /// Ways of drawing what may be seen, each chunk once.
    pub(crate) fn runs(&self, view: &View, joining: Joining) -> Vec<Run> {
        let mut runs: Vec<Run> = Vec::new();
        let mut page = 0;
        for (chunk, bounds) in self.chunks.all().iter().zip(&self.bounds) {
            while self
                .pages
                .get(page)
                .is_some_and(|page| page.places().end <= chunk.triangles.start)
            {
                page += 1;
            }
            if !bounds.may_be_seen(&view.clip_from_world) {
                continue;
            }
            let start = self.pages.get(page).map_or(0, |page| page.places().start);
            let (from, to) = (chunk.triangles.start - start, chunk.triangles.end - start);
            match runs.last_mut() {
                Some(last)
                    if last.page == page
                        && last.triangles.end == from
                        && (joining == Joining::Any || last.material == chunk.material) =>
                {
                    last.triangles.end = to;
                }
                _ => runs.push(Run {
                    page,
                    triangles: from..to,
                    first_place: chunk.triangles.start,
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
        runs
    }

    /// Whether [`Detail::Reduced`] draws fewer triangles in a picture of `view`: there are such, nothing is hidden, and
    /// enough of the surface is to be seen that their size does not show.
    pub fn has_reduced(&self, view: &View) -> bool {
        let is_made = self.pages.iter().any(|page| page.reduced().is_some());
        is_made && self.shown.is_none() && self.drawn_triangles(view) >= REDUCED_FROM_TRIANGLES
    }

    /// The fewer triangles of each page, where there are such: not for materials.
    pub(crate) fn reduced_runs(&self) -> Vec<Run> {
        let reduced = self.pages.iter().enumerate();
        let run = |(page, reduced): (usize, &Page)| {
            Some(Run {
                page,
                triangles: 0..reduced.reduced()?.index_count / 3,
                first_place: 0,
                material: 0,
                alpha: Alpha::Opaque,
                detail: Detail::Reduced,
            })
        };
        reduced.filter_map(run).collect()
    }
}
