//! Actions on the keys of the edit over time.
//!
//! The document shows one moment. When the moment or the keys change, handles with keys go where the keys have them at
//! that moment, in the same step of the history, and the surface is solved for them from the same start as every other
//! frame. Handles without keys stay.

use std::collections::BTreeSet;

use pliant_deform::Solve;

use super::key_work::Play;
use super::state::Workspace;
use crate::document::{Animation, Aspect, Document, HandleId, KeyFrame, KeyId, Placed};
use crate::ease::Ease;
use crate::jobs::JobKind;
use crate::key_space::KeySpace;
use crate::timeline::{Posed, present_key};

/// Sets a key of handles at the shown moment, at their present positions; pins have no keys. Selects it.
pub(crate) fn key_here(workspace: &mut Workspace, is_wanted: impl Fn(HandleId) -> bool) {
    let mut key = present_key(&workspace.document, is_wanted);
    workspace.without_filters(&mut key);
    workspace.edit_keys("Key here", |animation| Some(animation.put_all(vec![key])));
}

/// Sets a key of the strength alone at the shown moment: the share of the edit that is shown. Selects it. The first such
/// key makes the keys of handles whole: they have the shown positions, of which this share is made.
pub(crate) fn key_strength(workspace: &mut Workspace) {
    let document = &workspace.document;
    let key = KeyFrame {
        time: document.animation().time(),
        strength: Some(document.strength()),
        ..KeyFrame::default()
    };
    workspace.edit_keys("Key strength", |animation| Some(animation.put_all(vec![key])));
}

/// Sets a key of the weights of examples alone at the shown moment. Selects it.
pub(crate) fn key_weights(workspace: &mut Workspace) {
    let animation = workspace.document.animation();
    let in_full = animation.has_strength().then(|| workspace.document.in_full());
    let document = in_full.as_ref().unwrap_or(&workspace.document);
    let key = KeyFrame {
        time: animation.time(),
        weights: document.examples().map(|examples| examples.weights.clone()),
        ..KeyFrame::default()
    };
    workspace.edit_keys("Key weights", |animation| Some(animation.put_all(vec![key])));
}

/// Sets a key at the shown moment from a kept pose, and shows it.
pub(crate) fn key_pose(workspace: &mut Workspace, place: usize) {
    let document = &workspace.document;
    let Some(pose) = document.poses().get(place) else {
        return;
    };
    let is_keyed = |id: &HandleId| document.handle(*id).is_some_and(|handle| !handle.is_pin);
    let handles = pose.handles.iter().filter(|(id, _)| is_keyed(id));
    let key = KeyFrame {
        time: document.animation().time(),
        handles: handles
            .map(|(id, placed)| (*id, posed(document, *id, *placed)))
            .collect(),
        ..KeyFrame::default()
    };
    let key = KeyFrame {
        weights: document
            .examples_name()
            .and_then(|name| pose.weights.get(name).cloned()),
        ..key
    };
    let name = format!("Key {}", pose.name);
    workspace.edit_keys(name, |animation| Some(animation.put_all(vec![key])));
}

/// The place of a pose's handle in a key. In another frame of a sequence it is moved as much from its place there.
fn posed(document: &Document, id: HandleId, placed: Placed) -> Placed {
    match document.handle(id).filter(|_| document.animation().frames().is_some()) {
        Some(handle) => Placed {
            pivot: handle.pivot,
            ..placed
        },
        None => placed,
    }
}

/// Shows a moment, in seconds.
pub(crate) fn go_to(workspace: &mut Workspace, time: f64) {
    if workspace.document.animation().frames().is_some() {
        let frame = workspace.document.animation().frame_at(time);
        return workspace.want_frame(frame.round() as usize);
    }
    workspace.step("Go to time", |workspace| workspace.show_moment(time));
}

/// Shows the moment so many frames later.
pub(crate) fn step_frames(workspace: &mut Workspace, frames: i32) {
    let animation = workspace.document.animation();
    let frame = animation.frame_at(animation.time());
    let next = match frames < 0 {
        true => (frame - 1e-6).ceil(),
        false => (frame + 1e-6).floor(),
    } + f64::from(frames);
    let time = next.max(0.0) / animation.fps();
    if animation.frames().is_some() {
        return workspace.step_frames(frames);
    }
    go_to(workspace, time);
}

/// The time of the next key after the shown moment, or of the last one before it.
pub(crate) fn neighbour_key(animation: &Animation, is_forward: bool) -> Option<f64> {
    let (now, mut times) = (animation.time(), animation.keys().iter().map(|key| key.time));
    match is_forward {
        true => times.find(|time| *time > now),
        false => times.rfind(|time| *time < now),
    }
}

/// Moves the selected keys by a time in seconds; none goes below 0.
pub(crate) fn move_keys(workspace: &mut Workspace, by: f64) {
    let first = workspace.first_selected().unwrap_or(0.0);
    let by = by.max(-first);
    retime(workspace, "Move keys", |time| time + by);
}

/// Stretches the times of the selected keys by a factor about the first of them.
pub(crate) fn stretch_keys(workspace: &mut Workspace, factor: f64) {
    let first = workspace.first_selected().unwrap_or(0.0);
    retime(workspace, "Stretch keys", |time| first + (time - first) * factor);
}

fn retime(workspace: &mut Workspace, name: &str, time: impl Fn(f64) -> f64) {
    let selected = workspace.keys.selected.clone();
    workspace.edit_keys(name, |animation| Some(animation.retime(&selected, time)));
}

/// Removes the selected keys.
pub(crate) fn delete_keys(workspace: &mut Workspace) {
    let selected = workspace.keys.selected.clone();
    workspace.edit_keys("Delete keys", |animation| {
        animation.take(&selected);
        Some(BTreeSet::new())
    });
}

/// Keeps the selected keys to be pasted.
pub(crate) fn copy_keys(workspace: &mut Workspace) {
    let mut animation = workspace.document.animation().clone();
    workspace.keys.copied = animation.take(&workspace.keys.selected);
}

/// Sets the copied keys, the first of them at the shown moment. Handles that no longer exist are left out.
pub(crate) fn paste_keys(workspace: &mut Workspace) {
    let mut keys = workspace.keys.copied.clone();
    let Some(first) = keys.first().map(|key| key.time) else {
        return;
    };
    let now = workspace.document.animation().time();
    let animation = workspace.document.animation();
    let frames = (animation.frame_at(now) - animation.frame_at(first)).round();
    for key in &mut keys {
        key.time += now - first;
        key.shift_spans(frames as isize);
        key.handles.retain(|id, _| workspace.document.handle(*id).is_some());
    }
    workspace.edit_keys("Paste keys", |animation| Some(animation.put_all(keys)));
}

/// Gives the moments of the selected keys another way to the next.
pub(crate) fn set_key_ease(workspace: &mut Workspace, ease: Ease) {
    let selected = workspace.keys.selected.clone();
    workspace.edit_keys("Change ease", |animation| {
        animation.set_ease(&selected, ease);
        None
    });
}

/// Chooses the axes in which the selected keys of a sequence stay the same, with all keys of their spans.
pub(crate) fn set_key_space(workspace: &mut Workspace, space: KeySpace) {
    let selected = workspace.keys.selected.clone();
    workspace.edit_keys("Change axes of keys", |animation| {
        animation.set_space(&selected, space);
        None
    });
}

/// Changes the frames over which a key, and those with the same span, spread.
pub(crate) fn set_span(workspace: &mut Workspace, id: KeyId, to: [usize; 2]) {
    workspace.edit_keys("Change span", |animation| {
        animation.set_span(id, to);
        None
    });
}

/// Chooses the number of frames a second. Keys keep their times.
pub(crate) fn set_fps(workspace: &mut Workspace, fps: f64) {
    workspace.change("Change frame rate", |document| {
        document.set_animation(document.animation().with_fps(fps));
    });
}

/// The document's moment and keys.
impl Workspace {
    /// Changes the keys in one step, and shows the present moment of the changed ones. `change` returns the keys that
    /// are selected then, unless the selection stays.
    fn edit_keys(&mut self, name: impl Into<String>, change: impl FnOnce(&mut Animation) -> Option<BTreeSet<KeyId>>) {
        self.step(name, |workspace| {
            let mut animation = workspace.document.animation().clone();
            let selected = change(&mut animation);
            animation.drop_useless_keys();
            animation.tidy_spans();
            let time = animation.time();
            workspace.document.set_animation(animation);
            if let Some(selected) = selected {
                workspace.keys.selected = selected;
            }
            match workspace.document.animation().frames() {
                Some(_) => workspace.pose_frame(),
                None => workspace.show_moment(time),
            }
        });
    }

    /// Shows a moment, in seconds: handles with keys go to their transforms at that time.
    fn show_moment(&mut self, time: f64) {
        let document = &mut self.document;
        let animation = document.animation().at(time);
        let posed = Posed::at(&animation, document, animation.time());
        document.set_animation(animation);
        if posed.is_empty() {
            return;
        }
        document.unsettle();
        posed.put(document);
        // While the moment is dragged, shapes go on from the last one, so that an iterative method keeps up.
        if !self.is_adjusting() {
            self.jobs.solve_anew(self.document.versions().of(Aspect::Targets));
        }
    }

    /// The drag of the moment has ended: the shape is solved like that of every other frame.
    pub(super) fn end_scrubbing(&mut self, before: &Animation) {
        let document = &mut self.document;
        let is_scrubbed = before.time() != document.animation().time() && before.frames().is_none();
        if is_scrubbed && document.is_moved() && document.method().solve() != Solve::Direct {
            self.jobs.drop_solves();
            document.unsettle();
            self.jobs.solve_anew(document.versions().of(Aspect::Targets));
        }
    }

    /// Selects keys; those that don't exist are left out.
    pub(crate) fn select_keys(&mut self, ids: impl IntoIterator<Item = KeyId>) {
        self.keys.selected = ids.into_iter().collect();
        self.drop_lost_keys();
    }

    /// Selects every key.
    pub(crate) fn select_all_keys(&mut self) {
        self.keys.selected = self.document.animation().ids().collect();
    }

    /// Drops selected keys that no longer exist.
    pub(super) fn drop_lost_keys(&mut self) {
        if !self.keys.selected.is_empty() {
            let present: BTreeSet<KeyId> = self.document.animation().ids().collect();
            self.keys.selected.retain(|id| present.contains(id));
        }
    }

    fn first_selected(&self) -> Option<f64> {
        self.keys.selected.iter().map(|id| id.time()).reduce(f64::min)
    }
}

/// Play.
impl Workspace {
    /// Begins to play the frames over and over, or pauses.
    pub(crate) fn play_or_pause_keys(&mut self) {
        if self.keys.is_playing() {
            return self.pause_keys();
        }
        let step = self.begin("Play");
        let now_ms = self.jobs.now_ms();
        self.keys.play = Some(Play {
            step,
            began_ms: now_ms,
            next_ms: now_ms,
        });
    }

    /// Ends a stretch of play, which becomes a step.
    pub(crate) fn pause_keys(&mut self) {
        if let Some(play) = self.keys.play.take() {
            self.commit(&play.step);
        }
    }

    /// Shows the next frame of a stretch of play, once the last one is solved and its time is over. No frame is left
    /// out. With an executor that does not measure time, every call shows one.
    pub(crate) fn tick(&mut self) {
        let now_ms = self.jobs.now_ms();
        let Some(play) = &mut self.keys.play else { return };
        if self.frames.is_awaited() {
            return;
        }
        if !self.document.is_settled() {
            let kinds = [JobKind::Order, JobKind::Region, JobKind::Bind, JobKind::Solve];
            if !kinds.into_iter().any(|kind| self.jobs.is_busy(kind)) {
                // It was stopped, or failed.
                self.pause_keys();
            }
            return;
        }
        if now_ms < play.next_ms && now_ms != play.began_ms {
            return;
        }
        let animation = self.document.animation();
        play.next_ms = now_ms.max(play.next_ms + 1000.0 / animation.fps());
        let next = (animation.frame_at(animation.time()) + 1e-6).floor() + 1.0;
        let last = animation.frame_at(animation.duration()) + 1e-6;
        let frame = if next > last { 0.0 } else { next };
        match animation.frames() {
            Some(_) => self.want_frame(frame as usize),
            None => {
                let time = frame / animation.fps();
                self.show_moment(time);
            }
        }
    }
}
