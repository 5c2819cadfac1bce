//! A triangle mesh in GPU buffers.

use std::ops::Range;
use std::sync::{Arc, OnceLock};

use crate::buffers::filled;
use crate::chunks::{ChunkBounds, Chunks};
use crate::edges::{IrregularEdge, irregular_edges};
use crate::guard::guarded;
use crate::pages::{Attributes, Page, PageLimits, page_chunks};
use crate::pipelines::MaterialAttributes;
use crate::surface_data::{checked, textures_exist};
use crate::surface_line::LineSet;
use crate::uniforms::{MaterialVertex, SurfaceUniform};
use crate::{
    ColourSpace, Detail, EdgePoint, Material, RenderError, Renderer, SurfaceData, SurfaceLine, TextureData, border,
};

/// Alpha of the parts of borders that surfaces hide, as a share of the visible parts'.
const HIDDEN_BORDERS: f32 = 0.22;

/// A triangle mesh in GPU buffers; its topology is fixed, its vertices may move and change colour.
#[derive(Debug)]
pub struct Surface {
    vertex_count: usize,
    /// Kept for the borders, which are only looked for when first drawn: 12 bytes a triangle.
    triangles: Vec<[u32; 3]>,
    welded: Option<Vec<u32>>,
    pub(crate) chunks: Arc<Chunks>,
    pub(crate) bounds: Vec<ChunkBounds>,
    pub(crate) pages: Vec<Page>,
    material_attributes: MaterialAttributes,
    /// The one entry of surfaces whose vertices have neither texture coordinates nor colours.
    shared_material_vertex: wgpu::Buffer,
    uniform_buffer: wgpu::Buffer,
    group: wgpu::BindGroup,
    materials: Vec<wgpu::BindGroup>,
    /// Of each triangle, whether it is drawn; `None` is all of them.
    pub(crate) shown: Option<Arc<Vec<bool>>>,
    /// For each page.
    borders: OnceLock<Vec<Option<LineSet>>>,
    /// For each page.
    outlines: Vec<Option<LineSet>>,
}

/// A new shape for a [`Surface`], with what can be computed beforehand on another thread.
#[derive(Debug, Clone, Copy)]
pub struct ShapeData<'a> {
    /// Positions relative to the caller's centre, one a vertex.
    pub positions: &'a [[f32; 3]],
    /// Unit normals, one a vertex.
    pub normals: &'a [[f32; 3]],
    /// [`Chunks::bounds`] of every chunk at these positions.
    pub bounds: &'a [ChunkBounds],
}

/// Materials and their textures on the device. They are made separately from the surface, possibly on another thread,
/// because decoding and uploading textures takes longer than everything else. Clones share the textures.
#[derive(Clone, Debug)]
pub struct Materials {
    /// One bind group per material, then that of the default material.
    groups: Vec<wgpu::BindGroup>,
}

impl Materials {
    /// Uploads textures and the materials that use them.
    ///
    /// # Errors
    /// Numbers out of range, textures of the wrong length, memory.
    pub fn new(renderer: &Renderer, materials: &[Material], textures: &[TextureData<'_>]) -> Result<Self, RenderError> {
        textures_exist(materials, textures.len())?;
        let groups = renderer.material_groups(materials, textures)?;
        Ok(Self { groups })
    }
}

impl Surface {
    /// Uploads a mesh. No triangles or no vertices is fine: it draws nothing.
    ///
    /// # Errors
    /// Slices that contradict each other, numbers out of range, textures of the wrong length, memory.
    pub fn new(renderer: &Renderer, data: &SurfaceData<'_>) -> Result<Self, RenderError> {
        Self::paged(renderer, data, PageLimits::of(renderer.device()))
    }

    /// The same on a device that holds no more than `vertices` and `triangles` in a buffer, for trying out how a mesh
    /// is spread over several.
    ///
    /// # Errors
    /// As [`Surface::new`].
    pub fn spread(
        renderer: &Renderer,
        data: &SurfaceData<'_>,
        vertices: usize,
        triangles: usize,
    ) -> Result<Self, RenderError> {
        Self::paged(renderer, data, PageLimits { vertices, triangles })
    }

    fn paged(renderer: &Renderer, data: &SurfaceData<'_>, limits: PageLimits) -> Result<Self, RenderError> {
        checked(data)?;
        let (device, queue) = (renderer.device(), renderer.queue());
        let count = data.positions.len();
        let chunks = match data.chunks {
            Some(chunks) => Arc::clone(chunks),
            None => Arc::new(Chunks::new(data.positions, data.triangles, data.groups, data.materials)),
        };
        let plain = vec![[0; 4]; if data.regions.is_some() { 0 } else { count }];
        let material_vertices = material_vertices(data);
        let attributes = Attributes {
            positions: data.positions,
            normals: data.normals,
            regions: data.regions.unwrap_or(&plain),
            material: material_vertices.as_deref(),
        };
        let pages = page_chunks(&chunks, count, limits)
            .into_iter()
            .map(|range| Page::new(device, queue, &chunks, range, data.triangles, &attributes))
            .collect::<Result<Vec<_>, _>>()?;
        let uniform = SurfaceUniform {
            id_base: 1,
            colours_are_linear: u32::from(data.colour_space == ColourSpace::Linear),
            mean_edge: mean_edge(data),
            padding: 0,
        };
        let uniforms = wgpu::BufferUsages::UNIFORM;
        let uniform_buffer = filled(device, queue, "surface uniform", uniforms, &[uniform])?;
        let group = renderer.uniform_group(&renderer.pipelines.surface_layout, &uniform_buffer)?;
        let white = MaterialVertex {
            uvs: [0.0; 4],
            colour: [255; 4],
        };
        Ok(Self {
            vertex_count: count,
            triangles: data.triangles.to_vec(),
            welded: data.welded.map(<[u32]>::to_vec),
            bounds: chunks.all_bounds(data.positions),
            chunks,
            pages,
            material_attributes: if material_vertices.is_some() {
                MaterialAttributes::PerVertex
            } else {
                MaterialAttributes::Shared
            },
            shared_material_vertex: filled(
                device,
                queue,
                "shared material vertex",
                wgpu::BufferUsages::VERTEX,
                &[white],
            )?,
            uniform_buffer,
            group,
            materials: renderer.material_groups(data.materials, data.textures)?,
            shown: None,
            borders: OnceLock::new(),
            outlines: Vec::new(),
        })
    }

    /// The number of vertices.
    pub fn vertex_count(&self) -> usize {
        self.vertex_count
    }

    /// The number of triangles.
    pub fn triangle_count(&self) -> usize {
        self.triangles.len()
    }

    /// Bytes that the mesh's buffers hold on the device (textures not counted).
    pub fn gpu_bytes(&self) -> u64 {
        self.pages.iter().map(Page::bytes).sum()
    }

    /// Over how many sets of buffers the mesh is spread.
    pub fn page_count(&self) -> usize {
        self.pages.len()
    }

    /// Moves the vertices; seen in the next drawing.
    ///
    /// # Errors
    /// [`RenderError::Length`] unless there is one position a vertex; memory.
    pub fn update_positions(&mut self, renderer: &Renderer, positions: &[[f32; 3]]) -> Result<(), RenderError> {
        self.update(renderer, "positions", |page| &page.positions, positions)?;
        self.bounds = self.chunks.all_bounds(positions);
        Ok(())
    }

    /// Moves the vertices, turns their normals and moves the chunks' boxes along.
    ///
    /// # Errors
    /// As [`Surface::update_positions`].
    pub fn update_shape(&mut self, renderer: &Renderer, shape: &ShapeData<'_>) -> Result<(), RenderError> {
        if shape.bounds.len() != self.chunks.count() {
            let (expected, found) = (self.chunks.count(), shape.bounds.len());
            let what = "chunk bounds";
            return Err(RenderError::Length { what, expected, found });
        }
        self.update(renderer, "positions", |page| &page.positions, shape.positions)?;
        self.bounds.copy_from_slice(shape.bounds);
        self.update_normals(renderer, shape.normals)
    }

    /// Turns the normals (unit vectors); seen in the next drawing.
    ///
    /// # Errors
    /// As [`Surface::update_positions`].
    pub fn update_normals(&self, renderer: &Renderer, normals: &[[f32; 3]]) -> Result<(), RenderError> {
        self.update(renderer, "normals", |page| &page.normals, normals)
    }

    /// Sets the region colours that [`crate::Style::region_share`] shows: sRGB, and in the fourth byte how much of
    /// the clay they replace (0 none, 255 all).
    ///
    /// # Errors
    /// As [`Surface::update_positions`].
    pub fn update_regions(&self, renderer: &Renderer, regions: &[[u8; 4]]) -> Result<(), RenderError> {
        self.update(renderer, "region colours", |page| &page.regions, regions)
    }

    /// Sets the region colours of some ranges of vertices, taken from `regions`, which has one a vertex.
    ///
    /// # Errors
    /// As [`Surface::update_positions`].
    pub fn update_some_regions(
        &self,
        renderer: &Renderer,
        regions: &[[u8; 4]],
        ranges: &[Range<usize>],
    ) -> Result<(), RenderError> {
        let Some(page) = self.whole_page().filter(|_| regions.len() == self.vertex_count) else {
            return self.update_regions(renderer, regions);
        };
        guarded(renderer.device(), "while uploading", || {
            for range in ranges {
                if let Some(some) = regions.get(range.clone()) {
                    let start = size_of_val(&regions[..range.start]) as u64;
                    renderer
                        .queue()
                        .write_buffer(&page.regions, start, bytemuck::cast_slice(some));
                }
            }
            Ok(())
        })
    }

    /// Replaces the lines that [`crate::Outlines::On`] draws, later ones over earlier ones.
    ///
    /// # Errors
    /// [`RenderError::NoSuch`] for a vertex that does not exist; memory.
    pub fn update_lines(&mut self, renderer: &Renderer, lines: &[SurfaceLine]) -> Result<(), RenderError> {
        let mut vertices = lines.iter().flat_map(|line| line.ends).flat_map(|end| end.vertices);
        let count = self.vertex_count;
        if let Some(vertex) = vertices.find(|&vertex| vertex as usize >= count) {
            let (what, number) = ("vertex", vertex as usize);
            return Err(RenderError::NoSuch { what, number, count });
        }
        let sets = (self.pages.iter()).map(|page| LineSet::new(renderer, page, lines.iter().copied(), 0.0));
        self.outlines = sets.collect::<Result<_, _>>()?;
        Ok(())
    }

    /// Draws only some of the triangles, a flag each; `None` draws them all. What is not drawn is not picked either.
    ///
    /// # Errors
    /// [`RenderError::Length`] unless there is one flag a triangle; memory.
    pub fn show(&mut self, renderer: &Renderer, shown: Option<Arc<Vec<bool>>>) -> Result<(), RenderError> {
        if let Some(flags) = shown.as_ref().filter(|flags| flags.len() != self.triangles.len()) {
            let (what, expected, found) = ("shown triangles", self.triangles.len(), flags.len());
            return Err(RenderError::Length { what, expected, found });
        }
        let is_shown = |triangle: u32| shown.as_ref().is_none_or(|shown| shown[triangle as usize]);
        for page in &mut self.pages {
            page.show(renderer.device(), renderer.queue(), &self.chunks, &is_shown)?;
        }
        self.borders = OnceLock::new();
        self.shown = shown;
        Ok(())
    }

    fn is_shown(&self, triangle: u32) -> bool {
        self.shown.as_ref().is_none_or(|shown| shown[triangle as usize])
    }

    /// Gives the surface other materials: as many as it was made with, with the same alpha.
    ///
    /// # Errors
    /// [`RenderError::Length`] for another number of materials.
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
        renderer: &Renderer,
        what: &'static str,
        buffer: impl Fn(&Page) -> &wgpu::Buffer,
        contents: &[T],
    ) -> Result<(), RenderError> {
        if contents.len() != self.vertex_count {
            let (expected, found) = (self.vertex_count, contents.len());
            return Err(RenderError::Length { what, expected, found });
        }
        for page in &self.pages {
            page.refill(renderer.device(), renderer.queue(), buffer(page), contents)?;
        }
        Ok(())
    }

    /// The one page of a mesh that is not spread over several.
    pub(crate) fn whole_page(&self) -> Option<&Page> {
        self.pages.first().filter(|page| page.is_whole())
    }

    pub(crate) fn pages(&self) -> &[Page] {
        &self.pages
    }

    pub(crate) fn material_attributes(&self) -> MaterialAttributes {
        self.material_attributes
    }

    pub(crate) fn material(&self, number: usize) -> Option<&wgpu::BindGroup> {
        self.materials.get(number)
    }

    /// Which triangle is drawn where.
    pub(crate) fn chunks(&self) -> Arc<Chunks> {
        Arc::clone(&self.chunks)
    }

    /// Binds group 1.
    pub(crate) fn bind(&self, pass: &mut wgpu::RenderPass<'_>) {
        pass.set_bind_group(1, &self.group, &[]);
    }

    /// Binds a page's shape and triangles.
    pub(crate) fn bind_shape(&self, pass: &mut wgpu::RenderPass<'_>, page: usize, detail: Detail) {
        let Some(page) = self.pages.get(page) else { return };
        for (slot, buffer) in [&page.positions, &page.normals, &page.regions].into_iter().enumerate() {
            pass.set_vertex_buffer(slot as u32, buffer.slice(..));
        }
        let triangles = match (detail, page.reduced()) {
            (Detail::Reduced, Some(reduced)) => &reduced.buffer,
            _ => &page.indices,
        };
        pass.set_index_buffer(triangles.slice(..), wgpu::IndexFormat::Uint32);
    }

    /// Binds a page's texture coordinates and colours.
    pub(crate) fn bind_material_attributes(&self, pass: &mut wgpu::RenderPass<'_>, page: usize) {
        let own = self.pages.get(page).and_then(|page| page.material.as_ref());
        pass.set_vertex_buffer(3, own.unwrap_or(&self.shared_material_vertex).slice(..));
    }

    /// The pages' borders, where there are any.
    pub(crate) fn borders(&self) -> &[Option<LineSet>] {
        self.borders.get().map_or(&[], Vec::as_slice)
    }

    /// The pages' outlines, where there are any.
    pub(crate) fn outlines(&self) -> &[Option<LineSet>] {
        &self.outlines
    }

    /// Makes the edges unless they are there.
    pub(crate) fn prepare_edges(&self, renderer: &Renderer) -> Result<(), RenderError> {
        let (device, queue) = (renderer.device(), renderer.queue());
        let is_shown = |triangle| self.is_shown(triangle);
        self.pages
            .iter()
            .try_for_each(|page| page.prepare_edges(device, queue, &self.chunks, &is_shown))
    }

    /// Looks for borders unless that was done.
    pub(crate) fn prepare_borders(&self, renderer: &Renderer) -> Result<(), RenderError> {
        if self.borders.get().is_some() {
            return Ok(());
        }
        let mut edges = irregular_edges(&self.triangles, self.vertex_count, self.welded.as_deref());
        if self.shown.is_some() {
            // What hangs together stays so: a hidden neighbour makes no border, and takes its own along.
            let mut of_shown = vec![false; self.vertex_count];
            let shown = (0..)
                .zip(&self.triangles)
                .filter(|(triangle, _)| self.is_shown(*triangle));
            for &corner in shown.flat_map(|(_, corners)| corners) {
                of_shown[corner as usize] = true;
            }
            edges.retain(|edge| {
                let (IrregularEdge::Boundary(ends) | IrregularEdge::NonManifold(ends)) = edge;
                ends.iter().all(|&end| of_shown[end as usize])
            });
        }
        let made = (self.pages.iter()).map(|page| LineSet::new(renderer, page, border_lines(&edges), HIDDEN_BORDERS));
        let _ = self.borders.set(made.collect::<Result<Vec<_>, _>>()?);
        Ok(())
    }

    /// Says which number the first triangle has in the next drawing of triangle numbers.
    pub(crate) fn set_id_base(&self, queue: &wgpu::Queue, id_base: u32) {
        let offset = std::mem::offset_of!(SurfaceUniform, id_base) as u64;
        queue.write_buffer(&self.uniform_buffer, offset, bytemuck::bytes_of(&id_base));
    }
}

/// The irregular edges as lines. An edge whose ends are on several pages is drawn once on each.
fn border_lines(edges: &[IrregularEdge]) -> impl Iterator<Item = SurfaceLine> {
    const WIDTH_POINTS: f32 = 2.6;
    edges.iter().map(|edge| {
        let (ends, colour) = match edge {
            IrregularEdge::Boundary(ends) => (ends, border::OPEN),
            IrregularEdge::NonManifold(ends) => (ends, border::BRANCHING),
        };
        SurfaceLine {
            ends: ends.map(EdgePoint::at),
            colour,
            width_points: WIDTH_POINTS,
        }
    })
}

/// Texture coordinates and colours side by side, where the data has any.
fn material_vertices(data: &SurfaceData<'_>) -> Option<Vec<MaterialVertex>> {
    if data.uvs.is_none() && data.second_uvs.is_none() && data.colours.is_none() {
        return None;
    }
    let material_vertex = |vertex: usize| {
        let [u, v] = data.uvs.map_or([0.0; 2], |uvs| uvs[vertex]);
        let [s, t] = data.second_uvs.map_or([0.0; 2], |uvs| uvs[vertex]);
        MaterialVertex {
            uvs: [u, v, s, t],
            colour: data.colours.map_or([255; 4], |colours| colours[vertex]),
        }
    };
    Some((0..data.positions.len()).map(material_vertex).collect())
}

/// The mean length of an edge, from at most ten thousand triangles evenly spread: it only sets how faint a wireframe
/// is.
fn mean_edge(data: &SurfaceData<'_>) -> f32 {
    let step = (data.triangles.len() / 10_000).max(1);
    let mut sum = 0.0;
    let mut count = 0;
    for triangle in data.triangles.iter().step_by(step) {
        let [a, b, c] = triangle.map(|vertex| glam::Vec3::from(data.positions[vertex as usize]));
        for length in [a.distance(b), b.distance(c), c.distance(a)] {
            if length.is_finite() {
                sum += length;
                count += 1;
            }
        }
    }
    sum / count.max(1) as f32
}
