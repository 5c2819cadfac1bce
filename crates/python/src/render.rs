//! Pictures of files, like `pliant render`.

use std::path::{Path, PathBuf};

use numpy::{PyArray1, PyArrayMethods};
use pliant_editor::Clay;
use pliant_engine::EngineError;
use pliant_engine::files::Staging;
use pliant_engine::watch::Watch;
use pliant_picture::{
    Choice, LookOptions, OfFile, PictureSize, ProjectionName, Shading, StillOptions, Up, View, draw_file, named,
    outputs, picture_file,
};
use pyo3::prelude::*;

use crate::given::given;
use crate::interruptible::interruptible;
use crate::refusal::{of_engine, refused};
use crate::values::weld_options;
use crate::warned::warn;

#[doc = include_str!(concat!(env!("OUT_DIR"), "/render.txt"))]
#[pyfunction]
#[pyo3(signature = (file, *, output=None, edit=None, size=None, up="guess", view="three-quarter", shading="clay", clay="clay", projection="perspective", flat=false, wireframe=false, borders=false, outlines=false, grid=false, shadow=false, transparent=false, turntable=None, weld=None))]
#[expect(clippy::too_many_arguments, reason = "they are the command's arguments, by name")]
pub fn render<'py>(
    py: Python<'py>,
    file: PathBuf,
    output: Option<PathBuf>,
    edit: Option<&Bound<'py, PyAny>>,
    size: Option<&Bound<'py, PyAny>>,
    up: &str,
    view: &str,
    shading: &str,
    clay: &str,
    projection: &str,
    flat: bool,
    wireframe: bool,
    borders: bool,
    outlines: bool,
    grid: bool,
    shadow: bool,
    transparent: bool,
    turntable: Option<i64>,
    weld: Option<f64>,
) -> PyResult<Option<Bound<'py, PyAny>>> {
    weld_options(weld)?;
    let clays = Clay::NAMES.map(|(name, value)| Choice { name, value, help: "" });
    let options = StillOptions {
        size: picture_size(size)?,
        look: LookOptions {
            up: chosen("up", Up::CHOICES, up)?,
            view: chosen("view", View::CHOICES, view)?,
            shading: chosen("shading", Shading::CHOICES, shading)?,
        },
        clay: chosen("clay", &clays, clay)?,
        projection: chosen("projection", ProjectionName::CHOICES, projection)?,
        flat,
        wireframe,
        borders,
        outlines,
        grid,
        shadow,
        transparent,
        turntable: turntable.map(pictures_around).transpose()?,
    };
    let source = edit.map(|edit| given(edit, "edit")).transpose()?;
    let mut sources = vec![("FILE", &*file)];
    sources.extend(source.as_ref().and_then(|source| source.source()));
    let paths = output.map(|output| outputs(&output, options.turntable, &sources));
    let paths = paths.transpose().map_err(|error| of_engine(&error))?;
    let run = |watch: &Watch| -> Result<(Pictures, Vec<String>), EngineError> {
        let edit = source.as_ref().map(|source| source.edit(watch)).transpose()?;
        let place = source.as_ref().map(|source| source.place());
        let job = OfFile {
            file: &file,
            edit: edit.as_ref().zip(place),
            weld,
            options: &options,
        };
        pictures(&job, paths.as_deref(), watch)
    };
    let done = interruptible(py, |pool, cancel| pool.install(|| run(&Watch::cancelled_by(cancel))))?;
    let (pictures, notes) = done.map_err(|error| of_engine(&error))?;
    warn(py, &notes)?;
    pictures.map(|pixels| of_pixels(py, pixels, &options)).transpose()
}

/// The pixels of all pictures in turn; `None` if they were written to files.
type Pictures = Option<Vec<u8>>;

/// Draws the pictures, and writes them to `paths` if there are any. Gives sentences about what they don't show, too.
fn pictures(
    job: &OfFile<'_>,
    paths: Option<&[PathBuf]>,
    watch: &Watch,
) -> Result<(Pictures, Vec<String>), EngineError> {
    let Some(paths) = paths else {
        let mut pixels = Vec::new();
        let notes = draw_file(job, &[], watch, |picture| {
            pixels.append(&mut picture_file::straight(picture).rgba);
            Ok(())
        })?;
        return Ok((Some(pixels), notes));
    };
    let mut pngs = Vec::new();
    let notes = draw_file(job, paths, watch, |picture| {
        pngs.push(picture_file::png(picture)?);
        Ok(())
    })?;
    let files = paths.iter().map(|path| Path::to_owned(path));
    let files = files.zip(pngs.iter().map(Vec::as_slice));
    Staging::default().stage(files)?.commit()?;
    Ok((None, notes))
}

/// The pixels as an array of the shape (height, width, 4), or (n, height, width, 4) for a turntable.
fn of_pixels<'py>(py: Python<'py>, pixels: Vec<u8>, options: &StillOptions) -> PyResult<Bound<'py, PyAny>> {
    let PictureSize { width, height } = options.size;
    let [width, height] = [width, height].map(|side| side as usize);
    let flat = PyArray1::from_vec(py, pixels);
    Ok(match options.turntable {
        None => flat.reshape([height, width, 4])?.into_any(),
        Some(count) => flat.reshape([count as usize, height, width, 4])?.into_any(),
    })
}

/// The choice with this name.
fn chosen<T: Copy>(argument: &str, choices: &[Choice<T>], name: &str) -> PyResult<T> {
    named(choices, name).map_err(|why| refused(format!("{argument} is {name:?}: {why}")))
}

/// A size as a text such as `1280x800`, or as a pair of a width and a height.
fn picture_size(size: Option<&Bound<'_, PyAny>>) -> PyResult<PictureSize> {
    let Some(any) = size else {
        return Ok(StillOptions::default().size);
    };
    let text = match any.extract::<(i64, i64)>() {
        Ok((width, height)) => format!("{width}x{height}"),
        Err(_) => any.extract().unwrap_or_default(),
    };
    text.parse().map_err(|_| {
        refused(format!(
            "size is {any}: give \"1280x800\" or (1280, 800), each side from 1 to 16384"
        ))
    })
}

/// The number of pictures of a turntable.
fn pictures_around(count: i64) -> PyResult<u32> {
    match u32::try_from(count) {
        Ok(count @ 2..=9999) => Ok(count),
        _ => Err(refused(format!("turntable is {count}: give a number from 2 to 9999"))),
    }
}
