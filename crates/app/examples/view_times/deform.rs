//! One frame of a drag with one handle that moves every vertex: bases and normals on the processor with an upload, or in
//! compute shaders, until the device is done.

use std::sync::Arc;

use glam::{DAffine3, DMat3, DQuat, DVec3};
use pliant_app::drawing::Drawing;
use pliant_mesh::Model;
use pliant_render::{Deformer, DeformerData, RenderError, Renderer, Surface};
use rayon::prelude::*;

use crate::{FRAMES, median, timed};

/// Milliseconds on the processor and on the device.
pub fn frame_ms(
    model: &Arc<Model>,
    drawing: &Drawing,
    renderer: &mut Renderer,
    surface: &mut Surface,
) -> Result<[f64; 2], RenderError> {
    let rest: Vec<DVec3> = model.surface.positions.clone();
    let weight = |p: &DVec3| 0.5 + 0.4 * p.x;
    let basis = |p: &DVec3| (*p * weight(p)).extend(weight(p)).as_vec4().to_array();
    let bases: Vec<[f32; 4]> = rest.iter().map(basis).collect();
    let columns = |turn: f64| {
        let map = DAffine3::from_rotation_translation(DQuat::from_rotation_y(turn), DVec3::X * 0.1);
        let linear = map.matrix3 - DMat3::IDENTITY;
        [linear.x_axis, linear.y_axis, linear.z_axis, map.translation]
    };
    let mut processor = Vec::new();
    for frame in 0..FRAMES {
        let columns = columns(0.02 * frame as f64);
        let (ms, done) = timed(|| {
            let displacements: Vec<DVec3> = bases
                .par_iter()
                .map(|weights| {
                    let terms = columns.iter().zip(weights);
                    terms.map(|(column, &weight)| *column * f64::from(weight)).sum()
                })
                .collect();
            surface.update_shape(renderer, &drawing.pose(model, &displacements).data())?;
            renderer.queue().submit([]);
            renderer.finish()
        });
        done?;
        processor.push(ms);
    }
    let rest = model.rest();
    let triangles: Vec<[u32; 3]> = rest.triangles.iter().map(|corners| corners.map(|v| v.0)).collect();
    let of_drawn = model.drawn.surface_vertices();
    let of_drawn: Vec<u32> = of_drawn.map(|v| v.map_or(DeformerData::STILL, |v| v.0)).collect();
    let relative = |p: &DVec3| (*p - drawing.centre).as_vec3().to_array();
    let data = DeformerData {
        rest: &rest.positions.iter().map(relative).collect::<Vec<_>>(),
        row_of_vertex: &of_drawn,
        rows: &bases,
        handle_count: 1,
        triangles: &triangles,
        normal_groups: &of_drawn,
        stored: None,
    };
    let deformer = Deformer::new(renderer, surface, &data)?;
    let mut device = Vec::new();
    for frame in 0..FRAMES {
        let columns = columns(0.02 * frame as f64).map(|column| column.as_vec3().to_array());
        let (ms, done) = timed(|| {
            deformer.run(renderer, surface, &[columns])?;
            renderer.finish()
        });
        done?;
        device.push(ms);
    }
    Ok([processor, device].map(median))
}
