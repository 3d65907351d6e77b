//! Lattices of control points: free-form deformation of the plane.
//!
//! > X(s,t) = Σⱼ Σᵢ Nᵢ(s) Nⱼ(t) wᵢⱼ (xᵢⱼ, yᵢⱼ, 1),  s = (x − x₀)/(x₁ − x₀),  t = (y − y₀)/(y₁ − y₀)
//!
//! (T. W. Sederberg, S. R. Parry, *Free-form deformation of solid geometric models*, SIGGRAPH 1986; T. W. Sederberg,
//! *Computer Aided Geometric Design*, chapter 14). The basis is Bernstein's, or that of uniform clamped B-splines. i counts
//! from the left, j from the top.
//!
//! Nothing moves outside the region, so its border is a crease. If the k + 1 outermost rows or columns along a side are in their
//! regular positions (with weights 1), the map is Cᵏ across that side. The Bézier pieces of a B-spline lattice of degree d agree
//! in d − 1 derivatives; the lines between them are creases too.

mod grid;
mod map;

pub use grid::Lattice;
pub use map::LatticeMap;
