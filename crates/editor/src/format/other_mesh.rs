//! Another mesh than the one that an edit was made on, matched to its places.

use glam::{DAffine3, DVec3};
use pliant_deform::CONTINUITY_RANGE;
use pliant_mesh::{Bvh, Model, OrientedPoints, SurfaceVertex};
use rayon::prelude::*;

use super::edit_error::EditError;
use super::edit_file::{EditFile, STIFFNESS_RANGE};
use super::field::FieldEntry;
use super::handle_entry::HandleEntry;
use super::kept::StoredKept;
use super::matched_by_place::{FoundPlaces, MatchedByPlace, percent, rounded};
use super::places::{Oriented, PlaceTree, Places, Recorded};
use super::selector::Selector;
use crate::warning::shortened;

/// A place is found if the other surface is as near as this share of the first mesh' diagonal.
const WITHIN: f64 = 0.02;

/// A handle of which less than this share of its places is found is refused.
const LEAST_FOUND: f64 = 0.5;

/// A mesh faces the other way if this many times as many places have a surface there that faces the other way as have
/// one that faces theirs.
const TURNED: usize = 4;

/// Vertices that are further from where their handle moves them than this share of the diagonal were painted in the bent
/// shape.
const BESIDE: f64 = 1e-4;

/// How a field's numbers are interpolated.
#[derive(Clone, Copy, PartialEq)]
pub(super) enum Scale {
    Linear,
    Logarithmic,
}

/// The mesh on which an edit is used, matched to the places of the one that it was made on.
pub(super) struct Other<'a> {
    places: &'a Places,
    mesh: Oriented<'a>,
    tree: PlaceTree<'a>,
    /// For each place, whether the surface is near.
    is_found: Vec<bool>,
    /// The place of each surface vertex.
    of_each: Vec<Option<u32>>,
}

impl<'a> Other<'a> {
    pub(super) fn of(places: &'a Places, recorded: &'a Recorded, model: &'a Model) -> Self {
        let tree = PlaceTree::of(recorded);
        let (mesh, is_found) = facing_as(recorded, Oriented::of(model));
        let of_each = tree.of_each(&mesh);
        Self {
            places,
            mesh,
            tree,
            is_found,
            of_each,
        }
    }

    /// Returns true if the triangles face the other way than those of the edit's mesh.
    pub(super) fn is_turned(&self) -> bool {
        self.mesh.is_turned
    }

    /// Finds the sets' places, and gives a handle that is smaller than this mesh' triangles the vertices next to them.
    pub(super) fn found(&mut self, edit: &EditFile) -> Result<MatchedByPlace, EditError> {
        let recorded = self.tree.recorded;
        let within = WITHIN * recorded.bounds.diagonal();
        let mut found = Vec::new();
        let share_of = |is_in: &[bool]| {
            let own = recorded.numbers.iter().zip(&self.is_found);
            let own = own.filter(|(number, _)| is_in[**number as usize]);
            let (count, all) = own.fold((0, 0), |(count, all), (_, is)| (count + usize::from(*is), all + 1));
            (all > 0).then(|| count as f64 / f64::from(all))
        };
        let count = self.places.vertex_count();
        let mut is_held = vec![false; count];
        let mut small = Vec::new();
        for (index, handle) in edit.handles.iter().enumerate() {
            let Some(select) = &handle.select else { continue };
            let Some(is_in) = select.by_number(count, &format!("handles[{index}].select"))? else {
                continue;
            };
            let Some(share) = share_of(&is_in) else { continue };
            let set = format!("`{}`", shortened(&handle.name));
            if share < LEAST_FOUND {
                return Err(elsewhere(&set, share, within));
            }
            found.push(FoundPlaces { set, share });
            let number = |place: &u32| recorded.numbers[*place as usize] as usize;
            if !self.of_each.iter().flatten().any(|place| is_in[number(place)]) {
                let own = (0..recorded.numbers.len() as u32).filter(|place| is_in[number(place)]);
                small.extend(own.filter(|place| self.is_found[*place as usize]));
            }
            is_held.iter_mut().zip(is_in).for_each(|(held, own)| *held |= own);
        }
        if let Some(mut is_in) = edit.region.by_number(count, "region")? {
            is_in.iter_mut().zip(is_held).for_each(|(own, held)| *own &= !held);
            if let Some(share) = share_of(&is_in) {
                let set = "the free region".to_owned();
                if edit.handles.is_empty() && share < LEAST_FOUND {
                    return Err(elsewhere(&set, share, within));
                }
                found.push(FoundPlaces { set, share });
            }
        }
        self.give_nearest(&small);
        Ok(MatchedByPlace {
            within,
            found,
            turned: self.mesh.is_turned,
            left_out: Vec::new(),
        })
    }

    /// Matches the vertex next to each of these places with it.
    fn give_nearest(&mut self, places: &[u32]) {
        if places.is_empty() {
            return;
        }
        let recorded = self.tree.recorded;
        let diagonal = recorded.bounds.diagonal();
        let vertices = OrientedPoints::new(self.mesh.positions(), &self.mesh.normals, WITHIN * diagonal);
        let mut found = Vec::new();
        for place in places {
            let (position, normal) = (recorded.positions[*place as usize], recorded.normals[*place as usize]);
            vertices.nearest(position, normal, diagonal, 1, &mut found);
            if let Some(near) = found.first() {
                self.of_each[near.number as usize] = Some(*place);
            }
        }
    }

    /// The number of a surface vertex' place.
    fn number(&self, vertex: SurfaceVertex) -> Option<usize> {
        let place = self.of_each[vertex.index()]?;
        Some(self.tree.recorded.numbers[place as usize] as usize)
    }

    /// A selector on this mesh.
    pub(super) fn selected(&self, selector: &Selector, place: &str) -> Result<Selector, EditError> {
        let each = |selectors: &[Selector]| -> Result<Vec<Selector>, EditError> {
            selectors
                .iter()
                .map(|selector| self.selected(selector, place))
                .collect()
        };
        Ok(match selector {
            Selector::Vertices(_) | Selector::Ranges(_) => {
                let named = selector
                    .by_number(self.places.vertex_count(), place)?
                    .unwrap_or_default();
                Selector::of_surface(self.mesh.model, |v| self.number(v).is_some_and(|number| named[number]))
            }
            Selector::Union(selectors) => Selector::Union(each(selectors)?),
            Selector::Intersection(selectors) => Selector::Intersection(each(selectors)?),
            Selector::Not(selector) => Selector::Not(Box::new(self.selected(selector, place)?)),
            other => other.clone(),
        })
    }

    /// A selector of whole parts on this mesh: those of which it has most vertices.
    pub(super) fn whole_parts(&self, selector: &Selector, place: &str) -> Result<Selector, EditError> {
        let model = self.mesh.model;
        let selected = self.selected(selector, place)?;
        if *selector == Selector::None || selected == *selector {
            return Ok(selected);
        }
        let selection = selected.evaluate_at(model, place)?;
        let mut counts = vec![0; model.topology.components().len()];
        selection
            .iter()
            .for_each(|v| counts[model.topology.component(v) as usize] += 1);
        let parts = model.topology.components().iter();
        let has_most: Vec<bool> = counts
            .iter()
            .zip(parts)
            .map(|(own, part)| 2 * own > part.vertex_count)
            .collect();
        Ok(Selector::of_surface(model, |v| {
            has_most[model.topology.component(v) as usize]
        }))
    }

    /// A painted field's entry on this mesh.
    pub(super) fn field(&self, entry: &FieldEntry, place: &str, scale: Scale) -> Result<FieldEntry, EditError> {
        let default = match scale {
            Scale::Linear => *CONTINUITY_RANGE.end(),
            Scale::Logarithmic => 1.0,
        };
        if let FieldEntry::Select { select, value } = entry {
            return Ok(FieldEntry::Select {
                select: self.selected(select, &format!("{place}.select"))?,
                value: *value,
            });
        }
        let numbered = entry.numbered(self.places.vertex_count(), place)?;
        let stored = |number: &u32| {
            let value = numbered[*number as usize].unwrap_or(default);
            DVec3::X
                * match scale {
                    Scale::Linear => value,
                    Scale::Logarithmic => value.ln(),
                }
        };
        let at_places: Vec<DVec3> = self.tree.recorded.numbers.iter().map(stored).collect();
        let values = self.tree.field(&self.mesh, &self.of_each, &at_places);
        let read = |value: DVec3| match scale {
            Scale::Linear => value.x.clamp(*CONTINUITY_RANGE.start(), *CONTINUITY_RANGE.end()),
            Scale::Logarithmic if value.x == f64::INFINITY => value.x,
            Scale::Logarithmic => value.x.exp().clamp(*STIFFNESS_RANGE.start(), *STIFFNESS_RANGE.end()),
        };
        let value = |v: SurfaceVertex| {
            self.number(v).filter(|number| numbered[*number].is_some())?;
            values[v.index()].map(read)
        };
        Ok(FieldEntry::of_vertices(self.mesh.model, value))
    }

    /// The kept shape on this mesh, if corrections by hand or vertices that were painted in the bent shape need it.
    pub(super) fn kept(
        &self,
        kept: &StoredKept,
        handles: &[HandleEntry],
        left_out: &mut Vec<String>,
    ) -> Result<Option<StoredKept>, EditError> {
        let recorded = self.tree.recorded;
        let count = self.places.vertex_count();
        if !self.places.are_shown_once() {
            left_out.push("its shape is solved anew, because the first mesh shows vertices twice".to_owned());
            return Ok(None);
        }
        let at_places = |by_number: &[DVec3]| -> Vec<DVec3> {
            recorded
                .numbers
                .iter()
                .map(|number| by_number[*number as usize])
                .collect()
        };
        let shape = at_places(&kept.shape_by_number(count)?);
        let corrections = kept
            .corrections_by_number(count)?
            .map(|by_number| at_places(&by_number));
        let mut values = self.displacements(&shape);
        let mut is_painted_on_bent = false;
        for (index, handle) in handles.iter().enumerate().filter(|(_, handle)| handle.line().is_none()) {
            let (Some(map), Some(select)) = (kept.map_of(index), &handle.select) else {
                continue;
            };
            let Some(is_in) = select.by_number(count, &format!("handles[{index}].select"))? else {
                continue;
            };
            // Details of this mesh turn with the handle, so only what is beside its map is interpolated.
            let way = |position: DVec3| map.transform_point3(position) - position;
            let own = recorded.positions.iter().zip(&shape).zip(&recorded.numbers);
            is_painted_on_bent |= own.clone().any(|((position, displacement), number)| {
                is_in[*number as usize] && is_beside(map, *position, *displacement, recorded.bounds.diagonal())
            });
            let beside: Vec<DVec3> = own
                .map(|((position, displacement), _)| *displacement - way(*position))
                .collect();
            let beside = self.displacements(&beside);
            for (v, value) in (0..).map(SurfaceVertex).zip(&mut values) {
                if self.number(v).is_some_and(|number| is_in[number]) {
                    *value = way(self.mesh.positions()[v.index()]) + beside[v.index()];
                }
            }
        }
        let kept = match is_painted_on_bent {
            true => Some(kept.clone()),
            false => kept.clone().for_another_method(),
        };
        // Without a person's work the shape is the solution, which is found anew.
        let Some(kept) = kept else { return Ok(None) };
        let corrections = corrections.map(|corrections| self.displacements(&corrections));
        Ok(Some(kept.on_other(self.mesh.model, &values, corrections.as_deref())))
    }

    /// The displacement of each surface vertex, given those of the places; 0 for a vertex without a place.
    fn displacements(&self, at_places: &[DVec3]) -> Vec<DVec3> {
        let values = self.tree.field(&self.mesh, &self.of_each, at_places).into_iter();
        values.map(Option::unwrap_or_default).collect()
    }
}

/// The mesh, turned if it faces the other way than the recorded one, and for each place whether its surface is near.
///
/// The two sides of a thin sheet are both near. The nearer one counts, and that is the facing one on a mesh with the same
/// winding, however thin the sheet is, unless the scans differ by more than its thickness; then neither has the majority.
fn facing_as<'a>(recorded: &Recorded, mesh: Oriented<'a>) -> (Oriented<'a>, Vec<bool>) {
    let within = WITHIN * recorded.bounds.diagonal();
    let surface = &mesh.model.surface;
    let each = recorded.positions.par_iter().zip(&recorded.normals);
    if surface.triangles.is_empty() {
        let points = OrientedPoints::new(&surface.positions, &mesh.normals, within);
        let are_near = each.map_init(Vec::new, |found, (&position, &normal)| {
            points.nearest(position, normal, within, 1, found);
            !found.is_empty()
        });
        let are_near = are_near.collect();
        return (mesh, are_near);
    }
    let bvh = Bvh::build(&surface.positions, &surface.triangles);
    let distances: Vec<[Option<f64>; 2]> = each
        .map(|(&position, &normal)| [normal, -normal].map(|normal| bvh.distance_to_facing(position, normal, within)))
        .collect();
    let is_nearer = |a: Option<f64>, b: Option<f64>| a.is_some_and(|a| b.is_none_or(|b| a < b));
    let facing = distances.iter().filter(|[own, other]| is_nearer(*own, *other)).count();
    let turned = distances.iter().filter(|[own, other]| is_nearer(*other, *own)).count();
    match turned > TURNED * facing {
        true => (
            mesh.turned(),
            distances.iter().map(|[_, other]| other.is_some()).collect(),
        ),
        false => (mesh, distances.iter().map(|[own, _]| own.is_some()).collect()),
    }
}

/// Returns true if a vertex is not where its handle's map moves it.
pub(super) fn is_beside(map: DAffine3, position: DVec3, displacement: DVec3, diagonal: f64) -> bool {
    map.transform_point3(position).distance(position + displacement) > BESIDE * diagonal
}

fn elsewhere(set: &str, share: f64, within: f64) -> EditError {
    EditError::Elsewhere {
        set: set.to_owned(),
        found: percent(share),
        within: rounded(within),
    }
}
