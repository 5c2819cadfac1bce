//! A linear deformation evaluated on the device: a frame uploads four columns a handle and nothing a vertex.
//!
//! A handle moves affinely and a linear method's surface answers linearly, so a vertex stands at
//! rest + Σ_h (c_h0 x + c_h1 y + c_h2 z + c_h3 w), where (x, y, z, w) is its row's entry for handle h and c_h0..3 are the
//! columns of what the handle does (Botsch & Kobbelt 2004). Vertices of a handle have rows, too; what is fixed has none.
//! Normals are then the area-weighted means of the moved triangles, the file's own turned along as on the processor.
//! All is f32: against f64 that costs a few units in the last place of the positions' own size.

use crate::bindings::bind_group;
use crate::buffers::{filled, refill};
use crate::guard::guarded;
use crate::shaders::Shader;
use crate::uniforms::DeformUniform;
use crate::{RenderError, Renderer, Surface};

/// What a [`Deformer`] is made of.
#[derive(Debug, Clone, Copy)]
pub struct DeformerData<'a> {
    /// Positions at rest, relative to the caller's centre, one a vertex.
    pub rest: &'a [[f32; 3]],
    /// The row of each vertex; [`DeformerData::STILL`] for one that does not move.
    pub row_of_vertex: &'a [u32],
    /// Row-major: `handle_count` entries (x, y, z, constant) a row.
    pub rows: &'a [[f32; 4]],
    /// How many handles a row has.
    pub handle_count: usize,
    /// The surface's triangles.
    pub triangles: &'a [[u32; 3]],
    /// For each vertex the group that it shares a normal with; groups are numbered from 0 without gaps.
    pub normal_groups: &'a [u32],
    /// Unit normals of the file, one a vertex (zero where it has none), and with them the means of the triangles at
    /// rest.
    pub stored: Option<StoredNormals<'a>>,
}

/// The file's own normals, and what they are turned from.
#[derive(Debug, Clone, Copy)]
pub struct StoredNormals<'a> {
    /// The file's, one a vertex.
    pub stored: &'a [[f32; 3]],
    /// Those of the triangles at rest, one a vertex.
    pub at_rest: &'a [[f32; 3]],
}

impl DeformerData<'_> {
    /// The row of a vertex that does not move.
    pub const STILL: u32 = u32::MAX;
}

/// A deformation on the device, bound to one surface.
#[derive(Debug)]
pub struct Deformer {
    vertex_count: u32,
    handle_count: usize,
    columns: wgpu::Buffer,
    groups: [wgpu::BindGroup; 3],
    pipelines: [wgpu::ComputePipeline; 2],
}

/// Invocations in a workgroup, as the shader says.
const GROUP: u32 = 64;
/// The most workgroups a side that every device allows.
const MOST_GROUPS: u32 = 65_535;

impl Deformer {
    /// Uploads rows and the way from triangles to normals for `surface`.
    ///
    /// # Errors
    /// [`RenderError::Length`] where the slices contradict each other or the surface; [`RenderError::TooLarge`] where
    /// the surface or the rows exceed what the device's shaders can reach: then deform on the processor.
    pub fn new(renderer: &Renderer, surface: &Surface, data: &DeformerData<'_>) -> Result<Self, RenderError> {
        let (device, queue) = (renderer.device(), renderer.queue());
        let count = surface.vertex_count();
        checked(surface, data)?;
        let limit = device.limits().max_storage_buffer_binding_size;
        let largest = (16 * data.rows.len()).max(36 * data.triangles.len()).max(32 * count) as u64;
        let too_large = |bytes| RenderError::TooLarge {
            what: "bases",
            bytes,
            limit,
        };
        let page = surface.whole_page().ok_or_else(|| too_large(12 * count as u64))?;
        if largest > limit {
            return Err(too_large(largest));
        }
        let storage = wgpu::BufferUsages::STORAGE;
        let bits = |(&[x, y, z], &row): (&[f32; 3], &u32)| [x.to_bits(), y.to_bits(), z.to_bits(), row];
        let rest: Vec<[u32; 4]> = data.rest.iter().zip(data.row_of_vertex).map(bits).collect();
        let (starts, faces) = faces_of_vertices(data);
        let of_rest = |vertex: usize| {
            let [stored, at_rest] = match data.stored {
                Some(StoredNormals { stored, at_rest }) => [stored[vertex], at_rest[vertex]],
                None => [[0.0; 3]; 2],
            };
            [at_rest, stored].map(|[x, y, z]| [x, y, z, 0.0])
        };
        let normal_count = if data.stored.is_some() { count } else { 1.min(count) };
        let rest_normals: Vec<[f32; 4]> = (0..normal_count).flat_map(of_rest).collect();
        let uniform = DeformUniform {
            vertex_count: count as u32,
            handle_count: data.handle_count as u32,
            has_stored: u32::from(data.stored.is_some()),
            padding: 0,
        };
        let job = filled(device, queue, "deformation", wgpu::BufferUsages::UNIFORM, &[uniform])?;
        let still = vec![[0.0_f32; 4]; 4 * data.handle_count.max(1)];
        let columns = filled(device, queue, "handle motions", storage, &still)?;
        let held = [
            filled(device, queue, "rest positions", storage, &rest)?,
            filled(device, queue, "bases", storage, data.rows)?,
            filled(device, queue, "first faces", storage, &starts)?,
            filled(device, queue, "faces of vertices", storage, &faces)?,
            filled(device, queue, "corners of faces", storage, data.triangles)?,
            filled(device, queue, "rest normals", storage, &rest_normals)?,
        ];
        let [rest, rows, starts, faces, triangles, rest_normals] = &held;
        guarded(device, "while getting ready to deform", || {
            let module = device.create_shader_module(wgpu::ShaderModuleDescriptor {
                label: Some(Shader::Deform.file_name()),
                source: wgpu::ShaderSource::Wgsl(Shader::Deform.composed().into()),
            });
            let written = wgpu::BufferBindingType::Storage { read_only: false };
            let read = wgpu::BufferBindingType::Storage { read_only: true };
            let layouts = [
                layout(device, &[wgpu::BufferBindingType::Uniform, written, written]),
                layout(device, &[read; 3]),
                layout(device, &[read; 4]),
            ];
            let [shape, bases, around] = &layouts;
            let groups = [
                group(device, shape, &[&job, &page.positions, &page.normals]),
                group(device, bases, &[rest, rows, &columns]),
                group(device, around, &[starts, faces, triangles, rest_normals]),
            ];
            let pipeline = |entry, groups: &[Option<&wgpu::BindGroupLayout>]| {
                let layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
                    label: Some(entry),
                    bind_group_layouts: groups,
                    immediate_size: 0,
                });
                device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
                    label: Some(entry),
                    layout: Some(&layout),
                    module: &module,
                    entry_point: Some(entry),
                    compilation_options: Default::default(),
                    cache: None,
                })
            };
            let pipelines = [
                pipeline("move_vertices", &[Some(shape), Some(bases)]),
                pipeline("turn_normals", &[Some(shape), None, Some(around)]),
            ];
            Ok(Self {
                vertex_count: count as u32,
                handle_count: data.handle_count,
                columns,
                groups,
                pipelines,
            })
        })
    }

    /// Moves the surface that this was made for: `motions` has four columns (x, y, z, constant) a handle. Submits and
    /// does not wait; the surface is then always drawn whole, since nobody knows where its chunks are.
    ///
    /// # Errors
    /// [`RenderError::Length`] for another number of handles; memory, or a device that refuses.
    pub fn run(
        &self,
        renderer: &Renderer,
        surface: &mut Surface,
        motions: &[[[f32; 3]; 4]],
    ) -> Result<(), RenderError> {
        let device = renderer.device();
        if motions.len() != self.handle_count {
            let (expected, found) = (self.handle_count, motions.len());
            let what = "handle motions";
            return Err(RenderError::Length { what, expected, found });
        }
        if self.vertex_count == 0 {
            return Ok(());
        }
        let columns: Vec<[f32; 4]> = motions.iter().flatten().map(|&[x, y, z]| [x, y, z, 0.0]).collect();
        refill(device, renderer.queue(), &self.columns, &columns)?;
        surface.forget_bounds();
        guarded(device, "while deforming", || {
            let groups = self.vertex_count.div_ceil(GROUP);
            let rows = groups.div_ceil(MOST_GROUPS);
            let mut encoder = device.create_command_encoder(&Default::default());
            for pipeline in &self.pipelines {
                // A pass of its own, so that the second one sees what the first has written.
                let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor {
                    label: Some("deform"),
                    timestamp_writes: None,
                });
                pass.set_pipeline(pipeline);
                for (number, group) in self.groups.iter().enumerate() {
                    pass.set_bind_group(number as u32, group, &[]);
                }
                pass.dispatch_workgroups(groups.div_ceil(rows), rows, 1);
            }
            renderer.queue().submit([encoder.finish()]);
            Ok(())
        })
    }
}

fn checked(surface: &Surface, data: &DeformerData<'_>) -> Result<(), RenderError> {
    let count = surface.vertex_count();
    let lengths = [
        ("rest positions", data.rest.len(), count),
        ("rows of vertices", data.row_of_vertex.len(), count),
        ("normal groups", data.normal_groups.len(), count),
        (
            "stored normals",
            data.stored.map_or(count, |normals| normals.stored.len()),
            count,
        ),
        (
            "rest normals",
            data.stored.map_or(count, |normals| normals.at_rest.len()),
            count,
        ),
        ("triangles", data.triangles.len(), surface.triangle_count()),
    ];
    for (what, found, expected) in lengths {
        if found != expected {
            return Err(RenderError::Length { what, expected, found });
        }
    }
    let row_count = data.rows.len() / data.handle_count.max(1);
    let moving = data.row_of_vertex.iter().filter(|&&row| row != DeformerData::STILL);
    if let Some(&row) = moving.max().filter(|&&row| row as usize >= row_count) {
        return Err(RenderError::NoSuch {
            what: "row",
            number: row as usize,
            count: row_count,
        });
    }
    let corners = data.triangles.iter().flatten();
    if let Some(&vertex) = corners.max().filter(|&&vertex| vertex as usize >= count) {
        return Err(RenderError::NoSuch {
            what: "vertex",
            number: vertex as usize,
            count,
        });
    }
    Ok(())
}

/// For each vertex the faces of its group, ascending, as offsets and a list.
fn faces_of_vertices(data: &DeformerData<'_>) -> (Vec<u32>, Vec<u32>) {
    let group_count = data.normal_groups.iter().max().map_or(0, |&most| most as usize + 1);
    let mut of_group: Vec<Vec<u32>> = vec![Vec::new(); group_count];
    for (face, triangle) in data.triangles.iter().enumerate() {
        for &vertex in triangle {
            of_group[data.normal_groups[vertex as usize] as usize].push(face as u32);
        }
    }
    let (mut starts, mut faces) = (vec![0], Vec::new());
    for &group in data.normal_groups {
        faces.extend_from_slice(&of_group[group as usize]);
        starts.push(faces.len() as u32);
    }
    (starts, faces)
}

fn layout(device: &wgpu::Device, types: &[wgpu::BufferBindingType]) -> wgpu::BindGroupLayout {
    let entries: Vec<wgpu::BindGroupLayoutEntry> = types
        .iter()
        .enumerate()
        .map(|(binding, &ty)| wgpu::BindGroupLayoutEntry {
            binding: binding as u32,
            visibility: wgpu::ShaderStages::COMPUTE,
            ty: wgpu::BindingType::Buffer {
                ty,
                has_dynamic_offset: false,
                min_binding_size: None,
            },
            count: None,
        })
        .collect();
    device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
        label: Some("deform"),
        entries: &entries,
    })
}

fn group(device: &wgpu::Device, layout: &wgpu::BindGroupLayout, buffers: &[&wgpu::Buffer]) -> wgpu::BindGroup {
    let resources: Vec<_> = buffers.iter().map(|buffer| buffer.as_entire_binding()).collect();
    bind_group(device, "deform", layout, &resources)
}
