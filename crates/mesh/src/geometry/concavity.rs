//! The concavity of a surface at a scale: how fast its smoothed normals turn towards each other.
//!
//! Parts of a shape end in concave creases, by the minima rule of human vision [HR84].

use glam::DVec3;

use super::smooth_normals::SomeVertices;
use crate::{SurfaceVertex, Topology};

/// The concavity of the surface at each of some vertices, in radians per world unit: the largest rate over its edges at
/// which the normals, smoothed over the length `scale`, turn towards each other; 0 where the surface is flat or convex.
/// Only these vertices, each listed once, and the triangles around them count.
pub fn concavities(
    triangles: &[[SurfaceVertex; 3]],
    topology: &Topology,
    positions: &[DVec3],
    vertices: &[SurfaceVertex],
    scale: f64,
) -> Vec<f64> {
    let some = SomeVertices::of(topology, positions, vertices);
    let smooth = some.normals(triangles, scale);
    let concavity = |place: usize| {
        let (here, normal) = (some.position(place), smooth[place]);
        let rate = |other: usize| {
            let edge = some.position(other) - here;
            (normal - smooth[other]).dot(edge) / edge.length_squared()
        };
        // `max` leaves out NaN, of edges without a length.
        some.neighbours(place).map(rate).fold(0.0, f64::max)
    };
    some.each(concavity)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Drawn, shapes};

    /// The total turn that a way along x over the whole of the surface crosses, and the largest concavity.
    fn turn(drawn: Drawn, scale: f64) -> (f64, f64) {
        let model = shapes::model(drawn);
        let vertices: Vec<SurfaceVertex> = (0..model.surface.positions.len() as u32).map(SurfaceVertex).collect();
        let (triangles, positions) = (&model.surface.triangles, &model.surface.positions);
        let found = concavities(triangles, &model.topology, positions, &vertices, scale);
        let most = found.iter().copied().fold(0.0, f64::max);
        let on_way = |p: &DVec3| (p.y - 0.5).abs() < 1e-9;
        let mut way: Vec<(DVec3, f64)> = model.surface.positions.iter().copied().zip(found).collect();
        way.retain(|(p, _)| on_way(p));
        way.sort_by(|(a, _), (b, _)| a.x.total_cmp(&b.x));
        let step = |pair: &[(DVec3, f64)]| 0.5 * (pair[0].1 + pair[1].1) * pair[0].0.distance(pair[1].0);
        (way.windows(2).map(step).sum(), most)
    }

    /// A sheet over the unit square that folds up by `angle` along x = 0.5.
    fn folded(cells: usize, angle: f64) -> Drawn {
        let mut drawn = shapes::grid(cells, cells);
        for p in &mut drawn.positions {
            let beyond = (p.x - 0.5).max(0.0);
            *p += DVec3::new(angle.cos() - 1.0, 0.0, angle.sin()) * beyond;
        }
        drawn
    }

    #[test]
    fn a_way_across_a_crease_turns_by_its_angle_on_every_mesh() {
        for cells in [40, 80, 160] {
            for angle in [0.3, 0.8, 1.2] {
                let (across, _) = turn(folded(cells, angle), 0.05);
                // Each vertex counts the edge on the side of the crease, and the one in it counts its edge once more: the
                // turn left at a distance x falls as exp(−x/σ).
                let twice = 0.5 * (1.0 - (-1.0 / (cells as f64 * 0.05)).exp());
                assert!(
                    (0.8..1.05 + twice).contains(&(across / angle)),
                    "{cells} cells, {angle}: {across}"
                );
                let (_, convex) = turn(folded(cells, -angle), 0.05);
                assert!(convex < 0.5 * angle, "{cells} cells, −{angle}: {convex}");
            }
        }
    }

    #[test]
    fn flat_and_round_shapes_have_none_and_noise_is_smoothed_away() {
        assert!(turn(shapes::grid(40, 40), 0.05).1 < 1e-9);
        assert!(turn(shapes::icosphere(4), 0.1).1 < 0.05);
        let mut rough = shapes::grid(120, 120);
        let mut number = 7_u32;
        for p in &mut rough.positions {
            number = number.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            p.z += 1e-3 * (f64::from(number >> 8) / f64::from(1 << 24) - 0.5);
        }
        let (fine, coarse) = (turn(rough.clone(), 1e-3).0, turn(rough, 0.05).0);
        assert!(coarse < 0.1 * fine, "{fine} {coarse}");
    }
}
