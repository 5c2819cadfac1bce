//! Rows of measurements: parsed from an example's output, printed as a table, saved as JSON.

use std::path::Path;
use std::process::{Command, Stdio};

use crate::process::{cargo, target_folder, words};

/// One row: names and JSON values, in column order.
#[derive(Clone, PartialEq, Debug, Default)]
pub struct Row(Vec<(String, String)>);

impl Row {
    /// Appends a text.
    #[must_use]
    pub fn text(mut self, name: &str, value: &str) -> Self {
        let escaped = value.replace('\\', "\\\\").replace('"', "\\\"");
        self.0.push((name.to_owned(), format!("\"{escaped}\"")));
        self
    }

    /// Appends a number.
    #[must_use]
    pub fn number(mut self, name: &str, value: f64) -> Self {
        self.0.push((name.to_owned(), format!("{value}")));
        self
    }

    /// The row with this text if it has a column of this name.
    #[must_use]
    pub fn with_text(self, name: &str, value: &str) -> Self {
        self.with(Self::default().text(name, value))
    }

    /// The row with this number if it has a column of this name.
    #[must_use]
    pub fn with_number(self, name: &str, value: f64) -> Self {
        self.with(Self::default().number(name, value))
    }

    fn with(mut self, other: Self) -> Self {
        for (name, value) in other.0 {
            self.0
                .iter_mut()
                .filter(|(own, _)| *own == name)
                .for_each(|(_, own)| own.clone_from(&value));
        }
        self
    }

    /// Appends another row.
    #[must_use]
    pub fn and(mut self, other: Self) -> Self {
        self.0.extend(other.0);
        self
    }

    /// Parses a line with one flat JSON object of strings and numbers; `None` for anything else.
    pub fn parse(line: &str) -> Option<Self> {
        let mut rest = line.trim().strip_prefix('{')?.strip_suffix('}')?.trim();
        let mut row = Vec::new();
        while !rest.is_empty() {
            let (name, after) = rest.strip_prefix('"')?.split_once('"')?;
            let after = after.trim_start().strip_prefix(':')?.trim_start();
            let end = match after.strip_prefix('"') {
                Some(text) => text.find('"')? + 2,
                None => after.find(',').unwrap_or(after.len()),
            };
            row.push((name.to_owned(), after[..end].trim().to_owned()));
            let tail = after[end..].trim_start();
            rest = tail.strip_prefix(',').unwrap_or(tail).trim_start();
        }
        Some(Self(row))
    }

    /// A value in JSON.
    pub fn get(&self, name: &str) -> Option<&str> {
        let (_, value) = self.0.iter().find(|(own, _)| own == name)?;
        Some(value)
    }

    fn json(&self) -> String {
        let members: Vec<String> = self
            .0
            .iter()
            .map(|(name, value)| format!("\"{name}\": {value}"))
            .collect();
        format!("{{{}}}", members.join(", "))
    }
}

/// Builds a crate's example in release and runs it. Every line with a JSON object is a row.
///
/// # Errors
/// One sentence if it can't be built or fails.
pub fn measured(package: &str, example: &str, arguments: &[String]) -> Result<Vec<Row>, String> {
    rows_of(release(package, ["--example", example]).args(arguments))
}

/// The command that builds a program in release and runs it.
pub fn release(package: &str, program: [&str; 2]) -> Command {
    let mut command = cargo(&["run", "--locked", "--quiet", "--release", "--package", package]);
    command.args(program).arg("--");
    command
}

/// Runs a program. Every line with a JSON object is a row.
///
/// # Errors
/// One sentence if it can't be started or fails.
pub fn rows_of(command: &mut Command) -> Result<Vec<Row>, String> {
    let words = words(command);
    let output = command
        .stderr(Stdio::inherit())
        .output()
        .map_err(|e| format!("`{words}` can't be started: {e}."))?;
    if !output.status.success() {
        return Err(format!("`{words}` failed ({}).", output.status));
    }
    Ok(String::from_utf8_lossy(&output.stdout)
        .lines()
        .filter_map(Row::parse)
        .collect())
}

/// Prints rows as a table; a row with other columns starts a new table.
pub fn print(rows: &[Row]) {
    let names = |row: &Row| row.0.iter().map(|(name, _)| name.clone()).collect::<Vec<_>>();
    let mut rest = rows;
    while let Some(first) = rest.first() {
        let columns = names(first);
        let end = rest.iter().position(|row| names(row) != columns).unwrap_or(rest.len());
        let (table, tail) = rest.split_at(end);
        let cells: Vec<Vec<String>> = table
            .iter()
            .map(|row| row.0.iter().map(|(_, value)| shown(value)).collect())
            .collect();
        let width = |column: usize| {
            let longest = cells.iter().map(|row| row[column].chars().count()).max().unwrap_or(0);
            longest.max(columns[column].chars().count())
        };
        let line = |row: &[String]| {
            let padded: Vec<String> = (0..row.len()).map(|i| format!("{:>1$}", row[i], width(i))).collect();
            println!("{}", padded.join("  "));
        };
        line(&columns);
        cells.iter().for_each(|row| line(row));
        rest = tail;
    }
}

/// Numbers with three significant digits, strings without quotes.
fn shown(value: &str) -> String {
    match value.parse::<f64>() {
        Ok(number) if number.fract() == 0.0 || number.abs() >= 100.0 => format!("{number:.0}"),
        Ok(number) if number.abs() >= 10.0 => format!("{number:.1}"),
        Ok(number) if number.abs() < 0.01 => format!("{number:.2e}"),
        Ok(number) => format!("{number:.2}"),
        Err(_) => value.trim_matches('"').to_owned(),
    }
}

/// Saves a section's rows as `target/bench/<name>.json`.
///
/// # Errors
/// One sentence if it can't be written.
pub fn keep(name: &str, rows: &[Row]) -> Result<(), String> {
    let path = folder().join(format!("{name}.json"));
    let lines: Vec<String> = rows.iter().map(|row| format!("  {}", row.json())).collect();
    write(&path, format!("[\n{}\n]\n", lines.join(",\n")).as_bytes())
}

/// A section's last saved rows; none if there are none.
pub fn kept(name: &str) -> Vec<Row> {
    let text = std::fs::read_to_string(folder().join(format!("{name}.json"))).unwrap_or_default();
    let lines = text.lines().map(|line| line.trim().trim_end_matches(','));
    lines.filter_map(Row::parse).collect()
}

/// The folder of measurements and their meshes.
pub fn folder() -> std::path::PathBuf {
    target_folder().join("bench")
}

/// Writes a file and creates its parent folders.
///
/// # Errors
/// One sentence if it can't be written.
pub fn write(path: &Path, bytes: &[u8]) -> Result<(), String> {
    let parent = path.parent().unwrap_or(path);
    std::fs::create_dir_all(parent)
        .and_then(|()| std::fs::write(path, bytes))
        .map_err(|e| format!("{} can't be written: {e}.", path.display()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_row_survives_writing_and_parsing() {
        let row = Row::default()
            .text("mesh", "a, b")
            .number("ms", 1.25)
            .number("count", 3.0);
        assert_eq!(row.json(), r#"{"mesh": "a, b", "ms": 1.25, "count": 3}"#);
        assert_eq!(Row::parse(&row.json()), Some(row.clone()));
        assert_eq!(Row::parse("bound in 3 ms"), None);
        assert_eq!(Row::parse("{}"), Some(Row::default()));
    }

    #[test]
    fn a_value_is_replaced_in_its_column() {
        let row = Row::default().text("solver", "a").number("ms", 2.0).text("mesh", "m");
        let other = Row::default().text("solver", "b").number("ms", 3.0).text("mesh", "m");
        assert_eq!(
            row.with_text("solver", "b")
                .with_number("ms", 3.0)
                .with_number("kg", 1.0),
            other
        );
    }

    #[test]
    fn numbers_are_shown_with_three_significant_digits() {
        assert_eq!(
            ["1234.5", "12.34", "0.123", "7", "\"x\""].map(shown),
            ["1234", "12.3", "0.12", "7", "x"]
        );
    }
}
