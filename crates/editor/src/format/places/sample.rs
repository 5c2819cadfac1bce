//! The vertices of a mesh that are recorded with an edit.

use std::collections::{BTreeSet, HashSet};

use glam::DVec3;
use pliant_mesh::{Bounds, SurfaceVertex};

use super::matched::{Oriented, PlaceTree};
use super::recorded::Recorded;

/// The places of a whole mesh without sets: one in each cell of this share of the box's longest side, and each side.
const COARSE: f64 = 1.0 / 40.0;

/// Fields are refined to cells this many times finer, each half as long as the one before.
const REFINED: usize = 4;

/// Fields are recorded to the bit while there are no more places than this: 0.6 MB in a file.
const MOST: usize = 1 << 15;

/// The most rounds in which vertices of wrong sets are added.
const ROUNDS: usize = 8;

/// What each surface vertex of a mesh means to an edit.
pub(in crate::format) struct Meaning {
    /// Vertices with the same number are in the same sets.
    pub class: Vec<u32>,
    /// The painted fields.
    pub fields: Vec<Painted>,
    /// The file's number of each.
    pub numbers: Vec<u32>,
}

/// A field, and how far a value may be off.
pub(in crate::format) struct Painted {
    pub values: Vec<DVec3>,
    pub tolerance: f64,
    /// True if it is recorded to the bit while there are not too many places.
    pub is_exact: bool,
}

/// Chooses the vertices to record, so that the mesh itself gets its own sets back.
pub(in crate::format) fn sample(mesh: &Oriented<'_>, bounds: Bounds, meaning: &Meaning) -> Recorded {
    let mut sample = Sample {
        mesh,
        bounds,
        meaning,
        chosen: BTreeSet::new(),
    };
    let vertices = || (0..meaning.class.len() as u32).map(SurfaceVertex);
    let is_at_border = |v: &SurfaceVertex| {
        let mut neighbours = mesh.model.topology.neighbours(*v).iter();
        neighbours.any(|other| meaning.class[other.index()] != meaning.class[v.index()])
    };
    sample.chosen.extend(vertices().filter(is_at_border));
    let mut cell = COARSE * bounds.extent().max_element();
    sample.add_in_cells(vertices(), cell);
    for _ in 0..REFINED {
        cell *= 0.5;
        let (strayed, off) = sample.wrong(Some(1.0));
        if strayed.is_empty() && off.is_empty() {
            break;
        }
        sample.chosen.extend(strayed);
        sample.add_in_cells(off.into_iter(), cell);
    }
    let (_, off) = sample.wrong(None);
    if sample.chosen.len() + off.len() <= MOST {
        sample.chosen.extend(off);
    }
    for _ in 0..ROUNDS {
        let (strayed, _) = sample.wrong(Some(f64::INFINITY));
        if strayed.is_empty() {
            break;
        }
        sample.chosen.extend(strayed);
    }
    sample.recorded().0
}

struct Sample<'a> {
    mesh: &'a Oriented<'a>,
    bounds: Bounds,
    meaning: &'a Meaning,
    chosen: BTreeSet<SurfaceVertex>,
}

impl Sample<'_> {
    /// The present choice, and the surface vertex of each place.
    fn recorded(&self) -> (Recorded, Vec<SurfaceVertex>) {
        let number = |v: &SurfaceVertex| self.meaning.numbers[v.index()];
        let mut vertices: Vec<SurfaceVertex> = self.chosen.iter().copied().collect();
        vertices.sort_by_key(number);
        // Two surface vertices can be one of the file's.
        vertices.dedup_by_key(|v| number(v));
        let each = vertices.iter().map(|v| {
            let (positions, normals) = (self.mesh.positions(), &self.mesh.normals);
            (number(v), positions[v.index()], normals[v.index()])
        });
        (Recorded::of(each, self.bounds), vertices)
    }

    /// Chooses the first of the vertices in each cell and each eighth of the directions in which nothing is chosen.
    fn add_in_cells(&mut self, vertices: impl Iterator<Item = SurfaceVertex>, cell: f64) {
        let key = |v: SurfaceVertex| {
            let from_corner = self.mesh.positions()[v.index()] - self.bounds.min;
            let side = self.mesh.normals[v.index()].cmplt(DVec3::ZERO).bitmask();
            ((from_corner / cell).floor().as_i64vec3().to_array(), side)
        };
        let mut taken: HashSet<([i64; 3], u32)> = self.chosen.iter().map(|v| key(*v)).collect();
        let added: Vec<SurfaceVertex> = vertices.filter(|v| taken.insert(key(*v))).collect();
        self.chosen.extend(added);
    }

    /// The vertices that the present choice gives to wrong sets, and those at which a field is off by more than this
    /// multiple of its tolerance; without one, by anything at all.
    fn wrong(&self, multiple: Option<f64>) -> (Vec<SurfaceVertex>, Vec<SurfaceVertex>) {
        let (recorded, vertices) = self.recorded();
        let tree = PlaceTree::of(&recorded);
        let of_each = tree.of_each(self.mesh);
        let class = &self.meaning.class;
        let all = || (0..class.len() as u32).map(SurfaceVertex);
        let is_strayed = |v: &SurfaceVertex| {
            let place = of_each[v.index()];
            place.is_none_or(|place| class[vertices[place as usize].index()] != class[v.index()])
        };
        let strayed = all().filter(is_strayed).collect();
        let mut is_off = vec![false; class.len()];
        for field in &self.meaning.fields {
            let allowed = multiple.map_or(0.0, |multiple| multiple * field.tolerance);
            if allowed == f64::INFINITY || (multiple.is_none() && !field.is_exact) {
                continue;
            }
            let values: Vec<DVec3> = vertices.iter().map(|v| field.values[v.index()]).collect();
            let read = tree.field(self.mesh, &of_each, &values);
            for ((is_off, read), own) in is_off.iter_mut().zip(read).zip(&field.values) {
                *is_off |= read.is_none_or(|read| (read - *own).length() > allowed);
            }
        }
        (strayed, all().filter(|v| is_off[v.index()]).collect())
    }
}
