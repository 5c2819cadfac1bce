//! The method's examples: kept poses, and their weights.

use std::sync::Arc;

use pliant_deform::{Attachment, ExampleShape, Examples};

use super::state::Workspace;
use crate::document::Document;

/// Keeps the present shape as a further example.
pub(crate) fn keep_example(workspace: &mut Workspace) {
    let displacements = Arc::clone(&workspace.document.from_rest);
    let name = numbered("example", &workspace.document);
    push(workspace, "Keep example", ExampleShape { name, displacements });
}

/// Adds a shape, with displacements from the file's shape, as a further example.
pub(crate) fn add_example(workspace: &mut Workspace, shape: ExampleShape) {
    let document = &workspace.document;
    let from_file = shape.displacements.iter().zip(document.rest());
    let displacements = Arc::new(from_file.map(|(displacement, rest)| *displacement - *rest).collect());
    let name = match &*shape.name {
        "" => numbered("example", document),
        own if names(document).any(|name| name == own) => numbered(own, document),
        _ => shape.name,
    };
    push(workspace, "Add example", ExampleShape { name, displacements });
}

/// Adds an example. If its weight bends the surface it is 0, so that nothing moves.
fn push(workspace: &mut Workspace, step: &'static str, shape: ExampleShape) {
    let weight = workspace.document.method().examples_bend().then_some(0.0);
    change(workspace, step, |examples| {
        Arc::make_mut(&mut examples.shapes).push(shape);
        examples.weights.push(weight);
    });
}

/// Sets the weight of an example; with `None` the solver finds it.
pub(crate) fn set_example_weight(workspace: &mut Workspace, place: usize, weight: Option<f64>) {
    change(workspace, "Change example weight", |examples| {
        if let Some(own) = examples.weights.get_mut(place) {
            *own = weight;
        }
    });
}

/// Renames an example.
pub(crate) fn rename_example(workspace: &mut Workspace, place: usize, name: String) {
    change(workspace, "Rename example", |examples| {
        if let Some(own) = Arc::make_mut(&mut examples.shapes).get_mut(place) {
            own.name = name;
        }
    });
}

/// Removes an example.
pub(crate) fn remove_example(workspace: &mut Workspace, place: usize) {
    change(workspace, "Remove example", |examples| {
        if place < examples.weights.len() {
            Arc::make_mut(&mut examples.shapes).remove(place);
            examples.weights.remove(place);
        }
    });
}

fn change(workspace: &mut Workspace, name: &'static str, change: impl FnOnce(&mut Examples)) {
    workspace.change(name, |document| {
        let Some(name) = document.examples_name() else { return };
        let mut examples = document.examples().cloned().unwrap_or_default();
        change(&mut examples);
        let mut attachments = Arc::clone(&document.attachments);
        let all = Arc::make_mut(&mut attachments);
        let before = match examples.shapes.is_empty() {
            true => all.remove(name),
            false => all.insert(name, Attachment::Shapes(examples)),
        };
        if before.as_ref() != attachments.get(name) {
            document.unsettle();
            document.set_attachments(attachments);
        }
    });
}

/// The name with the first number that no example has.
fn numbered(name: &str, document: &Document) -> String {
    let number = (1..).find(|number| names(document).all(|other| other != format!("{name} {number}")));
    format!("{name} {}", number.unwrap_or(1))
}

fn names(document: &Document) -> impl Iterator<Item = &str> {
    let shapes = document.examples().map_or(&[][..], |examples| &examples.shapes);
    shapes.iter().map(|shape| &*shape.name)
}
