//! Files bent by an edit, like `pliant apply`, `pliant animate` and `pliant sequence`.

use std::ops::RangeInclusive;
use std::path::{Path, PathBuf};

use pliant_deform::{Budget, Method};
use pliant_editor::Beginning;
use pliant_engine::files::{Staging, refuse_shared};
use pliant_engine::watch::Watch;
use pliant_engine::{Animate, Apply, EditJob, EngineError, ExistingFrames, Given, MorphDeltas, MorphTarget, Sequence};
use pyo3::prelude::*;
use pyo3::types::PyBool;

use crate::given::{budget, given, method};
use crate::refusal::refused;
use crate::reported::reported;
use crate::values::weld_options;

#[doc = include_str!(concat!(env!("OUT_DIR"), "/apply.txt"))]
#[pyfunction]
#[pyo3(signature = (file, *, edit, output, report=None, frames=None, as_morph=None, morph_weight=1.0, morph_deltas=None, method=None, memory=None, weld=None))]
#[expect(clippy::too_many_arguments, reason = "they are the command's arguments, by name")]
pub fn apply<'py>(
    py: Python<'py>,
    file: PathBuf,
    edit: &Bound<'py, PyAny>,
    output: PathBuf,
    report: Option<PathBuf>,
    frames: Option<i64>,
    as_morph: Option<&Bound<'py, PyAny>>,
    morph_weight: f64,
    morph_deltas: Option<&str>,
    method: Option<&Bound<'py, PyAny>>,
    memory: Option<&Bound<'py, PyAny>>,
    weld: Option<f64>,
) -> PyResult<Bound<'py, PyAny>> {
    let bending = Bending::of(edit, method, memory, weld)?;
    let frames = frames.map(|frames| match usize::try_from(frames) {
        Ok(count @ 1..=100_000) => Ok(count),
        _ => Err(refused(format!("frames is {frames}: give a number from 1 to 100000"))),
    });
    let frames = frames.transpose()?;
    if !(0.0..=1.0).contains(&morph_weight) {
        return Err(refused(format!(
            "morph_weight is {morph_weight}: give a number from 0 to 1"
        )));
    }
    let deltas = match morph_deltas {
        None => MorphDeltas::WhereFarOff,
        Some("turn") => MorphDeltas::Turn,
        Some("stay") => MorphDeltas::Stay,
        Some(_) => return Err(refused("morph_deltas takes \"turn\" or \"stay\"")),
    };
    let morph = morph_name(as_morph, &bending.edit)?;
    bending.run(py, |watch, edit| {
        bending.refuse_shared(&output, report.as_deref(), Some(&file))?;
        let job = Apply {
            job: EditJob {
                file: &file,
                edit,
                edit_path: bending.edit.place(),
                output: &output,
                report: report.as_deref(),
                weld,
                budget: bending.budget,
            },
            frames,
            deltas,
            morph: morph.as_deref().map(|name| MorphTarget {
                name,
                weight: morph_weight,
            }),
        };
        let told = pliant_engine::apply(&job, watch, &Staging::default())?;
        Ok((told.to_json(), told.warnings))
    })
}

/// The name of the new morph target, if one is wanted.
fn morph_name(as_morph: Option<&Bound<'_, PyAny>>, edit: &Given) -> PyResult<Option<String>> {
    let Some(given) = as_morph else {
        return Ok(None);
    };
    if let Ok(wanted) = given.cast::<PyBool>() {
        return Ok(wanted.is_true().then(|| edit.own_name()));
    }
    let name: String = given
        .extract()
        .map_err(|_| refused("as_morph takes a name, or True for the name of the edit's file"))?;
    Ok(Some(name))
}

#[doc = include_str!(concat!(env!("OUT_DIR"), "/animate.txt"))]
#[pyfunction]
#[pyo3(signature = (file, *, edit, output, report=None, tolerance=0.00001, fps=24.0, replace=false, method=None, memory=None, weld=None))]
#[expect(clippy::too_many_arguments, reason = "they are the command's arguments, by name")]
pub fn animate<'py>(
    py: Python<'py>,
    file: PathBuf,
    edit: &Bound<'py, PyAny>,
    output: PathBuf,
    report: Option<PathBuf>,
    tolerance: f64,
    fps: f64,
    replace: bool,
    method: Option<&Bound<'py, PyAny>>,
    memory: Option<&Bound<'py, PyAny>>,
    weld: Option<f64>,
) -> PyResult<Bound<'py, PyAny>> {
    check_range("tolerance", tolerance, 1e-7..=0.1)?;
    check_range("fps", fps, FRAME_RATES)?;
    let bending = Bending::of(edit, method, memory, weld)?;
    let name = bending.edit.own_name();
    bending.run(py, |watch, edit| {
        bending.refuse_shared(&output, report.as_deref(), Some(&file))?;
        let job = Animate {
            job: EditJob {
                file: &file,
                edit,
                edit_path: bending.edit.place(),
                output: &output,
                report: report.as_deref(),
                weld,
                budget: bending.budget,
            },
            name: &name,
            tolerance,
            fps,
            frames: ExistingFrames::replaced(replace),
        };
        let told = pliant_engine::animate(&job, watch, &Staging::default())?;
        Ok((told.to_json(), told.warnings))
    })
}

#[doc = include_str!(concat!(env!("OUT_DIR"), "/sequence.txt"))]
#[pyfunction]
#[pyo3(signature = (
    frames, *, edit, output, mesh=None, report=None, fps=None, replace=false, method=None, memory=None, weld=None
))]
#[expect(clippy::too_many_arguments, reason = "they are the command's arguments, by name")]
pub fn sequence<'py>(
    py: Python<'py>,
    frames: PathBuf,
    edit: &Bound<'py, PyAny>,
    output: PathBuf,
    mesh: Option<PathBuf>,
    report: Option<PathBuf>,
    fps: Option<f64>,
    replace: bool,
    method: Option<&Bound<'py, PyAny>>,
    memory: Option<&Bound<'py, PyAny>>,
    weld: Option<f64>,
) -> PyResult<Bound<'py, PyAny>> {
    if let Some(fps) = fps {
        check_range("fps", fps, FRAME_RATES)?;
    }
    let bending = Bending::of(edit, method, memory, weld)?;
    let name = bending.edit.own_name();
    bending.run(py, |watch, edit| {
        bending.refuse_shared(&output, report.as_deref(), None)?;
        let job = Sequence {
            mesh: mesh.as_deref(),
            fps,
            name: &name,
            frames: ExistingFrames::replaced(replace),
            job: EditJob {
                file: &frames,
                edit,
                edit_path: bending.edit.place(),
                output: &output,
                report: report.as_deref(),
                weld,
                budget: bending.budget,
            },
        };
        let told = pliant_engine::sequence(&job, watch, &Staging::default())?;
        Ok((told.to_json(), told.warnings))
    })
}

/// The frames a second that an animation may have.
const FRAME_RATES: RangeInclusive<f64> = 0.001..=1000.0;

fn check_range(name: &str, value: f64, range: RangeInclusive<f64>) -> PyResult<()> {
    if range.contains(&value) {
        return Ok(());
    }
    let (least, most) = range.into_inner();
    Err(refused(format!(
        "{name} is {value}: give a number from {least} to {most}"
    )))
}

/// The arguments that all commands share which bend.
struct Bending {
    edit: Given,
    method: Option<Method>,
    budget: Budget,
}

impl Bending {
    fn of(
        edit: &Bound<'_, PyAny>,
        replaced: Option<&Bound<'_, PyAny>>,
        memory: Option<&Bound<'_, PyAny>>,
        weld: Option<f64>,
    ) -> PyResult<Self> {
        weld_options(weld)?;
        Ok(Self {
            edit: given(edit, "edit")?,
            method: replaced.map(method).transpose()?,
            budget: budget(memory)?,
        })
    }

    /// Refuses outputs that are inputs: a file may be replaced only by its own new shape.
    fn refuse_shared(&self, output: &Path, report: Option<&Path>, file: Option<&Path>) -> Result<(), EngineError> {
        refuse_shared(("--output", output), self.edit.source())?;
        let Some(report) = report else {
            return Ok(());
        };
        let file = file.map(|file| ("FILE", file));
        let others = file.into_iter().chain(self.edit.source());
        refuse_shared(("--report", report), others.chain([("--output", output)]))
    }

    /// Runs a command, which gives the report's text and the warnings, and returns the report as a dict.
    fn run<'py>(
        &self,
        py: Python<'py>,
        command: impl Fn(&Watch, &Beginning) -> Result<(String, Vec<String>), EngineError> + Sync,
    ) -> PyResult<Bound<'py, PyAny>> {
        reported(py, |watch| {
            let mut edit = self.edit.edit(watch)?;
            if let Some(method) = &self.method {
                edit.set_method(method.clone());
            }
            command(watch, &edit)
        })
    }
}
