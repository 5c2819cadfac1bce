//! The edit format and the project format: a document and an edit as JSON, and an edit resolved on a model.
//!
//! `json` reads text, `reader` gives its values to serde's derived code and names the place of every refusal
//! (`refusal`); `edit_file` and `project` are the two formats, of `selector`s, `field`s, `transform`s and a `method`
//! with its `attachment`s. `setup` is an edit or a document on a model, ready for the solver, and `exchange` converts
//! between documents and edits.

mod attachment;
mod beginning;
mod curve;
mod cut_curve;
mod digest;
mod document_keys;
mod edit_error;
mod edit_file;
mod examples;
mod exchange;
mod field;
mod filters;
mod flow_file;
mod footprints;
mod handle_entry;
mod handle_on_model;
mod joins;
mod json;
pub(crate) mod kept;
mod keyed;
mod keys;
mod loose;
mod matched_by_place;
mod method;
mod mix;
mod numbered;
mod one_shape;
mod other_mesh;
mod path;
mod pivoted;
mod placed_edit;
mod places;
mod pose;
mod project;
mod reader;
mod recorded_edit;
mod refusal;
mod selector;
mod sequence_edit;
mod sequences;
mod setup;
mod sketch;
mod spans;
pub(crate) mod stored_field;
mod strength;
mod text;
mod transform;
mod version;

pub use attachment::AttachmentEntry;
pub use beginning::Beginning;
pub use digest::digest;
pub use edit_error::EditError;
pub use edit_file::{EditFile, STIFFNESS_RANGE};
pub use examples::{ExampleEntry, ExampleSource};
pub use exchange::ExportError;
pub(crate) use exchange::export;
pub use field::FieldEntry;
pub use filters::FilterEntry;
pub use flow_file::{Accuracy, DyeEntry, FlowFile, FlowMotion, VelocityEntry};
pub use footprints::FootprintEntry;
pub use handle_entry::{HandleEntry, SOFT_RANGE};
pub use joins::{JoinsFile, Placement};
pub use keys::KeyEntry;
pub use matched_by_place::{FoundPlaces, MatchedByPlace};
pub use mix::MixEntry;
pub use one_shape::refuse_keys;
pub use path::PathEntry;
pub(crate) use pivoted::without_pivot;
pub use placed_edit::Placed;
pub use places::Places;
pub use pose::PoseEntry;
pub use project::{MeshReference, Project, StoredKept, geometry_hash};
pub use selector::{Axis, Selector};
pub use sequence_edit::SequenceEdit;
pub use sequences::PathPart;
pub use setup::{HandleSetup, Rest, Setup};
pub use strength::STRENGTH_RANGE;
pub use version::EDIT_VERSION;
