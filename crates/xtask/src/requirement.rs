//! The requirements of building and testing Pliant: their detection, and the packages that provide them.

use crate::{process, system};

/// A requirement that must be installed.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Requirement {
    /// Its detection.
    pub evidence: Evidence,
    /// The Debian and Ubuntu package that provides it.
    pub package: &'static str,
}

/// The way to detect a requirement.
#[derive(Clone, Copy, PartialEq, Debug)]
pub enum Evidence {
    /// A program in `PATH`.
    Program(&'static str),
    /// A shared library that the dynamic loader finds.
    Library(&'static str),
    /// Any Vulkan driver.
    VulkanDriver,
    /// Mesa's software Vulkan driver.
    SoftwareVulkanDriver,
    /// Khronos' validation layer.
    VulkanValidation,
}

const fn library(name: &'static str, package: &'static str) -> Requirement {
    Requirement {
        evidence: Evidence::Library(name),
        package,
    }
}

const fn tool(name: &'static str, package: &'static str) -> Requirement {
    Requirement {
        evidence: Evidence::Program(name),
        package,
    }
}

/// The requirements of pictures: Vulkan and some driver.
pub const PICTURES: &[Requirement] = &[
    library("libvulkan.so.1", "libvulkan1"),
    Requirement {
        evidence: Evidence::VulkanDriver,
        package: "mesa-vulkan-drivers",
    },
];

/// The requirements of a window: the libraries that winit loads at run time.
pub const WINDOW: &[Requirement] = &[
    library("libX11.so.6", "libx11-6"),
    library("libX11-xcb.so.1", "libx11-xcb1"),
    library("libXcursor.so.1", "libxcursor1"),
    library("libXi.so.6", "libxi6"),
    library("libxkbcommon.so.0", "libxkbcommon0"),
    library("libxkbcommon-x11.so.0", "libxkbcommon-x11-0"),
    library("libwayland-client.so.0", "libwayland-client0"),
];

/// The requirements of the tests: a virtual display, a tool that moves its mouse, the driver for comparing pictures,
/// and the layer that checks its use.
pub const TESTS: &[Requirement] = &[
    Requirement {
        evidence: Evidence::SoftwareVulkanDriver,
        package: "mesa-vulkan-drivers",
    },
    Requirement {
        evidence: Evidence::VulkanValidation,
        package: "vulkan-validationlayers",
    },
    tool("Xvfb", "xvfb"),
    tool("xdotool", "xdotool"),
    tool("openbox", "openbox"),
    tool("wmctrl", "wmctrl"),
];

/// The packages of the libraries among the requirements: the dependencies of a package of Pliant.
pub fn library_packages(requirements: &[&[Requirement]]) -> Vec<&'static str> {
    let libraries = requirements.iter().copied().flatten();
    let libraries = libraries.filter(|requirement| matches!(requirement.evidence, Evidence::Library(_)));
    libraries.map(|requirement| requirement.package).collect()
}

/// The packages of the missing requirements, without duplicates.
pub fn missing_packages(requirements: &[&[Requirement]]) -> Vec<&'static str> {
    let mut packages = Vec::new();
    for requirement in requirements.iter().copied().flatten() {
        if !requirement.evidence.is_there() && !packages.contains(&requirement.package) {
            packages.push(requirement.package);
        }
    }
    packages
}

impl Evidence {
    fn is_there(self) -> bool {
        match self {
            Self::Program(name) => process::program(name).is_some(),
            Self::Library(name) => system::has_library(name),
            Self::VulkanDriver => !system::vulkan_drivers().is_empty(),
            Self::SoftwareVulkanDriver => system::software_vulkan_driver().is_some(),
            Self::VulkanValidation => system::has_validation_layer(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn missing_things_name_their_package_once() {
        let absent = [
            tool("no-such-program-of-ours", "one"),
            library("libnosuchthing.so.9", "one"),
            tool("sh", "two"),
        ];
        assert_eq!(missing_packages(&[&absent, &absent]), ["one"]);
    }
}
