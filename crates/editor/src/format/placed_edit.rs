//! An edit on another mesh than the one that it was made on.

use glam::DVec3;
use pliant_deform::CONTINUITY_RANGE;
use pliant_mesh::{Bvh, Model, OrientedPoints, SurfaceVertex};
use rayon::prelude::*;
use serde::Serialize;

use super::attachment::AttachmentEntry;
use super::edit_error::EditError;
use super::edit_file::{EditFile, STIFFNESS_RANGE};
use super::examples::ExampleSource;
use super::field::FieldEntry;
use super::kept::StoredKept;
use super::places::{Oriented, PlaceTree, Places, Recorded};
use super::selector::Selector;
use super::stored_field::Field;
use crate::warning::shortened;

/// A place is found if the other surface is as near as this share of the first mesh' diagonal.
const WITHIN: f64 = 0.02;

/// A handle of which less than this share of its places is found is refused.
const LEAST_FOUND: f64 = 0.5;

/// The sentence names no more handles than this, those of which the least was found.
const MOST_NAMED: usize = 4;

/// An edit by the numbers of the mesh on which it is used.
#[derive(Clone, Debug)]
pub struct Placed {
    /// The edit, without places.
    pub edit: EditFile,
    /// What was found.
    pub matched: MatchedByPlace,
}

/// How much of an edit's sets another mesh has.
#[derive(Clone, PartialEq, Debug, Serialize)]
pub struct MatchedByPlace {
    /// The distance within which a place counts as found, in world units.
    pub within: f64,
    /// The sets with recorded places: the handles in their order, then the free region.
    pub found: Vec<FoundPlaces>,
    /// Sentences about parts of the edit that stay behind.
    pub left_out: Vec<String>,
}

/// How much of a set was found.
#[derive(Clone, PartialEq, Debug, Serialize)]
pub struct FoundPlaces {
    /// The handle's name, or "the free region".
    pub set: String,
    /// The share of its places that have a partner, 0 to 1.
    pub share: f64,
}

impl MatchedByPlace {
    /// The sentence for a person.
    pub fn sentence(&self) -> String {
        let mut found: Vec<&FoundPlaces> = self.found.iter().collect();
        if found.len() > MOST_NAMED + 1 {
            found.sort_by(|a, b| a.share.total_cmp(&b.share));
            found.truncate(MOST_NAMED);
        }
        let parts: Vec<String> = found
            .iter()
            .map(|found| format!("{} of {}", percent(found.share), found.set))
            .collect();
        let others = match self.found.len() > parts.len() {
            true => ", more of the others",
            false => "",
        };
        let mut sentence = format!(
            "the edit was made on another mesh and is matched by place: {}{others} has a partner within {}",
            parts.join(", "),
            rounded(self.within)
        );
        for left_out in &self.left_out {
            sentence = format!("{sentence}; {left_out}");
        }
        sentence
    }
}

fn percent(share: f64) -> String {
    format!("{:.0}%", (100.0 * share).floor())
}

/// Two digits of a length.
fn rounded(length: f64) -> String {
    let digits = (1.0 - length.log10().floor()).clamp(0.0, 12.0);
    format!("{length:.*}", digits as usize)
}

impl EditFile {
    /// The edit by the numbers of `model`, if that is another mesh than the one that the edit was made on; `None` if it
    /// is the same, or if the edit has no places, so that its numbers count as they are.
    ///
    /// # Errors
    /// A handle of which less than half is found, examples by numbers, and numbers that do not fit the places.
    pub fn placed(&self, model: &Model) -> Result<Option<Placed>, EditError> {
        let Some(places) = self.places.as_ref().filter(|places| !places.are_of(model)) else {
            return Ok(None);
        };
        let recorded = places.recorded()?;
        self.refuse_numbered_examples(places)?;
        let mut other = Other::of(places, &recorded, model);
        let mut matched = other.found(self)?;
        let field = |entries: &[FieldEntry], member: &str, scale: Scale| -> Result<Vec<FieldEntry>, EditError> {
            let each = entries.iter().enumerate();
            each.map(|(index, entry)| other.field(entry, &format!("{member}[{index}]"), scale))
                .collect()
        };
        let mut handles = self.handles.clone();
        for (index, handle) in handles.iter_mut().enumerate() {
            let select = handle.select.as_ref();
            let select = select.map(|select| other.selected(select, &format!("handles[{index}].select")));
            handle.select = select.transpose()?;
        }
        let loose_parts = self.loose_parts.iter().enumerate();
        let loose_parts = loose_parts.map(|(index, (select, loose))| {
            let parts = other.whole_parts(select, &format!("loose[{}].select", index + 1))?;
            Ok((parts, *loose))
        });
        let kept = match self.kept.as_ref().filter(|_| !self.handles.is_empty()) {
            Some(kept) => other.kept(kept, &mut matched.left_out)?,
            None => None,
        };
        let edit = Self {
            places: None,
            region: other.selected(&self.region, "region")?,
            fixed: other.selected(&self.fixed, "fixed")?,
            handles,
            stiffness: field(&self.stiffness, "stiffness", Scale::Logarithmic)?,
            continuity: field(&self.continuity, "continuity", Scale::Linear)?,
            loose_parts: loose_parts.collect::<Result<_, EditError>>()?,
            inside_out: other.whole_parts(&self.inside_out, "inside_out")?,
            kept,
            ..self.clone()
        };
        Ok(Some(Placed { edit, matched }))
    }

    /// Refuses examples that are numbers for each vertex.
    fn refuse_numbered_examples(&self, places: &Places) -> Result<(), EditError> {
        for (name, entry) in &self.attachments {
            let AttachmentEntry::Examples(examples) = entry else {
                continue;
            };
            let numbered = |source: &ExampleSource| matches!(source, ExampleSource::PerVertex(_));
            if let Some(index) = examples.iter().position(|example| numbered(&example.source)) {
                return Err(EditError::Other {
                    place: format!("method.{name}[{index}]"),
                    sentence: format!(
                        "is a shape of the mesh with {} vertices that the edit was made on, and examples are not matched \
                         by place: give the example as a `file` with this mesh' vertices, or choose another method",
                        places.vertex_count()
                    ),
                });
            }
        }
        Ok(())
    }
}

/// How a field's numbers are interpolated.
#[derive(Clone, Copy, PartialEq)]
enum Scale {
    Linear,
    Logarithmic,
}

/// The mesh on which an edit is used, matched to the places of the one that it was made on.
struct Other<'a> {
    places: &'a Places,
    mesh: Oriented<'a>,
    tree: PlaceTree<'a>,
    /// The place of each surface vertex.
    of_each: Vec<Option<u32>>,
}

impl<'a> Other<'a> {
    fn of(places: &'a Places, recorded: &'a Recorded, model: &'a Model) -> Self {
        let mesh = Oriented::of(model);
        let tree = PlaceTree::of(recorded);
        let of_each = tree.of_each(&mesh);
        Self {
            places,
            mesh,
            tree,
            of_each,
        }
    }

    /// Finds the sets' places, and gives a handle that is smaller than this mesh' triangles the vertices next to them.
    fn found(&mut self, edit: &EditFile) -> Result<MatchedByPlace, EditError> {
        let recorded = self.tree.recorded;
        let within = WITHIN * recorded.bounds.diagonal();
        let is_found = self.are_found(within);
        let mut found = Vec::new();
        let share_of = |is_in: &[bool]| {
            let own = recorded.numbers.iter().zip(&is_found);
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
                small.extend(own.filter(|place| is_found[*place as usize]));
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
            left_out: Vec::new(),
        })
    }

    /// For each place, whether the surface is as near.
    fn are_found(&self, within: f64) -> Vec<bool> {
        let recorded = self.tree.recorded;
        let surface = &self.mesh.model.surface;
        let each = recorded.positions.par_iter().zip(&recorded.normals);
        if surface.triangles.is_empty() {
            let points = OrientedPoints::new(&surface.positions, &self.mesh.normals, within);
            return each
                .map_init(Vec::new, |found, (&position, &normal)| {
                    points.nearest(position, normal, within, 1, found);
                    !found.is_empty()
                })
                .collect();
        }
        let bvh = Bvh::build(&surface.positions, &surface.triangles);
        each.map(|(&position, &normal)| bvh.distance_to_facing(position, normal, within).is_some())
            .collect()
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
    fn selected(&self, selector: &Selector, place: &str) -> Result<Selector, EditError> {
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
    fn whole_parts(&self, selector: &Selector, place: &str) -> Result<Selector, EditError> {
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
    fn field(&self, entry: &FieldEntry, place: &str, scale: Scale) -> Result<FieldEntry, EditError> {
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

    /// The corrections by hand on this mesh, with the shape from which they are solved.
    fn kept(&self, kept: &StoredKept, left_out: &mut Vec<String>) -> Result<Option<StoredKept>, EditError> {
        let Some(corrected) = kept.clone().for_another_method() else {
            left_out.push("its shape is solved anew".to_owned());
            return Ok(None);
        };
        if !self.places.are_shown_once() {
            left_out.push("corrections by hand stay behind, because the first mesh shows vertices twice".to_owned());
            return Ok(None);
        }
        let kept = corrected.with_fields(|field, name| {
            let stored = field.by_number::<3>(name, self.places.vertex_count())?;
            let numbers = self.tree.recorded.numbers.iter();
            let at_places: Vec<DVec3> = numbers
                .map(|number| DVec3::from_array(stored[*number as usize]))
                .collect();
            let values = self.tree.field(&self.mesh, &self.of_each, &at_places);
            Ok(Field::of(self.mesh.model, |v| {
                let value = values[v.index()].filter(|value| *value != DVec3::ZERO)?;
                Some(value.to_array())
            }))
        });
        kept.map(Some)
    }
}

fn elsewhere(set: &str, share: f64, within: f64) -> EditError {
    EditError::Elsewhere {
        set: set.to_owned(),
        found: percent(share),
        within: rounded(within),
    }
}
