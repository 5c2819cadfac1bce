//! Remeshing for better triangles: tangential smoothing, Delaunay edge flips, and projection back onto the surface.

use super::mesh::{BOUNDARY, Mesh, in_parallel, next, previous};
use super::solid::Solid;
use super::vector::{Vec3, v};

/// `rounds` of smoothing and flipping; `size` is the mesh's edge length.
///
/// # Errors
/// Names an edge that is not manifold.
pub fn relax(mesh: &mut Mesh, solid: &dyn Solid, size: f64, rounds: usize) -> Result<(), String> {
    for _ in 0..rounds {
        flip_to_delaunay(mesh)?;
        let middles = neighbour_middles(mesh);
        let moved = in_parallel(mesh.positions.len(), |i| {
            let p = mesh.positions[i];
            let normal = slope(solid, p, size).normalized();
            let glide = middles[i] - p;
            project(solid, p + (glide - normal * glide.dot(normal)) * 0.7, size)
        });
        mesh.positions = moved;
    }
    flip_to_delaunay(mesh)?;
    mesh.positions = in_parallel(mesh.positions.len(), |i| {
        (0..3).fold(mesh.positions[i], |p, _| project(solid, p, size))
    });
    Ok(())
}

/// The gradient of the distance at `p`, by finite differences at the corners of a tetrahedron of a quarter edge length.
pub fn slope(solid: &dyn Solid, p: Vec3, size: f64) -> Vec3 {
    let h = size * 0.25;
    let corners = [
        v(1.0, -1.0, -1.0),
        v(-1.0, -1.0, 1.0),
        v(-1.0, 1.0, -1.0),
        v(1.0, 1.0, 1.0),
    ];
    corners
        .iter()
        .fold(Vec3::default(), |sum, &c| sum + c * solid.distance(p + c * h))
        * (0.25 / h)
}

/// One Newton step from `p` to the surface, at most one edge long.
fn project(solid: &dyn Solid, p: Vec3, size: f64) -> Vec3 {
    let g = slope(solid, p, size);
    let square = g.dot(g).max(0.04);
    let step = g * (solid.distance(p) / square);
    let length = step.length();
    p - step * if length > size { size / length } else { 1.0 }
}

/// The mean of each vertex's neighbours.
fn neighbour_middles(mesh: &Mesh) -> Vec<Vec3> {
    let mut sums = vec![(Vec3::default(), 0.0); mesh.positions.len()];
    for triangle in &mesh.triangles {
        for c in 0..3 {
            let (a, b) = (triangle[c] as usize, triangle[(c + 1) % 3] as usize);
            sums[a].0 += mesh.positions[b];
            sums[a].1 += 1.0;
        }
    }
    sums.into_iter()
        .map(|(sum, count)| sum * (1.0 / f64::max(count, 1.0)))
        .collect()
}

/// Flips edges whose opposite angles sum to more than π, in a few sweeps in fixed order.
fn flip_to_delaunay(mesh: &mut Mesh) -> Result<(), String> {
    let mut opposite = mesh.opposites()?;
    for _ in 0..3 {
        let mut flips = 0;
        for h in 0..opposite.len() as u32 {
            let o = opposite[h as usize];
            if o != BOUNDARY && h < o && wants_flip(mesh, h, o) && !joined(mesh, &opposite, h, o) {
                flip(mesh, &mut opposite, h, o);
                flips += 1;
            }
        }
        if flips == 0 {
            break;
        }
    }
    Ok(())
}

/// The start vertex of half-edge `h`.
fn start(mesh: &Mesh, h: u32) -> u32 {
    mesh.triangles[h as usize / 3][h as usize % 3]
}

/// Cotangent of the angle opposite half-edge `h`.
fn cotangent(mesh: &Mesh, h: u32) -> f64 {
    let apex = mesh.positions[start(mesh, previous(h)) as usize];
    let a = mesh.positions[start(mesh, h) as usize] - apex;
    let b = mesh.positions[start(mesh, next(h)) as usize] - apex;
    a.dot(b) / a.cross(b).length().max(1e-30)
}

/// Returns true if the edge is not Delaunay and flipping it causes no fold.
fn wants_flip(mesh: &Mesh, h: u32, o: u32) -> bool {
    if cotangent(mesh, h) + cotangent(mesh, o) >= -1e-6 {
        return false;
    }
    let at = |h: u32| mesh.positions[start(mesh, h) as usize];
    let (a, b, c, d) = (at(h), at(o), at(previous(h)), at(previous(o)));
    let old = (b - a).cross(c - a) + (a - b).cross(d - b);
    (a - c).cross(d - c).dot(old) > 0.0 && (d - c).cross(b - c).dot(old) > 0.0
}

/// Returns true if the two vertices of the flipped edge already share an edge.
fn joined(mesh: &Mesh, opposite: &[u32], h: u32, o: u32) -> bool {
    let far = start(mesh, previous(o));
    let first = previous(h);
    let mut around = first;
    loop {
        if start(mesh, next(around)) == far {
            return true;
        }
        around = opposite[previous(around) as usize];
        if around == BOUNDARY {
            return true;
        }
        if around == first {
            return false;
        }
    }
}

/// Flips the edge of half-edges `h` and `o`.
fn flip(mesh: &mut Mesh, opposite: &mut [u32], h: u32, o: u32) {
    let (hn, hp, on, op) = (next(h), previous(h), next(o), previous(o));
    let (a, b, c, d) = (start(mesh, h), start(mesh, o), start(mesh, hp), start(mesh, op));
    let outer = [
        opposite[hp as usize],
        opposite[on as usize],
        opposite[op as usize],
        opposite[hn as usize],
    ];
    // Triangle of h becomes (c, a, d), that of o (d, b, c); the inner edge is d-c and c-d.
    let (t, u) = (h / 3 * 3, o / 3 * 3);
    mesh.triangles[t as usize / 3] = [c, a, d];
    mesh.triangles[u as usize / 3] = [d, b, c];
    for (half_edge, other) in [
        (t, outer[0]),
        (t + 1, outer[1]),
        (u, outer[2]),
        (u + 1, outer[3]),
        (t + 2, u + 2),
    ] {
        opposite[half_edge as usize] = other;
        if other != BOUNDARY {
            opposite[other as usize] = half_edge;
        }
    }
}
