//! The Pliant to package.

use std::process::Command;

use crate::process;

/// The program's name for desktops and stores, in reverse order of the project's address.
pub const ID: &str = "org.example.pliant";

/// The project's address.
pub const HOMEPAGE: &str = env!("CARGO_PKG_HOMEPAGE");

/// The version and the time of the packaged program.
pub struct Release {
    /// The workspace's version, such as "0.1.0".
    pub version: &'static str,
    /// Seconds since 1970: `SOURCE_DATE_EPOCH`, or the commit's time.
    pub epoch: u64,
    /// The maintainer: `DEBFULLNAME` and `DEBEMAIL`, or the commit's author.
    pub maintainer: String,
}

impl Release {
    /// Reads it from the environment and from git.
    ///
    /// # Errors
    /// One sentence if neither gives the time or the maintainer.
    pub fn read() -> Result<Self, String> {
        let variable = |name: &str| std::env::var(name).ok().filter(|value| !value.is_empty());
        let commit = |format: &str| {
            let mut git = Command::new("git");
            git.args(["log", "-1", &format!("--format={format}")]);
            process::said(git.current_dir(crate::root::root())).map(|line| line.trim().to_owned())
        };
        let epoch = match variable("SOURCE_DATE_EPOCH") {
            Some(epoch) => epoch,
            None => commit("%ct").map_err(|e| format!("{e} Outside a git clone set SOURCE_DATE_EPOCH."))?,
        };
        let maintainer = match (variable("DEBFULLNAME"), variable("DEBEMAIL")) {
            (Some(name), Some(address)) => format!("{name} <{address}>"),
            _ => commit("%an <%ae>").map_err(|e| format!("{e} Outside a git clone set DEBFULLNAME and DEBEMAIL."))?,
        };
        Ok(Self {
            version: env!("CARGO_PKG_VERSION"),
            epoch: epoch
                .parse()
                .map_err(|_| format!("SOURCE_DATE_EPOCH is `{epoch}`; it must be seconds since 1970."))?,
            maintainer,
        })
    }

    /// The time in a format of `date` (GNU's), in UTC.
    ///
    /// # Errors
    /// One sentence if `date` fails.
    pub fn date(&self, format: &str) -> Result<String, String> {
        let mut date = Command::new("date");
        date.env("LC_ALL", "C")
            .args(["-u", "-d", &format!("@{}", self.epoch), format]);
        process::said(&mut date).map(|line| line.trim().to_owned())
    }

    /// A text with `@VERSION@`, `@ID@` and `@HOMEPAGE@` filled in.
    pub fn filled(&self, text: &str) -> String {
        let values = [("@VERSION@", self.version), ("@ID@", ID), ("@HOMEPAGE@", HOMEPAGE)];
        let fill = |text: String, (name, value): (&str, &str)| text.replace(name, value);
        values.into_iter().fold(text.to_owned(), fill)
    }

    /// The beginning of file names: `pliant-0.1.0-x86_64-linux`.
    pub fn name(&self) -> String {
        format!(
            "pliant-{}-{}-{}",
            self.version,
            std::env::consts::ARCH,
            std::env::consts::OS
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::files::text;

    #[test]
    fn every_file_that_names_the_address_has_the_same() {
        let website = format!("website = \"{HOMEPAGE}\"");
        for (file, named) in [
            ("blender/addon/blender_manifest.toml", website.as_str()),
            ("README.md", HOMEPAGE),
            ("packaging/linux/copyright", HOMEPAGE),
        ] {
            assert!(text(file).unwrap_or_default().contains(named), "{file}");
        }
    }

    #[test]
    fn the_flatpak_has_the_same_name() {
        let manifest = text(&format!("packaging/flatpak/{ID}.yml")).unwrap_or_default();
        assert!(manifest.contains(&format!("\nid: {ID}\n")));
    }

    #[test]
    fn the_name_is_the_address_backwards() {
        let host = HOMEPAGE
            .trim_start_matches("https://")
            .split('/')
            .next()
            .unwrap_or_default();
        let backwards: Vec<&str> = host.rsplit('.').collect();
        assert_eq!(format!("{}.pliant", backwards.join(".")), ID);
    }
}
