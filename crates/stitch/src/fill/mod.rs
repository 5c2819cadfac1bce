//! Fills holes: triangles of least weight on the rim, as dense as the surrounding surface, faired [Lie03].
//!
//! Each hole is a separate task, which needs the rim and one ring of triangles around it. So a thousand small holes
//! take as long as their patches, for any size of the surface.

mod divide;
mod fair;
mod flips;
mod holes;
mod patch;
mod refine;
mod rim;
mod triangulate;
mod tube;

use glam::DVec3;
use pliant_deform::{BindError, Budget};
use pliant_mesh::{Cancel, Model, Progress, SurfaceVertex};
use rayon::prelude::*;

use crate::borders::{Border, Borders, Loops};
use crate::error::StitchError;
use crate::part::face_beyond;
use fair::{Surroundings, fair_ends, refine_and_fair};
use holes::chosen;
pub use holes::{Holes, Reason, Unfilled};
use patch::Patch;
use rim::{Joined, Rim};
use triangulate::triangulate;
use tube::Tube;

/// The triangles that fill a hole, or the tube between two borders.
#[derive(Clone, PartialEq, Debug)]
pub struct FilledHole {
    /// The rim: one border, or the two that the tube joins.
    pub borders: Vec<Border>,
    /// The points inside.
    pub points: Vec<DVec3>,
    /// They are counterclockwise. Corners below the count of the borders' vertices are places in the list of these;
    /// higher ones are points inside.
    pub triangles: Vec<[u32; 3]>,
    /// True if the points inside are faired. If the equations could not be solved, the patch has its shape after
    /// triangulation.
    pub is_faired: bool,
}

/// The result of filling.
#[derive(Clone, PartialEq, Debug, Default)]
pub struct Filled {
    /// The filled holes by falling length of their rims.
    pub holes: Vec<FilledHole>,
    /// The other borders that the request means, by the reason why they stay open.
    pub unfilled: Vec<Unfilled>,
}

/// Computes patches for holes of a model.
///
/// # Errors
/// [`StitchError::NoBorder`], a vertex on no border, a faulty border if there is no sound one to fill, or
/// [`StitchError::OnlyOuterBorders`]; [`StitchError::Cancelled`] soon after `cancel` is raised.
pub fn fill(
    model: &Model,
    holes: Holes,
    budget: Budget,
    progress: &Progress,
    cancel: &Cancel,
) -> Result<Filled, StitchError> {
    let borders = Borders::of(model);
    cancel.check()?;
    let (chosen, unfilled) = chosen(model, &borders, holes)?;
    let shared = SharedVertices::of(&borders);
    if let Holes::Between(_) = holes {
        let tube = tube(model, &borders, &chosen, (&shared, budget, cancel))?;
        return Ok(Filled {
            holes: vec![tube],
            unfilled,
        });
    }
    let done = std::sync::atomic::AtomicUsize::new(0);
    let filled: Vec<Result<FilledHole, StitchError>> = chosen
        .par_iter()
        .map(|&number| {
            cancel.check()?;
            let hole = fill_one(
                model,
                &borders.sound[number],
                &shared.of_others(&[number]),
                budget,
                cancel,
            )?;
            let count = done.fetch_add(1, std::sync::atomic::Ordering::Relaxed) + 1;
            progress.set(count as f32 / chosen.len() as f32);
            Ok(hole)
        })
        .collect();
    Ok(Filled {
        holes: filled.into_iter().collect::<Result<_, _>>()?,
        unfilled,
    })
}

/// The vertices that more than one border passes.
struct SharedVertices {
    /// Each with the number of a border that passes it, ascending.
    borders: Vec<(SurfaceVertex, u32)>,
}

impl SharedVertices {
    fn of(borders: &Borders) -> Self {
        let numbered = (0..).zip(&borders.sound);
        let passes = numbered.flat_map(|(number, border)| border.vertices.iter().map(move |&v| (v, number)));
        let mut all: Vec<(SurfaceVertex, u32)> = passes.collect();
        all.sort_unstable();
        let of_several = all.chunk_by(|a, b| a.0 == b.0).filter(|own| own.len() > 1);
        Self {
            borders: of_several.flatten().copied().collect(),
        }
    }

    /// The borders through a vertex besides these.
    fn of_others<'a>(&'a self, numbers: &'a [usize]) -> impl Fn(SurfaceVertex) -> Vec<u32> + 'a {
        move |vertex| {
            let first = self.borders.partition_point(|(own, _)| *own < vertex);
            let own = self.borders[first..].iter().take_while(|(own, _)| *own == vertex);
            own.map(|(_, border)| *border)
                .filter(|border| !numbers.contains(&(*border as usize)))
                .collect()
        }
    }
}

/// Fills one hole.
fn fill_one(
    model: &Model,
    border: &Border,
    others: &dyn Fn(SurfaceVertex) -> Vec<u32>,
    budget: Budget,
    cancel: &Cancel,
) -> Result<FilledHole, StitchError> {
    let borders = vec![border.clone()];
    let site = Site::of(model, &Loops::of(&borders), others);
    let rim = border.vertices.len();
    let outline = Rim {
        points: &site.points,
        beyond: &site.beyond,
        joined: &site.joined,
    };
    let mut points = site.points.clone();
    let mut scales = site.scales.clone();
    let triangles = triangulate(&outline).unwrap_or_else(|| {
        // A fan around a new point fills any rim.
        points.push(site.points.iter().sum::<DVec3>() / rim as f64);
        scales.push(site.scales.iter().sum::<f64>() / rim as f64);
        (0..rim as u32).map(|k| [k, (k + 1) % rim as u32, rim as u32]).collect()
    });
    let mut patch = Patch::new(points, rim, triangles, site.joined);
    let faired = refine_and_fair(&mut patch, scales, &site.around, budget, cancel);
    finished(borders, patch, faired)
}

/// Joins two borders by a tube.
fn tube(
    model: &Model,
    borders: &Borders,
    chosen: &[usize],
    (shared, budget, cancel): (&SharedVertices, Budget, &Cancel),
) -> Result<FilledHole, StitchError> {
    let own: Vec<Border> = chosen.iter().map(|&number| borders.sound[number].clone()).collect();
    let loops = Loops::of(&own);
    let mut distinct = loops.vertices.clone();
    distinct.sort_unstable();
    distinct.dedup();
    if distinct.len() < loops.count() {
        let at = |k: usize| model.first_file_vertex(own[k].vertices[0]).0;
        return Err(StitchError::BordersTouch {
            vertices: [at(0), at(1)],
        });
    }
    let site = Site::of(model, &loops, &shared.of_others(chosen));
    let spacing = site.scales.iter().sum::<f64>() / site.scales.len() as f64;
    let tube = Tube::between(&site.points, own[0].vertices.len(), spacing);
    let points = [&site.points[..], &tube.points].concat();
    let mut patch = Patch::new(points, loops.count(), tube.triangles, site.joined);
    let faired = fair_ends(&mut patch, &tube.is_near_border, &site.around, budget, cancel);
    finished(own, patch, faired)
}

/// The finished patch, if it was not cancelled.
fn finished(borders: Vec<Border>, mut patch: Patch, faired: Result<(), BindError>) -> Result<FilledHole, StitchError> {
    let is_faired = match faired {
        Ok(()) => true,
        Err(BindError::Cancelled(cancelled)) => return Err(cancelled.into()),
        Err(_) => false,
    };
    Ok(FilledHole {
        borders,
        points: patch.points.split_off(patch.rim),
        triangles: patch.triangles,
        is_faired,
    })
}

/// A hole's surroundings.
struct Site {
    /// The rim's points.
    points: Vec<DVec3>,
    /// For each edge of the rim the third corner of the triangle beyond it.
    beyond: Vec<DVec3>,
    /// For each point of the rim the mean length of the surface's edges there.
    scales: Vec<f64>,
    /// As [`Rim::joined`].
    joined: Joined,
    around: Surroundings,
}

impl Site {
    fn of(model: &Model, loops: &Loops, other_borders: &dyn Fn(SurfaceVertex) -> Vec<u32>) -> Self {
        let (surface, topology) = (&model.surface, &model.topology);
        let rim = &loops.vertices;
        let position = |vertex: SurfaceVertex| surface.positions[vertex.index()];
        let mut place_of: Vec<(SurfaceVertex, u32)> = rim.iter().copied().zip(0..).collect();
        place_of.sort_unstable();
        let place = |vertex: SurfaceVertex| {
            let found = place_of.binary_search_by_key(&vertex, |(own, _)| *own);
            found.ok().map(|found| place_of[found].1)
        };
        let mut faces: Vec<u32> = rim
            .iter()
            .flat_map(|&v| topology.faces(v, &surface.triangles))
            .collect();
        faces.sort_unstable();
        faces.dedup();
        let mut others: Vec<SurfaceVertex> = faces
            .iter()
            .flat_map(|&face| surface.triangles[face as usize])
            .collect();
        others.sort_unstable();
        others.dedup();
        others.retain(|&vertex| place(vertex).is_none());
        let number = |vertex: SurfaceVertex| {
            let beyond = others.partition_point(|&other| other < vertex) + rim.len();
            place(vertex).unwrap_or(beyond as u32)
        };
        let triangles = faces.iter().map(|&face| surface.triangles[face as usize].map(number));
        let around = Surroundings {
            points: others.iter().map(|&vertex| position(vertex)).collect(),
            triangles: triangles.collect(),
        };
        let beyond = (0..rim.len()).map(|k| {
            let (from, to) = (rim[k], rim[loops.next(k)]);
            let corners = face_beyond(model, from, to).map(|face| surface.triangles[face]);
            let third = corners.and_then(|corners| corners.into_iter().find(|v| *v != from && *v != to));
            position(third.unwrap_or(from))
        });
        let scale = |&vertex: &SurfaceVertex| {
            let own = topology.neighbours(vertex);
            own.iter()
                .map(|&other| position(vertex).distance(position(other)))
                .sum::<f64>()
                / own.len().max(1) as f64
        };
        Self {
            points: rim.iter().map(|&vertex| position(vertex)).collect(),
            beyond: beyond.collect(),
            scales: rim.iter().map(scale).collect(),
            joined: joined(model, loops, place, other_borders),
            around,
        }
    }
}

/// The pairs of a rim's points that an edge of the surface joins, or that the patch of another hole could join.
fn joined(
    model: &Model,
    loops: &Loops,
    place: impl Fn(SurfaceVertex) -> Option<u32>,
    other_borders: &dyn Fn(SurfaceVertex) -> Vec<u32>,
) -> Joined {
    let mut joined = Joined::default();
    for (own, &vertex) in (0..).zip(&loops.vertices) {
        let neighbours = model.topology.neighbours(vertex).iter();
        let others = neighbours.filter_map(|&other| place(other));
        let beside = [loops.next(own as usize), loops.before(own as usize)];
        let is_inside = |other: &u32| own < *other && !beside.contains(&(*other as usize));
        joined.edges.extend(others.filter(is_inside).map(|other| [own, other]));
        let borders = other_borders(vertex).into_iter();
        joined.on_others.extend(borders.map(|border| (own, border)));
    }
    joined.edges.sort_unstable();
    joined.edges.dedup();
    joined
}
