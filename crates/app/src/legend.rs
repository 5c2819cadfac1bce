//! The legend of a colour scale: a bar with numbers. The window and `pliant render` paint it with the same function.

use eframe::egui::{self, Align2, Color32, FontId, Mesh, Painter, Pos2, Rect, Stroke, StrokeKind, pos2, vec2};
use pliant_render::{Image, RenderError, Renderer};

use crate::drawing::{Scale, colour_at};

/// Width and height in points.
pub const SIZE: egui::Vec2 = vec2(150.0, 222.0);

const BAR: Rect = Rect {
    min: pos2(16.0, 40.0),
    max: pos2(36.0, 204.0),
};

/// Paints the legend of `scale` with its upper left corner at `corner`.
pub fn paint(painter: &Painter, corner: Pos2, scale: &Scale) {
    let moved = |rect: Rect| rect.translate(corner.to_vec2());
    painter.rect_filled(Rect::from_min_size(corner, SIZE), 6.0, Color32::from_black_alpha(140));
    let text = Color32::from_gray(230);
    let title = corner + vec2(14.0, 19.0);
    painter.text(
        title,
        Align2::LEFT_CENTER,
        scale.title,
        FontId::proportional(12.0),
        text,
    );
    let bar = moved(BAR);
    let mut mesh = Mesh::default();
    const STEPS: u32 = 48;
    for step in 0..=STEPS {
        let share = step as f32 / STEPS as f32;
        let [r, g, b, _] = colour_at(f64::from(share));
        let y = bar.bottom() - share * bar.height();
        for x in [bar.left(), bar.right()] {
            mesh.colored_vertex(pos2(x, y), Color32::from_rgb(r, g, b));
        }
        if step > 0 {
            let at = 2 * step;
            mesh.add_triangle(at - 2, at - 1, at);
            mesh.add_triangle(at - 1, at + 1, at);
        }
    }
    painter.add(mesh);
    painter.rect_stroke(
        bar,
        0.0,
        Stroke::new(1.0, Color32::from_black_alpha(160)),
        StrokeKind::Outside,
    );
    for tick in &scale.ticks {
        let y = bar.bottom() - tick.at as f32 * bar.height();
        painter.hline(bar.right()..=bar.right() + 5.0, y, Stroke::new(1.0, text));
        let beside = pos2(bar.right() + 10.0, y);
        painter.text(
            beside,
            Align2::LEFT_CENTER,
            &tick.label,
            FontId::proportional(12.0),
            text,
        );
    }
}

/// The legend as an image with a transparent background, at `pixels_per_point`.
///
/// # Errors
/// Out of memory, or the device does not respond.
pub fn picture(renderer: &Renderer, scale: &Scale, pixels_per_point: f32) -> Result<Image, RenderError> {
    let context = egui::Context::default();
    context.set_pixels_per_point(pixels_per_point);
    let input = || egui::RawInput {
        screen_rect: Some(Rect::from_min_size(Pos2::ZERO, SIZE)),
        ..egui::RawInput::default()
    };
    // The first pass makes egui apply `pixels_per_point`.
    let mut fonts = context.run_ui(input(), |_| {}).textures_delta;
    let output = context.run_ui(input(), |ui| paint(ui.painter(), Pos2::ZERO, scale));
    fonts.append(output.textures_delta);
    let shapes = context.tessellate(output.shapes, output.pixels_per_point);
    let (device, queue) = (renderer.device(), renderer.queue());
    let size_in_pixels = [SIZE.x, SIZE.y].map(|side| (side * pixels_per_point).round().max(1.0) as u32);
    let screen = egui_wgpu::ScreenDescriptor {
        size_in_pixels,
        pixels_per_point,
    };
    let format = wgpu::TextureFormat::Rgba8Unorm;
    let texture = device.create_texture(&wgpu::TextureDescriptor {
        label: Some("legend"),
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
            label: Some("legend"),
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

/// Composites an image with premultiplied alpha over another, `margin_px` from its upper left corner.
pub fn composite(under: &mut Image, over: &Image, margin_px: u32) {
    for y in 0..over.height.min(under.height) {
        for x in 0..over.width.min(under.width) {
            let (to_x, to_y) = (margin_px + x, margin_px + y);
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
