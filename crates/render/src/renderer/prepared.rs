//! A frame whose buffers and pipelines are prepared on the device.

use crate::frame::overlay::OverlayBatch;
use crate::pipelines::{Pipeline, Visibility};
use crate::surface::draw_calls::DrawCall;
use crate::{Background, Borders, Frame, Matcap, Outlines, Shading, Shadows, Surface, Wireframe};

/// A frame whose buffers and pipelines are prepared on the device.
pub(crate) struct PreparedFrame<'a> {
    pub(crate) frame: &'a Frame<'a>,
    pub(crate) overlays: OverlayBatch,
    /// The draw calls of every surface.
    pub(crate) draw_calls: Vec<(&'a Surface, Vec<DrawCall>)>,
}

impl PreparedFrame<'_> {
    /// The pipelines that recording the frame needs.
    pub(crate) fn pipelines(&self) -> Vec<Pipeline> {
        let style = self.frame.style;
        let mut pipelines = Vec::new();
        if style.shading == Shading::Material {
            for (surface, draw_calls) in &self.draw_calls {
                pipelines.extend(
                    draw_calls
                        .iter()
                        .map(|call| Pipeline::Material(call.alpha, surface.material_attributes())),
                );
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
        if style.shadows == Shadows::On {
            pipelines.push(Pipeline::Shadow);
        }
        if style.wireframe == Wireframe::On {
            pipelines.push(Pipeline::Wireframe);
        }
        for visibility in Visibility::BOTH {
            let has_wires = |(surface, _): &(&Surface, Vec<DrawCall>)| surface.wires().iter().any(Option::is_some);
            if style.borders == Borders::On || style.outlines == Outlines::On || self.draw_calls.iter().any(has_wires) {
                pipelines.push(Pipeline::SurfaceLines(visibility));
            }
            if !self.overlays.vertices.is_empty() {
                pipelines.push(Pipeline::OverlayTriangles(visibility));
            }
            if !self.overlays.lines.is_empty() {
                pipelines.push(Pipeline::OverlayLines(visibility));
            }
        }
        pipelines
    }
}

/// The pipeline of a shading other than the file's materials.
pub(super) fn shading_pipeline(shading: Shading) -> Pipeline {
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
