//! An edit of a sequence as the beginning of a document.

use std::collections::{BTreeMap, BTreeSet};

use pliant_mesh::Model;

use super::document_keys::placed;
use super::edit_error::EditError;
use super::edit_file::EditFile;
use super::exchange::import;
use super::keyed::handle_of;
use super::path::PathEntry;
use super::setup::Setup;
use crate::HandleTransform;
use crate::document::{Animation, BodyPath, Document, HandleFilter, HandleId, HandleMix, KeyFrame};
use crate::ease::Ease;
use crate::key_space::KeySpace;
use crate::timeline::HandlePlace;
use crate::warning::shortened;

/// An edit of a sequence, and its keys, path, filters, footprints and mix for a document.
#[derive(Clone, PartialEq, Debug)]
pub struct SequenceEdit {
    /// The edit without those, at rest and in full.
    pub(super) edit: EditFile,
    animation: Animation,
}

impl SequenceEdit {
    /// An edit of a sequence on the model of `setup`, on which it was resolved and where the handles are at `rest`. `place`
    /// gives the place of a handle, by its number, in each frame that has a key.
    ///
    /// # Errors
    /// What [`EditFile::sequence_timeline`], [`EditFile::footprints_of_handles`] and [`EditFile::led_handles`] refuse, and
    /// what only the command line has: keys at one frame with different eases, the path of a handle, two filters of one.
    pub fn of(
        edit: &EditFile,
        setup: &Setup,
        rest: &[HandlePlace],
        place: impl Fn(usize, usize) -> HandlePlace + Copy,
    ) -> Result<Self, EditError> {
        let of_keys = EditFile {
            filter: Vec::new(),
            ..edit.clone()
        };
        of_keys.sequence_timeline(setup, rest, place, BTreeMap::new())?;
        let names = edit.names();
        let mut animation = Animation::default();
        for (number, key) in edit.keys.iter().enumerate() {
            let refuse = |sentence: &str| EditError::Other {
                place: format!("keys[{number}]"),
                sentence: sentence.to_owned(),
            };
            let frame = key.frame.unwrap_or_default();
            let is_other = |other: &Ease| *other != key.ease;
            let mut same = edit
                .keys
                .iter()
                .filter(|other| other.frame == key.frame)
                .map(|other| &other.ease);
            if same.any(is_other) {
                return Err(refuse(
                    "has another `ease` than another key at its frame, but the window has one at each frame: give them the \
                     same",
                ));
            }
            let mut own = KeyFrame {
                time: f64::from(frame) / animation.fps(),
                ease: key.ease,
                ..KeyFrame::default()
            };
            for (name, transform) in &key.handles {
                let handle = handle_of(name, &names)?;
                let (id, pivot) = (HandleId(handle as u16), setup.handles[handle].pivot);
                let pivot = transform.pivot_or(place(frame as usize, handle).carried(pivot, &rest[handle]));
                own.handles
                    .insert(id, placed(transform.part(edit.strength, pivot), pivot));
                if key.space == KeySpace::World {
                    own.in_world.insert(id);
                }
                own.spans
                    .extend(key.span.map(|span| (id, span.map(|end| end as usize))));
            }
            animation.put(own);
        }
        let animation = with_ways(animation, edit)?;
        Ok(Self {
            edit: at_rest(edit),
            animation,
        })
    }

    /// The document on the model.
    ///
    /// # Errors
    /// Those of [`EditFile::resolve`].
    pub(super) fn document(&self, model: &Model) -> Result<Document, EditError> {
        let mut document = import(&self.edit, model)?;
        document.set_animation(self.animation.clone());
        Ok(document)
    }
}

/// The same animation with the path, the filters, the footprints and the mix of an edit.
fn with_ways(mut animation: Animation, edit: &EditFile) -> Result<Animation, EditError> {
    let names = edit.names();
    let id = |name: &str, place: &str| -> Result<HandleId, EditError> {
        let handle = handle_of(name, &names).map_err(|error| error.under(place))?;
        Ok(HandleId(handle as u16))
    };
    if let Some(path) = &edit.path {
        path.check_of_document()?;
        animation = animation.with_path(part_of_path(path, edit.strength));
    }
    for (number, filter) in edit.filter.iter().enumerate() {
        let id = id(&filter.handle, &format!("filter[{number}].handle"))?;
        if animation.filters().contains_key(&id) {
            return Err(EditError::Other {
                place: format!("filter[{number}]"),
                sentence: format!(
                    "is a second one of `{}`, but the window has one for each handle: keep one of them",
                    shortened(&filter.handle)
                ),
            });
        }
        let own = filter.filter();
        let amount = own.amount * edit.strength;
        animation = animation.with_filter(id, Some(HandleFilter { amount, ..own }));
    }
    for (handle, footprint) in edit.footprints_of_handles()? {
        animation = animation.with_footprints(HandleId(handle as u16), Some(footprint.footprints()));
    }
    if let Some(mix) = &edit.mix {
        let led: BTreeSet<HandleId> = edit
            .led_handles()?
            .into_iter()
            .map(|handle| HandleId(handle as u16))
            .collect();
        let mix = mix.mix(led);
        let share = mix.share * edit.strength;
        animation = animation.with_mix(Some(HandleMix { share, ..mix }));
    }
    Ok(animation)
}

fn part_of_path(path: &PathEntry, share: f64) -> Option<BodyPath> {
    BodyPath::of(path.shifts(share).into_iter().collect(), path.up)
}

/// The edit without motions.
fn at_rest(edit: &EditFile) -> EditFile {
    let mut edit = EditFile {
        keys: Vec::new(),
        filter: Vec::new(),
        footprints: Vec::new(),
        path: None,
        mix: None,
        strength: 1.0,
        ..edit.clone()
    };
    for handle in &mut edit.handles {
        handle.transform = HandleTransform::IDENTITY;
    }
    edit
}
