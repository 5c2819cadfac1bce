//! Queries the shown parts of the present binding: the weights of a handle, and the smooth base bent by the handles.

use std::sync::{Arc, PoisonError};

use glam::DVec3;
use pliant_deform::Bound;

use super::computed::Computed;
use super::inspected::{Asked, Inspected};
use super::slot::Work;
use super::solving::{present_lines, targets};
use crate::bending::Targets;
use crate::document::{Document, HandleId, sum_of_shapes};

/// Queries the present binding; `None` while there is none.
pub(super) fn inspect_work(computed: &Computed, document: &Document, asked: Asked) -> Option<Work<Inspected>> {
    let binding = computed.slots.bind.last()?;
    let bound = Arc::clone(&binding.bound);
    let handles = computed.region.handles.clone();
    let is_base_wanted = asked.base && computed.inspectable().base;
    let targets = is_base_wanted
        .then(|| targets(document, &document.method, &handles))
        .flatten();
    let targets =
        targets.map(|targets| targets.along(&present_lines(&binding.lines, document, &handles), document.strength()));
    let rest = document.applied.then(|| Arc::clone(&document.rest));
    Some(Box::new(move |_, cancel| {
        cancel.check()?;
        let mut bound = bound.lock().unwrap_or_else(PoisonError::into_inner);
        let number = |id: HandleId| handles.iter().position(|handle| *handle == id);
        let weights = asked.weights_of.and_then(number);
        let base = targets.and_then(|targets| bent_base(&mut bound, &targets));
        Ok(Inspected {
            weights: weights.and_then(|number| bound.handle_weights(number)).map(Arc::new),
            base: base.map(|base| sum_of_shapes(rest.as_ref(), &Arc::new(base))),
        })
    }))
}

/// The smooth base bent by the handles with these targets, from the rest shape; `None` if that can't be solved, which
/// the solve itself reports.
///
/// The last solve may have been for other targets than the document's, for example after undo, so this solves again:
/// only linear methods have a base, and their result does not depend on the start.
fn bent_base(bound: &mut Bound, targets: &Targets) -> Option<Vec<DVec3>> {
    let mut base = vec![DVec3::ZERO; bound.vertex_count()];
    targets.set(bound).ok()?;
    bound.step(&mut base).ok()?;
    bound.base(&mut base).then_some(base)
}
