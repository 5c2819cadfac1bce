//! Pictures that egui paints, without a window: legends, captions.

use egui::{Painter, Pos2, Rect, Vec2};
use pliant_render::{Image, RenderError, Renderer};

/// The picture that `paint` makes in a rectangle of this size in points, with the origin at its upper left corner, as
/// an image with a transparent background at `pixels_per_point`.
///
/// # Errors
/// Out of memory, or the device does not respond.
pub fn picture(
    renderer: &Renderer,
    size: Vec2,
    pixels_per_point: f32,
    paint: impl Fn(&Painter),
) -> Result<Image, RenderError> {
    let context = egui::Context::default();
    context.set_pixels_per_point(pixels_per_point);
    let input = || egui::RawInput {
        screen_rect: Some(Rect::from_min_size(Pos2::ZERO, size)),
        ..egui::RawInput::default()
    };
    // The first pass makes egui apply `pixels_per_point`.
    let mut fonts = context.run_ui(input(), |_| {}).textures_delta;
    let output = context.run_ui(input(), |ui| paint(ui.painter()));
    fonts.append(output.textures_delta);
    let shapes = context.tessellate(output.shapes, output.pixels_per_point);
    let (device, queue) = (renderer.device(), renderer.queue());
    let size_in_pixels = [size.x, size.y].map(|side| (side * pixels_per_point).round().max(1.0) as u32);
    let screen = egui_wgpu::ScreenDescriptor {
        size_in_pixels,
        pixels_per_point,
    };
    let format = wgpu::TextureFormat::Rgba8Unorm;
    let texture = device.create_texture(&wgpu::TextureDescriptor {
        label: Some("painting"),
        size: wgpu::Extent3d {
            width: size_in_pixels[0],
            height: size_in_pixels[1],
            depth_or_array_layers: 1,
        },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format,
        usage: wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::COPY_SRC,
        view_formats: &[],
    });
    let mut egui_renderer = egui_wgpu::Renderer::new(device, format, egui_wgpu::RendererOptions::default());
    for (id, deltas) in &fonts.set {
        for delta in deltas {
            egui_renderer.update_texture(device, queue, *id, delta);
        }
    }
    fonts.clear();
    let mut encoder = device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
    let before = egui_renderer.update_buffers(device, queue, &mut encoder, &shapes, &screen);
    let view = texture.create_view(&wgpu::TextureViewDescriptor::default());
    let mut pass = encoder
        .begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("painting"),
            color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                view: &view,
                depth_slice: None,
                resolve_target: None,
                ops: wgpu::Operations {
                    load: wgpu::LoadOp::Clear(wgpu::Color::TRANSPARENT),
                    store: wgpu::StoreOp::Store,
                },
            })],
            ..Default::default()
        })
        .forget_lifetime();
    egui_renderer.render(&mut pass, &shapes, &screen);
    drop(pass);
    queue.submit(before.into_iter().chain([encoder.finish()]));
    renderer.read_texture(&texture)
}

/// Composites an image with premultiplied alpha over another, whose pixel `corner_px` becomes its upper left corner.
pub fn composite(under: &mut Image, over: &Image, corner_px: [u32; 2]) {
    for y in 0..over.height.min(under.height) {
        for x in 0..over.width.min(under.width) {
            let (to_x, to_y) = (corner_px[0] + x, corner_px[1] + y);
            if to_x >= under.width || to_y >= under.height {
                continue;
            }
            let from = 4 * (y as usize * over.width as usize + x as usize);
            let to = 4 * (to_y as usize * under.width as usize + to_x as usize);
            let left = 255 - u32::from(over.rgba[from + 3]);
            for channel in 0..4 {
                let below = u32::from(under.rgba[to + channel]);
                let sum = u32::from(over.rgba[from + channel]) + (below * left + 127) / 255;
                under.rgba[to + channel] = sum.min(255) as u8;
            }
        }
    }
}
