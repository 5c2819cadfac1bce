//! The oldest glibc with which a program runs.
//!
//! A program that is linked with the system's glibc asks for functions as new as that system: here `hypot` alone asks
//! for 2.35. Zig's linker knows the functions of every version, so a program that it links runs on older systems.

use std::path::Path;
use std::process::Command;

use crate::process::{said, target_folder};
use crate::tool::Tool;

/// The glibc of Red Hat 8 and of Debian 10, for which Blender is built, too.
pub const OLDEST: &str = "2.28";

const ZIG: Tool = Tool {
    program: "cargo-zigbuild",
    install: "pip install cargo-zigbuild==0.24.1",
};
const OBJDUMP: Tool = Tool {
    program: "objdump",
    install: "apt install binutils",
};

/// The compiler's command, and the folder of its results in a profile named `dist`.
pub struct Linked {
    /// `cargo`, or cargo with Zig as its linker.
    pub command: Command,
    /// The folder.
    pub folder: std::path::PathBuf,
}

/// `cargo rustc` with Zig's linker on Linux, if it is installed, and otherwise with the system's.
///
/// # Errors
/// One sentence, if only a part of it is installed.
pub fn rustc() -> Result<Linked, String> {
    let Ok(zig) = ZIG.find() else {
        return Ok(system());
    };
    if !cfg!(all(target_os = "linux", target_env = "gnu")) {
        return Ok(system());
    }
    check_compiler(&zig)?;
    let target = format!("{}-unknown-linux-gnu", std::env::consts::ARCH);
    let mut command = Command::new(zig);
    command.current_dir(crate::root::root());
    command.args(["rustc", "--target", &format!("{target}.{OLDEST}")]);
    Ok(Linked {
        command,
        folder: target_folder().join(target).join("dist"),
    })
}

/// Checks that cargo-zigbuild finds Zig's compiler. Cargo would show its backtrace in mid-build otherwise.
fn check_compiler(zig: &Path) -> Result<(), String> {
    let answer = Command::new(zig).args(["zig", "cc", "--", "--version"]).output();
    match answer {
        Ok(answer) if answer.status.success() => Ok(()),
        _ => Err(format!(
            "{} is installed, and finds no Zig: pip install ziglang, in a Python whose programs are in PATH.",
            ZIG.program
        )),
    }
}

fn system() -> Linked {
    Linked {
        command: crate::process::cargo(&["rustc"]),
        folder: target_folder().join("dist"),
    }
}

/// A sentence with the oldest glibc with which a program or a library runs.
///
/// # Errors
/// One sentence naming the missing tool.
pub fn sentence(file: &Path) -> Result<String, String> {
    let symbols = said(Command::new(OBJDUMP.find()?).arg("-T").arg(file))?;
    let name = file.file_name().unwrap_or_default().to_string_lossy();
    Ok(match newest(&symbols) {
        Some([major, minor]) => {
            let remedy = match format!("{major}.{minor}") == OLDEST || ZIG.find().is_ok() {
                true => String::new(),
                false => format!("; for {OLDEST}: {}", ZIG.install),
            };
            format!("{name} runs with glibc {major}.{minor} and later{remedy}")
        }
        None => format!("{name} needs no glibc"),
    })
}

/// The newest version of glibc that is named in a table of symbols.
fn newest(symbols: &str) -> Option<[u32; 2]> {
    let named = symbols.split("GLIBC_").skip(1).filter_map(|rest| {
        let version = rest
            .split(|letter: char| letter != '.' && !letter.is_ascii_digit())
            .next()?;
        let mut numbers = version.split('.').map(str::parse);
        match (numbers.next(), numbers.next()) {
            (Some(Ok(major)), Some(Ok(minor))) => Some([major, minor]),
            _ => None,
        }
    });
    named.max()
}

#[cfg(test)]
mod tests {
    use super::newest;

    #[test]
    fn the_newest_version_counts_by_its_numbers() {
        let symbols = "\
            0000 DF *UND* 0000 (GLIBC_2.2.5) memcpy\n\
            0000 DF *UND* 0000 (GLIBC_2.35)  hypot\n\
            0000 DF *UND* 0000 (GLIBC_2.9)   pipe2\n\
            0000 DF *UND* 0000 (GCC_3.0)     _Unwind_Resume\n\
            0000 DF *UND* 0000 (GLIBC_PRIVATE) _dl_x\n";
        assert_eq!(newest(symbols), Some([2, 35]));
        assert_eq!(newest("0000 DF *UND* 0000 GCC_3.0 _Unwind_Resume"), None);
    }
}
