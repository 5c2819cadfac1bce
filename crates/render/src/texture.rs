//! Textures of materials, uploaded with mipmaps.

use std::borrow::Cow;

use pliant_shaders::Shader;

use crate::RenderError;
use crate::device::bindings::bind_group;
use crate::device::guard::guarded;
use crate::device::opening::is_software;
use crate::pipelines::fullscreen;

/// An image with four bytes per pixel (straight alpha), rows from the top.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TextureData<'a> {
    /// Width in pixels, at least 1.
    pub width: u32,
    /// Height in pixels, at least 1.
    pub height: u32,
    /// `4 · width · height` bytes.
    pub rgba: &'a [u8],
    /// The encoding of the bytes.
    pub encoding: Encoding,
}

/// The encoding of an image's bytes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum Encoding {
    /// Colours in sRGB.
    #[default]
    Srgb,
    /// Linear data: normals, roughness, occlusion.
    Linear,
}

/// A wrap mode: how a texture continues beyond its edges.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum Wrap {
    /// Repeated.
    #[default]
    Repeat,
    /// Repeated, every other time mirrored.
    Mirror,
    /// Clamped to the edge.
    Clamp,
}

/// Uploads textures and generates their mipmaps.
#[derive(Debug)]
pub(crate) struct TextureUploader {
    device: wgpu::Device,
    queue: wgpu::Queue,
    /// Pipelines for sRGB and for linear textures.
    mipmaps: [wgpu::RenderPipeline; 2],
    mipmap_sampler: wgpu::Sampler,
    anisotropy: u16,
}

/// The formats of sRGB and of linear textures.
const FORMATS: [wgpu::TextureFormat; 2] = [wgpu::TextureFormat::Rgba8UnormSrgb, wgpu::TextureFormat::Rgba8Unorm];

impl TextureUploader {
    pub(crate) fn new(device: &wgpu::Device, queue: &wgpu::Queue) -> Self {
        let module = device.create_shader_module(wgpu::ShaderModuleDescriptor {
            label: Some(Shader::Mipmap.file_name()),
            source: wgpu::ShaderSource::Wgsl(Shader::Mipmap.composed().into()),
        });
        let pipeline = |format| fullscreen::pipeline(device, &module, ["vs_mipmap", "fs_mipmap"], format);
        let mipmap_sampler = device.create_sampler(&wgpu::SamplerDescriptor {
            label: Some("mipmap"),
            mag_filter: wgpu::FilterMode::Linear,
            min_filter: wgpu::FilterMode::Linear,
            ..Default::default()
        });
        Self {
            device: device.clone(),
            queue: queue.clone(),
            mipmaps: FORMATS.map(pipeline),
            mipmap_sampler,
            // Anisotropic filtering is too slow on software devices.
            anisotropy: if is_software(device) { 1 } else { 8 },
        }
    }

    /// Uploads the texture `number` of a surface with all its mipmaps, scaled down to the device's size limit.
    pub(crate) fn texture(&self, number: usize, data: &TextureData<'_>) -> Result<wgpu::TextureView, RenderError> {
        let (width, height) = (data.width, data.height);
        let needed = 4 * width as usize * height as usize;
        if needed == 0 || data.rgba.len() != needed {
            let found = data.rgba.len();
            return Err(RenderError::TextureBytes {
                texture: number,
                width,
                height,
                found,
            });
        }
        let limit = self.device.limits().max_texture_dimension_2d;
        let (width, height, rgba) = scaled_to_fit(data, limit);
        guarded(&self.device, "while uploading textures", || {
            let size = wgpu::Extent3d {
                width,
                height,
                depth_or_array_layers: 1,
            };
            let texture = self.device.create_texture(&wgpu::TextureDescriptor {
                label: Some("material image"),
                size,
                mip_level_count: width.max(height).ilog2() + 1,
                sample_count: 1,
                dimension: wgpu::TextureDimension::D2,
                format: FORMATS[data.encoding as usize],
                usage: wgpu::TextureUsages::TEXTURE_BINDING
                    | wgpu::TextureUsages::COPY_DST
                    | wgpu::TextureUsages::RENDER_ATTACHMENT,
                view_formats: &[],
            });
            let rows = wgpu::TexelCopyBufferLayout {
                offset: 0,
                bytes_per_row: Some(4 * width),
                rows_per_image: Some(height),
            };
            self.queue.write_texture(texture.as_image_copy(), &rgba, rows, size);
            self.make_mipmaps(&texture, &self.mipmaps[data.encoding as usize]);
            Ok(texture.create_view(&wgpu::TextureViewDescriptor::default()))
        })
    }

    /// A sampler with these wrap modes.
    pub(crate) fn sampler(&self, wrap: [Wrap; 2]) -> wgpu::Sampler {
        let mode = |wrap| match wrap {
            Wrap::Repeat => wgpu::AddressMode::Repeat,
            Wrap::Mirror => wgpu::AddressMode::MirrorRepeat,
            Wrap::Clamp => wgpu::AddressMode::ClampToEdge,
        };
        self.device.create_sampler(&wgpu::SamplerDescriptor {
            label: Some("material image"),
            address_mode_u: mode(wrap[0]),
            address_mode_v: mode(wrap[1]),
            mag_filter: wgpu::FilterMode::Linear,
            min_filter: wgpu::FilterMode::Linear,
            mipmap_filter: wgpu::MipmapFilterMode::Linear,
            anisotropy_clamp: self.anisotropy,
            ..Default::default()
        })
    }

    fn make_mipmaps(&self, texture: &wgpu::Texture, pipeline: &wgpu::RenderPipeline) {
        let view_of = |level| {
            texture.create_view(&wgpu::TextureViewDescriptor {
                base_mip_level: level,
                mip_level_count: Some(1),
                ..Default::default()
            })
        };
        let mut encoder = self.device.create_command_encoder(&Default::default());
        let layout = pipeline.get_bind_group_layout(0);
        for level in 1..texture.mip_level_count() {
            let resources = [
                wgpu::BindingResource::TextureView(&view_of(level - 1)),
                wgpu::BindingResource::Sampler(&self.mipmap_sampler),
            ];
            let group = bind_group(&self.device, "mipmap", &layout, &resources);
            fullscreen::draw(&mut encoder, pipeline, &group, &view_of(level));
        }
        self.queue.submit([encoder.finish()]);
    }
}

/// An image halved until neither side exceeds `limit`. Each pixel is the mean of the bytes of the four that it covers;
/// the last row or column of an odd side is dropped. Means of sRGB bytes are slightly dark, which only affects images
/// beyond the device's limit.
fn scaled_to_fit<'a>(data: &TextureData<'a>, limit: u32) -> (u32, u32, Cow<'a, [u8]>) {
    let (mut width, mut height) = (data.width as usize, data.height as usize);
    let mut rgba = Cow::Borrowed(data.rgba);
    while width.max(height) > limit as usize {
        let (half_width, half_height) = ((width / 2).max(1), (height / 2).max(1));
        let mut halved = Vec::with_capacity(4 * half_width * half_height);
        for y in 0..half_height {
            let rows = [2 * y, (2 * y + 1).min(height - 1)];
            for x in 0..half_width {
                let columns = [2 * x, (2 * x + 1).min(width - 1)];
                for channel in 0..4 {
                    let mut sum = 0_u32;
                    for row in rows {
                        for column in columns {
                            sum += u32::from(rgba[4 * (row * width + column) + channel]);
                        }
                    }
                    halved.push(((sum + 2) / 4) as u8);
                }
            }
        }
        (width, height, rgba) = (half_width, half_height, Cow::Owned(halved));
    }
    (width as u32, height as u32, rgba)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_image_beyond_the_limit_is_halved_until_it_fits() {
        let rgba: Vec<u8> = (0..4 * 5 * 2).map(|byte| byte as u8).collect();
        let data = TextureData {
            width: 5,
            height: 2,
            rgba: &rgba,
            encoding: Encoding::Srgb,
        };
        assert_eq!(scaled_to_fit(&data, 5), (5, 2, Cow::Borrowed(&rgba[..])));
        let (width, height, halved) = scaled_to_fit(&data, 4);
        assert_eq!((width, height), (2, 1));
        // The first pixel covers bytes 0, 4, 20 and 24 of red.
        assert_eq!(halved[0], 12);
        let (width, height, pixel) = scaled_to_fit(&data, 1);
        assert_eq!((width, height, pixel.len()), (1, 1, 4));
    }
}
