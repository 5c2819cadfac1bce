//! Cutting along planes.

use glam::DVec3;
use pliant_mesh::{Drawn, Model, shapes};
use pliant_stitch::{Keep, NewShape, Plane, StitchError, VertexSource};

use crate::made::{genus, noise, with_coloured};

/// Cuts a shape whose vertices have their coordinates as colours.
fn cut(model: &Model, plane: &Plane, keep: Keep) -> Result<NewShape, StitchError> {
    with_coloured(model, |part| NewShape::cut_along(part, plane, keep, &[]))
}

fn as_model(shape: &NewShape) -> Model {
    shapes::model(Drawn {
        positions: shape.positions.clone(),
        triangles: shape.triangles.clone(),
        file_vertex: shape.file_vertices.clone(),
        file_vertex_count: shape.file_vertex_count,
        ..Drawn::default()
    })
}

fn area(model: &Model) -> f64 {
    let triangles = 0..model.surface.triangles.len();
    let areas = triangles.map(|face| {
        let [a, b, c] = model.surface.corners(face);
        0.5 * (b - a).cross(c - a).length()
    });
    areas.sum()
}

/// Both sides together have the surface's area, each is on its own side, and all borders lie on the plane.
#[test]
fn the_sides_of_a_plane_are_the_surface_and_their_borders_lie_on_it() {
    for (name, shape) in shapes::classes() {
        let model = shapes::model(shape);
        let Some(bounds) = model.bounds() else { continue };
        let before = model.topology.boundary_loops().len();
        for k in 0..6 {
            let normal = DVec3::from_array([0, 1, 2].map(|axis| noise(axis, k)));
            // A plane through a vertex, and ones through none.
            let through = match k {
                0 => model.surface.positions[model.surface.triangles[0][0].index()],
                _ => bounds.centre(),
            };
            let plane = Plane::of(normal, normal.dot(through)).unwrap();
            let Ok(upper) = cut(&model, &plane, Keep::Positive) else {
                continue;
            };
            let lower = cut(&model, &plane, Keep::Negative).unwrap();
            let both = as_model(&cut(&model, &plane, Keep::Both).unwrap());
            assert_eq!(both.topology.boundary_loops().len(), before, "{name}");
            let touch = 1e-9 * bounds.diagonal();
            let mut sum = 0.0;
            for (shape, sign) in [(&upper, 1.0), (&lower, -1.0)] {
                for (row, vertex) in shape.vertices.iter().zip(&shape.positions) {
                    let distance = sign * plane.distance(*vertex);
                    assert!(distance >= -touch || !is_used(shape, vertex), "{name}: {distance}");
                    if let VertexSource::New { row, .. } = row {
                        assert!(distance.abs() <= touch, "{name}: {distance}");
                        let values = &shape.values[3 * *row as usize..][..3];
                        assert!(DVec3::from_slice(values).distance(*vertex) <= touch, "{name}");
                    }
                }
                sum += area(&as_model(shape));
            }
            let whole = area(&model);
            assert!((sum - whole).abs() <= 1e-9 * whole, "{name}: {sum} of {whole}");
        }
    }
}

fn is_used(shape: &NewShape, position: &DVec3) -> bool {
    let corners = shape.triangles.iter().flatten();
    corners
        .map(|corner| shape.positions[corner.index()])
        .any(|own| own == *position)
}

/// A plane that opens a closed surface gives borders on the plane alone, and no crack.
#[test]
fn halves_of_a_sphere_and_of_a_torus_have_the_borders_that_the_plane_gives() {
    let count = |shape: Drawn, normal: DVec3, level: f64| {
        let model = shapes::model(shape);
        let plane = Plane::of(normal, level).unwrap();
        [Keep::Positive, Keep::Negative].map(|keep| {
            let half = as_model(&cut(&model, &plane, keep).unwrap());
            let positions = &half.surface.positions;
            let loops = half.topology.boundary_loops();
            let on_border = loops
                .iter()
                .flatten()
                .map(|v| plane.distance(positions[v.index()]).abs());
            assert!(on_border.fold(0.0, f64::max) < 1e-9);
            assert_eq!(
                half.topology.non_manifold_edges() + half.topology.misoriented_edges(),
                0
            );
            (loops.len(), genus(&half))
        })
    };
    assert_eq!(
        count(shapes::icosphere(3), DVec3::new(0.3, 2.0, 0.4), 0.35),
        [(1, 0); 2]
    );
    // Along a ring of vertices and edges, nothing is split.
    assert_eq!(count(shapes::uv_sphere(8, 12), DVec3::Z, 0.0), [(1, 0); 2]);
    let mut torus = shapes::tube(40, 20, 1.0);
    for p in &mut torus.positions {
        let turn = std::f64::consts::TAU * p.z;
        let out = 3.0 + p.x;
        *p = DVec3::new(out * turn.cos(), out * turn.sin(), p.y);
    }
    assert_eq!(count(torus, DVec3::X, 0.1), [(2, 0); 2]);
}

#[test]
fn a_plane_beside_the_surface_is_refused_with_the_levels_to_choose_from() {
    let sphere = shapes::model(shapes::icosphere(2));
    let plane = Plane::of(DVec3::Z * 2.0, 6.0).unwrap();
    let refused = cut(&sphere, &plane, Keep::Positive).unwrap_err();
    assert_eq!(refused, StitchError::PlaneMisses { from: -1.0, to: 1.0 });
    assert!(Plane::of(DVec3::ZERO, 0.0).is_none() && Plane::of(DVec3::X, f64::NAN).is_none());
}
