//! A panic on the window's thread leaves a report and a recovery file, from which a person can go on.
//!
//! A panic on another thread is caught there and reported ([`super::workers`]); the window goes on.

use std::backtrace::Backtrace;
use std::fs;
use std::panic::{PanicHookInfo, set_hook, take_hook};
use std::path::{Path, PathBuf};
use std::time::SystemTime;

use super::files::recovery;
use crate::version::VERSION;

/// From now on a panic on this thread saves the newest work and writes a report into `folder`.
pub fn listen(folder: PathBuf) {
    let before = take_hook();
    let window = std::thread::current().id();
    set_hook(Box::new(move |info| {
        before(info);
        if std::thread::current().id() == window {
            let kept = recovery::write_latest();
            // Nobody is left to report to.
            let _ = report(info, kept.as_deref(), &folder);
        }
    }));
}

fn report(info: &PanicHookInfo<'_>, kept: Option<&Path>, folder: &Path) -> std::io::Result<()> {
    fs::create_dir_all(folder)?;
    let seconds = SystemTime::now()
        .duration_since(SystemTime::UNIX_EPOCH)
        .map_or(0, |since| since.as_secs());
    let kept = kept.map_or("there was none".to_owned(), pliant_engine::files::shown);
    let text = format!(
        "Pliant {VERSION} on {} stopped because of an internal error.\n\n{info}\n\nUnsaved work: {kept}\n\n{}\n",
        std::env::consts::OS,
        Backtrace::force_capture()
    );
    fs::write(folder.join(format!("fault-{seconds}.txt")), text)
}
