//! Solving for the frames of a sequence around the shown one: the edit is bound in each frame, on the shape that it has
//! there.

use std::collections::BTreeMap;
use std::sync::Arc;

use glam::DVec3;
use pliant_mesh::{Cancel, Model, Progress};

use super::allowance::Allowance;
use super::computed::Computed;
use super::skinned::{Skin, Skinned};
use super::slot::{Unfinished, Work};
use super::solving::Wanted;
use super::work::BindInput;
use crate::document::{Animation, Aspect, Document, FramePlace, HandleId, Version};
use crate::timeline::BodyMotion;

/// A frame of a sequence around the shown one.
pub(crate) struct FrameSkin {
    /// As in [`Skin`].
    pub(crate) place: i8,
    pub(crate) frame: usize,
    /// The displacements of the frame's own shape from the file's.
    pub(crate) shape: Arc<Vec<DVec3>>,
    /// The places of the handles in it.
    pub(crate) places: BTreeMap<HandleId, FramePlace>,
    /// The motions of the body along its bent path in this frame and in the shown one.
    pub(crate) motions: Option<(BodyMotion, BodyMotion)>,
}

/// The sources of the shapes.
#[derive(Clone, PartialEq, Debug)]
pub(crate) struct FrameSkinSource {
    frames: Vec<(i8, usize)>,
    /// True if the body and the handles were followed through all frames.
    knows_way: bool,
    animation: Animation,
    versions: [Version; 8],
}

impl FrameSkinSource {
    pub(super) fn of(frames: Vec<(i8, usize)>, knows_way: bool, document: &Document) -> Self {
        let aspects = [
            Aspect::Paint,
            Aspect::Stiffness,
            Aspect::Continuity,
            Aspect::Method,
            Aspect::Tips,
            Aspect::Loose,
            Aspect::Constraints,
            Aspect::Targets,
        ];
        Self {
            frames,
            knows_way,
            animation: document.animation().clone(),
            versions: aspects.map(|aspect| document.versions().of(aspect)),
        }
    }
}

/// Solves for frames one after the other, each in a binding of its own, of which there is one at a time; `None` while the
/// ordering is missing.
pub(super) fn frame_skins_work(
    computed: &Computed,
    document: &Document,
    skins: Vec<FrameSkin>,
    allowance: Allowance,
) -> Option<Work<Box<Skinned>>> {
    let model = Arc::clone(computed.model.as_ref()?);
    let revision = computed.slots.bind.made().0;
    let input = match computed.region.handles.is_empty() {
        true => None,
        false => Some(BindInput::of(computed, &model, document, revision, allowance)?),
    };
    let document = document.clone();
    let handles = computed.region.handles.clone();
    Some(Box::new(move |progress, cancel| {
        let mut solved = Vec::with_capacity(skins.len());
        for skin in skins {
            cancel.check()?;
            let mut there = document.clone();
            there.put_frame(skin.frame, &skin.shape, &skin.places);
            let from_file = match &input {
                Some(input) if there.is_moved() => bent(input, there, &handles, progress, cancel)?,
                _ => Arc::clone(&skin.shape),
            };
            let from_file = carried(from_file, &model, skin.motions);
            solved.push(Skin {
                place: skin.place,
                from_file,
            });
        }
        cancel.check()?;
        Ok(Box::new(Skinned {
            skins: solved,
            own: None,
        }))
    }))
}

/// The bent shape of the frame that a document shows, as displacements from the file's.
fn bent(
    input: &BindInput,
    there: Document,
    handles: &[HandleId],
    progress: &Progress,
    cancel: &Cancel,
) -> Result<Arc<Vec<DVec3>>, Unfinished> {
    let wanted = Wanted::of(&there, &there.method, handles, &there.from_rest, None);
    let wanted = wanted.ok_or(Unfinished::Cancelled)?;
    let binding = input.of_document(there.clone()).bind(progress, cancel)?;
    let mut bound = binding.bound.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
    bound.set_cancel(cancel);
    let solved = wanted.along(&binding.lines, &there).anew().solve(&mut bound, cancel);
    let solved = solved.map_err(|error| Unfinished::Failed(error.to_string()))?;
    Ok(solved.from_file)
}

/// The shape in the space of the shown frame, if the body's path carries both frames.
fn carried(from_file: Arc<Vec<DVec3>>, model: &Model, motions: Option<(BodyMotion, BodyMotion)>) -> Arc<Vec<DVec3>> {
    let Some((there, shown)) = motions.filter(|(there, shown)| there.moves() || shown.moves()) else {
        return from_file;
    };
    let file = model.surface.positions.iter();
    let places = file.zip(&*from_file).map(|(file, way)| {
        let place = there.moved(*file + *way);
        shown.before(place) - *file
    });
    Arc::new(places.collect())
}
