//! The parent: it sends cases, ends a child that does not answer, reports broken laws, and minimises their cases.

use std::collections::BTreeMap;
use std::fs::File;
use std::io::{BufRead as _, BufReader, Write as _};
use std::path::{Path, PathBuf};
use std::process::{Child, ChildStdin, Command, ExitCode, Stdio};
use std::sync::mpsc::{Receiver, RecvTimeoutError, channel};
use std::time::{Duration, Instant};

use pliant_tests::hostile::{Case, Kind, Size, lay};
use serde_json::{Value, json};

use crate::counting::cpu_ms;
use crate::table::Table;

/// The processor time after which a command is ended.
const MOST_CPU_MS: u64 = 25_000;

/// The time after which an idle command is ended.
const MOST_IDLE: Duration = Duration::from_secs(20);

/// The most reports of one law for one kind.
const TOLD: usize = 12;

/// The most folders kept for one law and kind.
const KEPT: usize = 2;

/// Runs cases from `seed` on.
pub fn drive(seed: u64, count: u64, kind: Option<Kind>) -> ExitCode {
    let base = Path::new("/dev/shm");
    let base = if base.is_dir() {
        base.to_owned()
    } else {
        std::env::temp_dir()
    };
    let scratch = tempfile::Builder::new()
        .prefix("pliant-hostile-")
        .tempdir_in(base)
        .unwrap();
    let mut worker = Worker::start(scratch.path());
    let mut table = Table::default();
    let mut told: BTreeMap<(String, &str), usize> = BTreeMap::new();
    for number in seed..seed.saturating_add(count) {
        let kind = kind.unwrap_or(Kind::ALL[(number % Kind::ALL.len() as u64) as usize]);
        let end = worker.case(number, kind, &[]);
        table.add(kind, number, &end);
        let mut laws: Vec<(&str, &str)> = Vec::new();
        for violation in end["violations"].as_array().into_iter().flatten() {
            let (law, what) = (violation[0].as_str().unwrap(), violation[1].as_str().unwrap());
            if !laws.iter().any(|(other, _)| *other == law) {
                laws.push((law, what));
            }
        }
        let mut kept = String::new();
        for (law, what) in laws {
            let times = told.entry((law.to_owned(), kind.name())).or_default();
            *times += 1;
            if *times > TOLD {
                continue;
            }
            let mut shrunk = String::new();
            if *times <= KEPT {
                // Once per case, before it is run again.
                if kept.is_empty() {
                    kept = format!("; its folder is {}", keep(scratch.path(), kind, number).display());
                }
                let without = worker.shrink(number, kind, law, &end);
                if !without.is_empty() {
                    shrunk = format!(" (also without {without:?})");
                }
            }
            println!(
                "{law}: `hostile {number} 1 {}`{shrunk}: {what}; by {}{kept}",
                kind.name(),
                end["last"]
            );
        }
    }
    table.print();
    for ((law, kind), times) in &told {
        println!("{law} was broken by {times} cases of the kind {kind}");
    }
    if told.is_empty() {
        ExitCode::SUCCESS
    } else {
        ExitCode::FAILURE
    }
}

/// Copies a case's folder to its final place, in the state `before` the commands and in the present one.
fn keep(scratch: &Path, kind: Kind, number: u64) -> PathBuf {
    let kept = std::env::temp_dir()
        .join("pliant-hostile")
        .join(format!("{}-{number}", kind.name()));
    let _ = std::fs::remove_dir_all(&kept);
    let _ = std::fs::create_dir_all(&kept);
    let _ = Command::new("cp")
        .arg("-a")
        .arg(scratch.join("case"))
        .arg(&kept)
        .status();
    lay(&Case::new(number, kind, Size::Full, &[]), &kept.join("before"));
    kept
}

/// A child that runs cases.
struct Worker {
    scratch: PathBuf,
    child: Child,
    orders: ChildStdin,
    lines: Receiver<String>,
}

impl Worker {
    fn start(scratch: &Path) -> Self {
        let errors = File::create(scratch.join("errors")).unwrap();
        let mut child = Command::new(std::env::current_exe().unwrap())
            .arg("worker")
            .arg(scratch)
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .stderr(errors)
            .spawn()
            .unwrap();
        let orders = child.stdin.take().unwrap();
        let out = BufReader::new(child.stdout.take().unwrap());
        let (sender, lines) = channel();
        std::thread::spawn(move || {
            for line in out.lines().map_while(Result::ok) {
                if sender.send(line).is_err() {
                    return;
                }
            }
        });
        Self {
            scratch: scratch.to_owned(),
            child,
            orders,
            lines,
        }
    }

    /// Runs a case; returns its result, with the save or the command that ended it as `last`.
    fn case(&mut self, number: u64, kind: Kind, without: &[usize]) -> Value {
        let without: Vec<String> = without.iter().map(usize::to_string).collect();
        let order = format!("{number} {} {}\n", kind.name(), without.join(" "));
        if self.orders.write_all(order.as_bytes()).is_err() {
            *self = Self::start(&self.scratch);
            self.orders.write_all(order.as_bytes()).unwrap();
        }
        let process = self.child.id().to_string();
        let (mut last, mut applied) = (Value::Null, Value::Null);
        let mut began = (Instant::now(), cpu_ms(&process).unwrap_or(0));
        let mut idle = began;
        loop {
            match self.lines.recv_timeout(Duration::from_millis(200)) {
                Ok(line) => {
                    began = (Instant::now(), cpu_ms(&process).unwrap_or(0));
                    idle = began;
                    if let Some(words) = line.strip_prefix("RUN ") {
                        last = serde_json::from_str(words).unwrap();
                        if applied.is_null() && last[0] == "apply" {
                            applied = last.clone();
                        }
                    } else if let Some(end) = line.strip_prefix("END ") {
                        let mut end: Value = serde_json::from_str(end).unwrap();
                        end["last"] = if applied.is_null() { last } else { applied };
                        return end;
                    }
                }
                Err(RecvTimeoutError::Timeout) => {
                    let cpu = cpu_ms(&process).unwrap_or(began.1);
                    if cpu > idle.1 + 20 {
                        idle = (Instant::now(), cpu);
                    }
                    let what = if cpu - began.1 > MOST_CPU_MS {
                        format!("ended after {MOST_CPU_MS} ms of the processor")
                    } else if idle.0.elapsed() > MOST_IDLE {
                        format!("ended after waiting for {MOST_IDLE:?}")
                    } else {
                        continue;
                    };
                    let _ = self.child.kill();
                    return self.died("InTime", &what, last, kind);
                }
                Err(RecvTimeoutError::Disconnected) => return self.died("NoDeath", "the process ended", last, kind),
            }
        }
    }

    /// The result of a case that ended the child. The next case gets another child.
    fn died(&mut self, law: &str, what: &str, last: Value, kind: Kind) -> Value {
        // The child can no longer report the number of changes; a mesh has none, anything else at most three.
        let mutations = if kind == Kind::Mesh { 0 } else { 3 };
        let status = self.child.wait().unwrap();
        let errors = std::fs::read_to_string(self.scratch.join("errors")).unwrap_or_default();
        let law = if errors.contains("memory allocation of") {
            "InMemory"
        } else {
            law
        };
        // The culprit is the first of ours in the backtrace, whose lines begin with a number.
        let ours: Vec<&str> = errors
            .lines()
            .filter_map(|line| line.trim().split_once(": "))
            .filter(|(_, place)| place.trim_start_matches('<').starts_with("pliant_") && !place.contains("hostile"))
            .map(|(_, place)| place.split(">::").last().unwrap_or(place))
            .take(3)
            .collect();
        let said: String = errors
            .lines()
            .rev()
            .take(2)
            .collect::<Vec<_>>()
            .join(" | ")
            .chars()
            .take(300)
            .collect();
        let what = format!("{what} ({status}): {said} {}", ours.join(" < "));
        *self = Self::start(&self.scratch);
        json!({ "violations": [[law, what]], "last": last, "mutations": mutations })
    }

    /// The random changes that can be left out with the same law still broken.
    fn shrink(&mut self, number: u64, kind: Kind, law: &str, end: &Value) -> Vec<usize> {
        let count = end["mutations"].as_u64().unwrap_or(0) as usize;
        let mut without = Vec::new();
        for mutation in 0..if count > 1 { count } else { 0 } {
            without.push(mutation);
            let again = self.case(number, kind, &without);
            let breaks = again["violations"]
                .as_array()
                .into_iter()
                .flatten()
                .any(|violation| violation[0] == law);
            if !breaks {
                without.pop();
            }
        }
        without
    }
}
