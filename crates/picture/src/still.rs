//! A picture of a file, at rest or with an edit applied, as the window shows it; or several around it.

use std::f64::consts::TAU;
use std::sync::Arc;

use glam::DVec2;
use pliant_editor::{Before, Look, Skins, UpAxis};
use pliant_engine::EngineError;
use pliant_engine::watch::Watch;
use pliant_render::{Background, Frame, Headless, Image, Samples};

use crate::camera::camera;
use crate::drawing::{self, Drawing};
use crate::options::{PictureSize, Shading, StillOptions};
use crate::subject::Subject;
use crate::uploaded::{Uploaded, refuse, upload};
use crate::{legend, painting};

/// Draws the pictures and hands each to `take`, whose colours are premultiplied by alpha. The result describes the
/// parts of the file that they don't show, a sentence each.
///
/// # Errors
/// No graphics driver, or its refusal; an error of `take`; [`EngineError::Interrupted`].
pub fn draw(
    subject: &Subject<'_>,
    options: &StillOptions,
    watch: &Watch,
    mut take: impl FnMut(Image) -> Result<(), EngineError>,
) -> Result<Vec<String>, EngineError> {
    let Subject {
        loaded,
        shape,
        inside_out,
    } = subject;
    let model = &loaded.model;
    let Some(bounds) = model.bounds() else {
        return Err(EngineError::Empty(loaded.path.clone()));
    };
    let progress = watch.begin("drawing");
    let drawing = Drawing::new(model, loaded.scene.appearance(), Arc::new((*inside_out).clone()));
    let pose = drawing.pose(model, &shape.displacements);
    progress.set(0.2);

    let mut renderer = Headless::new().map_err(refuse)?.renderer;
    let look = look(options);
    let Uploaded {
        mut surface,
        scale,
        notes,
    } = upload(&renderer, &drawing, &pose, model, shape, &look, &watch.cancel)?;
    progress.set(0.3);

    let PictureSize { width, height } = options.size;
    let size_px = DVec2::new(f64::from(width), f64::from(height));
    let camera = camera(options, model, size_px);
    // Marks are as large as on a screen of the usual size, and smaller in a small picture.
    let pixels_per_point = (height as f32 / 620.0).clamp(0.7, 8.0);
    let mut style = drawing::style(&look, pixels_per_point);
    if options.transparent {
        style.background = Background::Transparent;
    }
    let legend = match &scale {
        Some(scale) => Some(legend::picture(&renderer, scale, pixels_per_point).map_err(refuse)?),
        None => None,
    };
    let low = match camera.up {
        UpAxis::Y => bounds.min.y,
        UpAxis::Z => bounds.min.z,
    };
    if look.shadow {
        let ground = drawing::ground(&camera, size_px, low, drawing.centre());
        renderer.update_shadow(&mut surface, &ground).map_err(refuse)?;
    }
    let count = options.turntable.unwrap_or(1);
    for number in 0..count {
        if watch.cancel.is_cancelled() {
            return Err(EngineError::Interrupted);
        }
        let mut turned = camera;
        turned.yaw_rad += TAU * f64::from(number) / f64::from(count);
        let ground = look
            .grid
            .then(|| drawing::ground(&turned, size_px, low, drawing.centre()));
        let frame = Frame {
            view: &drawing::view(&turned, size_px, drawing.centre()),
            style: &style,
            surfaces: &[&surface],
            grid: ground.as_ref(),
            overlays: &[],
        };
        let mut image = renderer
            .draw_to_image([width, height], Samples::Four, &frame)
            .map_err(refuse)?;
        if let Some(legend) = &legend {
            painting::composite(&mut image, legend, [height / 50; 2]);
        }
        take(image)?;
        progress.set(0.3 + 0.7 * (number + 1) as f32 / count as f32);
    }
    Ok(notes)
}

/// The look of the surface that the options request.
fn look(options: &StillOptions) -> Look {
    let regions = options.look.shading == Shading::Regions;
    Look {
        shading: options.look.shading.of_editor(),
        clay: options.clay,
        flat: options.flat,
        wireframe: options.wireframe,
        borders: options.borders,
        regions,
        outlines: options.outlines || regions,
        grid: options.grid,
        shadow: options.shadow,
        original: false,
        base: false,
        timeline: false,
        path: false,
        skins: Skins::default(),
        before: Before::Off,
    }
}

#[cfg(test)]
mod tests {
    use pliant_render::Outlines;

    use super::*;

    #[test]
    fn outlines_are_drawn_where_they_are_asked_for_whatever_the_shading() {
        for (outlines, shading, expected) in [
            (false, Shading::Clay, Outlines::Off),
            (true, Shading::Clay, Outlines::On),
            (false, Shading::Regions, Outlines::On),
        ] {
            let mut options = StillOptions {
                outlines,
                ..StillOptions::default()
            };
            options.look.shading = shading;
            assert_eq!(
                drawing::style(&look(&options), 1.0).outlines,
                expected,
                "{outlines} {shading:?}"
            );
        }
    }
}
