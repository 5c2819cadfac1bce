//! Sample shapes for tests and examples, each a file that shows its vertices once: closed and open ones, several
//! components, and the broken kinds that occur in real scans.
//!
//! Unless their comment says otherwise, they are manifold and their normals point outward.

use std::collections::BTreeMap;
use std::f64::consts::{FRAC_PI_2, PI, TAU};

use glam::{DAffine3, DVec2, DVec3};

use crate::{Cancel, Drawn, DrawnVertex, FileVertex, Model, Progress, Rounding, WeldOptions};

/// The unit sphere about the origin, poles on z: `rings` (2 or more) bands of `segments` (3 or more).
/// `segments (rings - 1) + 2` vertices.
pub fn uv_sphere(rings: usize, segments: usize) -> Drawn {
    turned(rings, segments, |share| (PI * share).sin_cos().into())
}

/// A surface of revolution about z: `profile` gives its radius and its z from its upper pole (0) to its lower one (1).
/// `rings` (2 or more) bands of `segments` (3 or more). Closed.
pub fn turned(rings: usize, segments: usize, profile: impl Fn(f64) -> DVec2) -> Drawn {
    let mut positions = vec![DVec3::Z * profile(0.0).y];
    for ring in 1..rings {
        let at = profile(ring as f64 / rings as f64);
        positions.extend((0..segments).map(|segment| {
            let (sin, cos) = (TAU * segment as f64 / segments as f64).sin_cos();
            DVec3::new(at.x * cos, at.x * sin, at.y)
        }));
    }
    positions.push(DVec3::Z * profile(1.0).y);
    let last = positions.len() - 1;
    let at = |ring: usize, segment: usize| match ring {
        0 => 0,
        _ if ring == rings => last,
        _ => 1 + (ring - 1) * segments + segment % segments,
    };
    let mut triangles = Vec::new();
    for ring in 0..rings {
        for segment in 0..segments {
            let [a, b] = [at(ring, segment), at(ring, segment + 1)];
            let [c, d] = [at(ring + 1, segment + 1), at(ring + 1, segment)];
            // The first band comes to a point above, the last one below.
            if d != c {
                triangles.push([a, d, c]);
            }
            if a != b {
                triangles.push([a, c, b]);
            }
        }
    }
    drawn(positions, triangles)
}

/// The unit sphere about the origin from an icosahedron, each triangle cut into four `level` times:
/// `10 · 4^level + 2` vertices, nearly equal triangles.
pub fn icosphere(level: u32) -> Drawn {
    let golden = 0.5 * (1.0 + 5.0_f64.sqrt());
    let mut positions = Vec::new();
    for (one, long) in [(1.0, golden), (-1.0, golden), (1.0, -golden), (-1.0, -golden)] {
        positions.extend([
            DVec3::new(0.0, one, long).normalize(),
            DVec3::new(one, long, 0.0).normalize(),
            DVec3::new(long, 0.0, one).normalize(),
        ]);
    }
    // The faces are the triples that are all one edge apart.
    let edge = 2.0 / (1.0 + golden * golden).sqrt();
    let touch = |a: usize, b: usize| (DVec3::distance(positions[a], positions[b]) - edge).abs() < 1e-9;
    let mut triangles: Vec<[usize; 3]> = Vec::new();
    for a in 0..12 {
        for b in a + 1..12 {
            for c in b + 1..12 {
                if touch(a, b) && touch(b, c) && touch(c, a) {
                    let is_outward = positions[a].cross(positions[b]).dot(positions[c]) > 0.0;
                    triangles.push(if is_outward { [a, b, c] } else { [a, c, b] });
                }
            }
        }
    }
    for _ in 0..level {
        let mut middles = BTreeMap::new();
        let mut finer = Vec::with_capacity(4 * triangles.len());
        for [a, b, c] in triangles {
            let [ab, bc, ca] = [[a, b], [b, c], [c, a]].map(|[from, to]| {
                *middles.entry([from.min(to), from.max(to)]).or_insert_with(|| {
                    positions.push((positions[from] + positions[to]).normalize());
                    positions.len() - 1
                })
            });
            finer.extend([[a, ab, ca], [b, bc, ab], [c, ca, bc], [ab, bc, ca]]);
        }
        triangles = finer;
    }
    drawn(positions, triangles)
}

/// The flat sheet [0, 1]² at z = 0, normals along +z: `nx` by `ny` cells of two triangles. One boundary.
pub fn grid(nx: usize, ny: usize) -> Drawn {
    let positions = (0..=ny)
        .flat_map(|y| (0..=nx).map(move |x| DVec3::new(x as f64 / nx as f64, y as f64 / ny as f64, 0.0)))
        .collect();
    drawn(positions, quads(nx, ny, |x, y| y * (nx + 1) + x))
}

/// A flat sheet [-0.5, 0.5]² at z = 0 of `cells` by `cells` cells with half a ball of radius 0.15 about the origin in it:
/// above it, as a nose is, if `side` is 1, and below it, as a socket is, if it is -1. One boundary.
pub fn half_ball(cells: usize, side: f64) -> Drawn {
    const BALL: f64 = 0.15;
    let mut sheet = grid(cells, cells);
    for position in &mut sheet.positions {
        let flat = *position - DVec3::new(0.5, 0.5, 0.0);
        let distance = flat.length();
        let (radius, height) = match distance {
            ..0.25 => {
                let (sin, cos) = (FRAC_PI_2 * distance / 0.25).sin_cos();
                (BALL * sin, BALL * cos)
            }
            0.25..0.5 => (BALL + (distance - 0.25) * (0.5 - BALL) / 0.25, 0.0),
            _ => (distance, 0.0),
        };
        *position = flat.normalize_or_zero() * radius + DVec3::Z * (side * height);
    }
    sheet
}

/// The sheet of [`grid`] with vertices that coincide at random, so that a sixth of the places are left: it is no longer
/// a surface.
pub fn tangle(side: usize) -> Drawn {
    let mut sheet = grid(side, side);
    let mut state = 1_u64;
    let mut random = |below: usize| {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
        (state >> 33) as usize % below
    };
    let all = sheet.positions.clone();
    for position in &mut sheet.positions {
        *position = all[6 * random(all.len() / 6)];
    }
    sheet
}

/// A torus about z, radii 1 and 0.4: `around` by `across` cells. Closed, genus 1.
pub fn torus(around: usize, across: usize) -> Drawn {
    let positions = (0..across)
        .flat_map(|v| {
            let (sin_v, cos_v) = (TAU * v as f64 / across as f64).sin_cos();
            (0..around).map(move |u| {
                let (sin_u, cos_u) = (TAU * u as f64 / around as f64).sin_cos();
                DVec3::new((1.0 + 0.4 * cos_v) * cos_u, (1.0 + 0.4 * cos_v) * sin_u, 0.4 * sin_v)
            })
        })
        .collect();
    drawn(
        positions,
        quads(around, across, |u, v| (v % across) * around + u % around),
    )
}

/// A tube about z from 0 to `length`, radius 1, open at both ends: `around` by `along` cells. Two boundaries.
pub fn tube(around: usize, along: usize, length: f64) -> Drawn {
    let positions = (0..=along)
        .flat_map(|z| {
            (0..around).map(move |u| {
                let (sin, cos) = (TAU * u as f64 / around as f64).sin_cos();
                DVec3::new(cos, sin, length * z as f64 / along as f64)
            })
        })
        .collect();
    drawn(positions, quads(around, along, |u, z| z * around + u % around))
}

/// The box [0, nx] × [0, ny] × [0, nz] with unit cells on its faces. Closed.
pub fn bar(nx: usize, ny: usize, nz: usize) -> Drawn {
    let size = [nx, ny, nz];
    let mut numbers: BTreeMap<[usize; 3], usize> = BTreeMap::new();
    let mut positions = Vec::new();
    let mut triangles = Vec::new();
    for axis in 0..3 {
        let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
        for is_far in [false, true] {
            let mut number = |i: usize, j: usize| {
                let mut at = [0; 3];
                (at[axis], at[u], at[v]) = (if is_far { size[axis] } else { 0 }, i, j);
                *numbers.entry(at).or_insert_with(|| {
                    positions.push(DVec3::from_array(at.map(|c| c as f64)));
                    positions.len() - 1
                })
            };
            for [a, b, c] in quads(size[u], size[v], &mut number) {
                triangles.push(if is_far { [a, b, c] } else { [a, c, b] });
            }
        }
    }
    drawn(positions, triangles)
}

/// `blades` triangles around one edge: with three or more, the edge is non-manifold.
pub fn non_manifold_fan(blades: usize) -> Drawn {
    let mut positions = vec![DVec3::ZERO, DVec3::Z];
    positions.extend((0..blades).map(|blade| {
        let (sin, cos) = (TAU * blade as f64 / blades as f64).sin_cos();
        DVec3::new(cos, sin, 0.5)
    }));
    drawn(positions, (0..blades).map(|blade| [0, 1, 2 + blade]))
}

/// Two tetrahedra that share one corner, which is a non-manifold vertex. Closed.
pub fn bowtie() -> Drawn {
    let mut positions = vec![DVec3::ZERO];
    let mut triangles = Vec::new();
    for sign in [1.0, -1.0] {
        let n = positions.len();
        let ends = [
            DVec3::new(1.0, 0.0, 1.0),
            DVec3::new(-0.5, 0.9, 1.0),
            DVec3::new(-0.5, -0.9, 1.0),
        ];
        // A point reflection turns the winding over twice in three axes: once in all.
        positions.extend(ends.map(|p| sign * p));
        let faces = [[0, n + 1, n], [0, n + 2, n + 1], [0, n, n + 2], [n, n + 1, n + 2]];
        triangles.extend(faces.map(|[a, b, c]| if sign > 0.0 { [a, b, c] } else { [a, c, b] }));
    }
    drawn(positions, triangles)
}

/// `shape` with one of each fault that welding must remove or tolerate: a vertex that is not a number with a triangle
/// at it, a vertex without a triangle, a triangle with two corners in one place, a repeated triangle, and a triangle
/// without area that is joined to the shape by one edge. The shape must have a triangle.
pub fn broken(shape: &Drawn) -> Drawn {
    let mut positions = shape.positions.clone();
    let mut triangles = shape.triangles.clone();
    let [a, b, c] = triangles[0];
    let mut add = |position: DVec3| {
        positions.push(position);
        DrawnVertex(positions.len() as u32 - 1)
    };
    let middle = 0.5 * (shape.positions[a.index()] + shape.positions[b.index()]);
    let [not_a_number, _alone, twin, between] =
        [DVec3::NAN, DVec3::splat(0.3), shape.positions[c.index()], middle].map(&mut add);
    triangles.extend([[a, b, not_a_number], [b, c, twin], [b, c, a], [b, a, between]]);
    Drawn::once(positions, triangles)
}

/// Every triangle of `shape` with three corners of its own, as an STL has them.
pub fn soup(shape: &Drawn) -> Drawn {
    let positions = shape
        .triangles
        .iter()
        .flatten()
        .map(|v| shape.positions[v.index()])
        .collect();
    drawn(
        positions,
        (0..shape.triangles.len()).map(|t| [3 * t, 3 * t + 1, 3 * t + 2]),
    )
}

/// Several shapes in one file, one after the other.
pub fn together(parts: &[Drawn]) -> Drawn {
    let mut all = Drawn::default();
    for part in parts {
        let (drawn, file) = (all.positions.len() as u32, all.file_vertex_count as u32);
        all.positions.extend(&part.positions);
        all.triangles
            .extend(part.triangles.iter().map(|t| t.map(|v| DrawnVertex(v.0 + drawn))));
        all.file_vertex
            .extend(part.file_vertex.iter().map(|v| FileVertex(v.0 + file)));
        all.file_vertex_count += part.file_vertex_count;
        all.roundings.extend(part.roundings.iter().map(|run| Rounding {
            vertices: run.vertices.start + drawn..run.vertices.end + drawn,
            ..*run
        }));
    }
    all
}

/// `shape` moved by `motion`, which must not mirror.
pub fn moved(shape: &Drawn, motion: DAffine3) -> Drawn {
    let positions = shape.positions.iter().map(|&p| motion.transform_point3(p)).collect();
    Drawn {
        positions,
        ..shape.clone()
    }
}

/// One small shape of each class, by name, for laws that hold on all of them.
pub fn classes() -> Vec<(&'static str, Drawn)> {
    let apart = |shape: Drawn, x: f64| moved(&shape, DAffine3::from_translation(DVec3::new(x, 0.0, 0.0)));
    vec![
        ("closed sphere", icosphere(2)),
        ("closed sphere with poles", uv_sphere(8, 12)),
        ("closed torus", torus(20, 10)),
        ("closed bar", bar(8, 2, 1)),
        ("open sheet", grid(7, 9)),
        ("open tube", tube(10, 6, 4.0)),
        (
            "several components",
            together(&[icosphere(1), apart(grid(4, 4), 3.0), apart(torus(8, 6), 8.0)]),
        ),
        ("non-manifold edge", non_manifold_fan(5)),
        ("non-manifold vertex", bowtie()),
        ("broken", broken(&icosphere(1))),
        ("soup", soup(&uv_sphere(5, 7))),
        (
            "far from the origin",
            moved(&icosphere(2), DAffine3::from_translation(DVec3::new(4e5, 5e6, 30.0))),
        ),
    ]
}

/// `drawn`, welded with the program's defaults.
pub fn model(drawn: Drawn) -> Model {
    // No one else has the cancel flag, so the default is never used.
    Model::weld(drawn, &WeldOptions::default(), &Progress::new(), &Cancel::new()).unwrap_or_default()
}

/// Two triangles for each of `nu` by `nv` cells, `number` giving the vertex at a cell's corner.
fn quads(nu: usize, nv: usize, mut number: impl FnMut(usize, usize) -> usize) -> Vec<[usize; 3]> {
    let mut triangles = Vec::with_capacity(2 * nu * nv);
    for v in 0..nv {
        for u in 0..nu {
            let [a, b, c, d] = [number(u, v), number(u + 1, v), number(u + 1, v + 1), number(u, v + 1)];
            triangles.extend([[a, b, c], [a, c, d]]);
        }
    }
    triangles
}

fn drawn(positions: Vec<DVec3>, triangles: impl IntoIterator<Item = [usize; 3]>) -> Drawn {
    let triangles = triangles
        .into_iter()
        .map(|t| t.map(|v| DrawnVertex(v as u32)))
        .collect();
    Drawn::once(positions, triangles)
}
