//! The drawn triangles in as few bytes as their order allows: counted, taken from the surface, or listed.

use rayon::prelude::*;

use crate::{DrawnVertex, Surface, SurfaceVertex};

/// Triangles over drawn vertices, in the file's order.
#[derive(Clone, Debug)]
pub(crate) enum Corners {
    /// Triangle t has the corners 3t, 3t + 1 and 3t + 2, as in an STL file.
    InRow(usize),
    /// A list of triangles.
    Listed(Vec<[DrawnVertex; 3]>),
}

/// Triangles over drawn vertices, beside a surface.
#[derive(Clone, Debug)]
pub(crate) enum DrawnTriangles {
    /// A list of their own.
    AsTheyCame(Corners),
    /// A reference to the surface's triangles.
    BySurface(BySurface),
}

/// The surface's triangles in another order, mostly over the first drawn vertex of each surface vertex.
#[derive(Clone, Debug)]
pub(crate) struct BySurface {
    count: usize,
    /// The first drawn vertex of each surface vertex.
    first_drawn: Vec<DrawnVertex>,
    /// The exceptions: the numbers, ascending, and the corners of triangles that the surface does not have or has over
    /// other drawn vertices.
    others: Vec<u32>,
    corners_of_others: Vec<[DrawnVertex; 3]>,
}

impl Default for DrawnTriangles {
    fn default() -> Self {
        Self::AsTheyCame(Corners::InRow(0))
    }
}

impl Corners {
    pub(crate) fn new(listed: Vec<[DrawnVertex; 3]>) -> Self {
        if listed.par_iter().enumerate().all(|(t, corners)| *corners == in_row(t)) {
            Self::InRow(listed.len())
        } else {
            Self::Listed(listed)
        }
    }

    /// The number of triangles.
    pub(crate) fn len(&self) -> usize {
        match self {
            Self::InRow(count) => *count,
            Self::Listed(listed) => listed.len(),
        }
    }

    /// The corners of a triangle.
    #[inline]
    pub(crate) fn of(&self, triangle: usize) -> [DrawnVertex; 3] {
        match self {
            Self::InRow(_) => in_row(triangle),
            Self::Listed(listed) => listed[triangle],
        }
    }

    /// The corners of all triangles.
    pub(crate) fn iter(&self) -> impl Iterator<Item = [DrawnVertex; 3]> + '_ {
        (0..self.len()).map(|t| self.of(t))
    }
}

impl DrawnTriangles {
    /// The number of triangles.
    pub(crate) fn len(&self) -> usize {
        match self {
            Self::AsTheyCame(corners) => corners.len(),
            Self::BySurface(told) => told.count,
        }
    }

    /// The same by reference to a surface, if that takes less memory. `of_surface` gives each triangle's place in the
    /// surface, and `surface_vertices` the surface vertex behind each drawn one, or a number beyond all if there is
    /// none.
    pub(crate) fn told_by(self, surface: &Surface, surface_vertices: &[u32], of_surface: &[u32]) -> Self {
        let Self::AsTheyCame(Corners::Listed(listed)) = self else {
            return self;
        };
        let mut first_drawn = vec![DrawnVertex(u32::MAX); surface.positions.len()];
        for (v, &surface_vertex) in surface_vertices.iter().enumerate().rev() {
            if let Some(first) = first_drawn.get_mut(surface_vertex as usize) {
                *first = DrawnVertex(v as u32);
            }
        }
        let mut is_told = vec![false; listed.len()];
        for (&number, corners) in of_surface.iter().zip(&surface.triangles) {
            is_told[number as usize] = listed[number as usize] == over(&first_drawn, *corners);
        }
        let others = is_told.iter().filter(|&&is_told| !is_told).count();
        let bytes = others * size_of::<[DrawnVertex; 4]>() + size_of_val(&first_drawn[..]);
        if bytes >= size_of_val(&listed[..]) {
            return Self::AsTheyCame(Corners::Listed(listed));
        }
        let numbers = (0..listed.len() as u32).filter(|&number| !is_told[number as usize]);
        let mut told = BySurface {
            count: listed.len(),
            first_drawn,
            others: Vec::with_capacity(others),
            corners_of_others: Vec::with_capacity(others),
        };
        told.others.extend(numbers.clone());
        let corners = numbers.map(|number| listed[number as usize]);
        told.corners_of_others.extend(corners);
        Self::BySurface(told)
    }

    /// The corners of the triangle of this number, which the surface has over `corners`.
    #[inline]
    pub(crate) fn behind(&self, corners: [SurfaceVertex; 3], number: u32) -> [DrawnVertex; 3] {
        match self {
            Self::AsTheyCame(corners) => corners.of(number as usize),
            Self::BySurface(told) => told.other(number).unwrap_or_else(|| over(&told.first_drawn, corners)),
        }
    }

    /// The corners of the triangle of this number, if there is one.
    pub(crate) fn get(&self, number: u32, surface: &Surface, of_surface: &[u32]) -> Option<[DrawnVertex; 3]> {
        match self {
            Self::AsTheyCame(corners) => ((number as usize) < corners.len()).then(|| corners.of(number as usize)),
            Self::BySurface(told) => told.other(number).or_else(|| {
                let place = of_surface.iter().position(|&of| of == number)?;
                Some(over(&told.first_drawn, surface.triangles[place]))
            }),
        }
    }

    /// All triangles, in their order.
    pub(crate) fn listed(&self, surface: &Surface, of_surface: &[u32]) -> Vec<[DrawnVertex; 3]> {
        match self {
            Self::AsTheyCame(corners) => corners.iter().collect(),
            Self::BySurface(told) => {
                let mut out = vec![[DrawnVertex(0); 3]; told.count];
                for (&number, corners) in of_surface.iter().zip(&surface.triangles) {
                    out[number as usize] = over(&told.first_drawn, *corners);
                }
                for (&number, corners) in told.others.iter().zip(&told.corners_of_others) {
                    out[number as usize] = *corners;
                }
                out
            }
        }
    }
}

impl BySurface {
    #[inline]
    fn other(&self, number: u32) -> Option<[DrawnVertex; 3]> {
        let place = self.others.binary_search(&number).ok()?;
        Some(self.corners_of_others[place])
    }
}

#[inline]
fn in_row(triangle: usize) -> [DrawnVertex; 3] {
    [0, 1, 2].map(|k| DrawnVertex(3 * triangle as u32 + k))
}

#[inline]
fn over(first_drawn: &[DrawnVertex], corners: [SurfaceVertex; 3]) -> [DrawnVertex; 3] {
    corners.map(|corner| first_drawn[corner.index()])
}
