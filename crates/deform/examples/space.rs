//! Times the methods that bend space: `space VERTICES THREADS METHOD [OPTION=VALUE ..] [by-hand]`.
//!
//! Points are spread over a bumpy ball; a cap is the handle, the lower third is fixed. One JSON object: binding, the
//! median frame of a drag and the median of its normals, in milliseconds. Jacobians turn the normals, and the time is
//! theirs; if the method gives none, the normals are those of the triangles. With `by-hand` the cage or lattice that
//! the method makes is brought back, and one of its points is moved in each frame, too.
#![allow(
    clippy::print_stdout,
    clippy::print_stderr,
    clippy::unwrap_used,
    reason = "a program that measures"
)]

mod common;

use std::sync::Arc;

use common::{median, one_handle, pool, timed};
use glam::{DAffine3, DVec3};
use pliant_deform::{Attachment, Method, OptionKind, OptionValue, Role};
use pliant_mesh::{Cancel, Progress, shapes, vertex_normals};
use rayon::prelude::*;

/// Frames of the drag.
const FRAMES: usize = 30;

fn main() {
    let words: Vec<String> = std::env::args().skip(1).collect();
    let [vertices, threads, name, options @ ..] = words.as_slice() else {
        panic!("usage: space VERTICES THREADS METHOD [OPTION=VALUE ..] [by-hand]");
    };
    let (by_hand, options): (Vec<&String>, Vec<&String>) = options.iter().partition(|word| *word == "by-hand");
    let method = options.iter().fold(Method::from_name(name).unwrap(), |method, option| {
        let (option, value) = option.split_once('=').unwrap();
        let declared = method.declaration().options.iter().find(|own| own.name == option);
        let value = match declared.unwrap().kind {
            OptionKind::Number { .. } => OptionValue::Number(value.parse().unwrap()),
            OptionKind::Whole { .. } | OptionKind::Numbered { .. } => OptionValue::Whole(value.parse().unwrap()),
            OptionKind::Named { choices } => {
                OptionValue::Name(choices.iter().find(|choice| **choice == value).unwrap())
            }
            OptionKind::Switch => OptionValue::Switch(value.parse().unwrap()),
        };
        method.with([(option, value)]).unwrap()
    });
    let threads = threads.parse().unwrap();
    let pool = pool(threads);
    pool.install(|| measure(vertices.parse().unwrap(), threads, &method, !by_hand.is_empty()));
}

fn measure(vertices: usize, threads: usize, method: &Method, by_hand: bool) {
    let rings = (vertices as f64 / 2.0).sqrt() as usize;
    let mut drawn = shapes::uv_sphere(rings, 2 * rings);
    for p in &mut drawn.positions {
        *p *= 1.0 + 0.05 * (9.0 * p.x).sin() * (7.0 * p.y).sin() * (8.0 * p.z).sin();
    }
    let model = shapes::model(drawn);
    let role = |p: &DVec3| match p.z {
        z if z > 0.8 => Role::Handle(0),
        z if z < -0.33 => Role::Fixed,
        _ => Role::Free,
    };
    let roles: Vec<Role> = model.surface.positions.iter().map(role).collect();
    let stiffness = vec![1.0; roles.len()];
    let (progress, cancel) = (Progress::new(), Cancel::new());
    let mut problem = one_handle(&model, &roles, &stiffness, method);
    let made = by_hand.then(|| problem.bind(None, &progress, &cancel).unwrap());
    let brought = made.and_then(|made| made.attachment().map(|(name, own)| (name, own.clone())));
    problem.attachments = brought.as_slice();
    let (bind_ms, bound) = timed(|| problem.bind(None, &progress, &cancel));
    let mut bound = bound.unwrap();
    let mut displacements = vec![DVec3::ZERO; roles.len()];
    let (mut frames, mut normals) = (Vec::new(), Vec::new());
    let (mut jacobians, mut bent, mut of_triangles) = (Vec::new(), Vec::new(), Vec::new());
    for frame in 0..FRAMES {
        let t = frame as f64 / FRAMES as f64;
        let turn = DAffine3::from_axis_angle(DVec3::X, 0.8 * t);
        let target = DAffine3::from_translation(DVec3::new(0.3, 0.1, 0.4) * t) * turn;
        let moved = brought.as_ref().map(|(_, own)| {
            let mut moved = own.moved().unwrap().to_vec();
            moved[0] += DVec3::X * t;
            Arc::new(moved)
        });
        let (frame_ms, ()) = timed(|| {
            bound.set_targets(&[target]).unwrap();
            if let Some(moved) = &moved {
                bound.set_controls(moved).unwrap();
            }
            bound.step(&mut displacements).unwrap();
        });
        let (normals_ms, ()) = timed(|| {
            if !bound.jacobians_into(&mut jacobians) {
                let places = model.surface.positions.par_iter().zip(&displacements);
                places.map(|(rest, own)| *rest + *own).collect_into_vec(&mut bent);
                vertex_normals(&model.surface.triangles, &model.topology, &bent, &mut of_triangles);
            }
        });
        frames.push(frame_ms);
        normals.push(normals_ms);
    }
    let faces = match bound.attachment() {
        Some((_, Attachment::Mesh(cage))) => cage.triangles.len(),
        _ => 0,
    };
    println!(
        "{{\"vertices\": {}, \"method\": \"{}\", \"threads\": {threads}, \"free\": {}, \"faces\": {faces}, \
         \"bind\": {bind_ms:.0}, \"frame\": {:.2}, \"normals\": {:.2}}}",
        roles.len(),
        method.name(),
        bound.solved_count(),
        median(&mut frames[1..]),
        median(&mut normals[1..]),
    );
    for warning in bound.warnings() {
        eprintln!("{warning:?}");
    }
}
