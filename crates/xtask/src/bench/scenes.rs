//! Every method on the survey's scenes and on limbs of scans, with the example `every_method` of the tests.

use super::scale::Scale;
use super::table::{Row, measured};

/// A row for each scene and method; none if the folder in `PLIANT_DATA` is missing.
pub fn rows(_: Scale) -> Result<Vec<Row>, String> {
    measured("pliant-tests", "every_method", &[])
}
