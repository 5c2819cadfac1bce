//! The state of each render pipeline.

use pliant_shaders::Shader;

use super::vertex_layouts::{
    OVERLAY_LINE_BUFFER, OVERLAY_TRIANGLE_BUFFER, SHAPE_BUFFERS, SURFACE_LINE_BUFFER, material_buffers,
};
use super::{Alpha, ID_FORMAT, MaterialAttributes, OCCLUSION_FORMAT, Pipeline, Visibility};
use crate::{Samples, Target};

/// The state in which pipelines differ.
pub(super) struct PipelineDescription {
    pub(super) shader: Shader,
    vertex_entry: &'static str,
    pub(super) fragment_entry: &'static str,
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
    pub(super) fn of(pipeline: Pipeline) -> Self {
        let (triangles, strip) = (
            wgpu::PrimitiveTopology::TriangleList,
            wgpu::PrimitiveTopology::TriangleStrip,
        );
        match pipeline {
            Pipeline::Matcap => Self::opaque("fs_matcap"),
            Pipeline::Painted => Self::opaque("fs_painted"),
            Pipeline::Zebra => Self::opaque("fs_zebra"),
            Pipeline::Normals => Self::opaque("fs_normals"),
            Pipeline::Material(alpha, attributes) => Self::of_material(alpha, attributes),
            Pipeline::Wireframe => Self {
                buffers: SHAPE_BUFFERS[..1].to_vec(),
                topology: wgpu::PrimitiveTopology::LineList,
                ..Self::blended(Shader::Wireframe, "vs_wireframe", "fs_wireframe")
            },
            Pipeline::SurfaceLines(visibility) => Self::with_visibility(
                Shader::SurfaceLine,
                "vs_surface_line",
                SURFACE_LINE_BUFFER,
                strip,
                visibility,
            ),
            Pipeline::Background => Self {
                colour: OPAQUE,
                ..Self::blended(Shader::Background, "vs_background", "fs_background")
            },
            Pipeline::Grid => Self {
                topology: strip,
                ..Self::blended(Shader::Grid, "vs_grid", "fs_grid")
            },
            Pipeline::Shadow => Self {
                topology: strip,
                ..Self::blended(Shader::Shadow, "vs_shadow", "fs_shadow")
            },
            Pipeline::Occlusion => Self {
                shader: Shader::ShadowOcclusion,
                vertex_entry: "vs_occlusion",
                buffers: SHAPE_BUFFERS[..1].to_vec(),
                colour: wgpu::ColorTargetState {
                    format: OCCLUSION_FORMAT,
                    ..OPAQUE
                },
                ..Self::opaque("fs_occlusion")
            },
            Pipeline::OverlayTriangles(visibility) => Self::with_visibility(
                Shader::OverlayTriangle,
                "vs_overlay_triangle",
                OVERLAY_TRIANGLE_BUFFER,
                triangles,
                visibility,
            ),
            Pipeline::OverlayLines(visibility) => Self::with_visibility(
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
                ..Self::opaque("fs_id")
            },
        }
    }

    /// Draws the surface, with the fragments nearest to the eye.
    fn opaque(fragment_entry: &'static str) -> Self {
        Self {
            shader: Shader::Surface,
            vertex_entry: "vs_surface",
            fragment_entry,
            buffers: SHAPE_BUFFERS.to_vec(),
            topology: wgpu::PrimitiveTopology::TriangleList,
            depth_compare: wgpu::CompareFunction::Greater,
            writes_depth: true,
            colour: OPAQUE,
        }
    }

    fn of_material(alpha: Alpha, attributes: MaterialAttributes) -> Self {
        let fragment_entry = match alpha {
            Alpha::Opaque => "fs_material_opaque",
            Alpha::Mask => "fs_material_mask",
            Alpha::Blend => "fs_material_blend",
        };
        let is_blended = alpha == Alpha::Blend;
        Self {
            shader: Shader::Material,
            vertex_entry: "vs_material",
            buffers: material_buffers(attributes).to_vec(),
            writes_depth: !is_blended,
            colour: if is_blended { BLENDED } else { OPAQUE },
            ..Self::opaque(fragment_entry)
        }
    }

    /// Draws over or behind surfaces, without writing depth.
    fn blended(shader: Shader, vertex_entry: &'static str, fragment_entry: &'static str) -> Self {
        Self {
            shader,
            vertex_entry,
            buffers: Vec::new(),
            depth_compare: wgpu::CompareFunction::GreaterEqual,
            writes_depth: false,
            colour: BLENDED,
            ..Self::opaque(fragment_entry)
        }
    }

    /// Draws marks that are visible or those that are hidden, which have opposite depth tests and fragment shaders.
    fn with_visibility(
        shader: Shader,
        vertex_entry: &'static str,
        buffer: wgpu::VertexBufferLayout<'static>,
        topology: wgpu::PrimitiveTopology,
        visibility: Visibility,
    ) -> Self {
        let (fragment_entry, depth_compare) = match visibility {
            Visibility::Visible => ("fs_visible", wgpu::CompareFunction::GreaterEqual),
            Visibility::Hidden => ("fs_hidden", wgpu::CompareFunction::Less),
        };
        Self {
            buffers: vec![Some(buffer)],
            topology,
            depth_compare,
            ..Self::blended(shader, vertex_entry, fragment_entry)
        }
    }

    pub(super) fn pipeline(
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
