//! Rounding of positions in long runs.

use crate::chain::Chain;
use crate::chain::bathe;
use ladder::{Rung, Worst};
use looselink::newton::Newton;
use looselink::stepper::{
    Method, backward_euler, dormand_prince, esdirk, generalized_alpha, trapezoidal, velocity_verlet,
};
use looselink::system::{State, System};

/// The displacement of a step is a twentieth of the rounding of the position: without a compensated sum the mass stays at 1 m.
#[test]
fn displacements_below_the_rounding_of_the_position_add_up() {
    let (h, steps) = (1e-6, 100_000);
    let chain = Chain::new(vec![1.0], vec![0.0, 0.0]);
    let spectral_radius = 0.8;
    let methods = [
        bathe(0.5),
        Method::new(&trapezoidal::SCHEME),
        Method::new(&backward_euler::SCHEME),
        Method::new(&generalized_alpha::SCHEME).with("spectral_radius", spectral_radius),
        Method::new(&generalized_alpha::HHT).with("spectral_radius", spectral_radius),
        Method::new(&velocity_verlet::SCHEME),
        Method::new(&esdirk::ORDER_3),
        Method::new(&esdirk::ORDER_5),
        Method::new(&dormand_prince::SCHEME),
    ];
    let worst = Worst::new();
    for method in methods {
        let mut newton = Newton::new(&chain, 1e-13);
        let mut work = chain.work();
        let mut from = State::zeros(chain.shape());
        (from.q[0], from.v[0]) = (1.0, 1e-11);
        let mut to = from.clone();
        let mut scheme = method.stepper(chain.shape());
        for k in 1..=steps {
            scheme
                .step(&chain, &from, k as f64 * h, &mut to, &mut newton, &mut work)
                .unwrap();
            scheme.accept();
            from.copy_from(&to);
        }
        let exact = from.v[0] * steps as f64 * h;
        worst.at(method.name());
        worst.see(from.q[0] - 1.0 - exact);
    }
    Rung::Identities
        .asks("Free mass at 1 m, 100,000 displacements of 1e-17 m with every method: error of position [m]")
        .within(
            &worst,
            2.0 * f64::EPSILON,
            "rounding of the position and of the difference; plain sums lose all of 1e-12 m",
        );
}
