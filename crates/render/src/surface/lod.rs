//! A reduced level of detail over the same vertices, for interaction on slow devices.
//!
//! Vertex clustering [RB93]: each cell of a grid keeps one of its vertices, and the triangles that still have three
//! different corners remain. No vertex is added, so the reduced mesh shares the vertex buffers of the full one.

/// Fewer visible triangles are drawn fast enough at full detail.
pub(crate) const REDUCED_FROM_TRIANGLES: usize = 300_000;
/// Cells along the longest side of the bounding box.
const CELLS: f32 = 140.0;

/// The triangles that remain after clustering, without duplicates.
pub(crate) fn reduced_triangles(positions: &[[f32; 3]], triangles: &[[u32; 3]]) -> Vec<[u32; 3]> {
    let (mut low, mut high) = (glam::Vec3::INFINITY, glam::Vec3::NEG_INFINITY);
    for &corner in triangles.iter().flatten() {
        let position = glam::Vec3::from(positions[corner as usize]);
        (low, high) = (low.min(position), high.max(position));
    }
    let cell = (high - low).max_element() / CELLS;
    if !(cell > 0.0 && cell.is_finite()) {
        return triangles.to_vec();
    }
    let counts = ((high - low) / cell).to_array().map(|side| side as usize + 1);
    let mut kept = vec![u32::MAX; counts.iter().product()];
    let mut kept_of = |vertex: u32| {
        let at = ((glam::Vec3::from(positions[vertex as usize]) - low) / cell).to_array();
        let [x, y, z] = std::array::from_fn(|axis| (at[axis] as usize).min(counts[axis] - 1));
        let kept = &mut kept[(z * counts[1] + y) * counts[0] + x];
        *kept = if *kept == u32::MAX { vertex } else { *kept };
        *kept
    };
    let mut reduced: Vec<[u32; 3]> = triangles
        .iter()
        .map(|corners| corners.map(&mut kept_of))
        .filter(|[a, b, c]| a != b && b != c && c != a)
        .map(|[a, b, c]| match a.min(b).min(c) {
            lowest if lowest == a => [a, b, c],
            lowest if lowest == b => [b, c, a],
            _ => [c, a, b],
        })
        .collect();
    reduced.sort_unstable();
    reduced.dedup();
    reduced
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::Vec3;

    /// A UV sphere of radius 1.
    fn sphere(around: u32) -> (Vec<[f32; 3]>, Vec<[u32; 3]>) {
        let across = around / 2;
        let mut positions = Vec::new();
        for k in 0..=across {
            for i in 0..around {
                let (turn, tip) = (
                    std::f32::consts::TAU * i as f32 / around as f32,
                    std::f32::consts::PI * k as f32 / across as f32,
                );
                positions.push([turn.cos() * tip.sin(), tip.cos(), -turn.sin() * tip.sin()]);
            }
        }
        let at = |i: u32, k: u32| k * around + i % around;
        let quads = (0..across).flat_map(|k| (0..around).map(move |i| (i, k)));
        let triangles = quads.flat_map(|(i, k)| {
            let [a, b, c, d] = [at(i, k), at(i, k + 1), at(i + 1, k + 1), at(i + 1, k)];
            [[a, b, c], [a, c, d]]
        });
        let triangles = triangles.collect();
        (positions, triangles)
    }

    #[test]
    fn a_fine_sphere_becomes_a_coarse_one_that_faces_the_same_way() {
        let (positions, triangles) = sphere(1200);
        let reduced = reduced_triangles(&positions, &triangles);
        assert!(
            reduced.len() > 20_000 && reduced.len() < triangles.len() / 8,
            "{}",
            reduced.len()
        );
        let (mut area, mut backward) = (0.0, 0.0);
        for triangle in &reduced {
            let [a, b, c] = triangle.map(|vertex| Vec3::from(positions[vertex as usize]));
            let doubled = (b - a).cross(c - a);
            area += 0.5 * doubled.length();
            if doubled.dot(a + b + c) < 0.0 {
                backward += 0.5 * doubled.length();
            }
        }
        let whole = 4.0 * std::f32::consts::PI;
        assert!((area / whole - 1.0).abs() < 0.03, "{area}");
        assert!(backward < 0.01 * whole, "{backward}");
    }

    #[test]
    fn a_mesh_without_extent_or_without_triangles_stays_as_it_is() {
        assert!(reduced_triangles(&[], &[]).is_empty());
        assert_eq!(reduced_triangles(&[[1.0; 3]; 3], &[[0, 1, 2]]), [[0, 1, 2]]);
    }
}
