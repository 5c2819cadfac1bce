//! Parses the command line of `cargo xtask`.

use std::path::PathBuf;

use crate::bench::scale::Scale;
use crate::install::Consent;
use crate::profile::Profile;

/// Printed for `--help` and for unknown commands.
pub const HELP: &str = "\
usage: cargo xtask COMMAND

  run [FILE] [--release] [--yes]
                             build Pliant quickly, or with --release for speed, and open its window on the
                             sample, or on FILE; without a display, apply the sample's edit headless and print
                             the paths of the results
  test [FILTER..] [--yes]    run all checks: formatting, clippy, every test
  check                      run the fast checks: formatting, clippy, unit tests
  bench [SECTION..] [--full] measure, and print tables
  assets [NAME..] [--triangles N] [--output DIR]
                             make the samples; with --triangles the creature at that size (60k, 600k, 5M)
  gallery                    draw the samples' edits by every method into docs/gallery and docs/methods.md
  package                    make the packages that this system can make, and list the others
  manual                     build the manual as a site, and check its links
  python                     build the Python package and the Blender add-on, and run their tests and the notebook

`run` and `test` install missing packages with apt after asking; --yes answers yes.";

/// A command with its arguments.
#[derive(Clone, PartialEq, Debug)]
pub enum Command {
    /// Print the help.
    Help,
    /// Build Pliant and open its window.
    Run {
        /// A mesh instead of the sample.
        file: Option<PathBuf>,
        /// How it is built.
        profile: Profile,
        /// The consent to installing packages without asking.
        consent: Consent,
    },
    /// Run all checks.
    Test {
        /// Filters of test names. With filters, formatting and clippy are skipped.
        filters: Vec<String>,
        /// The consent to installing packages without asking.
        consent: Consent,
    },
    /// Run the fast checks.
    Check,
    /// Measure.
    Bench {
        /// Sections to run; empty for all.
        sections: Vec<String>,
        /// Sizes of the meshes.
        scale: Scale,
    },
    /// Make the samples.
    Assets(Order),
    /// Draw the samples by every method into the docs.
    Gallery,
    /// Make this system's packages.
    Package,
    /// Build the manual.
    Manual,
    /// Build and test the Python package and the Blender add-on.
    Python,
}

/// The samples to make, their size, and their folder.
#[derive(Clone, PartialEq, Debug, Default)]
pub struct Order {
    /// Samples to make; empty for all.
    pub names: Vec<String>,
    /// Number of triangles of the creature, if not the committed one.
    pub triangles: Option<usize>,
    /// Output folder; `assets` by default, or `target/assets` for other sizes.
    pub output: Option<PathBuf>,
}

/// Parses the arguments after `cargo xtask`.
///
/// # Errors
/// One sentence naming the argument that isn't understood.
pub fn parse(words: &[String]) -> Result<Command, String> {
    let Some((command, rest)) = words.split_first() else {
        return Ok(Command::Help);
    };
    let (mut names, mut consent, mut scale, mut order) = (Vec::new(), Consent::Ask, Scale::Usual, Order::default());
    let mut profile = Profile::Quick;
    let mut rest = rest.iter();
    while let Some(word) = rest.next() {
        let mut value = || {
            rest.next()
                .cloned()
                .ok_or_else(|| format!("`{word}` wants a value after it."))
        };
        match (command.as_str(), word.as_str()) {
            ("run" | "test", "--yes") => consent = Consent::Given,
            ("run", "--release") => profile = Profile::Release,
            ("bench", "--full") => scale = Scale::Full,
            ("assets", "--triangles") => order.triangles = Some(count(&value()?)?),
            ("assets", "--output") => order.output = Some(value()?.into()),
            (_, "--help" | "-h") => return Ok(Command::Help),
            (_, option) if option.starts_with('-') => {
                return Err(format!("`cargo xtask {command}` has no option `{option}`."));
            }
            _ => names.push(word.clone()),
        }
    }
    match command.as_str() {
        "help" | "--help" | "-h" => Ok(Command::Help),
        "run" if names.len() > 1 => Err(format!("`cargo xtask run` opens one file; `{}` is a second.", names[1])),
        "run" => Ok(Command::Run {
            file: names.into_iter().next().map(PathBuf::from),
            profile,
            consent,
        }),
        "test" => Ok(Command::Test {
            filters: names,
            consent,
        }),
        "check" if names.is_empty() => Ok(Command::Check),
        "check" => Err(format!(
            "`cargo xtask check` takes no names; for `{}` use `cargo xtask test`.",
            names[0]
        )),
        "bench" => Ok(Command::Bench { sections: names, scale }),
        "assets" => Ok(Command::Assets(Order { names, ..order })),
        "gallery" | "package" | "manual" | "python" if !names.is_empty() => Err(format!(
            "`cargo xtask {command}` takes no names; leave out `{}`.",
            names[0]
        )),
        "gallery" => Ok(Command::Gallery),
        "package" => Ok(Command::Package),
        "manual" => Ok(Command::Manual),
        "python" => Ok(Command::Python),
        _ => Err(format!("There is no command `{command}`.")),
    }
}

/// A count such as `60000`, `600k` or `5M`.
fn count(word: &str) -> Result<usize, String> {
    let (digits, factor) = match word.strip_suffix(['k', 'K']) {
        Some(digits) => (digits, 1_000),
        None => word
            .strip_suffix(['m', 'M'])
            .map_or((word, 1), |digits| (digits, 1_000_000)),
    };
    match digits.parse::<usize>().ok().and_then(|n| n.checked_mul(factor)) {
        Some(n) if (1_000..=20_000_000).contains(&n) => Ok(n),
        _ => Err(format!(
            "`{word}` is not a number of triangles from 1000 to 20M; write 600k or 5M."
        )),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn parsed(line: &str) -> Result<Command, String> {
        parse(&line.split_whitespace().map(str::to_owned).collect::<Vec<_>>())
    }

    #[test]
    fn commands_and_their_options_are_read() {
        assert_eq!(parsed(""), Ok(Command::Help));
        assert_eq!(
            parsed("test --yes"),
            Ok(Command::Test {
                filters: vec![],
                consent: Consent::Given
            })
        );
        assert_eq!(
            parsed("run a.glb"),
            Ok(Command::Run {
                file: Some("a.glb".into()),
                profile: Profile::Quick,
                consent: Consent::Ask
            })
        );
        assert_eq!(
            parsed("run --release"),
            Ok(Command::Run {
                file: None,
                profile: Profile::Release,
                consent: Consent::Ask
            })
        );
        let order = Order {
            names: vec![],
            triangles: Some(600_000),
            output: Some("x".into()),
        };
        assert_eq!(parsed("assets --triangles 600k --output x"), Ok(Command::Assets(order)));
        assert_eq!(count("5M"), Ok(5_000_000));
    }

    #[test]
    fn unknown_arguments_are_named() {
        for (line, culprit) in [
            ("fly", "fly"),
            ("test --full", "--full"),
            ("test --release", "--release"),
            ("run a b", "`b`"),
            ("check mesh", "mesh"),
            ("package deb", "deb"),
            ("assets --triangles", "--triangles"),
            ("assets --triangles 5x", "5x"),
            ("assets --triangles 99999999999999999999M", "99999999999999999999M"),
        ] {
            assert!(parsed(line).is_err_and(|sentence| sentence.contains(culprit)), "{line}");
        }
    }
}
