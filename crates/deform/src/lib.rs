//! The core solver: a surface, the roles of its vertices and a method in; displacements out.
//!
//! Rates of change are types: [`Ordering`] changes with the mesh, [`Bound`] with roles, stiffness and options, and a
//! [`Bound::step`] with the handles' transforms. The crate uses no clock, no file and no thread of its own: rayon's
//! current pool is the caller's, and every result is the same bit for bit for every size of the pool.
//!
//! Binding goes from the [`Problem`] through `region` (the solved vertices) to the [`Laplacian`] (`operators`), to a
//! matrix in the restricted [`Ordering`], which is factored (`sparse`), and to the method: `bilaplacian` gives
//! [`HandleBases`], so that a frame is a product with them; `arap` shares everything up to the factor and takes as many
//! steps as it needs; `primo` steps with rigid prisms, `shells` with edges' lengths and angles; `wrinkles` adds learnt
//! details to the bi-Laplacian; `poisson` spreads the handles' turns and solves for the surface that fits them,
//! `laplacian` does so with differential coordinates, and `frames` solves for the turns first. `rbf`, `mls`,
//! `embedded`, `lattice` and `cage` bend the space around points, connected or not (`space`).
//!
//! A bar whose one end is held while its other, the handle, is lifted:
//!
//! ```
//! use glam::{DAffine3, DVec3};
//! use pliant_deform::{Method, Problem, Role};
//! use pliant_mesh::{Cancel, Progress, shapes};
//!
//! let model = shapes::model(shapes::bar(10, 2, 2));
//! let roles: Vec<Role> = (model.surface.positions.iter())
//!     .map(|position| match position.x {
//!         x if x < 1.5 => Role::Fixed,
//!         x if x > 8.5 => Role::Handle(0),
//!         _ => Role::Free,
//!     })
//!     .collect();
//! let method = Method::from_name("arap").unwrap_or_default();
//! let (progress, cancel) = (Progress::new(), Cancel::new());
//! let stiffness = vec![1.0; roles.len()];
//! let problem = Problem::new((&model.surface, &model.topology), &roles, &stiffness, &method);
//! let ordering = method.ordering(&model.topology, &progress, &cancel)?;
//! let mut bound = problem.bind(&ordering, &progress, &cancel)?;
//!
//! let lift = DVec3::new(0.0, 0.0, 3.0);
//! bound.set_targets(&[DAffine3::from_translation(lift)])?;
//! let mut displacements = vec![DVec3::ZERO; roles.len()];
//! while !bound.step(&mut displacements)?.finished {}
//!
//! for ((position, role), displacement) in model.surface.positions.iter().zip(&roles).zip(&displacements) {
//!     match role {
//!         Role::Fixed => assert_eq!(*displacement, DVec3::ZERO),
//!         Role::Handle(_) => assert_eq!(*displacement, lift),
//!         Role::Free if position.x == 5.0 => assert!((displacement.z - 1.5).abs() < 0.2, "half way"),
//!         Role::Free => {}
//!     }
//! }
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod attachment;
mod attachment_refused;
mod bound;
mod budget;
mod coarse;
mod descent;
mod error;
mod fairing;
mod handles;
mod iteration;
mod method;
mod methods;
mod needs;
mod numerical;
mod operators;
mod option;
mod picture;
mod problem;
mod region;
mod registry;
mod remedy;
mod rigid;
mod role;
mod space;
mod sparse;
#[doc(hidden)]
pub mod stages;
mod systems;
mod transfer;
mod warning;

pub use attachment::{
    Attachment, AttachmentDeclaration, AttachmentKind, ControlLattice, ControlMesh, ExampleShape, Examples,
    LARGEST_WEIGHT,
};
pub use attachment_refused::AttachmentRefused;
pub use bound::{Accuracy, Bound, Step, Target, TurnedMap, Valley};
pub use budget::{Budget, Limit};
pub use error::{BindError, Crowded, SolveError};
pub use fairing::fair;
pub use handles::bases::HandleBases;
pub use method::{Method, MethodDeclaration};
pub use methods::arap::{Arap, ArapEnergy};
pub use methods::bilaplacian::{Bilaplacian, BilaplacianOrder, Detail};
pub use methods::cage::{Cage, CageCoordinates};
pub use methods::embedded::Embedded;
pub use methods::frames::Frames;
pub use methods::laplacian::{LaplacianEditing, LocalScale, Transforms};
pub use methods::lattice::{Lattice, LatticeBasis, LatticeNorm};
pub use methods::mls::{Mls, MlsTransforms};
pub use methods::poisson::{Poisson, Propagation};
pub use methods::primo::Primo;
pub use methods::rbf::Rbf;
pub use methods::shells::Shells;
pub use methods::space_primo::SpacePrimo;
pub use methods::wrinkles::Wrinkles;
pub use needs::{ConstraintKind, HandleFit, Needs, Solve};
pub use numerical::rigid_fit::RigidMotion;
pub use operators::discretisation::{Discretisation, TriangulationKind};
pub use operators::{Laplacian, mollified_lengths};
pub use option::{OptionDeclaration, OptionKind, OptionRefused, OptionSlider, OptionValue};
pub use picture::Picture;
pub use problem::Problem;
pub use region::constraints::{CONTINUITY_RANGE, Constraints};
pub use registry::METHODS;
pub use remedy::Remedy;
pub use role::{Loose, Role};
pub use sparse::Ordering;
pub use sparse::refactorisation::ReusableFactor;
pub use systems::poisson_equation::PoissonEquation;
pub use transfer::{DeformationTransfer, PosedShape};
pub use warning::Warning;
