//! The smallest method: only handles move.
//!
//! It shows the parts of a method (this folder and its line in [`crate::METHODS`]), works on bare points, and is
//! compiled for tests only (the feature `identity-method`).

use glam::DVec3;

use crate::handles::finite::Finite;
use crate::handles::{Motion, clear};
use crate::method::{BindInput, BoundMethod, DeformMethod, MethodDeclaration, Stepped};
use crate::needs::{Needs, Solve};
use crate::option::{Number, options};
use crate::{BindError, Picture, SolveError};

pub(crate) const DECLARATION: MethodDeclaration = MethodDeclaration {
    name: "identity",
    title: "Handles alone",
    paper: "identity",
    when_to_use: "Moves the handles and leaves the rest in place.",
    keywords: "identity nothing",
    picture: Picture::Bar,
    slider: None,
    options: Identity::OPTIONS,
    attachments: &[],
    heeds: &[],
    default: || Identity::default().into(),
    first_choice: || Identity::default().into(),
};

options! {
    /// Options of the identity.
    pub struct Identity {
        /// The share of the handles' displacements that they move by.
        share: f64 = Number {
            default: 1.0,
            range: [0.0, 1.0],
            unit: "",
            help: "share of the handles' motion",
        },
    }
}

/// The handles' vertices and their coordinates.
#[derive(Debug)]
struct BoundIdentity {
    share: f64,
    handles: Vec<Vec<(u32, [f64; 4])>>,
}

impl DeformMethod for Identity {
    fn declaration(&self) -> &'static MethodDeclaration {
        &DECLARATION
    }

    fn needs(&self) -> Needs {
        Needs::Points
    }

    fn solve(&self) -> Solve {
        Solve::Direct
    }

    fn bind(&self, input: &BindInput<'_>) -> Result<Box<dyn BoundMethod>, BindError> {
        let positions = &input.problem.surface.positions;
        let handles = input.handles.iter().map(|handle| {
            let vertices = handle.vertices.iter();
            vertices
                .map(|&vertex| (vertex, handle.coordinates(positions[vertex as usize])))
                .collect()
        });
        Ok(Box::new(BoundIdentity {
            share: self.share,
            handles: handles.collect(),
        }))
    }
}

impl BoundMethod for BoundIdentity {
    fn step(&mut self, motions: &[Motion], displacements: &mut [DVec3]) -> Result<Stepped, SolveError> {
        clear(displacements);
        for (own, motion) in self.handles.iter().zip(motions) {
            for &(vertex, coordinates) in own {
                displacements[vertex as usize] = motion.displace(coordinates) * self.share;
            }
        }
        Ok(Stepped::at_once(0.0, Finite::Unknown))
    }

    fn solved_count(&self) -> usize {
        0
    }
}
