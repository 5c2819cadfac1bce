//! Cages and examples that are read from files.

use std::borrow::Cow;
use std::path::PathBuf;
use std::sync::Arc;

use glam::DVec3;
use pliant_deform::{Attachment, ControlMesh, ExampleShape};
use pliant_editor::Command;
use pliant_engine::control_mesh::control_mesh;
use pliant_engine::watch::Watch;
use pliant_engine::{EngineError, Loaded, examples};

use crate::window::application::Application;
use crate::window::session::OpenFile;
use crate::window::threads::message::Message;

impl Application {
    /// Reads a cage, off the window's thread.
    pub fn load_cage(&mut self, path: PathBuf) {
        let read = move || {
            let mesh = control_mesh(&path, &Watch::default());
            Message::Cage(mesh.map_err(|error| error.to_string()))
        };
        self.workers
            .spawn("control mesh", read, |sentence| Message::Cage(Err(sentence)));
    }

    /// Takes the cage that was read.
    pub(in crate::window) fn take_cage(&mut self, mesh: Result<(Vec<DVec3>, Vec<[u32; 3]>), String>) {
        match mesh {
            Ok((rest, triangles)) => {
                let rest = Arc::new(rest);
                let cage = Attachment::Mesh(ControlMesh {
                    moved: Arc::clone(&rest),
                    rest,
                    triangles: Arc::new(triangles),
                });
                self.command(Command::BringAttachment(cage));
            }
            Err(sentence) => self.fail(sentence),
        }
    }

    /// Reads a shape of the open file for an example, off the window's thread.
    pub fn load_example(&mut self, path: PathBuf) {
        self.read_example(move |loaded| {
            let displacements = examples::from_file(&path, loaded, &Watch::default())?;
            Ok(example(
                &path.file_stem().unwrap_or_default().to_string_lossy(),
                displacements,
            ))
        });
    }

    /// Reads a morph target of the open file for an example, off the window's thread.
    pub(super) fn load_morph_target(&mut self, target: String) {
        self.read_example(move |loaded| {
            let displacements = examples::from_morph_target(&target, loaded, &Watch::default())?;
            Ok(example(&target, displacements))
        });
    }

    fn read_example(&mut self, read: impl FnOnce(&Loaded) -> Result<ExampleShape, EngineError> + Send + 'static) {
        let Some(open) = &self.session.open else { return };
        let loaded = Arc::clone(&open.loaded);
        let unread = Arc::clone(&loaded);
        self.workers.spawn(
            "example",
            move || {
                let shape = read(&loaded).map_err(|error| error.to_string());
                Message::Example(loaded, shape)
            },
            move |sentence| Message::Example(unread.clone(), Err(sentence)),
        );
    }

    /// Takes the example that was read, unless another file has been opened.
    pub(in crate::window) fn take_example(&mut self, of: &Arc<Loaded>, shape: Result<ExampleShape, String>) {
        let is_open = |open: &OpenFile| Arc::ptr_eq(&open.loaded, of);
        if !self.session.open.as_ref().is_some_and(is_open) {
            return;
        }
        match shape.map(Command::AddExample) {
            Ok(command) => match self.editor.unavailable_because(&command).map(Cow::into_owned) {
                Some(why) => self.fail(why),
                None => self.command(command),
            },
            Err(sentence) => self.fail(sentence),
        }
    }
}

fn example(name: &str, displacements: Vec<DVec3>) -> ExampleShape {
    ExampleShape {
        name: name.to_owned(),
        displacements: Arc::new(displacements),
    }
}
