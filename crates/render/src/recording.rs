//! A frame as commands: what is drawn in which order, and by which pipelines.

use crate::overlay::OverlayBatch;
use crate::pipelines::{Alpha, Part, Pipeline};
use crate::runs::Run;
use crate::surface_line::LineSet;
use crate::target::{Attachments, fresh_depth};
use crate::{Background, Borders, Frame, Matcap, Outlines, Renderer, Samples, Shading, Surface, Wireframe};

/// What a picture is drawn from, ready on the device.
pub(crate) struct Ready<'a> {
    pub(crate) frame: &'a Frame<'a>,
    pub(crate) overlays: OverlayBatch,
    /// Runs of every surface.
    pub(crate) runs: Vec<(&'a Surface, Vec<Run>)>,
}

impl Renderer {
    /// Opaque triangles, then the background where nothing is, the ground, what is seen through, edges and marks.
    pub(crate) fn record(&self, pass: &mut wgpu::RenderPass<'_>, ready: &Ready<'_>, samples: Samples) {
        let style = ready.frame.style;
        let set = |pass: &mut wgpu::RenderPass<'_>, pipeline| match self.pipelines.get(pipeline, samples) {
            Some(pipeline) => pass.set_pipeline(pipeline),
            None => debug_assert!(false, "{pipeline:?} was not prepared"),
        };
        pass.set_bind_group(0, &self.frame_group, &[]);
        let is_material = style.shading == Shading::Material;
        let draw_runs = |pass: &mut wgpu::RenderPass<'_>, is_wanted: &dyn Fn(&Run) -> bool| {
            for (surface, runs) in &ready.runs {
                surface.bind(pass);
                let mut page = usize::MAX;
                for run in runs.iter().filter(|run| is_wanted(run)) {
                    if run.page != page {
                        page = run.page;
                        surface.bind_shape(pass, page, run.detail);
                        surface.bind_look(pass, page);
                    }
                    if is_material {
                        set(pass, Pipeline::Material(run.alpha, surface.look()));
                        pass.set_bind_group(2, surface.material(run.material), &[]);
                    }
                    pass.draw_indexed(3 * run.triangles.start..3 * run.triangles.end, 0, 0..1);
                }
            }
        };
        if is_material {
            pass.set_bind_group(3, self.environment.as_ref(), &[]);
            draw_runs(pass, &|run| run.alpha != Alpha::Blend);
        } else {
            set(pass, shading_pipeline(style.shading));
            pass.set_bind_group(2, self.matcaps.get(&matcap_of(style.shading)), &[]);
            draw_runs(pass, &|_| true);
        }
        if matches!(style.background, Background::Gradient { .. }) {
            set(pass, Pipeline::Background);
            pass.draw(0..3, 0..1);
        }
        if ready.frame.grid.is_some() {
            set(pass, Pipeline::Grid);
            pass.set_bind_group(1, &self.grid_group, &[]);
            pass.draw(0..4, 0..1);
        }
        if is_material {
            draw_runs(pass, &|run| run.alpha == Alpha::Blend);
        }
        for (surface, _) in &ready.runs {
            surface.bind(pass);
            if style.wireframe == Wireframe::On {
                set(pass, Pipeline::Wireframe);
                for page in surface.pages() {
                    let Some(edges) = page.edges() else { continue };
                    pass.set_vertex_buffer(0, page.positions.slice(..));
                    pass.set_index_buffer(edges.buffer.slice(..), wgpu::IndexFormat::Uint32);
                    pass.draw_indexed(0..edges.index_count, 0, 0..1);
                }
            }
            let draw_lines = |pass: &mut wgpu::RenderPass<'_>, lines: &LineSet, part| {
                set(pass, Pipeline::SurfaceLines(part));
                pass.set_bind_group(2, &lines.positions, &[]);
                pass.set_vertex_buffer(0, lines.lines.slice(..));
                pass.draw(0..4, 0..lines.count);
            };
            if style.outlines == Outlines::On {
                let outlines = surface.outlines().iter().flatten();
                outlines.for_each(|lines| draw_lines(pass, lines, Part::Visible));
            }
            if style.borders == Borders::On {
                for lines in surface.borders().iter().flatten() {
                    Part::BOTH.into_iter().for_each(|part| draw_lines(pass, lines, part));
                }
            }
        }
        for layer in &ready.overlays.layers {
            if let (Some(buffer), false) = (self.overlay_triangles.buffer(), layer.vertices.is_empty()) {
                pass.set_vertex_buffer(0, buffer.slice(..));
                for part in Part::BOTH {
                    set(pass, Pipeline::OverlayTriangles(part));
                    pass.draw(layer.vertices.clone(), 0..1);
                }
            }
            if let (Some(buffer), false) = (self.overlay_lines.buffer(), layer.lines.is_empty()) {
                pass.set_vertex_buffer(0, buffer.slice(..));
                for part in Part::BOTH {
                    set(pass, Pipeline::OverlayLines(part));
                    pass.draw(0..4, layer.lines.clone());
                }
            }
        }
    }
}

impl Ready<'_> {
    /// The pipelines that the drawing sets.
    pub(crate) fn pipelines(&self) -> Vec<Pipeline> {
        let style = self.frame.style;
        let mut pipelines = Vec::new();
        if style.shading == Shading::Material {
            for (surface, runs) in &self.runs {
                pipelines.extend(runs.iter().map(|run| Pipeline::Material(run.alpha, surface.look())));
            }
            pipelines.dedup();
        } else {
            pipelines.push(shading_pipeline(style.shading));
        }
        if matches!(style.background, Background::Gradient { .. }) {
            pipelines.push(Pipeline::Background);
        }
        if self.frame.grid.is_some() {
            pipelines.push(Pipeline::Grid);
        }
        if style.wireframe == Wireframe::On {
            pipelines.push(Pipeline::Wireframe);
        }
        for part in Part::BOTH {
            if style.borders == Borders::On || style.outlines == Outlines::On {
                pipelines.push(Pipeline::SurfaceLines(part));
            }
            if !self.overlays.vertices.is_empty() {
                pipelines.push(Pipeline::OverlayTriangles(part));
            }
            if !self.overlays.lines.is_empty() {
                pipelines.push(Pipeline::OverlayLines(part));
            }
        }
        pipelines
    }
}

/// The pipeline of every shading but the file's materials.
fn shading_pipeline(shading: Shading) -> Pipeline {
    match shading {
        Shading::Matcap(_) | Shading::Material => Pipeline::Matcap,
        Shading::Painted => Pipeline::Painted,
        Shading::Zebra => Pipeline::Zebra,
        Shading::Normals => Pipeline::Normals,
    }
}

/// The matcap that lights a shading.
pub(crate) fn matcap_of(shading: Shading) -> Matcap {
    match shading {
        Shading::Matcap(matcap) => matcap,
        _ => Matcap::Plaster,
    }
}

/// Begins to draw into a target, from nothing.
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
        depth_stencil_attachment: Some(fresh_depth(&attachments.depth)),
        timestamp_writes,
        ..Default::default()
    })
}
