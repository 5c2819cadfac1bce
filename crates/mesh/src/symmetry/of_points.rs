//! The planes across which a set of points is its own image, point by point.

use std::collections::HashMap;

use glam::DVec3;

use super::MirrorPlane;

/// The number of vertices by which a plane is judged.
const SAMPLES: usize = 64;

/// The number of vertices farthest from the centre, pairs of which suggest planes, and the number of pairs that are
/// tried.
const FURTHEST: usize = 48;
const PAIRS: usize = 200;

/// A vertex has its image if another vertex is this close to it, as a share of the shape's size.
const NEAR: f64 = 1e-4;

/// The share of the samples that must have their image.
const MOST: f64 = 0.5;

/// The planes across which more than half of these finite positions have their image among them, the likeliest first,
/// each with that share. A sample represents all positions, so the result may include a plane that a few of them lack.
///
/// ```
/// use glam::DVec3;
/// use pliant_mesh::{mirror_planes, shapes};
///
/// let tower = shapes::bar(2, 2, 5).positions;
/// let planes = mirror_planes(&tower);
/// assert!(planes.iter().any(|(share, plane)| *share == 1.0 && plane.normal() == DVec3::X));
/// ```
pub fn mirror_planes(positions: &[DVec3]) -> Vec<(f64, MirrorPlane)> {
    let centre = positions.iter().sum::<DVec3>() / positions.len().max(1) as f64;
    let size = positions.iter().map(|p| p.distance(centre)).fold(0.0, f64::max);
    let places = Places::of(positions, NEAR * size);
    planes(positions, centre, size)
        .into_iter()
        .filter_map(|(normal, through)| MirrorPlane::new(normal, normal.dot(through)))
        .map(|plane| (places.share_with_image(positions, &plane), plane))
        .filter(|(share, _)| *share > MOST)
        .collect()
}

/// Planes that may be planes of symmetry, each by its unit normal and a point: the most likely first.
fn planes(positions: &[DVec3], centre: DVec3, size: f64) -> Vec<(DVec3, DVec3)> {
    let mut planes = Vec::new();
    for axis in [DVec3::X, DVec3::Z, DVec3::Y] {
        planes.push((axis, DVec3::ZERO));
        planes.push((axis, centre));
    }
    let mut far: Vec<(f64, DVec3)> = positions.iter().map(|&p| (p.distance(centre), p)).collect();
    let count = far.len().min(FURTHEST);
    if count > 0 {
        far.select_nth_unstable_by(count - 1, |a, b| b.0.total_cmp(&a.0));
    }
    let by_place = |a: &(f64, DVec3), b: &(f64, DVec3)| {
        let [a, b] = [a, b].map(|(distance, p)| [-*distance, p.x, p.y, p.z]);
        let mut lanes = a.iter().zip(&b).map(|(a, b)| a.total_cmp(b));
        lanes.find(|order| order.is_ne()).unwrap_or(std::cmp::Ordering::Equal)
    };
    far[..count].sort_by(by_place);
    // A vertex and its image have the same distance from the centre.
    let pairs = (0..count).flat_map(|a| (a + 1..count).map(move |b| (a, b)));
    let alike = pairs.map(|(a, b)| (far[a], far[b]));
    let alike = alike.filter(|((a, _), (b, _))| (a - b).abs() <= NEAR * size);
    let normals = alike.filter_map(|((_, a), (_, b))| (a - b).try_normalize());
    planes.extend(normals.take(PAIRS).map(|normal| (normal, centre)));
    planes
}

/// The cells of a grid that contain vertices.
struct Places {
    width: f64,
    cells: HashMap<[i64; 3], Vec<DVec3>>,
}

impl Places {
    fn of(positions: &[DVec3], width: f64) -> Self {
        let mut places = Self {
            width,
            cells: HashMap::new(),
        };
        if width > 0.0 {
            for &position in positions {
                let cell = places.cells.entry(places.cell(position)).or_default();
                // One of them says as much as a million.
                if cell.len() < 4 {
                    cell.push(position);
                }
            }
        }
        places
    }

    fn cell(&self, position: DVec3) -> [i64; 3] {
        position.to_array().map(|number| (number / self.width).floor() as i64)
    }

    fn has_near(&self, position: DVec3) -> bool {
        let cell = self.cell(position);
        // A plane may be so inaccurate that its image is beyond the last cell.
        let around = (0..27).map(|k| {
            let steps = [k % 3 - 1, k / 3 % 3 - 1, k / 9 - 1];
            std::array::from_fn(|axis| i64::saturating_add(cell[axis], steps[axis]))
        });
        let mut near = around.filter_map(|cell| self.cells.get(&cell)).flatten();
        near.any(|other| other.distance(position) <= self.width)
    }

    /// The share of sampled vertices whose image across a plane is a vertex.
    fn share_with_image(&self, positions: &[DVec3], plane: &MirrorPlane) -> f64 {
        if self.cells.is_empty() {
            return 0.0;
        }
        let step = positions.len().div_ceil(SAMPLES).max(1);
        let samples = positions.iter().step_by(step);
        let count = samples.len().max(1) as f64;
        let has_image = |p: &&DVec3| self.has_near(plane.mirrored(**p));
        samples.filter(has_image).count() as f64 / count
    }
}
