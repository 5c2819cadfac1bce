//! Selectors by the file's numbers, which need no model.

use pliant_mesh::{Model, SurfaceVertex};

use super::edit_error::EditError;
use super::selector::{Selector, ranges_of};

impl Selector {
    /// For each vertex of a file with `count` vertices, whether the selector names it; `None` for one that needs a model.
    ///
    /// # Errors
    /// A number that is not below `count`; `place` names the selector.
    pub(crate) fn by_number(&self, count: usize, place: &str) -> Result<Option<Vec<bool>>, EditError> {
        let mut named = vec![false; count];
        let no_such_vertex = |vertex: u32| EditError::NoSuchVertex {
            place: place.to_owned(),
            vertex: vertex.into(),
            count,
        };
        let each = |selectors: &[Self]| -> Result<Option<Vec<Vec<bool>>>, EditError> {
            let each = selectors.iter().map(|selector| selector.by_number(count, place));
            each.collect()
        };
        match self {
            Self::All => named.fill(true),
            Self::None => {}
            Self::Vertices(vertices) => {
                for &vertex in vertices {
                    let slot = named.get_mut(vertex as usize);
                    *slot.ok_or_else(|| no_such_vertex(vertex))? = true;
                }
            }
            Self::Ranges(ranges) => {
                for &[first, last] in ranges {
                    let run = named.get_mut(first as usize..=last as usize);
                    run.ok_or_else(|| no_such_vertex(last))?.fill(true);
                }
            }
            Self::Union(selectors) => {
                let Some(parts) = each(selectors)? else { return Ok(None) };
                for part in parts {
                    named.iter_mut().zip(part).for_each(|(all, one)| *all |= one);
                }
            }
            Self::Intersection(selectors) => {
                let Some(parts) = each(selectors)? else { return Ok(None) };
                named.fill(true);
                for part in parts {
                    named.iter_mut().zip(part).for_each(|(all, one)| *all &= one);
                }
            }
            Self::Not(selector) => {
                let Some(part) = selector.by_number(count, place)? else {
                    return Ok(None);
                };
                named = part.into_iter().map(|one| !one).collect();
            }
            Self::Slab { .. } | Self::Box { .. } | Self::Sphere { .. } | Self::Component(_) => return Ok(None),
        }
        Ok(Some(named))
    }

    /// The file's vertices behind these surface vertices.
    pub(crate) fn of_surface(model: &Model, is_selected: impl Fn(SurfaceVertex) -> bool) -> Self {
        let mut selected = vec![false; model.drawn.file_vertex_count()];
        for (surface_vertex, file_vertex) in model.drawn.surface_vertices().zip(model.drawn.file_vertices()) {
            if surface_vertex.is_some_and(&is_selected) {
                selected[file_vertex.index()] = true;
            }
        }
        match ranges_of(&selected) {
            ranges if ranges.is_empty() => Self::None,
            ranges => Self::Ranges(ranges),
        }
    }
}
