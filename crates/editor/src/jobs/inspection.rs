//! Looks up what a person looks at of the present binding: the weights of a handle, and the smooth base.

use std::sync::{Arc, PoisonError};

use super::computed::Computed;
use super::inspected::{Asked, Inspected};
use super::job::{JobOutcome, Work};
use crate::document::HandleId;

/// Looks into the present binding; `None` while there is none.
pub(super) fn inspect_work(computed: &Computed, asked: Asked) -> Option<Work> {
    let (bound, model) = (computed.bound.clone()?, computed.model.clone()?);
    let region = computed.region.clone();
    Some(Box::new(move |_, cancel| {
        if cancel.is_cancelled() {
            return JobOutcome::Cancelled;
        }
        let bound = bound.lock().unwrap_or_else(PoisonError::into_inner);
        let number = |id: HandleId| region.handles.iter().position(|handle| *handle == id);
        let weights = asked.weights_of.and_then(number);
        let base = || {
            let surface = region.rest_surface.as_deref().unwrap_or(&model.surface);
            let mut positions = surface.positions.clone();
            bound.base(&mut positions).then(|| {
                let file = model.surface.positions.iter();
                Arc::new(file.zip(&positions).map(|(file, base)| *base - *file).collect())
            })
        };
        JobOutcome::Inspected(Inspected {
            weights: weights.and_then(|number| bound.handle_weights(number)).map(Arc::new),
            base: asked.base.then(base).flatten(),
        })
    }))
}
