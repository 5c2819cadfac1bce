//! Whether the system has a dialog for files. A cancelled one and a missing one give the same answer.

/// Returns true if a portal of the desktop answers on the session's bus, or zenity replaces it.
#[cfg(all(unix, not(target_os = "macos")))]
pub fn is_there() -> bool {
    pollster::block_on(has_portal()).unwrap_or(false) || has_zenity()
}

/// These systems always have one.
#[cfg(any(windows, target_os = "macos"))]
pub fn is_there() -> bool {
    true
}

#[cfg(all(unix, not(target_os = "macos")))]
async fn has_portal() -> zbus::Result<bool> {
    const PORTAL: &str = "org.freedesktop.portal.Desktop";
    let connection = zbus::Connection::session().await?;
    let bus = zbus::fdo::DBusProxy::new(&connection).await?;
    let is_portal = |name: &zbus::names::OwnedBusName| name.as_str() == PORTAL;
    Ok(bus.list_activatable_names().await?.iter().any(is_portal) || bus.list_names().await?.iter().any(is_portal))
}

#[cfg(all(unix, not(target_os = "macos")))]
fn has_zenity() -> bool {
    let path = std::env::var_os("PATH").unwrap_or_default();
    std::env::split_paths(&path).any(|folder| folder.join("zenity").is_file())
}
