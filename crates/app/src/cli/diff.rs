//! `pliant diff`: the differences between two files, in words.

use std::fmt::Write as _;

use pliant_io::{Difference, What};
use serde_json::{Value, json};

use super::arguments::DiffArguments;
use super::shared_arguments::ComputeArguments;
use crate::cli::console::{Console, print, print_json};
use crate::cli::threads::on_threads;
use pliant_engine::{Compared, EngineError, differences};

pub(super) fn run(arguments: &DiffArguments, console: &mut Console<'_>) -> Result<(), EngineError> {
    let watch = &console.watch;
    let differences = on_threads(ComputeArguments::default(), || {
        let [first, second] = [&arguments.first, &arguments.second].map(|path| Compared::File(path));
        differences(first, second, watch)
    })??;
    let text = if arguments.json {
        let all: Vec<Value> = differences.iter().map(as_json).collect();
        return print_json(console.out, &json!({ "differences": all }));
    } else if differences.is_empty() {
        "no difference\n".to_owned()
    } else {
        let mut text = String::new();
        for difference in &differences {
            // Writing to a String can't fail.
            let _ = writeln!(text, "{difference}");
        }
        text
    };
    print(console.out, &text)
}

fn as_json(difference: &Difference) -> Value {
    let mut told = json!({ "place": difference.place, "sentence": difference.to_string() });
    if let What::Elements { elements, of, largest } = &difference.what {
        told["elements"] = json!(elements);
        told["of"] = json!(of);
        // JSON has no infinity.
        told["largest"] = if largest.is_finite() {
            json!(largest)
        } else {
            Value::Null
        };
    }
    told
}
