//! A mesh's vertex and index buffers: a single page if the mesh fits in the device's buffers, otherwise as many as
//! needed, each with the vertices of its own triangles.

use std::ops::Range;
use std::sync::OnceLock;

use bytemuck::NoUninit;

use crate::RenderError;
use crate::device::buffers::{filled, refill};
use crate::device::opening::is_software;
use crate::surface::chunks::Chunks;
use crate::surface::edges::unique_edges;
use crate::surface::lod::{REDUCED_FROM_TRIANGLES, reduced_triangles};
use crate::uniforms::MaterialVertex;

/// The buffers of some of a mesh's chunks.
#[derive(Debug)]
pub(crate) struct Page {
    /// The mesh's index of each vertex of the page; `None` if the page has all vertices, in order.
    vertices: Option<Vec<u32>>,
    /// Triangles in the page's vertex indices, in draw order. Kept for the edges, which are built when first drawn.
    triangles: Vec<[u32; 3]>,
    /// The page's range in the draw order.
    draw_range: Range<u32>,
    pub(crate) positions: wgpu::Buffer,
    pub(crate) normals: wgpu::Buffer,
    pub(crate) regions: wgpu::Buffer,
    pub(crate) material: Option<wgpu::Buffer>,
    pub(crate) indices: wgpu::Buffer,
    /// The reduced level of detail, for large meshes on software devices.
    reduced: Option<Indices>,
    edges: OnceLock<Option<Indices>>,
}

/// Another index buffer over a page's vertices: its edges, or its reduced level of detail.
#[derive(Debug)]
pub(crate) struct Indices {
    pub(crate) buffer: wgpu::Buffer,
    pub(crate) index_count: u32,
}

/// The contents of vertex buffers, one entry per vertex of the mesh.
pub(crate) struct Attributes<'a> {
    pub(crate) positions: &'a [[f32; 3]],
    pub(crate) normals: &'a [[f32; 3]],
    pub(crate) regions: &'a [[u8; 4]],
    pub(crate) material: Option<&'a [MaterialVertex]>,
}

/// The most vertices and triangles that a page may have.
#[derive(Debug, Clone, Copy)]
pub(crate) struct PageLimits {
    pub(crate) vertices: usize,
    pub(crate) triangles: usize,
}

impl PageLimits {
    /// The limits that follow from the device's maximum buffer size.
    pub(crate) fn of(device: &wgpu::Device) -> Self {
        let bytes = usize::try_from(device.limits().max_buffer_size).unwrap_or(usize::MAX);
        Self {
            // The vertex buffer with the largest stride is that of the material attributes.
            vertices: bytes / size_of::<MaterialVertex>(),
            triangles: bytes / size_of::<[u32; 3]>(),
        }
    }
}

/// The chunks of each page: as many as fit, in order. A single chunk always fits.
pub(crate) fn page_chunks(chunks: &Chunks, vertex_count: usize, limits: PageLimits) -> Vec<Range<usize>> {
    let all = chunks.all();
    let triangle_count = all.last().map_or(0, |chunk| chunk.triangles.end as usize);
    let mut pages: Vec<Range<usize>> = Vec::new();
    if vertex_count <= limits.vertices && triangle_count <= limits.triangles {
        pages.push(0..all.len());
        return pages;
    }
    let mut on_page = vec![u32::MAX; vertex_count];
    let (mut vertices, mut triangles) = (0, 0);
    for (number, chunk) in all.iter().enumerate() {
        let page = (pages.len() as u32).wrapping_sub(1);
        let is_new = |vertex: &&u32| on_page[**vertex as usize] != page;
        let more = chunks.vertices(number).iter().filter(is_new).count();
        if pages.is_empty() || vertices + more > limits.vertices || triangles + chunk.triangles.len() > limits.triangles
        {
            pages.push(number..number);
            (vertices, triangles) = (0, 0);
        }
        let page = pages.len() as u32 - 1;
        for &vertex in chunks.vertices(number) {
            if on_page[vertex as usize] != page {
                on_page[vertex as usize] = page;
                vertices += 1;
            }
        }
        triangles += chunk.triangles.len();
        if let Some(last) = pages.last_mut() {
            last.end = number + 1;
        }
    }
    pages
}

impl Page {
    pub(crate) fn new(
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        chunks: &Chunks,
        range: Range<usize>,
        triangles: &[[u32; 3]],
        attributes: &Attributes<'_>,
    ) -> Result<Self, RenderError> {
        let all = chunks.all();
        let is_whole = range.len() == all.len();
        let triangles_of = |chunk: usize| all.get(chunk).map(|chunk| chunk.triangles.clone()).unwrap_or_default();
        let draw_range = if range.is_empty() {
            0..0
        } else {
            triangles_of(range.start).start..triangles_of(range.end - 1).end
        };
        let mut own = draw_range
            .clone()
            .map(|position| triangles[chunks.triangle_at(position) as usize])
            .collect::<Vec<_>>();
        let vertices = (!is_whole).then(|| {
            let lists = range.clone().flat_map(|chunk| chunks.vertices(chunk));
            let mut vertices: Vec<u32> = lists.copied().collect();
            vertices.sort_unstable();
            vertices.dedup();
            for corner in own.iter_mut().flatten() {
                *corner = vertices.partition_point(|&vertex| vertex < *corner) as u32;
            }
            vertices
        });
        let positions = gathered(&vertices, attributes.positions);
        let reduced = if triangles.len() < REDUCED_FROM_TRIANGLES || !is_software(device) {
            None
        } else {
            let reduced = reduced_triangles(&positions, &own);
            Some(Indices {
                buffer: filled(device, queue, "fewer triangles", wgpu::BufferUsages::INDEX, &reduced)?,
                index_count: 3 * reduced.len() as u32,
            })
        };
        let vertex = wgpu::BufferUsages::VERTEX;
        // Lines on the surface read positions by index.
        let looked_up = vertex | wgpu::BufferUsages::STORAGE;
        let mut page = Self {
            positions: filled(device, queue, "positions", looked_up, &positions)?,
            normals: filled(
                device,
                queue,
                "normals",
                vertex,
                &gathered(&vertices, attributes.normals),
            )?,
            regions: filled(
                device,
                queue,
                "region colours",
                vertex,
                &gathered(&vertices, attributes.regions),
            )?,
            material: None,
            indices: filled(device, queue, "triangles", wgpu::BufferUsages::INDEX, &own)?,
            vertices,
            triangles: own,
            draw_range,
            reduced,
            edges: OnceLock::new(),
        };
        if let Some(material) = attributes.material {
            let material = gathered(&page.vertices, material);
            page.material = Some(filled(
                device,
                queue,
                "texture coordinates and colours",
                vertex,
                &material,
            )?);
        }
        Ok(page)
    }

    /// Refills a vertex buffer from one entry per vertex of the mesh.
    pub(crate) fn refill<T: NoUninit>(
        &self,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        buffer: &wgpu::Buffer,
        contents: &[T],
    ) -> Result<(), RenderError> {
        refill(device, queue, buffer, &gathered(&self.vertices, contents))
    }

    /// Shows only the triangles for which `is_shown` is true, by their index in the mesh. Hidden ones become
    /// degenerate, so that indices and draw order stay the same.
    pub(crate) fn show(
        &mut self,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        chunks: &Chunks,
        is_shown: &dyn Fn(u32) -> bool,
    ) -> Result<(), RenderError> {
        let drawn: Vec<[u32; 3]> = self.drawn(chunks, is_shown);
        refill(device, queue, &self.indices, &drawn)?;
        self.edges = OnceLock::new();
        Ok(())
    }

    fn drawn(&self, chunks: &Chunks, is_shown: &dyn Fn(u32) -> bool) -> Vec<[u32; 3]> {
        let own = self.draw_range.clone().zip(&self.triangles);
        let shown = own.map(|(position, &corners)| match is_shown(chunks.triangle_at(position)) {
            true => corners,
            false => [0; 3],
        });
        shown.collect()
    }

    /// The page's range in the draw order.
    pub(crate) fn draw_range(&self) -> &Range<u32> {
        &self.draw_range
    }

    /// The page's index of a vertex of the mesh, if the page has it.
    pub(crate) fn vertex(&self, of_mesh: u32) -> Option<u32> {
        match &self.vertices {
            None => Some(of_mesh),
            Some(vertices) => vertices.binary_search(&of_mesh).ok().map(|at| at as u32),
        }
    }

    /// Returns true if the page has all of the mesh's vertices, in order.
    pub(crate) fn is_whole(&self) -> bool {
        self.vertices.is_none()
    }

    pub(crate) fn bytes(&self) -> u64 {
        let [edges, reduced] = [self.edges(), self.reduced()].map(|indices| indices.map_or(0, |own| own.buffer.size()));
        let material = self.material.as_ref().map_or(0, wgpu::Buffer::size);
        let others = [&self.positions, &self.normals, &self.regions, &self.indices];
        others.iter().map(|buffer| buffer.size()).sum::<u64>() + edges + reduced + material
    }

    pub(crate) fn reduced(&self) -> Option<&Indices> {
        self.reduced.as_ref()
    }

    pub(crate) fn edges(&self) -> Option<&Indices> {
        self.edges.get().and_then(Option::as_ref)
    }

    /// Creates the edges if they do not exist yet.
    pub(crate) fn prepare_edges(
        &self,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        chunks: &Chunks,
        is_shown: &dyn Fn(u32) -> bool,
    ) -> Result<(), RenderError> {
        if self.edges.get().is_some() {
            return Ok(());
        }
        let vertex_count = self
            .triangles
            .iter()
            .flatten()
            .max()
            .map_or(0, |&most| most as usize + 1);
        let mut edges = unique_edges(&self.drawn(chunks, is_shown), vertex_count);
        // Hidden triangles are degenerate.
        edges.retain(|[from, to]| from != to);
        let made = if edges.is_empty() {
            None
        } else {
            let buffer = filled(device, queue, "edges", wgpu::BufferUsages::INDEX, &edges)?;
            Some(Indices {
                buffer,
                index_count: 2 * edges.len() as u32,
            })
        };
        let _ = self.edges.set(made);
        Ok(())
    }
}

/// The entries for a page's vertices.
fn gathered<'a, T: Copy>(vertices: &Option<Vec<u32>>, contents: &'a [T]) -> std::borrow::Cow<'a, [T]> {
    match vertices {
        None => contents.into(),
        Some(vertices) => vertices.iter().map(|&vertex| contents[vertex as usize]).collect(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_chunk_is_on_one_page_and_no_page_exceeds_its_limits() {
        let count = 300_000_u32;
        let positions: Vec<[f32; 3]> = (0..count + 2).map(|v| [(v / 2) as f32, (v % 2) as f32, 0.0]).collect();
        let triangles: Vec<[u32; 3]> = (0..count).map(|t| [t, t + 1, t + 2]).collect();
        let chunks = Chunks::new(&positions, &triangles, &[], &[]);
        let whole = page_chunks(
            &chunks,
            positions.len(),
            PageLimits {
                vertices: 400_000,
                triangles: 300_000,
            },
        );
        assert!(whole.len() == 1 && whole[0] == (0..chunks.count()));
        for limits in [
            PageLimits {
                vertices: 50_000,
                triangles: 1 << 30,
            },
            PageLimits {
                vertices: 1 << 30,
                triangles: 70_000,
            },
        ] {
            let pages = page_chunks(&chunks, positions.len(), limits);
            assert!(pages.len() > 3);
            let mut next = 0;
            for page in pages {
                assert_eq!(page.start, next);
                next = page.end;
                let triangles: usize = page.clone().map(|c| chunks.all()[c].triangles.len()).sum();
                let mut vertices: Vec<u32> = page.flat_map(|c| chunks.vertices(c).to_vec()).collect();
                vertices.sort_unstable();
                vertices.dedup();
                assert!(triangles <= limits.triangles && vertices.len() <= limits.vertices);
            }
            assert_eq!(next, chunks.count());
        }
    }
}
