//! A virtual display: Xvfb with a window manager, terminated when dropped.

use std::io::{BufRead, BufReader};
use std::process::{Child, Command, Stdio};

use crate::process;

/// A virtual display.
pub struct Display {
    name: String,
    children: Vec<Child>,
}

impl Display {
    /// Starts Xvfb on a free display number.
    ///
    /// # Errors
    /// One sentence if Xvfb can't be started.
    pub fn start() -> Result<Self, String> {
        let failed = |why: &str| format!("Xvfb can't open a display ({why}); install the package xvfb.");
        let program = process::program("Xvfb").ok_or_else(|| failed("not found"))?;
        let mut server = Command::new(program)
            .args(["-displayfd", "1", "-screen", "0", "1600x1000x24", "-nolisten", "tcp"])
            .stdin(Stdio::null())
            .stdout(Stdio::piped())
            .stderr(Stdio::null())
            .spawn()
            .map_err(|e| failed(&e.to_string()))?;
        let mut number = String::new();
        let answered = server
            .stdout
            .take()
            .map(|pipe| BufReader::new(pipe).read_line(&mut number));
        let mut display = Self {
            name: format!(":{}", number.trim()),
            children: vec![server],
        };
        if !matches!(answered, Some(Ok(1..))) {
            return Err(failed("it ended at once"));
        }
        if let Some(manager) = process::program("openbox") {
            let manager = Command::new(manager)
                .env("DISPLAY", &display.name)
                .stdin(Stdio::null())
                .stdout(Stdio::null())
                .stderr(Stdio::null())
                .spawn();
            display.children.extend(manager);
        }
        Ok(display)
    }

    /// The value for `DISPLAY`.
    pub fn name(&self) -> &str {
        &self.name
    }
}

impl Drop for Display {
    fn drop(&mut self) {
        for child in self.children.iter_mut().rev() {
            // The process may have exited already.
            let _ = child.kill();
            let _ = child.wait();
        }
    }
}
