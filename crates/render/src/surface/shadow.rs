//! A surface's soft shadow on the ground: darkest where the surface touches the ground, as under an overcast sky.
//!
//! The surface is drawn once from below, orthographically, into a small picture of its height above the ground; the
//! picture is blurred, and drawn as a square on the ground. So a frame costs one textured square, and the surface is
//! drawn a second time only when the shadow is made again.

use glam::{Mat4, Vec3, Vec4};
use pliant_shaders::Shader;

use crate::device::bindings::bind_group;
use crate::device::guard::guarded;
use crate::pipelines::{OCCLUSION_FORMAT, Pipeline, fullscreen};
use crate::surface::draw_calls::Batching;
use crate::target::cleared_depth;
use crate::uniforms::{FrameUniform, ShadowUniform};
use crate::{Gpu, Grid, RenderError, Samples, Surface, Target, View};

/// The side of the picture, in pixels.
const SIDE_PX: u32 = 192;

/// The square's margin beyond the surface, as a share of the surface's larger half side: room for the blur.
const MARGIN: f32 = 0.3;

/// The height above which the surface casts no shadow, as a share of its size.
const HEIGHT: f32 = 0.6;

/// The resources that draw a shadow: made once a device, on first use.
#[derive(Debug)]
pub(crate) struct ShadowTools {
    blurs: [wgpu::RenderPipeline; 2],
    sampler: wgpu::Sampler,
}

/// The position of the shadow, and the heights of the surface that cast it.
struct Place {
    uniform: ShadowUniform,
    from_below: View,
}

impl ShadowTools {
    fn new(device: &wgpu::Device) -> Self {
        Self {
            blurs: blurs(device),
            sampler: device.create_sampler(&wgpu::SamplerDescriptor {
                label: Some("shadow"),
                mag_filter: wgpu::FilterMode::Linear,
                min_filter: wgpu::FilterMode::Linear,
                ..Default::default()
            }),
        }
    }
}

/// The pipelines that blur across and down.
pub(crate) fn blurs(device: &wgpu::Device) -> [wgpu::RenderPipeline; 2] {
    let module = device.create_shader_module(wgpu::ShaderModuleDescriptor {
        label: Some(Shader::ShadowBlur.file_name()),
        source: wgpu::ShaderSource::Wgsl(Shader::ShadowBlur.composed().into()),
    });
    ["fs_blur_across", "fs_blur_down"]
        .map(|entry| fullscreen::pipeline(device, &module, ["vs_blur", entry], OCCLUSION_FORMAT))
}

impl Surface {
    /// Makes the shadow that [`crate::Shadows::On`] draws: that of the present shape and of the shown triangles, on the
    /// plane of `ground`. It does not change when the surface moves, until it is made again.
    ///
    /// # Errors
    /// As [`crate::Renderer::draw`].
    pub(crate) fn update_shadow(
        &mut self,
        gpu: &mut Gpu,
        tools: &mut Option<ShadowTools>,
        ground: &Grid,
    ) -> Result<(), RenderError> {
        self.shadow = match Place::of(self, ground) {
            Some(place) => Some(drawn(self, gpu, tools, &place)?),
            None => None,
        };
        Ok(())
    }

    /// The bind group of the shadow, if there is one.
    pub(crate) fn shadow(&self) -> Option<&wgpu::BindGroup> {
        self.shadow.as_ref()
    }
}

impl Place {
    /// `None` for a surface without finite positions.
    fn of(surface: &Surface, ground: &Grid) -> Option<Self> {
        let [u, v] = ground.along.map(Vec3::from);
        let up = u.cross(v);
        let base = Vec3::from(ground.middle);
        let along = |axis: Vec3| {
            let ends = surface.bounds.iter().map(|bounds| {
                let (middle, half) = (0.5 * (bounds.min + bounds.max), 0.5 * (bounds.max - bounds.min));
                let (at, reach) = ((middle - base).dot(axis), half.dot(axis.abs()));
                [at - reach, at + reach]
            });
            let finite = ends.filter(|[from, to]| from.is_finite() && to.is_finite());
            finite.reduce(|[from, to], [other_from, other_to]| [from.min(other_from), to.max(other_to)])
        };
        let [[u_from, u_to], [v_from, v_to], [_, top]] = [along(u)?, along(v)?, along(up)?];
        let wide = 0.5 * (u_to - u_from).max(v_to - v_from);
        let height = HEIGHT * top.max(2.0 * wide);
        let half_side = (1.0 + MARGIN) * wide;
        if height <= 0.0 || half_side <= 0.0 || !half_side.is_finite() {
            return None;
        }
        let middle = base + u * (0.5 * (u_from + u_to)) + v * (0.5 * (v_from + v_to));
        // By rows: across, up in the picture, and 1 on the ground to 0 at the height.
        let row = |axis: Vec3, scale: f32, offset: f32| (axis * scale).extend(offset - scale * axis.dot(middle));
        let rows = Mat4::from_cols(
            row(u, half_side.recip(), 0.0),
            row(v, half_side.recip(), 0.0),
            row(up, -height.recip(), 1.0),
            Vec4::W,
        );
        Some(Self {
            uniform: ShadowUniform {
                middle: middle.to_array(),
                half_side,
                along_u: u.to_array(),
                padding: 0.0,
                along_v: v.to_array(),
                padding_to_16: 0.0,
            },
            from_below: View {
                clip_from_world: rows.transpose(),
                view_from_world: Mat4::IDENTITY,
                eye: (-up).extend(0.0),
            },
        })
    }
}

/// The bind group of the shadow's square, with its picture.
fn drawn(
    surface: &Surface,
    gpu: &mut Gpu,
    tools: &mut Option<ShadowTools>,
    place: &Place,
) -> Result<wgpu::BindGroup, RenderError> {
    gpu.pipelines.prepare(&gpu.device, Pipeline::Occlusion, Samples::One)?;
    let gpu = &*gpu;
    let device = &gpu.device;
    let below = FrameUniform {
        clip_from_world: place.from_below.clip_from_world.to_cols_array_2d(),
        ..bytemuck::Zeroable::zeroed()
    };
    let below = gpu.uniform("shadow frame uniform", below)?;
    let below = gpu.uniform_group(&gpu.pipelines.frame_layout, &below)?;
    let square = gpu.uniform("shadow uniform", place.uniform)?;
    guarded(device, "while drawing the shadow", || {
        let tools = tools.get_or_insert_with(|| ShadowTools::new(device));
        let texture = |format| picture(device, format);
        let (occlusion, across, depth) = (
            texture(OCCLUSION_FORMAT),
            texture(OCCLUSION_FORMAT),
            texture(Target::DEPTH_FORMAT),
        );
        let mut encoder = device.create_command_encoder(&Default::default());
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("occlusion"),
            color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                view: &occlusion,
                depth_slice: None,
                resolve_target: None,
                ops: wgpu::Operations {
                    load: wgpu::LoadOp::Clear(wgpu::Color::TRANSPARENT),
                    store: wgpu::StoreOp::Store,
                },
            })],
            depth_stencil_attachment: Some(cleared_depth(&depth)),
            ..Default::default()
        });
        if let Some(pipeline) = gpu.pipelines.get(Pipeline::Occlusion, Samples::One) {
            pass.set_pipeline(pipeline);
        }
        pass.set_bind_group(0, &below, &[]);
        surface.bind(&mut pass);
        let calls = match surface.has_reduced(&place.from_below) {
            true => surface.reduced_draw_calls(),
            false => surface.draw_calls(&place.from_below, Batching::Any),
        };
        for call in calls {
            surface.bind_shape(&mut pass, call.page, call.detail);
            pass.draw_indexed(3 * call.triangles.start..3 * call.triangles.end, 0, 0..1);
        }
        drop(pass);
        for (blur, [from, to]) in tools.blurs.iter().zip([[&occlusion, &across], [&across, &occlusion]]) {
            let layout = blur.get_bind_group_layout(0);
            let from = [wgpu::BindingResource::TextureView(from)];
            let group = bind_group(device, "shadow blur", &layout, &from);
            fullscreen::draw(&mut encoder, blur, &group, to);
        }
        gpu.queue.submit([encoder.finish()]);
        let resources = [
            square.as_entire_binding(),
            wgpu::BindingResource::TextureView(&occlusion),
            wgpu::BindingResource::Sampler(&tools.sampler),
        ];
        let layout = &gpu.pipelines.shadow_layout;
        Ok(bind_group(device, "shadow", layout, &resources))
    })
}

fn picture(device: &wgpu::Device, format: wgpu::TextureFormat) -> wgpu::TextureView {
    let texture = device.create_texture(&wgpu::TextureDescriptor {
        label: Some("shadow"),
        size: wgpu::Extent3d {
            width: SIDE_PX,
            height: SIDE_PX,
            depth_or_array_layers: 1,
        },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format,
        usage: wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::RENDER_ATTACHMENT,
        view_formats: &[],
    });
    texture.create_view(&wgpu::TextureViewDescriptor::default())
}
