//! The other sequence that leads handles of the open one, as a person chooses it.

use std::borrow::Cow;
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use pliant_editor::{Command, HandleMix};
use pliant_engine::files;

use crate::window::application::Application;

impl Application {
    /// Lets the sequence of a file lead handles, once it was found to fit: those that are led already, or the selected
    /// one.
    pub fn mix_with(&mut self, file: &Path) {
        let frame = self.editor.document().animation().frame();
        self.session.check_mix(file, frame, &self.workers);
    }

    /// Takes the sequence that was found to fit.
    pub(in crate::window) fn take_mix(&mut self, chosen: Result<PathBuf, String>) {
        self.session.has_checked_mix();
        let path = match chosen {
            Ok(path) => path,
            Err(sentence) => return self.fail(sentence),
        };
        let sequence = files::path_as_text(&path);
        let mix = match self.editor.document().animation().mix() {
            Some(mix) => HandleMix {
                sequence,
                ..(**mix).clone()
            },
            None => HandleMix {
                sequence,
                handles: BTreeSet::from_iter(self.editor.view().selected),
                share: 1.0,
            },
        };
        let command = Command::SetMix(Some(mix));
        match self.editor.unavailable_because(&command).map(Cow::into_owned) {
            Some(why) => self.fail(why),
            None => self.command(command),
        }
    }
}
