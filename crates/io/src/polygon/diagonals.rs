//! The choice between a quad's diagonals where both are as long: one that a mirror keeps.
//!
//! The order of a face's corners says nothing of the shape, so a cut by it leans the same way on both sides of a figure
//! that is its own mirror image, and a symmetric edit bends it lopsided. Here a plane across which most vertices have
//! their image is looked for, and of equal diagonals the one is taken whose ends have the lesser value of a function that
//! only asks how far a vertex is from that plane and where it is along it. The images of a quad's corners have the same
//! values, so that its image is cut by the image of its cut. A quad that is its own image has no such cut.
//!
//! The function also leaves out the sides of the other two axes, as long as it tells the diagonals apart, so that figures
//! with several planes keep them all.

use std::cell::OnceCell;
use std::collections::HashMap;

use glam::DVec3;

/// Diagonals that differ by less than this share of their squares are equal.
const EQUAL: f64 = 1e-3;

/// Values that differ by less than this share of a diagonal's square don't tell diagonals apart.
const ALIKE: f64 = 1e-4;

/// How many roundings to f32 of a coordinate may be between a vertex and its image.
const ROUNDINGS: f64 = 16.0;

/// Vertices by which a plane is judged.
const SAMPLES: usize = 64;

/// Vertices that are furthest from the centre, pairs of which suggest planes, and how many pairs are tried.
const FURTHEST: usize = 48;
const PAIRS: usize = 200;

/// A vertex has its image if a vertex is this near to it, as a share of the shape's size.
const NEAR: f64 = 1e-4;

/// The share of the samples that must have their image.
const MOST: f64 = 0.5;

/// How one of two equal diagonals of a shape is chosen.
pub(crate) struct Diagonals<'a> {
    positions: &'a [DVec3],
    frame: OnceCell<Frame>,
}

impl<'a> Diagonals<'a> {
    /// Those of faces over these vertices.
    pub fn of(positions: &'a [DVec3]) -> Self {
        Self {
            positions,
            frame: OnceCell::new(),
        }
    }

    /// Whether b–d is taken of the quad a, b, c, d, of which either diagonal would do.
    pub fn takes_bd(&self, [a, b, c, d]: [DVec3; 4]) -> bool {
        let (ac, bd) = (a.distance_squared(c), b.distance_squared(d));
        let frame = || self.frame.get_or_init(|| Frame::of(self.positions));
        let furthest = [a, b, c, d]
            .into_iter()
            .fold(0.0, |most: f64, p| most.max(p.abs().max_element()));
        let rounding = ROUNDINGS * f64::from(f32::EPSILON) * furthest * ac.max(bd).sqrt();
        if (ac - bd).abs() > EQUAL * ac.max(bd) + rounding {
            return bd < ac;
        }
        let frame = frame();
        let [a, b, c, d] = [a, b, c, d].map(|corner| frame.seen(corner));
        let least = ALIKE * ac.max(bd) + rounding;
        let functions = [Frame::value_of_all_sides, Frame::value_of_one_side];
        let mut differences = functions
            .map(|value| value(a) + value(c) - value(b) - value(d))
            .into_iter();
        differences
            .find(|difference| difference.abs() > least)
            .is_some_and(|difference| difference > 0.0)
    }
}

/// The plane across which most vertices have their image: its normal first, then two axes along it.
struct Frame {
    axes: [DVec3; 3],
    centre: DVec3,
}

impl Frame {
    fn of(positions: &[DVec3]) -> Self {
        let finite: Vec<DVec3> = positions.iter().copied().filter(|p| p.is_finite()).collect();
        let centre = finite.iter().sum::<DVec3>() / finite.len().max(1) as f64;
        let size = finite.iter().map(|p| p.distance(centre)).fold(0.0, f64::max);
        let places = Places::of(&finite, NEAR * size);
        let judged: Vec<(f64, (DVec3, DVec3))> = planes(&finite, centre, size)
            .into_iter()
            .map(|plane| (places.share_with_image(&finite, plane), plane))
            .filter(|(share, _)| *share > MOST)
            .collect();
        let most = judged.iter().map(|(share, _)| *share).fold(0.0, f64::max);
        let best = judged.iter().find(|(share, _)| *share >= most);
        let (normal, through) = best.map_or((DVec3::X, centre), |(_, plane)| *plane);
        // A second plane, square to the first, is kept as long as the sides of both tell diagonals apart.
        let square = judged.iter().map(|(_, (other, _))| *other);
        let second = square.into_iter().find(|other| other.dot(normal).abs() < NEAR);
        let second = second.unwrap_or_else(|| normal.any_orthonormal_vector());
        Self {
            axes: [normal, second, normal.cross(second)],
            centre: centre + normal * (through - centre).dot(normal),
        }
    }

    /// A corner from the plane, and along it from the centre.
    fn seen(&self, corner: DVec3) -> DVec3 {
        let from = corner - self.centre;
        DVec3::from_array(self.axes.map(|axis| axis.dot(from)))
    }

    fn value_of_all_sides(seen: DVec3) -> f64 {
        Self::value_of_one_side(seen.abs())
    }

    /// A sum of products, since sums of functions of single axes are equal over both diagonals of a rectangle.
    fn value_of_one_side(seen: DVec3) -> f64 {
        let side = seen.x.abs();
        side * seen.y + 0.754_877_666 * seen.y * seen.z + 0.569_840_291 * seen.z * side
    }
}

/// Planes that the shape may be its own image across, each by its unit normal and a point: the most likely first.
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
    // A vertex and its image are as far from the centre.
    let pairs = (0..count).flat_map(|a| (a + 1..count).map(move |b| (a, b)));
    let alike = pairs.map(|(a, b)| (far[a], far[b]));
    let alike = alike.filter(|((a, _), (b, _))| (a - b).abs() <= NEAR * size);
    let normals = alike.filter_map(|((_, a), (_, b))| (a - b).try_normalize());
    planes.extend(normals.take(PAIRS).map(|normal| (normal, centre)));
    planes
}

/// Which cells of a grid hold vertices.
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
                // One tells as much as a million.
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
        let [x, y, z] = self.cell(position);
        let around = (0..27).map(|k| [x + k % 3 - 1, y + k / 3 % 3 - 1, z + k / 9 - 1]);
        let mut near = around.filter_map(|cell| self.cells.get(&cell)).flatten();
        near.any(|other| other.distance(position) <= self.width)
    }

    /// The share of sampled vertices whose image across a plane is a vertex.
    fn share_with_image(&self, positions: &[DVec3], (normal, through): (DVec3, DVec3)) -> f64 {
        if self.cells.is_empty() {
            return 0.0;
        }
        let step = positions.len().div_ceil(SAMPLES).max(1);
        let samples = positions.iter().step_by(step);
        let count = samples.len().max(1) as f64;
        let has_image = |p: &&DVec3| self.has_near(**p - normal * (2.0 * (**p - through).dot(normal)));
        samples.filter(has_image).count() as f64 / count
    }
}
