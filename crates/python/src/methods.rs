//! The methods' declarations as dicts.

use pliant_deform::{METHODS, MethodDeclaration, OptionKind, OptionValue};
use pyo3::prelude::*;
use pyo3::types::PyDict;

#[doc = include_str!(concat!(env!("OUT_DIR"), "/methods.txt"))]
#[pyfunction]
pub fn methods(py: Python<'_>) -> PyResult<Bound<'_, PyDict>> {
    let all = PyDict::new(py);
    for declaration in METHODS {
        all.set_item(declaration.name, described(py, declaration)?)?;
    }
    Ok(all)
}

fn described<'py>(py: Python<'py>, declaration: &MethodDeclaration) -> PyResult<Bound<'py, PyDict>> {
    let method = (declaration.default)();
    let options = PyDict::new(py);
    let first_choice = (declaration.first_choice)();
    for option in declaration.options {
        let own = PyDict::new(py);
        for (name, method) in [("default", &method), ("first_choice", &first_choice)] {
            match method.value(option.name) {
                Some(OptionValue::Number(number)) => own.set_item(name, number)?,
                Some(OptionValue::Whole(number)) => own.set_item(name, number)?,
                Some(OptionValue::Name(value)) => own.set_item(name, value)?,
                Some(OptionValue::Switch(on)) => own.set_item(name, on)?,
                None => {}
            }
        }
        match option.kind {
            OptionKind::Number { range, .. } => own.set_item("range", range)?,
            OptionKind::Whole { range } => own.set_item("range", range)?,
            OptionKind::Numbered { choices } => {
                let numbers: Vec<u32> = choices.iter().map(|(number, _)| *number).collect();
                own.set_item("choices", numbers)?;
            }
            OptionKind::Named { choices } => own.set_item("choices", choices)?,
            OptionKind::Switch => {}
        }
        own.set_item("allowed", option.kind.allowed())?;
        let unit = match option.kind {
            OptionKind::Number { unit, .. } => unit,
            _ => "",
        };
        own.set_item("unit", unit)?;
        own.set_item("help", option.help)?;
        options.set_item(option.name, own)?;
    }
    let attachments: Vec<&str> = declaration.attachments.iter().map(|own| own.name).collect();
    let all = PyDict::new(py);
    all.set_item("title", declaration.title)?;
    all.set_item("when_to_use", declaration.when_to_use)?;
    all.set_item("options", options)?;
    all.set_item("attachments", attachments)?;
    Ok(all)
}
