//! Lattices of control points in space: free-form deformation.
//!
//! > X(s,t,u) = Σₖ Σⱼ Σᵢ Nᵢ(s) Nⱼ(t) Nₖ(u) wᵢⱼₖ (xᵢⱼₖ, yᵢⱼₖ, zᵢⱼₖ, 1)
//!
//! with s, t, u from 0 to 1 across a box and Bernstein polynomials or uniform clamped B-splines N (T. W. Sederberg, S. R. Parry,
//! *Free-form deformation of solid geometric models*, SIGGRAPH 1986; with weights: P. Kalra et al., 1992). i counts from the
//! left, j from the bottom, k from the back.
//!
//! Nothing moves outside the box unless the map is extended, so its faces are creases. If the k + 1 outermost layers along a face
//! are in their regular positions with weights 1, the map is Cᵏ across that face.

mod grid;
mod map;

pub use grid::Lattice3;
pub use map::LatticeMap3;
