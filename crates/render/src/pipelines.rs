//! Layouts and pipelines: made once a device, those that depend on the number of samples when first needed.

use crate::guard::guarded;
use crate::shaders::Shader;
use crate::uniforms::{OverlayLineInstance, OverlayVertex};
use crate::{RenderError, Samples, Target};

/// The format of triangle numbers.
pub(crate) const ID_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::R32Uint;

/// Layouts shared by all pipelines, and the pipelines made so far.
#[derive(Debug)]
pub(crate) struct Pipelines {
    pub(crate) frame_layout: wgpu::BindGroupLayout,
    pub(crate) surface_layout: wgpu::BindGroupLayout,
    pub(crate) material_layout: wgpu::BindGroupLayout,
    picture: [Option<PicturePipelines>; 2],
    id: Option<wgpu::RenderPipeline>,
}

/// The pipelines of a picture with one number of samples.
#[derive(Debug)]
pub(crate) struct PicturePipelines {
    pub(crate) clay: wgpu::RenderPipeline,
    pub(crate) material_opaque: wgpu::RenderPipeline,
    pub(crate) material_mask: wgpu::RenderPipeline,
    pub(crate) material_blend: wgpu::RenderPipeline,
    pub(crate) wireframe: wgpu::RenderPipeline,
    pub(crate) background: wgpu::RenderPipeline,
    pub(crate) overlay_triangles: Softened,
    pub(crate) overlay_lines: Softened,
}

/// Two pipelines of a mark: where it is seen and where a surface hides it.
#[derive(Debug)]
pub(crate) struct Softened {
    pub(crate) visible: wgpu::RenderPipeline,
    pub(crate) hidden: wgpu::RenderPipeline,
}

/// The vertex buffers of a surface: positions, normals, texture coordinates, colours, regions.
pub(crate) const SURFACE_BUFFERS: [Option<wgpu::VertexBufferLayout<'static>>; 5] = {
    const POSITION: [wgpu::VertexAttribute; 1] = wgpu::vertex_attr_array![0 => Float32x3];
    const NORMAL: [wgpu::VertexAttribute; 1] = wgpu::vertex_attr_array![1 => Float32x3];
    const UV: [wgpu::VertexAttribute; 1] = wgpu::vertex_attr_array![2 => Float32x2];
    const COLOUR: [wgpu::VertexAttribute; 1] = wgpu::vertex_attr_array![3 => Unorm8x4];
    const REGION: [wgpu::VertexAttribute; 1] = wgpu::vertex_attr_array![4 => Unorm8x4];
    [
        Some(per_vertex(12, &POSITION)),
        Some(per_vertex(12, &NORMAL)),
        Some(per_vertex(8, &UV)),
        Some(per_vertex(4, &COLOUR)),
        Some(per_vertex(4, &REGION)),
    ]
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
        Self {
            frame_layout: layout(device, "frame", &[uniform_entry(0, both)]),
            surface_layout: layout(device, "surface", &[uniform_entry(0, both)]),
            material_layout: layout(
                device,
                "material",
                &[uniform_entry(0, fragment), texture_entry(1), sampler_entry(2)],
            ),
            picture: [None, None],
            id: None,
        }
    }

    /// The pipelines of pictures of `samples`.
    pub(crate) fn picture(
        &mut self,
        device: &wgpu::Device,
        samples: Samples,
    ) -> Result<&PicturePipelines, RenderError> {
        let slot = match samples {
            Samples::One => 0,
            Samples::Four => 1,
        };
        if self.picture[slot].is_none() {
            let made = guarded(device, "while compiling shaders", || {
                Ok(PicturePipelines::new(device, self, samples))
            })?;
            self.picture[slot] = Some(made);
        }
        self.picture[slot].as_ref().ok_or(RenderError::Lost {
            doing: "compiling shaders",
        })
    }

    /// The pipeline of triangle numbers.
    pub(crate) fn id(&mut self, device: &wgpu::Device) -> Result<&wgpu::RenderPipeline, RenderError> {
        if !device.features().contains(wgpu::Features::PRIMITIVE_INDEX) {
            return Err(RenderError::NoTriangleNumbers);
        }
        if self.id.is_none() {
            let made = guarded(device, "while compiling shaders", || {
                let maker = Maker::new(device, &[&self.frame_layout, &self.surface_layout], Samples::One);
                let shader = maker.module(Shader::SurfaceId);
                let numbers = wgpu::ColorTargetState {
                    format: ID_FORMAT,
                    blend: None,
                    write_mask: wgpu::ColorWrites::ALL,
                };
                Ok(maker.pipeline(&shader, "fs_id", &Primitive::SURFACE, &numbers))
            })?;
            self.id = Some(made);
        }
        self.id.as_ref().ok_or(RenderError::Lost {
            doing: "compiling shaders",
        })
    }
}

impl PicturePipelines {
    fn new(device: &wgpu::Device, shared: &Pipelines, samples: Samples) -> Self {
        let frame = &shared.frame_layout;
        let surface = &shared.surface_layout;
        let opaque = wgpu::ColorTargetState {
            format: Target::COLOUR_FORMAT,
            blend: None,
            write_mask: wgpu::ColorWrites::ALL,
        };
        let blended = wgpu::ColorTargetState {
            blend: Some(wgpu::BlendState::PREMULTIPLIED_ALPHA_BLENDING),
            ..opaque.clone()
        };

        let maker = Maker::new(device, &[frame, surface, &shared.material_layout], samples);
        let shader = maker.module(Shader::Surface);
        let solid = Primitive::SURFACE;
        let glass = Primitive {
            writes_depth: false,
            ..Primitive::SURFACE
        };
        let material_opaque = maker.pipeline(&shader, "fs_material_opaque", &solid, &opaque);
        let material_mask = maker.pipeline(&shader, "fs_material_mask", &solid, &opaque);
        let material_blend = maker.pipeline(&shader, "fs_material_blend", &glass, &blended);

        let maker = Maker::new(device, &[frame, surface], samples);
        let clay = maker.pipeline(&shader, "fs_clay", &solid, &opaque);
        let wireframe = {
            let primitive = Primitive {
                vertex_entry: "vs_wireframe",
                buffers: &SURFACE_BUFFERS[..1],
                topology: wgpu::PrimitiveTopology::LineList,
                depth_compare: wgpu::CompareFunction::GreaterEqual,
                writes_depth: false,
            };
            maker.pipeline(&maker.module(Shader::Wireframe), "fs_wireframe", &primitive, &blended)
        };

        let maker = Maker::new(device, &[frame], samples);
        let background = {
            let primitive = Primitive {
                vertex_entry: "vs_background",
                buffers: &[],
                topology: wgpu::PrimitiveTopology::TriangleList,
                depth_compare: wgpu::CompareFunction::GreaterEqual,
                writes_depth: false,
            };
            maker.pipeline(&maker.module(Shader::Background), "fs_background", &primitive, &opaque)
        };
        Self {
            clay,
            material_opaque,
            material_mask,
            material_blend,
            wireframe,
            background,
            overlay_triangles: maker.softened(
                Shader::OverlayTriangle,
                "vs_overlay_triangle",
                &[Some(OVERLAY_TRIANGLE_BUFFER)],
                wgpu::PrimitiveTopology::TriangleList,
                &blended,
            ),
            overlay_lines: maker.softened(
                Shader::OverlayLine,
                "vs_overlay_line",
                &[Some(OVERLAY_LINE_BUFFER)],
                wgpu::PrimitiveTopology::TriangleStrip,
                &blended,
            ),
        }
    }
}

/// What the vertex half of a pipeline and its depth test differ in.
struct Primitive<'a> {
    vertex_entry: &'a str,
    buffers: &'a [Option<wgpu::VertexBufferLayout<'a>>],
    topology: wgpu::PrimitiveTopology,
    depth_compare: wgpu::CompareFunction,
    writes_depth: bool,
}

impl Primitive<'static> {
    /// Surfaces, seen from both sides, before what is farther away.
    const SURFACE: Self = Self {
        vertex_entry: "vs_surface",
        buffers: &SURFACE_BUFFERS,
        topology: wgpu::PrimitiveTopology::TriangleList,
        depth_compare: wgpu::CompareFunction::Greater,
        writes_depth: true,
    };
}

/// Makes pipelines of one layout and number of samples.
struct Maker<'a> {
    device: &'a wgpu::Device,
    layout: wgpu::PipelineLayout,
    samples: Samples,
}

impl<'a> Maker<'a> {
    fn new(device: &'a wgpu::Device, groups: &[&wgpu::BindGroupLayout], samples: Samples) -> Self {
        let groups: Vec<_> = groups.iter().map(|&group| Some(group)).collect();
        let layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
            label: None,
            bind_group_layouts: &groups,
            immediate_size: 0,
        });
        Self {
            device,
            layout,
            samples,
        }
    }

    fn module(&self, shader: Shader) -> wgpu::ShaderModule {
        self.device.create_shader_module(wgpu::ShaderModuleDescriptor {
            label: Some(shader.file_name()),
            source: wgpu::ShaderSource::Wgsl(shader.composed().into()),
        })
    }

    fn pipeline(
        &self,
        shader: &wgpu::ShaderModule,
        fragment_entry: &str,
        primitive: &Primitive<'_>,
        colour: &wgpu::ColorTargetState,
    ) -> wgpu::RenderPipeline {
        self.device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
            label: Some(fragment_entry),
            layout: Some(&self.layout),
            vertex: wgpu::VertexState {
                module: shader,
                entry_point: Some(primitive.vertex_entry),
                compilation_options: Default::default(),
                buffers: primitive.buffers,
            },
            primitive: wgpu::PrimitiveState {
                topology: primitive.topology,
                front_face: wgpu::FrontFace::Ccw,
                cull_mode: None,
                ..Default::default()
            },
            depth_stencil: Some(wgpu::DepthStencilState {
                format: Target::DEPTH_FORMAT,
                depth_write_enabled: Some(primitive.writes_depth),
                depth_compare: Some(primitive.depth_compare),
                stencil: Default::default(),
                bias: Default::default(),
            }),
            multisample: wgpu::MultisampleState {
                count: self.samples.count(),
                ..Default::default()
            },
            fragment: Some(wgpu::FragmentState {
                module: shader,
                entry_point: Some(fragment_entry),
                compilation_options: Default::default(),
                targets: &[Some(colour.clone())],
            }),
            multiview_mask: None,
            cache: None,
        })
    }

    fn softened(
        &self,
        shader: Shader,
        vertex_entry: &str,
        buffers: &[Option<wgpu::VertexBufferLayout<'_>>],
        topology: wgpu::PrimitiveTopology,
        colour: &wgpu::ColorTargetState,
    ) -> Softened {
        let module = self.module(shader);
        let half = |fragment_entry, depth_compare| {
            let primitive = Primitive {
                vertex_entry,
                buffers,
                topology,
                depth_compare,
                writes_depth: false,
            };
            self.pipeline(&module, fragment_entry, &primitive, colour)
        };
        Softened {
            visible: half("fs_visible", wgpu::CompareFunction::GreaterEqual),
            hidden: half("fs_hidden", wgpu::CompareFunction::Less),
        }
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

/// A filterable two-dimensional texture for the fragment stage.
pub(crate) fn texture_entry(binding: u32) -> wgpu::BindGroupLayoutEntry {
    let ty = wgpu::BindingType::Texture {
        sample_type: wgpu::TextureSampleType::Float { filterable: true },
        view_dimension: wgpu::TextureViewDimension::D2,
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
pub(crate) fn sampler_entry(binding: u32) -> wgpu::BindGroupLayoutEntry {
    let ty = wgpu::BindingType::Sampler(wgpu::SamplerBindingType::Filtering);
    wgpu::BindGroupLayoutEntry {
        binding,
        visibility: wgpu::ShaderStages::FRAGMENT,
        ty,
        count: None,
    }
}
