//! A line on the terminal with the present stage and its progress.

use std::io::{self, Write};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Duration;

use pliant_engine::watch::Watch;

/// Erases the terminal's line.
const ERASE: &str = "\r\x1b[K";

/// A line that is being shown; dropping it erases it.
pub(super) struct ProgressLine {
    done: Arc<AtomicBool>,
    /// Held while something is printed.
    shown: Arc<Mutex<bool>>,
}

/// Shows the stage and progress of `watch` ten times a second, after a quarter of a second: shorter work needs no line.
pub(super) fn show(watch: Watch) -> ProgressLine {
    let (done, shown) = (Arc::new(AtomicBool::new(false)), Arc::new(Mutex::new(false)));
    let line = ProgressLine {
        done: done.clone(),
        shown: shown.clone(),
    };
    std::thread::spawn(move || {
        std::thread::sleep(Duration::from_millis(250));
        loop {
            let mut shown = shown.lock().unwrap_or_else(PoisonError::into_inner);
            if done.load(Ordering::Relaxed) {
                return;
            }
            if let Some((doing, fraction)) = watch.now() {
                let percent = (fraction * 100.0) as u32;
                let _ = write!(io::stderr(), "{ERASE}{doing} {percent}%");
                *shown = true;
            }
            drop(shown);
            std::thread::sleep(Duration::from_millis(100));
        }
    });
    line
}

impl Drop for ProgressLine {
    fn drop(&mut self) {
        self.done.store(true, Ordering::Relaxed);
        let mut shown = self.shown.lock().unwrap_or_else(PoisonError::into_inner);
        if std::mem::take(&mut *shown) {
            let _ = write!(io::stderr(), "{ERASE}");
        }
    }
}

/// Standard error that erases the progress line before anything is written.
pub(super) struct ErasingWriter {
    line: Option<ProgressLine>,
}

impl ErasingWriter {
    pub(super) fn new(line: Option<ProgressLine>) -> Self {
        Self { line }
    }
}

impl Write for ErasingWriter {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.line = None;
        io::stderr().write(bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        io::stderr().flush()
    }
}
