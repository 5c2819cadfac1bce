//! Radial basis functions as one of the methods.

use std::f64::consts::FRAC_PI_2;

use glam::DVec3;

use super::Rbf;
use super::centres::fitted;
use super::constraints::Constraints;
use super::kernel::{Sum, Weights};
use crate::BindError;
use crate::Picture;
use crate::budget::bytes_of;
use crate::handles::turns::Followed;
use crate::method::{BindInput, BoundMethod, DeformMethod, MethodDeclaration};
use crate::needs::{Needs, Solve};
use crate::space::field::{Coefficients, FIELD_ROW, SpaceMap};
use crate::space::linear::BoundLinear;

pub(crate) const DECLARATION: MethodDeclaration = MethodDeclaration {
    name: "rbf",
    title: "Space",
    paper: "radial basis functions",
    when_to_use: "Bends the space around the surface as smoothly as possible, in one step: for scans of loose or \
                  broken pieces. Everything near in space moves along, connected or not.",
    keywords: "basis functions rbf radial triharmonic space points soup warp",
    picture: Picture::Circles,
    slider: None,
    options: Rbf::OPTIONS,
    attachments: &[],
    heeds: &[],
    default: || Rbf::default().into(),
    first_choice: || Rbf::default().into(),
};

/// The field in world units.
struct WorldField<'a> {
    weights: &'a Weights,
    world_origin: DVec3,
    unit: f64,
}

impl SpaceMap for WorldField<'_> {
    fn coefficients(&self, world_points: &[DVec3], out: &mut [Coefficients]) {
        let relative = |point: &DVec3| (*point - self.world_origin) / self.unit;
        let points: Vec<DVec3> = world_points.iter().map(relative).collect();
        let mut sums = vec![Sum::default(); points.len()];
        let count = self.weights.handle_count;
        for handle in 0..count {
            self.weights.evaluate(handle, &points, &mut sums);
            for (out, sum) in out.iter_mut().skip(handle).step_by(count).zip(&sums) {
                out.value = sum[0];
                for k in 0..4 {
                    out.gradient[k] = DVec3::new(sum[1][k], sum[2][k], sum[3][k]) / self.unit;
                }
            }
        }
    }
}

impl DeformMethod for Rbf {
    fn declaration(&self) -> &'static MethodDeclaration {
        &DECLARATION
    }

    /// Between two turns it is their mean, which is narrower by the cosine of half the angle.
    fn follows_turns(&self) -> Option<Followed> {
        Some(Followed::by_limbs(90.0))
    }

    fn needs(&self) -> Needs {
        Needs::Points
    }

    fn solve(&self) -> Solve {
        Solve::Direct
    }

    fn handle_row_bytes(&self) -> usize {
        FIELD_ROW
    }

    fn largest_gap_rad(&self) -> f64 {
        FRAC_PI_2
    }

    fn bind(&self, input: &BindInput<'_>) -> Result<Box<dyn BoundMethod>, BindError> {
        let constraints = Constraints::of(input);
        let most = constraints.points.len().min(self.centres as usize);
        let of_system = bytes_of(most + 4, (most + 4 + 8 * input.handles.len()) * size_of::<f64>());
        let budget = input.partition.budget.without(of_system);
        budget.map_err(|limit| BindError::budget(input.partition.solved.len(), limit))?;
        input.progress.set(0.1);
        let fitted = fitted(self, &constraints.points, input.handles.len(), input.cancel)?;
        input.progress.set(0.5);
        let map = WorldField {
            weights: &fitted.weights,
            world_origin: constraints.world_origin,
            unit: constraints.unit,
        };
        let missed = (fitted.error > self.tolerance).then(|| {
            format!(
                "`rbf` misses its constraints by up to {:.1e} of the handles' motion with {} centres: allow more \
                 `centres`, or a larger `tolerance`",
                fitted.error,
                fitted.weights.centres.len()
            )
        });
        let bound = BoundLinear::bind(&map, missed.into_iter().collect(), input)?;
        input.progress.set(1.0);
        Ok(Box::new(bound))
    }
}
