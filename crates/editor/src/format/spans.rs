//! An edit's keys at frames of a sequence: the spans of its handles.

use std::collections::{BTreeMap, BTreeSet};

use glam::DVec3;

use super::edit_error::EditError;
use super::edit_file::EditFile;
use super::footprints::FootprintEntry;
use super::keyed::handle_of;
use super::keys::KeyEntry;
use super::selector::Selector;
use super::setup::Setup;
use crate::HandleTransform;
use crate::document::{HandleFootprints, SplitTransform};
use crate::timeline::{HandlePlace, SequenceTimeline, Span, SpanKey, filter_shifts};
use crate::warning::shortened;

impl EditFile {
    /// The frames in a sequence of `count` frames in which the places of handles must be known, ascending: those of keys
    /// and of filters, and all for footprints, a path and a mix.
    ///
    /// # Errors
    /// Keys at times, or beyond the last frame; data that fit only one frame: lines, cages, examples, a kept shape;
    /// transforms of handles without a key.
    pub fn frames_with_places(&self, count: usize) -> Result<Vec<usize>, EditError> {
        let refuse = |place: String, sentence: &str| {
            let sentence = sentence.to_owned();
            Err(EditError::Other { place, sentence })
        };
        for (number, handle) in self.handles.iter().enumerate() {
            let place = format!("handles[{number}]");
            if handle.line().is_some() {
                return refuse(
                    place,
                    "follows a line, which fits only one frame: move it by keys instead",
                );
            }
            let is_keyed = self.keys.iter().any(|key| key.handles.contains_key(&handle.name));
            if !handle.transform.is_identity() && !is_keyed {
                return refuse(
                    place,
                    "has a transform but no key, so it has no frames: move the transform to a key",
                );
            }
        }
        if let Some(name) = self.attachments.keys().next() {
            return refuse(
                format!("method.{name}"),
                "fits only one frame: leave it out, so that the method makes its own, or take another method",
            );
        }
        if self.inside_out != Selector::None {
            return refuse(
                "inside_out".to_owned(),
                "is for a single file: remove it, and turn the parts in each frame",
            );
        }
        if self.kept.is_some() {
            return refuse(
                "the edit".to_owned(),
                "has a `kept` shape, which fits only one frame: remove it",
            );
        }
        let mut frames = BTreeSet::new();
        for (place, key) in self.keys.iter().enumerate() {
            let Some(frame) = key.frame else {
                return refuse(
                    format!("keys[{place}]"),
                    "has a `time`, not a `frame` and a `span` of a sequence: use `pliant animate`, or give it those",
                );
            };
            let last = key.span.map_or(frame, |[_, last]| last);
            if last as usize >= count {
                return Err(EditError::OutOfRange {
                    place: format!("keys[{place}].{}", if frame == last { "frame" } else { "span" }),
                    found: last.to_string(),
                    allowed: format!("frames from 0 to {}", count.saturating_sub(1)),
                });
            }
            frames.insert(frame as usize);
        }
        for (place, filter) in self.filter.iter().enumerate() {
            let [first, last] = filter.span.map(|frame| frame as usize);
            if last >= count {
                return Err(EditError::OutOfRange {
                    place: format!("filter[{place}].span"),
                    found: last.to_string(),
                    allowed: format!("frames from 0 to {}", count.saturating_sub(1)),
                });
            }
            frames.extend(first..=last);
        }
        if let Some(path) = &self.path {
            path.check_frames(count)?;
        }
        if !self.footprints.is_empty() || self.path.is_some() || self.mix.is_some() {
            frames.extend(0..count);
        }
        Ok(frames.into_iter().collect())
    }

    /// The motions of its handles through a sequence, on the model of `setup`, where the handles are at `rest`. `place`
    /// gives the place of a handle, by its number, in each of the [frames](EditFile::frames_with_places), and `led` the
    /// places to which another sequence leads handles, in every frame.
    ///
    /// # Errors
    /// A name that no handle has, or that two handles have; two keys of a handle at one frame; spans of a handle that
    /// overlap and are not equal.
    pub fn sequence_timeline(
        &self,
        setup: &Setup,
        rest: &[HandlePlace],
        place: impl Fn(usize, usize) -> HandlePlace + Copy,
        led: BTreeMap<usize, Vec<HandlePlace>>,
    ) -> Result<SequenceTimeline, EditError> {
        let names = self.names();
        let mut spans: Vec<Vec<Span>> = vec![Vec::new(); names.len()];
        for (number, key) in self.keys.iter().enumerate() {
            for (name, transform) in &key.handles {
                let in_key = |error: EditError| error.under(&format!("keys[{number}].handles"));
                let handle = handle_of(name, &names).map_err(in_key)?;
                let pivot = (setup.handles[handle].pivot, &rest[handle]);
                let own = self.span_key(
                    key,
                    transform,
                    place(key.frame.unwrap_or_default() as usize, handle),
                    pivot,
                );
                add(&mut spans[handle], key, own).map_err(|sentence| EditError::Other {
                    place: format!("keys[{number}]"),
                    sentence: format!("moves `{}`, {sentence}", shortened(name)),
                })?;
            }
        }
        for span in spans.iter_mut().flatten() {
            span.keys.sort_by_key(|key| key.frame);
        }
        Ok(SequenceTimeline {
            spans,
            shifts: self.shifts(&names, place)?,
            led,
            strength: self.strength * self.mix.as_ref().map_or(1.0, |mix| mix.share),
        })
    }

    /// The footprints, each with the number of its handle.
    ///
    /// # Errors
    /// A method that moves handles as a whole; a name that no handle has, or that two handles have; a handle that a key, a
    /// filter or another footprint moves too.
    pub fn footprints_of_handles(&self) -> Result<Vec<(usize, &FootprintEntry)>, EditError> {
        let refusal = HandleFootprints::refusal_by(&self.method).filter(|_| !self.footprints.is_empty());
        if let Some(sentence) = refusal {
            let place = "footprints".to_owned();
            return Err(EditError::Other { place, sentence });
        }
        let names = self.names();
        let mut found: Vec<(usize, &FootprintEntry)> = Vec::new();
        for (place, footprint) in self.footprints.iter().enumerate() {
            let name = &footprint.handle;
            let in_footprint = |error: EditError| error.under(&format!("footprints[{place}].handle"));
            let handle = handle_of(name, &names).map_err(in_footprint)?;
            if self.is_keyed_or_filtered(name) || found.iter().any(|(other, _)| *other == handle) {
                return Err(EditError::Other {
                    place: format!("footprints[{place}]"),
                    sentence: format!(
                        "holds `{}`, which a key, a filter or another footprint moves too: keep one of them",
                        shortened(name)
                    ),
                });
            }
            found.push((handle, footprint));
        }
        Ok(found)
    }

    /// The shifts of each handle by the filters, by frame. The trajectory of a handle with a parent is filtered as the
    /// parent sees it.
    fn shifts(
        &self,
        names: &[&str],
        place: impl Fn(usize, usize) -> HandlePlace,
    ) -> Result<Vec<BTreeMap<usize, DVec3>>, EditError> {
        let mut shifts = vec![BTreeMap::new(); names.len()];
        for (number, filter) in self.filter.iter().enumerate() {
            let in_filter = |error: EditError| error.under(&format!("filter[{number}].handle"));
            let handle = handle_of(&filter.handle, names).map_err(in_filter)?;
            let parent = self.handles[handle].parent.map(|parent| parent as usize);
            let frames = filter.span[0] as usize..=filter.span[1] as usize;
            let places = frames
                .clone()
                .map(|frame| (place(frame, handle), parent.map(|parent| place(frame, parent))));
            let gain = filter.kind.gain(filter.amount);
            let own = filter_shifts(&places.collect::<Vec<_>>(), filter.width, gain);
            for (frame, shift) in frames.zip(own) {
                *shifts[handle].entry(frame).or_insert(DVec3::ZERO) += shift * self.strength;
            }
        }
        Ok(shifts)
    }

    /// A key of a handle that has this place there, and whose pivot is a point at another place.
    fn span_key(
        &self,
        key: &KeyEntry,
        transform: &HandleTransform,
        place: HandlePlace,
        (pivot, at): (DVec3, &HandlePlace),
    ) -> SpanKey {
        // The pivot rides along with the handle.
        let pivot = place.carried(pivot, at);
        SpanKey {
            frame: key.frame.unwrap_or_default() as usize,
            ease: key.ease,
            space: key.space,
            place,
            transform: SplitTransform::of(&transform.part(self.strength, pivot), pivot),
        }
    }
}

/// Adds a key to the spans of its handle.
fn add(spans: &mut Vec<Span>, key: &KeyEntry, own: SpanKey) -> Result<(), String> {
    let ends = key.span.unwrap_or_default().map(|frame| frame as usize);
    match spans
        .iter_mut()
        .find(|span| span.ends[0] <= ends[1] && ends[0] <= span.ends[1])
    {
        None => spans.push(Span { ends, keys: vec![own] }),
        Some(span) if span.ends == ends => {
            if span.keys.iter().any(|other| other.frame == own.frame) {
                let frame = own.frame;
                return Err(format!("but another key does so at frame {frame}: keep one of them"));
            }
            if span.keys.iter().any(|other| other.space != own.space) {
                return Err("but with another `space` than other keys of its span: give them the same".to_owned());
            }
            span.keys.push(own);
        }
        Some(span) => {
            let [first, last] = span.ends;
            return Err(format!(
                "but its span overlaps with [{first}, {last}] of another key: give both the same span, or spans that \
                 don't meet"
            ));
        }
    }
    Ok(())
}
