//! Fills holes: triangles of least weight on the rim, as dense as the surrounding surface, faired [Lie03].
//!
//! Each hole is a separate task, which needs the rim and one ring of triangles around it. So a thousand small holes
//! take as long as their patches, for any size of the surface.

mod divide;
mod fair;
mod flips;
mod patch;
mod refine;
mod rim;
mod triangulate;

use glam::DVec3;
use pliant_deform::{BindError, Budget};
use pliant_mesh::{Cancel, Model, Progress, SurfaceVertex};
use rayon::prelude::*;

use crate::borders::{Border, Borders};
use crate::error::StitchError;
use crate::part::face_beyond;
use fair::{Surroundings, refine_and_fair};
use patch::Patch;
use rim::Rim;
use triangulate::triangulate;

/// The holes to fill.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub enum Holes {
    /// All holes.
    #[default]
    Every,
    /// This many of the holes with the longest rims.
    Largest(usize),
    /// The holes whose rims pass this vertex, numbered as in the file.
    At(u32),
}

/// The triangles that fill a hole.
#[derive(Clone, PartialEq, Debug)]
pub struct FilledHole {
    /// The rim.
    pub border: Border,
    /// The points inside.
    pub points: Vec<DVec3>,
    /// They are counterclockwise. Corners below the rim's count are places in the rim; higher ones are points inside.
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
    /// The refusals of faulty borders that were skipped.
    pub passed_over: Vec<StitchError>,
}

/// Computes patches for holes of a model.
///
/// # Errors
/// [`StitchError::NoBorder`], a vertex on no border, or a faulty border if there is no sound one to fill;
/// [`StitchError::Cancelled`] soon after `cancel` is raised.
pub fn fill(
    model: &Model,
    holes: Holes,
    budget: Budget,
    progress: &Progress,
    cancel: &Cancel,
) -> Result<Filled, StitchError> {
    let borders = Borders::of(model);
    cancel.check()?;
    let chosen = chosen(model, &borders, holes)?;
    let shared = shared_vertices(&borders);
    let done = std::sync::atomic::AtomicUsize::new(0);
    let filled: Vec<Result<FilledHole, StitchError>> = chosen
        .par_iter()
        .map(|&number| {
            cancel.check()?;
            let hole = fill_one(model, &borders.sound[number], &shared, budget, cancel)?;
            let count = done.fetch_add(1, std::sync::atomic::Ordering::Relaxed) + 1;
            progress.set(count as f32 / chosen.len() as f32);
            Ok(hole)
        })
        .collect();
    let passed_over = match holes {
        Holes::At(_) => Vec::new(),
        Holes::Every | Holes::Largest(_) => {
            let faulty = 0..borders.faulty.len();
            faulty.map(|number| borders.refusal(number, model)).collect()
        }
    };
    Ok(Filled {
        holes: filled.into_iter().collect::<Result<_, _>>()?,
        passed_over,
    })
}

/// The numbers of the borders to fill.
fn chosen(model: &Model, borders: &Borders, holes: Holes) -> Result<Vec<usize>, StitchError> {
    if borders.sound.is_empty() && borders.faulty.is_empty() {
        return Err(StitchError::NoBorder);
    }
    if let Holes::At(vertex) = holes {
        let count = model.drawn.file_vertex_count();
        if vertex as usize >= count {
            return Err(StitchError::NoVertex { vertex, count });
        }
        let of_file = model.surface_of_file();
        return borders.at(vertex, of_file.of(pliant_mesh::FileVertex(vertex)), model);
    }
    if borders.sound.is_empty() {
        return Err(borders.refusal(0, model));
    }
    let most = match holes {
        Holes::Largest(count) => count.min(borders.sound.len()),
        _ => borders.sound.len(),
    };
    Ok((0..most).collect())
}

/// The vertices that more than one border passes, ascending.
fn shared_vertices(borders: &Borders) -> Vec<SurfaceVertex> {
    let mut all: Vec<SurfaceVertex> = borders
        .sound
        .iter()
        .flat_map(|border| &border.vertices)
        .copied()
        .collect();
    all.sort_unstable();
    let mut shared: Vec<SurfaceVertex> = all
        .windows(2)
        .filter(|pair| pair[0] == pair[1])
        .map(|pair| pair[0])
        .collect();
    shared.dedup();
    shared
}

/// Fills one hole.
fn fill_one(
    model: &Model,
    border: &Border,
    shared: &[SurfaceVertex],
    budget: Budget,
    cancel: &Cancel,
) -> Result<FilledHole, StitchError> {
    let site = Site::of(model, border, shared);
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
    let mut patch = Patch::new(points, rim, triangles, site.joined.clone());
    let faired = refine_and_fair(&mut patch, &mut scales, &site.around, budget, cancel);
    let is_faired = match faired {
        Ok(()) => true,
        Err(BindError::Cancelled(cancelled)) => return Err(cancelled.into()),
        Err(_) => false,
    };
    Ok(FilledHole {
        border: border.clone(),
        points: patch.points.split_off(rim),
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
    /// The pairs of [`Rim::joined`].
    joined: Vec<[u32; 2]>,
    around: Surroundings,
}

impl Site {
    fn of(model: &Model, border: &Border, shared: &[SurfaceVertex]) -> Self {
        let (surface, topology) = (&model.surface, &model.topology);
        let rim = &border.vertices;
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
            let (from, to) = (rim[k], rim[(k + 1) % rim.len()]);
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
            joined: joined(model, rim, place, shared),
            around,
        }
    }
}

/// The pairs of places in a rim, not next to each other, that an edge of the surface joins, or that the patch of
/// another hole could join.
fn joined(
    model: &Model,
    rim: &[SurfaceVertex],
    place: impl Fn(SurfaceVertex) -> Option<u32>,
    shared: &[SurfaceVertex],
) -> Vec<[u32; 2]> {
    let mut joined = Vec::new();
    let is_shared = |vertex: SurfaceVertex| shared.binary_search(&vertex).is_ok();
    let with_others: Vec<u32> = (0..).zip(rim).filter(|(_, v)| is_shared(**v)).map(|(k, _)| k).collect();
    for (own, &vertex) in (0..).zip(rim) {
        let others = model
            .topology
            .neighbours(vertex)
            .iter()
            .filter_map(|&other| place(other));
        joined.extend(others.filter(|&other| own < other).map(|other| [own, other]));
        if with_others.binary_search(&own).is_ok() {
            joined.extend(
                with_others
                    .iter()
                    .filter(|&&other| own < other)
                    .map(|&other| [own, other]),
            );
        }
    }
    let last = rim.len() as u32 - 1;
    joined.retain(|&[a, b]| a + 1 != b && !(a == 0 && b == last));
    joined.sort_unstable();
    joined.dedup();
    joined
}
