//! Errors, each in one sentence that names the culprit and the remedy.

use pliant_mesh::{Cancelled, SurfaceVertex, Topology};

use crate::{AttachmentRefused, Budget, Limit, Remedy};

/// A problem could not be bound. Vertices are the surface's, until they are [`BindError::renumbered`].
#[derive(Clone, PartialEq, Debug, thiserror::Error)]
#[non_exhaustive]
pub enum BindError {
    /// The flag was raised.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
    /// A table's length differs from the surface's.
    #[error("{table} has {found} entries, but {expected} are expected: give one for each")]
    Length {
        /// The table.
        table: &'static str,
        /// Its length.
        found: usize,
        /// The expected length.
        expected: usize,
    },
    /// A vertex belongs to a handle that does not exist.
    #[error(
        "vertex {vertex} belongs to handle {handle}, but there are {handle_count} handles: add the handle or free the vertex"
    )]
    UnknownHandle {
        /// The vertex.
        vertex: u32,
        /// Its handle.
        handle: u16,
        /// The number of handles.
        handle_count: usize,
    },
    /// A handle without vertices.
    #[error("handle {handle} has no vertex: select at least one for it or remove it")]
    EmptyHandle {
        /// The handle.
        handle: usize,
    },
    /// A stiffness that is not a positive number.
    #[error("the stiffness {value} of vertex {vertex} is not a number above 0: paint it again")]
    Stiffness {
        /// The vertex.
        vertex: u32,
        /// Its stiffness.
        value: f64,
    },
    /// Rigid paint on too many separate parts.
    #[error(
        "{found} separate parts are painted rigid, and {most} can move as bodies: paint fewer, or paint a stiffness of 1000"
    )]
    RigidParts {
        /// The number of parts.
        found: usize,
        /// The allowed number.
        most: usize,
    },
    /// A soft handle's weight that is not allowed.
    #[error("the weight {value} of soft handle {handle} is not a number above 0: give it one, or make it hard")]
    SoftWeight {
        /// The handle.
        handle: usize,
        /// Its weight.
        value: f64,
    },
    /// A continuity that is not from 0 to 2.
    #[error("the continuity {value} of vertex {vertex} is not a number from 0 to 2: paint it again")]
    Continuity {
        /// The vertex.
        vertex: u32,
        /// Its continuity.
        value: f64,
    },
    /// An attachment can't be used.
    #[error("the {title} {refused}")]
    Attachment {
        /// Its label for a person.
        title: &'static str,
        /// Its fault.
        refused: AttachmentRefused,
    },
    /// The surface has only points, and the method bends surfaces.
    #[error(
        "the file has no triangle, but {method} bends surfaces: take {}, which bend points and lines",
        Remedy::OfSpace
    )]
    NoTriangles {
        /// The method's name.
        method: &'static str,
    },
    /// The ordering was made for another mesh or another power.
    #[error(
        "the ordering is for {found} vertices and power {found_power}, not for {expected} vertices and power \
         {expected_power}: make one from this surface"
    )]
    Ordering {
        /// The ordering's vertices.
        found: usize,
        /// The ordering's power.
        found_power: u32,
        /// The surface's vertices.
        expected: usize,
        /// The method's power.
        expected_power: u32,
    },
    /// The method needs an ordering.
    #[error("the method needs an ordering of power {expected_power}: make one from this surface")]
    NoOrdering {
        /// The method's power.
        expected_power: u32,
    },
    /// A rest position that is not finite.
    #[error("vertex {vertex} has no finite position: weld the surface again")]
    Position {
        /// The vertex.
        vertex: u32,
    },
    /// The system is not positive definite, even with a little regularisation.
    #[error(
        "component {component} cannot be solved for at vertex {vertex}: fix vertices around it, repair the triangles there, or take {}",
        Remedy::OfSpace
    )]
    NotPositiveDefinite {
        /// The component, as numbered in the edit format (`docs/edit-format.md`).
        component: u32,
        /// The vertex whose pivot failed.
        vertex: u32,
    },
    /// The factor does not reproduce a constant.
    #[error(
        "component {component} is solved only to {error:.1e} near vertex {vertex}: fix vertices around it, repair the triangles there, or take {}",
        Remedy::OfSpace
    )]
    Inaccurate {
        /// The component, as numbered in the edit format (`docs/edit-format.md`).
        component: u32,
        /// The vertex with the largest error.
        vertex: u32,
        /// The error of a constant.
        error: f64,
    },
    /// A bi-Laplacian of an order above 1 was refused; a lower order may work.
    #[error("{refused}, or lower the method's `order` from {order}")]
    Order {
        /// The bi-Laplacian's order.
        order: u32,
        /// The reason for the refusal.
        refused: Box<BindError>,
    },
    /// The solved region is too long and thin for the computation.
    #[error(
        "vertex {vertex} is {edges} edges from the nearest fixed vertex or handle, too far to be solved for: fix \
         vertices between them, make the mesh coarser, {}or take {}",
        .order.map_or(String::new(), |order| format!("lower the method's `order` from {order}, ")),
        Remedy::OfSpace
    )]
    Slender {
        /// The vertex that is farthest.
        vertex: u32,
        /// The number of edges between it and the nearest fixed vertex or handle.
        edges: usize,
        /// The bi-Laplacian's order, if that is the method.
        order: Option<u32>,
    },
    /// Binding would exceed its [`crate::Budget`].
    #[error("{}", over_budget(*.free_count, *.limit, .crowded.as_ref()))]
    Budget {
        /// The number of solved vertices.
        free_count: usize,
        /// The budget's limit.
        limit: Limit,
        /// The vertex with the most neighbours, if it has many.
        crowded: Option<Crowded>,
    },
    /// The handles' tables together would exceed the [`crate::Budget`].
    #[error(
        "{handle_count} handles over {free_count} free vertices take more memory than allowed: join handles, make the region smaller, or take {}",
        Remedy::OfSpaceForManyHandles
    )]
    Handles {
        /// The number of handles.
        handle_count: usize,
        /// The number of solved vertices.
        free_count: usize,
    },
    /// The factor does not fit.
    #[error(
        "the factor of {free_count} free vertices does not fit into memory: make the region smaller, or take {}",
        Remedy::OfSpace
    )]
    OutOfMemory {
        /// The number of solved vertices.
        free_count: usize,
    },
}

/// A vertex with very many neighbours.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Crowded {
    /// The vertex.
    pub vertex: u32,
    /// The number of its neighbours.
    pub neighbours: usize,
}

/// A vertex of fewer neighbours than this is no culprit.
const CROWD: usize = 100;

fn over_budget(free_count: usize, limit: Limit, crowded: Option<&Crowded>) -> String {
    let allowed = match limit {
        Limit::Bytes(bytes) if bytes < 1 << 30 => format!("{} MiB of memory", bytes >> 20),
        Limit::Bytes(bytes) => format!("{:.1} GiB of memory", bytes as f64 / f64::from(1 << 30)),
        Limit::Operations(operations) => format!("{:.0e} operations", operations as f64),
    };
    let remedy = match (crowded, limit) {
        (Some(Crowded { vertex, neighbours }), _) => {
            let space = Remedy::OfSpace;
            format!(
                "split vertex {vertex}, which has {neighbours} neighbours, make the region smaller, or take {space}"
            )
        }
        (None, Limit::Bytes(_)) => format!(
            "make the region smaller or the mesh coarser, or take {}",
            Remedy::OfSpace
        ),
        (None, Limit::Operations(_)) => format!(
            "make the region smaller or the mesh coarser, move apart vertices that coincide by accident, or take {}",
            Remedy::OfSpace
        ),
    };
    format!("solving for {free_count} free vertices takes more than the {allowed} allowed: {remedy}")
}

impl BindError {
    /// The refusal for this many free vertices, which exceed the remaining budget; the binding fills in the other
    /// facts.
    pub(crate) fn budget(free_count: usize, limit: Limit) -> Self {
        Self::Budget {
            free_count,
            limit,
            crowded: None,
        }
    }

    /// Adds the budget and the vertex with the most neighbours, if the refusal is for memory.
    pub(crate) fn with_culprit(mut self, topology: &Topology, budget: Budget) -> Self {
        if let Self::Budget { limit, crowded, .. } = &mut self {
            if let Limit::Bytes(bytes) = limit {
                *bytes = budget.bytes;
            }
            let count = |vertex: u32| topology.neighbours(SurfaceVertex(vertex)).len();
            let most = (0..topology.vertex_count() as u32).max_by_key(|&vertex| count(vertex));
            *crowded = most.filter(|&vertex| count(vertex) >= CROWD).map(|vertex| Crowded {
                vertex,
                neighbours: count(vertex),
            });
        }
        self
    }

    /// The vertex of the refusal.
    pub fn vertex(&self) -> Option<u32> {
        match self {
            Self::UnknownHandle { vertex, .. }
            | Self::Stiffness { vertex, .. }
            | Self::Continuity { vertex, .. }
            | Self::Position { vertex }
            | Self::Slender { vertex, .. }
            | Self::NotPositiveDefinite { vertex, .. }
            | Self::Inaccurate { vertex, .. } => Some(*vertex),
            Self::Budget { crowded, .. } => crowded.map(|crowded| crowded.vertex),
            Self::Order { refused, .. } => refused.vertex(),
            _ => None,
        }
    }

    /// The error with the file's vertex instead of the surface's.
    #[must_use]
    pub fn renumbered(mut self, known: impl Fn(u32) -> u32) -> Self {
        match &mut self {
            Self::UnknownHandle { vertex, .. }
            | Self::Stiffness { vertex, .. }
            | Self::Continuity { vertex, .. }
            | Self::Position { vertex }
            | Self::Slender { vertex, .. }
            | Self::NotPositiveDefinite { vertex, .. }
            | Self::Inaccurate { vertex, .. } => *vertex = known(*vertex),
            Self::Budget {
                crowded: Some(crowded), ..
            } => crowded.vertex = known(crowded.vertex),
            Self::Order { refused, .. } => **refused = refused.as_ref().clone().renumbered(known),
            _ => {}
        }
        self
    }
}

impl SolveError {
    /// Like [`BindError::renumbered`].
    #[must_use]
    pub fn renumbered(mut self, known: impl Fn(u32) -> u32) -> Self {
        if let Self::NotFinite { vertex } = &mut self {
            *vertex = known(*vertex);
        }
        self
    }
}

/// A step failed; the displacements are then all zero.
#[derive(Clone, PartialEq, Debug, thiserror::Error)]
#[non_exhaustive]
pub enum SolveError {
    /// The number of transforms is not the number of handles.
    #[error("{found} transforms are given for {expected} handles: give one for each")]
    TargetCount {
        /// The number of transforms.
        found: usize,
        /// The number of handles.
        expected: usize,
    },
    /// A transform contains a NaN or an infinity.
    #[error("the transform of handle {handle} is not finite: reset it")]
    TargetNotFinite {
        /// The handle.
        handle: usize,
    },
    /// A direction along which a handle is free has no length, or contains a NaN or an infinity.
    #[error("the free direction of handle {handle} is none: give three finite numbers, not all 0")]
    NoDirection {
        /// The handle.
        handle: usize,
    },
    /// A handle's vertices have places, and the method takes no places.
    #[error(
        "{method} moves a handle as a whole and takes no positions for its vertices: give a transform, or take {}",
        Remedy::TakingPlaces
    )]
    NoPlaces {
        /// The method.
        method: &'static str,
    },
    /// The number of places is not the number of the handle's vertices.
    #[error("{found} positions are given for the {expected} surface vertices of handle {handle}: give one for each")]
    PlaceCount {
        /// The handle.
        handle: usize,
        /// The given number.
        found: usize,
        /// The number of the handle's vertices.
        expected: usize,
    },
    /// A place holds a NaN or an infinity.
    #[error("the position of vertex {vertex} of handle {handle} is not finite: give a finite one")]
    PlaceNotFinite {
        /// The handle.
        handle: usize,
        /// The vertex.
        vertex: u32,
    },
    /// The moved control points do not fit those of the binding.
    #[error("the {title} {refused}")]
    Controls {
        /// The attachment's label for a person.
        title: &'static str,
        /// Their fault.
        refused: AttachmentRefused,
    },
    /// Control points were moved, but the binding has none.
    #[error("the binding has no control points to move: bind with a cage or a lattice")]
    NoControls,
    /// The output's length differs from the surface's.
    #[error("room for {found} displacements was given for {expected} surface vertices: give one for each")]
    OutputLength {
        /// The output's length.
        found: usize,
        /// The surface's vertices.
        expected: usize,
    },
    /// The solution did not settle.
    #[error(
        "the surface was solved only to {error:.1e} of its motion: fix more vertices, repair its triangles, or take {}",
        Remedy::OfSpace
    )]
    Inaccurate {
        /// An estimate of the error, relative to the largest displacement.
        error: f64,
    },
    /// The energy is too large for the computation.
    #[error("the energy of the bent surface is not finite: move the handles less far or scale the model down")]
    EnergyNotFinite,
    /// A displacement is not finite.
    #[error("the displacement of vertex {vertex} is not finite: move the handles less far")]
    NotFinite {
        /// The first vertex with such a displacement.
        vertex: u32,
    },
}

#[cfg(test)]
mod tests {
    use super::{BindError, SolveError};

    #[test]
    fn a_renumbered_error_names_the_vertex_that_a_person_knows() {
        let refused = BindError::NotPositiveDefinite {
            component: 2,
            vertex: 7,
        };
        let nested = BindError::Order {
            order: 3,
            refused: Box::new(refused.clone()),
        };
        for error in [refused, nested, BindError::Position { vertex: 7 }] {
            assert_eq!(error.vertex(), Some(7));
            let known = error.renumbered(|vertex| vertex + 90);
            assert_eq!(known.vertex(), Some(97));
            assert!(known.to_string().contains("vertex 97"), "{known}");
        }
        let known = SolveError::NotFinite { vertex: 7 }.renumbered(|vertex| vertex + 90);
        assert!(known.to_string().contains("vertex 97"), "{known}");
        assert_eq!(BindError::EmptyHandle { handle: 7 }.renumbered(|_| 97).vertex(), None);
    }
}
