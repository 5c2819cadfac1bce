//! Ctrl-C, SIGTERM and SIGHUP: a command stops within a second and leaves no file behind.

use std::io::Write;
use std::time::Duration;

use pliant_engine::EngineError;
use pliant_engine::files::Staging;
use pliant_engine::watch::Watch;

/// The time that a command has to stop by itself.
const PATIENCE: Duration = Duration::from_millis(500);

/// Raises the flag on Ctrl-C (SIGINT), SIGTERM and SIGHUP. If a command has not ended a little later, this ends it
/// without its files; it also ends the window, with its saves.
pub(super) fn listen(watch: &Watch, staging: &Staging) {
    #[cfg(unix)]
    {
        // With this a write beyond the limit on file sizes returns an error that can be reported, and does not end the
        // program. The flag itself is not read.
        let has_come = std::sync::Arc::default();
        let _ = signal_hook::flag::register(signal_hook::consts::SIGXFSZ, has_come);
    }
    let (cancel, staging) = (watch.cancel.clone(), staging.clone());
    // Without a handler Ctrl-C still ends the program; only a temporary file may remain then.
    let _ = ctrlc::set_handler(move || {
        cancel.cancel();
        std::thread::sleep(PATIENCE);
        // Held until the process has ended, so that nothing is renamed meanwhile.
        if let Some(_guard) = staging.discard() {
            // Each of the window's saves has its own staging.
            staging.discard_others();
            let interrupted = EngineError::Interrupted;
            let _ = writeln!(std::io::stderr(), "\r\x1b[Kpliant: {interrupted}");
            std::process::exit(i32::from(interrupted.status()));
        }
    });
}
