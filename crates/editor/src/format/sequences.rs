//! The members of an edit that only sequences have: the path of the body, and the sequence that leads handles.

use glam::DVec3;

use super::edit_error::EditError;
use super::edit_file::EditFile;
use super::keyed::handle_of;
use super::path::PathEntry;
use crate::timeline::{BodyMotion, body_motions};
use crate::warning::shortened;

/// The part of a body whose middle makes the path.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum PathPart {
    /// All of it.
    Body,
    /// A handle, by its number.
    Handle(usize),
}

impl EditFile {
    /// The first member that only a sequence has.
    pub fn member_of_sequences(&self) -> Option<&'static str> {
        let members = [
            ("filter", !self.filter.is_empty()),
            ("footprints", !self.footprints.is_empty()),
            ("path", self.path.is_some()),
            ("mix", self.mix.is_some()),
        ];
        members
            .into_iter()
            .find(|(_, is_there)| *is_there)
            .map(|(member, _)| member)
    }

    /// The part whose middle makes the path of the body, if the edit bends it.
    ///
    /// # Errors
    /// A name that no handle has, or that two handles have.
    pub fn part_of_path(&self) -> Result<Option<PathPart>, EditError> {
        let Some(path) = &self.path else { return Ok(None) };
        let Some(name) = &path.handle else {
            return Ok(Some(PathPart::Body));
        };
        let found = handle_of(name, &self.names()).map_err(|error| error.under("path.handle"))?;
        Ok(Some(PathPart::Handle(found)))
    }

    /// The motions of the body by its bent path, where the path's part has its middle at `trajectory` in each frame; none
    /// without a path. The path's frames are frames of the trajectory.
    pub fn body_motions(&self, trajectory: &[DVec3]) -> Vec<BodyMotion> {
        let motions = |path: &PathEntry| body_motions(trajectory, &path.shifts(self.strength), path.up.direction());
        self.path.as_ref().map_or_else(Vec::new, motions)
    }

    /// The numbers of the handles that another sequence leads, ascending.
    ///
    /// # Errors
    /// A name that no handle has, or that two handles have; a handle that a key, a filter or a footprint moves too.
    pub fn led_handles(&self) -> Result<Vec<usize>, EditError> {
        let Some(mix) = &self.mix else { return Ok(Vec::new()) };
        let names = self.names();
        let named = mix.handles.iter().enumerate().map(|(place, name)| {
            handle_of(name, &names).map_err(|error| error.under(&format!("mix.handles[{place}]")))
        });
        let mut led = match mix.handles.is_empty() {
            true => (0..names.len()).collect(),
            false => named.collect::<Result<Vec<usize>, EditError>>()?,
        };
        led.sort_unstable();
        led.dedup();
        let is_moved = |name: &str| {
            let has_footprints = self.footprints.iter().any(|footprint| footprint.handle == name);
            has_footprints || self.is_keyed_or_filtered(name)
        };
        match led.iter().find(|handle| is_moved(names[**handle])) {
            None => Ok(led),
            Some(handle) => Err(EditError::Other {
                place: "mix".to_owned(),
                sentence: format!(
                    "leads `{}`, which a key, a filter or a footprint moves too: name the other handles in \
                     `mix.handles`, or remove one of them",
                    shortened(names[*handle])
                ),
            }),
        }
    }

    /// Returns true if a key or a filter moves the handles with this name.
    pub(super) fn is_keyed_or_filtered(&self, name: &str) -> bool {
        let is_keyed = self.keys.iter().any(|key| key.handles.contains_key(name));
        is_keyed || self.filter.iter().any(|filter| filter.handle == *name)
    }

    /// The handles' names, in their order.
    pub(super) fn names(&self) -> Vec<&str> {
        self.handles.iter().map(|handle| &*handle.name).collect()
    }
}
