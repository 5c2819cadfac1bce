//! The settings, which last from one session to the next, in a JSON file that a person may edit.
//!
//! A file without valid settings is reported once and renamed, so that settings can be kept again; missing members have
//! their defaults.

use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};

use pliant_engine::files::{self, Staging, shown};
use pliant_engine::memory;

/// The number of files that are remembered.
const RECENT: usize = 10;

/// The number of commands that are remembered.
const RECENT_COMMANDS: usize = 6;

/// The settings.
#[derive(Clone, PartialEq, Debug, Serialize, Deserialize)]
#[serde(default)]
pub struct Settings {
    /// Files and projects that were opened or saved, the newest first.
    pub recent: Vec<PathBuf>,
    /// Commands that were chosen in the palette, by their names there, the newest first.
    pub recent_commands: Vec<String>,
    /// Light or dark.
    pub theme: ThemeChoice,
    /// The scale of the interface, 1 for the system's own.
    pub ui_scale: f32,
    /// The panel's width in points.
    pub panel_width: f32,
    /// The window's size in points.
    pub window_size: Option<[f32; 2]>,
    /// True if the window fills the screen; its size is the one for the other case.
    pub maximised: bool,
    /// The page of the panel that is shown.
    pub page: PanelPage,
    /// Sections of the panel that are folded away, by their titles.
    pub folded: std::collections::BTreeSet<String>,
    /// True if the person has closed the hints on the canvas.
    pub hints_seen: bool,
    /// The memory limit for binding; without one, the machine's free memory.
    pub memory: Option<MostMemory>,
    /// Keys of commands, by the commands' names, if they differ from the program's own.
    pub keys: std::collections::BTreeMap<String, Vec<String>>,
}

/// The settings and their file; a change is written at once.
#[derive(Debug, Default)]
pub struct SettingsFile {
    settings: Settings,
    path: Option<PathBuf>,
    /// The problem with the file, in a sentence.
    pub problem: Option<String>,
}

impl SettingsFile {
    /// The settings in this file; without a file the defaults, which are not saved.
    pub fn open(path: Option<PathBuf>) -> Self {
        let Some(path) = path else { return Self::default() };
        let (settings, problem) = Settings::read(&path);
        let (path, problem) = match problem {
            None => (Some(path), None),
            Some(Problem::Unreadable(sentence)) => (None, Some(sentence)),
            Some(Problem::Corrupted(reason)) => match put_aside(&path) {
                Ok(aside) => {
                    let sentence = format!(
                        "the settings in {} can't be read ({reason}), so the defaults apply: the old file is kept as \
                         {}",
                        shown(&path),
                        shown(&aside)
                    );
                    (Some(path), Some(sentence))
                }
                Err(sentence) => (None, Some(sentence)),
            },
        };
        Self {
            settings,
            path,
            problem,
        }
    }

    /// The settings.
    pub fn get(&self) -> &Settings {
        &self.settings
    }

    /// Changes them.
    pub fn change(&mut self, change: impl FnOnce(&mut Settings)) {
        let before = self.settings.clone();
        change(&mut self.settings);
        if let (true, Some(path)) = (before != self.settings, &self.path)
            && let Err(sentence) = self.settings.write(path)
        {
            self.problem = Some(sentence);
        }
    }
}

/// The reason why settings could not be read.
#[derive(Clone, PartialEq, Eq, Debug)]
pub enum Problem {
    /// The file can't be read, in a sentence; the person must repair it.
    Unreadable(String),
    /// It has no valid settings, for this reason.
    Corrupted(String),
}

/// Renames a file to a free name beside it; returns the new name.
fn put_aside(path: &Path) -> Result<PathBuf, String> {
    let named = |number: usize| match number {
        1 => path.with_extension("broken.json"),
        _ => path.with_extension(format!("broken-{number}.json")),
    };
    let free = (1..1000)
        .map(named)
        .find(|name| std::fs::symlink_metadata(name).is_err());
    let aside = free.unwrap_or_else(|| named(1));
    std::fs::rename(path, &aside).map_err(|error| {
        format!(
            "the settings in {} can't be read, and the file can't be renamed ({error}): repair or delete it; the \
             defaults apply for now",
            shown(path)
        )
    })?;
    Ok(aside)
}

/// A page of the panel.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum PanelPage {
    /// Handles and poses.
    #[default]
    Handles,
    /// The options of the method.
    Method,
    /// Objects, the history and the file.
    Scene,
}

/// Light or dark.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum ThemeChoice {
    /// A dim frame.
    #[default]
    Dark,
    /// A bright one.
    Light,
    /// The system's choice.
    System,
}

impl ThemeChoice {
    /// The next choice in the cycle.
    pub fn next(self) -> Self {
        match self {
            Self::Dark => Self::Light,
            Self::Light => Self::System,
            Self::System => Self::Dark,
        }
    }
}

/// A memory limit in bytes, written as on the command line: "8GB".
#[derive(Clone, Copy, PartialEq, Eq, Debug, Serialize, Deserialize)]
#[serde(try_from = "String", into = "String")]
pub struct MostMemory(pub u64);

impl TryFrom<String> for MostMemory {
    type Error = String;

    fn try_from(text: String) -> Result<Self, String> {
        memory::bytes(&text).map(Self)
    }
}

impl From<MostMemory> for String {
    fn from(most: MostMemory) -> Self {
        format!("{}GB", most.0 as f64 / 1e9)
    }
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            recent: Vec::new(),
            recent_commands: Vec::new(),
            theme: ThemeChoice::default(),
            ui_scale: 1.0,
            panel_width: 280.0,
            window_size: None,
            maximised: false,
            page: PanelPage::default(),
            folded: Default::default(),
            hints_seen: false,
            memory: None,
            keys: Default::default(),
        }
    }
}

impl Settings {
    /// Reads the settings; the defaults if there is no such file, and with the reason if it can't be read.
    pub fn read(path: &Path) -> (Self, Option<Problem>) {
        if !path.exists() {
            return (Self::default(), None);
        }
        let text = match files::read_text(path) {
            Ok(text) => text,
            Err(error) => return (Self::default(), Some(Problem::Unreadable(error.to_string()))),
        };
        match serde_json::from_str::<Self>(&text) {
            Ok(mut settings) => {
                let scale = settings.ui_scale;
                settings.ui_scale = if scale.is_finite() { scale.clamp(0.5, 3.0) } else { 1.0 };
                settings.panel_width = settings.panel_width.clamp(200.0, 600.0);
                settings.window_size = settings
                    .window_size
                    .filter(|size| size.iter().all(|side| (320.0..=16_384.0).contains(side)));
                (settings, None)
            }
            Err(error) => (Self::default(), Some(Problem::Corrupted(error.to_string()))),
        }
    }

    /// Writes the settings.
    ///
    /// # Errors
    /// The disk's message, in a sentence.
    pub fn write(&self, path: &Path) -> Result<(), String> {
        let folder = files::folder_of(path);
        std::fs::create_dir_all(folder)
            .map_err(|error| format!("{} can't be made ({error}): check its rights", shown(folder)))?;
        let mut text = serde_json::to_string_pretty(self).unwrap_or_default();
        text.push('\n');
        Staging::default()
            .stage([(path.to_owned(), text.as_bytes())])
            .and_then(|staged| Ok(staged.commit()?))
            .map_err(|error| error.to_string())
    }

    /// Puts a file at the head of the recent ones.
    pub fn remember(&mut self, path: &Path) {
        let path = std::fs::canonicalize(path).unwrap_or_else(|_| path.to_owned());
        put_first(&mut self.recent, path, RECENT);
    }

    /// Puts a command of the palette at the head of the recent ones.
    pub fn remember_command(&mut self, name: String) {
        put_first(&mut self.recent_commands, name, RECENT_COMMANDS);
    }

    /// Removes the recent file that a refusal names from the list, if it no longer exists.
    pub fn forget_if_gone(&mut self, refusal: &str) {
        let is_named = |path: &Path| refusal.starts_with(&shown(path));
        self.recent.retain(|path| !is_named(path) || path.exists());
    }
}

/// Puts an entry at the head of at most `most` different ones.
fn put_first<T: PartialEq>(recent: &mut Vec<T>, entry: T, most: usize) {
    recent.retain(|known| *known != entry);
    recent.insert(0, entry);
    recent.truncate(most);
}

#[cfg(test)]
#[expect(clippy::unwrap_used, reason = "a test fails by panicking")]
mod tests {
    use super::{MostMemory, Problem, Settings, SettingsFile};

    #[test]
    fn memory_is_kept_as_the_command_line_takes_it() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("settings.json");
        for bytes in [500_000_000, 1_610_612_736, 8_000_000_000] {
            let settings = Settings {
                memory: Some(MostMemory(bytes)),
                ..Settings::default()
            };
            settings.write(&path).unwrap();
            assert_eq!(Settings::read(&path), (settings, None));
        }
        assert!(std::fs::read_to_string(&path).unwrap().contains(r#""memory": "8GB""#));
        std::fs::write(&path, r#"{ "memory": "a lot" }"#).unwrap();
        let (settings, problem) = Settings::read(&path);
        assert_eq!(settings, Settings::default());
        assert!(matches!(problem.unwrap(), Problem::Corrupted(reason) if reason.contains("such as 8GB")));
    }

    #[test]
    fn a_corrupted_file_is_said_once_put_aside_and_settings_are_kept_again() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("settings.json");
        for (number, broken) in ["{ \"theme\": \"li", "nonsense"].into_iter().enumerate() {
            std::fs::write(&path, broken).unwrap();
            let mut file = SettingsFile::open(Some(path.clone()));
            let said = file.problem.clone().unwrap();
            let aside = ["settings.broken.json", "settings.broken-2.json"][number];
            assert!(said.contains(aside), "{said}");
            assert_eq!(std::fs::read_to_string(folder.path().join(aside)).unwrap(), broken);
            file.change(|settings| settings.ui_scale = 1.5);
            let file = SettingsFile::open(Some(path.clone()));
            assert_eq!((file.problem.clone(), file.get().ui_scale), (None, 1.5));
        }
    }

    #[test]
    fn a_recent_file_that_is_gone_is_forgotten_once_it_was_asked_for() {
        let folder = tempfile::tempdir().unwrap();
        let files = ["here.ply", "gone.ply", "gone too.ply"].map(|name| folder.path().join(name));
        std::fs::write(&files[0], "").unwrap();
        let mut settings = Settings {
            recent: files.to_vec(),
            ..Settings::default()
        };
        for file in &files[..2] {
            settings.forget_if_gone(&format!("{} can't be read: for some reason", file.display()));
        }
        assert_eq!(
            settings.recent,
            [files[0].clone(), files[2].clone()],
            "nobody asked for the last"
        );
    }
}
