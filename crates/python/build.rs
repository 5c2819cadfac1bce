//! Writes each docstring of the stub to its own file, which the sources include. macOS links Python's symbols only when
//! the module is loaded.

use std::path::Path;
use std::{env, fs, io};

const STUB: &str = "python/pliant/__init__.pyi";

fn main() -> io::Result<()> {
    pyo3_build_config::add_extension_module_link_args();
    println!("cargo::rerun-if-changed={STUB}");
    println!("cargo::rerun-if-changed=build.rs");
    let folder = env::var_os("OUT_DIR").ok_or(io::ErrorKind::NotFound)?;
    for (name, text) in docstrings(&fs::read_to_string(STUB)?) {
        fs::write(Path::new(&folder).join(format!("{name}.txt")), text)?;
    }
    Ok(())
}

/// Each function's, class's and member's docstring by its name: `bind`, `Mesh`, `Mesh.vertices`.
fn docstrings(stub: &str) -> Vec<(String, String)> {
    let mut found = Vec::new();
    let mut class = String::new();
    // The name for the next docstring.
    let mut of = None;
    let mut lines = stub.lines();
    while let Some(line) = lines.next() {
        let inner = line.trim_start();
        let indent = line.len() - inner.len();
        if let Some(name) = called(inner, "class ") {
            name.clone_into(&mut class);
            of = Some(class.clone());
        } else if let Some(name) = called(inner, "def ") {
            of = Some(match indent {
                0 => name.to_owned(),
                _ => format!("{class}.{name}"),
            });
            // Its parameters may be on separate lines.
            let mut last = line;
            while !last.ends_with(':') && !last.ends_with("...") {
                let Some(next) = lines.next() else { break };
                last = next;
            }
        } else if let Some(first) = inner.strip_prefix("\"\"\"") {
            let mut text = first.to_owned();
            while !text.ends_with("\"\"\"") {
                let Some(next) = lines.next() else { break };
                let own = next.get(indent..).unwrap_or_else(|| next.trim_start());
                text = text + "\n" + own;
            }
            let text = text.trim_end_matches("\"\"\"").trim_end().to_owned();
            found.extend(of.take().map(|name| (name, text)));
        } else if inner.starts_with('@') || inner.contains(" = ") || indent == 0 && inner.contains(": ") {
            of = None;
        }
    }
    found
}

/// The name that a line defines after `keyword`.
fn called<'a>(line: &'a str, keyword: &str) -> Option<&'a str> {
    let rest = line.strip_prefix(keyword)?;
    rest.split(['(', ':']).next()
}
