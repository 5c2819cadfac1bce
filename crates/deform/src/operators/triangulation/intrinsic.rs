//! Intrinsic triangulations: triangles given by their edges' lengths alone.
//!
//! [`Intrinsic::delaunay`] flips edges of the surface within the surface until opposite angles add up to at most 180°
//! ([FSBS06]; [SC20], section 4): no cotangent weight is negative then, and the surface is the same to the last point.
//! Edges at a border or with more than two triangles stay. [`Intrinsic::tufted`] first covers the surface twice, so
//! that every edge has exactly two triangles (see `tufted`): then this holds for all triangles.
//!
//! Lengths are mollified first, by the same amount over a whole component, so that an edge has one length on both
//! sides.

use pliant_mesh::SurfaceVertex;

use crate::numerical::lists::Lists;
use crate::operators::mollification::lack;
use crate::operators::triangulation::flips::{Sides, flip_to_delaunay};
use crate::operators::triangulation::surface::SurfaceTriangulation;
use crate::operators::triangulation::tufted::{cover, edges};

/// An intrinsic triangulation of a surface's vertices.
#[derive(Clone, Debug)]
pub(crate) struct Intrinsic {
    sides: Sides,
    neighbours: Lists<SurfaceVertex>,
    faces: Lists<u32>,
    share: f64,
    mollified_faces: usize,
    is_delaunay: bool,
}

impl Intrinsic {
    /// The surface's triangles, flipped.
    pub fn delaunay(triangulation: &SurfaceTriangulation) -> Self {
        let (lengths, mollified_faces) = mollified_lengths(triangulation);
        let mut sides = Sides::new(triangulation.surface.triangles.clone(), lengths);
        for edge in edges(triangulation) {
            if let [one, other] = edge[..] {
                sides.join(one, other);
            }
        }
        Self::finished(triangulation, sides, 1.0, mollified_faces)
    }

    /// The surface's tufted cover, flipped.
    pub fn tufted(triangulation: &SurfaceTriangulation) -> Self {
        let (lengths, mollified_faces) = mollified_lengths(triangulation);
        Self::finished(triangulation, cover(triangulation, &lengths), 0.5, mollified_faces)
    }

    fn finished(triangulation: &SurfaceTriangulation, mut sides: Sides, share: f64, mollified_faces: usize) -> Self {
        let is_delaunay = flip_to_delaunay(&mut sides);
        let count = triangulation.surface.positions.len();
        let (mut corners, mut ends) = (Vec::new(), Vec::new());
        for face in 0..sides.face_count() as u32 {
            let [a, b, c] = sides.corners(face);
            corners.extend([(a, face), (b, face), (c, face)]);
            for (from, to) in [(a, b), (b, c), (c, a)] {
                if from != to {
                    ends.extend([(from, to), (to, from)]);
                }
            }
        }
        Self {
            sides,
            neighbours: sorted_lists(count, ends),
            faces: sorted_lists(count, corners),
            share,
            mollified_faces,
            is_delaunay,
        }
    }

    pub fn vertex_count(&self) -> usize {
        self.faces.len()
    }

    pub fn face_count(&self) -> usize {
        self.sides.face_count()
    }

    /// The vertices that share an edge with this one, ascending.
    pub fn neighbours(&self, vertex: SurfaceVertex) -> &[SurfaceVertex] {
        self.neighbours.at(vertex.index())
    }

    /// The triangles around a vertex, each once, ascending.
    pub fn faces(&self, vertex: SurfaceVertex) -> &[u32] {
        self.faces.at(vertex.index())
    }

    pub fn corners(&self, face: u32) -> [SurfaceVertex; 3] {
        self.sides.corners(face)
    }

    /// Entry `i` is the edge opposite corner `i`.
    pub fn lengths(&self, face: u32) -> [f64; 3] {
        self.sides.lengths(face)
    }

    /// One over the number of times by which the triangles cover the surface.
    pub fn share(&self) -> f64 {
        self.share
    }

    /// The number of the surface's triangles that were too flat.
    pub fn mollified_faces(&self) -> usize {
        self.mollified_faces
    }

    /// Returns true if no edge remains to be flipped.
    pub fn is_delaunay(&self) -> bool {
        self.is_delaunay
    }
}

/// The triangles' lengths, mollified by the amount that the flattest triangle of each component needs, and the number
/// of triangles that need it.
fn mollified_lengths(triangulation: &SurfaceTriangulation) -> (Vec<[f64; 3]>, usize) {
    let mut lengths: Vec<[f64; 3]> = (0..triangulation.surface.triangles.len() as u32)
        .map(|face| triangulation.lengths(face))
        .collect();
    let component = |face: usize| {
        triangulation
            .topology
            .component(triangulation.surface.triangles[face][0]) as usize
    };
    let mut lacks = vec![0.0_f64; triangulation.topology.components().len()];
    let mut count = 0;
    for (face, lengths) in lengths.iter().enumerate() {
        let lack = lack(*lengths);
        if lack > 0.0 {
            count += 1;
            lacks[component(face)] = lacks[component(face)].max(lack);
        }
    }
    for (face, lengths) in lengths.iter_mut().enumerate() {
        *lengths = lengths.map(|length| length + lacks[component(face)]);
    }
    (lengths, count)
}

/// A list for each vertex, of pairs in any order; each list is sorted and without repeats.
fn sorted_lists<T: Copy + Default + Ord>(count: usize, mut pairs: Vec<(SurfaceVertex, T)>) -> Lists<T> {
    pairs.sort_unstable();
    pairs.dedup();
    Lists::of(count, pairs.iter().map(|(vertex, entry)| (vertex.0, *entry)))
}

#[cfg(test)]
mod tests {
    use glam::{DAffine3, DVec3};
    use pliant_mesh::{Drawn, Model, shapes};

    use super::Intrinsic;
    use crate::operators::triangulation::Triangulation;
    use crate::operators::triangulation::surface::SurfaceTriangulation;
    use crate::{Discretisation, Laplacian, TriangulationKind};

    fn laplacian(model: &Model, triangulation: TriangulationKind) -> Laplacian {
        let own = SurfaceTriangulation {
            surface: &model.surface,
            topology: &model.topology,
            stretches: Vec::new(),
        };
        let triangulation = match triangulation {
            TriangulationKind::AsIs => Triangulation::Surface(own),
            TriangulationKind::IntrinsicDelaunay => {
                Triangulation::Intrinsic(Box::new(Intrinsic::delaunay(&own)), &model.topology)
            }
            TriangulationKind::Tufted => Triangulation::Intrinsic(Box::new(Intrinsic::tufted(&own)), &model.topology),
        };
        assert_eq!(triangulation.warning(), None);
        let count = model.surface.positions.len();
        let rows: Vec<u32> = (0..count as u32).collect();
        Laplacian::on(
            &triangulation,
            &vec![1.0; count],
            &rows,
            Discretisation::CotangentArea,
            &|_, _| 1.0,
        )
    }

    fn least_weight(laplacian: &Laplacian) -> f64 {
        let rows = 0..laplacian.vertices().len();
        rows.flat_map(|row| laplacian.weights(row))
            .copied()
            .fold(f64::INFINITY, f64::min)
    }

    /// The surface sheared until most triangles are obtuse.
    fn sheared(drawn: Drawn) -> Drawn {
        let mut shear = DAffine3::IDENTITY;
        shear.matrix3.y_axis = DVec3::new(2.3, 1.0, 0.4);
        shapes::moved(&drawn, shear)
    }

    /// The difference of two operators on a rough field, relative to the larger result.
    fn agree(one: &Laplacian, other: &Laplacian, tolerance: f64) -> bool {
        let count = one.vertices().len();
        let field: Vec<[f64; 1]> = (0..count).map(|v| [((v * 7919) % 1009) as f64 / 1009.0]).collect();
        (0..count).all(|v| {
            let ([a], [b]) = (one.row(v, &field), other.row(v, &field));
            let scale = one.weights(v).iter().map(|weight| weight.abs()).sum::<f64>();
            let areas = [one, other].map(|laplacian| laplacian.inverse_areas()[v]);
            (a - b).abs() <= tolerance * scale && (areas[0] / areas[1] - 1.0).abs() < tolerance
        })
    }

    #[test]
    fn no_weight_of_the_tufted_cover_is_negative_on_any_class() {
        for (name, drawn) in shapes::classes() {
            for drawn in [drawn.clone(), sheared(drawn)] {
                let least = least_weight(&laplacian(&shapes::model(drawn), TriangulationKind::Tufted));
                assert!(least > -1e-8, "{name}: {least:e}");
            }
        }
    }

    #[test]
    fn flips_leave_no_negative_weight_where_every_edge_has_two_triangles() {
        for drawn in [
            shapes::icosphere(3),
            shapes::torus(14, 9),
            shapes::bar(3, 2, 7),
            shapes::uv_sphere(9, 14),
        ] {
            let model = shapes::model(sheared(drawn));
            assert!(least_weight(&laplacian(&model, TriangulationKind::AsIs)) < -0.1);
            let flipped = laplacian(&model, TriangulationKind::IntrinsicDelaunay);
            assert!(least_weight(&flipped) > -1e-8);
            // A closed surface's cover is the surface twice.
            assert!(agree(&flipped, &laplacian(&model, TriangulationKind::Tufted), 1e-6));
        }
    }

    #[test]
    fn triangles_that_are_delaunay_keep_their_weights() {
        for drawn in [shapes::icosphere(3), shapes::tube(16, 24, 6.0)] {
            let model = shapes::model(drawn);
            let own = laplacian(&model, TriangulationKind::AsIs);
            assert!(agree(
                &own,
                &laplacian(&model, TriangulationKind::IntrinsicDelaunay),
                1e-12
            ));
        }
    }

    #[test]
    fn flips_keep_the_surface_linear_functions_stay_harmonic_on_a_sheared_sheet() {
        for triangulation in TriangulationKind::ALL {
            let model = shapes::model(sheared(shapes::grid(12, 12)));
            let laplacian = laplacian(&model, triangulation);
            let field: Vec<[f64; 3]> = model.surface.positions.iter().map(|p| p.to_array()).collect();
            let mut area = 0.0;
            for v in 0..field.len() {
                area += laplacian.inverse_areas()[v].recip();
                // The tufted cover continues around a border, where it is no plane.
                let is_flat = triangulation != TriangulationKind::Tufted
                    && !model.topology.is_boundary_vertex(pliant_mesh::SurfaceVertex(v as u32));
                if !is_flat {
                    continue;
                }
                assert!(
                    laplacian.row(v, &field).iter().all(|value| value.abs() < 1e-9),
                    "{triangulation:?}"
                );
            }
            let exact: f64 = pliant_mesh::face_areas(&model.surface, &model.surface.positions)
                .iter()
                .sum();
            assert!((area / exact - 1.0).abs() < 1e-9, "{triangulation:?} {area} {exact}");
        }
    }
}
