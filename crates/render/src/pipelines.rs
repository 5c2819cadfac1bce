//! Layouts, made once a device, and pipelines, each when it is first needed.

use std::collections::HashMap;

use crate::guard::guarded;
use crate::shaders::Shader;
use crate::uniforms::{MaterialVertex, OverlayLineInstance, OverlayVertex, SurfaceLineInstance};
use crate::{RenderError, Samples, Target};

/// The format of triangle numbers.
pub(crate) const ID_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::R32Uint;

/// Layouts shared by all pipelines, and the pipelines made so far.
#[derive(Debug)]
pub(crate) struct Pipelines {
    pub(crate) frame_layout: wgpu::BindGroupLayout,
    pub(crate) surface_layout: wgpu::BindGroupLayout,
    pub(crate) matcap_layout: wgpu::BindGroupLayout,
    pub(crate) material_layout: wgpu::BindGroupLayout,
    pub(crate) environment_layout: wgpu::BindGroupLayout,
    pub(crate) positions_layout: wgpu::BindGroupLayout,
    modules: HashMap<Shader, wgpu::ShaderModule>,
    made: HashMap<(Pipeline, Samples), wgpu::RenderPipeline>,
}

/// A pipeline of a picture, or that of triangle numbers.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(crate) enum Pipeline {
    Matcap,
    Painted,
    Zebra,
    Normals,
    Material(Alpha, MaterialAttributes),
    Wireframe,
    SurfaceLines(Visibility),
    Background,
    Grid,
    OverlayTriangles(Visibility),
    OverlayLines(Visibility),
    Id,
}

/// How a material's alpha is drawn.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(crate) enum Alpha {
    Opaque,
    Mask,
    Blend,
}

/// Whether each vertex has texture coordinates and a colour of its own.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(crate) enum MaterialAttributes {
    PerVertex,
    Shared,
}

/// Marks are drawn where they are seen and, fainter, where a surface hides them.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(crate) enum Visibility {
    Hidden,
    Visible,
}

impl Visibility {
    /// In the order of drawing.
    pub(crate) const BOTH: [Self; 2] = [Self::Hidden, Self::Visible];
}

const POSITION: [wgpu::VertexAttribute; 1] = wgpu::vertex_attr_array![0 => Float32x3];
const NORMAL: [wgpu::VertexAttribute; 1] = wgpu::vertex_attr_array![1 => Float32x3];
const REGION: [wgpu::VertexAttribute; 1] = wgpu::vertex_attr_array![2 => Unorm8x4];
const MATERIAL: [wgpu::VertexAttribute; 2] = wgpu::vertex_attr_array![3 => Float32x4, 4 => Unorm8x4];

/// The vertex buffers of a surface's shape: positions, normals, regions.
pub(crate) const SHAPE_BUFFERS: [Option<wgpu::VertexBufferLayout<'static>>; 3] = [
    Some(per_vertex(12, &POSITION)),
    Some(per_vertex(12, &NORMAL)),
    Some(per_vertex(4, &REGION)),
];

/// The same, and what only materials read; a stride of 0 gives every vertex the one entry.
pub(crate) const fn material_buffers(attributes: MaterialAttributes) -> [Option<wgpu::VertexBufferLayout<'static>>; 4] {
    let stride = match attributes {
        MaterialAttributes::PerVertex => size_of::<MaterialVertex>() as u64,
        MaterialAttributes::Shared => 0,
    };
    [
        Some(per_vertex(12, &POSITION)),
        Some(per_vertex(12, &NORMAL)),
        Some(per_vertex(4, &REGION)),
        Some(per_vertex(stride, &MATERIAL)),
    ]
}

/// The instance buffer of lines on the surface.
pub(crate) const SURFACE_LINE_BUFFER: wgpu::VertexBufferLayout<'static> = {
    const ATTRIBUTES: [wgpu::VertexAttribute; 6] = wgpu::vertex_attr_array![
        0 => Uint32x2, 1 => Uint32x2, 2 => Float32x2, 3 => Float32, 4 => Float32, 5 => Unorm8x4
    ];
    wgpu::VertexBufferLayout {
        array_stride: size_of::<SurfaceLineInstance>() as u64,
        step_mode: wgpu::VertexStepMode::Instance,
        attributes: &ATTRIBUTES,
    }
};

/// The one vertex buffer of overlay triangles.
pub(crate) const OVERLAY_TRIANGLE_BUFFER: wgpu::VertexBufferLayout<'static> = {
    const ATTRIBUTES: [wgpu::VertexAttribute; 3] =
        wgpu::vertex_attr_array![0 => Float32x3, 1 => Unorm8x4, 2 => Float32];
    per_vertex(size_of::<OverlayVertex>() as u64, &ATTRIBUTES)
};

/// The one instance buffer of overlay lines.
pub(crate) const OVERLAY_LINE_BUFFER: wgpu::VertexBufferLayout<'static> = {
    const ATTRIBUTES: [wgpu::VertexAttribute; 6] = wgpu::vertex_attr_array![
        0 => Float32x3, 1 => Float32, 2 => Float32x3, 3 => Float32, 4 => Unorm8x4, 5 => Unorm8x4
    ];
    wgpu::VertexBufferLayout {
        array_stride: size_of::<OverlayLineInstance>() as u64,
        step_mode: wgpu::VertexStepMode::Instance,
        attributes: &ATTRIBUTES,
    }
};

const fn per_vertex(
    array_stride: u64,
    attributes: &'static [wgpu::VertexAttribute],
) -> wgpu::VertexBufferLayout<'static> {
    wgpu::VertexBufferLayout {
        array_stride,
        step_mode: wgpu::VertexStepMode::Vertex,
        attributes,
    }
}

impl Pipelines {
    /// The layouts; pipelines follow on demand.
    pub(crate) fn new(device: &wgpu::Device) -> Self {
        let both = wgpu::ShaderStages::VERTEX_FRAGMENT;
        let fragment = wgpu::ShaderStages::FRAGMENT;
        let mut material = vec![uniform_entry(0, fragment)];
        for image in 0..5 {
            material.push(texture_entry(2 * image + 1, wgpu::TextureViewDimension::D2));
            material.push(sampler_entry(2 * image + 2));
        }
        let flat = wgpu::TextureViewDimension::D2;
        let cube = wgpu::TextureViewDimension::Cube;
        Self {
            frame_layout: layout(device, "frame", &[uniform_entry(0, both)]),
            surface_layout: layout(device, "surface", &[uniform_entry(0, both)]),
            matcap_layout: layout(
                device,
                "matcap",
                &[uniform_entry(0, fragment), texture_entry(1, flat), sampler_entry(2)],
            ),
            material_layout: layout(device, "material", &material),
            environment_layout: layout(
                device,
                "environment",
                &[texture_entry(0, cube), texture_entry(1, cube), sampler_entry(2)],
            ),
            positions_layout: layout(device, "positions", &[storage_entry(0)]),
            modules: HashMap::new(),
            made: HashMap::new(),
        }
    }

    /// Makes a pipeline for pictures of `samples` unless it is there.
    pub(crate) fn prepare(
        &mut self,
        device: &wgpu::Device,
        pipeline: Pipeline,
        samples: Samples,
    ) -> Result<(), RenderError> {
        if self.made.contains_key(&(pipeline, samples)) {
            return Ok(());
        }
        if pipeline == Pipeline::Id && !device.features().contains(wgpu::Features::PRIMITIVE_INDEX) {
            return Err(RenderError::NoTriangleNumbers);
        }
        let made = guarded(device, "while compiling shaders", || {
            Ok(self.make(device, pipeline, samples))
        })?;
        self.made.insert((pipeline, samples), made);
        Ok(())
    }

    /// A pipeline that was prepared.
    pub(crate) fn get(&self, pipeline: Pipeline, samples: Samples) -> Option<&wgpu::RenderPipeline> {
        self.made.get(&(pipeline, samples))
    }

    fn make(&mut self, device: &wgpu::Device, pipeline: Pipeline, samples: Samples) -> wgpu::RenderPipeline {
        let description = PipelineDescription::of(pipeline);
        let module = self.modules.entry(description.shader).or_insert_with(|| {
            device.create_shader_module(wgpu::ShaderModuleDescriptor {
                label: Some(description.shader.file_name()),
                source: wgpu::ShaderSource::Wgsl(description.shader.composed().into()),
            })
        });
        let (frame, surface) = (&self.frame_layout, &self.surface_layout);
        let groups = match pipeline {
            Pipeline::Matcap | Pipeline::Painted | Pipeline::Zebra | Pipeline::Normals => {
                vec![frame, surface, &self.matcap_layout]
            }
            Pipeline::Material(..) => vec![frame, surface, &self.material_layout, &self.environment_layout],
            Pipeline::Wireframe | Pipeline::Id => vec![frame, surface],
            Pipeline::SurfaceLines(_) => vec![frame, surface, &self.positions_layout],
            // The grid's uniform stands in the surface's place and has its form.
            Pipeline::Grid => vec![frame, surface],
            Pipeline::Background | Pipeline::OverlayTriangles(_) | Pipeline::OverlayLines(_) => vec![frame],
        };
        let groups: Vec<_> = groups.into_iter().map(Some).collect();
        let layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
            label: None,
            bind_group_layouts: &groups,
            immediate_size: 0,
        });
        description.pipeline(device, &layout, module, samples)
    }
}

/// What pipelines differ in.
struct PipelineDescription {
    shader: Shader,
    vertex_entry: &'static str,
    fragment_entry: &'static str,
    buffers: Vec<Option<wgpu::VertexBufferLayout<'static>>>,
    topology: wgpu::PrimitiveTopology,
    depth_compare: wgpu::CompareFunction,
    writes_depth: bool,
    colour: wgpu::ColorTargetState,
}

const OPAQUE: wgpu::ColorTargetState = wgpu::ColorTargetState {
    format: Target::COLOUR_FORMAT,
    blend: None,
    write_mask: wgpu::ColorWrites::ALL,
};

const BLENDED: wgpu::ColorTargetState = wgpu::ColorTargetState {
    blend: Some(wgpu::BlendState::PREMULTIPLIED_ALPHA_BLENDING),
    ..OPAQUE
};

impl PipelineDescription {
    fn of(pipeline: Pipeline) -> Self {
        let solid = |fragment_entry| Self {
            shader: Shader::Surface,
            vertex_entry: "vs_surface",
            fragment_entry,
            buffers: SHAPE_BUFFERS.to_vec(),
            topology: wgpu::PrimitiveTopology::TriangleList,
            depth_compare: wgpu::CompareFunction::Greater,
            writes_depth: true,
            colour: OPAQUE,
        };
        // What lies over or behind surfaces and hides nothing.
        let light = |shader, vertex_entry, fragment_entry| Self {
            shader,
            vertex_entry,
            buffers: Vec::new(),
            depth_compare: wgpu::CompareFunction::GreaterEqual,
            writes_depth: false,
            colour: BLENDED,
            ..solid(fragment_entry)
        };
        let mark = |shader, vertex_entry, buffer, topology, visibility| {
            let (fragment_entry, depth_compare) = match visibility {
                Visibility::Visible => ("fs_visible", wgpu::CompareFunction::GreaterEqual),
                Visibility::Hidden => ("fs_hidden", wgpu::CompareFunction::Less),
            };
            Self {
                buffers: vec![Some(buffer)],
                topology,
                depth_compare,
                ..light(shader, vertex_entry, fragment_entry)
            }
        };
        let (triangles, strip) = (
            wgpu::PrimitiveTopology::TriangleList,
            wgpu::PrimitiveTopology::TriangleStrip,
        );
        match pipeline {
            Pipeline::Matcap => solid("fs_matcap"),
            Pipeline::Painted => solid("fs_painted"),
            Pipeline::Zebra => solid("fs_zebra"),
            Pipeline::Normals => solid("fs_normals"),
            Pipeline::Material(alpha, attributes) => {
                let fragment_entry = match alpha {
                    Alpha::Opaque => "fs_material_opaque",
                    Alpha::Mask => "fs_material_mask",
                    Alpha::Blend => "fs_material_blend",
                };
                let is_glass = alpha == Alpha::Blend;
                Self {
                    shader: Shader::Material,
                    vertex_entry: "vs_material",
                    buffers: material_buffers(attributes).to_vec(),
                    writes_depth: !is_glass,
                    colour: if is_glass { BLENDED } else { OPAQUE },
                    ..solid(fragment_entry)
                }
            }
            Pipeline::Wireframe => Self {
                buffers: SHAPE_BUFFERS[..1].to_vec(),
                topology: wgpu::PrimitiveTopology::LineList,
                ..light(Shader::Wireframe, "vs_wireframe", "fs_wireframe")
            },
            Pipeline::SurfaceLines(visibility) => mark(
                Shader::SurfaceLine,
                "vs_surface_line",
                SURFACE_LINE_BUFFER,
                strip,
                visibility,
            ),
            Pipeline::Background => Self {
                colour: OPAQUE,
                ..light(Shader::Background, "vs_background", "fs_background")
            },
            Pipeline::Grid => Self {
                topology: strip,
                ..light(Shader::Grid, "vs_grid", "fs_grid")
            },
            Pipeline::OverlayTriangles(visibility) => mark(
                Shader::OverlayTriangle,
                "vs_overlay_triangle",
                OVERLAY_TRIANGLE_BUFFER,
                triangles,
                visibility,
            ),
            Pipeline::OverlayLines(visibility) => mark(
                Shader::OverlayLine,
                "vs_overlay_line",
                OVERLAY_LINE_BUFFER,
                strip,
                visibility,
            ),
            Pipeline::Id => Self {
                shader: Shader::SurfaceId,
                vertex_entry: "vs_id",
                buffers: SHAPE_BUFFERS[..1].to_vec(),
                colour: wgpu::ColorTargetState {
                    format: ID_FORMAT,
                    ..OPAQUE
                },
                ..solid("fs_id")
            },
        }
    }

    fn pipeline(
        &self,
        device: &wgpu::Device,
        layout: &wgpu::PipelineLayout,
        module: &wgpu::ShaderModule,
        samples: Samples,
    ) -> wgpu::RenderPipeline {
        device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
            label: Some(self.fragment_entry),
            layout: Some(layout),
            vertex: wgpu::VertexState {
                module,
                entry_point: Some(self.vertex_entry),
                compilation_options: Default::default(),
                buffers: &self.buffers,
            },
            primitive: wgpu::PrimitiveState {
                topology: self.topology,
                front_face: wgpu::FrontFace::Ccw,
                cull_mode: None,
                ..Default::default()
            },
            depth_stencil: Some(wgpu::DepthStencilState {
                format: Target::DEPTH_FORMAT,
                depth_write_enabled: Some(self.writes_depth),
                depth_compare: Some(self.depth_compare),
                stencil: Default::default(),
                bias: Default::default(),
            }),
            multisample: wgpu::MultisampleState {
                count: samples.count(),
                ..Default::default()
            },
            fragment: Some(wgpu::FragmentState {
                module,
                entry_point: Some(self.fragment_entry),
                compilation_options: Default::default(),
                targets: &[Some(self.colour.clone())],
            }),
            multiview_mask: None,
            cache: None,
        })
    }
}

fn layout(device: &wgpu::Device, label: &str, entries: &[wgpu::BindGroupLayoutEntry]) -> wgpu::BindGroupLayout {
    device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
        label: Some(label),
        entries,
    })
}

fn uniform_entry(binding: u32, visibility: wgpu::ShaderStages) -> wgpu::BindGroupLayoutEntry {
    let ty = wgpu::BindingType::Buffer {
        ty: wgpu::BufferBindingType::Uniform,
        has_dynamic_offset: false,
        min_binding_size: None,
    };
    wgpu::BindGroupLayoutEntry {
        binding,
        visibility,
        ty,
        count: None,
    }
}

/// A buffer that vertex shaders look numbers up in.
fn storage_entry(binding: u32) -> wgpu::BindGroupLayoutEntry {
    let ty = wgpu::BindingType::Buffer {
        ty: wgpu::BufferBindingType::Storage { read_only: true },
        has_dynamic_offset: false,
        min_binding_size: None,
    };
    wgpu::BindGroupLayoutEntry {
        binding,
        visibility: wgpu::ShaderStages::VERTEX,
        ty,
        count: None,
    }
}

/// A filterable texture for the fragment stage.
fn texture_entry(binding: u32, view_dimension: wgpu::TextureViewDimension) -> wgpu::BindGroupLayoutEntry {
    let ty = wgpu::BindingType::Texture {
        sample_type: wgpu::TextureSampleType::Float { filterable: true },
        view_dimension,
        multisampled: false,
    };
    wgpu::BindGroupLayoutEntry {
        binding,
        visibility: wgpu::ShaderStages::FRAGMENT,
        ty,
        count: None,
    }
}

/// A filtering sampler for the fragment stage.
fn sampler_entry(binding: u32) -> wgpu::BindGroupLayoutEntry {
    let ty = wgpu::BindingType::Sampler(wgpu::SamplerBindingType::Filtering);
    wgpu::BindGroupLayoutEntry {
        binding,
        visibility: wgpu::ShaderStages::FRAGMENT,
        ty,
        count: None,
    }
}
