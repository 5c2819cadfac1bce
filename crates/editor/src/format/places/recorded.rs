//! Recorded vertices of a mesh: their numbers, places and normals, and their form in a file.

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use glam::{DVec2, DVec3, Vec2Swizzles};
use pliant_mesh::Bounds;

/// The bits of a coordinate, as a share of the longest side of the box.
const BITS: u32 = 21;

/// The largest coordinate.
const MOST: f64 = ((1 << BITS) - 1) as f64;

/// Set in a stored place without a normal.
const NO_NORMAL: u64 = 1 << 63;

/// The bytes of a vertex: its number (4), its place (8) and its normal (2).
const BYTES: usize = 14;

/// Vertices of a mesh.
#[derive(Clone, Debug)]
pub(in crate::format) struct Recorded {
    /// The file's numbers, ascending.
    pub numbers: Vec<u32>,
    /// In world space, rounded to [`Self::precision`].
    pub positions: Vec<DVec3>,
    /// Unit normals, or 0.
    pub normals: Vec<DVec3>,
    /// The box of the whole mesh.
    pub bounds: Bounds,
}

impl Recorded {
    /// These vertices, each a number, a place in `bounds` and a normal, as they are read again from a file.
    pub fn of(vertices: impl Iterator<Item = (u32, DVec3, DVec3)>, bounds: Bounds) -> Self {
        Self::of_bytes(&bytes_of(vertices, &bounds), bounds)
    }

    /// The same from a file; `None` if the text is none that [`Self::to_base64`] gives.
    pub fn of_base64(text: &str, bounds: Bounds) -> Option<Self> {
        let bytes = STANDARD.decode(text).ok()?;
        let is_whole = bytes.len().is_multiple_of(BYTES);
        let are_finite = bounds.min.is_finite() && bounds.max.is_finite() && bounds.min.cmple(bounds.max).all();
        let own = (is_whole && are_finite).then(|| Self::of_bytes(&bytes, bounds))?;
        own.numbers.is_sorted_by(|a, b| a < b).then_some(own)
    }

    fn of_bytes(bytes: &[u8], bounds: Bounds) -> Self {
        let unit = unit(&bounds);
        let mut own = Self {
            numbers: Vec::with_capacity(bytes.len() / BYTES),
            positions: Vec::with_capacity(bytes.len() / BYTES),
            normals: Vec::with_capacity(bytes.len() / BYTES),
            bounds,
        };
        for vertex in bytes.chunks_exact(BYTES) {
            let (number, rest) = vertex.split_at(4);
            let (place, normal) = rest.split_at(8);
            let place = place.try_into().map_or(0, u64::from_le_bytes);
            let step = |axis: u32| (place >> (axis * BITS) & ((1 << BITS) - 1)) as f64;
            own.numbers.push(number.try_into().map_or(0, u32::from_le_bytes));
            own.positions
                .push(bounds.min + unit * DVec3::new(step(0), step(1), step(2)));
            own.normals.push(match place & NO_NORMAL {
                0 => unfolded([normal[0], normal[1]]),
                _ => DVec3::ZERO,
            });
        }
        own
    }

    pub fn to_base64(&self) -> String {
        let vertices = self.numbers.iter().zip(&self.positions).zip(&self.normals);
        let vertices = vertices.map(|((number, position), normal)| (*number, *position, *normal));
        STANDARD.encode(bytes_of(vertices, &self.bounds))
    }

    /// Places are rounded by no more than this in each coordinate.
    pub fn precision(&self) -> f64 {
        unit(&self.bounds)
    }
}

/// The vertices in a file.
fn bytes_of(vertices: impl Iterator<Item = (u32, DVec3, DVec3)>, bounds: &Bounds) -> Vec<u8> {
    let mut bytes = Vec::new();
    let unit = unit(bounds);
    for (number, position, normal) in vertices {
        let steps = ((position - bounds.min) / unit).round();
        let [x, y, z] = steps
            .clamp(DVec3::ZERO, DVec3::splat(MOST))
            .to_array()
            .map(|step| step as u64);
        let no_normal = if normal == DVec3::ZERO { NO_NORMAL } else { 0 };
        bytes.extend(number.to_le_bytes());
        bytes.extend((x | y << BITS | z << (2 * BITS) | no_normal).to_le_bytes());
        bytes.extend(folded(normal));
    }
    bytes
}

/// The step of a coordinate.
fn unit(bounds: &Bounds) -> f64 {
    (bounds.extent().max_element() / MOST).max(f64::MIN_POSITIVE)
}

/// A direction as two bytes: the octahedron |x| + |y| + |z| = 1 unfolded onto a square. 0 is stored as some direction.
fn folded(normal: DVec3) -> [u8; 2] {
    let on = normal / normal.abs().element_sum().max(f64::MIN_POSITIVE);
    let flat = match on.z < 0.0 {
        true => (1.0 - on.truncate().yx().abs()) * sides(on.truncate()),
        false => on.truncate(),
    };
    (flat * 127.0).to_array().map(|step| (step.round() + 127.0) as u8)
}

fn unfolded(bytes: [u8; 2]) -> DVec3 {
    let flat = (DVec2::from(bytes.map(f64::from)) - 127.0) / 127.0;
    let height = 1.0 - flat.abs().element_sum();
    let on = match height < 0.0 {
        true => (1.0 - flat.yx().abs()) * sides(flat),
        false => flat,
    };
    on.extend(height).normalize_or(DVec3::Z)
}

/// 1 or -1 for each coordinate.
fn sides(of: DVec2) -> DVec2 {
    DVec2::select(of.cmplt(DVec2::ZERO), DVec2::NEG_ONE, DVec2::ONE)
}
