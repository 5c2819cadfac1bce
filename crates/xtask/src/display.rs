//! A virtual display: Xvfb with a window manager, terminated when dropped.

use std::ffi::OsStr;
use std::fs::File;
use std::io::{BufRead, BufReader, Read, Seek, SeekFrom};
use std::path::Path;
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
        Self::with(&[])
    }

    /// The same with its pixels in a file of `folder`, which [`Screen`] reads.
    ///
    /// # Errors
    /// One sentence if Xvfb can't be started or the folder can't be made.
    pub fn with_framebuffer(folder: &Path) -> Result<Self, String> {
        std::fs::create_dir_all(folder).map_err(|e| format!("{} can't be made: {e}.", folder.display()))?;
        Self::with(&[OsStr::new("-fbdir"), folder.as_os_str()])
    }

    fn with(more: &[&OsStr]) -> Result<Self, String> {
        let failed = |why: &str| format!("Xvfb can't open a display ({why}); install the package xvfb.");
        let program = process::program("Xvfb").ok_or_else(|| failed("not found"))?;
        let mut server = Command::new(program)
            .args(["-displayfd", "1", "-screen", "0", "1600x1000x24", "-nolisten", "tcp"])
            .args(more)
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

/// The picture of a virtual display.
pub struct Screen {
    file: File,
    /// The start of the pixels in the file, and the bytes of a row.
    start: u64,
    row: u64,
    size_px: [u64; 2],
}

/// The side of the examined square in the middle.
const MIDDLE_PX: u64 = 160;

impl Screen {
    /// The screen of a display that was started with this folder ([`Display::with_framebuffer`]).
    ///
    /// # Errors
    /// One sentence if it can't be read.
    pub fn open(folder: &Path) -> Result<Self, String> {
        let path = folder.join("Xvfb_screen0");
        let cannot = |e: std::io::Error| format!("{} can't be read: {e}.", path.display());
        let mut file = File::open(&path).map_err(cannot)?;
        // The file is an X window dump: a header of 25 numbers, its name, the colour table of 12 bytes each, the
        // pixels.
        let mut header = [0_u8; 100];
        file.read_exact(&mut header).map_err(cannot)?;
        let number = |index: usize| {
            let bytes = [0, 1, 2, 3].map(|byte| header[4 * index + byte]);
            u64::from(u32::from_be_bytes(bytes))
        };
        Ok(Self {
            start: number(0) + 12 * number(19),
            row: number(12),
            size_px: [number(4), number(5)],
            file,
        })
    }

    /// The pixels in the middle of the screen, four bytes each.
    ///
    /// # Errors
    /// One sentence if they can't be read.
    pub fn middle(&self) -> Result<Vec<u8>, String> {
        let mut pixels = vec![0; (4 * MIDDLE_PX * MIDDLE_PX) as usize];
        let [left, top] = self.size_px.map(|size| (size.max(MIDDLE_PX) - MIDDLE_PX) / 2);
        let mut file = &self.file;
        for (row, bytes) in (top..).zip(pixels.chunks_mut(4 * MIDDLE_PX as usize)) {
            let at = SeekFrom::Start(self.start + row * self.row + 4 * left);
            let read = file.seek(at).and_then(|_| file.read_exact(bytes));
            read.map_err(|e| format!("The virtual display's pixels can't be read: {e}."))?;
        }
        Ok(pixels)
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
