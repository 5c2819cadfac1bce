//! A selector evaluated on a model: a set of its welded vertices.

use glam::DVec3;
use pliant_mesh::{Drawn, DrawnVertex, Model, SurfaceVertex};

use crate::{Axis, EditError, Selector};

/// A set of a surface's vertices.
#[derive(Clone, PartialEq, Eq, Debug, Default)]
pub struct Selection {
    selected: Vec<bool>,
}

impl Selection {
    /// The empty set on a surface with `vertex_count` vertices.
    pub fn none(vertex_count: usize) -> Self {
        Self {
            selected: vec![false; vertex_count],
        }
    }

    /// Returns true if the set has this vertex.
    pub fn contains(&self, vertex: SurfaceVertex) -> bool {
        self.selected[vertex.index()]
    }

    /// Returns true if the set has no vertex.
    pub fn is_empty(&self) -> bool {
        !self.selected.contains(&true)
    }

    /// The number of vertices in the set.
    pub fn len(&self) -> usize {
        self.selected.iter().filter(|&&selected| selected).count()
    }

    /// The set's vertices, ascending.
    pub fn iter(&self) -> impl Iterator<Item = SurfaceVertex> {
        self.selected
            .iter()
            .zip(0..)
            .filter(|&(&selected, _)| selected)
            .map(|(_, vertex)| SurfaceVertex(vertex))
    }
}

impl Selector {
    /// The surface's vertices that the selector describes.
    ///
    /// A welded vertex is selected if any of the file's vertices behind it is, so twins are selected together.
    /// Positions are the file's own, in world space. Vertices of the file that are not drawn or not finite may be named
    /// and select nothing. A vertex or component number that the model does not have is an error.
    pub fn evaluate(&self, model: &Model) -> Result<Selection, EditError> {
        self.evaluate_at(model, "the selector")
    }

    /// Like [`Selector::evaluate`], naming `place` in a refusal.
    pub(crate) fn evaluate_at(&self, model: &Model, place: &str) -> Result<Selection, EditError> {
        let selected = match self {
            Self::All => vec![true; model.surface.positions.len()],
            Self::None => vec![false; model.surface.positions.len()],
            Self::Vertices(_) | Self::Ranges(_) => {
                let named = self.by_number(model.drawn.file_vertex_count(), place)?;
                by_file_vertex(model, &named.unwrap_or_default())
            }
            Self::Slab { axis, from, to } => by_slab(model, *axis, *from, *to),
            Self::Box { min, max } => by_position(model, |p| min.cmple(p).all() && p.cmple(*max).all()),
            Self::Sphere { center, radius } => by_position(model, |p| p.distance(*center) <= *radius),
            Self::Component(component) => by_component(model, *component, place)?,
            Self::Union(selectors) => {
                let mut union = vec![false; model.surface.positions.len()];
                for selector in selectors {
                    let part = selector.evaluate_at(model, place)?;
                    union.iter_mut().zip(&part.selected).for_each(|(all, one)| *all |= one);
                }
                union
            }
            Self::Intersection(selectors) => {
                let mut intersection = vec![true; model.surface.positions.len()];
                for selector in selectors {
                    let part = selector.evaluate_at(model, place)?;
                    intersection
                        .iter_mut()
                        .zip(&part.selected)
                        .for_each(|(all, one)| *all &= one);
                }
                intersection
            }
            Self::Not(selector) => selector
                .evaluate_at(model, place)?
                .selected
                .iter()
                .map(|one| !one)
                .collect(),
        };
        Ok(Selection { selected })
    }
}

/// The surface vertices with a drawn vertex for which `test` is true.
fn by_drawn(model: &Model, test: impl Fn(DrawnVertex) -> bool) -> Vec<bool> {
    let mut selected = vec![false; model.surface.positions.len()];
    for (drawn, surface_vertex) in (0..).map(DrawnVertex).zip(model.drawn.surface_vertices()) {
        if let Some(surface_vertex) = surface_vertex
            && test(drawn)
        {
            selected[surface_vertex.index()] = true;
        }
    }
    selected
}

fn by_file_vertex(model: &Model, named: &[bool]) -> Vec<bool> {
    by_drawn(model, |drawn| named[model.drawn.file_vertex(drawn).index()])
}

fn by_position(model: &Model, test: impl Fn(DVec3) -> bool) -> Vec<bool> {
    by_drawn(model, |drawn| test(model.rest_position(drawn)))
}

fn by_slab(model: &Model, axis: Axis, from: f64, to: f64) -> Vec<bool> {
    let Some((min, max)) = bounds_of_used_vertices(model) else {
        return vec![false; model.surface.positions.len()];
    };
    let extent = max - min;
    let axis = match axis {
        Axis::X => 0,
        Axis::Y => 1,
        Axis::Z => 2,
        Axis::Longest => longest_axis(extent),
    };
    // A box without extent along the axis has all its vertices at its lower end.
    let unit = if extent[axis] > 0.0 { extent[axis] } else { 1.0 };
    by_position(model, |p| {
        let fraction = (p[axis] - min[axis]) / unit;
        from <= fraction && fraction <= to
    })
}

/// The bounding box of the finite vertices that triangles of the scene use, or of all if there is no triangle.
fn bounds_of_used_vertices(model: &Model) -> Option<(DVec3, DVec3)> {
    let Drawn {
        positions, triangles, ..
    } = model.rest();
    let of_triangles = triangles.as_flattened().iter().map(|vertex| positions[vertex.index()]);
    let all = if triangles.is_empty() { &positions[..] } else { &[] };
    of_triangles
        .chain(all.iter().copied())
        .filter(|position| position.is_finite())
        .fold(None, |bounds, p| match bounds {
            None => Some((p, p)),
            Some((min, max)) => Some((p.min(min), p.max(max))),
        })
}

/// The first axis whose length is within 1e-6 of the longest.
fn longest_axis(extent: DVec3) -> usize {
    let least = extent.max_element() * (1.0 - 1e-6);
    (0..3).find(|&axis| extent[axis] >= least).unwrap_or(0)
}

fn by_component(model: &Model, component: u32, place: &str) -> Result<Vec<bool>, EditError> {
    let count = model.topology.components().len();
    if component as usize >= count {
        return Err(EditError::NoSuchComponent {
            place: place.to_owned(),
            component,
            count,
        });
    }
    let vertices = 0..model.surface.positions.len() as u32;
    Ok(vertices
        .map(|vertex| model.topology.component(SurfaceVertex(vertex)) == component)
        .collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_longest_axis_prefers_x_then_y_among_nearly_equal_ones() {
        assert_eq!(longest_axis(DVec3::new(1.0, 1.0, 1.0)), 0);
        assert_eq!(longest_axis(DVec3::new(1.0, 1.0 + 5e-7, 0.5)), 0);
        assert_eq!(longest_axis(DVec3::new(1.0, 1.0 + 2e-6, 1.0)), 1);
        assert_eq!(longest_axis(DVec3::new(1.0, 2.0, 2.0 + 1e-6)), 1);
        assert_eq!(longest_axis(DVec3::ZERO), 0);
    }
}
