//! The triangles under a curve that is laid onto a surface.

use super::curve::Curve;
use crate::{Bvh, SurfaceVertex};

/// How often the way between two places of the curve's table is halved where their triangles have no common vertex.
const MOST_HALVINGS: u32 = 7;

/// The triangles that a curve crosses when each of its points is put onto the nearest point of a surface: their numbers,
/// ascending. `bvh` has the surface's triangles.
pub fn triangles_under(curve: &Curve, bvh: &Bvh, triangles: &[[SurfaceVertex; 3]]) -> Vec<u32> {
    let under = |place: f64| -> Option<(f64, u32)> {
        let (triangle, _) = bvh.nearest_triangle(curve.position(place))?;
        Some((place, triangle))
    };
    let mut found: Vec<u32> = Vec::new();
    let mut last: Option<(f64, u32)> = None;
    for place in curve.station_places() {
        let Some(here) = under(place) else { continue };
        if let Some(before) = last {
            between(before, here, MOST_HALVINGS, &under, triangles, &mut found);
        }
        found.push(here.1);
        last = Some(here);
    }
    found.sort_unstable();
    found.dedup();
    found
}

/// Adds the triangles between two places.
fn between(
    from: (f64, u32),
    to: (f64, u32),
    halvings: u32,
    under: &impl Fn(f64) -> Option<(f64, u32)>,
    triangles: &[[SurfaceVertex; 3]],
    found: &mut Vec<u32>,
) {
    let [a, b] = [from, to].map(|(_, triangle)| triangles[triangle as usize]);
    let are_joined = a.iter().any(|corner| b.contains(corner));
    if halvings == 0 || are_joined {
        return;
    }
    if let Some(middle) = under(0.5 * (from.0 + to.0)) {
        found.push(middle.1);
        between(from, middle, halvings - 1, under, triangles, found);
        between(middle, to, halvings - 1, under, triangles, found);
    }
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use super::*;
    use crate::shapes;

    #[test]
    fn the_triangles_under_a_line_across_a_bar_are_a_strip_from_end_to_end() {
        let model = shapes::model(shapes::bar(20, 4, 4));
        let surface = &model.surface;
        let bvh = Bvh::build(&surface.positions, &surface.triangles);
        let line = vec![DVec3::new(0.3, 1.3, 4.4), DVec3::new(19.7, 2.6, 4.2)];
        let curve = Curve::new(line, false).unwrap_or_else(|refused| unreachable!("{refused}"));
        let under = triangles_under(&curve, &bvh, &surface.triangles);
        let corners = |triangle: &u32| surface.triangles[*triangle as usize].map(|v| surface.positions[v.index()]);
        assert!(
            under
                .iter()
                .all(|triangle| corners(triangle).iter().all(|corner| corner.z == 4.0))
        );
        // Each column of cells is crossed.
        for x in 0..20 {
            let is_here = |triangle: &u32| corners(triangle).iter().sum::<DVec3>().x / 3.0;
            assert!(
                under
                    .iter()
                    .any(|triangle| (is_here(triangle) - f64::from(x) - 0.5).abs() < 0.5),
                "{x}"
            );
        }
        assert!(under.len() < 80, "{}", under.len());
    }
}
