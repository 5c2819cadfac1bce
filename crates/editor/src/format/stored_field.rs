//! A field over the vertices in a project: the vertices, as ranges of the file's drawn vertices, and their numbers as
//! base64 of little-endian f64, because text would be three times as long and slow to read.
//!
//! Drawn vertices have the file's own order, so that a project stays readable when welding changes; welded twins share
//! one value, stored at the lowest of them.

use std::ops::RangeInclusive;
use std::sync::Arc;

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use glam::DVec3;
use pliant_mesh::{DrawnVertex, Model, SurfaceVertex};
use serde::{Deserialize, Serialize};

use crate::EditError;
use crate::document::Dye;
use crate::format::selector::ranges_of;

/// First and last drawn vertex of runs, ascending.
pub(crate) type Ranges = Vec<[u32; 2]>;

/// Values at some vertices.
#[derive(Clone, PartialEq, Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Field {
    vertices: Ranges,
    f64_base64: String,
}

impl Field {
    /// The values, `N` numbers each, of the vertices for which `value` returns some; `None` if it returns none.
    pub(crate) fn of<const N: usize>(
        model: &Model,
        mut value: impl FnMut(SurfaceVertex) -> Option<[f64; N]>,
    ) -> Option<Self> {
        let mut is_stored = vec![false; model.drawn.vertex_count()];
        let mut bytes = Vec::new();
        let mut is_seen = vec![false; model.surface.positions.len()];
        for (drawn, vertex) in model.drawn.surface_vertices().enumerate() {
            let Some(vertex) = vertex else { continue };
            if std::mem::replace(&mut is_seen[vertex.index()], true) {
                continue;
            }
            if let Some(numbers) = value(vertex) {
                is_stored[drawn] = true;
                bytes.extend(numbers.iter().flat_map(|number| number.to_le_bytes()));
            }
        }
        (!bytes.is_empty()).then(|| Self {
            vertices: ranges_of(&is_stored),
            f64_base64: STANDARD.encode(bytes),
        })
    }

    /// The stored numbers, in the order of the vertices.
    fn stored<const N: usize>(&self, name: &str) -> Result<Vec<[f64; N]>, EditError> {
        let bytes = STANDARD
            .decode(&self.f64_base64)
            .map_err(|error| EditError::Project(format!("`{name}` is not base64 ({error}): save it again")))?;
        let stored: u64 = self
            .vertices
            .iter()
            .map(|[a, b]| u64::from(b.saturating_sub(*a)) + 1)
            .sum();
        if bytes.len() as u64 != stored * (8 * N) as u64 {
            return Err(EditError::Project(format!(
                "`{name}` has {} bytes for {stored} vertices, but each needs {}: save it again",
                bytes.len(),
                8 * N
            )));
        }
        let number = |bytes: &[u8]| bytes.try_into().map_or(f64::NAN, f64::from_le_bytes);
        let each = bytes.chunks_exact(8 * N).map(|bytes| {
            let mut numbers = bytes.chunks_exact(8).map(number);
            std::array::from_fn(|_| numbers.next().unwrap_or(f64::NAN))
        });
        Ok(each.collect())
    }

    /// The numbers of each of `count` drawn vertices, 0 where none are stored.
    ///
    /// # Errors
    /// A vertex that is not among them, too many or too few numbers, or one that is not finite.
    pub(super) fn by_number<const N: usize>(&self, name: &str, count: usize) -> Result<Vec<[f64; N]>, EditError> {
        let stored = self.stored::<N>(name)?;
        let mut all = vec![[0.0; N]; count];
        let vertices = self.vertices.iter().flat_map(|[first, last]| *first..=*last);
        for (vertex, numbers) in vertices.zip(stored) {
            let slot = all.get_mut(vertex as usize);
            match slot.filter(|_| numbers.iter().all(|number| number.is_finite())) {
                Some(slot) => *slot = numbers,
                None => {
                    return Err(EditError::Project(format!(
                        "`{name}` does not fit its mesh: export the edit again"
                    )));
                }
            }
        }
        Ok(all)
    }

    /// Gives every stored vertex and its numbers to `take`.
    ///
    /// # Errors
    /// A vertex that the file does not have, too many or too few numbers, or a NaN.
    fn read<const N: usize>(
        &self,
        name: &str,
        model: &Model,
        is_number: impl Fn(f64) -> bool,
        mut take: impl FnMut(SurfaceVertex, [f64; N]),
    ) -> Result<(), EditError> {
        let mut numbers = self.stored::<N>(name)?.into_iter();
        for_each_drawn(&self.vertices, name, model, |vertex| {
            let values = numbers.next().unwrap_or([f64::NAN; N]);
            match vertex {
                _ if !values.iter().all(|number| is_number(*number)) => Err(EditError::Project(format!(
                    "`{name}` has a number that is not finite: save it again"
                ))),
                Some(vertex) => {
                    take(vertex, values);
                    Ok(())
                }
                None => Ok(()),
            }
        })
    }

    /// One number for each surface vertex, `default` if none is stored.
    ///
    /// # Errors
    /// Those of [`Self::read`], and a number outside `range` that `is_beyond` does not allow.
    pub(super) fn numbers(
        &self,
        name: &str,
        model: &Model,
        default: f64,
        range: RangeInclusive<f64>,
        is_beyond: impl Fn(f64) -> bool,
    ) -> Result<Arc<Vec<f64>>, EditError> {
        let mut numbers = vec![default; model.surface.positions.len()];
        let mut refused = None;
        let is_number = |value: f64| value.is_finite() || is_beyond(value);
        self.read(name, model, is_number, |vertex, [value]| {
            if !range.contains(&value) && !is_beyond(value) {
                refused = Some(value);
            }
            numbers[vertex.index()] = value;
        })?;
        match refused {
            Some(value) => Err(EditError::Project(format!(
                "`{name}` has {value}, which is not from {} to {}: save it again",
                range.start(),
                range.end()
            ))),
            None => Ok(Arc::new(numbers)),
        }
    }

    /// A dye for each surface vertex, none if none is stored.
    ///
    /// # Errors
    /// Those of [`Self::read`], and a number that is not from 0 to 1.
    pub(super) fn dyes(&self, name: &str, model: &Model) -> Result<Arc<Vec<Dye>>, EditError> {
        let mut dyes = vec![Dye::default(); model.surface.positions.len()];
        let mut are_in_range = true;
        self.read(name, model, f64::is_finite, |vertex, dye: [f64; 4]| {
            are_in_range &= dye.iter().all(|value| (0.0..=1.0).contains(value));
            dyes[vertex.index()] = dye.map(|value| value as f32);
        })?;
        match are_in_range {
            true => Ok(Arc::new(dyes)),
            false => Err(EditError::Project(format!(
                "`{name}` has a number that is not from 0 to 1: save it again"
            ))),
        }
    }

    /// A displacement for each surface vertex, zero if none is stored.
    ///
    /// # Errors
    /// Those of [`Self::read`].
    pub(super) fn displacements(&self, name: &str, model: &Model) -> Result<Arc<Vec<DVec3>>, EditError> {
        let mut displacements = vec![DVec3::ZERO; model.surface.positions.len()];
        self.read(name, model, f64::is_finite, |vertex, value| {
            displacements[vertex.index()] = DVec3::from_array(value);
        })?;
        Ok(Arc::new(displacements))
    }
}

/// Every drawn vertex whose surface vertex is chosen.
pub(crate) fn ranges_where(model: &Model, is_chosen: impl Fn(SurfaceVertex) -> bool) -> Ranges {
    let chosen: Vec<bool> = model
        .drawn
        .surface_vertices()
        .map(|vertex| vertex.is_some_and(&is_chosen))
        .collect();
    ranges_of(&chosen)
}

/// Calls `visit` for the surface vertex behind each drawn vertex of the ranges.
pub(crate) fn for_each_drawn(
    ranges: &[[u32; 2]],
    name: &str,
    model: &Model,
    mut visit: impl FnMut(Option<SurfaceVertex>) -> Result<(), EditError>,
) -> Result<(), EditError> {
    let count = model.drawn.vertex_count();
    for &[first, last] in ranges {
        if first > last || last as usize >= count {
            return Err(EditError::Project(format!(
                "`{name}` names the vertices {first} to {last}, but the mesh has {count}: save it again"
            )));
        }
        for vertex in first..=last {
            visit(model.drawn.surface_vertex(DrawnVertex(vertex)))?;
        }
    }
    Ok(())
}
