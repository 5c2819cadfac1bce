//! A grid that tells which directions the triangles in its cells face.
//!
//! Most vertices of a surface have nothing opposite them nearby. A look into the few cells around a short ray excludes
//! them for a tenth of the time of a hierarchy and a ray, so that only the triangles near the others need a hierarchy.
//! Directions are counted in the bins of a cube's sides, as in a cube map; a cell keeps one bit for each.

use glam::DVec3;
use pliant_mesh::Bounds;

/// The bins along each edge of a cube's side. All bins of a cell fit into 64 bits.
const BINS: usize = 3;

/// The most cells.
const MOST_CELLS: f64 = 2e6;

/// A triangle whose box covers more cells than this counts as everywhere.
const MOST_OF_ONE: usize = 64;

/// Boxes grow by this share of a cell: a ray may meet a triangle beside its edge by rounding.
const MARGIN: f64 = 1e-6;

/// Cosines of directions are rounded by less than this.
const ROUNDING: f64 = 1e-9;

/// The directions that triangles face in each cell of a box.
#[derive(Debug)]
pub(crate) struct OpposingGrid {
    origin: DVec3,
    cells_per_length: f64,
    counts: [usize; 3],
    /// The bins of each cell.
    bins: Vec<u64>,
    /// The bins of triangles that are everywhere.
    everywhere: u64,
    /// For each bin its middle, and the greatest cosine with it of a direction that is opposite to one in the bin.
    opposite_to: Vec<(DVec3, f64)>,
}

impl OpposingGrid {
    /// An empty grid over a box, with cells of about this length; directions are opposite if their cosine is at most
    /// `facing`.
    pub fn new(bounds: Bounds, length: f64, facing: f64) -> Self {
        let extent = bounds.extent();
        let cells = |length: f64| (extent / length).to_array().map(|cells| cells.floor() + 1.0);
        let mut length = length.max(f64::MIN_POSITIVE);
        while cells(length).iter().product::<f64>() > MOST_CELLS {
            length *= 2.0;
        }
        let counts = cells(length).map(|count| count as usize);
        Self {
            origin: bounds.min,
            cells_per_length: length.recip(),
            counts,
            bins: vec![0; counts.iter().product()],
            everywhere: 0,
            opposite_to: (0..6 * BINS * BINS).map(|bin| reach(bin, facing)).collect(),
        }
    }

    /// Adds a triangle with these corners and this normal of any length.
    pub fn add(&mut self, corners: [DVec3; 3], normal: DVec3) {
        let Some(bin) = bin_of(normal) else { return };
        let [low, high] = self.cells_around(corners);
        let covered = (0..3).map(|axis| high[axis] - low[axis] + 1).product::<usize>();
        if covered > MOST_OF_ONE {
            self.everywhere |= 1 << bin;
        } else {
            each(self.counts, [low, high], |cell| self.bins[cell] |= 1 << bin);
        }
    }

    /// Returns true if a triangle that faces away from the unit vector `normal` may be met between two points.
    pub fn may_meet(&self, from: DVec3, to: DVec3, normal: DVec3) -> bool {
        let middle = 0.5 * (from + to);
        let mut bins = self.everywhere;
        for part in [[from, middle], [middle, to]] {
            each(self.counts, self.cells_around(part), |cell| bins |= self.bins[cell]);
        }
        while bins != 0 {
            let (centre, most) = self.opposite_to[bins.trailing_zeros() as usize];
            if centre.dot(normal) <= most {
                return true;
            }
            bins &= bins - 1;
        }
        false
    }

    /// The lowest and highest cells of the box around some points; outside the grid the nearest ones.
    fn cells_around<const N: usize>(&self, points: [DVec3; N]) -> [[usize; 3]; 2] {
        let low = points.iter().copied().fold(DVec3::INFINITY, DVec3::min);
        let high = points.iter().copied().fold(DVec3::NEG_INFINITY, DVec3::max);
        [(low, -MARGIN), (high, MARGIN)].map(|(corner, margin)| {
            let cell = (corner - self.origin) * self.cells_per_length + margin;
            std::array::from_fn(|axis| (cell[axis] as usize).min(self.counts[axis] - 1))
        })
    }
}

/// The places that rays reach in a grid.
#[derive(Debug)]
pub(crate) struct Reached {
    is_reached: Vec<bool>,
}

impl Reached {
    pub fn none(grid: &OpposingGrid) -> Self {
        Self {
            is_reached: vec![false; grid.bins.len()],
        }
    }

    /// Marks the cells between two points.
    pub fn mark(&mut self, grid: &OpposingGrid, from: DVec3, to: DVec3) {
        let range = grid.cells_around([from, to]);
        each(grid.counts, range, |cell| self.is_reached[cell] = true);
    }

    /// Returns true if a triangle may meet the marked places.
    pub fn holds(&self, grid: &OpposingGrid, corners: [DVec3; 3]) -> bool {
        let range = grid.cells_around(corners);
        let covered = (0..3)
            .map(|axis| range[1][axis] - range[0][axis] + 1)
            .product::<usize>();
        let mut holds = covered > MOST_OF_ONE;
        if !holds {
            each(grid.counts, range, |cell| holds |= self.is_reached[cell]);
        }
        holds
    }
}

/// Visits the cells of a range.
#[inline]
fn each(counts: [usize; 3], [low, high]: [[usize; 3]; 2], mut visit: impl FnMut(usize)) {
    for z in low[2]..=high[2] {
        for y in low[1]..=high[1] {
            let row = (z * counts[1] + y) * counts[0];
            (row + low[0]..=row + high[0]).for_each(&mut visit);
        }
    }
}

/// The bin of a direction of any length; `None` if it has none.
fn bin_of(direction: DVec3) -> Option<usize> {
    let size = direction.abs();
    let axis = if size.x >= size.y && size.x >= size.z {
        0
    } else if size.y >= size.z {
        1
    } else {
        2
    };
    let longest = direction[axis];
    if longest == 0.0 || !direction.is_finite() {
        return None;
    }
    let side = 2 * axis + usize::from(longest < 0.0);
    let place = |other: usize| {
        let share = 0.5 + 0.5 * direction[other] / longest.abs();
        ((share * BINS as f64) as usize).min(BINS - 1)
    };
    Some((side * BINS + place((axis + 1) % 3)) * BINS + place((axis + 2) % 3))
}

/// A bin's middle, and the greatest cosine with it of a unit vector whose cosine with one in the bin is at most
/// `facing`.
fn reach(bin: usize, facing: f64) -> (DVec3, f64) {
    let (side, u, v) = (bin / (BINS * BINS), bin / BINS % BINS, bin % BINS);
    let (axis, sign) = (side / 2, if side % 2 == 0 { 1.0 } else { -1.0 });
    let at = |u: f64, v: f64| {
        let mut direction = DVec3::ZERO;
        direction[axis] = sign;
        direction[(axis + 1) % 3] = 2.0 * u / BINS as f64 - 1.0;
        direction[(axis + 2) % 3] = 2.0 * v / BINS as f64 - 1.0;
        direction.normalize()
    };
    let (u, v) = (u as f64, v as f64);
    let centre = at(u + 0.5, v + 0.5);
    let widest = [(0.0, 0.0), (1.0, 0.0), (0.0, 1.0), (1.0, 1.0)]
        .map(|(right, up)| centre.dot(at(u + right, v + up)).acos())
        .into_iter()
        .fold(0.0, f64::max);
    let least = (facing.acos() - widest).max(0.0);
    (centre, least.cos() + ROUNDING)
}
