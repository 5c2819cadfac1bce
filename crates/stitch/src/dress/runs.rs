//! The charts and groups along a rim, and their continuation over a patch.
//!
//! A *run* is a stretch of the rim along which texture coordinates are continuous. Each triangle of the patch belongs
//! to the run, and takes the group, of the rim's nearest edge, counted in triangles.

use std::collections::VecDeque;

use pliant_mesh::DrawnVertex;

use crate::borders::Loops;
use crate::fill::FilledHole;
use crate::part::{Part, face_beyond};

/// The edges of a rim in their drawn form.
#[derive(Debug)]
pub(super) struct DrawnRim {
    /// For each edge, the drawn vertices at its first and its second end in the triangle beyond it.
    pub ends: Vec<[DrawnVertex; 2]>,
    /// For each edge, the drawn triangle beyond it.
    pub triangles: Vec<u32>,
    /// For each edge, its run.
    pub runs: Vec<u32>,
    /// The borders that it consists of.
    pub loops: Loops,
}

impl DrawnRim {
    /// Finds the rim of a hole; `None` if a triangle beyond it is missing, which a sound border excludes.
    pub fn of(part: &Part<'_>, hole: &FilledHole) -> Option<Self> {
        let model = part.model;
        let loops = Loops::of(&hole.borders);
        let (mut ends, mut triangles) = (Vec::with_capacity(loops.count()), Vec::with_capacity(loops.count()));
        for (k, &from) in loops.vertices.iter().enumerate() {
            let to = loops.vertices[loops.next(k)];
            let face = face_beyond(model, from, to)?;
            let (own, drawn) = (model.surface.triangles[face], model.drawn_corners(face));
            let at = |vertex| (0..3).find(|&corner| own[corner] == vertex).map(|corner| drawn[corner]);
            ends.push([at(from)?, at(to)?]);
            triangles.push(model.drawn.triangle_of_surface()[face]);
        }
        let runs = runs(part, &ends, &loops);
        Some(Self {
            ends,
            triangles,
            runs,
            loops,
        })
    }

    /// The drawn vertex of a run at a place of the rim, if the run passes it.
    pub fn vertex(&self, place: usize, run: u32) -> Option<DrawnVertex> {
        let before = self.loops.before(place);
        if self.runs[place] == run {
            Some(self.ends[place][0])
        } else if self.runs[before] == run {
            Some(self.ends[before][1])
        } else {
            None
        }
    }
}

/// Numbers the runs: a run begins at the first edge that does not continue the one before. Each border has runs of its
/// own, unless there are no texture coordinates.
fn runs(part: &Part<'_>, ends: &[[DrawnVertex; 2]], loops: &Loops) -> Vec<u32> {
    let mut runs = vec![0; ends.len()];
    if part.attributes.charted == 0 {
        return runs;
    }
    let begins = |k: usize| !part.attributes.are_of_one_chart(ends[loops.before(k)][1], ends[k][0]);
    let mut run = 0;
    for border in loops.ranges() {
        let (start, count) = (border.start, border.len());
        let first = border.clone().find(|&k| begins(k));
        let origin = first.map_or(0, |first| first - start);
        for step in 0..count {
            let k = start + (origin + step) % count;
            run += u32::from(step > 0 && first.is_some() && begins(k));
            runs[k] = run;
        }
        run += 1;
    }
    runs
}

/// The run of each triangle of a patch, and an edge of the rim that it continues.
pub(super) fn continued(part: &Part<'_>, hole: &FilledHole, rim: &DrawnRim) -> Vec<(u32, u32)> {
    let count = rim.runs.len() as u32;
    let group = |triangle: &u32| (part.group)(*triangle);
    let is_one_group = rim
        .triangles
        .iter()
        .all(|triangle| group(triangle) == group(&rim.triangles[0]));
    if is_one_group && rim.runs.iter().all(|run| *run == 0) {
        return vec![(0, 0); hole.triangles.len()];
    }
    let mut beside: Vec<([u32; 2], u32)> = Vec::with_capacity(3 * hole.triangles.len());
    for (number, &[a, b, c]) in (0..).zip(&hole.triangles) {
        beside.extend([[a, b], [b, c], [c, a]].map(|edge| (edge, number)));
    }
    beside.sort_unstable();
    let left_of = |edge: [u32; 2]| {
        let found = beside.binary_search_by_key(&edge, |(own, _)| *own);
        found.ok().map(|found| beside[found].1)
    };
    let mut of_triangle: Vec<Option<(u32, u32)>> = vec![None; hole.triangles.len()];
    let mut queue = VecDeque::new();
    for edge in 0..count {
        if let Some(triangle) = left_of([edge, rim.loops.next(edge as usize) as u32])
            && of_triangle[triangle as usize].is_none()
        {
            of_triangle[triangle as usize] = Some((rim.runs[edge as usize], edge));
            queue.push_back(triangle);
        }
    }
    while let Some(triangle) = queue.pop_front() {
        let [a, b, c] = hole.triangles[triangle as usize];
        for edge in [[b, a], [c, b], [a, c]] {
            if let Some(next) = left_of(edge)
                && of_triangle[next as usize].is_none()
            {
                of_triangle[next as usize] = of_triangle[triangle as usize];
                queue.push_back(next);
            }
        }
    }
    of_triangle.into_iter().map(|found| found.unwrap_or((0, 0))).collect()
}
