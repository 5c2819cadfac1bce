//! A frame as GPU commands: draw calls, their order and their pipelines.

use super::prepared::{PreparedFrame, matcap_of, shading_pipeline};
use super::resources::Resources;
use crate::frame::overlay::OverlayBatch;
use crate::pipelines::{Alpha, Pipeline, Pipelines, Visibility};
use crate::surface::draw_calls::DrawCall;
use crate::surface::lines::LineSet;
use crate::target::{Attachments, cleared_depth};
use crate::{Background, Borders, Outlines, Samples, Shading, Shadows, Style, Surface, Wireframe};

/// Records prepared frames.
pub(super) struct Recorder<'a> {
    pub(super) pipelines: &'a Pipelines,
    pub(super) resources: &'a Resources,
}

impl Recorder<'_> {
    /// Records opaque triangles, the background, the ground, shadows, transparent triangles, lines on surfaces, and
    /// overlays, in that order.
    pub(crate) fn record(&self, pass: &mut wgpu::RenderPass<'_>, prepared: &PreparedFrame<'_>, samples: Samples) {
        let style = prepared.frame.style;
        let set = |pass: &mut wgpu::RenderPass<'_>, pipeline| self.set_pipeline(pass, pipeline, samples);
        pass.set_bind_group(0, &self.resources.frame_group, &[]);
        let is_material = style.shading == Shading::Material;
        let draw_surfaces = |pass: &mut wgpu::RenderPass<'_>, is_wanted: &dyn Fn(&DrawCall) -> bool| {
            for (surface, draw_calls) in &prepared.draw_calls {
                surface.bind(pass);
                let mut page = usize::MAX;
                for call in draw_calls.iter().filter(|call| is_wanted(call)) {
                    if call.page != page {
                        page = call.page;
                        surface.bind_shape(pass, page, call.detail);
                        surface.bind_material_attributes(pass, page);
                    }
                    if is_material {
                        set(pass, Pipeline::Material(call.alpha, surface.material_attributes()));
                        pass.set_bind_group(2, surface.material(call.material), &[]);
                    }
                    pass.draw_indexed(3 * call.triangles.start..3 * call.triangles.end, 0, 0..1);
                }
            }
        };
        if is_material {
            pass.set_bind_group(3, self.resources.environment.as_ref(), &[]);
            draw_surfaces(pass, &|call| call.alpha != Alpha::Blend);
        } else {
            set(pass, shading_pipeline(style.shading));
            pass.set_bind_group(2, self.resources.matcaps.get(&matcap_of(style.shading)), &[]);
            draw_surfaces(pass, &|_| true);
        }
        if matches!(style.background, Background::Gradient { .. }) {
            set(pass, Pipeline::Background);
            pass.draw(0..3, 0..1);
        }
        if prepared.frame.grid.is_some() {
            set(pass, Pipeline::Grid);
            pass.set_bind_group(1, &self.resources.grid_group, &[]);
            pass.draw(0..4, 0..1);
        }
        if style.shadows == Shadows::On {
            for shadow in prepared.frame.surfaces.iter().filter_map(|surface| surface.shadow()) {
                set(pass, Pipeline::Shadow);
                pass.set_bind_group(1, shadow, &[]);
                pass.draw(0..4, 0..1);
            }
        }
        if is_material {
            draw_surfaces(pass, &|call| call.alpha == Alpha::Blend);
        }
        for (surface, _) in &prepared.draw_calls {
            self.record_lines(pass, surface, style, samples);
        }
        self.record_overlays(pass, &prepared.overlays, samples);
    }

    /// Records a surface's edges, wires, outlines and borders.
    fn record_lines(&self, pass: &mut wgpu::RenderPass<'_>, surface: &Surface, style: &Style, samples: Samples) {
        surface.bind(pass);
        if style.wireframe == Wireframe::On {
            self.set_pipeline(pass, Pipeline::Wireframe, samples);
            for page in surface.pages() {
                let Some(edges) = page.edges() else { continue };
                pass.set_vertex_buffer(0, page.positions.slice(..));
                pass.set_index_buffer(edges.buffer.slice(..), wgpu::IndexFormat::Uint32);
                pass.draw_indexed(0..edges.index_count, 0, 0..1);
            }
        }
        let draw_lines = |pass: &mut wgpu::RenderPass<'_>, lines: &LineSet, visibility| {
            self.set_pipeline(pass, Pipeline::SurfaceLines(visibility), samples);
            pass.set_bind_group(2, &lines.positions, &[]);
            pass.set_vertex_buffer(0, lines.lines.slice(..));
            pass.draw(0..4, 0..lines.count);
        };
        for lines in surface.wires().iter().flatten() {
            draw_lines(pass, lines, Visibility::Visible);
        }
        if style.outlines == Outlines::On {
            for lines in surface.outlines().iter().flatten() {
                draw_lines(pass, lines, Visibility::Visible);
            }
        }
        if style.borders == Borders::On {
            for lines in surface.borders().iter().flatten() {
                for visibility in Visibility::BOTH {
                    draw_lines(pass, lines, visibility);
                }
            }
        }
    }

    fn record_overlays(&self, pass: &mut wgpu::RenderPass<'_>, overlays: &OverlayBatch, samples: Samples) {
        for layer in &overlays.layers {
            if let (Some(buffer), false) = (self.resources.overlay_triangles.buffer(), layer.vertices.is_empty()) {
                pass.set_vertex_buffer(0, buffer.slice(..));
                for visibility in Visibility::BOTH {
                    self.set_pipeline(pass, Pipeline::OverlayTriangles(visibility), samples);
                    pass.draw(layer.vertices.clone(), 0..1);
                }
            }
            if let (Some(buffer), false) = (self.resources.overlay_lines.buffer(), layer.lines.is_empty()) {
                pass.set_vertex_buffer(0, buffer.slice(..));
                for visibility in Visibility::BOTH {
                    self.set_pipeline(pass, Pipeline::OverlayLines(visibility), samples);
                    pass.draw(0..4, layer.lines.clone());
                }
            }
        }
    }

    fn set_pipeline(&self, pass: &mut wgpu::RenderPass<'_>, pipeline: Pipeline, samples: Samples) {
        match self.pipelines.get(pipeline, samples) {
            Some(pipeline) => pass.set_pipeline(pipeline),
            None => debug_assert!(false, "{pipeline:?} was not prepared"),
        }
    }
}

/// Begins the render pass of a frame on cleared attachments.
pub(crate) fn begin_picture<'a>(
    encoder: &'a mut wgpu::CommandEncoder,
    attachments: &Attachments,
    timestamp_writes: Option<wgpu::RenderPassTimestampWrites<'_>>,
) -> wgpu::RenderPass<'a> {
    let single = &attachments.colour_view;
    let (view, resolve_target, store) = match &attachments.multisampled {
        Some(samples) => (samples, Some(single), wgpu::StoreOp::Discard),
        None => (single, None, wgpu::StoreOp::Store),
    };
    encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
        label: Some("picture"),
        color_attachments: &[Some(wgpu::RenderPassColorAttachment {
            view,
            depth_slice: None,
            resolve_target,
            ops: wgpu::Operations {
                load: wgpu::LoadOp::Clear(wgpu::Color::TRANSPARENT),
                store,
            },
        })],
        depth_stencil_attachment: Some(cleared_depth(&attachments.depth)),
        timestamp_writes,
        ..Default::default()
    })
}
