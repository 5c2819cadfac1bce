//! Pictures: `render` and `compare`.

use std::collections::BTreeSet;
use std::sync::Arc;

use pliant_editor::Clay;
use pliant_engine::EngineError;
use pliant_engine::watch::Watch;
use pliant_picture::{
    Choice, Comparison, LookOptions, PictureSize, Posed, ProjectionName, Shading, Shape, StillOptions, Subject, Up,
    View, draw, named, picture_file, resolved,
};
use serde::Deserialize;
use serde_json::Value;

use super::answer::Answer;
use super::bending::given_edit;
use super::models::Models;
use crate::cli::compare::asked;

/// The largest side of a picture in an answer, in pixels.
const LARGEST_SIDE: u32 = 2048;

/// The view and the colours.
#[derive(Deserialize, Default)]
#[serde(deny_unknown_fields)]
pub struct Look {
    size: Option<String>,
    up: Option<String>,
    view: Option<String>,
    shading: Option<String>,
}

/// The arguments of `render`.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Render {
    model: String,
    #[serde(default)]
    look: Look,
    clay: Option<String>,
    projection: Option<String>,
    #[serde(default)]
    original: bool,
    #[serde(default)]
    flat: bool,
    #[serde(default)]
    wireframe: bool,
    #[serde(default)]
    borders: bool,
    #[serde(default)]
    outlines: bool,
    #[serde(default)]
    grid: bool,
    #[serde(default)]
    shadow: bool,
}

/// The arguments of `compare`.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Compare {
    model: String,
    methods: Vec<String>,
    edit: Option<Value>,
    #[serde(default)]
    look: Look,
}

impl Look {
    fn size(&self, default: PictureSize) -> Result<PictureSize, EngineError> {
        let Some(text) = &self.size else {
            return Ok(default);
        };
        let size: PictureSize = text
            .parse()
            .map_err(|why| EngineError::Arguments(format!("size: {why}")))?;
        match size.width.max(size.height) <= LARGEST_SIDE {
            true => Ok(size),
            false => Err(EngineError::Arguments(format!(
                "size {}x{} is too large for an answer: give at most {LARGEST_SIDE} each way, or draw it with `pliant \
                 render`",
                size.width, size.height
            ))),
        }
    }

    fn options(&self) -> Result<LookOptions, EngineError> {
        Ok(LookOptions {
            up: chosen("up", Up::CHOICES, self.up.as_deref())?,
            view: chosen("view", View::CHOICES, self.view.as_deref())?,
            shading: chosen("shading", Shading::CHOICES, self.shading.as_deref())?,
        })
    }
}

/// The choice with this name, or the default.
fn chosen<T: Copy + Default>(what: &str, choices: &[Choice<T>], name: Option<&str>) -> Result<T, EngineError> {
    let Some(name) = name else {
        return Ok(T::default());
    };
    named(choices, name).map_err(|why| {
        let name = pliant_io::quoted(name);
        EngineError::Arguments(format!("{what} {name} is not known: {why}"))
    })
}

/// Draws a model, with its edit if it has one.
pub fn render(models: &mut Models, given: Render, watch: &Watch) -> Result<Answer, EngineError> {
    let opened = models.get(&given.model)?;
    let clays = Clay::NAMES.map(|(name, value)| Choice { name, value, help: "" });
    let size = PictureSize {
        width: 1024,
        height: 768,
    };
    let options = StillOptions {
        size: given.look.size(size)?,
        look: given.look.options()?,
        clay: chosen("clay", &clays, given.clay.as_deref())?,
        projection: chosen("projection", ProjectionName::CHOICES, given.projection.as_deref())?,
        flat: given.flat,
        wireframe: given.wireframe,
        borders: given.borders,
        outlines: given.outlines,
        grid: given.grid,
        shadow: given.shadow,
        ..StillOptions::default()
    };
    let loaded = &opened.loaded;
    let bent = opened.bent.as_ref().filter(|_| !given.original);
    let edit = bent.map(|bent| resolved(&bent.edit, &bent.place, loaded, watch));
    let edit = edit.transpose()?.map(|resolved| resolved.edit);
    // It was solved by `apply`; here the edit gives only the regions.
    let mut shape = Shape::of(loaded, edit, Posed::AtRest, watch)?;
    if let Some(bent) = bent {
        shape.displacements = Arc::new(bent.displacements.clone());
    }
    let inside_out = bent.map_or_else(BTreeSet::new, |bent| bent.inside_out.clone());
    let subject = Subject {
        loaded,
        shape: &shape,
        inside_out: &inside_out,
    };
    let mut answer = Answer::default();
    let notes = draw(&subject, &options, watch, |picture| {
        let png = picture_file::png(picture)?;
        answer = std::mem::take(&mut answer).and_png(&png);
        Ok(())
    })?;
    Ok(answer.and_text(notes.join("\n")))
}

/// Draws one edit by several methods side by side, with figures.
pub fn compare(models: &mut Models, given: Compare, watch: &Watch) -> Result<Answer, EngineError> {
    let methods = asked("methods", &given.methods)?;
    if methods.is_empty() {
        return Err(EngineError::Arguments(
            "methods is empty: name one, or `all`".to_owned(),
        ));
    }
    let opened = models.get(&given.model)?;
    let size = PictureSize {
        width: 1600,
        height: 1000,
    };
    let (size, look) = (given.look.size(size)?, given.look.options()?);
    let source = given.edit.map(given_edit);
    let own = source.as_ref().map(|source| source.edit(watch)).transpose()?;
    let (edit, edit_place) = match (&own, &source, &opened.bent) {
        (Some(own), Some(source), _) => (own, source.place()),
        (_, _, Some(bent)) => (&bent.edit, &*bent.place),
        _ => {
            return Err(EngineError::Arguments(format!(
                "{} has no edit to compare: give `edit`, or call `apply` first",
                given.model
            )));
        }
    };
    let job = Comparison {
        loaded: &opened.loaded,
        edit,
        edit_place,
        methods: &methods,
        frames: None,
        size,
        look,
    };
    let compared = pliant_picture::compare(&job, watch)?;
    let warnings = compared.warnings.join("\n");
    Ok(Answer::text(compared.table).and_png(&compared.sheet).and_text(warnings))
}
