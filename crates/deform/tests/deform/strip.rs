//! A unit strip between two ends, whose shape is a polynomial in the limit.

use glam::{DAffine3, DVec3};
use pliant_deform::{Bilaplacian, Method, Role};
use pliant_mesh::shapes;

use crate::rig::Scene;

/// Heights at the middle of a unit strip of `cells` rows, held over n rows at both ends, of which one is lifted by 1:
/// at 0, h, .., 1 between the innermost held rows, with h. `change` edits the scene before it is bound.
pub fn heights(cells: usize, method: Method, change: impl FnOnce(&mut Scene)) -> (Vec<f64>, f64) {
    let Some(options) = method.options::<Bilaplacian>() else {
        unreachable!()
    };
    let rows = options.order.number() as f64;
    let pitch = 1.0 / cells as f64;
    let (from, to) = ((rows - 0.5) * pitch, 1.0 - (rows - 0.5) * pitch);
    let mut scene = Scene::new(shapes::grid(cells, cells))
        .with(Role::Fixed, |p| p.x < from)
        .with(Role::Handle(0), |p| p.x > to);
    scene.method = method;
    change(&mut scene);
    let displacements = scene.moved(&[DAffine3::from_translation(DVec3::Z)]);
    let mut row: Vec<(f64, f64)> = scene
        .positions()
        .iter()
        .zip(&displacements)
        .filter(|(p, _)| (p.y - 0.5).abs() < 1e-9 && p.x > from - pitch && p.x < to + pitch)
        .map(|(p, d)| (p.x, d.z))
        .collect();
    row.sort_by(|a, b| a.0.total_cmp(&b.0));
    let heights: Vec<f64> = row.into_iter().map(|(_, z)| z).collect();
    let pitch = 1.0 / (heights.len() - 1) as f64;
    (heights, pitch)
}

/// The largest distance of the heights from `exact`.
pub fn largest_error(heights: &[f64], pitch: f64, exact: impl Fn(f64) -> f64) -> f64 {
    let errors = heights
        .iter()
        .enumerate()
        .map(|(i, z)| (z - exact(i as f64 * pitch)).abs());
    errors.fold(0.0, f64::max)
}
