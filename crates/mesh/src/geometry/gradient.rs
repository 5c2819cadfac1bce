//! Deformation gradients of triangles.

use glam::{DMat3, DVec3};

use crate::geometry::area_vector;

/// The linear map that takes the rest triangle's edges to the deformed one's and its unit normal to the deformed one's
/// (Sumner and Popović 2004, equation 4, with the normal kept a unit). The identity if either has no area.
///
/// It describes the whole deformation at this triangle; a rigid motion gives its rotation. Tangents are transformed by
/// it, normals by its inverse transpose.
pub fn face_gradient(rest: [DVec3; 3], deformed: [DVec3; 3]) -> DMat3 {
    let (Some(rest), Some(deformed)) = (Frame::of(rest), Frame::of(deformed)) else {
        return DMat3::IDENTITY;
    };
    let ([e1, e2], n) = (rest.edges, rest.normal);
    let ([d1, d2], m) = (deformed.edges, deformed.normal);
    // The basis dual to (e1, e2, n): g1·e1 = 1, g1·e2 = 0, g1·n = 0 and so on.
    let (g1, g2) = (e2.cross(n) / rest.double_area, n.cross(e1) / rest.double_area);
    let column = |axis: usize| d1 * g1[axis] + d2 * g2[axis] + m * n[axis];
    DMat3::from_cols(column(0), column(1), column(2))
}

/// Two edges of a triangle, its unit normal and twice its area.
struct Frame {
    edges: [DVec3; 2],
    normal: DVec3,
    double_area: f64,
}

impl Frame {
    /// The frame of a triangle that has an area.
    fn of([a, b, c]: [DVec3; 3]) -> Option<Self> {
        let (area_vector, double_area) = area_vector([a, b, c])?;
        Some(Self {
            edges: [b - a, c - a],
            normal: area_vector / double_area,
            double_area,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::face_normal;
    use glam::{DAffine3, DQuat};

    const REST: [DVec3; 3] = [
        DVec3::new(1.0, 0.2, -0.5),
        DVec3::new(1.3, 0.1, -0.4),
        DVec3::new(0.9, 0.8, -0.1),
    ];

    #[test]
    fn a_rigid_motion_gives_its_rotation() {
        let rotation = DQuat::from_axis_angle(DVec3::new(1.0, 2.0, -1.0).normalize(), 2.1);
        let motion = DAffine3::from_rotation_translation(rotation, DVec3::new(3.0, -7.0, 1.0));
        let gradient = face_gradient(REST, REST.map(|p| motion.transform_point3(p)));
        assert!(gradient.abs_diff_eq(DMat3::from_quat(rotation), 1e-12));
    }

    #[test]
    fn edges_and_normals_go_where_they_went() {
        let deformed = [DVec3::ZERO, DVec3::new(0.0, 2.0, 0.0), DVec3::new(0.1, 0.0, -3.0)];
        let gradient = face_gradient(REST, deformed);
        let edges = |[a, b, c]: [DVec3; 3]| [b - a, c - a, face_normal([a, b, c])];
        for (from, to) in edges(REST).into_iter().zip(edges(deformed)) {
            assert!((gradient * from).abs_diff_eq(to, 1e-12));
        }
    }

    #[test]
    fn a_triangle_without_area_tells_nothing() {
        let line = [DVec3::ZERO, DVec3::X, 2.0 * DVec3::X];
        assert_eq!(face_gradient(line, REST), DMat3::IDENTITY);
        assert_eq!(face_gradient(REST, line), DMat3::IDENTITY);
    }
}
