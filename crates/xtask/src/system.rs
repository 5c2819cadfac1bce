//! Detects the operating system and its installed libraries and drivers.

use std::path::{Path, PathBuf};

use crate::process;

/// The operating system, for the installation of packages.
#[derive(Clone, PartialEq, Debug)]
pub enum System {
    /// Debian, Ubuntu or a derivative: apt installs packages.
    Debian {
        /// Its name in `os-release`.
        name: String,
    },
    /// Another Linux, with other package names.
    OtherLinux {
        /// Its name in `os-release`.
        name: String,
    },
    /// Another system.
    Other {
        /// Rust's name for it.
        name: String,
    },
}

impl System {
    /// The system of this machine.
    pub fn here() -> Self {
        if std::env::consts::OS != "linux" {
            return Self::Other {
                name: std::env::consts::OS.to_owned(),
            };
        }
        let text = ["/etc/os-release", "/usr/lib/os-release"]
            .iter()
            .find_map(|path| std::fs::read_to_string(path).ok());
        Self::from_os_release(&text.unwrap_or_default())
    }

    /// Parses an `os-release` file.
    pub fn from_os_release(text: &str) -> Self {
        let value = |key: &str| {
            text.lines()
                .filter_map(|line| line.trim().split_once('='))
                .find(|(name, _)| *name == key)
                .map(|(_, value)| value.trim_matches(['"', '\'']).to_owned())
                .unwrap_or_default()
        };
        let name = [value("PRETTY_NAME"), value("NAME")]
            .into_iter()
            .find(|n| !n.is_empty());
        let name = name.unwrap_or_else(|| "this Linux".to_owned());
        let kinds = format!("{} {}", value("ID"), value("ID_LIKE"));
        if kinds
            .split_whitespace()
            .any(|kind| kind == "debian" || kind == "ubuntu")
        {
            Self::Debian { name }
        } else {
            Self::OtherLinux { name }
        }
    }

    /// Its name in messages.
    pub fn name(&self) -> &str {
        match self {
            Self::Debian { name } | Self::OtherLinux { name } | Self::Other { name } => name,
        }
    }
}

/// Returns true if the loader finds the shared library with this exact name (`libvulkan.so.1`).
pub fn has_library(name: &str) -> bool {
    let cached = process::output("ldconfig", &["-p"]).unwrap_or_default();
    let listed = cached.lines().any(|line| line.split_whitespace().next() == Some(name));
    listed || library_folders().iter().any(|folder| folder.join(name).exists())
}

/// Library folders that may be missing from the loader's cache.
fn library_folders() -> Vec<PathBuf> {
    let asked = std::env::var_os("LD_LIBRARY_PATH").unwrap_or_default();
    let triple = format!("/usr/lib/{}-linux-gnu", std::env::consts::ARCH);
    std::env::split_paths(&asked)
        .chain([triple.as_str(), "/usr/lib64", "/usr/lib"].map(PathBuf::from))
        .collect()
}

/// The manifests of the installed Vulkan drivers.
pub fn vulkan_drivers() -> Vec<PathBuf> {
    for variable in ["VK_DRIVER_FILES", "VK_ICD_FILENAMES"] {
        if let Some(files) = std::env::var_os(variable) {
            return std::env::split_paths(&files).filter(|file| file.exists()).collect();
        }
    }
    let mut files: Vec<PathBuf> = ["/etc", "/usr/local/share", "/usr/share"]
        .iter()
        .filter_map(|folder| std::fs::read_dir(Path::new(folder).join("vulkan/icd.d")).ok())
        .flat_map(|entries| entries.filter_map(Result::ok).map(|entry| entry.path()))
        .filter(|file| file.extension().is_some_and(|extension| extension == "json"))
        .collect();
    files.sort();
    files
}

/// The manifest of Mesa's software driver, on which pictures are compared.
pub fn software_vulkan_driver() -> Option<PathBuf> {
    vulkan_drivers().into_iter().find(|file| {
        let name = file.file_name().unwrap_or_default().to_string_lossy();
        name.starts_with("lvp_icd") && !name.contains("i686")
    })
}

/// Returns true if Khronos' validation layer is installed.
pub fn has_validation_layer() -> bool {
    ["/etc", "/usr/local/share", "/usr/share"].iter().any(|folder| {
        Path::new(folder)
            .join("vulkan/explicit_layer.d/VkLayer_khronos_validation.json")
            .exists()
    })
}

/// Returns true if this process runs as root.
pub fn is_root() -> bool {
    process::output("id", &["-u"]).is_some_and(|answer| answer.trim() == "0")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn debian_ubuntu_and_their_children_have_apt() {
        let debian = "PRETTY_NAME=\"Debian GNU/Linux 12 (bookworm)\"\nID=debian\n";
        assert_eq!(
            System::from_os_release(debian),
            System::Debian {
                name: "Debian GNU/Linux 12 (bookworm)".into()
            }
        );
        let mint = "NAME='Linux Mint'\nID=linuxmint\nID_LIKE=\"ubuntu debian\"\n";
        assert_eq!(
            System::from_os_release(mint),
            System::Debian {
                name: "Linux Mint".into()
            }
        );
    }

    #[test]
    fn other_systems_have_not_and_odd_files_are_read() {
        let fedora = "NAME=\"Fedora Linux\"\nID=fedora\n";
        assert_eq!(
            System::from_os_release(fedora),
            System::OtherLinux {
                name: "Fedora Linux".into()
            }
        );
        assert_eq!(
            System::from_os_release("\u{feff}no equals sign"),
            System::OtherLinux {
                name: "this Linux".into()
            }
        );
    }
}
