//! The unfinished triangles of a hole: points, triangles and their neighbours.

use std::collections::HashMap;
use std::hash::{BuildHasherDefault, Hasher};

use glam::DVec3;

use super::rim::Joined;

/// A triangulated polygon whose first points are the rim, in order.
#[derive(Clone, Debug, Default)]
pub(crate) struct Patch {
    /// The rim, then the points inside.
    pub points: Vec<DVec3>,
    /// The number of the rim's points.
    pub rim: usize,
    /// The triangles are counterclockwise, so that edges of the rim run from each point to the next.
    pub triangles: Vec<[u32; 3]>,
    /// The triangle on the left of each directed edge. The code only looks it up and never lists it.
    beside: HashMap<u64, u32, BuildHasherDefault<EdgeHasher>>,
    /// The pairs of rim points that the patch must not join.
    joined: Joined,
}

impl Patch {
    /// Makes a patch of these points and triangles. It must not join the rim points that are `joined`.
    pub fn new(points: Vec<DVec3>, rim: usize, triangles: Vec<[u32; 3]>, joined: Joined) -> Self {
        let mut patch = Self {
            points,
            rim,
            triangles: Vec::with_capacity(triangles.len()),
            beside: HashMap::with_capacity_and_hasher(3 * triangles.len(), BuildHasherDefault::default()),
            joined,
        };
        triangles.into_iter().for_each(|triangle| {
            patch.push(triangle);
        });
        patch
    }

    /// The positions of a triangle's corners.
    pub fn corners(&self, triangle: usize) -> [DVec3; 3] {
        self.triangles[triangle].map(|point| self.points[point as usize])
    }

    /// True if an edge joins two points, here or outside.
    pub fn is_edge(&self, a: u32, b: u32) -> bool {
        self.beside.contains_key(&key(a, b)) || self.beside.contains_key(&key(b, a)) || self.joined.contains(a, b)
    }

    /// The triangle on the left of an edge, if there is one.
    pub fn left_of(&self, from: u32, to: u32) -> Option<usize> {
        self.beside.get(&key(from, to)).map(|&triangle| triangle as usize)
    }

    /// The corner of a triangle that is on neither end of an edge.
    pub fn opposite(&self, triangle: usize, edge: [u32; 2]) -> u32 {
        let corners = self.triangles[triangle];
        corners
            .into_iter()
            .find(|corner| !edge.contains(corner))
            .unwrap_or(corners[0])
    }

    /// Cuts a triangle into three at a new point inside it.
    pub fn split(&mut self, triangle: usize, at: DVec3) -> u32 {
        let [a, b, c] = self.triangles[triangle];
        let point = self.points.len() as u32;
        self.points.push(at);
        self.put(triangle, [a, b, point]);
        self.push([b, c, point]);
        self.push([c, a, point]);
        point
    }

    /// Replaces the edge between two triangles by the other diagonal of their quadrilateral.
    pub fn flip(&mut self, edge: [u32; 2]) {
        let [a, b] = edge;
        let (Some(left), Some(right)) = (self.left_of(a, b), self.left_of(b, a)) else {
            return;
        };
        let (c, d) = (self.opposite(left, edge), self.opposite(right, edge));
        self.beside.remove(&key(a, b));
        self.beside.remove(&key(b, a));
        self.put(left, [a, d, c]);
        self.put(right, [d, b, c]);
    }

    fn push(&mut self, triangle: [u32; 3]) {
        self.triangles.push(triangle);
        self.put(self.triangles.len() - 1, triangle);
    }

    fn put(&mut self, place: usize, triangle: [u32; 3]) {
        self.triangles[place] = triangle;
        let [a, b, c] = triangle;
        for [from, to] in [[a, b], [b, c], [c, a]] {
            self.beside.insert(key(from, to), place as u32);
        }
    }
}

/// A directed edge as one number.
fn key(from: u32, to: u32) -> u64 {
    u64::from(from) << 32 | u64::from(to)
}

/// Hashes an edge by one multiplication: refining looks edges up a hundred times for each point.
#[derive(Clone, Copy, Debug, Default)]
struct EdgeHasher(u64);

impl Hasher for EdgeHasher {
    fn finish(&self) -> u64 {
        self.0
    }

    fn write(&mut self, bytes: &[u8]) {
        bytes.iter().for_each(|&byte| self.write_u64(u64::from(byte)));
    }

    fn write_u64(&mut self, number: u64) {
        // Fibonacci hashing; the table takes its place from the low bits and a tag from the high ones.
        let product = (self.0 ^ number).wrapping_mul(0x9e37_79b9_7f4a_7c15);
        self.0 = product ^ product >> 32;
    }
}
