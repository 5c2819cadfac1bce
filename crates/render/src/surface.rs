//! A triangle mesh in GPU buffers.

use std::ops::Range;
use std::sync::OnceLock;

use crate::buffers::{filled, refill};
use crate::edges::unique_edges;
use crate::surface_data::checked;
use crate::uniforms::{MaterialUniform, SurfaceUniform};
use crate::{AlphaMode, ColourSpace, Material, RenderError, Renderer, SurfaceData};

/// A triangle mesh in GPU buffers; its topology is fixed, its vertices may move and change colour.
#[derive(Debug)]
pub struct Surface {
    vertex_count: usize,
    /// Kept for the edges, which are only made when a wireframe is first drawn: 12 bytes a triangle.
    triangles: Vec<[u32; 3]>,
    /// Positions, normals, texture coordinates, colours, regions: the order of the pipelines' buffers.
    vertex_buffers: [wgpu::Buffer; 5],
    index_buffer: wgpu::Buffer,
    uniform_buffer: wgpu::Buffer,
    group: wgpu::BindGroup,
    materials: Vec<wgpu::BindGroup>,
    batches: Vec<Batch>,
    edges: OnceLock<Option<Edges>>,
}

/// Triangles that are drawn together.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Batch {
    pub(crate) triangles: Range<u32>,
    pub(crate) material: usize,
    pub(crate) alpha: AlphaMode,
}

/// A surface's edges, for its wireframe.
#[derive(Debug)]
pub(crate) struct Edges {
    pub(crate) buffer: wgpu::Buffer,
    pub(crate) index_count: u32,
}

const POSITIONS: usize = 0;
const NORMALS: usize = 1;
const REGIONS: usize = 4;

impl Surface {
    /// Uploads a mesh. No triangles or no vertices is fine: it draws nothing.
    ///
    /// # Errors
    /// Slices that contradict each other, numbers out of range, buffers beyond the device's limit
    /// ([`RenderError::TooLarge`]), memory.
    pub fn new(renderer: &Renderer, data: &SurfaceData<'_>) -> Result<Self, RenderError> {
        checked(data)?;
        let (device, queue) = (renderer.device(), renderer.queue());
        let count = data.positions.len();
        let vertex = wgpu::BufferUsages::VERTEX;
        let uvs = data.uvs.map_or_else(|| vec![[0.0; 2]; count], <[_]>::to_vec);
        let colours = data.colours.map_or_else(|| vec![[255; 4]; count], <[_]>::to_vec);
        let regions = data.regions.map_or_else(|| vec![[0; 4]; count], <[_]>::to_vec);
        let vertex_buffers = [
            filled(device, queue, "positions", vertex, data.positions)?,
            filled(device, queue, "normals", vertex, data.normals)?,
            filled(device, queue, "texture coordinates", vertex, &uvs)?,
            filled(device, queue, "vertex colours", vertex, &colours)?,
            filled(device, queue, "region colours", vertex, &regions)?,
        ];
        let index_buffer = filled(device, queue, "triangles", wgpu::BufferUsages::INDEX, data.triangles)?;
        let uniform = SurfaceUniform {
            id_base: 1,
            colours_are_linear: u32::from(data.colour_space == ColourSpace::Linear),
            mean_edge: mean_edge(data),
            padding: 0,
        };
        let uniform_buffer = filled(
            device,
            queue,
            "surface uniform",
            wgpu::BufferUsages::UNIFORM,
            &[uniform],
        )?;
        let group = renderer.uniform_group(&renderer.pipelines().surface_layout, &uniform_buffer)?;
        Ok(Self {
            vertex_count: count,
            triangles: data.triangles.to_vec(),
            vertex_buffers,
            index_buffer,
            uniform_buffer,
            group,
            materials: material_groups(renderer, data)?,
            batches: batches(data),
            edges: OnceLock::new(),
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
        let edges = self
            .edges
            .get()
            .and_then(Option::as_ref)
            .map_or(0, |edges| edges.buffer.size());
        self.vertex_buffers.iter().map(wgpu::Buffer::size).sum::<u64>() + self.index_buffer.size() + edges
    }

    /// Moves the vertices; seen in the next drawing.
    ///
    /// # Errors
    /// [`RenderError::Length`] unless there is one position a vertex; memory.
    pub fn update_positions(&self, renderer: &Renderer, positions: &[[f32; 3]]) -> Result<(), RenderError> {
        self.update(renderer, "positions", POSITIONS, positions)
    }

    /// Turns the normals (unit vectors); seen in the next drawing.
    ///
    /// # Errors
    /// As [`Surface::update_positions`].
    pub fn update_normals(&self, renderer: &Renderer, normals: &[[f32; 3]]) -> Result<(), RenderError> {
        self.update(renderer, "normals", NORMALS, normals)
    }

    /// Sets the region colours that [`crate::Style::region_share`] shows: sRGB, and in the fourth byte how much of
    /// the clay they replace (0 none, 255 all).
    ///
    /// # Errors
    /// As [`Surface::update_positions`].
    pub fn update_regions(&self, renderer: &Renderer, regions: &[[u8; 4]]) -> Result<(), RenderError> {
        self.update(renderer, "region colours", REGIONS, regions)
    }

    fn update<T: bytemuck::NoUninit>(
        &self,
        renderer: &Renderer,
        what: &'static str,
        buffer: usize,
        contents: &[T],
    ) -> Result<(), RenderError> {
        if contents.len() != self.vertex_count {
            let (expected, found) = (self.vertex_count, contents.len());
            return Err(RenderError::Length { what, expected, found });
        }
        refill(
            renderer.device(),
            renderer.queue(),
            &self.vertex_buffers[buffer],
            contents,
        )
    }

    pub(crate) fn batches(&self) -> &[Batch] {
        &self.batches
    }

    pub(crate) fn material(&self, number: usize) -> &wgpu::BindGroup {
        &self.materials[number]
    }

    pub(crate) fn index_count(&self) -> u32 {
        3 * self.triangles.len() as u32
    }

    /// Binds group 1 and all vertex and index buffers.
    pub(crate) fn bind(&self, pass: &mut wgpu::RenderPass<'_>) {
        pass.set_bind_group(1, &self.group, &[]);
        for (slot, buffer) in self.vertex_buffers.iter().enumerate() {
            pass.set_vertex_buffer(slot as u32, buffer.slice(..));
        }
        pass.set_index_buffer(self.index_buffer.slice(..), wgpu::IndexFormat::Uint32);
    }

    /// Binds group 1, positions and edges; gives the number of indices, zero when there is nothing to draw.
    pub(crate) fn bind_edges(&self, pass: &mut wgpu::RenderPass<'_>) -> u32 {
        let Some(edges) = self.edges.get().and_then(Option::as_ref) else {
            return 0;
        };
        pass.set_bind_group(1, &self.group, &[]);
        pass.set_vertex_buffer(0, self.vertex_buffers[POSITIONS].slice(..));
        pass.set_index_buffer(edges.buffer.slice(..), wgpu::IndexFormat::Uint32);
        edges.index_count
    }

    /// Makes the edges unless they are there.
    pub(crate) fn prepare_edges(&self, device: &wgpu::Device, queue: &wgpu::Queue) -> Result<(), RenderError> {
        if self.edges.get().is_some() {
            return Ok(());
        }
        let edges = unique_edges(&self.triangles, self.vertex_count);
        let made = if edges.is_empty() {
            None
        } else {
            let buffer = filled(device, queue, "edges", wgpu::BufferUsages::INDEX, &edges)?;
            Some(Edges {
                buffer,
                index_count: 2 * edges.len() as u32,
            })
        };
        let _ = self.edges.set(made);
        Ok(())
    }

    /// Says which number the first triangle has in the next drawing of triangle numbers.
    pub(crate) fn set_id_base(&self, queue: &wgpu::Queue, id_base: u32) {
        let offset = std::mem::offset_of!(SurfaceUniform, id_base) as u64;
        queue.write_buffer(&self.uniform_buffer, offset, bytemuck::bytes_of(&id_base));
    }
}

/// The given materials, and the default one after them.
fn material_groups(renderer: &Renderer, data: &SurfaceData<'_>) -> Result<Vec<wgpu::BindGroup>, RenderError> {
    let textures = data
        .textures
        .iter()
        .enumerate()
        .map(|(number, texture)| renderer.textures().texture(number, texture))
        .collect::<Result<Vec<_>, _>>()?;
    data.materials
        .iter()
        .chain([&Material::default()])
        .map(|material| {
            let (alpha_cutoff, opaque) = match material.alpha {
                AlphaMode::Mask { cutoff } => (cutoff, true),
                AlphaMode::Opaque => (0.0, true),
                AlphaMode::Blend => (0.0, false),
            };
            let uniform = MaterialUniform {
                base_colour: material.base_colour,
                alpha_cutoff,
                back_share: if material.double_sided || !opaque { 1.0 } else { 0.45 },
                padding: [0.0; 2],
            };
            let texture = material
                .base_colour_texture
                .map(|number| (&textures[number], data.textures[number].wrap));
            renderer.material_group(&uniform, texture)
        })
        .collect()
}

/// The groups in the order of triangles, gaps filled with the default material.
fn batches(data: &SurfaceData<'_>) -> Vec<Batch> {
    let default_material = data.materials.len();
    let count = data.triangles.len() as u32;
    let mut groups: Vec<_> = data.groups.iter().filter(|group| !group.triangles.is_empty()).collect();
    groups.sort_by_key(|group| group.triangles.start);
    let mut batches: Vec<Batch> = Vec::new();
    let mut push = |triangles: Range<u32>, material: usize| {
        if triangles.is_empty() {
            return;
        }
        match batches.last_mut() {
            Some(last) if last.material == material && last.triangles.end == triangles.start => {
                last.triangles.end = triangles.end;
            }
            _ => {
                let alpha = data.materials.get(material).map_or(AlphaMode::Opaque, |m| m.alpha);
                batches.push(Batch {
                    triangles,
                    material,
                    alpha,
                });
            }
        }
    };
    let mut next = 0;
    for group in groups {
        push(next..group.triangles.start, default_material);
        push(group.triangles.clone(), group.material);
        next = next.max(group.triangles.end);
    }
    push(next..count, default_material);
    batches
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::MaterialGroup;

    #[test]
    fn gaps_between_groups_get_the_default_material_and_neighbours_merge() {
        let group = |triangles, material| MaterialGroup { triangles, material };
        let groups = [group(6..8, 0), group(2..4, 1), group(4..4, 0), group(4..6, 1)];
        let glass = Material {
            alpha: AlphaMode::Blend,
            ..Material::default()
        };
        let data = SurfaceData {
            triangles: &[[0; 3]; 10],
            groups: &groups,
            materials: &[Material::default(), glass],
            ..Default::default()
        };
        let batch = |triangles, material, alpha| Batch {
            triangles,
            material,
            alpha,
        };
        let expected = [
            batch(0..2, 2, AlphaMode::Opaque),
            batch(2..6, 1, AlphaMode::Blend),
            batch(6..8, 0, AlphaMode::Opaque),
            batch(8..10, 2, AlphaMode::Opaque),
        ];
        assert_eq!(batches(&data), expected);
    }
}
