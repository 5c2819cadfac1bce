//! Texture coordinates on patches.

use pliant_deform::Budget;
use pliant_mesh::{Cancel, Drawn, DrawnVertex, Progress, shapes};
use pliant_stitch::{Age, Attributes, Holes, NewShape, Part, VertexSource, fill};

use crate::made::{model, without};

/// A seam at every vertex of the rim: each triangle of the patch continues the chart of the edge that it belongs to,
/// and none of its corners is of another.
#[test]
fn a_triangle_of_a_patch_has_the_chart_of_one_edge_of_the_rim() {
    let ball = without(&shapes::icosphere(4), |p| p.z > 0.8);
    // Every triangle has vertices of its own, and its number as their texture coordinate.
    let corners = ball.triangles.iter().flatten();
    let positions: Vec<_> = corners.map(|corner| ball.positions[corner.index()]).collect();
    let triangles = (0..ball.triangles.len() as u32).map(|t| [0, 1, 2].map(|k| DrawnVertex(3 * t + k)));
    let open = model(Drawn::once(positions, triangles.collect()));
    let drawn = open.rest();
    let chart = |vertex: DrawnVertex| f64::from(vertex.0 / 3);
    let part = Part {
        model: &open,
        drawn: &drawn,
        group: &|_| 0,
        attributes: Attributes {
            charted: 1,
            blended: 1,
            value: &|vertex, channel| {
                if channel == 0 {
                    chart(vertex)
                } else {
                    drawn.positions[vertex.index()].z
                }
            },
        },
        normals: None,
    };
    let filled = fill(&open, Holes::Every, Budget::default(), &Progress::new(), &Cancel::new()).unwrap();
    let shape = NewShape::filled(&part, &filled, Budget::default(), &Cancel::new()).unwrap();
    let number = |corner: DrawnVertex| match shape.vertices[corner.index()] {
        VertexSource::Old { vertex, .. } => chart(vertex),
        VertexSource::New { row, .. } => shape.values[2 * row as usize],
    };
    let mut charts = std::collections::BTreeSet::new();
    let sources = shape.triangle_sources.iter().zip(&shape.triangles);
    for (source, corners) in sources.filter(|(source, _)| source.age == Age::New) {
        for &corner in corners {
            assert!((number(corner) - f64::from(source.triangle)).abs() < 1e-6);
        }
        charts.insert(source.triangle);
    }
    // A triangle with two edges of the rim has the chart of one of them.
    assert!(2 * charts.len() > filled.holes[0].borders[0].vertices.len());
    // Colours have no seams.
    let range = filled.holes[0].borders[0]
        .vertices
        .iter()
        .map(|v| open.surface.positions[v.index()].z);
    let (low, high) = range.fold((f64::MAX, f64::MIN), |(low, high), z| (low.min(z), high.max(z)));
    let heights = shape.values.chunks(2).map(|row| row[1]);
    assert!(heights.into_iter().all(|z| z > low - 1e-9 && z < high + 1e-9));
}
