//! The places where details fold over, and where the base has no room for them.
//!
//! A triangle of the surface should turn with its triangle of the base: with M = (e₁ e₂ n) of the latter, two edges and
//! the unit normal, a rest edge e becomes about M' M⁻¹ e. A triangle is folded if its normal is against the one that
//! this gives.

use glam::DVec3;
use pliant_mesh::point_in_words;
use rayon::prelude::*;

use super::base::Base;
use super::faces::Faces;
use super::frames::SLIMMEST;
use super::triangle_frame::triangle_frame;
use crate::numerical::rows::CHUNK;

/// A triangle of the base has collapsed if it has less than this share of the area of the surface's.
const COLLAPSED: f64 = 0.01;

/// The surface's triangles relative to the base's.
#[derive(Debug)]
pub(crate) struct Folds {
    corners: Vec<[u32; 3]>,
    /// M⁻¹ a × M⁻¹ b of two edges a and b of the surface's triangle; zero if the base's triangle is degenerate.
    areas: Vec<DVec3>,
    /// The surface at each local vertex, relative to the base's centre.
    surface: Vec<DVec3>,
    /// The middles of the surface's triangles whose triangles of the base have collapsed.
    collapsed: Vec<DVec3>,
    centre: DVec3,
}

impl Folds {
    /// Compares the surface with its base.
    pub fn of(base: &Base, faces: &Faces) -> Self {
        let patch = &base.patch;
        let mut surface = patch.rest.clone();
        for (offset, &local) in base.offsets.iter().zip(&patch.rows) {
            surface[local as usize] += *offset;
        }
        let mut collapsed = Vec::new();
        let areas = faces.corners.iter().map(|corners| {
            let [a, b, c] = corners.map(|corner| surface[corner as usize]);
            let [p, q, r] = corners.map(|corner| patch.rest[corner as usize]);
            let own = [b - a, c - a];
            let area = (q - p).cross(r - p).length();
            if area < COLLAPSED * own[0].cross(own[1]).length() {
                collapsed.push((a + b + c) / 3.0);
            }
            let longest = (q - p).length_squared().max((r - p).length_squared());
            match triangle_frame([p, q, r]) {
                Some(frame) if area > SLIMMEST * longest => {
                    let [first, second] = own.map(|edge| frame.inverse() * edge);
                    first.cross(second)
                }
                _ => DVec3::ZERO,
            }
        });
        Self {
            areas: areas.collect(),
            corners: faces.corners.clone(),
            centre: base.centre,
            surface,
            collapsed,
        }
    }

    /// The sentence on the base, if triangles of it have collapsed.
    pub fn on_the_base(&self) -> Option<String> {
        let first = *self.collapsed.first()?;
        let place = point_in_words(first + self.centre);
        Some(format!(
            "the smooth base has lost more than 99% of the area of {} (at {place}), so details there may fold: lower \
             `base_length`, or take `detail` \"deformation-transfer\"",
            triangles(self.collapsed.len())
        ))
    }

    /// The sentence on the surface that `displacements` move, if details have folded over on the `posed` base.
    pub fn on_the_surface(&self, base: &Base, posed: &[DVec3], displacements: &[DVec3]) -> Option<String> {
        let place = |corner: u32| {
            let local = corner as usize;
            self.surface[local] + displacements[base.patch.vertices[local] as usize]
        };
        let is_folded = |(corners, area): (&[u32; 3], &DVec3)| {
            let [p, q, r] = corners.map(|corner| posed[corner as usize]);
            let (first, second) = (q - p, r - p);
            let normal = first.cross(second);
            // M' a' × M' b' with (x, y, z) = a' × b' is z e₁ × e₂ + (x e₂ − y e₁) × n; here times |e₁ × e₂|.
            let across = (second * area.x - first * area.y).cross(normal);
            let expected = normal * (area.z * normal.length()) + across;
            let [a, b, c] = corners.map(place);
            expected.dot((b - a).cross(c - a)) < 0.0
        };
        let pairs = self.corners.par_iter().zip(&self.areas).with_min_len(CHUNK);
        let count = pairs.clone().filter(|pair| is_folded(*pair)).count();
        if count == 0 {
            return None;
        }
        let (corners, _) = pairs.find_first(|pair| is_folded(*pair))?;
        let middle = corners.map(place).iter().sum::<DVec3>() / 3.0;
        Some(format!(
            "details fold over at {} (at {}), where the base bends more sharply than they are high: lower \
             `base_length`, or take `detail` \"deformation-transfer\"",
            triangles(count),
            point_in_words(middle + self.centre)
        ))
    }
}

fn triangles(count: usize) -> String {
    match count {
        1 => "a triangle".to_owned(),
        _ => format!("{count} triangles"),
    }
}
