//! From drawn vertices and triangles to a welded surface, with everything that was left out counted.

use rayon::prelude::*;

use crate::finding::collect;
use crate::geometry::{bounds_of, is_without_area};
use crate::joining::{self, Joined};
use crate::{Cancel, Cancelled, Drawn, FileVertex, Finding, Findings, Progress, Surface, SurfaceVertex, WeldOptions};

/// Coordinates beyond this count as not finite: areas and volumes of such a mesh would overflow.
const LARGEST_COORDINATE: f64 = 1e60;

/// Larger tolerances than this share of the diagonal are taken as this one: they would eat the mesh.
const LARGEST_TOLERANCE: f64 = 1e-4;

/// What welding makes.
pub(crate) struct Welded {
    pub(crate) surface: Surface,
    pub(crate) surface_of_drawn: Vec<Option<SurfaceVertex>>,
    pub(crate) drawn_triangle_of_surface: Vec<u32>,
    /// The lowest file vertex behind each surface vertex.
    pub(crate) first_file_vertex: Vec<FileVertex>,
    /// Those findings that are about file vertices and triangles; the topology's are still empty.
    pub(crate) findings: Findings,
}

/// What uses a drawn vertex.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Use {
    None,
    LeftOutTriangle,
    Triangle,
}

/// Welds `drawn`; progress goes from 0 to 0.6.
pub(crate) fn weld(
    drawn: &Drawn,
    options: &WeldOptions,
    progress: &Progress,
    cancel: &Cancel,
) -> Result<Welded, Cancelled> {
    let mut findings = Findings::default();
    let usable: Vec<bool> = drawn
        .positions
        .par_iter()
        .map(|p| p.is_finite() && p.abs().max_element() <= LARGEST_COORDINATE)
        .collect();
    let uses = uses_of_vertices(drawn, &usable);
    report_vertices(drawn, &usable, &uses, &mut findings);
    cancel.check()?;
    progress.set(0.1);

    let members: Vec<u32> = (0..uses.len() as u32)
        .filter(|&v| uses[v as usize] == Use::Triangle)
        .collect();
    let Some(bounds) = bounds_of(members.par_iter().map(|&v| drawn.positions[v as usize])) else {
        findings.non_finite_triangles = collect(drawn.triangles.len(), |_| true);
        return Ok(nothing_to_weld(drawn, findings));
    };
    let tolerance = options
        .tolerance
        .map(|share| share.clamp(0.0, LARGEST_TOLERANCE) * bounds.diagonal());
    let joined = joining::join(&drawn.positions, &members, &bounds, tolerance);
    cancel.check()?;
    progress.set(0.35);

    let group_of_drawn = groups_by_vertex(drawn.positions.len(), &joined);
    let corners: Vec<[u32; 3]> = drawn
        .triangles
        .par_iter()
        .map(|triangle| triangle.map(|v| group_of_drawn[v.index()]))
        .collect();
    findings.non_finite_triangles = collect(corners.len(), |t| has_unusable_corner(corners[t]));
    findings.collapsed_triangles = collect(corners.len(), |t| {
        !has_unusable_corner(corners[t]) && is_collapsed(corners[t])
    });
    let surface_of_group = number_used_groups(&corners, joined.order.len());
    cancel.check()?;
    progress.set(0.45);

    let (triangles, drawn_triangle_of_surface) =
        sort_triangles(&corners, &surface_of_group, &mut findings.duplicate_triangles);
    let positions: Vec<_> = (0..joined.order.len())
        .filter(|&group| surface_of_group[group] != NONE)
        .map(|group| drawn.positions[joined.order[group] as usize])
        .collect();
    let surface_of_drawn: Vec<Option<SurfaceVertex>> = group_of_drawn
        .par_iter()
        .map(|&group| match group {
            NONE => None,
            group => Some(surface_of_group[group as usize])
                .filter(|&s| s != NONE)
                .map(SurfaceVertex),
        })
        .collect();
    let mut first_file_vertex = vec![FileVertex(u32::MAX); positions.len()];
    for (surface_vertex, &file_vertex) in surface_of_drawn.iter().zip(&drawn.file_vertex) {
        if let Some(s) = surface_vertex {
            first_file_vertex[s.index()] = first_file_vertex[s.index()].min(file_vertex);
        }
    }
    let surface = Surface { positions, triangles };
    findings.zero_area_triangles = collect(surface.triangles.len(), |t| is_without_area(surface.corners(t)))
        .renamed(|t| drawn_triangle_of_surface[t as usize]);
    progress.set(0.6);
    Ok(Welded {
        surface,
        surface_of_drawn,
        drawn_triangle_of_surface,
        first_file_vertex,
        findings,
    })
}

/// No group, no surface vertex.
const NONE: u32 = u32::MAX;

fn has_unusable_corner(corners: [u32; 3]) -> bool {
    corners.contains(&NONE)
}

fn is_collapsed([a, b, c]: [u32; 3]) -> bool {
    a == b || b == c || c == a
}

/// Triangles with an unusable corner don't count as users: their other corners would float.
fn uses_of_vertices(drawn: &Drawn, usable: &[bool]) -> Vec<Use> {
    let mut uses = vec![Use::None; drawn.positions.len()];
    for triangle in &drawn.triangles {
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

/// Finds the file's vertices that are not finite or that no triangle uses.
fn report_vertices(drawn: &Drawn, usable: &[bool], uses: &[Use], findings: &mut Findings) {
    let mut is_used = vec![false; drawn.file_vertex_count];
    let mut is_bad = vec![false; drawn.file_vertex_count];
    for (v, file_vertex) in drawn.file_vertex.iter().enumerate() {
        let Some(is_used) = is_used.get_mut(file_vertex.index()) else {
            continue;
        };
        *is_used |= uses[v] != Use::None;
        is_bad[file_vertex.index()] |= !usable[v];
    }
    findings.non_finite_vertices = collect(drawn.file_vertex_count, |v| is_bad[v]);
    findings.unreferenced_vertices = collect(drawn.file_vertex_count, |v| !is_used[v]);
}

fn nothing_to_weld(drawn: &Drawn, findings: Findings) -> Welded {
    Welded {
        surface: Surface::default(),
        surface_of_drawn: vec![None; drawn.positions.len()],
        drawn_triangle_of_surface: Vec::new(),
        first_file_vertex: Vec::new(),
        findings,
    }
}

/// The place of each vertex's representative, [`NONE`] for vertices that took no part.
fn groups_by_vertex(vertex_count: usize, joined: &Joined) -> Vec<u32> {
    let mut groups = vec![NONE; vertex_count];
    for (&vertex, &representative) in joined.order.iter().zip(&joined.representative) {
        groups[vertex as usize] = representative;
    }
    groups
}

/// Numbers the groups that proper triangles use, in Morton order.
fn number_used_groups(corners: &[[u32; 3]], group_count: usize) -> Vec<u32> {
    let mut number = vec![NONE; group_count];
    for &corners in corners {
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

/// A triangle on its way into the sorted list: middle and highest vertex, drawn triangle.
type Sorted = (u32, u32, u32);

/// The proper triangles by lowest, middle and highest vertex, so that triangles near each other are near in memory,
/// without those that repeat an earlier one; corners stay in drawn order.
fn sort_triangles(
    corners: &[[u32; 3]],
    surface_of_group: &[u32],
    duplicates: &mut Finding,
) -> (Vec<[SurfaceVertex; 3]>, Vec<u32>) {
    let vertex_count = surface_of_group.iter().filter(|&&s| s != NONE).count();
    let in_surface = |t: usize| corners[t].map(|group| surface_of_group[group as usize]);
    let is_proper = |t: &usize| !has_unusable_corner(corners[*t]) && !is_collapsed(corners[*t]);

    // Counting sort by lowest vertex.
    let mut starts = vec![0u32; vertex_count + 1];
    for t in (0..corners.len()).filter(is_proper) {
        let [a, b, c] = in_surface(t);
        starts[a.min(b).min(c) as usize + 1] += 1;
    }
    for v in 0..vertex_count {
        starts[v + 1] += starts[v];
    }
    let mut sorted: Vec<Sorted> = vec![(0, 0, 0); starts[vertex_count] as usize];
    let mut next = starts.clone();
    for t in (0..corners.len()).filter(is_proper) {
        let mut of_triangle = in_surface(t);
        of_triangle.sort_unstable();
        let place = &mut next[of_triangle[0] as usize];
        sorted[*place as usize] = (of_triangle[1], of_triangle[2], t as u32);
        *place += 1;
    }

    let mut repeated = Vec::new();
    let mut drawn_triangles = Vec::with_capacity(sorted.len());
    for v in 0..vertex_count {
        let group = &mut sorted[starts[v] as usize..starts[v + 1] as usize];
        group.sort_unstable();
        let mut previous = None;
        for &(middle, highest, t) in group.iter() {
            if previous == Some((middle, highest)) {
                repeated.push(t);
            } else {
                drawn_triangles.push(t);
            }
            previous = Some((middle, highest));
        }
    }
    repeated.sort_unstable();
    *duplicates = Finding::of(&repeated);
    let triangles = drawn_triangles
        .par_iter()
        .map(|&t| in_surface(t as usize).map(SurfaceVertex))
        .collect();
    (triangles, drawn_triangles)
}
