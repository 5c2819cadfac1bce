//! The tools, and what assistants read about them.

use pliant_engine::EngineError;
use pliant_engine::watch::Watch;
use pliant_picture::{Choice, ProjectionName, Shading, Up, View};
use serde::de::DeserializeOwned;
use serde_json::{Value, json};

use super::answer::Answer;
use super::models::Models;
use super::{bending, opening, pictures};
use crate::cli::arguments::methods_help;

/// A tool's function.
type Call = fn(&str, &mut Models, Value, &Watch) -> Result<Answer, EngineError>;

/// A tool.
pub struct Tool {
    /// The name by which it is called.
    pub name: &'static str,
    title: &'static str,
    description: &'static str,
    /// The JSON schemas of its arguments by name, and the names of those that must be given.
    arguments: fn() -> (Value, &'static [&'static str]),
    /// It changes neither files nor a model.
    only_reads: bool,
    call: Call,
}

/// Every tool, in the order of a session.
pub const TOOLS: [Tool; 9] = [
    Tool {
        name: "info",
        title: "Inspect a file",
        description: "Lists a mesh file's contents and the faults of its mesh, without opening it: vertices, triangles, \
                      bounding box, components, materials, findings.",
        arguments: || (file_arguments(), &["file"]),
        only_reads: true,
        call: |name, models, arguments, watch| opening::info(models, read(name, arguments)?, watch),
    },
    Tool {
        name: "open",
        title: "Open a file",
        description: "Opens a mesh file (glb, gltf, obj, ply, stl, off, 3mf or usdz) and gives a name for it, `model`, which the \
                      other tools take. At most 16 models are open at a time.",
        arguments: || (file_arguments(), &["file"]),
        only_reads: true,
        call: |name, models, arguments, watch| opening::open(models, read(name, arguments)?, watch),
    },
    Tool {
        name: "edit_format",
        title: "Describe the edit format",
        description: "Gives the description of edits, selectors and methods. Read it before the first `select` or \
                      `apply`.",
        arguments: || (json!({}), &[]),
        only_reads: true,
        call: |name, _, arguments, _| {
            read::<Nothing>(name, arguments)?;
            Ok(Answer::text(EDIT_FORMAT).and_text(methods_help()))
        },
    },
    Tool {
        name: "select",
        title: "Try a selector",
        description: "Selects vertices of a model by a selector of the edit format, such as {\"slab\": {\"axis\": \"y\", \
                      \"from\": 0.9, \"to\": 1}}, and gives their number, mean, bounding box and file numbers. It \
                      changes nothing.",
        arguments: || {
            let selector = json!({ "description": "A selector of the edit format: a word or an object" });
            (
                json!({ "model": model(), "selector": selector }),
                &["model", "selector"],
            )
        },
        only_reads: true,
        call: |name, models, arguments, watch| opening::select(models, read(name, arguments)?, watch),
    },
    Tool {
        name: "apply",
        title: "Bend a model",
        description: "Bends a model by an edit: handles with transforms, fixed parts, stiffness and a method. The edit \
                      replaces the model's earlier one; each begins at the file's shape. Gives a report with warnings. \
                      Nothing is written.",
        arguments: || {
            let method = json!({ "type": "string",
                "description": "Another method than the edit's: NAME, or NAME:OPTION=VALUE.." });
            (
                json!({ "model": model(), "edit": edit(), "method": method }),
                &["model", "edit"],
            )
        },
        only_reads: false,
        call: |name, models, arguments, watch| bending::apply(models, read(name, arguments)?, watch),
    },
    Tool {
        name: "render",
        title: "Look at a model",
        description: "Draws a model with its edit as a PNG picture. Pictures before and after an edit have the same \
                      view.",
        arguments: || {
            let switch = |what: &str| json!({ "type": "boolean", "default": false, "description": what });
            let clays = pliant_editor::Clay::NAMES.map(|(name, _)| name);
            let arguments = json!({
                "model": model(),
                "look": look("1024x768"),
                "clay": { "enum": clays },
                "projection": names(ProjectionName::CHOICES),
                "original": switch("Draw the file's shape, without the edit"),
                "flat": switch("Shade each triangle flat"),
                "wireframe": switch("Draw the triangles' edges"),
                "borders": switch("Mark the edges where the surface ends"),
                "outlines": switch("Outline the edit's handles and the free region"),
                "grid": switch("Draw the ground's grid"),
                "shadow": switch("Draw a soft shadow on the ground"),
            });
            (arguments, &["model"])
        },
        only_reads: true,
        call: |name, models, arguments, watch| pictures::render(models, read(name, arguments)?, watch),
    },
    Tool {
        name: "compare",
        title: "Compare methods",
        description: "Bends a model by one edit with several methods, and gives a picture with a cell for each and a \
                      table of figures. The model keeps its shape.",
        arguments: || {
            let methods = json!({ "type": "array", "items": { "type": "string" }, "minItems": 1,
                "description": "NAME or NAME:OPTION=VALUE.. each, or `all` alone" });
            let arguments = json!({
                "model": model(), "methods": methods, "edit": edit(), "look": look("1600x1000"),
            });
            (arguments, &["model", "methods"])
        },
        only_reads: true,
        call: |name, models, arguments, watch| pictures::compare(models, read(name, arguments)?, watch),
    },
    Tool {
        name: "save",
        title: "Save a model",
        description: "Writes a model's shape to a file, whose extension tells its format. Everything else in the file \
                      stays as it was. A file that exists is only replaced with `replace`, and is kept beside the new \
                      one.",
        arguments: || {
            let arguments = json!({
                "model": model(),
                "output": { "type": "string", "description": "The path of the file to write" },
                "replace": { "type": "boolean", "default": false, "description": "Replace a file that exists" },
            });
            (arguments, &["model", "output"])
        },
        only_reads: false,
        call: |name, models, arguments, watch| bending::save(models, read(name, arguments)?, watch),
    },
    Tool {
        name: "close",
        title: "Close a model",
        description: "Closes a model and frees its memory. A shape that was not saved is lost.",
        arguments: || (json!({ "model": model() }), &["model"]),
        only_reads: false,
        call: |name, models, arguments, watch| opening::close(models, read(name, arguments)?, watch),
    },
];

/// The manual's page about edits.
const EDIT_FORMAT: &str = include_str!("../../../edit-format.md");

/// Advice for the use of the tools together.
pub const INSTRUCTIONS: &str = "Pliant bends scanned meshes and saves them back with only the shape changed. A session: \
    `open` a file; read `edit_format`; find the parts with `select`, and `render` to see where they are; `apply` an edit; \
    `render` again; try other methods with `compare`; `save` under a new name. Lengths are in the file's units. Refusals \
    say what to change.";

/// No arguments.
#[derive(serde::Deserialize)]
#[serde(deny_unknown_fields)]
struct Nothing {}

impl Tool {
    /// The tool with this name.
    pub fn named(name: &str) -> Option<&'static Self> {
        TOOLS.iter().find(|tool| tool.name == name)
    }

    /// Calls it.
    ///
    /// # Errors
    /// The refusal of the arguments or of the work.
    pub fn call(&self, models: &mut Models, arguments: Value, watch: &Watch) -> Result<Answer, EngineError> {
        (self.call)(self.name, models, arguments, watch)
    }

    /// Its declaration for the client.
    pub fn declaration(&self) -> Value {
        let (properties, required) = (self.arguments)();
        json!({
            "name": self.name,
            "title": self.title,
            "description": self.description,
            "inputSchema": {
                "type": "object",
                "properties": properties,
                "required": required,
                "additionalProperties": false,
            },
            "annotations": {
                "readOnlyHint": self.only_reads,
                "destructiveHint": false,
                "openWorldHint": false,
            },
        })
    }
}

/// The arguments of a call.
fn read<T: DeserializeOwned>(tool: &str, arguments: Value) -> Result<T, EngineError> {
    serde_json::from_value(arguments).map_err(|error| {
        EngineError::Arguments(format!(
            "the arguments of {tool} are wrong: {error}; `tools/list` has their schema"
        ))
    })
}

fn file_arguments() -> Value {
    json!({
        "file": { "type": "string", "description": "The path of the file" },
        "weld": { "type": "number", "minimum": 0,
            "description": "The distance within which vertices are welded; by default it follows from the mesh" },
    })
}

fn model() -> Value {
    json!({ "type": "string", "description": "The model's name, which `open` gave" })
}

fn edit() -> Value {
    json!({ "type": ["object", "string"],
        "description": "An edit as an object, or the path of an edit's file or of a .pliant project" })
}

fn look(size: &str) -> Value {
    json!({
        "type": "object",
        "additionalProperties": false,
        "properties": {
            "size": { "type": "string", "default": size, "description": "WIDTHxHEIGHT in pixels, at most 2048 each" },
            "up": names(Up::CHOICES),
            "view": names(View::CHOICES),
            "shading": names(Shading::CHOICES),
        },
    })
}

fn names<T>(choices: &[Choice<T>]) -> Value {
    let names: Vec<&str> = choices.iter().map(|choice| choice.name).collect();
    json!({ "enum": names })
}

#[cfg(test)]
mod tests {
    use super::EDIT_FORMAT;

    #[test]
    fn the_page_about_edits_is_the_manuals_and_not_the_name_of_a_link() {
        assert!(EDIT_FORMAT.len() > 5000 && EDIT_FORMAT.contains("\"handles\""));
    }
}
