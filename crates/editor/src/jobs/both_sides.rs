//! Both sides of a plane of symmetry: pairs of vertices.

use pliant_mesh::{Bvh, Cancel, Cancelled, Counterparts, MirrorPlane, Model, Progress, SurfaceVertex, symmetry_plane};

/// The plane across which both sides are painted at once.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default, Hash)]
pub enum Symmetry {
    /// No plane: each side by itself.
    #[default]
    None,
    /// The shape's own plane.
    Found,
    /// Across an axis of the world (0, 1, 2 for x, y, z), through the model's middle.
    Axis(usize),
}

/// Both sides of a plane.
#[derive(Debug)]
pub struct BothSides {
    pub(crate) plane: MirrorPlane,
    counterparts: Counterparts,
}

impl BothSides {
    /// Searches for them across the given plane, or across the shape's own; `None` if it has none. `bvh` is that of the
    /// file's shape, if it exists.
    pub(crate) fn find(
        model: &Model,
        bvh: Option<Bvh>,
        given: Option<MirrorPlane>,
        progress: &Progress,
        cancel: &Cancel,
    ) -> Result<Option<Self>, Cancelled> {
        let (surface, topology) = (&model.surface, &model.topology);
        let bvh = bvh.unwrap_or_else(|| Bvh::build(&surface.positions, &surface.triangles));
        let plane = match given {
            Some(plane) => Some(plane),
            None => symmetry_plane(surface, topology, &bvh, progress, cancel)?,
        };
        let Some(plane) = plane else { return Ok(None) };
        let counterparts = Counterparts::find(surface, topology, &bvh, plane, progress, cancel)?;
        Ok(Some(Self { plane, counterparts }))
    }

    /// The partners of these vertices on the other side, in any order, some more than once.
    pub(crate) fn opposite<'a>(
        &'a self,
        vertices: impl IntoIterator<Item = SurfaceVertex> + 'a,
    ) -> impl Iterator<Item = SurfaceVertex> + 'a {
        let of = |vertex| self.counterparts.of(vertex).iter().copied();
        vertices.into_iter().flat_map(of)
    }

    /// The same with data for each vertex.
    pub(crate) fn opposite_with<T: Copy>(&self, vertices: &[(SurfaceVertex, T)]) -> Vec<(SurfaceVertex, T)> {
        let of = |&(vertex, value): &(SurfaceVertex, T)| {
            let counterparts = self.counterparts.of(vertex).iter();
            counterparts.map(move |&counterpart| (counterpart, value))
        };
        vertices.iter().flat_map(of).collect()
    }
}
