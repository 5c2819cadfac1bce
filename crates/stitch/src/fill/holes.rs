//! The choice of the borders to fill, and words about the others.
//!
//! The outer border of an open sheet is a border, too, but filling it closes the sheet to a bag. A component is an open
//! sheet if its area vector (the sum of its triangles' areas times their normals, which its borders alone determine) is
//! at least half as long as its area. This is one for a flat piece, a half for a half sphere, and near zero for a closed
//! surface with small holes or a tube. The outer border is the one that spans the most in the opposite direction.

use glam::DVec3;
use pliant_mesh::{FileVertex, Model};

use crate::borders::{Border, Borders};
use crate::error::{BorderFault, StitchError};

/// The holes to fill.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub enum Holes {
    /// All holes. The outer border of an open sheet is none.
    #[default]
    Every,
    /// This many of the borders with the largest lengths.
    Largest(usize),
    /// The borders that pass this vertex, numbered as in the file.
    At(u32),
    /// A tube between the borders that pass these vertices, numbered as in the file.
    Between([u32; 2]),
}

/// Borders that are not filled, for one reason.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Unfilled {
    /// The reason.
    pub reason: Reason,
    /// How many they are.
    pub count: usize,
    /// A vertex of the first, numbered as in the file.
    pub vertex: u32,
}

/// The reason why a border is not filled.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Reason {
    /// It has a fault.
    Faulty(BorderFault),
    /// It is the outer border of an open sheet, and was not named.
    Outer,
}

impl std::fmt::Display for Unfilled {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Self { reason, count, vertex } = self;
        let (borders, stay, each) = match count {
            1 => (format!("the border at vertex {vertex}"), "stays", "it"),
            _ => (
                format!("{count} borders (the first at vertex {vertex})"),
                "stay",
                "each of them",
            ),
        };
        match reason {
            Reason::Faulty(fault) => write!(f, "{borders} {stay} open: {each} {fault}"),
            Reason::Outer => write!(
                f,
                "{borders} {stay} open: {each} is the outer border of an open sheet, which is filled only if it is \
                 picked in the window, or named by a vertex or by its length"
            ),
        }
    }
}

/// The share of a component's area from which on its area vector makes it an open sheet.
const SHEET: f64 = 0.5;

/// The numbers of the borders to fill, and the others that `holes` means.
pub(super) fn chosen(
    model: &Model,
    borders: &Borders,
    holes: Holes,
) -> Result<(Vec<usize>, Vec<Unfilled>), StitchError> {
    if borders.sound.is_empty() && borders.faulty.is_empty() {
        return Err(match holes {
            Holes::Every | Holes::Largest(_) => StitchError::NoHole,
            Holes::At(_) | Holes::Between(_) => StitchError::NoBorder,
        });
    }
    let at = |vertex: u32| {
        let count = model.drawn.file_vertex_count();
        if vertex as usize >= count {
            return Err(StitchError::NoVertex { vertex, count });
        }
        borders.at(vertex, model.surface_of_file().of(FileVertex(vertex)), model)
    };
    match holes {
        Holes::At(vertex) => return Ok((at(vertex)?, Vec::new())),
        Holes::Between(vertices) => {
            let [first, second] = [at(vertices[0])?, at(vertices[1])?];
            let mut pairs = first
                .iter()
                .flat_map(|one| second.iter().map(move |other| [*one, *other]));
            let pair = pairs.find(|[one, other]| one != other);
            return match pair {
                Some(pair) => Ok((pair.to_vec(), Vec::new())),
                None => Err(StitchError::SameBorder { vertices }),
            };
        }
        Holes::Every | Holes::Largest(_) => {}
    }
    if borders.sound.is_empty() {
        return Err(borders.refusal(0, model));
    }
    let mut unfilled = faulty(model, borders);
    if let Holes::Largest(count) = holes {
        return Ok(((0..count.min(borders.sound.len())).collect(), unfilled));
    }
    let outer = outer_borders(model, &borders.sound);
    let inner: Vec<usize> = (0..borders.sound.len())
        .filter(|number| !outer.contains(number))
        .collect();
    if let Some(&first) = outer.first() {
        let vertex = model.first_file_vertex(borders.sound[first].vertices[0]).0;
        if inner.is_empty() {
            return Err(StitchError::OnlyOuterBorders { vertex });
        }
        unfilled.push(Unfilled {
            reason: Reason::Outer,
            count: outer.len(),
            vertex,
        });
    }
    Ok((inner, unfilled))
}

/// The faulty borders by their faults.
fn faulty(model: &Model, borders: &Borders) -> Vec<Unfilled> {
    let mut out: Vec<Unfilled> = Vec::new();
    for &(vertex, fault) in &borders.faulty {
        let reason = Reason::Faulty(fault);
        match out.iter_mut().find(|own| own.reason == reason) {
            Some(own) => own.count += 1,
            None => out.push(Unfilled {
                reason,
                count: 1,
                vertex: model.first_file_vertex(vertex).0,
            }),
        }
    }
    out
}

/// The numbers of the borders that are the outer ones of open sheets, ascending.
fn outer_borders(model: &Model, sound: &[Border]) -> Vec<usize> {
    let count = model.topology.components().len();
    // The area vector and the area of each component.
    let mut areas = vec![(DVec3::ZERO, 0.0); count];
    for (face, corners) in model.surface.triangles.iter().enumerate() {
        let [a, b, c] = model.surface.corners(face);
        let area = 0.5 * (b - a).cross(c - a);
        let own = &mut areas[model.topology.component(corners[0]) as usize];
        own.0 += area;
        own.1 += area.length();
    }
    // For each component its border that spans the most against the area vector.
    let mut outer: Vec<Option<(f64, usize)>> = vec![None; count];
    for (number, border) in sound.iter().enumerate() {
        let component = model.topology.component(border.vertices[0]) as usize;
        let (vector, area) = areas[component];
        if vector.length() < SHEET * area {
            continue;
        }
        let spanned = -spanned(model, border).dot(vector);
        if spanned > 0.0 && outer[component].is_none_or(|(most, _)| spanned > most) {
            outer[component] = Some((spanned, number));
        }
    }
    let mut numbers: Vec<usize> = outer.into_iter().flatten().map(|(_, number)| number).collect();
    numbers.sort_unstable();
    numbers
}

/// The area vector of any surface inside a border, in the direction of the triangles that would fill it.
fn spanned(model: &Model, border: &Border) -> DVec3 {
    let positions = &model.surface.positions;
    let origin = positions[border.vertices[0].index()];
    let point = |k: usize| positions[border.vertices[k % border.vertices.len()].index()] - origin;
    let halves = (0..border.vertices.len()).map(|k| point(k).cross(point(k + 1)));
    0.5 * halves.sum::<DVec3>()
}
