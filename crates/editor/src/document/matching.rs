//! The vertices of a mesh that was read again, matched to those of the mesh on which a document was made.

use std::collections::HashMap;

use glam::DVec3;
use pliant_mesh::{Model, SurfaceVertex};

use super::matched_objects::matched_objects;

/// Vertices in the same place are no further apart than this share of the mesh's size and place, which is the error of
/// positions stored as f32.
const SAME_PLACE: f64 = 1e-6;

/// The vertices of one mesh matched to those of another.
#[derive(Clone, Debug)]
pub struct Matching {
    /// For each surface vertex of the new mesh that of the old one.
    pub(super) of_new: Vec<Option<u32>>,
    /// For each connected part of the new mesh, the old part of its first matched vertex.
    pub(super) of_new_part: Vec<Option<u32>>,
    /// For each object of the new mesh, the old object that most of its matched triangles belong to.
    pub(super) of_new_object: Vec<Option<u32>>,
}

impl Matching {
    /// Matches by the numbers of the file's vertices if both files draw the same triangles, else by their places. The
    /// new mesh has the old one's shape, moved by `moved` (an entry per surface vertex) if that is given.
    pub fn of(old: &Model, new: &Model, moved: Option<&[DVec3]>) -> Self {
        let counts = |model: &Model| (model.drawn.vertex_count(), model.drawn.triangle_count());
        let draws_the_same = counts(old) == counts(new) && old.drawn_triangles() == new.drawn_triangles();
        let of_new = match (draws_the_same, moved) {
            (true, _) => by_number(old, new),
            (false, Some(moved)) => {
                let places = old.surface.positions.iter().zip(moved).map(|(p, d)| *p + *d);
                by_place(&places.collect::<Vec<_>>(), &new.surface.positions)
            }
            (false, None) => by_place(&old.surface.positions, &new.surface.positions),
        };
        let of_new_object = match draws_the_same {
            true => (0..new.all_objects().len() as u32).map(Some).collect(),
            false => matched_objects(old, new, &of_new),
        };
        Self::with(of_new, of_new_object, old, new)
    }

    /// The same from the new mesh to the old one. Where several vertices match one, it gets the first.
    pub(crate) fn inverse(&self, old: &Model, new: &Model) -> Self {
        let mut of_old = vec![None; old.surface.positions.len()];
        for (vertex, old_vertex) in (0..).zip(&self.of_new) {
            if let Some(old_vertex) = old_vertex {
                of_old[*old_vertex as usize].get_or_insert(vertex);
            }
        }
        let objects = matched_objects(new, old, &of_old);
        Self::with(of_old, objects, new, old)
    }

    fn with(of_new: Vec<Option<u32>>, of_new_object: Vec<Option<u32>>, old: &Model, new: &Model) -> Self {
        let mut of_new_part = vec![None; new.topology.components().len()];
        for (vertex, old_vertex) in (0..).zip(&of_new) {
            if let Some(old_vertex) = old_vertex {
                let part = new.topology.component(SurfaceVertex(vertex));
                of_new_part[part as usize].get_or_insert(old.topology.component(SurfaceVertex(*old_vertex)));
            }
        }
        Self {
            of_new,
            of_new_part,
            of_new_object,
        }
    }

    /// The displacements of the new mesh's vertices, given those of the old one's; zero for unmatched ones.
    pub(crate) fn displacements(&self, old: &[DVec3]) -> Vec<DVec3> {
        let of_new = self.of_new.iter();
        of_new
            .map(|vertex| vertex.map_or(DVec3::ZERO, |vertex| old[vertex as usize]))
            .collect()
    }

    /// The vertices of the new mesh without a counterpart that belong to a part with matched ones, ascending.
    pub(super) fn new_in_former_parts(&self, new: &Model) -> Vec<u32> {
        let all = (0..).zip(&self.of_new).filter(|(_, old)| old.is_none());
        let is_former = |vertex: &u32| {
            let part = new.topology.component(SurfaceVertex(*vertex));
            self.of_new_part[part as usize].is_some()
        };
        all.map(|(vertex, _)| vertex).filter(is_former).collect()
    }

    /// The number of vertices of the new mesh without a counterpart in the old one.
    pub fn unmatched(&self) -> usize {
        self.of_new.iter().filter(|old| old.is_none()).count()
    }
}

/// A new vertex that replaces several old ones gets the first that triangles use.
fn by_number(old: &Model, new: &Model) -> Vec<Option<u32>> {
    let mut of_new: Vec<Option<u32>> = vec![None; new.surface.positions.len()];
    let first_bare = old.topology.bare_points().start as u32;
    for (old, new) in old.drawn.surface_vertices().zip(new.drawn.surface_vertices()) {
        if let (Some(old), Some(new)) = (old, new) {
            let place = &mut of_new[new.index()];
            if place.is_none_or(|taken| taken >= first_bare && old.0 < first_bare) {
                *place = Some(old.0);
            }
        }
    }
    of_new
}

fn by_place(old: &[DVec3], new: &[DVec3]) -> Vec<Option<u32>> {
    let farthest = old.iter().map(|p| p.abs().max_element()).fold(0.0, f64::max);
    let reach = (SAME_PLACE * farthest).max(f64::MIN_POSITIVE);
    let cell = |p: DVec3| (p / reach).floor().as_i64vec3();
    let mut by_cell: HashMap<[i64; 3], Vec<u32>> = HashMap::new();
    for (vertex, place) in old.iter().enumerate() {
        by_cell.entry(cell(*place).to_array()).or_default().push(vertex as u32);
    }
    let nearest = |place: &DVec3| {
        let [x, y, z] = cell(*place).to_array();
        let sides = || [-1, 0, 1].into_iter();
        let cells = sides().flat_map(|i| sides().flat_map(move |j| sides().map(move |k| [x + i, y + j, z + k])));
        let near = cells.filter_map(|cell| by_cell.get(&cell)).flatten();
        let near = near.map(|vertex| (old[*vertex as usize].distance(*place), *vertex));
        let near = near.filter(|(way, _)| *way <= reach);
        near.min_by(|(a, _), (b, _)| a.total_cmp(b)).map(|(_, vertex)| vertex)
    };
    new.iter().map(nearest).collect()
}
