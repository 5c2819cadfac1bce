//! `pliant generate`: the pages and completions that packages and the manual take from the definitions of the command
//! line and of the window's commands.

use std::fmt::Write as _;
use std::fs;
use std::io;

use clap_complete::{Generator, Shell};
use pliant_editor::{Command, Shortcut};

use super::arguments::{GenerateArguments, definition};
use crate::cli::console::Console;
use pliant_engine::EngineError;
use pliant_engine::files::shown;

/// Writes `man/*.1`, `completions/*`, `command-line.md` and `commands.md` into a folder, replacing files with these
/// names there: all of them or none.
///
/// # Errors
/// If the folder can't be written.
pub(super) fn run(arguments: &GenerateArguments, console: &mut Console<'_>) -> Result<(), EngineError> {
    let folder = &arguments.folder;
    let refuse = |error: io::Error| {
        EngineError::System(format!(
            "{} can't be written: {error}; choose another folder",
            shown(folder)
        ))
    };
    let files = files().map_err(refuse)?;
    for part in [MAN, COMPLETIONS] {
        fs::create_dir_all(folder.join(part)).map_err(refuse)?;
    }
    let files = files.iter().map(|(name, bytes)| (folder.join(name), &**bytes));
    console.staging.stage(files)?.commit()?;
    Ok(())
}

/// The folders of manual pages and of completions.
const MAN: &str = "man";
const COMPLETIONS: &str = "completions";

/// The files, by their paths in the folder.
fn files() -> io::Result<Vec<(String, Vec<u8>)>> {
    let mut program = definition().disable_help_subcommand(true);
    program.build();
    let commands = program.get_subcommands().filter(|command| !command.is_hide_set());
    let mut files = Vec::new();
    for command in std::iter::once(&program).chain(commands) {
        let page = clap_mangen::Man::new(command.clone());
        let name = page.get_filename();
        let mut bytes = Vec::new();
        page.render(&mut bytes)?;
        files.push((format!("{MAN}/{name}"), bytes));
    }
    for shell in [Shell::Bash, Shell::Zsh, Shell::Fish, Shell::PowerShell] {
        let mut bytes = Vec::new();
        clap_complete::generate(shell, &mut definition(), "pliant", &mut bytes);
        files.push((format!("{COMPLETIONS}/{}", shell.file_name("pliant")), bytes));
    }
    files.push(("command-line.md".to_owned(), command_line().into_bytes()));
    files.push(("commands.md".to_owned(), self::commands().into_bytes()));
    Ok(files)
}

/// The command line as a page in Markdown: the help of the program and of each of its commands.
fn command_line() -> String {
    let mut program = definition();
    program.build();
    let mut page = "# The command line\n".to_owned();
    let commands = program.get_subcommands().cloned();
    for mut command in std::iter::once(program.clone()).chain(commands) {
        // The program itself has no display name.
        let name = command.get_display_name().unwrap_or("pliant").replace('-', " ");
        // Writing to a String can't fail.
        let _ = write!(
            page,
            "\n## {name}\n\n```text\n{}\n```\n",
            command.render_long_help().to_string().trim_end()
        );
    }
    page
}

/// The window's commands with their keys as a page in Markdown.
fn commands() -> String {
    let mut page = "# Commands and keys\n\n| command | key | effect |\n|---|---|---|\n".to_owned();
    for listed in Command::all_listed() {
        let keys: Vec<String> = listed.shortcuts.iter().map(Shortcut::label).collect();
        let cells = [listed.name, &keys.join(", "), listed.tooltip].map(|cell| cell.replace('|', "\\|"));
        // Writing to a String can't fail.
        let _ = writeln!(page, "| {} |", cells.join(" | "));
    }
    page
}

#[cfg(test)]
#[expect(clippy::unwrap_used, reason = "a test fails by panicking")]
mod tests {
    use std::path::Path;

    use super::*;
    use pliant_engine::files::Staging;
    use pliant_engine::watch::Watch;

    fn generate(folder: &Path) -> Result<(), EngineError> {
        let mut console = Console {
            out: &mut Vec::new(),
            err: &mut Vec::new(),
            watch: Watch::default(),
            staging: Staging::default(),
        };
        let folder = folder.to_owned();
        run(&GenerateArguments { folder }, &mut console)
    }

    #[test]
    fn where_one_file_can_t_be_written_none_is() {
        let folder = tempfile::tempdir().unwrap();
        let at = |name: &str| folder.path().join(name);
        fs::create_dir(at("commands.md")).unwrap();
        fs::write(at("command-line.md"), "older").unwrap();
        let error = generate(folder.path()).unwrap_err().to_string();
        assert!(error.contains("commands.md"), "{error}");
        assert_eq!(fs::read_to_string(at("command-line.md")).unwrap(), "older");
        for part in [MAN, COMPLETIONS] {
            assert_eq!(fs::read_dir(at(part)).unwrap().count(), 0, "{part}");
        }
    }

    #[test]
    fn every_command_is_in_all_that_is_written() {
        let folder = tempfile::tempdir().unwrap();
        generate(folder.path()).unwrap();
        let read = |name: &str| fs::read_to_string(folder.path().join(name)).unwrap();
        let (page, commands) = (read("command-line.md"), read("commands.md"));
        assert!(page.contains("\n## pliant\n"), "the program itself has a heading");
        for listed in Command::all_listed() {
            assert!(commands.contains(listed.tooltip), "{}", listed.name);
        }
        let shells =
            ["pliant.bash", "_pliant", "pliant.fish", "_pliant.ps1"].map(|name| read(&format!("completions/{name}")));
        for command in definition().get_subcommands() {
            let name = command.get_name();
            assert!(read(&format!("man/pliant-{name}.1")).contains(".SH NAME"), "{name}");
            assert!(page.contains(&format!("\n## pliant {name}\n")), "{name}");
            assert!(shells.iter().all(|shell| shell.contains(name)), "{name}");
            for option in command.get_arguments().filter_map(clap::Arg::get_long) {
                assert!(page.contains(&format!("--{option}")), "{name} {option}");
                assert!(shells.iter().all(|shell| shell.contains(option)), "{name} {option}");
            }
        }
    }
}
