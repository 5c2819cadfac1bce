//! The triangles around a vertex, found from their order. They are sorted by their lowest vertex, so those triangles of
//! a vertex in which it is not the lowest are in the runs of its lower neighbours. A stored list would take as much
//! memory as the triangles.

use std::ops::Range;

use crate::SurfaceVertex;

/// Longer runs are searched by their order, not from end to end.
const LONG: usize = 32;

/// The number of triangles in a block.
const BLOCK: usize = 1024;

/// The start of the run of triangles in which each vertex is the lowest, and the end of the last one.
pub(crate) fn runs(vertex_count: usize, triangles: &[[SurfaceVertex; 3]]) -> Vec<u32> {
    let mut starts = Vec::with_capacity(vertex_count + 1);
    for (t, triangle) in (0..).zip(triangles) {
        let [lowest, ..] = sorted(*triangle);
        if starts.len() <= lowest.index() {
            starts.resize(lowest.index() + 1, t);
        }
    }
    starts.resize(vertex_count + 1, triangles.len() as u32);
    starts
}

/// A triangle's vertices, ascending.
#[inline]
fn sorted(triangle: [SurfaceVertex; 3]) -> [SurfaceVertex; 3] {
    let [a, b, c] = triangle;
    let (low, high) = (a.min(b), a.max(b));
    [low.min(c), low.max(high.min(c)), high.max(c)]
}

/// Returns true if triangles are in order of their lowest, then their middle, then their highest vertex.
pub(crate) fn are_in_order(triangles: &[[SurfaceVertex; 3]]) -> bool {
    triangles.is_sorted_by_key(|triangle| sorted(*triangle))
}

/// The triangles around a vertex, ascending.
#[derive(Clone, Debug)]
pub struct Faces<'a> {
    vertex: SurfaceVertex,
    triangles: &'a [[SurfaceVertex; 3]],
    runs: &'a [u32],
    /// The lower neighbours whose runs are still to come; the vertex's own comes last.
    lower: &'a [SurfaceVertex],
    own: Range<u32>,
    /// The rest of the present run.
    run: Range<u32>,
    /// A long run, and the middle vertices with which it is still to be searched for the vertex.
    long: Range<u32>,
    middles: &'a [SurfaceVertex],
}

impl<'a> Faces<'a> {
    /// The triangles around `vertex`, whose neighbours are `ring`.
    #[inline]
    pub(crate) fn around(
        vertex: SurfaceVertex,
        ring: &'a [SurfaceVertex],
        triangles: &'a [[SurfaceVertex; 3]],
        runs: &'a [u32],
    ) -> Self {
        let lower = if ring.len() <= LONG {
            ring.iter().take_while(|&&u| u < vertex).count()
        } else {
            ring.partition_point(|&u| u < vertex)
        };
        Self {
            vertex,
            triangles,
            runs,
            lower: &ring[..lower],
            own: run(runs, vertex),
            run: 0..0,
            long: 0..0,
            middles: &[],
        }
    }

    /// The triangles of the long run from these middle and highest vertices on.
    fn from(&self, middle: SurfaceVertex, highest: SurfaceVertex) -> Range<u32> {
        let Range { start, end } = self.long;
        let below = |triangle: &[SurfaceVertex; 3]| {
            let [_, b, c] = sorted(*triangle);
            (b, c) < (middle, highest)
        };
        let count = self.triangles[start as usize..end as usize].partition_point(below);
        start + count as u32..end
    }

    /// Begins a long run: for each middle vertex there is at most one triangle up to the vertex, and after them come
    /// the triangles whose middle vertex is the vertex itself.
    #[cold]
    fn search(&mut self) {
        while let Some((&middle, rest)) = self.middles.split_first() {
            self.middles = rest;
            let found = self.from(middle, self.vertex);
            let is_there = |t: u32| sorted(self.triangles[t as usize])[1..] == [middle, self.vertex];
            if !found.is_empty() && is_there(found.start) {
                self.run = found.start..found.start + 1;
                return;
            }
        }
        let with_middle = self.from(self.vertex, SurfaceVertex(0)).start;
        self.run = with_middle..self.from(SurfaceVertex(self.vertex.0 + 1), SurfaceVertex(0)).start;
        self.long = 0..0;
    }
}

impl Iterator for Faces<'_> {
    type Item = u32;

    #[inline]
    fn next(&mut self) -> Option<u32> {
        loop {
            for t in self.run.by_ref() {
                if self.triangles[t as usize].contains(&self.vertex) {
                    return Some(t);
                }
            }
            if !self.long.is_empty() {
                self.search();
                continue;
            }
            let Some((&u, rest)) = self.lower.split_first() else {
                return self.own.next();
            };
            self.lower = rest;
            let run = run(self.runs, u);
            if run.len() > LONG {
                (self.long, self.middles) = (run, rest);
            } else {
                self.run = run;
            }
        }
    }
}

#[inline]
fn run(runs: &[u32], lowest: SurfaceVertex) -> Range<u32> {
    runs[lowest.index()]..runs[lowest.index() + 1]
}

/// Rows of triangles around a range of vertices.
pub(crate) struct FaceRows {
    /// The start of each vertex's row, and the end of the last one.
    pub(crate) offsets: Vec<u32>,
    pub(crate) list: Vec<u32>,
}

/// Triangles in blocks, of which only some have corners in a range of vertices.
pub(crate) struct Blocks<'a> {
    triangles: &'a [[SurfaceVertex; 3]],
    /// Each block's highest vertex.
    highest: Vec<SurfaceVertex>,
}

impl<'a> Blocks<'a> {
    pub(crate) fn of(triangles: &'a [[SurfaceVertex; 3]]) -> Self {
        let highest = |block: &[[SurfaceVertex; 3]]| block.as_flattened().iter().copied().max();
        Self {
            triangles,
            highest: triangles.chunks(BLOCK).filter_map(highest).collect(),
        }
    }

    /// The blocks with corners among some vertices, and perhaps others, ascending: the number of each one's first
    /// triangle, and its triangles.
    fn touching(&self, vertices: &Range<usize>) -> impl Iterator<Item = (u32, &'a [[SurfaceVertex; 3]])> + '_ {
        let (start, end) = (vertices.start, vertices.end);
        let blocks = self.triangles.chunks(BLOCK).zip(&self.highest).zip(0..);
        // Blocks are in order of their first triangle's lowest vertex.
        blocks
            .take_while(move |((block, _), _)| sorted(block[0])[0].index() < end)
            .filter(move |((_, highest), _)| highest.index() >= start)
            .map(|((block, _), number)| (number * BLOCK as u32, block))
    }

    /// The triangles around each vertex of a range, ascending.
    pub(crate) fn rows(&self, vertices: Range<usize>) -> FaceRows {
        let first = vertices.start;
        // A vertex below the range wraps around to a place above it.
        let place = |v: SurfaceVertex| v.index().wrapping_sub(first);
        let mut offsets = vec![0u32; vertices.len() + 2];
        for (_, block) in self.touching(&vertices) {
            for &v in block.as_flattened() {
                if place(v) < vertices.len() {
                    offsets[place(v) + 2] += 1;
                }
            }
        }
        for row in 2..offsets.len() {
            offsets[row] += offsets[row - 1];
        }
        // Shifted by one, each start moves on to the next row's start while its row fills.
        let mut list = vec![0u32; offsets[vertices.len() + 1] as usize];
        for (number, block) in self.touching(&vertices) {
            for (t, triangle) in (number..).zip(block) {
                for &v in triangle {
                    if place(v) < vertices.len() {
                        let next = &mut offsets[place(v) + 1];
                        list[*next as usize] = t;
                        *next += 1;
                    }
                }
            }
        }
        offsets.pop();
        FaceRows { offsets, list }
    }
}
