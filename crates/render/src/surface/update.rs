//! Changes to a surface in place: its shape, its colours and lines, its materials, and which triangles are shown.

use std::ops::Range;
use std::sync::{Arc, OnceLock};

use super::Surface;
use super::chunks::ChunkBounds;
use super::lines::LineSet;
use super::pages::Page;
use crate::device::guard::guarded;
use crate::{Gpu, Materials, RenderError, SurfaceLine};

/// A new shape for a [`Surface`]. All of it can be computed beforehand on another thread.
#[derive(Debug, Clone, Copy)]
pub struct ShapeData<'a> {
    /// Positions relative to the caller's centre, one per vertex.
    pub positions: &'a [[f32; 3]],
    /// Unit normals, one per vertex.
    pub normals: &'a [[f32; 3]],
    /// [`Chunks::bounds`](super::chunks::Chunks::bounds) of every chunk at these positions.
    pub bounds: &'a [ChunkBounds],
}

impl Surface {
    /// Updates the positions.
    ///
    /// # Errors
    /// [`RenderError::Length`] unless there is one entry per vertex; out of memory.
    pub fn update_positions(&mut self, gpu: &Gpu, positions: &[[f32; 3]]) -> Result<(), RenderError> {
        self.update(gpu, "positions", |page| &page.positions, positions)?;
        self.bounds = self.chunks.all_bounds(positions);
        Ok(())
    }

    /// Updates positions, normals and the chunks' bounds.
    ///
    /// # Errors
    /// As [`Surface::update_positions`].
    pub fn update_shape(&mut self, gpu: &Gpu, shape: &ShapeData<'_>) -> Result<(), RenderError> {
        if shape.bounds.len() != self.chunks.count() {
            let (expected, found) = (self.chunks.count(), shape.bounds.len());
            let what = "chunk bounds";
            return Err(RenderError::Length { what, expected, found });
        }
        self.update(gpu, "positions", |page| &page.positions, shape.positions)?;
        self.bounds.copy_from_slice(shape.bounds);
        self.update_normals(gpu, shape.normals)
    }

    /// Updates the normals (unit vectors).
    ///
    /// # Errors
    /// As [`Surface::update_positions`].
    pub fn update_normals(&self, gpu: &Gpu, normals: &[[f32; 3]]) -> Result<(), RenderError> {
        self.update(gpu, "normals", |page| &page.normals, normals)
    }

    /// Updates the region colours that [`crate::Style::region_share`] shows: sRGB, and in the fourth byte the share of
    /// the shading's colour that they replace (0 none, 255 all).
    ///
    /// # Errors
    /// As [`Surface::update_positions`].
    pub fn update_regions(&self, gpu: &Gpu, regions: &[[u8; 4]]) -> Result<(), RenderError> {
        self.update(gpu, "region colours", |page| &page.regions, regions)
    }

    /// Updates the region colours of some ranges of vertices; `regions` has one entry for every vertex.
    ///
    /// # Errors
    /// As [`Surface::update_positions`].
    pub fn update_some_regions(
        &self,
        gpu: &Gpu,
        regions: &[[u8; 4]],
        ranges: &[Range<usize>],
    ) -> Result<(), RenderError> {
        let Some(page) = self.whole_page().filter(|_| regions.len() == self.vertex_count) else {
            return self.update_regions(gpu, regions);
        };
        guarded(&gpu.device, "while uploading", || {
            for range in ranges {
                if let Some(some) = regions.get(range.clone()) {
                    let start = size_of_val(&regions[..range.start]) as u64;
                    gpu.queue.write_buffer(&page.regions, start, bytemuck::cast_slice(some));
                }
            }
            Ok(())
        })
    }

    /// Replaces the lines that [`crate::Outlines::On`] draws; later lines cover earlier ones.
    ///
    /// # Errors
    /// [`RenderError::NoSuch`] for a vertex out of range; out of memory.
    pub fn update_lines(&mut self, gpu: &Gpu, lines: &[SurfaceLine]) -> Result<(), RenderError> {
        self.outlines = self.line_sets(gpu, lines)?;
        Ok(())
    }

    /// Replaces the lines that are drawn with every style; a line with both ends at the same vertex is a dot. A surface
    /// on several pages draws only the lines between its triangles' vertices.
    ///
    /// # Errors
    /// As [`Surface::update_lines`].
    pub fn update_wires(&mut self, gpu: &Gpu, lines: &[SurfaceLine]) -> Result<(), RenderError> {
        self.wires = self.line_sets(gpu, lines)?;
        Ok(())
    }

    fn line_sets(&self, gpu: &Gpu, lines: &[SurfaceLine]) -> Result<Vec<Option<LineSet>>, RenderError> {
        let mut vertices = lines.iter().flat_map(|line| line.ends).flat_map(|end| end.vertices);
        let count = self.vertex_count;
        if let Some(vertex) = vertices.find(|&vertex| vertex as usize >= count) {
            let (what, number) = ("vertex", vertex as usize);
            return Err(RenderError::NoSuch { what, number, count });
        }
        let sets = (self.pages.iter()).map(|page| LineSet::new(gpu, page, lines.iter().copied(), 0.0));
        sets.collect()
    }

    /// Shows only the triangles whose flag is set; `None` shows all. Hidden triangles can't be picked either.
    ///
    /// # Errors
    /// [`RenderError::Length`] unless there is one flag per triangle; out of memory.
    pub fn show(&mut self, gpu: &Gpu, shown: Option<Arc<Vec<bool>>>) -> Result<(), RenderError> {
        if let Some(flags) = shown.as_ref().filter(|flags| flags.len() != self.triangles.len()) {
            let (what, expected, found) = ("shown triangles", self.triangles.len(), flags.len());
            return Err(RenderError::Length { what, expected, found });
        }
        let is_shown = |triangle: u32| shown.as_ref().is_none_or(|shown| shown[triangle as usize]);
        for page in &mut self.pages {
            page.show(&gpu.device, &gpu.queue, &self.chunks, &is_shown)?;
        }
        self.borders = OnceLock::new();
        self.shown = shown;
        Ok(())
    }

    pub(super) fn is_shown(&self, triangle: u32) -> bool {
        self.shown.as_ref().is_none_or(|shown| shown[triangle as usize])
    }

    /// Replaces the materials by the same number of others, with the same alpha modes.
    ///
    /// # Errors
    /// [`RenderError::Length`] if the number of materials differs.
    pub fn set_materials(&mut self, materials: Materials) -> Result<(), RenderError> {
        if materials.groups.len() != self.materials.len() {
            let [expected, found] = [&self.materials, &materials.groups].map(|groups| groups.len() - 1);
            let what = "materials";
            return Err(RenderError::Length { what, expected, found });
        }
        self.materials = materials.groups;
        Ok(())
    }

    fn update<T: bytemuck::NoUninit>(
        &self,
        gpu: &Gpu,
        what: &'static str,
        buffer: impl Fn(&Page) -> &wgpu::Buffer,
        contents: &[T],
    ) -> Result<(), RenderError> {
        if contents.len() != self.vertex_count {
            let (expected, found) = (self.vertex_count, contents.len());
            return Err(RenderError::Length { what, expected, found });
        }
        for page in &self.pages {
            page.refill(&gpu.device, &gpu.queue, buffer(page), contents)?;
        }
        Ok(())
    }
}
