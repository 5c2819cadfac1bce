//! The shown folder and the typed text, apart from the drawing: every act of a person is a function.

use std::path::{Path, PathBuf};

use pliant_engine::files::shown;

use super::typed_path::{begun_anew, candidates, completed, folder_of, split, text_of};
use crate::window::files::listing::{Column, Entry, Order, shown_entries};

/// The purpose of asking for a file.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Asked {
    /// To open an existing one.
    ToOpen,
    /// To save under a name.
    ToSave,
}

/// A folder for quick access.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Place {
    /// Its name.
    pub name: String,
    /// Its path.
    pub folder: PathBuf,
}

/// The state of the shown folder.
#[derive(Clone, PartialEq, Eq, Debug)]
pub enum Contents {
    /// It is being read.
    Awaited,
    /// Its contents.
    Read(Vec<Entry>),
    /// The reason why it can't be read.
    Refused(String),
}

/// Folders, one of which is shown, until the person finds a path.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct FolderBrowser {
    asked: Asked,
    endings: &'static [&'static str],
    places: Vec<Place>,
    home: Option<PathBuf>,
    folder: PathBuf,
    contents: Contents,
    /// The folder has still to be requested.
    is_wanted: bool,
    /// It has not been shown yet.
    is_new: bool,
    back: Vec<PathBuf>,
    forward: Vec<PathBuf>,
    /// True if the folder was reached letter by letter: the way back leads to the start of the typing.
    is_typed: bool,
    /// The typed path: the folder, and a part of a name that filters.
    path: String,
    /// The name to save under.
    name: String,
    /// The extension of a name that is typed without one.
    ending: Option<String>,
    order: Order,
    chosen: Option<PathBuf>,
    /// Enter was pressed before the folder was read.
    is_entered: bool,
    problem: Option<String>,
    found: Option<PathBuf>,
}

impl FolderBrowser {
    /// Begins at `suggested`: shows its folder, and takes its name as the one to save under. Lists files with these
    /// extensions, or all if there are none.
    pub fn new(
        asked: Asked,
        endings: &'static [&'static str],
        suggested: &Path,
        places: Vec<Place>,
        home: Option<PathBuf>,
    ) -> Self {
        let name = match asked {
            Asked::ToOpen => String::new(),
            Asked::ToSave => suggested.file_name().unwrap_or_default().to_string_lossy().into_owned(),
        };
        let folder = match asked {
            Asked::ToOpen => suggested,
            Asked::ToSave => suggested.parent().unwrap_or(suggested),
        };
        Self {
            asked,
            endings,
            places,
            home,
            folder: folder.to_owned(),
            contents: Contents::Awaited,
            is_wanted: true,
            is_new: true,
            back: Vec::new(),
            forward: Vec::new(),
            is_typed: false,
            path: text_of(folder),
            ending: Path::new(&name)
                .extension()
                .map(|ending| ending.to_string_lossy().into_owned()),
            name,
            order: Order {
                column: Column::Name,
                is_reversed: false,
            },
            chosen: None,
            is_entered: false,
            problem: None,
            found: None,
        }
    }

    /// The purpose.
    pub fn asked(&self) -> Asked {
        self.asked
    }

    /// The shown folder.
    pub fn folder(&self) -> &Path {
        &self.folder
    }

    /// Its state.
    pub fn contents(&self) -> &Contents {
        &self.contents
    }

    /// The extensions of the listed files; none if all are listed.
    pub fn endings(&self) -> &'static [&'static str] {
        self.endings
    }

    /// The folders for quick access.
    pub fn places(&self) -> &[Place] {
        &self.places
    }

    /// The typed path.
    pub fn path(&self) -> &str {
        &self.path
    }

    /// The name to save under.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// The order of the list.
    pub fn order(&self) -> Order {
        self.order
    }

    /// The reason why the last Enter did nothing.
    pub fn problem(&self) -> Option<&str> {
        self.problem.as_deref()
    }

    /// The entries to show, in order.
    pub fn shown(&self) -> Vec<&Entry> {
        shown_entries(self.entries(), self.endings, split(&self.path).1, self.order)
    }

    /// The chosen one's place among them.
    pub fn chosen(&self) -> Option<usize> {
        let chosen = self.chosen.as_ref()?;
        self.shown().iter().position(|entry| entry.path == *chosen)
    }

    /// The folder that must be read now, once.
    pub fn take_wanted(&mut self) -> Option<PathBuf> {
        std::mem::take(&mut self.is_wanted).then(|| self.folder.clone())
    }

    /// Returns true if this is the first time that it is shown.
    pub fn take_is_new(&mut self) -> bool {
        std::mem::take(&mut self.is_new)
    }

    /// The result, once.
    pub fn take_found(&mut self) -> Option<PathBuf> {
        self.found.take()
    }

    /// Takes the contents of a folder; nothing happens if another one is shown by now.
    pub fn set_contents(&mut self, folder: &Path, contents: Result<Vec<Entry>, String>) {
        if folder != self.folder || self.contents != Contents::Awaited {
            return;
        }
        self.contents = contents.map_or_else(Contents::Refused, Contents::Read);
        self.choose_match();
        if std::mem::take(&mut self.is_entered) {
            self.enter();
        }
    }

    /// Goes to a folder, or reads this one again.
    pub fn go(&mut self, folder: PathBuf) {
        if folder != self.folder {
            self.back.push(self.folder.clone());
            self.forward.clear();
        }
        self.show(folder);
    }

    /// Returns true if there is a folder above.
    pub fn has_above(&self) -> bool {
        self.folder.parent().is_some()
    }

    /// Goes to the folder above; when opening a file, it selects the folder that was left.
    pub fn go_up(&mut self) {
        if let Some(above) = self.folder.parent().map(Path::to_owned) {
            let left = self.folder.clone();
            self.go(above);
            self.chosen = (self.asked == Asked::ToOpen).then_some(left);
        }
    }

    /// True for each way that exists: back, forward.
    pub fn has_ways(&self) -> [bool; 2] {
        [!self.back.is_empty(), !self.forward.is_empty()]
    }

    /// Goes back to the folder before.
    pub fn go_back(&mut self) {
        if let Some(before) = self.back.pop() {
            self.forward.push(self.folder.clone());
            self.show(before);
        }
    }

    /// Takes the last way back again.
    pub fn go_forward(&mut self) {
        if let Some(next) = self.forward.pop() {
            self.back.push(self.folder.clone());
            self.show(next);
        }
    }

    /// Takes the present typed path: up to its last separator it is the shown folder, and the rest filters.
    pub fn set_path(&mut self, typed: &str) {
        begun_anew(typed).clone_into(&mut self.path);
        self.problem = None;
        self.is_entered = false;
        let head = split(&self.path).0;
        if !head.is_empty() {
            let folder = folder_of(head, &self.folder, self.home.as_deref());
            if folder != self.folder {
                if !self.is_typed {
                    self.back.push(self.folder.clone());
                    self.forward.clear();
                }
                self.request(folder);
                self.is_typed = true;
            }
        }
        self.choose_match();
    }

    /// Tab's completion of the path; `None` if it adds nothing.
    pub fn completion(&self) -> Option<String> {
        let (head, rest) = split(&self.path);
        Some(format!("{head}{}", completed(rest, &self.shown())?))
    }

    /// The entries that begin like the end of the path.
    pub fn candidates(&self) -> Vec<&Entry> {
        let rest = split(&self.path).1;
        let shown = self.shown();
        if rest.is_empty() {
            Vec::new()
        } else {
            candidates(rest, &shown)
        }
    }

    /// Takes the present typed name.
    pub fn set_name(&mut self, name: String) {
        self.name = name;
        (self.chosen, self.problem) = (None, None);
        self.is_entered = false;
    }

    /// Takes the name as a person types it. Typing replaces the part before the extension, so a format's extension may come
    /// before the one that was there, which it then replaces.
    pub fn type_name(&mut self, typed: String) {
        let stem = |name: &str| {
            let ending = self.name.rsplit_once('.').map(|(_, ending)| ending)?;
            self.ending_of(ending)?;
            Some(name.strip_suffix(ending)?.strip_suffix('.')?.to_owned())
        };
        let ends_as_format = |stem: &String| {
            stem.rsplit_once('.')
                .is_some_and(|(_, own)| self.ending_of(own).is_some())
        };
        let had_both = stem(&self.name).is_some_and(|stem| ends_as_format(&stem));
        let replaced = stem(&typed).filter(|stem| ends_as_format(stem) && !had_both);
        self.set_name(replaced.unwrap_or(typed));
    }

    /// The extension of a format, in any case.
    fn ending_of(&self, own: &str) -> Option<&'static str> {
        self.endings
            .iter()
            .copied()
            .find(|ending| ending.eq_ignore_ascii_case(own))
    }

    /// The extension that decides the format of the saved file, one of [`Self::endings`]; `None` if the name has another
    /// one.
    pub fn format(&self) -> Option<&'static str> {
        let own = Path::new(self.name.trim()).extension();
        let own = own
            .map(|ending| ending.to_string_lossy().into_owned())
            .or(self.ending.clone())?;
        self.ending_of(&own)
    }

    /// Chooses the format by its extension, which replaces that of another format in the name.
    pub fn set_format(&mut self, ending: &str) {
        let name = self.name.trim();
        let has_format = Path::new(name).extension().is_some() && self.format().is_some();
        let stem = match name.rsplit_once('.') {
            Some((stem, _)) if has_format => stem,
            _ => name,
        };
        if !stem.is_empty() {
            self.set_name(format!("{stem}.{ending}"));
        }
        self.ending = Some(ending.to_owned());
    }

    /// Sorts by a column, or reverses the order.
    pub fn sort(&mut self, column: Column) {
        self.order = self.order.after_click(column);
    }

    /// Selects the entry at this place of the list; a file's name becomes the one to save under.
    pub fn choose(&mut self, place: usize) {
        let entry = self
            .shown()
            .get(place)
            .map(|entry| (entry.path.clone(), entry.name.clone(), entry.is_folder));
        let Some((path, name, is_folder)) = entry else { return };
        (self.chosen, self.problem) = (Some(path), None);
        if self.asked == Asked::ToSave && !is_folder {
            self.name = name;
        }
    }

    /// Selects the entry so many places further on, or back, from the selected one; without one, the first or the last.
    pub fn choose_next(&mut self, steps: isize) {
        let Some(last) = self.shown().len().checked_sub(1) else {
            return;
        };
        let place = match self.chosen() {
            Some(place) => place.saturating_add_signed(steps).min(last),
            None if steps < 0 => last,
            None => 0,
        };
        self.choose(place);
    }

    /// Returns true if Enter would do anything.
    pub fn can_enter(&self) -> bool {
        let is_named = self.asked == Asked::ToSave && !self.name.trim().is_empty();
        is_named || self.chosen().is_some() || !split(&self.path).1.is_empty()
    }

    /// Enters the selected folder, or returns the selected file or the name to save under. Before the folder is read,
    /// this waits.
    pub fn enter(&mut self) {
        let is_name_path = self.asked == Asked::ToSave && !split(&self.name).0.is_empty();
        if is_name_path && self.chosen.is_none() {
            let name = std::mem::take(&mut self.name);
            let (head, rest) = split(name.trim());
            self.go(folder_of(head, &self.folder, self.home.as_deref()));
            self.name = rest.to_owned();
        }
        match &self.contents {
            Contents::Awaited => self.is_entered = true,
            Contents::Refused(_) => {}
            Contents::Read(_) => self.enter_read(),
        }
    }

    fn enter_read(&mut self) {
        let (name, rest) = (self.name.trim(), split(&self.path).1);
        let named = |name: &str| {
            self.entries()
                .iter()
                .find(|entry| !name.is_empty() && entry.name == name)
        };
        let chosen = self.chosen().and_then(|place| self.shown().get(place).copied());
        let entry = match self.asked {
            // Unlisted entries, hidden or of another kind, open by their full names.
            Asked::ToOpen => chosen.or_else(|| named(rest)),
            Asked::ToSave => chosen.or_else(|| named(name).filter(|entry| entry.is_folder)),
        };
        if let Some(entry) = entry.cloned() {
            self.open(entry);
        } else if self.asked == Asked::ToSave && !name.is_empty() {
            self.found = Some(self.folder.join(self.with_ending(name)));
        } else if !rest.is_empty() {
            let missing = shown(&self.folder.join(rest));
            self.problem = Some(format!(
                "{missing} does not exist: choose a file from the list, or another folder."
            ));
        }
    }

    /// Enters a folder, or returns a file.
    fn open(&mut self, entry: Entry) {
        match entry.is_folder {
            true => self.go(entry.path),
            false => self.found = Some(entry.path),
        }
    }

    fn entries(&self) -> &[Entry] {
        match &self.contents {
            Contents::Read(entries) => entries,
            Contents::Awaited | Contents::Refused(_) => &[],
        }
    }

    fn show(&mut self, folder: PathBuf) {
        self.path = text_of(&folder);
        self.request(folder);
        self.is_typed = false;
    }

    fn request(&mut self, folder: PathBuf) {
        self.folder = folder;
        (self.contents, self.is_wanted) = (Contents::Awaited, true);
        (self.chosen, self.problem) = (None, None);
    }

    /// Selects the likeliest match of the typed text: the same name, then a name that begins so, then one that contains
    /// it.
    fn choose_match(&mut self) {
        let (shown, rest) = (self.shown(), split(&self.path).1);
        if rest.is_empty() {
            return;
        }
        let exact = shown.iter().find(|entry| entry.name == rest);
        let begins = || candidates(rest, &shown).first().copied();
        let best = exact.copied().or_else(begins).or(shown.first().copied());
        self.chosen = best.map(|entry| entry.path.clone());
    }

    /// A name with the default extension, if it has none.
    fn with_ending(&self, name: &str) -> String {
        match &self.ending {
            Some(ending) if Path::new(name).extension().is_none() => format!("{name}.{ending}"),
            _ => name.to_owned(),
        }
    }
}
