//! Programs that some commands use if they are installed.

use std::path::PathBuf;

use crate::process;

/// A program that the caller of a command can install.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Tool {
    /// Its name in `PATH`.
    pub program: &'static str,
    /// The command that installs it.
    pub install: &'static str,
}

impl Tool {
    /// Its path.
    ///
    /// # Errors
    /// One sentence naming it and its installation.
    pub fn find(self) -> Result<PathBuf, String> {
        process::program(self.program).ok_or_else(|| format!("{} is not installed: {}", self.program, self.install))
    }
}

/// Checks that all of these are installed.
///
/// # Errors
/// One sentence naming all that are missing.
pub fn all_there(tools: &[Tool]) -> Result<(), String> {
    let missing: Vec<String> = tools.iter().filter_map(|tool| tool.find().err()).collect();
    if missing.is_empty() {
        Ok(())
    } else {
        Err(missing.join("; "))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_missing_tool_is_named_with_its_remedy() {
        let tool = |program| Tool {
            program,
            install: "apt install it",
        };
        let sentence = all_there(&[tool("no-such-tool"), tool("cargo"), tool("no-other-tool")]);
        assert_eq!(
            sentence,
            Err("no-such-tool is not installed: apt install it; no-other-tool is not installed: apt install it".into())
        );
    }
}
