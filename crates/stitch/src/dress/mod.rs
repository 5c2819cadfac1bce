//! A patch in its drawn form: its vertices with their numbers, and its triangles with their groups.
//!
//! Colours continue from the whole rim. Texture coordinates jump along seams, so each run of the rim continues over its
//! own share of the patch (see `runs`), and a point between two shares is drawn once for each.

mod runs;
mod values;

use std::collections::BTreeMap;

use glam::DVec3;
use pliant_deform::Budget;
use pliant_mesh::{Cancel, DrawnVertex};

use crate::fill::FilledHole;
use crate::part::Part;
use runs::{DrawnRim, continued};
use values::continue_values;

/// A patch in its drawn form.
#[derive(Clone, PartialEq, Debug, Default)]
pub(crate) struct DressedPatch {
    /// The new vertices: each one's point of the patch, and a drawn vertex of the rim whose kind it takes.
    pub vertices: Vec<(u32, DrawnVertex)>,
    /// Their numbers, row after row.
    pub values: Vec<f64>,
    /// The triangles.
    pub triangles: Vec<[DressedCorner; 3]>,
    /// The drawn triangle whose group each of them takes.
    pub sources: Vec<u32>,
}

/// A corner of a patch's triangle.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(crate) enum DressedCorner {
    /// A drawn vertex of the rim.
    Old(DrawnVertex),
    /// A new vertex, by its place in [`DressedPatch::vertices`].
    New(u32),
}

impl DressedPatch {
    /// Dresses a patch; `None` for a hole without a rim of this part.
    pub fn of(part: &Part<'_>, hole: &FilledHole, budget: Budget, cancel: &Cancel) -> Option<Self> {
        let rim = DrawnRim::of(part, hole)?;
        let of_triangle = continued(part, hole, &rim);
        let count = rim.runs.len();
        let positions = rim
            .loops
            .vertices
            .iter()
            .map(|v| part.model.surface.positions[v.index()]);
        let points: Vec<DVec3> = positions.chain(hole.points.iter().copied()).collect();
        let blended = blended(part, hole, &rim, &points, (budget, cancel));
        let (charts, blends) = (part.attributes.charted, part.attributes.blended);

        let mut patch = Self {
            triangles: Vec::with_capacity(hole.triangles.len()),
            sources: of_triangle
                .iter()
                .map(|&(_, edge)| rim.triangles[edge as usize])
                .collect(),
            ..Self::default()
        };
        let mut corners_of: Vec<[DressedCorner; 3]> = vec![[DressedCorner::New(0); 3]; hole.triangles.len()];
        let mut by_run: BTreeMap<u32, Vec<usize>> = BTreeMap::new();
        for (number, (run, _)) in of_triangle.iter().enumerate() {
            by_run.entry(*run).or_default().push(number);
        }
        for (run, numbers) in by_run {
            let triangles: Vec<[u32; 3]> = numbers.iter().map(|&number| hole.triangles[number]).collect();
            let on_rim: Vec<Option<DrawnVertex>> = (0..points.len())
                .map(|point| if point < count { rim.vertex(point, run) } else { None })
                .collect();
            let known: Vec<bool> = on_rim.iter().map(Option::is_some).collect();
            let mut rows = vec![0.0; points.len() * charts];
            for (point, vertex) in on_rim.iter().enumerate() {
                if let Some(vertex) = vertex {
                    for channel in 0..charts {
                        rows[point * charts + channel] = (part.attributes.value)(*vertex, channel);
                    }
                }
            }
            continue_values(&points, &triangles, &known, &mut rows, charts, (budget, cancel));
            let like = rim.runs.iter().position(|own| *own == run).unwrap_or(0);
            let mut number_of: Vec<Option<DressedCorner>> =
                on_rim.iter().map(|vertex| vertex.map(DressedCorner::Old)).collect();
            for (&number, corners) in numbers.iter().zip(&triangles) {
                corners_of[number] = corners.map(|point| {
                    *number_of[point as usize].get_or_insert_with(|| {
                        let point_row = point as usize * charts;
                        let blend_row = point as usize * blends;
                        patch.values.extend(&rows[point_row..point_row + charts]);
                        patch.values.extend(&blended[blend_row..blend_row + blends]);
                        patch.vertices.push((point, rim.ends[like][0]));
                        DressedCorner::New(patch.vertices.len() as u32 - 1)
                    })
                });
            }
        }
        patch.triangles = corners_of;
        Some(patch)
    }
}

/// The blended numbers of all points of a patch.
fn blended(part: &Part<'_>, hole: &FilledHole, rim: &DrawnRim, points: &[DVec3], means: (Budget, &Cancel)) -> Vec<f64> {
    let (first, width) = (part.attributes.charted, part.attributes.blended);
    let count = rim.ends.len();
    let mut rows = vec![0.0; points.len() * width];
    for place in 0..count {
        let [before, own] = [rim.ends[rim.loops.before(place)][1], rim.ends[place][0]];
        for channel in 0..width {
            let value = |vertex| (part.attributes.value)(vertex, first + channel);
            rows[place * width + channel] = 0.5 * (value(before) + value(own));
        }
    }
    let known: Vec<bool> = (0..points.len()).map(|point| point < count).collect();
    continue_values(points, &hole.triangles, &known, &mut rows, width, means);
    rows
}
