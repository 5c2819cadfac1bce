//! The desktop's own programs: the file manager, which shows a file in its folder, and the browser.

use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::sync::Arc;

use pliant_engine::files::{folder_of, shown};

/// A thing for another program to show.
#[derive(Clone, PartialEq, Eq, Debug)]
pub enum Elsewhere {
    /// This file, in its folder.
    File(PathBuf),
    /// The page at this address.
    Page(String),
}

/// Shows a thing; its error is a sentence.
type Show = dyn Fn(&Elsewhere) -> Result<(), String> + Send + Sync;

/// The way to have something shown elsewhere. A test replaces it, so that it opens nothing on its person's desktop.
#[derive(Clone)]
pub struct Desktop(Arc<Show>);

impl Default for Desktop {
    /// The system's.
    fn default() -> Self {
        Self::new(show)
    }
}

impl Desktop {
    /// One that shows things by `show`, whose error is a sentence.
    pub fn new(show: impl Fn(&Elsewhere) -> Result<(), String> + Send + Sync + 'static) -> Self {
        Self(Arc::new(show))
    }

    /// Has something shown; it may take a while until the other program answers.
    ///
    /// # Errors
    /// If nothing shows it, in a sentence.
    pub fn show(&self, elsewhere: &Elsewhere) -> Result<(), String> {
        (self.0)(elsewhere)
    }
}

fn show(elsewhere: &Elsewhere) -> Result<(), String> {
    match elsewhere {
        Elsewhere::File(file) if !file.exists() => Err(format!(
            "{} no longer exists: save it again, or look for it under another name",
            shown(file)
        )),
        Elsewhere::File(file) => show_file(file).map_err(|reason| {
            format!(
                "no file manager shows {} ({reason}): open {} yourself",
                shown(file),
                shown(folder_of(file))
            )
        }),
        Elsewhere::Page(address) => {
            open(address.as_ref()).map_err(|reason| format!("no browser opens {address} ({reason}): open it yourself"))
        }
    }
}

/// Asks the file manager on the session's bus to select the file, or else opens its folder.
#[cfg(all(unix, not(target_os = "macos")))]
fn show_file(file: &Path) -> Result<(), String> {
    match pollster::block_on(select(file)) {
        Ok(()) => Ok(()),
        Err(_) => open(folder_of(file).as_os_str()),
    }
}

#[cfg(all(unix, not(target_os = "macos")))]
async fn select(file: &Path) -> zbus::Result<()> {
    const MANAGER: &str = "org.freedesktop.FileManager1";
    let connection = zbus::Connection::session().await?;
    let files = vec![address_of(file)];
    connection
        .call_method(
            Some(MANAGER),
            "/org/freedesktop/FileManager1",
            Some(MANAGER),
            "ShowItems",
            &(files, ""),
        )
        .await?;
    Ok(())
}

/// The address of a file. Only bytes that are safe in every address stay as they are.
#[cfg(all(unix, not(target_os = "macos")))]
fn address_of(file: &Path) -> String {
    use std::fmt::Write;
    use std::os::unix::ffi::OsStrExt;

    let mut address = "file://".to_owned();
    for &byte in file.as_os_str().as_bytes() {
        if byte.is_ascii_alphanumeric() || b"/-._~".contains(&byte) {
            address.push(char::from(byte));
        } else {
            // Writing to a string can't fail.
            let _ = write!(address, "%{byte:02X}");
        }
    }
    address
}

#[cfg(target_os = "macos")]
fn show_file(file: &Path) -> Result<(), String> {
    finish(Command::new("open").arg("-R").arg(file))
}

#[cfg(windows)]
fn show_file(file: &Path) -> Result<(), String> {
    let mut selected = std::ffi::OsString::from("/select,");
    selected.push(file);
    start(Command::new("explorer").arg(selected))
}

#[cfg(all(unix, not(target_os = "macos")))]
fn open(address: &std::ffi::OsStr) -> Result<(), String> {
    finish(Command::new("xdg-open").arg(address))
}

#[cfg(target_os = "macos")]
fn open(address: &std::ffi::OsStr) -> Result<(), String> {
    finish(Command::new("open").arg(address))
}

/// The explorer's exit status says nothing.
#[cfg(windows)]
fn open(address: &std::ffi::OsStr) -> Result<(), String> {
    start(Command::new("explorer").arg(address))
}

#[cfg(windows)]
fn start(command: &mut Command) -> Result<(), String> {
    command.spawn().map(drop).map_err(|error| error.to_string())
}

/// Waits for a program that ends as soon as it has handed its request on.
#[cfg(unix)]
fn finish(command: &mut Command) -> Result<(), String> {
    let name = command.get_program().to_string_lossy().into_owned();
    let silent = command.stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::null());
    match silent.status() {
        Ok(status) if status.success() => Ok(()),
        Ok(status) => Err(format!("{name} ended with {status}")),
        Err(error) => Err(format!("{name}: {error}")),
    }
}

#[cfg(all(test, unix, not(target_os = "macos")))]
mod tests {
    use std::ffi::OsStr;
    use std::os::unix::ffi::OsStrExt;
    use std::path::Path;

    use super::{Desktop, Elsewhere, address_of};

    #[test]
    fn an_address_has_every_byte_of_the_path() {
        let path = Path::new(OsStr::from_bytes(b"/my scans/50%/\xffa#?.ply"));
        assert_eq!(address_of(path), "file:///my%20scans/50%25/%FFa%23%3F.ply");
    }

    #[test]
    fn a_file_that_is_gone_is_named_and_nothing_is_started() {
        let gone = Elsewhere::File(Path::new("/no such folder/ball.off").to_owned());
        let refused = Desktop::default().show(&gone);
        assert!(refused.is_err_and(|sentence| sentence.starts_with("/no such folder/ball.off no longer exists")));
    }
}
