//! Picking: the frame's surfaces are drawn into an id buffer, with triangle ids in place of colours.
//!
//! For a single point, a ray against a bounding volume hierarchy on the CPU is faster. This answers for rectangles (a
//! lasso selects only what is *visible*), and agrees exactly with the picture because both share their vertex shader.

use std::sync::Arc;

use crate::device::guard::guarded;
use crate::device::readback::Readback;
use crate::pipelines::{ID_FORMAT, Pipeline};
use crate::renderer::WHOLE_BACKGROUND;
use crate::surface::draw_calls::Batching;
use crate::target::cleared_depth;
use crate::{Chunks, Frame, Gpu, RenderError, Renderer, Samples, Target};

/// The id buffer. [`Renderer::pick`] resizes it as needed; keep it between picks.
#[derive(Debug, Default)]
pub struct IdTarget {
    attachments: Option<IdAttachments>,
}

#[derive(Debug)]
struct IdAttachments {
    size_px: [u32; 2],
    ids: wgpu::Texture,
    ids_view: wgpu::TextureView,
    depth: wgpu::TextureView,
}

/// A rectangle of pixels, from the upper left corner of the picture.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct PixelRect {
    /// Left edge, in pixels.
    pub x: u32,
    /// Top edge, in pixels.
    pub y: u32,
    /// Width in pixels.
    pub width: u32,
    /// Height in pixels.
    pub height: u32,
}

/// The triangle that is visible in a pixel.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct Picked {
    /// Index of the surface in the frame.
    pub surface: u32,
    /// Index of the triangle in the surface.
    pub triangle: u32,
}

/// The result of a pick: one entry per pixel, rows from the top.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct PickedIds {
    /// The rectangle, clipped to the picture.
    pub rect: PixelRect,
    /// `width · height` entries; `None` where no surface is visible.
    pub ids: Vec<Option<Picked>>,
}

/// A pick whose result is being read back.
#[derive(Debug)]
pub struct PickRequest {
    rect: PixelRect,
    /// For each surface, one past its last id. Ids start at 1; 0 means no triangle.
    ends: Vec<u32>,
    /// For each surface, its draw order.
    chunks: Vec<Arc<Chunks>>,
    /// `None` if the rectangle is empty.
    readback: Option<Readback>,
}

impl IdTarget {
    /// An empty target.
    pub fn new() -> Self {
        Self::default()
    }

    fn resize(&mut self, device: &wgpu::Device, size_px: [u32; 2]) -> &IdAttachments {
        let kept = self
            .attachments
            .take()
            .filter(|attachments| attachments.size_px == size_px);
        self.attachments
            .insert(kept.unwrap_or_else(|| IdAttachments::new(device, size_px)))
    }
}

impl IdAttachments {
    fn new(device: &wgpu::Device, size_px: [u32; 2]) -> Self {
        let texture = |label, format, usage| {
            device.create_texture(&wgpu::TextureDescriptor {
                label: Some(label),
                size: wgpu::Extent3d {
                    width: size_px[0],
                    height: size_px[1],
                    depth_or_array_layers: 1,
                },
                mip_level_count: 1,
                sample_count: 1,
                dimension: wgpu::TextureDimension::D2,
                format,
                usage,
                view_formats: &[],
            })
        };
        let attachment = wgpu::TextureUsages::RENDER_ATTACHMENT;
        let ids = texture(
            "triangle numbers",
            ID_FORMAT,
            attachment | wgpu::TextureUsages::COPY_SRC,
        );
        let depth = texture("triangle depth", Target::DEPTH_FORMAT, attachment);
        Self {
            size_px,
            ids_view: ids.create_view(&wgpu::TextureViewDescriptor::default()),
            ids,
            depth: depth.create_view(&wgpu::TextureViewDescriptor::default()),
        }
    }
}

impl PixelRect {
    /// A whole picture of this width and height.
    pub const fn whole([width, height]: [u32; 2]) -> Self {
        Self {
            x: 0,
            y: 0,
            width,
            height,
        }
    }

    /// A single pixel.
    pub fn pixel(x: u32, y: u32) -> Self {
        Self {
            x,
            y,
            width: 1,
            height: 1,
        }
    }

    /// The rectangle clipped to a picture of `size_px`.
    fn clipped_to(self, size_px: [u32; 2]) -> Self {
        let (x, y) = (self.x.min(size_px[0]), self.y.min(size_px[1]));
        Self {
            x,
            y,
            width: self.width.min(size_px[0] - x),
            height: self.height.min(size_px[1] - y),
        }
    }
}

impl Renderer {
    /// Starts finding the triangles that a frame of `size_px` shows in `rect` (clipped to the picture), without
    /// waiting. Overlays and alpha masks are ignored.
    ///
    /// # Errors
    /// [`RenderError::NoTriangleNumbers`] on a device without the primitive index, [`RenderError::PictureTooLarge`],
    /// and as [`Renderer::draw`].
    pub fn pick(
        &mut self,
        target: &mut IdTarget,
        size_px: [u32; 2],
        rect: PixelRect,
        frame: &Frame<'_>,
    ) -> Result<PickRequest, RenderError> {
        let rect = rect.clipped_to(size_px);
        let (mut bases, mut ends) = (Vec::new(), Vec::new());
        let chunks: Vec<_> = frame.surfaces.iter().map(|surface| surface.chunks()).collect();
        let mut next = 1_u32;
        for surface in frame.surfaces {
            bases.push(next);
            next = next.saturating_add(surface.triangle_count() as u32);
            ends.push(next);
        }
        if rect.width == 0 || rect.height == 0 {
            return Ok(PickRequest {
                rect,
                ends,
                chunks,
                readback: None,
            });
        }
        let limit = self.gpu.device.limits().max_texture_dimension_2d;
        if size_px.iter().any(|&side| side > limit) {
            let [width, height] = size_px;
            return Err(RenderError::PictureTooLarge { width, height });
        }
        self.resources
            .write_frame(&self.gpu, frame, size_px, WHOLE_BACKGROUND)?;
        self.gpu
            .pipelines
            .prepare(&self.gpu.device, Pipeline::Id, Samples::One)?;
        let Gpu {
            device,
            queue,
            pipelines,
            ..
        } = &self.gpu;
        let readback = guarded(device, "while picking", || {
            for (surface, &base) in frame.surfaces.iter().zip(&bases) {
                surface.set_id_base(queue, base);
            }
            let attachments = target.resize(device, size_px);
            let mut encoder = device.create_command_encoder(&Default::default());
            let mut pass = begin_ids(&mut encoder, attachments);
            pass.set_scissor_rect(rect.x, rect.y, rect.width, rect.height);
            if let Some(pipeline) = pipelines.get(Pipeline::Id, Samples::One) {
                pass.set_pipeline(pipeline);
            }
            pass.set_bind_group(0, &self.resources.frame_group, &[]);
            for surface in frame.surfaces {
                surface.bind(&mut pass);
                for call in surface.draw_calls(frame.view, Batching::Any) {
                    surface.bind_shape(&mut pass, call.page, call.detail);
                    let first = call.first_triangle;
                    pass.draw_indexed(3 * call.triangles.start..3 * call.triangles.end, 0, first..first + 1);
                }
            }
            drop(pass);
            let origin = [rect.x, rect.y];
            Ok(Readback::submit(
                device,
                queue,
                encoder,
                &attachments.ids,
                origin,
                [rect.width, rect.height],
            ))
        })?;
        Ok(PickRequest {
            rect,
            ends,
            chunks,
            readback: Some(readback),
        })
    }
}

fn begin_ids<'a>(encoder: &'a mut wgpu::CommandEncoder, attachments: &IdAttachments) -> wgpu::RenderPass<'a> {
    encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
        label: Some("triangle numbers"),
        color_attachments: &[Some(wgpu::RenderPassColorAttachment {
            view: &attachments.ids_view,
            depth_slice: None,
            resolve_target: None,
            ops: wgpu::Operations {
                load: wgpu::LoadOp::Clear(wgpu::Color::TRANSPARENT),
                store: wgpu::StoreOp::Store,
            },
        })],
        depth_stencil_attachment: Some(cleared_depth(&attachments.depth)),
        ..Default::default()
    })
}

impl PickRequest {
    /// The result if it has arrived; does not wait. Returns it only once.
    pub fn poll(&mut self, renderer: &Renderer) -> Option<Result<PickedIds, RenderError>> {
        let bytes = match &self.readback {
            Some(readback) => readback.poll(renderer.device())?,
            None => Ok(Vec::new()),
        };
        Some(bytes.map(|bytes| self.decoded(&bytes)))
    }

    /// Waits for the result.
    ///
    /// # Errors
    /// [`RenderError::Lost`] if the device does not respond.
    pub fn wait(self, renderer: &Renderer) -> Result<PickedIds, RenderError> {
        let bytes = match &self.readback {
            Some(readback) => readback.wait(renderer.device())?,
            None => Vec::new(),
        };
        Ok(self.decoded(&bytes))
    }

    fn decoded(&self, bytes: &[u8]) -> PickedIds {
        let ids = bytes
            .chunks_exact(4)
            .map(|pixel| {
                let id = u32::from_le_bytes([pixel[0], pixel[1], pixel[2], pixel[3]]);
                let surface = self.ends.partition_point(|&end| end <= id);
                let first = if surface == 0 { 1 } else { self.ends[surface - 1] };
                (id > 0 && surface < self.ends.len()).then(|| Picked {
                    surface: surface as u32,
                    triangle: self
                        .chunks
                        .get(surface)
                        .map_or(id - first, |chunks| chunks.triangle_at(id - first)),
                })
            })
            .collect();
        PickedIds { rect: self.rect, ids }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ids_are_decoded_per_surface_and_zero_is_none() {
        let rect = PixelRect {
            x: 0,
            y: 0,
            width: 6,
            height: 1,
        };
        // Three triangles, none, two.
        let request = PickRequest {
            rect,
            ends: vec![4, 4, 6],
            chunks: Vec::new(),
            readback: None,
        };
        let bytes: Vec<u8> = [0_u32, 1, 3, 4, 5, 6].iter().flat_map(|id| id.to_le_bytes()).collect();
        let picked = |surface, triangle| Some(Picked { surface, triangle });
        let expected = [None, picked(0, 0), picked(0, 2), picked(2, 0), picked(2, 1), None];
        assert_eq!(request.decoded(&bytes).ids, expected);
    }

    #[test]
    fn a_rectangle_is_clipped_to_the_picture() {
        let cut = |x, y, width, height| PixelRect { x, y, width, height }.clipped_to([10, 8]);
        assert_eq!(
            cut(2, 3, 4, 4),
            PixelRect {
                x: 2,
                y: 3,
                width: 4,
                height: 4
            }
        );
        assert_eq!(
            cut(8, 6, u32::MAX, 9),
            PixelRect {
                x: 8,
                y: 6,
                width: 2,
                height: 2
            }
        );
        assert_eq!(
            cut(99, 99, 4, 4),
            PixelRect {
                x: 10,
                y: 8,
                width: 0,
                height: 0
            }
        );
    }
}
