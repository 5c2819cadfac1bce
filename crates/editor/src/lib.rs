//! The program without a window. So far: the edit format, its selectors, and what an edit means on a model.

mod edit_error;
mod edit_file;
mod edit_node;
mod handle_transform;
mod method_form;
mod polar;
mod selection;
mod selector;
mod setup;

pub use edit_error::EditError;
pub use edit_file::{EDIT_VERSION, EditFile, HandleEntry, STIFFNESS_RANGE, StiffnessEntry};
pub use handle_transform::HandleTransform;
pub use method_form::{MethodOption, method_options};
pub use selection::Selection;
pub use selector::{Axis, Selector};
pub use setup::{HandleSetup, Setup};
