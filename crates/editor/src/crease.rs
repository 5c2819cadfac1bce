//! The surface beside a curve without its crease, and so the crease itself.
//!
//! [NSAC05] sharpens a feature by a weight on the Laplacians along it. Here the Laplacians of the surface beside the curve
//! become 1 + w times what they are at rest, with positions and tangents held around it: L M⁻¹ L d = w L M⁻¹ L p for the
//! displacements d of the positions p. The fairest surface q over the same vertices has L M⁻¹ L q = 0, so d = w (p − q): w
//! = −1 is that surface, in which a fold has become a round fillet, and other weights lie on the line through both. The
//! vertices beside the curve get places of their own, not those of the line alone: a method that joins its handles
//! smoothly would lift a ridge's surroundings with it, and the angle at the ridge would stay. The two rings around them,
//! which stay, are the handle's too, so that the tangents are held by every method.

use glam::DVec3;
use pliant_deform::{BilaplacianOrder, Budget, fair};
use pliant_mesh::{Cancel, Curve, DistanceSearch, Surface, SurfaceVertex, Topology};

/// The rings around the vertices beside a curve that stay.
const RINGS: usize = 2;

/// The way from the fairest surface to the surface itself for those of a handle's `vertices`, ascending, that are beside the
/// curve.
///
/// # Errors
/// A sentence without its subject, the crease: there are no such vertices, they are a whole part of the surface, or
/// [`fair`] fails.
pub(crate) fn details(
    surface: &Surface,
    vertices: &[usize],
    is_beside: impl Fn(usize) -> bool,
) -> Result<Vec<(usize, DVec3)>, String> {
    let free: Vec<usize> = inner(surface, vertices).into_iter().filter(|v| is_beside(*v)).collect();
    let Some(&first) = free.first() else {
        return Err(
            "has no vertex of the handle with two rings of others around it: make it wider, or select more vertices"
                .to_owned(),
        );
    };
    let mut patch = Patch::around(surface, &free);
    let centre = surface.positions[first];
    let positions = || patch.vertices.iter().map(|v| surface.positions[*v]);
    let mut values: Vec<[f64; 3]> = positions().map(|p| (p - centre).to_array()).collect();
    let own = Surface {
        positions: positions().collect(),
        triangles: std::mem::take(&mut patch.triangles),
    };
    let topology = Topology::of(&own);
    // A border would shrink: nothing beyond it holds it.
    patch.free.retain(|v| !topology.is_boundary_vertex(SurfaceVertex(*v)));
    let is_free = |v: SurfaceVertex| patch.free.binary_search(&v.0).is_ok();
    let mut parts = 0..topology.components().len() as u32;
    if parts.any(|part| topology.vertices_of(part).all(is_free)) {
        return Err("covers a whole part of the surface: make its width smaller".to_owned());
    }
    let (order, budget) = (BilaplacianOrder::ThinPlate, Budget::default());
    fair(&own, &topology, &patch.free, order, &mut values, budget, &Cancel::new())
        .map_err(|error| format!("can't be told from its surroundings: {error}"))?;
    let way = |own: &u32| {
        let fair = DVec3::from_array(values[*own as usize]);
        let v = patch.vertices[*own as usize];
        (v, surface.positions[v] - centre - fair)
    };
    Ok(patch.free.iter().map(way).collect())
}

/// The vertices within a width of some others along the surface, and two rings around them, ascending.
pub(crate) fn beside(
    surface: &Surface,
    topology: &Topology,
    position: impl Fn(SurfaceVertex) -> DVec3,
    of: impl Iterator<Item = SurfaceVertex>,
    width: f64,
) -> Vec<SurfaceVertex> {
    let near = distances(surface, topology, position, of, width);
    let is_in = with_rings(topology, near.iter().map(|(vertex, _)| *vertex));
    let numbers = (0..).zip(is_in).filter(|(_, is_in)| *is_in);
    numbers.map(|(vertex, _)| SurfaceVertex(vertex)).collect()
}

/// The vertices within a limit of some others along the surface with their distances, nearest first.
pub(crate) fn distances(
    surface: &Surface,
    topology: &Topology,
    position: impl Fn(SurfaceVertex) -> DVec3,
    of: impl Iterator<Item = SurfaceVertex>,
    limit: f64,
) -> Vec<(SurfaceVertex, f64)> {
    let seeds: Vec<(SurfaceVertex, f64)> = of.map(|vertex| (vertex, 0.0)).collect();
    let mut search = DistanceSearch::default();
    search
        .within(&surface.triangles, topology, position, &seeds, limit)
        .to_vec()
}

/// For each vertex of the surface, whether it is one of these or in the two rings around them.
pub(crate) fn with_rings(topology: &Topology, near: impl Iterator<Item = SurfaceVertex>) -> Vec<bool> {
    let mut is_in = vec![false; topology.vertex_count()];
    let mut rim: Vec<SurfaceVertex> = near.collect();
    for vertex in &rim {
        is_in[vertex.index()] = true;
    }
    for _ in 0..RINGS {
        let mut ring = Vec::new();
        for neighbour in rim.iter().flat_map(|vertex| topology.neighbours(*vertex)) {
            if !std::mem::replace(&mut is_in[neighbour.index()], true) {
                ring.push(*neighbour);
            }
        }
        rim = ring;
    }
    is_in
}

/// The vertices under a curve along the surface, from the one of `start` that is nearest to its beginning on: each is the
/// nearest one that a walk along edges finds from the one before. Vertices may come more than once.
pub(crate) fn under(
    topology: &Topology,
    position: impl Fn(SurfaceVertex) -> DVec3,
    start: &[SurfaceVertex],
    curve: &Curve,
) -> Vec<SurfaceVertex> {
    let mut found = Vec::new();
    for place in curve.station_places() {
        let point = curve.position(place);
        let distance = |v: SurfaceVertex| position(v).distance_squared(point);
        let nearest = |vertices: &[SurfaceVertex]| {
            let of_all = vertices.iter().copied();
            of_all.min_by(|a, b| distance(*a).total_cmp(&distance(*b)))
        };
        let Some(mut here) = found.last().copied().or_else(|| nearest(start)) else {
            break;
        };
        while let Some(next) = nearest(topology.neighbours(here)).filter(|next| distance(*next) < distance(here)) {
            here = next;
        }
        found.push(here);
    }
    found
}

/// Those of some vertices, ascending, with two rings of others of them around them.
fn inner(surface: &Surface, vertices: &[usize]) -> Vec<usize> {
    let mut is_in = vec![false; surface.positions.len()];
    for v in vertices {
        is_in[*v] = true;
    }
    for _ in 0..RINGS {
        let has_other = |corners: &&[SurfaceVertex; 3]| corners.iter().any(|corner| !is_in[corner.index()]);
        let outer: Vec<[SurfaceVertex; 3]> = surface.triangles.iter().filter(has_other).copied().collect();
        for corner in outer.iter().flatten() {
            is_in[corner.index()] = false;
        }
    }
    vertices.iter().copied().filter(|v| is_in[*v]).collect()
}

/// The triangles that the plate's energy of some vertices reads: those around them and around their neighbours.
struct Patch {
    /// Surface vertices, ascending.
    vertices: Vec<usize>,
    /// Places among the vertices, in the surface's order.
    triangles: Vec<[SurfaceVertex; 3]>,
    /// Places of the free vertices, ascending.
    free: Vec<u32>,
}

impl Patch {
    fn around(surface: &Surface, free: &[usize]) -> Self {
        let mut is_in = vec![false; surface.positions.len()];
        for v in free {
            is_in[*v] = true;
        }
        grown(surface, &mut is_in);
        let triangles = grown(surface, &mut is_in);
        let mut places = vec![u32::MAX; surface.positions.len()];
        let mut vertices = Vec::new();
        for (v, _) in is_in.iter().enumerate().filter(|(_, is_in)| **is_in) {
            places[v] = vertices.len() as u32;
            vertices.push(v);
        }
        Self {
            triangles: triangles
                .into_iter()
                .map(|corners| corners.map(|corner| SurfaceVertex(places[corner.index()])))
                .collect(),
            free: free.iter().map(|v| places[*v]).collect(),
            vertices,
        }
    }
}

/// The triangles with a corner among these vertices, whose other corners are added to them.
fn grown(surface: &Surface, is_in: &mut [bool]) -> Vec<[SurfaceVertex; 3]> {
    let touches = |corners: &&[SurfaceVertex; 3]| corners.iter().any(|corner| is_in[corner.index()]);
    let triangles: Vec<[SurfaceVertex; 3]> = surface.triangles.iter().filter(touches).copied().collect();
    for corner in triangles.iter().flatten() {
        is_in[corner.index()] = true;
    }
    triangles
}
