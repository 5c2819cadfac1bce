//! The Debian package, made with Debian's own tools.

use std::path::{Path, PathBuf};
use std::process::Command;

use super::release::{HOMEPAGE, Release};
use super::tree::{DOCUMENTS, compress, plain_permissions};
use crate::files;
use crate::process::said;
use crate::requirement::{PICTURES, WINDOW, library_packages};
use crate::tool::{Tool, all_there};

const TOOLS: &[Tool] = &[
    Tool {
        program: "dpkg-deb",
        install: "it comes with Debian and Ubuntu",
    },
    Tool {
        program: "dpkg-shlibdeps",
        install: "apt install dpkg-dev",
    },
];

/// Makes `pliant_VERSION-1_ARCHITECTURE.deb` of the tree.
///
/// # Errors
/// One sentence naming the missing tool or the failure.
pub fn package(release: &Release, tree: &Path, folder: &Path) -> Result<Vec<PathBuf>, String> {
    all_there(TOOLS)?;
    let architecture = said(Command::new("dpkg").arg("--print-architecture"))?;
    let architecture = architecture.trim();
    let root = folder.join("deb");
    files::fresh_folder(&root)?;
    files::copy_folder(tree, &root.join("usr"))?;
    // In Debian the text of this licence is in the system, and `copyright` names its place.
    let documents = root.join("usr").join(DOCUMENTS);
    files::remove_file(&documents.join("LICENSE-MIT"))?;
    changelog(release, &documents)?;
    let libraries = linked_libraries(&root)?;
    let sums = checksums(&root)?;
    files::write(&root.join("DEBIAN/md5sums"), sums)?;
    files::write(
        &root.join("DEBIAN/control"),
        control(release, architecture, &libraries, kibibytes(&root)?),
    )?;
    plain_permissions(&root)?;
    let file = folder.join(format!("pliant_{}-1_{architecture}.deb", release.version));
    let mut build = Command::new("dpkg-deb");
    build.env("SOURCE_DATE_EPOCH", release.epoch.to_string());
    // One thread, because the output of xz depends on the number of threads.
    build
        .args(["--root-owner-group", "-Zxz", "--threads-max=1", "--build"])
        .arg(&root);
    said(build.arg(&file))?;
    files::remove_folder(&root)?;
    Ok(vec![file])
}

/// Debian's own changelog, which only names the place of the program's.
fn changelog(release: &Release, documents: &Path) -> Result<(), String> {
    let file = documents.join("changelog.Debian");
    let text = format!(
        "pliant ({}-1) unstable; urgency=medium\n\n  * See changelog.gz.\n\n -- {}  {}\n",
        release.version,
        release.maintainer,
        release.date("-R")?
    );
    files::write(&file, text)?;
    compress(&file)
}

/// The packages of the program's libraries, found by Debian's tool.
fn linked_libraries(root: &Path) -> Result<String, String> {
    // The tool refuses to work without a source package around it.
    let source = root.join("debian/control");
    files::write(&source, "Source: pliant\n\nPackage: pliant\nArchitecture: any\n")?;
    let mut shlibdeps = Command::new("dpkg-shlibdeps");
    let said = said(shlibdeps.current_dir(root).args(["-O", "usr/bin/pliant"]))?;
    files::remove_folder(&root.join("debian"))?;
    let depends = said.lines().find_map(|line| line.strip_prefix("shlibs:Depends="));
    depends
        .map(str::to_owned)
        .ok_or_else(|| "`dpkg-shlibdeps` does not name the libraries of the program.".to_owned())
}

/// The file that describes the package. It names the packages that the window and its pictures load at run time.
fn control(release: &Release, architecture: &str, libraries: &str, kibibytes: u64) -> String {
    format!(
        "Package: pliant\n\
         Version: {version}-1\n\
         Architecture: {architecture}\n\
         Maintainer: {maintainer}\n\
         Installed-Size: {kibibytes}\n\
         Depends: {libraries}, {loaded}\n\
         Recommends: mesa-vulkan-drivers | vulkan-icd, xdg-desktop-portal\n\
         Homepage: {HOMEPAGE}\n\
         Section: graphics\n\
         Priority: optional\n\
         Description: editor that bends scanned meshes\n \
         Pliant bends scanned meshes: paint the part that may move, paint a handle and drag it,\n \
         and the surface follows like a sheet of material. It opens glTF, OBJ, PLY,\n \
         STL, OFF, 3MF and USDZ, and saves the same file, changing only its shape.\n \
         .\n \
         It bends by many methods of research (as rigidly as possible, as a thin\n \
         plate, as a shell, with cages and lattices), in a window or in batch.\n",
        version = release.version,
        maintainer = release.maintainer,
        loaded = library_packages(&[PICTURES, WINDOW]).join(", "),
    )
}

/// The checksums of all files, as `md5sum` prints them.
fn checksums(root: &Path) -> Result<String, String> {
    said(Command::new("md5sum").current_dir(root).args(files::all_files(root)?))
}

/// The size of the files on a disk, each rounded up to whole KiB.
fn kibibytes(root: &Path) -> Result<u64, String> {
    let files = files::all_files(root)?;
    let sizes = files.iter().map(|file| {
        let about = std::fs::metadata(root.join(file));
        let about = about.map_err(|e| format!("{} can't be read: {e}.", file.display()))?;
        Ok(about.len().div_ceil(1024))
    });
    sizes.sum()
}
