//! Solving for other moments around the shown one.

use std::sync::{Arc, Mutex, PoisonError};

use pliant_deform::{Bound, Solve};
use pliant_mesh::Cancel;

use super::allowance::Allowance;
use super::computed::Computed;
use super::skinned::{Skin, Skinned};
use super::slot::{Unfinished, Work};
use super::solving::Wanted;
use super::work::BindInput;
use crate::document::{Animation, Aspect, Document, Version};
use crate::revision::Revision;
use crate::timeline::{Posed, present_key};

/// The sources of the shapes.
#[derive(Clone, PartialEq, Debug)]
pub(crate) struct SkinSource {
    moments: Vec<(i8, f64)>,
    animation: Animation,
    targets: Version,
    binding: Revision,
}

impl SkinSource {
    /// The moments, each with its place and its time in seconds.
    pub(super) fn moments(&self) -> &[(i8, f64)] {
        &self.moments
    }

    pub(super) fn of(moments: Vec<(i8, f64)>, document: &Document, binding: Revision) -> Self {
        Self {
            moments,
            animation: document.animation().clone(),
            targets: document.versions().of(Aspect::Targets),
            binding,
        }
    }
}

/// Solves for the moments around the shown one, with the present positions of handles as a key there; `None` while
/// nothing is bound.
pub(super) fn skins_work(
    computed: &Computed,
    document: &Document,
    moments: &[(i8, f64)],
    allowance: Allowance,
) -> Option<Work<Box<Skinned>>> {
    let (binding, model) = (computed.slots.bind.last()?, computed.model.as_ref()?);
    let animation = with_present(document);
    let wanted = moments.iter().map(|&(place, time)| {
        let there = document_at(document, &animation, time);
        let handles = &computed.region.handles;
        let wanted = Wanted::of(&there, &document.method, handles, &document.from_rest, None)?;
        Some((place, wanted.along(&binding.lines, &there).anew()))
    });
    let wanted: Vec<(i8, Wanted)> = wanted.collect::<Option<_>>()?;
    if document.method.solve() == Solve::Direct {
        let present = Arc::clone(&binding.bound);
        return Some(Box::new(move |_, cancel| {
            let skins = solved(wanted, &present, cancel)?;
            Ok(Box::new(Skinned { skins, own: None }))
        }));
    }
    let revision = computed.slots.bind.made();
    let last = computed.slots.skins.last().and_then(|last| last.own.clone());
    let last = last.filter(|(of, _)| *of == revision);
    let input = BindInput::of(computed, model, document, revision.0, allowance)?;
    Some(Box::new(move |progress, cancel| {
        let own = match last {
            Some((_, own)) => own,
            None => input.bind(progress, cancel)?.bound,
        };
        let skins = solved(wanted, &own, cancel)?;
        let own = Some((revision, own));
        Ok(Box::new(Skinned { skins, own }))
    }))
}

/// Solves for moments, one after the other, so that a frame of a drag comes in between.
fn solved(wanted: Vec<(i8, Wanted)>, bound: &Mutex<Bound>, cancel: &Cancel) -> Result<Vec<Skin>, Unfinished> {
    let mut skins = Vec::with_capacity(wanted.len());
    for (place, wanted) in wanted {
        cancel.check()?;
        let mut bound = bound.lock().unwrap_or_else(PoisonError::into_inner);
        bound.set_cancel(cancel);
        let solved = wanted.solve(&mut bound, cancel);
        let from_file = solved.map_err(|error| Unfinished::Failed(error.to_string()))?.from_file;
        skins.push(Skin { place, from_file });
    }
    cancel.check()?;
    Ok(skins)
}

/// The document's keys, and the one that *Key here* would set, if a handle is not where the keys have it.
fn with_present(document: &Document) -> Animation {
    let mut animation = document.animation().clone();
    if !Posed::at(&animation, document, animation.time()).is_empty() {
        animation.put(present_key(document, |_| true));
    }
    animation
}

/// The document with its handles where the keys have them at a time.
fn document_at(document: &Document, animation: &Animation, time: f64) -> Document {
    let mut there = document.clone();
    Posed::at(animation, document, time).put(&mut there);
    there
}
