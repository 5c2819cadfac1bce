//! `pliant compare`: one edit by several methods, in one picture and as data.

use std::path::Path;

use pliant_deform::METHODS;
use pliant_io::quoted;
use pliant_picture::{Asked, Compared, Comparison, check_png, with_edit};

use super::method_argument::method_argument;
use super::picture_arguments::CompareArguments;
use crate::cli::console::{Console, print, warn};
use crate::cli::threads::on_threads;
use pliant_engine::files::Destination;
use pliant_engine::watch::Watch;
use pliant_engine::{EngineError, files, read_edit};

pub(super) fn run(arguments: &CompareArguments, console: &mut Console<'_>) -> Result<(), EngineError> {
    check_png(&arguments.output)?;
    let methods = asked("--methods", &arguments.methods)?;
    let given = [("FILE", &*arguments.file), ("--edit", &*arguments.edit)];
    files::refuse_shared(("--output", &arguments.output), given)?;
    Destination::of(&arguments.output)?;
    if let Some(report) = &arguments.report {
        let others = given.into_iter().chain([("--output", &*arguments.output)]);
        files::refuse_shared(("--report", report), others)?;
        Destination::of(report)?;
    }
    let watch = &console.watch;
    let Compared {
        sheet,
        report,
        table,
        warnings,
    } = on_threads(arguments.compute, || compare(arguments, &methods, watch))??;
    if watch.cancel.is_cancelled() {
        return Err(EngineError::Interrupted);
    }
    let mut files = vec![(arguments.output.clone(), sheet.as_slice())];
    if let Some(path) = &arguments.report {
        files.push((path.clone(), report.as_bytes()));
    }
    console.staging.stage(files)?.commit()?;
    warn(console.err, &warnings);
    print(console.out, &table)
}

/// The methods that `names`, the value of `option`, requests, each once.
pub(super) fn asked(option: &str, names: &[String]) -> Result<Vec<Asked>, EngineError> {
    let all = METHODS.iter().map(|declaration| declaration.name.to_owned());
    let names = if *names == ["all"] {
        all.collect()
    } else {
        names.to_vec()
    };
    for (number, name) in names.iter().enumerate() {
        if names[..number].contains(name) {
            return Err(EngineError::Arguments(format!(
                "{option} names {} twice: name it once",
                quoted(name)
            )));
        }
    }
    let asked = |name: String| {
        let method = method_argument(option, &name)?;
        Ok(Asked { name, method })
    };
    names.into_iter().map(asked).collect()
}

fn compare(arguments: &CompareArguments, methods: &[Asked], watch: &Watch) -> Result<Compared, EngineError> {
    let edit = read_edit(&arguments.edit, watch)?;
    let given = Some((&edit, &*arguments.edit));
    let (loaded, _) = with_edit(&arguments.file, given, arguments.weld.weld, watch)?;
    let report = arguments.report.as_deref().map(|report| ("--report", report));
    let outputs: Vec<(&str, &Path)> = [("--output", &*arguments.output)].into_iter().chain(report).collect();
    watch.refuse_outputs(&outputs, None)?;
    let job = Comparison {
        loaded: &loaded,
        edit: &edit,
        edit_place: &arguments.edit,
        methods,
        frames: arguments.frames,
        size: arguments.size,
        look: arguments.look.options(),
    };
    pliant_picture::compare(&job, watch)
}
