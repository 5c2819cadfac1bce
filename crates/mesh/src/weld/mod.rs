//! Welds drawn vertices and triangles into a surface and counts everything that was left out.

mod bare_points;
mod closeness;
mod joining;
mod morton;
pub(crate) mod nearby;
mod options;

use glam::DVec3;
use rayon::prelude::*;

use crate::drawn::drawn_set::{DrawnSet, FileVertices, NONE};
use crate::drawn::drawn_triangles::Corners;
use crate::findings::finding::{collect, sort_out};
use crate::geometry::{bounds_of, is_without_area};
use crate::topology::components::Components;
use crate::{Bounds, Cancel, Cancelled, Drawn, DrawnVertex, Finding, Findings, Progress, Surface, SurfaceVertex};
use closeness::Closeness;
use joining::{Joined, join_equal};
use nearby::join_nearest;
pub use options::WeldOptions;

/// Larger coordinates count as not finite, because areas and volumes of such a mesh would overflow.
const LARGEST_COORDINATE: f64 = 1e60;

/// The result of welding.
pub(crate) struct Welded {
    /// Its triangles use the first vertices; the others are bare points.
    pub(crate) surface: Surface,
    /// The number of the first bare point, or the number of all vertices.
    pub(crate) first_bare: usize,
    /// The drawn set that was welded, its triangles in their original order.
    pub(crate) drawn: DrawnSet,
    pub(crate) components: Components,
    /// The findings about file vertices and triangles. Those about the topology are still empty.
    pub(crate) findings: Findings,
}

/// The users of a drawn vertex.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Use {
    None,
    LeftOutTriangle,
    Triangle,
}

/// Welds `drawn`; progress goes from 0 to 0.6. It drops each array as soon as it is no longer needed, because a scan's
/// positions alone take as much memory as its file.
pub(crate) fn weld(
    drawn: Drawn,
    options: &WeldOptions,
    progress: &Progress,
    cancel: &Cancel,
) -> Result<Welded, Cancelled> {
    let mut findings = Findings::default();
    let drawn_positions = drawn.positions;
    let file_vertices = FileVertices::new(drawn.file_vertex_count, drawn.file_vertex);
    let corners = Corners::new(drawn.triangles);
    let (lines, roundings) = (drawn.lines, drawn.roundings);
    let usable: Vec<bool> = drawn_positions.par_iter().map(is_usable).collect();
    let uses = uses_of_vertices(&corners, &usable);
    let in_triangles = || {
        let members: Vec<u32> = (0..uses.len() as u32)
            .filter(|&v| uses[v as usize] == Use::Triangle)
            .collect();
        let bounds = bounds_of(members.par_iter().map(|&v| drawn_positions[v as usize]));
        (members, bounds)
    };
    let report = || report_vertices(&file_vertices, &usable, &uses, &mut findings);
    let ((members, bounds), ()) = rayon::join(in_triangles, report);
    drop((usable, uses));
    cancel.check()?;
    progress.set(0.1);

    let distance = options.distance.map(|distance| distance.max(0.0));
    let Joining {
        mut positions,
        mut surface_vertices,
    } = match bounds {
        Some(bounds) => {
            let mut joined = join_equal(&drawn_positions, members, &bounds);
            cancel.check()?;
            progress.set(0.3);
            let groups = groups_by_vertex(drawn_positions.len(), &joined);
            let groups = if distance == Some(0.0) {
                groups
            } else {
                let closeness = Closeness::of(&drawn_positions, &corners, &groups, joined.order.len())
                    .with_distance(distance)
                    .with_roundings(&roundings);
                joined_to_near_ones(&drawn_positions, &corners, &mut joined, &bounds, groups, &closeness)
            };
            let Joined { order, representative } = joined;
            drop(representative);
            cancel.check()?;
            progress.set(0.4);
            joined_by_triangles(&drawn_positions, &corners, order, groups, &mut findings)
        }
        None => {
            findings.non_finite_triangles = collect(corners.len(), |_| true);
            Joining {
                positions: Vec::new(),
                surface_vertices: vec![NONE; drawn_positions.len()],
            }
        }
    };
    cancel.check()?;
    progress.set(0.45);

    let first_bare = positions.len();
    let bare: Vec<u32> = (0..drawn_positions.len() as u32)
        .filter(|&v| surface_vertices[v as usize] == NONE && is_usable(&drawn_positions[v as usize]))
        .collect();
    if !bare.is_empty() {
        let closeness =
            Closeness::of(&drawn_positions, &corners, &surface_vertices, first_bare).with_distance(distance);
        bare_points::add(
            &drawn_positions,
            &bare,
            &mut positions,
            &mut surface_vertices,
            &closeness,
        );
    }
    drop(bare);
    cancel.check()?;
    let drawn = DrawnSet::new(drawn_positions, surface_vertices, &positions, file_vertices);
    let in_surface = |v: DrawnVertex| match drawn.surface_vertex(v) {
        Some(v) if v.index() < first_bare => v.0,
        _ => NONE,
    };
    let (triangles, triangle_of_surface) = sort_triangles(
        corners.len(),
        |t| corners.of(t).map(in_surface),
        first_bare,
        &mut findings.duplicate_triangles,
    );
    let first_file_vertex = drawn.first_file_vertices(0..positions.len());
    let surface = Surface { positions, triangles };
    let (components, without_area) = rayon::join(
        || Components::of(&surface.triangles, &first_file_vertex),
        || collect(surface.triangles.len(), |t| is_without_area(surface.corners(t))),
    );
    findings.zero_area_triangles = without_area.renamed(|t| triangle_of_surface[t as usize]);
    progress.set(0.6);
    Ok(Welded {
        drawn: drawn.with_triangles(corners, triangle_of_surface).with_lines(lines),
        components,
        surface,
        first_bare,
        findings,
    })
}

/// The groups of drawn vertices, after close ones are joined.
fn joined_to_near_ones(
    positions: &[DVec3],
    corners: &Corners,
    joined: &mut Joined,
    bounds: &Bounds,
    mut groups: Vec<u32>,
    closeness: &Closeness<'_>,
) -> Vec<u32> {
    let rule = |near: &[u32]| closeness.rule(near, positions, corners, &groups);
    if join_nearest(positions, joined, bounds, |group| closeness.reach(group), rule) {
        groups.par_iter_mut().for_each(|group| {
            *group = joined.representative.get(*group as usize).copied().unwrap_or(NONE);
        });
    }
    groups
}

/// Welded positions, in Morton order, and the one of each drawn vertex ([`NONE`] if it has none).
struct Joining {
    positions: Vec<DVec3>,
    surface_vertices: Vec<u32>,
}

/// The groups that proper triangles use; reports the triangles that are left out.
fn joined_by_triangles(
    drawn_positions: &[DVec3],
    corners: &Corners,
    order: Vec<u32>,
    mut surface_vertices: Vec<u32>,
    findings: &mut Findings,
) -> Joining {
    let in_groups = |t: usize| corners.of(t).map(|v| surface_vertices[v.index()]);
    [findings.non_finite_triangles, findings.collapsed_triangles] = sort_out(corners.len(), |t| {
        let groups = in_groups(t);
        if has_unusable_corner(groups) {
            Some(0)
        } else {
            is_collapsed(groups).then_some(1)
        }
    });
    let surface_of_group = number_used_groups((0..corners.len()).map(in_groups), order.len());
    let used = (0..order.len()).filter(|&group| surface_of_group[group] != NONE);
    let mut positions = Vec::with_capacity(used.clone().count());
    positions.extend(used.map(|group| drawn_positions[order[group] as usize]));
    drop(order);
    surface_vertices.par_iter_mut().for_each(|group| {
        *group = surface_of_group.get(*group as usize).copied().unwrap_or(NONE);
    });
    Joining {
        positions,
        surface_vertices,
    }
}

fn is_usable(position: &DVec3) -> bool {
    position.is_finite() && position.abs().max_element() <= LARGEST_COORDINATE
}

fn has_unusable_corner(corners: [u32; 3]) -> bool {
    corners.contains(&NONE)
}

fn is_collapsed([a, b, c]: [u32; 3]) -> bool {
    a == b || b == c || c == a
}

/// A triangle with an unusable corner is left out, so it does not count as a user of its other corners.
fn uses_of_vertices(corners: &Corners, usable: &[bool]) -> Vec<Use> {
    let mut uses = vec![Use::None; usable.len()];
    for triangle in corners.iter() {
        let by = if triangle.iter().all(|v| usable[v.index()]) {
            Use::Triangle
        } else {
            Use::LeftOutTriangle
        };
        for v in triangle {
            uses[v.index()] = uses[v.index()].max(by);
        }
    }
    uses
}

/// Finds file vertices that are not finite and those that no triangle uses.
fn report_vertices(file_vertices: &FileVertices, usable: &[bool], uses: &[Use], findings: &mut Findings) {
    let count = file_vertices.count();
    let mut is_used = vec![false; count];
    let mut is_bad = vec![false; count];
    for v in 0..uses.len() {
        let file_vertex = file_vertices.of(v).index();
        let Some(is_used) = is_used.get_mut(file_vertex) else {
            continue;
        };
        *is_used |= uses[v] != Use::None;
        is_bad[file_vertex] |= !usable[v];
    }
    findings.non_finite_vertices = collect(count, |v| is_bad[v]);
    findings.unreferenced_vertices = collect(count, |v| !is_used[v]);
}

/// The place of each vertex's representative, or [`NONE`] for a vertex that took no part.
fn groups_by_vertex(vertex_count: usize, joined: &Joined) -> Vec<u32> {
    let mut groups = vec![NONE; vertex_count];
    for (&vertex, &representative) in joined.order.iter().zip(&joined.representative) {
        groups[vertex as usize] = representative;
    }
    groups
}

/// Numbers, in Morton order, the groups that proper triangles use.
fn number_used_groups(triangles: impl Iterator<Item = [u32; 3]>, group_count: usize) -> Vec<u32> {
    let mut number = vec![NONE; group_count];
    for corners in triangles {
        if !has_unusable_corner(corners) && !is_collapsed(corners) {
            for group in corners {
                number[group as usize] = 0;
            }
        }
    }
    for (next, number) in (0..).zip(number.iter_mut().filter(|number| **number != NONE)) {
        *number = next;
    }
    number
}

/// The proper triangles without duplicates, and the drawn triangle that each came from.
///
/// They are sorted by lowest, middle and highest vertex, so that triangles near each other are near in memory; corners
/// keep their drawn order. `in_surface` gives [`NONE`] for a corner that no proper triangle uses, so it alone tells
/// which triangles are proper.
fn sort_triangles(
    count: usize,
    in_surface: impl Fn(usize) -> [u32; 3] + Sync,
    vertex_count: usize,
    duplicates: &mut Finding,
) -> (Vec<[SurfaceVertex; 3]>, Vec<u32>) {
    let lowest: Vec<u32> = (0..count)
        .into_par_iter()
        .map(|t| {
            let [a, b, c] = in_surface(t);
            let is_proper = !has_unusable_corner([a, b, c]) && !is_collapsed([a, b, c]);
            if is_proper { a.min(b).min(c) } else { NONE }
        })
        .collect();

    // Counting sort by lowest vertex. The starts are shifted by one row: filling a row advances its start to the next
    // row's.
    let mut starts = vec![0u32; vertex_count + 2];
    for &v in lowest.iter().filter(|&&v| v != NONE) {
        starts[v as usize + 2] += 1;
    }
    for v in 2..starts.len() {
        starts[v] += starts[v - 1];
    }
    let mut sorted = vec![0u32; starts[vertex_count + 1] as usize];
    for (t, &v) in (0..).zip(&lowest) {
        if v != NONE {
            let place = &mut starts[v as usize + 1];
            sorted[*place as usize] = t;
            *place += 1;
        }
    }
    drop(lowest);

    let mut repeated = Vec::new();
    let mut row: Vec<(u32, u32, u32)> = Vec::new();
    // Rows only shrink, so the result overwrites rows that have already been read.
    let mut end = 0;
    for v in 0..vertex_count {
        row.clear();
        row.extend(sorted[starts[v] as usize..starts[v + 1] as usize].iter().map(|&t| {
            let mut corners = in_surface(t as usize);
            corners.sort_unstable();
            (corners[1], corners[2], t)
        }));
        row.sort_unstable();
        let mut previous = None;
        for &(middle, highest, t) in &row {
            if previous == Some((middle, highest)) {
                repeated.push(t);
            } else {
                sorted[end] = t;
                end += 1;
            }
            previous = Some((middle, highest));
        }
    }
    drop(starts);
    sorted.truncate(end);
    repeated.sort_unstable();
    *duplicates = Finding::of(&repeated);
    let triangles = sorted
        .par_iter()
        .map(|&t| in_surface(t as usize).map(SurfaceVertex))
        .collect();
    (triangles, sorted)
}
