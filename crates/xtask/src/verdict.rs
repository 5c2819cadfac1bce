//! Counts test results: the sum of all `test result:` lines and of the steps of this program.

use std::collections::BTreeSet;
use std::io::{BufRead, BufReader, Write};
use std::process::{Command, ExitStatus, Output, Stdio};
use std::sync::Mutex;
use std::time::Instant;

use crate::process;

/// The counts so far, and the names of failures.
#[derive(Clone, PartialEq, Eq, Debug, Default)]
pub struct Verdict {
    passed: usize,
    ignored: usize,
    filtered: usize,
    failures: Vec<String>,
    steps: Vec<String>,
    skipped: BTreeSet<String>,
    /// True if the current lines are output of passing tests, which follows "successes:".
    in_successes: bool,
}

/// The treatment of tests that were skipped without a graphics device or a display.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Skips {
    /// They are only listed: a user's machine may have neither, nor may a system with unknown packages.
    Named,
    /// They count as failures: continuous integration installed the needs of both.
    Failures,
}

/// Beginnings of the lines with which tests of pictures and of the window report that they are skipped.
const NEEDS_GRAPHICS: [&str; 4] = [
    "skipped: pictures",
    "skipped: the picture",
    "skipped: the window",
    "skipped: the real window",
];

/// The treatment of a line of output.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
enum Worth {
    Showing,
    Nothing,
}

impl Verdict {
    /// Runs a command as a step with this name.
    pub fn step(&mut self, name: &str, command: &mut Command) {
        println!("\n── {name}: {}", process::words(command));
        let started = Instant::now();
        let result = process::succeed(command);
        self.record(name, result, started);
    }

    /// Runs a `cargo test` command, and shows and counts its lines.
    pub fn tests(&mut self, name: &str, command: &mut Command) {
        println!("\n── {name}: {}", process::words(command));
        let (started, failures) = (Instant::now(), self.failures.len());
        let result = self.listen(command);
        self.record_tests(name, result, started, failures);
    }

    /// Runs named `cargo test` commands in their order, `at_once` of them at a time. The lines of each are shown and
    /// counted when it has ended.
    pub fn tests_at_once(&mut self, commands: Vec<(String, Command)>, at_once: usize) {
        let queue = Mutex::new(commands.into_iter());
        let (ended, outputs) = std::sync::mpsc::channel();
        std::thread::scope(|scope| {
            for _ in 0..at_once {
                let (ended, queue) = (ended.clone(), &queue);
                scope.spawn(move || {
                    // A queue whose lock is poisoned has no more tests; what panicked is reported by the scope.
                    while let Some((name, mut command)) = queue.lock().ok().and_then(|mut queue| queue.next()) {
                        let started = Instant::now();
                        let output = command.stdin(Stdio::null()).output();
                        if ended.send((name, process::words(&command), output, started)).is_err() {
                            return;
                        }
                    }
                });
            }
            drop(ended);
            for (name, words, output, started) in outputs {
                println!("\n── {name}: {words}");
                let failures = self.failures.len();
                let result = output
                    .map_err(|e| format!("`{words}` can't be run: {e}."))
                    .and_then(|output| self.show_output(&words, &output));
                self.record_tests(&name, result, started, failures);
            }
        });
    }

    /// Shows and counts all that an ended command wrote.
    fn show_output(&mut self, words: &str, output: &Output) -> Result<(), String> {
        eprint!("{}", String::from_utf8_lossy(&output.stderr));
        self.show(&output.stdout[..])
            .map_err(|e| format!("The output of `{words}` can't be shown: {e}."))?;
        succeeded(words, output.status)
    }

    /// Counts a `cargo test` command as a step. `failures` is the number of failures before it.
    fn record_tests(&mut self, name: &str, result: Result<(), String>, started: Instant, failures: usize) {
        if self.failures.len() > failures {
            // Failed tests are already listed; any other failure, such as a compile error, counts as this step's.
            self.steps.push(step(name, "FAILED", started));
        } else {
            self.record(name, result, started);
        }
    }

    /// Counts a check as a step with this name.
    pub fn record(&mut self, name: &str, result: Result<(), String>, started: Instant) {
        let word = match result {
            Ok(()) => {
                self.passed += 1;
                "ok"
            }
            Err(sentence) => {
                eprintln!("{sentence}");
                self.failures.push(name.to_owned());
                "FAILED"
            }
        };
        self.steps.push(step(name, word, started));
    }

    /// Names a skipped check, like that of a test of pictures without a device.
    pub fn skip(&mut self, sentence: &str) {
        self.skipped.insert(format!("skipped: {sentence}"));
    }

    fn listen(&mut self, command: &mut Command) -> Result<(), String> {
        let words = process::words(command);
        let cannot = |e: std::io::Error| format!("`{words}` can't be run: {e}.");
        let mut child = command.stdout(Stdio::piped()).spawn().map_err(cannot)?;
        if let Some(pipe) = child.stdout.take() {
            self.show(BufReader::new(pipe)).map_err(cannot)?;
        }
        succeeded(&words, child.wait().map_err(cannot)?)
    }

    /// Shows and counts all lines of cargo's output.
    fn show(&mut self, mut lines: impl BufRead) -> std::io::Result<()> {
        let mut line = Vec::new();
        while lines.read_until(b'\n', &mut line)? > 0 {
            if self.count(String::from_utf8_lossy(&line).trim_end()) == Worth::Showing {
                let mut out = std::io::stdout().lock();
                out.write_all(&line).and_then(|()| out.flush())?;
            }
            line.clear();
        }
        Ok(())
    }

    /// Processes one line of cargo's output. Output of passing tests is hidden, except for the names of skipped parts.
    fn count(&mut self, line: &str) -> Worth {
        if line == "successes:" {
            self.in_successes = true;
        } else if line == "failures:" || line.starts_with("test result: ") {
            self.in_successes = false;
        }
        if line.starts_with("skipped: ") {
            self.skipped.insert(line.to_owned());
        }
        if self.in_successes {
            return Worth::Nothing;
        }
        if let Some(name) = line
            .strip_prefix("test ")
            .and_then(|rest| rest.strip_suffix(" ... FAILED"))
        {
            self.failures.push(name.to_owned());
        }
        let Some((_, counts)) = line
            .strip_prefix("test result: ")
            .and_then(|rest| rest.split_once(". "))
        else {
            return Worth::Showing;
        };
        for part in counts.split("; ") {
            let Some((Ok(number), what)) = part.split_once(' ').map(|(n, what)| (n.parse::<usize>(), what)) else {
                continue;
            };
            match what {
                "passed" => self.passed += number,
                "ignored" => self.ignored += number,
                "filtered out" => self.filtered += number,
                _ => {}
            }
        }
        Worth::Showing
    }

    /// Prints the totals as the last lines, in cargo's format.
    ///
    /// # Errors
    /// One sentence if anything failed.
    pub fn conclude(self, started: Instant, skips: Skips) -> Result<(), String> {
        let (summary, result) = self.judge(started.elapsed().as_secs_f64(), skips);
        print!("\n{summary}");
        result
    }

    /// The summary and the result, as text: a test that printed such lines would be counted.
    fn judge(mut self, seconds: f64, skips: Skips) -> (String, Result<(), String>) {
        if skips == Skips::Failures {
            let needed = |line: &&String| NEEDS_GRAPHICS.iter().any(|start| line.starts_with(start));
            self.failures.extend(self.skipped.iter().filter(needed).cloned());
        }
        let result = match self.failures.as_slice() {
            [] => Ok(()),
            [failure] => Err(format!("{failure} failed.")),
            failures => Err(format!("{} tests failed: they are named above.", failures.len())),
        };
        (self.summary(seconds), result)
    }

    fn summary(&self, seconds: f64) -> String {
        let mut text = String::new();
        for step in &self.steps {
            text += step;
            text += "\n";
        }
        for skipped in &self.skipped {
            text += skipped;
            text += "\n";
        }
        if !self.failures.is_empty() {
            text += "\nfailures:\n";
            for failure in &self.failures {
                text += &format!("    {failure}\n");
            }
        }
        let word = if self.failures.is_empty() { "ok" } else { "FAILED" };
        text + &format!(
            "\ntest result: {word}. {} passed; {} failed; {} ignored; 0 measured; {} filtered out; finished in {seconds:.2}s\n",
            self.passed,
            self.failures.len(),
            self.ignored,
            self.filtered,
        )
    }
}

fn succeeded(words: &str, status: ExitStatus) -> Result<(), String> {
    match status.success() {
        true => Ok(()),
        false => Err(format!("`{words}` failed ({status}).")),
    }
}

/// A step's line in the summary.
fn step(name: &str, word: &str, started: Instant) -> String {
    format!("test {name} ... {word} ({:.0} s)", started.elapsed().as_secs_f64())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn results_are_summed_and_failures_named() {
        let mut verdict = Verdict::default();
        for line in [
            "running 3 tests",
            "test one::two ... ok",
            "test one::three ... FAILED",
            "",
            "successes:",
            "",
            "---- one::two stdout ----",
            "skipped: there is no moon",
            "test result in a test's own words ... FAILED",
            "",
            "successes:",
            "    one::two",
            "",
            "failures:",
            "test result: FAILED. 2 passed; 1 failed; 4 ignored; 0 measured; 5 filtered out; finished in 0.1s",
            "test result: ok. 7 passed; 0 failed; 0 ignored; 0 measured; 0 filtered out; finished in 0.1s",
        ] {
            verdict.count(line);
        }
        let (summary, result) = verdict.judge(2.0, Skips::Named);
        assert!(
            summary.starts_with("skipped: there is no moon\n\nfailures:\n    one::three\n"),
            "{summary}"
        );
        let last =
            "test result: FAILED. 9 passed; 1 failed; 4 ignored; 0 measured; 5 filtered out; finished in 2.00s\n";
        assert!(summary.ends_with(last), "{summary}");
        assert!(result.is_err());
    }

    #[test]
    fn skipped_pictures_and_windows_fail_where_they_must_run() {
        for (line, skips, is_failure) in [
            ("skipped: pictures (no adapter)", Skips::Failures, true),
            ("skipped: the real window (no Xvfb)", Skips::Failures, true),
            ("skipped: the real window (no Xvfb)", Skips::Named, false),
            ("skipped: there is no horse.ply", Skips::Failures, false),
        ] {
            let mut verdict = Verdict::default();
            verdict.count(line);
            assert_eq!(verdict.judge(0.0, skips).1.is_err(), is_failure, "{line}");
        }
    }

    #[test]
    fn a_step_that_fails_is_a_failure_and_one_that_succeeds_is_a_pass() {
        let mut verdict = Verdict::default();
        verdict.step("good", &mut Command::new("true"));
        verdict.step("bad", &mut Command::new("false"));
        verdict.step("absent", &mut Command::new("no-such-program-of-ours"));
        assert_eq!(verdict.failures, ["bad", "absent"]);
        assert_eq!(verdict.passed, 1);
    }
    #[test]
    fn every_command_of_a_queue_runs_once_and_counts() {
        for at_once in [1, 2, 9] {
            let mut verdict = Verdict::default();
            let programs = ["true", "false", "no-such-program-of-ours", "true"];
            let commands = programs.map(|program| (program.to_owned(), Command::new(program)));
            verdict.tests_at_once(commands.into(), at_once);
            verdict.failures.sort();
            assert_eq!(
                verdict.failures,
                ["false", "no-such-program-of-ours"],
                "{at_once} at once"
            );
            assert_eq!((verdict.passed, verdict.steps.len()), (2, 4), "{at_once} at once");
        }
    }
}
