//! Element kernels: mass, strain energy, elastic force and tangent in local coordinates. They know nothing of global
//! numbering.

mod ancf_cable;
mod ancf_gauss;
mod ancf_literal;
pub mod natural_rigid;

pub use ancf_cable::AncfCable;
pub use ancf_gauss::GaussCable;
pub use ancf_literal::LiteralCable;

/// First and second derivatives by x \[1/m, 1/m2 times the unit of the shape function\] of the shape functions S_1 ... S_4
/// of eq. 8 at xi = x/l.
pub(crate) fn shape_derivatives(xi: f64, l: f64) -> ([f64; 4], [f64; 4]) {
    let chord = 6.0 * xi * (1.0 - xi) / l;
    let bend = (12.0 * xi - 6.0) / (l * l);
    let first = [
        -chord,
        (1.0 - xi) * (1.0 - 3.0 * xi),
        chord,
        xi * (3.0 * xi - 2.0),
    ];
    let second = [bend, (6.0 * xi - 4.0) / l, -bend, (6.0 * xi - 2.0) / l];
    (first, second)
}

/// The elastic force of the planar cubic ANCF element (eq. 11): one law, several routes to the same numbers.
///
/// Local coordinates q = (r_i, r_i', r_j, r_j'), eq. 7, in m and 1; forces are conjugate to them.
pub trait ElasticRoute {
    /// The route to an element of length l \[m\], axial stiffness EA \[N\] and bending stiffness EI \[N m2\].
    fn new(length: f64, axial_stiffness: f64, bending_stiffness: f64) -> Self
    where
        Self: Sized;
    /// Adds the elastic force F^e(q) = (dU/dq)^T to `f`.
    fn force(&self, q: &[f64; 8], f: &mut [f64; 8]);
    /// Adds the elastic force to `f` and its Jacobian dF/dq, row by row, to `k`.
    fn force_and_tangent(&self, q: &[f64; 8], f: &mut [f64; 8], k: &mut [[f64; 8]; 8]);
}

/// One route of the registry, for tests and benchmarks that go through all of them.
#[derive(Debug, Clone, Copy)]
pub struct RegisteredRoute {
    /// Name of the route.
    pub name: &'static str,
    /// Builds the route from length, EA and EI.
    pub build: fn(f64, f64, f64) -> Box<dyn ElasticRoute>,
}

impl std::fmt::Debug for dyn ElasticRoute {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str("ElasticRoute")
    }
}

/// All routes; the first is the one that simulations take, because it is the fastest.
pub const ROUTES: [RegisteredRoute; 3] = [
    RegisteredRoute {
        name: "reduced tensor",
        build: |l, ea, ei| Box::new(AncfCable::new(l, ea, ei)),
    },
    RegisteredRoute {
        name: "five-point Gauss",
        build: |l, ea, ei| Box::new(GaussCable::new(l, ea, ei)),
    },
    RegisteredRoute {
        name: "literal invariants",
        build: |l, ea, ei| Box::new(LiteralCable::new(l, ea, ei)),
    },
];
