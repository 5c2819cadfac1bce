//! A part of a surface that a flow borrows, shares with others or owns.

use std::ops::Deref;
use std::sync::Arc;

use pliant_mesh::{Model, Surface, Topology};

/// A part of a model, wherever it is.
#[derive(Debug)]
pub(crate) enum Held<'a, T> {
    Lent(&'a T),
    OfModel(Arc<Model>),
    Own(Box<T>),
}

/// A part of a model.
pub(crate) trait PartOfModel {
    fn of(model: &Model) -> &Self;
}

impl PartOfModel for Surface {
    #[inline]
    fn of(model: &Model) -> &Self {
        &model.surface
    }
}

impl PartOfModel for Topology {
    #[inline]
    fn of(model: &Model) -> &Self {
        &model.topology
    }
}

impl<T: PartOfModel> Deref for Held<'_, T> {
    type Target = T;

    #[inline]
    fn deref(&self) -> &T {
        match self {
            Self::Lent(part) => part,
            Self::OfModel(model) => T::of(model),
            Self::Own(part) => part,
        }
    }
}
