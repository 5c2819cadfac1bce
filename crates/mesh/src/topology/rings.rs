//! One-rings: the neighbours of each vertex, the number of triangles on each edge, and the faults found there.

use std::ops::Range;

use rayon::prelude::*;

use crate::topology::faces::{Blocks, FaceRows};
use crate::{Cancel, Cancelled, SurfaceVertex};

/// Vertices a piece of the parallel walk.
const PIECE: usize = 2048;

/// The rows and findings of a range of vertices, or of all.
#[derive(Default)]
pub(crate) struct Rings {
    /// The length of each vertex's row in the range.
    pub(crate) degrees: Vec<u32>,
    /// The rows: neighbours ascending.
    pub(crate) neighbours: Vec<SurfaceVertex>,
    /// The rows again, as places in them, each in the order in which the triangles pass from neighbour to neighbour;
    /// meaningless for an irregular vertex. A fan with more neighbours than a byte can count is irregular too.
    pub(crate) fans: Vec<u8>,
    /// The kind of each vertex's row in `fans`.
    pub(crate) fan_kinds: Vec<FanKind>,
    /// The faults found there.
    pub(crate) findings: TopologyFindings,
}

/// Boundary edges, and places where triangles do not meet as on a manifold; each list is ascending.
#[derive(Clone, Debug, Default)]
pub(crate) struct TopologyFindings {
    /// Edges with one triangle, directed against it, so that the hole is on the left.
    pub(crate) boundary: Vec<[SurfaceVertex; 2]>,
    /// The lower vertex of each edge with more than two triangles.
    pub(crate) non_manifold_edges: Vec<SurfaceVertex>,
    /// The lower vertex of each edge along which both triangles run the same way.
    pub(crate) misoriented_edges: Vec<SurfaceVertex>,
    /// Vertices whose triangles form more than one fan.
    pub(crate) non_manifold_vertices: Vec<SurfaceVertex>,
}

impl Rings {
    /// Forgets all rows, but keeps their memory.
    fn clear(&mut self) {
        self.degrees.clear();
        self.neighbours.clear();
        self.fans.clear();
        self.fan_kinds.clear();
        self.findings.clear();
    }
}

impl TopologyFindings {
    /// The vertices from the lowest to the highest one in the lists.
    pub(crate) fn range(&self) -> Range<usize> {
        let edges = self.boundary.as_flattened();
        let others = [
            &self.non_manifold_edges,
            &self.misoriented_edges,
            &self.non_manifold_vertices,
        ];
        let named = edges.iter().chain(others.into_iter().flatten());
        let (low, high) = named.fold((usize::MAX, 0), |(low, high), vertex| {
            (low.min(vertex.index()), high.max(vertex.index() + 1))
        });
        low.min(high)..high
    }

    fn clear(&mut self) {
        self.boundary.clear();
        self.non_manifold_edges.clear();
        self.misoriented_edges.clear();
        self.non_manifold_vertices.clear();
    }

    fn extend(&mut self, later: &Self) {
        self.boundary.extend_from_slice(&later.boundary);
        self.non_manifold_edges.extend_from_slice(&later.non_manifold_edges);
        self.misoriented_edges.extend_from_slice(&later.misoriented_edges);
        self.non_manifold_vertices
            .extend_from_slice(&later.non_manifold_vertices);
    }
}

/// The connection of the triangles around a vertex.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum FanKind {
    /// One fan all around: each neighbour and the next make a triangle with the vertex, the last one with the first.
    Closed,
    /// One fan with two rims: each neighbour and the next make a triangle with the vertex.
    Open,
    /// Several fans, an edge with more than two triangles, triangles that disagree about the outside, or more than 256
    /// neighbours.
    Irregular,
}

/// Pieces that are walked before they are appended to the finished rows: few, so that little is stored twice.
const BATCH: usize = 64;

/// Parts of the vertices, one after the other, whose triangles are listed: the rows of all vertices would take as much
/// memory as the triangles themselves.
const PARTS: usize = 16;

/// Walks around every vertex, and gives the start of each one's row (and the end of the last one), and the rows.
pub(crate) fn rings(
    vertex_count: usize,
    triangles: &[[SurfaceVertex; 3]],
    cancel: &Cancel,
) -> Result<(Vec<u32>, Rings), Cancelled> {
    // A closed surface has three neighbours a triangle, an open one a few more: space for those is added as they come,
    // because a vector would double.
    let total = 3 * triangles.len();
    let mut offsets = Vec::with_capacity(vertex_count + 1);
    offsets.push(0);
    let mut all = Rings {
        neighbours: Vec::with_capacity(total),
        fans: Vec::with_capacity(total),
        fan_kinds: Vec::with_capacity(vertex_count),
        ..Rings::default()
    };
    walk_around_all(vertex_count, triangles, cancel, |piece| {
        let mut end = all.neighbours.len() as u32;
        offsets.extend(piece.degrees.iter().map(|degree| {
            end += degree;
            end
        }));
        if all.neighbours.capacity() < end as usize {
            let more = end as usize - all.neighbours.len() + total / 16;
            all.neighbours.reserve_exact(more);
            all.fans.reserve_exact(more);
        }
        all.neighbours.extend_from_slice(&piece.neighbours);
        all.fans.extend_from_slice(&piece.fans);
        all.fan_kinds.extend_from_slice(&piece.fan_kinds);
        all.findings.extend(&piece.findings);
    })?;
    all.neighbours.shrink_to_fit();
    all.fans.shrink_to_fit();
    Ok((offsets, all))
}

/// The faults around the vertices, without their rings.
pub(crate) fn topology_findings(
    vertex_count: usize,
    triangles: &[[SurfaceVertex; 3]],
    cancel: &Cancel,
) -> Result<TopologyFindings, Cancelled> {
    let mut all = TopologyFindings::default();
    walk_around_all(vertex_count, triangles, cancel, |piece| all.extend(&piece.findings))?;
    Ok(all)
}

/// Walks around all vertices, part by part, and gives their rings in order.
fn walk_around_all(
    vertex_count: usize,
    triangles: &[[SurfaceVertex; 3]],
    cancel: &Cancel,
    mut take: impl FnMut(&Rings),
) -> Result<(), Cancelled> {
    let blocks = Blocks::of(triangles);
    let size = vertex_count.div_ceil(PARTS).max(BATCH * PIECE / 4);
    for first in (0..vertex_count).step_by(size) {
        cancel.check()?;
        let vertices = first..(first + size).min(vertex_count);
        let faces = blocks.rows(vertices.clone());
        walk_around(vertices, triangles, &faces, &mut take);
    }
    Ok(())
}

/// Walks around a range of vertices, whose triangles `faces` has, and gives their rings in order, piece by piece.
fn walk_around(
    vertices: Range<usize>,
    triangles: &[[SurfaceVertex; 3]],
    faces: &FaceRows,
    mut take: impl FnMut(&Rings),
) {
    let mut pieces: Vec<(Rings, Walk)> = Vec::new();
    for first in vertices.clone().step_by(BATCH * PIECE) {
        pieces.resize_with(BATCH.min((vertices.end - first).div_ceil(PIECE)), Default::default);
        pieces.par_iter_mut().enumerate().for_each(|(piece, (rings, walk))| {
            rings.clear();
            let first = first + piece * PIECE;
            for v in first..(first + PIECE).min(vertices.end) {
                let row = v - vertices.start;
                let row = faces.offsets[row] as usize..faces.offsets[row + 1] as usize;
                walk.around(SurfaceVertex(v as u32), triangles, &faces.list[row], rings);
            }
        });
        pieces.iter().for_each(|(rings, _)| take(rings));
    }
}

/// Memory for the walk around one vertex.
#[derive(Default)]
struct Walk {
    /// The far ends of the edges of each triangle at the vertex: neighbour, whether the triangle runs towards the
    /// vertex along it, and the triangle's place in the row. They are packed, so that they sort fast.
    spokes: Vec<u64>,
    /// Union-find over the row's triangles.
    fan: Vec<u32>,
    /// For each neighbour the triangle (its place in the row) that runs to it from the vertex, if any.
    triangle_after: Vec<Option<u32>>,
    /// For each triangle of the row the neighbour (its place in the ring) from which it runs to the vertex.
    neighbour_before: Vec<u32>,
}

impl Walk {
    fn around(&mut self, v: SurfaceVertex, triangles: &[[SurfaceVertex; 3]], row: &[u32], rings: &mut Rings) {
        if add_closed_fan(v, triangles, row, rings) {
            return;
        }
        self.spokes.clear();
        self.fan.clear();
        self.triangle_after.clear();
        self.neighbour_before.clear();
        self.neighbour_before.resize(row.len(), 0);
        for (place, &t) in row.iter().enumerate() {
            let [next, previous] = others(triangles[t as usize], v);
            self.spokes.push(u64::from(next.0) << 32 | place as u64);
            self.spokes.push(u64::from(previous.0) << 32 | INWARD | place as u64);
            self.fan.push(place as u32);
        }
        self.spokes.sort_unstable();
        let mut fans = row.len();
        let ring_start = rings.neighbours.len();
        let mut is_regular = true;
        let mut first = 0;
        while first < self.spokes.len() {
            let neighbour = SurfaceVertex((self.spokes[first] >> 32) as u32);
            let place_in_ring = self.triangle_after.len() as u32;
            self.triangle_after.push(None);
            self.link(self.spokes[first], place_in_ring);
            let mut last = first + 1;
            let mut inward = usize::from(self.spokes[first] & INWARD != 0);
            while last < self.spokes.len() && (self.spokes[last] >> 32) as u32 == neighbour.0 {
                fans -= usize::from(self.join(self.spokes[first], self.spokes[last]));
                self.link(self.spokes[last], place_in_ring);
                inward += usize::from(self.spokes[last] & INWARD != 0);
                last += 1;
            }
            let count = last - first;
            is_regular &= count == 1 || count == 2 && inward == 1;
            rings.neighbours.push(neighbour);
            if count == 1 && inward == 1 {
                // The triangle runs from the neighbour to here, so the hole's rim runs from here to there.
                rings.findings.boundary.push([v, neighbour]);
            }
            if v < neighbour {
                if count > 2 {
                    rings.findings.non_manifold_edges.push(v);
                } else if count == 2 && inward != 1 {
                    rings.findings.misoriented_edges.push(v);
                }
            }
            first = last;
        }
        let degree = rings.neighbours.len() - ring_start;
        rings.degrees.push(degree as u32);
        if fans > 1 {
            rings.findings.non_manifold_vertices.push(v);
        }
        if is_regular && fans == 1 && degree <= 1 << u8::BITS {
            self.order_fan(rings);
        } else {
            rings.fan_kinds.push(FanKind::Irregular);
            rings.fans.resize(rings.neighbours.len(), 0);
        }
    }

    fn link(&mut self, spoke: u64, place_in_ring: u32) {
        let triangle = (spoke & (INWARD - 1)) as u32;
        if spoke & INWARD == 0 {
            self.triangle_after[place_in_ring as usize] = Some(triangle);
        } else {
            self.neighbour_before[triangle as usize] = place_in_ring;
        }
    }

    /// Follows the triangles of a regular vertex from neighbour to neighbour.
    fn order_fan(&self, rings: &mut Rings) {
        let degree = self.triangle_after.len();
        let kind = if degree == self.neighbour_before.len() {
            FanKind::Closed
        } else {
            FanKind::Open
        };
        rings.fan_kinds.push(kind);
        // An open fan starts at the one neighbour to which no triangle leads.
        let mut place = match kind {
            FanKind::Open => (0..degree as u32)
                .find(|place| !self.neighbour_before.contains(place))
                .unwrap_or(0),
            _ => 0,
        };
        for _ in 0..degree {
            rings.fans.push(place as u8);
            if let Some(triangle) = self.triangle_after[place as usize] {
                place = self.neighbour_before[triangle as usize];
            }
        }
    }

    /// Joins the fans of two spokes' triangles; returns whether they were apart.
    fn join(&mut self, a: u64, b: u64) -> bool {
        let (a, b) = (self.root(a), self.root(b));
        self.fan[a.max(b)] = a.min(b) as u32;
        a != b
    }

    fn root(&mut self, spoke: u64) -> usize {
        let mut place = (spoke & (INWARD - 1)) as usize;
        while self.fan[place] as usize != place {
            let parent = self.fan[place] as usize;
            self.fan[place] = self.fan[parent];
            place = parent;
        }
        place
    }
}

/// Adds the ring of a vertex whose few triangles are one closed fan. Nearly all vertices have such a ring, and a walk
/// from triangle to triangle finds it in a third of the instructions that sorting all spokes takes. Returns false, and
/// adds nothing, for all others.
fn add_closed_fan(v: SurfaceVertex, triangles: &[[SurfaceVertex; 3]], row: &[u32], rings: &mut Rings) -> bool {
    let degree = row.len();
    let mut far_ends = [[0; 2]; FEW];
    let Some(far_ends) = far_ends.get_mut(..degree) else {
        return false;
    };
    for (ends, &t) in far_ends.iter_mut().zip(row) {
        *ends = others(triangles[t as usize], v).map(|neighbour| neighbour.0);
    }
    let Some(first) = far_ends.iter().map(|[next, _]| *next).min() else {
        return false;
    };
    // Each neighbour with its place in the fan, packed to sort fast.
    let mut fan = [0u64; FEW];
    let mut neighbour = first;
    for (place, packed) in fan[..degree].iter_mut().enumerate() {
        let is_closed_early = place > 0 && neighbour == first;
        let after = far_ends.iter().find(|[next, _]| *next == neighbour);
        let Some([_, previous]) = after.filter(|_| !is_closed_early) else {
            return false;
        };
        *packed = u64::from(neighbour) << u8::BITS | place as u64;
        neighbour = *previous;
    }
    if neighbour != first {
        return false;
    }
    // The walk came back after as many steps as there are triangles and not before, so it used each of them once.
    fan[..degree].sort_unstable();
    let start = rings.fans.len();
    rings.fans.resize(start + degree, 0);
    for (rank, packed) in (0..).zip(&fan[..degree]) {
        rings.fans[start + usize::from(*packed as u8)] = rank;
        rings.neighbours.push(SurfaceVertex((packed >> u8::BITS) as u32));
    }
    rings.degrees.push(degree as u32);
    rings.fan_kinds.push(FanKind::Closed);
    true
}

/// The most triangles around a vertex that are walked one by one.
const FEW: usize = 16;

/// A spoke's bit for its direction, above its triangle's place in the row (below 2³¹).
const INWARD: u64 = 1 << 31;

/// The corners after and before `v`.
fn others([a, b, c]: [SurfaceVertex; 3], v: SurfaceVertex) -> [SurfaceVertex; 2] {
    if v == a {
        [b, c]
    } else if v == b {
        [c, a]
    } else {
        [a, b]
    }
}
