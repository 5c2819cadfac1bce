//! The damage of a deformation, counted, each kind with a place.

use glam::DVec3;

use super::distortion::flipped;
use super::face_area;
use crate::surface::corners;
use crate::{Surface, Topology};

/// An edge shorter than this share of its rest length has collapsed, and one longer than its inverse is torn out.
const SHRUNK: f64 = 0.01;

/// A triangle of less than this share of its area has collapsed.
const COLLAPSED: f64 = 0.01;

/// The count of a kind of damage, and its first place.
#[derive(Clone, Copy, PartialEq, Debug, Default)]
pub struct Damaged {
    /// The count.
    pub count: usize,
    /// The middle of the first of them, as deformed, in world units.
    pub place: Option<DVec3>,
}

/// The damage of a deformation.
#[derive(Clone, Copy, PartialEq, Debug, Default)]
pub struct Damage {
    /// Triangles that turned over, as [`crate::Distortion::flipped_faces`] counts them.
    pub flipped: Damaged,
    /// Edges shorter than a hundredth of their rest length.
    pub shrunk: Damaged,
    /// Edges longer than a hundred times their rest length.
    pub stretched: Damaged,
    /// Triangles of less than a hundredth of their area.
    pub collapsed: Damaged,
}

impl Damaged {
    fn add(&mut self, points: &[DVec3]) {
        self.count += 1;
        let middle = || points.iter().sum::<DVec3>() / points.len() as f64;
        self.place.get_or_insert_with(middle);
    }

    /// "3 triangles (the first at 0.1 0.2 0.3) .."; `None` if there are none.
    fn told(&self, [one, many]: [&str; 2], predicate: &str) -> Option<String> {
        let place = self.place?;
        let (noun, first) = if self.count == 1 {
            (one, "at")
        } else {
            (many, "the first at")
        };
        Some(format!(
            "{} {noun} ({first} {}) {predicate}",
            self.count,
            point_in_words(place)
        ))
    }
}

/// A point for a sentence, to about four digits for a mesh of any size.
///
/// ```
/// use glam::dvec3;
/// use pliant_mesh::point_in_words;
///
/// assert_eq!(point_in_words(dvec3(1.0, -0.25, 30.0)), "1.0000 -0.2500 30.0000");
/// assert_eq!(point_in_words(dvec3(1e-9, 0.0, -2.5e-8)), "1.000e-9 0.000e0 -2.500e-8");
/// ```
pub fn point_in_words(point: DVec3) -> String {
    let DVec3 { x, y, z } = point;
    match point.abs().max_element() {
        0.0 | 0.01..1e6 => format!("{x:.4} {y:.4} {z:.4}"),
        _ => format!("{x:.3e} {y:.3e} {z:.3e}"),
    }
}

impl Damage {
    /// Compares `surface` with its vertices moved to `deformed` (one position each).
    pub fn of(surface: &Surface, topology: &Topology, deformed: &[DVec3]) -> Self {
        let mut damage = Self::default();
        for (triangle, is_flipped) in surface.triangles.iter().zip(flipped(surface, topology, deformed)) {
            let now = corners(*triangle, deformed);
            if is_flipped {
                damage.flipped.add(&now);
            }
            let rest = face_area(corners(*triangle, &surface.positions));
            if face_area(now) < COLLAPSED * rest {
                damage.collapsed.add(&now);
            }
        }
        for [a, b] in topology.edges() {
            let length = |positions: &[DVec3]| positions[a.index()].distance(positions[b.index()]);
            let (rest, now) = (length(&surface.positions), length(deformed));
            let ends = [deformed[a.index()], deformed[b.index()]];
            if now < SHRUNK * rest {
                damage.shrunk.add(&ends);
            } else if rest > 0.0 && SHRUNK * now > rest {
                damage.stretched.add(&ends);
            }
        }
        damage
    }

    /// A sentence for each kind that occurs, which ends with the remedy.
    pub fn sentences(&self, remedy: &str) -> Vec<String> {
        let told = [
            self.flipped.told(["triangle", "triangles"], "turned over"),
            self.collapsed
                .told(["triangle", "triangles"], "lost more than 99% of the area"),
            self.shrunk
                .told(["edge", "edges"], "shrank to less than a hundredth of the length"),
            self.stretched
                .told(["edge", "edges"], "grew to more than a hundred times the length"),
        ];
        let each = told.into_iter().flatten();
        each.map(|told| format!("{told}: {remedy}")).collect()
    }
}

#[cfg(test)]
mod tests {
    use glam::{DAffine3, DVec3};

    use super::Damage;
    use crate::{SurfaceVertex, shapes};

    #[test]
    fn what_is_rigid_is_whole_and_each_fault_is_told_with_its_place() {
        let model = shapes::model(shapes::grid(6, 6));
        let (surface, topology) = (&model.surface, &model.topology);
        let motion = DAffine3::from_rotation_x(1.0) * DAffine3::from_translation(DVec3::splat(3.0));
        let rigid: Vec<DVec3> = surface.positions.iter().map(|p| motion.transform_point3(*p)).collect();
        let whole = Damage::of(surface, topology, &rigid);
        assert_eq!(whole, Damage::default());
        assert!(whole.sentences("").is_empty());

        let inner = (0..surface.positions.len() as u32)
            .map(SurfaceVertex)
            .find(|&v| !topology.is_boundary_vertex(v));
        let inner = inner.map(SurfaceVertex::index).unwrap_or_default();
        let beside = topology.neighbours(SurfaceVertex(inner as u32))[0].index();
        let with = |place: DVec3| {
            let mut deformed = surface.positions.clone();
            deformed[inner] = place;
            Damage::of(surface, topology, &deformed)
        };
        let collapsed = with(surface.positions[beside]);
        assert!(collapsed.shrunk.count == 1 && collapsed.collapsed.count >= 2);
        assert_eq!(collapsed.shrunk.place, Some(surface.positions[beside]));
        let far = with(surface.positions[inner] + DVec3::Z * 100.0);
        assert_eq!(
            far.stretched.count,
            topology.neighbours(SurfaceVertex(inner as u32)).len()
        );
        let over = with(surface.positions[inner] + DVec3::X * 0.4);
        assert!(over.flipped.count > 0);
        assert_eq!(over.sentences("").len(), 1, "{:?}", over.sentences(""));
    }
}
