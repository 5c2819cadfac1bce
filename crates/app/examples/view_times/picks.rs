//! Picks on a deformed mesh, and preparing for them.

use std::hint::black_box;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

use glam::{DVec2, DVec3};
use pliant_editor::Camera;
use pliant_mesh::{Bvh, Model};

use crate::{SIZE_PX, median, timed};

/// Members of a JSON object: building the hierarchy, refitting it when everything or a twentieth moved, and rays from
/// the eye that hit the surface, alone and during refitting.
pub fn row(model: &Model, moved: &[DVec3], camera: &Camera) -> String {
    let rest = &model.surface.positions;
    let (build_ms, mut bvh) = timed(|| Bvh::build(rest, &model.surface.triangles));
    let (refit_ms, ()) = timed(|| bvh.refit(|v| moved[v.index()]));
    let has_moved_on = |p: DVec3| p.x > 1.0 && p.y.abs() < 0.4;
    let share = moved.iter().filter(|&&p| has_moved_on(p)).count() as f64 / moved.len() as f64;
    let mut after = bvh.clone();
    let (part_ms, ()) = timed(|| {
        after.refit(|v| {
            let p = moved[v.index()];
            if has_moved_on(p) { p + DVec3::Z * 0.1 } else { p }
        })
    });
    let alone = picks(&bvh, camera, || ());
    // Pauses between picks imitate the time between pointer events.
    let is_over = AtomicBool::new(false);
    let beside = std::thread::scope(|threads| {
        threads.spawn(|| {
            for turn in 0..6 {
                let shape = if turn % 2 == 0 { rest.as_slice() } else { moved };
                after.refit(|v| shape[v.index()]);
            }
            is_over.store(true, Ordering::Relaxed);
        });
        let mut all = Vec::new();
        while !is_over.load(Ordering::Relaxed) {
            all.extend(picks(&bvh, camera, || std::thread::sleep(Duration::from_micros(100))));
        }
        all
    });
    let worst = |times: &[f64]| times.iter().copied().fold(0.0, f64::max);
    format!(
        "\"bvh_ms\": {build_ms:.0}, \"refit_ms\": {refit_ms:.1}, \"part\": {share:.3}, \"refit_part_ms\": {part_ms:.1}, \
         \"picks\": {}, \"pick_ms\": {:.4}, \"worst_ms\": {:.4}, \"picks_beside_refit\": {}, \
         \"beside_refit_ms\": {:.4}, \"worst_beside_ms\": {:.4}",
        alone.len(),
        median(alone.clone()),
        worst(&alone),
        beside.len(),
        median(beside.clone()),
        worst(&beside),
    )
}

/// Milliseconds of rays all over the picture. Rays that miss return at once and would distort the median, so they are
/// left out.
fn picks(bvh: &Bvh, camera: &Camera, between: impl Fn()) -> Vec<f64> {
    let size_px = DVec2::new(f64::from(SIZE_PX[0]), f64::from(SIZE_PX[1]));
    (0..4000_u32)
        .filter_map(|n| {
            let at = DVec2::new(f64::from(n * 7919 % SIZE_PX[0]), f64::from(n * 104_729 % SIZE_PX[1]));
            let ray = camera.ray(at, size_px);
            let (ms, hit) = timed(|| black_box(bvh.ray(ray.origin, ray.direction)));
            between();
            hit.map(|_| ms)
        })
        .collect()
}
