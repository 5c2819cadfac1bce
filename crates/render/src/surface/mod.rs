//! Triangle meshes in GPU buffers.

mod borders;
pub(crate) mod chunks;
pub(crate) mod data;
pub(crate) mod draw_calls;
mod edges;
pub(crate) mod lines;
mod lod;
mod pages;
pub(crate) mod shadow;
pub(crate) mod update;

use std::sync::{Arc, OnceLock};

use self::chunks::{ChunkBounds, Chunks};
use self::data::checked;
use self::lines::LineSet;
use self::pages::{Attributes, Page, PageLimits, page_chunks};
use crate::device::buffers::filled;
use crate::pipelines::MaterialAttributes;
use crate::uniforms::{MaterialVertex, SurfaceUniform};
use crate::{ColourSpace, Detail, Gpu, Materials, RenderError, SurfaceData};

/// A triangle mesh in GPU buffers. Its topology is fixed; its vertices can move, and their colours can change.
#[derive(Debug)]
pub struct Surface {
    vertex_count: usize,
    /// Kept for the borders, which are found when first drawn. Costs 12 bytes per triangle.
    triangles: Vec<[u32; 3]>,
    welded: Option<Vec<u32>>,
    pub(crate) chunks: Arc<Chunks>,
    pub(crate) bounds: Vec<ChunkBounds>,
    pub(crate) pages: Vec<Page>,
    material_attributes: MaterialAttributes,
    /// The single entry for surfaces without texture coordinates and vertex colours.
    shared_material_vertex: wgpu::Buffer,
    uniform_buffer: wgpu::Buffer,
    group: wgpu::BindGroup,
    materials: Vec<wgpu::BindGroup>,
    /// For each triangle, whether it is drawn; `None` draws all.
    pub(crate) shown: Option<Arc<Vec<bool>>>,
    /// One entry per page.
    borders: OnceLock<Vec<Option<LineSet>>>,
    /// One entry per page.
    outlines: Vec<Option<LineSet>>,
    /// One entry per page: lines and points that are always drawn.
    wires: Vec<Option<LineSet>>,
    shadow: Option<wgpu::BindGroup>,
}

impl Surface {
    /// Uploads a mesh. It may be empty: then it draws nothing.
    ///
    /// # Errors
    /// Slices of different lengths, indices out of range, textures of the wrong size, or out of memory.
    pub fn new(gpu: &Gpu, data: &SurfaceData<'_>) -> Result<Self, RenderError> {
        Self::paged(gpu, data, PageLimits::of(&gpu.device))
    }

    /// [`Surface::new`] as if the device's buffers held at most `vertices` and `triangles`, to test meshes that need
    /// several pages.
    ///
    /// # Errors
    /// As [`Surface::new`].
    pub fn spread(gpu: &Gpu, data: &SurfaceData<'_>, vertices: usize, triangles: usize) -> Result<Self, RenderError> {
        Self::paged(gpu, data, PageLimits { vertices, triangles })
    }

    fn paged(gpu: &Gpu, data: &SurfaceData<'_>, limits: PageLimits) -> Result<Self, RenderError> {
        checked(data)?;
        let (device, queue) = (&gpu.device, &gpu.queue);
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
        let uniform_buffer = gpu.uniform("surface uniform", uniform)?;
        let group = gpu.uniform_group(&gpu.pipelines.surface_layout, &uniform_buffer)?;
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
            materials: Materials::new(gpu, data.materials, data.textures)?.groups,
            shown: None,
            borders: OnceLock::new(),
            outlines: Vec::new(),
            wires: Vec::new(),
            shadow: None,
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

    /// GPU memory of the mesh in bytes, without textures.
    pub fn gpu_bytes(&self) -> u64 {
        self.pages.iter().map(Page::bytes).sum()
    }

    /// The number of pages: sets of buffers over which the mesh is distributed.
    pub fn page_count(&self) -> usize {
        self.pages.len()
    }

    /// The page of a mesh that has only one.
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

    /// The chunks, which define the draw order.
    pub(crate) fn chunks(&self) -> Arc<Chunks> {
        Arc::clone(&self.chunks)
    }

    /// Binds the surface's uniform as group 1.
    pub(crate) fn bind(&self, pass: &mut wgpu::RenderPass<'_>) {
        pass.set_bind_group(1, &self.group, &[]);
    }

    /// Binds a page's shape and indices.
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

    /// Binds a page's material attributes.
    pub(crate) fn bind_material_attributes(&self, pass: &mut wgpu::RenderPass<'_>, page: usize) {
        let own = self.pages.get(page).and_then(|page| page.material.as_ref());
        pass.set_vertex_buffer(3, own.unwrap_or(&self.shared_material_vertex).slice(..));
    }

    /// The lines and points of each page that are always drawn; empty if there are none.
    pub(crate) fn wires(&self) -> &[Option<LineSet>] {
        &self.wires
    }

    /// The outlines of each page; empty if there are none.
    pub(crate) fn outlines(&self) -> &[Option<LineSet>] {
        &self.outlines
    }

    /// Creates the edges of all pages if they do not exist yet.
    pub(crate) fn prepare_edges(&self, gpu: &Gpu) -> Result<(), RenderError> {
        let (device, queue) = (&gpu.device, &gpu.queue);
        let is_shown = |triangle| self.is_shown(triangle);
        self.pages
            .iter()
            .try_for_each(|page| page.prepare_edges(device, queue, &self.chunks, &is_shown))
    }

    /// Sets the id of the first triangle for the next pick.
    pub(crate) fn set_id_base(&self, queue: &wgpu::Queue, id_base: u32) {
        let offset = std::mem::offset_of!(SurfaceUniform, id_base) as u64;
        queue.write_buffer(&self.uniform_buffer, offset, bytemuck::bytes_of(&id_base));
    }
}

/// Interleaved texture coordinates and colours, if the data has either.
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

/// The mean edge length, sampled from at most ten thousand triangles: it only sets how faint the wireframe is.
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
