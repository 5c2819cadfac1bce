//! `pliant fill`, `pliant bridge`, `pliant cut` and `pliant merge`: new shapes.

use std::path::Path;

use pliant_engine::EngineError;
use pliant_engine::files;
use pliant_engine::stitching::{self, Cut, CutAlong, Fill, Holes, Merge, Remaking, Stitched};
use pliant_io::Format;

use super::replaced::keep_replaced;
use super::stitch_arguments::{BridgeArguments, CutArguments, FillArguments, MergeArguments, NewShapeArguments};
use crate::cli::console::{Console, print, warn};
use crate::cli::threads::on_threads;

pub(super) fn fill(arguments: &FillArguments, console: &mut Console<'_>) -> Result<(), EngineError> {
    let remaking = remaking(&arguments.file, &arguments.output)?;
    let holes = match (arguments.largest, arguments.at) {
        (_, Some(vertex)) => Holes::At(vertex),
        (Some(count), None) => Holes::Largest(count),
        (None, None) => Holes::Every,
    };
    filled(&Fill { remaking, holes }, &arguments.output, console)
}

pub(super) fn bridge(arguments: &BridgeArguments, console: &mut Console<'_>) -> Result<(), EngineError> {
    let remaking = remaking(&arguments.file, &arguments.output)?;
    let [first, second] = arguments.borders[..] else {
        return Err(EngineError::Arguments("--borders takes two vertices".to_owned()));
    };
    let holes = Holes::Between([first, second]);
    filled(&Fill { remaking, holes }, &arguments.output, console)
}

fn filled(job: &Fill<'_>, to: &NewShapeArguments, console: &mut Console<'_>) -> Result<(), EngineError> {
    let (watch, staging) = (&console.watch, &console.staging);
    let stitched = on_threads(to.compute, || stitching::fill(job, watch, staging))??;
    conclude(stitched, to, console)
}

pub(super) fn cut(arguments: &CutArguments, console: &mut Console<'_>) -> Result<(), EngineError> {
    let watch = &console.watch;
    let delete = arguments.delete.as_deref();
    let selector = delete.map(|path| stitching::read_selector(path, watch)).transpose()?;
    let curve = arguments.curve.as_deref();
    let curve = curve.map(|path| stitching::read_cut_curve(path, watch)).transpose()?;
    let job = Cut {
        remaking: remaking(&arguments.file, &arguments.output)?,
        along: match (&arguments.plane, &curve, selector.as_ref().zip(delete)) {
            (Some(plane), _, _) => CutAlong::Plane(plane.0, arguments.keep.into()),
            (None, Some(curve), _) => CutAlong::Curve(curve, arguments.keep.into()),
            (None, None, Some((selector, path))) => CutAlong::Selector(selector, path),
            (None, None, None) => return Err(EngineError::Arguments("give --delete, --plane or --curve".to_owned())),
        },
    };
    let (watch, staging) = (&console.watch, &console.staging);
    let stitched = on_threads(arguments.output.compute, || stitching::cut(&job, watch, staging))??;
    conclude(stitched, &arguments.output, console)
}

pub(super) fn merge(arguments: &MergeArguments, console: &mut Console<'_>) -> Result<(), EngineError> {
    let job = Merge {
        remaking: remaking(&arguments.first, &arguments.output)?,
        second: &arguments.second,
        joins: &stitching::read_joins(&arguments.joins, &console.watch)?,
        joins_path: &arguments.joins,
    };
    let (watch, staging) = (&console.watch, &console.staging);
    let stitched = on_threads(arguments.output.compute, || stitching::merge(&job, watch, staging))??;
    conclude(stitched, &arguments.output, console)
}

/// The file to read and the files to write. Refuses an OUT of no known format as a wrong argument.
fn remaking<'a>(file: &'a Path, to: &'a NewShapeArguments) -> Result<Remaking<'a>, EngineError> {
    let format = Format::of_name(&to.output.to_string_lossy());
    format.map_err(|error| EngineError::Arguments(format!("--output: {error}")))?;
    Ok(Remaking {
        file,
        output: &to.output,
        report: to.report.as_deref().into(),
        replace: to.replace(),
        weld: to.weld.options(),
    })
}

/// Keeps the original of a file that is replaced, commits, and says what was done.
fn conclude(stitched: Stitched, to: &NewShapeArguments, console: &mut Console<'_>) -> Result<(), EngineError> {
    let (cancel, staging) = (&console.watch.cancel, &console.staging);
    let replaced = stitched
        .loaded
        .iter()
        .find(|loaded| files::is_same(&loaded.path, &to.output));
    let kept = replaced.map(|loaded| keep_replaced(loaded, &to.output, staging, cancel));
    let (kept, first) = kept.transpose()?.unwrap_or_default();
    let (done, warnings) = (stitched.done.clone(), stitched.warnings.clone());
    stitched.commit(first)?;
    warn(console.err, &warnings);
    let kept = kept.map(|place| format!("; the original is kept as {}", files::shown(&place)));
    print(console.out, &format!("{done}{}\n", kept.unwrap_or_default()))
}
