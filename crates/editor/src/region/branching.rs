//! Whether a handle is on a limb: whether the surface around it goes on in more than one direction.
//!
//! The lines at equal distances from a handle on a nose, at the end of a tail or on a sheet are one loop each. Around an arm
//! a line closes behind the arm and becomes two loops, one towards the hand and one towards the body: the Reeb graph of
//! the distance branches there [HSKK01]. Here the surface is cut into shells between lines, and a shell of several
//! pieces which cross it is such a branch. A piece that does not cross its shell is the far side of a bump.

use pliant_mesh::{Surface, SurfaceVertex, Topology, face_area};

/// The thickness of a shell, in radii of the handle.
const SHELL_RADII: f64 = 0.5;

/// The least thickness of a shell, in mean edges: a thinner one falls to pieces.
const SHELL_EDGES: f64 = 2.5;

/// A piece crosses its shell if it comes so near to both sides, as a share of the thickness.
const NEAR_SIDE: f64 = 0.35;

/// A shell branches if its second largest piece has at least this share of its largest piece's area.
const BRANCH_SHARE: f64 = 0.2;

/// Returns true if the surface around a handle of this radius branches. `reached` are vertices around the handle with
/// their distances, in world units, and `distances` is scratch memory of one NaN a vertex.
pub(super) fn is_on_limb(
    surface: &Surface,
    topology: &Topology,
    reached: &[(SurfaceVertex, f64)],
    distances: &mut [f64],
    radius: f64,
) -> bool {
    for &(vertex, distance) in reached {
        distances[vertex.index()] = distance;
    }
    let thickness = (SHELL_RADII * radius).max(SHELL_EDGES * mean_edge(surface, topology, reached));
    // The areas of the largest two pieces of each shell.
    let mut largest: Vec<[f64; 2]> = Vec::new();
    let mut front = Vec::new();
    for &(seed, distance) in reached {
        if distances[seed.index()].is_nan() {
            continue;
        }
        let shell = shell_of(distance, thickness);
        let (mut area, mut nearest, mut farthest) = (0.0, f64::INFINITY, 0.0_f64);
        front.push((seed, distance));
        distances[seed.index()] = f64::NAN;
        while let Some((vertex, distance)) = front.pop() {
            area += area_around(surface, topology, vertex);
            (nearest, farthest) = (nearest.min(distance), farthest.max(distance));
            for &other in topology.neighbours(vertex) {
                let distance = distances[other.index()];
                // Never true of NaN.
                if distance >= 0.0 && shell_of(distance, thickness) == shell {
                    distances[other.index()] = f64::NAN;
                    front.push((other, distance));
                }
            }
        }
        let (inner, outer) = (shell as f64 * thickness, (shell + 1) as f64 * thickness);
        if nearest <= inner + NEAR_SIDE * thickness && farthest >= outer - NEAR_SIDE * thickness {
            largest.resize(largest.len().max(shell + 1), [0.0; 2]);
            let [first, second] = &mut largest[shell];
            (*first, *second) = (first.max(area), second.max(area.min(*first)));
        }
    }
    largest
        .iter()
        .any(|[first, second]| *second > 0.0 && *second >= BRANCH_SHARE * first)
}

fn shell_of(distance: f64, thickness: f64) -> usize {
    (distance / thickness) as usize
}

/// The mean edge around some vertices.
fn mean_edge(surface: &Surface, topology: &Topology, reached: &[(SurfaceVertex, f64)]) -> f64 {
    let position = |v: SurfaceVertex| surface.positions[v.index()];
    let edges = reached.iter().flat_map(|&(vertex, _)| {
        let lengths = topology.neighbours(vertex).iter();
        lengths.map(move |&other| position(vertex).distance(position(other)))
    });
    let (sum, count) = edges.fold((0.0, 0.0_f64), |(sum, count), length| (sum + length, count + 1.0));
    sum / count.max(1.0)
}

/// A vertex's share of the triangles around it.
fn area_around(surface: &Surface, topology: &Topology, vertex: SurfaceVertex) -> f64 {
    let corners = |face: u32| surface.triangles[face as usize].map(|v| surface.positions[v.index()]);
    let faces = topology.faces(vertex, &surface.triangles);
    faces.map(|face| face_area(corners(face)) / 3.0).sum()
}
