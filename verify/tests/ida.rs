//! IDA on our equations: what its largest order costs, and that its solution does not depend on it.

use ladder::Rung;
use looselink::scene::Scene;
use std::path::Path;
use verify::ida_of_system::{IdaError, IdaRun, IdaSettings, LinearSolver, NEWTON, integrate};

/// Simulated time \[s\].
const DURATION: f64 = 5e-3;

/// Case 2, undamped vibration, with a number of elements a link.
fn run(elements: usize, max_order: i32, linear_solver: LinearSolver, tolerance: f64) -> IdaRun {
    within(f64::INFINITY, elements, max_order, linear_solver, tolerance).unwrap()
}

/// The same, given up after a processor time \[s\].
fn within(
    longest: f64,
    elements: usize,
    max_order: i32,
    linear_solver: LinearSolver,
    tolerance: f64,
) -> Result<IdaRun, IdaError> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../scenes/3rrr/case2.toml");
    let links = (1..=3).map(|link| format!("bodies.link{link}.elements={elements}"));
    let run = [
        format!("simulation.duration={DURATION:e}"),
        "output.interval=5e-4".to_owned(),
    ];
    let set: Vec<String> = links.chain(run).collect();
    let scene = Scene::load(&path, &set).unwrap();
    let settings = IdaSettings {
        max_order,
        ratio: 0.0,
        linear_solver,
        newton: NEWTON[0],
    };
    integrate(&scene, settings, tolerance, longest)
}

/// Largest difference of an unknown at any row.
fn difference(a: &IdaRun, b: &IdaRun) -> f64 {
    assert_eq!(a.rows.len(), b.rows.len());
    let pairs = a.rows.iter().flatten().zip(b.rows.iter().flatten());
    pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
}

#[test]
fn a_run_that_takes_too_long_is_given_up() {
    let given_up = within(0.0, 1, 2, LinearSolver::Klu, 1e-3);
    assert!(
        matches!(given_up, Err(IdaError::TooLong(0.0))),
        "{given_up:?}"
    );
}

#[test]
fn orders_above_2_cost_undamped_vibrations_more_than_ten_times_the_residuals() {
    let [two, five] = [2, 5].map(|order| run(16, order, LinearSolver::Klu, 1e-3).counts.residuals);
    Rung::Codes
        .asks("IDA on our equations, case 2 with 16 elements a link, tolerance 1e-3: residuals with orders up to 2 over those with orders up to 5")
        .within(
            two as f64 / five as f64,
            0.1,
            "a step of BDF 3 to 5 is unstable for vibrations that it does not resolve, those of the links, and BDF 2 damps these: an \
             order of magnitude is far more than settings of Newton's method make",
        );
}

#[test]
fn all_orders_converge_to_one_solution() {
    let exact = run(1, 5, LinearSolver::Klu, 1e-10);
    let errors = [1e-5, 1e-6, 1e-7, 1e-8].map(|tolerance| {
        let found = run(1, 2, LinearSolver::Klu, tolerance);
        (tolerance, difference(&found, &exact))
    });
    Rung::Codes
        .asks("IDA on our equations, case 2: does the solution of BDF 2 tend to that of BDF 5?")
        .falls_on_average(
            "tolerance",
            &errors,
            0.5..1.0,
            "the local error, of order 3 in the step, follows the tolerance, so the error, of order 2, follows its power 2/3",
        );
}

#[test]
fn sparse_and_dense_matrices_give_one_solution() {
    let [sparse, dense] =
        [LinearSolver::Klu, LinearSolver::Dense].map(|solver| run(1, 2, solver, 1e-6));
    Rung::Codes
        .asks("IDA on our equations, case 2: do KLU and a dense matrix give the same unknowns?")
        .within(
            difference(&sparse, &dense),
            1e-9,
            "Newton's method stops below the tolerance of positions, 1e-9 m; rounding changes less",
        );
}
