//! The open models, which requests name.

use std::collections::{BTreeMap, BTreeSet};
use std::path::PathBuf;

use glam::DVec3;
use pliant_editor::Beginning;
use pliant_engine::files::Staging;
use pliant_engine::watch::Watch;
use pliant_engine::{EngineError, Loaded};
use pliant_io::quoted;
use pliant_mesh::WeldOptions;

/// The most models that are open at the same time, so that a forgetful client does not fill the memory.
const MOST_MODELS: usize = 16;

/// A model.
pub struct Opened {
    /// The file.
    pub loaded: Loaded,
    /// The welding with which it was read.
    pub weld: WeldOptions,
    /// The files that were read for it.
    pub watch: Watch,
    /// Its edit, if it has one.
    pub bent: Option<Bent>,
}

/// The shape of an edit on a model.
pub struct Bent {
    /// The edit as it was given.
    pub edit: Beginning,
    /// The edit's file, or its name in messages.
    pub place: PathBuf,
    /// The connected parts that are turned inside out, by their numbers.
    pub inside_out: BTreeSet<u32>,
    /// The position of each drawn vertex, in world space.
    pub positions: Vec<DVec3>,
    /// The displacement of each surface vertex, in world space.
    pub displacements: Vec<DVec3>,
}

/// The open models by their names.
pub struct Models {
    opened: BTreeMap<String, Opened>,
    count: u32,
    /// The files that saves write.
    pub staging: Staging,
}

impl Models {
    /// No model yet.
    pub fn new(staging: Staging) -> Self {
        Self {
            opened: BTreeMap::new(),
            count: 0,
            staging,
        }
    }

    /// Refuses another model if too many are open.
    ///
    /// # Errors
    /// [`EngineError::Unsupported`].
    pub fn check_room(&self) -> Result<(), EngineError> {
        match self.opened.len() < MOST_MODELS {
            true => Ok(()),
            false => Err(EngineError::Unsupported(format!(
                "{MOST_MODELS} models are open: close one first"
            ))),
        }
    }

    /// Adds a model and gives its name.
    pub fn add(&mut self, opened: Opened) -> String {
        self.count += 1;
        let name = format!("model-{}", self.count);
        self.opened.insert(name.clone(), opened);
        name
    }

    /// The model with this name.
    ///
    /// # Errors
    /// [`EngineError::Arguments`], naming it.
    pub fn get(&mut self, name: &str) -> Result<&mut Opened, EngineError> {
        self.opened.get_mut(name).ok_or_else(|| missing(name))
    }

    /// Closes a model.
    ///
    /// # Errors
    /// As [`Models::get`].
    pub fn remove(&mut self, name: &str) -> Result<Opened, EngineError> {
        self.opened.remove(name).ok_or_else(|| missing(name))
    }
}

fn missing(name: &str) -> EngineError {
    EngineError::Arguments(format!(
        "no model is open as {}: call `open`, which gives a model's name",
        quoted(name)
    ))
}
