//! Flow on surfaces: an incompressible fluid on a triangle mesh, which carries dye [SY04, Sta99].
//!
//! The velocity is tangent and constant on each triangle. A step adds forces (`forces`), carries velocity and dye along
//! the velocity (`advection`, on ways across triangles: `trace`), smooths it by viscosity (`viscosity`) and takes its
//! divergence out by pressure (`projection`), which solves the Poisson equation with the same factored Laplacian as the
//! deformation method `poisson`. The factor is made once. `conservation` keeps the dye.
//!
//! All of this needs only the triangles' own planes (`chart`), their hinges (`hinges`) and the tangent planes of vertices
//! (`fans`). Fluid slips along borders; components are apart; a surface is cut where it is no manifold (`sheets`). The
//! crate uses no clock, no file and no thread of its own, and results don't depend on the number of threads.
//!
//! A sphere that turns with a red cap:
//!
//! ```
//! use glam::DVec3;
//! use pliant_deform::Budget;
//! use pliant_flow::{Flow, FlowSettings};
//! use pliant_mesh::{Cancel, Progress, shapes};
//!
//! let model = shapes::model(shapes::icosphere(4));
//! let (progress, cancel) = (Progress::new(), Cancel::new());
//! let mut flow = Flow::bind(&model.surface, &model.topology, Budget::default(), &progress, &cancel)?;
//! let positions = &model.surface.positions;
//! let cap: Vec<f64> = positions.iter().map(|p| f64::from(u8::from(p.x > 0.7))).collect();
//! flow.pour(&cap, [1.0, 0.0, 0.0]);
//! flow.add_velocity(&vec![1.0; positions.len()], |p| DVec3::Z.cross(p));
//!
//! for _ in 0..20 {
//!     flow.step(0.05, &FlowSettings::default(), &cancel)?;
//! }
//! // The cap has turned by 1 radian.
//! let middle: DVec3 = positions.iter().zip(flow.dyes()).map(|(p, dye)| *p * dye[3]).sum();
//! assert!((middle.y.atan2(middle.x) - 1.0).abs() < 0.05);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod advection;
mod chart;
mod conservation;
mod corners;
mod crossings;
mod domain;
mod dye;
mod energy;
mod error;
mod fans;
mod flow;
mod fluid;
mod forces;
mod held;
mod hinges;
mod lanes;
mod plane;
mod projection;
mod settings;
mod sheets;
mod slide;
mod starts;
mod sums;
mod trace;
mod viscosity;

pub use error::FlowError;
pub use flow::Flow;
pub use settings::{Advection, FlowSettings};
