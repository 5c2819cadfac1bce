//! Embedded deformation [SSP07]: a graph of nodes spread over the shape, each with an affine map, whose blend moves every
//! vertex.
//!
//! A node at g with the linear map A = I + X and the shift t takes a point p to A (p − g) + g + t; a vertex takes the
//! mean of its seven nearest nodes' points with the weights (1 − d²/d₈²)², d₈ being the distance of the eighth. The
//! nodes' maps minimise, in the unit of the mean distance of joined nodes,
//!
//! E = 30 Σ_j ρ_j ‖A_jᵀ A_j − I‖² + 10 Σ_jk α_jk |X_j (g_k − g_j) + t_j − t_k|² + Σ_l w_l |d(v_l) − u(v_l)|²:
//!
//! each node's rigidity, the regularity of neighbours, and the constraints v_l, which are samples of the handles and of
//! the fixed vertices near the moving part. The differences from the paper:
//!
//! - Seven nodes move a vertex, not four, and the weights have d² instead of d, so that they have no peak at a node and
//!   normals are smooth.
//! - The rigidity weighs 30, not 1, so that nodes turn rather than flatten.
//! - If the moving part is its own mirror image, the nodes are too, and a symmetric edit bends both sides alike.
//! - The rigidity counts the angles between A's columns twice, so that it does not depend on the axes of space.
//! - α_jk is Σ_v s_v w_j w_k over the vertices, s the painted stiffness, over the root of the two nodes' own sums
//!   without s, and ρ_j the mean of s around the node: neighbours that share more are joined more firmly, and nodes in
//!   stiff paint stay rigid together. Parts that share nothing are joined at their nearest nodes.
//! - A constraint also requires that the blended linear map is its handle's, as if a small cross were tied to the
//!   vertex. So handles of one vertex turn their surroundings, and the surface leaves constrained parts without a
//!   hinge.
//! - The constraints are met in the least-squares sense by the nodes; the remaining error is blended out smoothly
//!   (`space::blend`), so that hard handles are met exactly.
//!
//! Parts: `region::nodes` spreads them, `graph` joins them, `energy` has the terms, `system` the Gauss–Newton matrix, whose
//! pattern is analysed once, and `solver` takes the steps. At the end of a drag a `second` descent begins from
//! rest.

mod declaration;
mod energy;
mod first;
mod graph;
mod options;
mod second;
mod solver;
mod system;

pub(crate) use self::declaration::DECLARATION;
pub use self::options::Embedded;
