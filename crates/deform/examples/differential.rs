//! Times the differential methods and the kinds of detail during a drag: `differential MESH.off THREADS [METHOD..]`.
//!
//! The edit is the one that peers are timed on, its target approached in sixty frames. One JSON object a method, the
//! bi-Laplacian first; times are medians in milliseconds. A method's binding alternates with the bi-Laplacian's, so
//! that their ratio compares runs close in time. With `PLIANT_CPU` in the environment times are the processor's, summed
//! over threads.
#![allow(clippy::print_stdout, clippy::unwrap_used, reason = "a program that measures")]

mod common;

use std::path::Path;

use common::{median, name, one_handle, peers_edit, pool, read, timed};
use glam::{DAffine3, DQuat, DVec3};
use pliant_deform::{Bilaplacian, Detail, Frames, LaplacianEditing, Method, Poisson, Role};
use pliant_mesh::{Cancel, Model, Progress, vertex_normals};
use rayon::prelude::*;

/// Frames of the drag.
const FRAMES: u32 = 60;

/// Bindings of each kind.
const BINDINGS: usize = 5;

fn main() {
    let words: Vec<String> = std::env::args().skip(1).collect();
    let [file, threads, wanted @ ..] = words.as_slice() else {
        panic!("usage: differential MESH.off THREADS [METHOD..]");
    };
    let threads = threads.parse().unwrap();
    let pool = pool(threads);
    let mut chosen = methods();
    chosen.retain(|(name, _)| wanted.is_empty() || wanted.iter().any(|wanted| wanted == name));
    pool.install(|| measure(Path::new(file), threads, &chosen));
}

fn methods() -> Vec<(&'static str, Method)> {
    let detailed = |detail| {
        let mut options = Bilaplacian::default();
        options.detail = detail;
        options.into()
    };
    vec![
        ("bilaplacian", Bilaplacian::default().into()),
        ("poisson", Poisson::default().into()),
        ("frames", Frames::default().into()),
        ("laplacian", LaplacianEditing::default().into()),
        ("normal-displacements", detailed(Detail::NormalDisplacements)),
        ("displacement-volumes", detailed(Detail::DisplacementVolumes)),
        ("deformation-transfer", detailed(Detail::DeformationTransfer)),
    ]
}

fn measure(file: &Path, threads: usize, chosen: &[(&str, Method)]) {
    let model = read(file);
    let (roles, target) = peers_edit(&model);
    let drag: Vec<DAffine3> = (1..=FRAMES)
        .map(|frame| part_of(&model, &roles, target, f64::from(frame) / f64::from(FRAMES)))
        .collect();
    let stiffness = vec![1.0; roles.len()];
    let (progress, cancel) = (Progress::new(), Cancel::new());
    let plain = Method::from(Bilaplacian::default());
    let plain_ordering = plain.ordering(&model.topology, &progress, &cancel).unwrap();
    for (title, method) in chosen {
        let ordering = method.ordering(&model.topology, &progress, &cancel).unwrap();
        let bind = |method, ordering: &Option<_>| {
            let problem = one_handle(&model, &roles, &stiffness, method);
            timed(|| problem.bind(ordering.as_ref(), &progress, &cancel).unwrap())
        };
        let (mut plain_ms, mut bind_ms) = (Vec::new(), Vec::new());
        let mut last = None;
        for _ in 0..BINDINGS {
            drop(last.take());
            plain_ms.push(bind(&plain, &plain_ordering).0);
            let (ms, bound) = bind(method, &ordering);
            bind_ms.push(ms);
            last = Some(bound);
        }
        let mut bound = last.unwrap();
        let mut displacements = vec![DVec3::ZERO; roles.len()];
        let mut normals = Vec::new();
        let (mut frame_ms, mut normals_ms, mut both_ms) = (Vec::new(), Vec::new(), Vec::new());
        for target in &drag {
            bound.set_targets(&[*target]).unwrap();
            let (frame, _) = timed(|| bound.step(&mut displacements).unwrap());
            let rest = model.surface.positions.par_iter();
            let positions: Vec<DVec3> = rest.zip(&displacements).map(|(rest, moved)| *rest + *moved).collect();
            let (own, ()) = timed(|| {
                vertex_normals(&model.surface.triangles, &model.topology, &positions, &mut normals);
            });
            frame_ms.push(frame);
            normals_ms.push(own);
            both_ms.push(frame + own);
        }
        let (plain_ms, bind_ms) = (median(&mut plain_ms), median(&mut bind_ms));
        println!(
            "{{\"mesh\": \"{}\", \"threads\": {threads}, \"method\": \"{title}\", \"free\": {}, \"bind\": {bind_ms:.1}, \
             \"bind_ratio\": {:.2}, \"frame\": {:.3}, \"normals\": {:.3}, \"both\": {:.3}}}",
            name(file),
            bound.solved_count(),
            bind_ms / plain_ms,
            median(&mut frame_ms),
            median(&mut normals_ms),
            median(&mut both_ms),
        );
    }
}

/// A share of the way to the target: of the handle's turn, and of its centre's shift.
fn part_of(model: &Model, roles: &[Role], target: DAffine3, share: f64) -> DAffine3 {
    let members = || {
        let all = roles.iter().zip(&model.surface.positions);
        all.filter(|(role, _)| matches!(role, Role::Handle(_))).map(|(_, p)| *p)
    };
    let centre = members().sum::<DVec3>() / members().count() as f64;
    let shift = target.transform_point3(centre) - centre;
    let turn = DQuat::IDENTITY.slerp(DQuat::from_mat3(&target.matrix3), share);
    DAffine3::from_translation(centre + shift * share) * DAffine3::from_quat(turn) * DAffine3::from_translation(-centre)
}
