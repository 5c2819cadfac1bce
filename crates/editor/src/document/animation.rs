//! The edit over time: keys, which hold the positions of handles at moments, and the moment that is shown.

use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

use super::body_path::BodyPath;
use super::handle::{Handle, HandleId};
use super::handle_curve::HandleCurve;
use super::handle_filter::HandleFilter;
use super::handle_footprints::HandleFootprints;
use super::handle_mix::HandleMix;
use super::key_id::{KeyId, KeyRow};
use super::pose::Placed;
use crate::ease::Ease;
use crate::key_space::KeySpace;

/// The frames a second of an animation that has no other rate.
const FPS: f64 = 24.0;

/// A time that is nearer to a frame than this share of a frame is that frame's.
const NEAR: f64 = 1e-9;

/// The keys of a document, and the moment that it shows.
#[derive(Clone, PartialEq, Debug)]
pub struct Animation {
    /// By time; each has a time of its own and is not empty.
    pub(super) keys: Arc<Vec<KeyFrame>>,
    /// The shown moment, in seconds, at least 0.
    pub(super) time: f64,
    /// The frames a second, in [`Animation::FPS_RANGE`].
    pub(super) fps: f64,
    /// The number of frames of the sequence that is edited, at least 1; `None` for an edit of one shape.
    pub(super) frames: Option<usize>,
    /// The bent path of a sequence's body; `None` if it is the body's own.
    pub(super) path: Option<Arc<BodyPath>>,
    /// The filters of handles' ways through a sequence.
    pub(super) filters: Arc<BTreeMap<HandleId, HandleFilter>>,
    /// The handles that are held wherever they rest on the ground.
    pub(super) footprints: Arc<BTreeMap<HandleId, HandleFootprints>>,
    /// The sequence that leads handles; `None` if none does.
    pub(super) mix: Option<Arc<HandleMix>>,
}

/// The positions of handles at a moment. Handles that it does not name pass by on the way to keys of their own.
#[derive(Clone, PartialEq, Debug, Default)]
pub struct KeyFrame {
    /// In seconds, at least 0.
    pub time: f64,
    /// The way to the next key of each handle.
    pub ease: Ease,
    pub(crate) handles: BTreeMap<HandleId, Placed>,
    /// The shown curves that some of them follow, of those at rest at that time.
    pub(crate) curves: BTreeMap<HandleId, HandleCurve>,
    /// The first and the last frame of a sequence over which the key of each handle spreads.
    pub(crate) spans: BTreeMap<HandleId, [usize; 2]>,
    /// The handles of a sequence whose keys stay the same to the world's axes, not to the handle's own.
    pub(crate) in_world: BTreeSet<HandleId>,
    /// The weights of the method's examples, if they bend the surface.
    pub(crate) weights: Option<Vec<Option<f64>>>,
    /// The share of the edit that is made, from 0 to 1. If a key of the animation has one, all keys have the whole
    /// positions; if none has, they have the shown ones.
    pub(crate) strength: Option<f64>,
}

impl KeyFrame {
    /// The handles that it names.
    pub fn handles(&self) -> impl Iterator<Item = HandleId> {
        self.handles.keys().copied()
    }

    /// Returns true if it names this handle.
    pub fn has(&self, handle: HandleId) -> bool {
        self.handles.contains_key(&handle)
    }

    /// The share of the edit that is made at its time, from 0 to 1, if it has one.
    pub fn strength(&self) -> Option<f64> {
        self.strength
    }

    /// The weights of the method's examples, if it has some.
    pub fn weights(&self) -> Option<&[Option<f64>]> {
        self.weights.as_deref()
    }

    /// The axes in which the key of a handle in a sequence stays the same.
    pub fn space(&self, handle: HandleId) -> KeySpace {
        match self.in_world.contains(&handle) {
            true => KeySpace::World,
            false => KeySpace::Local,
        }
    }

    /// The rows in which it stands.
    pub fn rows(&self) -> impl Iterator<Item = KeyRow> {
        let strength = self.strength.map(|_| KeyRow::Strength);
        let weights = self.weights.as_ref().map(|_| KeyRow::Weights);
        self.handles().map(KeyRow::Handle).chain(strength).chain(weights)
    }

    fn is_empty(&self) -> bool {
        self.rows().next().is_none()
    }
}

impl Default for Animation {
    fn default() -> Self {
        Self {
            keys: Arc::default(),
            time: 0.0,
            fps: FPS,
            frames: None,
            path: None,
            filters: Arc::default(),
            footprints: Arc::default(),
            mix: None,
        }
    }
}

impl Animation {
    /// The smallest and the largest number of frames a second.
    pub const FPS_RANGE: std::ops::RangeInclusive<f64> = 1.0..=1000.0;

    /// The latest time, in seconds: a week.
    pub const LATEST: f64 = 604_800.0;

    /// Keys in any order.
    pub(crate) fn of(keys: impl IntoIterator<Item = KeyFrame>, time: f64, fps: f64) -> Self {
        let mut animation = Self {
            keys: Arc::default(),
            time,
            fps,
            frames: None,
            path: None,
            filters: Arc::default(),
            footprints: Arc::default(),
            mix: None,
        };
        keys.into_iter().for_each(|key| animation.put(key));
        animation
    }

    /// The keys, by time.
    pub fn keys(&self) -> &[KeyFrame] {
        &self.keys
    }

    /// The shown moment, in seconds.
    pub fn time(&self) -> f64 {
        self.time
    }

    /// The frames a second.
    pub fn fps(&self) -> f64 {
        self.fps
    }

    /// The time of the last key, in seconds, or of a sequence's last frame; 0 without keys.
    pub fn duration(&self) -> f64 {
        match self.frames {
            Some(count) => (count - 1) as f64 / self.fps,
            None => self.keys.last().map_or(0.0, |key| key.time),
        }
    }

    /// The frame at a time in seconds, a fraction between two frames.
    pub fn frame_at(&self, time: f64) -> f64 {
        time * self.fps
    }

    /// The time of the frame nearest to a time in seconds.
    pub fn snapped(&self, time: f64) -> f64 {
        let latest = if self.frames.is_some() {
            self.duration()
        } else {
            Self::LATEST
        };
        (time.clamp(0.0, latest) * self.fps).round() / self.fps
    }

    /// Every key of every row.
    pub(crate) fn ids(&self) -> impl Iterator<Item = KeyId> {
        let of_key = |key: &KeyFrame| {
            let rows: Vec<KeyId> = key.rows().map(|row| KeyId::new(row, key.time)).collect();
            rows
        };
        self.keys.iter().flat_map(of_key)
    }

    /// Returns true if a key has a share of the edit: the keys then have the whole positions.
    pub fn has_strength(&self) -> bool {
        self.keys.iter().any(|key| key.strength.is_some())
    }

    /// The same animation at another moment.
    pub(crate) fn at(&self, time: f64) -> Self {
        Self {
            time: self.tidy(time),
            ..self.clone()
        }
    }

    /// Adds a key. If there is one at its time, each handle that it names gets its position, and that one's ease stays.
    pub(crate) fn put(&mut self, key: KeyFrame) {
        if key.is_empty() {
            return;
        }
        let time = self.tidy(key.time);
        let keys = Arc::make_mut(&mut self.keys);
        match keys.binary_search_by(|other| other.time.total_cmp(&time)) {
            Ok(place) => {
                let own = &mut keys[place];
                own.in_world.retain(|id| !key.handles.contains_key(id));
                own.in_world.extend(key.in_world);
                own.handles.extend(key.handles);
                own.curves.extend(key.curves);
                own.spans.extend(key.spans);
                own.weights = key.weights.or(own.weights.take());
                own.strength = key.strength.or(own.strength);
            }
            Err(place) => keys.insert(place, KeyFrame { time, ..key }),
        }
    }

    /// Takes keys of single rows out.
    pub(crate) fn take(&mut self, ids: &BTreeSet<KeyId>) -> Vec<KeyFrame> {
        let mut taken = Vec::new();
        let keys = Arc::make_mut(&mut self.keys);
        for key in keys.iter_mut() {
            let is_taken = |id: HandleId| ids.contains(&KeyId::new(id, key.time));
            let (own, rest) = std::mem::take(&mut key.handles)
                .into_iter()
                .partition(|(id, _)| is_taken(*id));
            key.handles = rest;
            let (curves, rest) = std::mem::take(&mut key.curves)
                .into_iter()
                .partition(|(id, _)| is_taken(*id));
            key.curves = rest;
            let (spans, rest) = std::mem::take(&mut key.spans)
                .into_iter()
                .partition(|(id, _)| is_taken(*id));
            key.spans = rest;
            let (in_world, rest) = std::mem::take(&mut key.in_world)
                .into_iter()
                .partition(|id| is_taken(*id));
            key.in_world = rest;
            let is_row_taken = |row: KeyRow| ids.contains(&KeyId::new(row, key.time));
            let weights = key.weights.take_if(|_| is_row_taken(KeyRow::Weights));
            let strength = key.strength.take_if(|_| is_row_taken(KeyRow::Strength));
            taken.push(KeyFrame {
                time: key.time,
                ease: key.ease,
                handles: own,
                curves,
                spans,
                in_world,
                weights,
                strength,
            });
        }
        keys.retain(|key| !key.is_empty());
        taken.retain(|key| !key.is_empty());
        taken
    }

    /// Moves keys of single rows to other times; those that come upon a key of their row replace it. Returns them
    /// at their new times.
    pub(crate) fn retime(&mut self, ids: &BTreeSet<KeyId>, time: impl Fn(f64) -> f64) -> BTreeSet<KeyId> {
        let mut moved = self.take(ids);
        for key in &mut moved {
            let before = self.frame_of(key);
            key.time = self.tidy(time(key.time));
            key.shift_spans(self.frame_of(key) as isize - before as isize);
        }
        self.put_all(moved)
    }

    /// Adds keys, and returns the key of every row in them.
    pub(crate) fn put_all(&mut self, keys: Vec<KeyFrame>) -> BTreeSet<KeyId> {
        let added = Self {
            frames: self.frames,
            ..Self::of(keys, self.time, self.fps)
        };
        let ids = added.ids().collect();
        added.keys.iter().for_each(|key| self.put(key.clone()));
        ids
    }

    /// Gives the moments of keys another way to the next.
    pub(crate) fn set_ease(&mut self, ids: &BTreeSet<KeyId>, ease: Ease) {
        for key in Arc::make_mut(&mut self.keys) {
            if key.rows().any(|row| ids.contains(&KeyId::new(row, key.time))) {
                key.ease = ease;
            }
        }
    }

    /// Keeps the keys' positions of handles when each handle's map of the rest shape becomes the new rest shape. Their
    /// curves are those of the former one and go.
    pub(crate) fn rebase(&mut self, handles: &[Handle]) {
        for key in Arc::make_mut(&mut self.keys) {
            key.curves.clear();
            for handle in handles {
                if let Some(placed) = key.handles.get_mut(&handle.id) {
                    *placed = placed.rebased(handle.affine(), handle.centre());
                }
            }
        }
    }

    /// The memory of the keys and of the path.
    pub(super) fn bytes(&self) -> usize {
        let of_curve = |curve: &HandleCurve| curve.moved().len() * 10 * size_of::<f64>();
        let of_key = |key: &KeyFrame| {
            let curves = key.curves.values().map(of_curve).sum::<usize>();
            size_of::<KeyFrame>() + key.handles.len() * size_of::<(HandleId, Placed)>() + curves
        };
        let of_path = self.path.as_ref().map_or(0, |path| path.bytes());
        self.keys.iter().map(of_key).sum::<usize>() + of_path
    }

    /// A time that is allowed, on the frame that it means.
    fn tidy(&self, time: f64) -> f64 {
        if self.frames.is_some() {
            return self.snapped(time);
        }
        let time = time.abs().min(Self::LATEST);
        let frame = (time * self.fps).round();
        if (time * self.fps - frame).abs() < NEAR {
            return frame / self.fps;
        }
        time
    }
}
