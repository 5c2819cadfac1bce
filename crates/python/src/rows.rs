//! Positions as targets: the vertices of a handle's rows, and the places that the rows give the surface's vertices.

use std::collections::HashMap;

use glam::DVec3;
use pliant_editor::Setup;
use pliant_mesh::{DrawnVertex, Model, SurfaceVertex};

/// The vertices of the rows of a handle's positions.
#[derive(Debug)]
pub struct Rows {
    /// The vertex of each row, with the numbers of selections.
    pub numbers: Vec<u32>,
    /// The rest position of each row's vertex.
    rest: Vec<DVec3>,
    /// For each of the handle's surface vertices, the row that it follows.
    of_surface: Vec<(SurfaceVertex, u32)>,
    /// The drawn vertices that go exactly to a row: the row's vertex and the vertices in the same place.
    drawn: Vec<(u32, u32)>,
    /// Rows of vertices in the same place, which must be equal.
    alike: Vec<(u32, u32)>,
    /// Rows of vertices at different positions that are welded and must move together.
    welded: Vec<(u32, u32)>,
}

impl Rows {
    /// The rows of a handle that moves these surface vertices, ascending. `numbers` has its vertices in the order of
    /// the array that named them; for a selector they ascend.
    ///
    /// # Errors
    /// A sentence without its subject, if a row would be for no vertex or for several, or a vertex has no row.
    pub fn of(
        model: &Model,
        setup: &Setup,
        handle: usize,
        numbers: Option<&[i64]>,
        moved: &[u32],
    ) -> Result<Self, String> {
        let drawn = &model.drawn;
        let is_own = |vertex: SurfaceVertex| {
            let role = pliant_deform::Role::Handle(handle as u16);
            setup.roles[vertex.index()] == role
        };
        let mut places: HashMap<u32, Vec<u32>> = HashMap::new();
        for (place, (file, surface)) in (0..).zip(drawn.file_vertices().zip(drawn.surface_vertices())) {
            if surface.is_some_and(is_own) {
                places.entry(file.0).or_default().push(place);
            }
        }
        let numbers: Vec<u32> = match numbers {
            Some(numbers) => numbers.iter().map(|&number| number as u32).collect(),
            None => {
                let mut numbers: Vec<u32> = places.keys().copied().collect();
                numbers.sort_unstable();
                numbers
            }
        };
        let mut rows = Self {
            rest: Vec::with_capacity(numbers.len()),
            of_surface: Vec::new(),
            drawn: Vec::new(),
            alike: Vec::new(),
            welded: Vec::new(),
            numbers,
        };
        let mut first_of_surface: HashMap<u32, u32> = HashMap::new();
        let mut first_in_place: HashMap<[u64; 3], u32> = HashMap::new();
        for (row, number) in (0..).zip(&rows.numbers) {
            let place = match places.get(number).map(Vec::as_slice) {
                Some(&[place]) => DrawnVertex(place),
                Some(_) => {
                    return Err(format!(
                        "takes no positions, because vertex {number} is shown in several places: give a transform"
                    ));
                }
                None => {
                    return Err(format!(
                        "takes no positions, because vertex {number} has no finite position: give a transform"
                    ));
                }
            };
            let rest = model.rest_position(place);
            rows.rest.push(rest);
            if let Some(surface) = drawn.surface_vertex(place) {
                let first = *first_of_surface.entry(surface.0).or_insert(row);
                if bits(rows.rest[first as usize]) != bits(rest) {
                    rows.welded.push((first, row));
                }
            }
            let same = *first_in_place.entry(bits(rest)).or_insert(row);
            if same != row {
                rows.alike.push((same, row));
            }
        }
        for &vertex in moved {
            let Some(&row) = first_of_surface.get(&vertex) else {
                let number = model.first_file_vertex(SurfaceVertex(vertex)).0;
                return Err(format!(
                    "takes no positions, because it also moves vertex {number}, which is rigid with its own and has \
                     no row: give a transform, or make less of it rigid"
                ));
            };
            rows.of_surface.push((SurfaceVertex(vertex), row));
        }
        for place in places.into_values().flatten() {
            if let Some(&row) = first_in_place.get(&bits(model.rest_position(DrawnVertex(place)))) {
                rows.drawn.push((place, row));
            }
        }
        rows.drawn.sort_unstable();
        Ok(rows)
    }

    /// The targets of the handle's surface vertices, ascending.
    ///
    /// # Errors
    /// A sentence without its subject.
    pub fn places(&self, model: &Model, positions: &[DVec3]) -> Result<Vec<DVec3>, String> {
        if positions.len() != self.numbers.len() {
            return Err(format!(
                "has {} positions, but the handle has {} vertices: give a row for each, or a transform",
                positions.len(),
                self.numbers.len()
            ));
        }
        if let Some(row) = positions.iter().position(|position| !position.is_finite()) {
            let position = positions[row];
            return Err(format!(
                "is not finite at row {row} ({}, {}, {}): give finite positions",
                position.x, position.y, position.z
            ));
        }
        let at = |row: u32| positions[row as usize];
        if let Some(&(first, second)) = self.alike.iter().find(|&&(first, second)| at(first) != at(second)) {
            let number = |row: u32| self.numbers[row as usize];
            return Err(format!(
                "moves the vertices {} and {} apart (rows {first} and {second}), which are at one position: give both \
                 the same position",
                number(first),
                number(second)
            ));
        }
        let moved = |row: u32| at(row) - self.rest[row as usize];
        let is_torn = |&&(first, second): &&(u32, u32)| {
            let apart = self.rest[first as usize].distance(self.rest[second as usize]);
            moved(first).distance(moved(second)) > apart
        };
        if let Some(&(first, second)) = self.welded.iter().find(is_torn) {
            let number = |row: u32| self.numbers[row as usize];
            return Err(format!(
                "moves the welded vertices {} and {} apart (rows {first} and {second}): move both equally, or give a \
                 smaller `weld`",
                number(first),
                number(second)
            ));
        }
        let place = |&(vertex, row): &(SurfaceVertex, u32)| {
            let rest = self.rest[row as usize];
            match positions[row as usize] {
                same if same == rest => model.surface.positions[vertex.index()],
                position => model.surface.positions[vertex.index()] + (position - rest),
            }
        };
        Ok(self.of_surface.iter().map(place).collect())
    }

    /// Puts the drawn vertices exactly on their rows: the sum of rest and displacement may miss them by a rounding.
    pub fn put(&self, positions: &[DVec3], drawn: &mut [DVec3]) {
        for &(place, row) in &self.drawn {
            drawn[place as usize] = positions[row as usize];
        }
    }
}

/// A position that is compared by its bits; zeros of both signs are equal.
fn bits(position: DVec3) -> [u64; 3] {
    position.to_array().map(|number| (number + 0.0).to_bits())
}
