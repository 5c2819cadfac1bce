//! `pliant render`: a picture of a file.

use super::Console;
use super::arguments::RenderArguments;
use crate::AppError;

pub(super) fn run(arguments: &RenderArguments, console: &mut Console<'_>) -> Result<(), AppError> {
    let _ = (arguments, console);
    Err(AppError::Unsupported("this version draws no pictures yet: open the written file in a viewer".to_owned()))
}
