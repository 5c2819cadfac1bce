//! The input shape: its surface, and the further data of its vertices.

use glam::DVec3;
use pliant_mesh::{Drawn, DrawnVertex, Model, SurfaceVertex};

/// A shape with its attributes.
#[derive(Clone, Copy)]
pub struct Part<'a> {
    /// Its surface.
    pub model: &'a Model,
    /// Its drawn vertices and triangles: [`Model::rest`].
    pub drawn: &'a Drawn,
    /// The group (node and material) of each drawn triangle, by any numbers.
    pub group: &'a (dyn Fn(u32) -> u32 + Sync),
    /// The numbers of its drawn vertices.
    pub attributes: Attributes<'a>,
    /// The unit normal of each drawn vertex, zero for one without; `None` if no vertex has one.
    pub normals: Option<&'a (dyn Fn(DrawnVertex) -> DVec3 + Sync)>,
}

/// Numbers at drawn vertices: first the charted ones, which may jump along seams, then the blended ones.
#[derive(Clone, Copy)]
pub struct Attributes<'a> {
    /// The count of numbers that jump along seams: texture coordinates.
    pub charted: usize,
    /// The count of numbers that are continuous on a patch: colours.
    pub blended: usize,
    /// The number of a vertex in a channel.
    pub value: &'a (dyn Fn(DrawnVertex, usize) -> f64 + Sync),
}

impl Part<'_> {
    /// True for a drawn triangle with a corner that is not finite: it belongs to no surface.
    pub(crate) fn is_broken(&self, corners: &[DrawnVertex; 3]) -> bool {
        let of_drawn = &self.model.drawn;
        corners.iter().any(|&corner| of_drawn.surface_vertex(corner).is_none())
    }
}

impl std::fmt::Debug for Part<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Attributes { charted, blended, .. } = self.attributes;
        f.debug_struct("Part")
            .field("triangles", &self.drawn.triangles.len())
            .field("charted", &charted)
            .field("blended", &blended)
            .finish_non_exhaustive()
    }
}

impl Attributes<'_> {
    /// No numbers.
    pub const NONE: Attributes<'static> = Attributes {
        charted: 0,
        blended: 0,
        value: &|_, _| 0.0,
    };

    /// The count of all channels.
    pub fn width(&self) -> usize {
        self.charted + self.blended
    }

    /// True if two vertices have the same charted numbers.
    pub(crate) fn are_of_one_chart(&self, a: DrawnVertex, b: DrawnVertex) -> bool {
        a == b || (0..self.charted).all(|channel| (self.value)(a, channel) == (self.value)(b, channel))
    }
}

/// The triangle of a surface that has an edge from `to` to `from`; it is beyond the border's edge from `from` to `to`.
pub(crate) fn face_beyond(model: &Model, from: SurfaceVertex, to: SurfaceVertex) -> Option<usize> {
    let triangles = &model.surface.triangles;
    let mut around = model.topology.faces(from, triangles);
    let face = around.find(|&face| {
        let [a, b, c] = triangles[face as usize];
        [[a, b], [b, c], [c, a]].contains(&[to, from])
    });
    face.map(|face| face as usize)
}
