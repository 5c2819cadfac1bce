//! Which vertices of a mesh that was read again correspond to those of the mesh that a document was made on.

use std::collections::HashMap;

use glam::DVec3;
use pliant_mesh::Model;

/// Vertices in the same place are no further apart than this share of the mesh's size and place, which is what storing
/// positions as f32 takes.
const SAME_PLACE: f64 = 1e-6;

/// The vertices of one mesh as another has them.
#[derive(Clone, Debug)]
pub struct Matching {
    /// For each surface vertex of the new mesh that of the old one.
    pub(super) of_new: Vec<Option<u32>>,
    /// Whether both have the same vertices and triangles.
    pub(super) is_same_mesh: bool,
}

impl Matching {
    /// By the numbers of the file's vertices where both files draw the same triangles, else by their places. The new mesh
    /// has the old one's shape, moved by `moved` (an entry per surface vertex) where that is given.
    pub fn of(old: &Model, new: &Model, moved: Option<&[DVec3]>) -> Self {
        let counts = |model: &Model| (model.drawn.vertex_count(), model.drawn.triangle_count());
        if counts(old) == counts(new) && old.drawn_triangles() == new.drawn_triangles() {
            return Self::by_number(old, new);
        }
        let places: Vec<DVec3> = match moved {
            Some(moved) => old.surface.positions.iter().zip(moved).map(|(p, d)| *p + *d).collect(),
            None => old.surface.positions.clone(),
        };
        Self::by_place(&places, &new.surface.positions)
    }

    /// How many vertices of the new mesh have no counterpart in the old one.
    pub fn unmatched(&self) -> usize {
        self.of_new.iter().filter(|old| old.is_none()).count()
    }

    fn by_number(old: &Model, new: &Model) -> Self {
        let mut of_new = vec![None; new.surface.positions.len()];
        for (old, new) in old.drawn.surface_vertices().zip(new.drawn.surface_vertices()) {
            if let (Some(old), Some(new)) = (old, new) {
                of_new[new.index()].get_or_insert(old.0);
            }
        }
        Self {
            of_new,
            is_same_mesh: true,
        }
    }

    fn by_place(old: &[DVec3], new: &[DVec3]) -> Self {
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
        Self {
            of_new: new.iter().map(nearest).collect(),
            is_same_mesh: false,
        }
    }
}
