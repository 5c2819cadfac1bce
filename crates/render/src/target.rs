//! The offscreen texture that a frame is drawn into, with its depth and multisample attachments.

use crate::RenderError;
use crate::device::guard::guarded;

/// Samples per pixel.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum Samples {
    /// One: fast but aliased. For interaction on software devices.
    One,
    /// Four: antialiased.
    #[default]
    Four,
}

impl Samples {
    /// The number of samples.
    pub fn count(self) -> u32 {
        match self {
            Self::One => 1,
            Self::Four => 4,
        }
    }
}

/// The offscreen texture that a frame is drawn into. Empty until its first [`Target::resize`]. Drawing into an empty
/// target does nothing, so a window of size zero needs no special case.
#[derive(Debug, Default)]
pub struct Target {
    attachments: Option<Attachments>,
}

/// The textures of a target that has a size.
#[derive(Debug)]
pub(crate) struct Attachments {
    pub(crate) size_px: [u32; 2],
    pub(crate) samples: Samples,
    pub(crate) colour: wgpu::Texture,
    pub(crate) colour_view: wgpu::TextureView,
    pub(crate) gamma_view: wgpu::TextureView,
    pub(crate) multisampled: Option<wgpu::TextureView>,
    pub(crate) depth: wgpu::TextureView,
}

impl Target {
    /// The colour format: sRGB, so that blending and multisampling are done in linear light.
    pub const COLOUR_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba8UnormSrgb;
    /// The format of [`Target::texture_view`]: the same bytes without conversion, as egui expects.
    pub const VIEW_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba8Unorm;
    /// The depth format (reversed: cleared to 0, nearer is greater).
    pub const DEPTH_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Depth32Float;

    /// An empty target.
    pub fn new() -> Self {
        Self::default()
    }

    /// Resizes the target, in pixels. Does nothing if size and samples are unchanged; a side of zero empties it.
    /// Returns whether the texture was replaced: then its view must be registered and the frame drawn again.
    ///
    /// # Errors
    /// [`RenderError::PictureTooLarge`] beyond the device's limit and [`RenderError::OutOfMemory`]; the target is
    /// then empty.
    pub fn resize(&mut self, device: &wgpu::Device, size_px: [u32; 2], samples: Samples) -> Result<bool, RenderError> {
        if size_px.contains(&0) {
            return Ok(self.attachments.take().is_some());
        }
        if self
            .attachments
            .as_ref()
            .is_some_and(|a| a.size_px == size_px && a.samples == samples)
        {
            return Ok(false);
        }
        self.attachments = None;
        let limit = device.limits().max_texture_dimension_2d;
        if size_px.iter().any(|&side| side > limit) {
            let [width, height] = size_px;
            return Err(RenderError::PictureTooLarge { width, height });
        }
        self.attachments = Some(guarded(device, "while making the view's texture", || {
            Ok(Attachments::new(device, size_px, samples))
        })?);
        Ok(true)
    }

    /// Width and height in pixels; zeros while empty.
    pub fn size_px(&self) -> [u32; 2] {
        self.attachments.as_ref().map_or([0, 0], |a| a.size_px)
    }

    /// The picture as sRGB-encoded bytes (see [`Target::VIEW_FORMAT`]); `None` while empty.
    pub fn texture_view(&self) -> Option<&wgpu::TextureView> {
        self.attachments.as_ref().map(|a| &a.gamma_view)
    }

    pub(crate) fn attachments(&self) -> Option<&Attachments> {
        self.attachments.as_ref()
    }
}

impl Attachments {
    fn new(device: &wgpu::Device, size_px: [u32; 2], samples: Samples) -> Self {
        let texture = |label, format, sample_count, usage, view_formats: &[wgpu::TextureFormat]| {
            device.create_texture(&wgpu::TextureDescriptor {
                label: Some(label),
                size: wgpu::Extent3d {
                    width: size_px[0],
                    height: size_px[1],
                    depth_or_array_layers: 1,
                },
                mip_level_count: 1,
                sample_count,
                dimension: wgpu::TextureDimension::D2,
                format,
                usage,
                view_formats,
            })
        };
        let attachment = wgpu::TextureUsages::RENDER_ATTACHMENT;
        let shown = attachment | wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_SRC;
        let colour = texture("view colour", Target::COLOUR_FORMAT, 1, shown, &[Target::VIEW_FORMAT]);
        let depth = texture("view depth", Target::DEPTH_FORMAT, samples.count(), attachment, &[]);
        let multisampled = (samples.count() > 1).then(|| {
            texture("view samples", Target::COLOUR_FORMAT, samples.count(), attachment, &[])
                .create_view(&wgpu::TextureViewDescriptor::default())
        });
        Self {
            size_px,
            samples,
            colour_view: colour.create_view(&wgpu::TextureViewDescriptor::default()),
            gamma_view: colour.create_view(&wgpu::TextureViewDescriptor {
                format: Some(Target::VIEW_FORMAT),
                usage: Some(wgpu::TextureUsages::TEXTURE_BINDING),
                ..Default::default()
            }),
            colour,
            multisampled,
            depth: depth.create_view(&wgpu::TextureViewDescriptor::default()),
        }
    }
}

/// A depth attachment that is cleared to infinity (0, as depth is reversed) and discarded afterwards.
pub(crate) fn cleared_depth(view: &wgpu::TextureView) -> wgpu::RenderPassDepthStencilAttachment<'_> {
    wgpu::RenderPassDepthStencilAttachment {
        view,
        depth_ops: Some(wgpu::Operations {
            load: wgpu::LoadOp::Clear(0.0),
            store: wgpu::StoreOp::Discard,
        }),
        stencil_ops: None,
    }
}
