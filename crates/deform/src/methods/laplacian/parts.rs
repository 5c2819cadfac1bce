//! Stiff parts: each turns as a whole.
//!
//! Stiffness alone does not keep a part's shape, however large it is: Δp' does not see harmonic displacements, and the
//! vertices' transformations differ. So each connected part C of stiffness above s₁ ([`Level`]) has one rigid motion T_C,
//! which fits it best in the first shape, and the excess over s₁ resists departures:
//!
//! ½ ∫ (s − s₁) (|Δp' − T_C Δp|² + q⁴ |p' − T_C p|²), q = π / r,
//!
//! r being the part's radius. A part with vertices of one handle, or with fixed ones, moves with those; one that has
//! both has only its stiffness. The first shape must not depend on the motions, so only implicit transformations in one
//! step have parts.

use std::f64::consts::PI;

use glam::DVec3;

use crate::handles::{Handle, Motion};
use crate::method::BindInput;
use crate::numerical::rigid_fit::RigidMotion;
use crate::systems::operator::BilaplacianOperator;
use crate::systems::setup::Prescribed;
use crate::systems::stiff_parts::{Guide, Level, hang, stiff_components};

/// A part.
#[derive(Debug)]
struct TurningPart {
    /// Its vertices and its frame.
    handle: Handle,
    guide: Guide,
    members: Vec<Member>,
    /// The rest positions of the members.
    world_rest: Vec<DVec3>,
    /// The places of its springs' anchors in a field, and their coordinates.
    anchors: Prescribed,
}

/// A vertex of a part that has a row.
#[derive(Debug)]
struct Member {
    local: u32,
    /// (s − s₁) / s, s without what belongs to higher levels.
    share: f64,
}

/// The parts of a bound problem.
#[derive(Debug, Default)]
pub(super) struct TurningParts(Vec<TurningPart>);

impl TurningParts {
    /// Ties the parts of the problem to their anchors.
    pub fn attach(operator: &mut BilaplacianOperator, input: &BindInput<'_>) -> Self {
        let problem = input.problem;
        let levels = Level::all(operator, problem);
        let mut parts = Vec::new();
        for level in &levels {
            let components = stiff_components(operator, &input.partition.triangulation, problem, level);
            parts.extend(components.into_iter().map(|component| (component, level)));
        }
        let part = |((vertices, guide), level): ((Vec<u32>, Guide), &Level)| {
            let excess = |vertex: u32| level.excess(problem, vertex);
            let handle = Handle::new(vertices, &problem.surface.positions);
            let anchors = hang(operator, problem, &handle, PI / handle.radius, &excess);
            let (mut members, mut world_rest) = (Vec::new(), Vec::new());
            for &vertex in &handle.vertices {
                if let Some(local) = operator.laplacian.local(vertex) {
                    let share = level.share(problem, vertex);
                    members.push(Member {
                        local: local as u32,
                        share,
                    });
                    world_rest.push(problem.surface.positions[vertex as usize]);
                }
            }
            TurningPart {
                handle,
                guide,
                members,
                world_rest,
                anchors,
            }
        };
        Self(parts.into_iter().map(part).collect())
    }

    /// Returns true if nothing turns as a whole.
    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// Finds the parts' motions from the first shape, which is in `field`, moves the anchors there, and blends
    /// (T_C − I) L p into the changes of the parts' vertices.
    pub fn turn(
        &self,
        motions: &[Motion],
        handles: &[Handle],
        curvature: &[DVec3],
        field: &mut [[f64; 3]],
        changes: &mut [DVec3],
    ) {
        for part in &self.0 {
            let motion = part.motion(motions, handles, field);
            for &(place, coordinates) in &part.anchors {
                field[place as usize] = motion.displace(coordinates).to_array();
            }
            let turn = motion.linear * part.handle.radius.recip();
            for member in &part.members {
                let local = member.local as usize;
                let change = &mut changes[local];
                *change += (turn * curvature[local] - *change) * member.share;
            }
        }
    }

    /// Copies the anchors' rows from one field to another.
    pub fn copy_anchors(&self, from: &[[f64; 3]], to: &mut [[f64; 3]]) {
        for &(place, _) in self.0.iter().flat_map(|part| &part.anchors) {
            to[place as usize] = from[place as usize];
        }
    }
}

impl TurningPart {
    /// T_C − I in the part's coordinates.
    fn motion(&self, motions: &[Motion], handles: &[Handle], field: &[[f64; 3]]) -> Motion {
        match self.guide {
            Guide::Fixed => Motion::default(),
            Guide::Handle(handle) => {
                let handle = usize::from(handle);
                self.handle.following(&handles[handle], &motions[handle])
            }
            Guide::Free => {
                let moved = self.members.iter();
                let moved: Vec<DVec3> = moved
                    .map(|member| DVec3::from_array(field[member.local as usize]))
                    .collect();
                let fit = RigidMotion::fit(&self.world_rest, &moved);
                fit.map_or(Motion::default(), |fit| self.handle.rigid_motion(&fit))
            }
        }
    }
}
