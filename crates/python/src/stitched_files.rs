//! New shapes of files, like `pliant merge`, `pliant fill`, `pliant bridge` and `pliant cut`.

use std::path::{Path, PathBuf};

use glam::DVec3;
use pliant_engine::EngineError;
use pliant_engine::files::{Staging, is_same, shown};
use pliant_engine::stitching::{
    self, Cut, CutAlong, Fill, Holes, Keep, Merge, Plane, Remaking, Replace, ReportTo, Stitched,
};
use pliant_engine::watch::Watch;
use pyo3::prelude::*;

use crate::given::given;
use crate::refusal::refused;
use crate::reported::reported;
use crate::values::weld_options;

#[doc = include_str!(concat!(env!("OUT_DIR"), "/merge.txt"))]
#[pyfunction]
#[pyo3(signature = (first, second, *, joins, output, report=None, weld=None))]
pub fn merge<'py>(
    py: Python<'py>,
    first: PathBuf,
    second: PathBuf,
    joins: &Bound<'py, PyAny>,
    output: PathBuf,
    report: Option<PathBuf>,
    weld: Option<f64>,
) -> PyResult<Bound<'py, PyAny>> {
    let remaking = remaking(&first, &output, report.as_deref(), weld)?;
    let joins = given(joins, "joins")?;
    run(py, |watch| {
        let job = Merge {
            remaking,
            second: &second,
            joins: &joins.joins(watch)?,
            joins_path: joins.place(),
        };
        stitching::merge(&job, watch, &Staging::default())
    })
}

#[doc = include_str!(concat!(env!("OUT_DIR"), "/fill.txt"))]
#[pyfunction]
#[pyo3(signature = (file, *, output, largest=None, at=None, report=None, weld=None))]
pub fn fill(
    py: Python<'_>,
    file: PathBuf,
    output: PathBuf,
    largest: Option<i64>,
    at: Option<i64>,
    report: Option<PathBuf>,
    weld: Option<f64>,
) -> PyResult<Bound<'_, PyAny>> {
    let remaking = remaking(&file, &output, report.as_deref(), weld)?;
    let holes = match (largest, at) {
        (Some(_), Some(_)) => return Err(refused("give largest or at, not both")),
        (Some(count), None) => match usize::try_from(count) {
            Ok(count) if count > 0 => Holes::Largest(count),
            _ => return Err(refused(format!("largest is {count}: give a number from 1"))),
        },
        (None, Some(number)) => Holes::At(vertex(number, "at")?),
        (None, None) => Holes::Every,
    };
    run(py, |watch| {
        stitching::fill(&Fill { remaking, holes }, watch, &Staging::default())
    })
}

#[doc = include_str!(concat!(env!("OUT_DIR"), "/bridge.txt"))]
#[pyfunction]
#[pyo3(signature = (file, *, borders, output, report=None, weld=None))]
pub fn bridge(
    py: Python<'_>,
    file: PathBuf,
    borders: (i64, i64),
    output: PathBuf,
    report: Option<PathBuf>,
    weld: Option<f64>,
) -> PyResult<Bound<'_, PyAny>> {
    let remaking = remaking(&file, &output, report.as_deref(), weld)?;
    let holes = Holes::Between([vertex(borders.0, "borders[0]")?, vertex(borders.1, "borders[1]")?]);
    run(py, |watch| {
        stitching::fill(&Fill { remaking, holes }, watch, &Staging::default())
    })
}

#[doc = include_str!(concat!(env!("OUT_DIR"), "/cut.txt"))]
#[pyfunction]
#[pyo3(signature = (file, *, output, delete=None, plane=None, curve=None, keep="positive", report=None, weld=None))]
#[expect(clippy::too_many_arguments, reason = "they are the command's arguments, by name")]
pub fn cut<'py>(
    py: Python<'py>,
    file: PathBuf,
    output: PathBuf,
    delete: Option<&Bound<'py, PyAny>>,
    plane: Option<[f64; 4]>,
    curve: Option<&Bound<'py, PyAny>>,
    keep: &str,
    report: Option<PathBuf>,
    weld: Option<f64>,
) -> PyResult<Bound<'py, PyAny>> {
    let remaking = remaking(&file, &output, report.as_deref(), weld)?;
    let keep = match keep {
        "positive" => Keep::Positive,
        "negative" => Keep::Negative,
        "both" => Keep::Both,
        _ => return Err(refused("keep takes \"positive\", \"negative\" or \"both\"")),
    };
    let plane = plane.map(|[x, y, z, level]| {
        Plane::of(DVec3::new(x, y, z), level)
            .ok_or_else(|| refused("plane is (nx, ny, nz, d): its normal has no direction, or a number is not finite"))
    });
    match (delete, plane.transpose()?, curve) {
        (None, Some(plane), None) => run(py, |watch| {
            let along = CutAlong::Plane(plane, keep);
            stitching::cut(&Cut { remaking, along }, watch, &Staging::default())
        }),
        (None, None, Some(curve)) => {
            let curve = given(curve, "curve")?;
            run(py, |watch| {
                let along = CutAlong::Curve(&curve.cut_curve(watch)?, keep);
                stitching::cut(&Cut { remaking, along }, watch, &Staging::default())
            })
        }
        (Some(delete), None, None) => {
            let delete = given(delete, "delete")?;
            run(py, |watch| {
                let selector = delete.selector(watch)?;
                let along = CutAlong::Selector(&selector, delete.place());
                stitching::cut(&Cut { remaking, along }, watch, &Staging::default())
            })
        }
        _ => Err(refused("give one of delete, plane and curve")),
    }
}

/// The number of a vertex of a file.
fn vertex(number: i64, place: &str) -> PyResult<u32> {
    u32::try_from(number).map_err(|_| refused(format!("{place} is {number}: give the number of a vertex, from 0")))
}

/// The file to read and the files to write. A file can't be replaced, because only the program keeps the original.
fn remaking<'a>(
    file: &'a Path,
    output: &'a Path,
    report: Option<&'a Path>,
    weld: Option<f64>,
) -> PyResult<Remaking<'a>> {
    let weld = weld_options(weld)?;
    if is_same(file, output) {
        return Err(refused(format!(
            "output {} is the file that is read: give another name",
            shown(output)
        )));
    }
    Ok(Remaking {
        file,
        output,
        report: report.map_or(ReportTo::Caller, ReportTo::File),
        replace: Replace::Never,
        weld,
    })
}

/// Makes a new shape, puts it in its place, and returns the report as a dict.
fn run<'py>(
    py: Python<'py>,
    stitch: impl Fn(&Watch) -> Result<Stitched, EngineError> + Sync,
) -> PyResult<Bound<'py, PyAny>> {
    reported(py, |watch| {
        let mut stitched = stitch(watch)?;
        let report = stitched.report.take().unwrap_or_default().to_string();
        let warnings = stitched.warnings.clone();
        stitched.commit(None)?;
        Ok((report, warnings))
    })
}
