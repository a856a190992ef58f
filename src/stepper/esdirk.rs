//! An explicit first stage and diagonally implicit ones (ESDIRK), L-stable, with the last stage at the end of the step. On the
//! first-order form of the equations of motion,
//!
//! ```text
//! v_i = v + h sum_j a_ij a_j        q_i = q + h sum_j a_ij v_j        a_ii = gamma for i > 1
//! ```
//!
//! All implicit stages have the same matrix, of weights (gamma h)^2 and gamma h. Every stage is of order 2 and lies at
//! t + c_i h, where c_i is the sum of its row.
//!
//! The stages are solved on the acceleration level, with the multipliers that keep d2(Phi)/dt2 = 0. This applies the method to the
//! underlying ordinary differential equation for (q, v), so it keeps its full order; on the position level the order falls
//! (Hairer & Wanner 1996, Solving Ordinary Differential Equations II, VII.4). Every step ends with a projection of q on Phi = 0 and of v on
//! Phi_q v + Phi_t = 0 (Eich 1993, SIAM J. Numer. Anal. 30:1467).
//!
//! Near a singular pose a stage that lies slightly off the constraints may have no solution, because the constraints no longer
//! determine its accelerations. Such a stage is solved on the position level, as with [`super::Bathe`].
//!
//! The local error is the difference from the solution of the embedded formula, of one order less. The step continues with the
//! solution of the higher order.

use super::{
    Estimate, EstimatedSolution, LocalError, Scheme, Stage, StepError, Stepper, Vibration,
    accumulate_stage, integrate, sum,
};
use crate::checkpoint::carried;
use crate::newton::{Level, Newton};
use crate::system::{Shape, State, System, Weights, Work};

/// The coefficients of a method.
#[derive(Debug)]
struct Tableau {
    gamma: f64,
    /// a_ij of the implicit stages, left of the diagonal.
    rows: &'static [&'static [f64]],
    /// Weights of the embedded formula.
    embedded: &'static [f64],
    /// The power of the step with which the local error of the embedded formula falls.
    order: f64,
    /// That of [`EstimatedSolution::Embedded`].
    weight: f64,
    /// Errors in a vibration.
    vibration: Vibration,
}

impl Tableau {
    /// The weights of the step, which are those of its last stage.
    fn weights(&self) -> impl Iterator<Item = f64> {
        let last = self.rows.last().into_iter().copied().flatten();
        last.copied().chain([self.gamma])
    }
}

/// ESDIRK3(2)4L\[2\]SA of Kennedy & Carpenter (2003, Appl. Numer. Math. 44:139).
static THREE_TWO: Tableau = Tableau {
    gamma: 1_767_732_205_903.0 / 4_055_673_282_236.0,
    rows: &[
        &[1_767_732_205_903.0 / 4_055_673_282_236.0],
        &[
            2_746_238_789_719.0 / 10_658_868_560_708.0,
            -640_167_445_237.0 / 6_845_629_431_997.0,
        ],
        &[
            1_471_266_399_579.0 / 7_840_856_788_654.0,
            -4_482_444_167_858.0 / 7_529_755_066_697.0,
            11_266_239_266_428.0 / 11_593_286_722_821.0,
        ],
    ],
    embedded: &[
        2_756_255_671_327.0 / 12_835_298_489_170.0,
        -10_771_552_573_575.0 / 22_201_958_757_719.0,
        9_247_589_265_047.0 / 10_645_013_368_117.0,
        2_193_209_047_091.0 / 5_459_859_503_100.0,
    ],
    order: 3.0,
    weight: 12.36,
    vibration: Vibration {
        error: 0.0259,
        ratio: 4.17,
    },
};

/// ESDIRK5(4)7L\[2\]SA2 of Kennedy & Carpenter (2019, Appl. Numer. Math. 146:221).
static FIVE_FOUR: Tableau = Tableau {
    gamma: 23.0 / 125.0,
    rows: &[
        &[23.0 / 125.0],
        &[
            791_020_047_304.0 / 3_561_426_431_547.0,
            791_020_047_304.0 / 3_561_426_431_547.0,
        ],
        &[
            -158_159_076_358.0 / 11_257_294_102_345.0,
            -158_159_076_358.0 / 11_257_294_102_345.0,
            -85_517_644_447.0 / 5_003_708_988_389.0,
        ],
        &[
            -1_653_327_111_580.0 / 4_048_416_487_981.0,
            -1_653_327_111_580.0 / 4_048_416_487_981.0,
            1_514_767_744_496.0 / 9_099_671_765_375.0,
            14_283_835_447_591.0 / 12_247_432_691_556.0,
        ],
        &[
            -4_540_011_970_825.0 / 8_418_487_046_959.0,
            -4_540_011_970_825.0 / 8_418_487_046_959.0,
            -1_790_937_573_418.0 / 7_393_406_387_169.0,
            10_819_093_665_085.0 / 7_266_595_846_747.0,
            4_109_463_131_231.0 / 7_386_972_500_302.0,
        ],
        &[
            -188_593_204_321.0 / 4_778_616_380_481.0,
            -188_593_204_321.0 / 4_778_616_380_481.0,
            2_809_310_203_510.0 / 10_304_234_040_467.0,
            1_021_729_336_898.0 / 2_364_210_264_653.0,
            870_612_361_811.0 / 2_470_410_392_208.0,
            -1_307_970_675_534.0 / 8_059_683_598_661.0,
        ],
    ],
    embedded: &[
        -582_099_335_757.0 / 7_214_068_459_310.0,
        -582_099_335_757.0 / 7_214_068_459_310.0,
        615_023_338_567.0 / 3_362_626_566_945.0,
        3_192_122_436_311.0 / 6_174_152_374_399.0,
        6_156_034_052_041.0 / 14_430_468_657_929.0,
        -1_011_318_518_279.0 / 9_693_750_372_484.0,
        1_914_490_192_573.0 / 13_754_262_428_401.0,
    ],
    order: 5.0,
    weight: 1.842,
    vibration: Vibration {
        error: 4.6e-5,
        ratio: 0.325,
    },
};

/// `method = "esdirk3"`
pub static ORDER_3: Scheme = Scheme {
    name: "esdirk3",
    order: 3,
    is_explicit: false,
    keeps_constraints: true,
    parameters: &[],
    build: |_, shape| Box::new(Esdirk::new(&THREE_TWO, shape)),
};

/// `method = "esdirk5"`
pub static ORDER_5: Scheme = Scheme {
    name: "esdirk5",
    order: 5,
    is_explicit: false,
    keeps_constraints: true,
    parameters: &[],
    build: |_, shape| Box::new(Esdirk::new(&FIVE_FOUR, shape)),
};

/// A method with its memory.
#[derive(Debug)]
pub struct Esdirk {
    tableau: &'static Tableau,
    /// The stages between the first and the last.
    middle: Vec<State>,
    stage: Stage,
    /// Changes of v and q by the stages before.
    change: Vec<f64>,
    increment: Vec<f64>,
}

carried!(Esdirk {} but { tableau, middle, stage, change, increment });

impl Esdirk {
    fn new(tableau: &'static Tableau, shape: Shape) -> Esdirk {
        let middle = tableau.rows.iter().skip(1);
        Esdirk {
            tableau,
            middle: middle.map(|_| State::zeros(shape)).collect(),
            stage: Stage::new(shape),
            change: vec![0.0; shape.unknowns],
            increment: vec![0.0; shape.unknowns],
        }
    }
}

impl Stepper for Esdirk {
    fn step(
        &mut self,
        system: &dyn System,
        from: &State,
        t: f64,
        to: &mut State,
        newton: &mut Newton,
        work: &mut Work,
    ) -> Result<usize, StepError> {
        newton.begin_step(from);
        let shape = system.shape();
        let h = t - from.t;
        let Tableau { gamma, rows, .. } = *self.tableau;
        let g = gamma * h;
        let w = Weights { q: g * g, v: g };
        let mut clamps = 0;
        for (i, row) in rows.iter().enumerate() {
            let (done, rest) = self.middle.split_at_mut(i);
            let (now, is_last) = match rest.first_mut() {
                Some(stage) => (stage, false),
                None => (&mut *to, true),
            };
            now.copy_from(done.last().unwrap_or(from));
            let c = row.iter().sum::<f64>() + gamma;
            now.t = if is_last { t } else { from.t + c * h };
            // the stages are not in the order of time
            system.prescribe(from, now, work)?;
            let before = || [from].into_iter().chain(&*done);
            let weights = || row.iter().copied();
            sum(h, weights(), before(), |s| &s.a, &mut self.change);
            sum(h, weights(), before(), |s| &s.v, &mut self.increment);
            for (k, change) in self.change.iter().enumerate() {
                let v_hat = from.v[k] + change;
                self.stage
                    .set(from, k, v_hat, self.increment[k] + g * v_hat);
            }
            let equations = self.stage.equations(Level::Acceleration, w);
            let is_constrained = shape.multipliers > 0;
            let mut solved = newton.solve_stage(system, equations, now, work);
            if solved.is_ok() {
                accumulate_stage(from, &self.stage.increment, w.q, now);
                if is_last && is_constrained {
                    solved = newton.return_to_constraints(system, now, work);
                }
            }
            clamps += match solved {
                Ok(()) => newton.finish_consistent_stage(system, now, work),
                Err(_) if is_constrained => {
                    let guess = done.last().unwrap_or(from);
                    now.a[..shape.unknowns].copy_from_slice(&guess.a[..shape.unknowns]);
                    now.lambda.copy_from_slice(&guess.lambda);
                    let clamped = self.stage.solve(system, w, from, now, newton, work)?;
                    newton.counters.position_level_stages += 1;
                    clamped
                }
                Err(failure) => return Err(failure.into()),
            };
        }
        to.integrals.copy_from_slice(&from.integrals);
        let State {
            powers, integrals, ..
        } = to;
        let before = [from].into_iter().chain(&self.middle);
        let all = before.map(|stage| &stage.powers).chain([&*powers]);
        for (weight, powers) in self.tableau.weights().zip(all) {
            integrate(h, &[(weight, powers)], integrals);
        }
        Ok(clamps)
    }

    fn estimate(&self) -> Estimate {
        Estimate {
            order: self.tableau.order,
            of: EstimatedSolution::Embedded {
                weight: self.tableau.weight,
                vibration: self.tableau.vibration,
            },
            implicit: true,
        }
    }

    fn local_error(&self, from: &State, to: &State, _: &State, error: &mut LocalError) {
        let h = to.t - from.t;
        let weights = || self.tableau.weights().zip(self.tableau.embedded);
        let difference = || weights().map(|(weight, embedded)| weight - embedded);
        let all = || [from].into_iter().chain(&self.middle).chain([to]);
        sum(h, difference(), all(), |s| &s.v, &mut error.q);
        sum(h, difference(), all(), |s| &s.a, &mut error.v);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::stepper::order_conditions::{DORMAND_PRINCE, RungeKutta};

    #[test]
    fn the_coefficients_satisfy_the_order_conditions() {
        for (tableau, order) in [(&THREE_TWO, 3), (&FIVE_FOUR, 5)] {
            let implicit = tableau
                .rows
                .iter()
                .map(|row| [row, &[tableau.gamma][..]].concat());
            let method = RungeKutta([vec![]].into_iter().chain(implicit).collect());
            let weights: Vec<f64> = tableau.weights().collect();
            for (weights, order) in [(&weights[..], order), (tableau.embedded, order - 1)] {
                for nodes in 1..=order {
                    // rounding of sums of seven terms of the order of one
                    assert!(method.error(weights, nodes) < 1e-14, "order {nodes}");
                }
            }
            // every stage is of order 2
            let c = method.times(&vec![1.0; weights.len()]);
            for (half, c) in method.times(&c).iter().zip(&c).skip(1) {
                assert!((half - 0.5 * c * c).abs() < 1e-14, "{c}");
            }
            let of_solution = method.error(&weights, order + 1);
            let ratio = of_solution / method.error(tableau.embedded, order);
            let weight = ratio / DORMAND_PRINCE;
            // three digits of the ratio of Dormand and Prince's pair
            assert!((weight / tableau.weight - 1.0).abs() < 2e-3, "{weight}");
            let [k, next] = [order as u32, order as u32 + 1];
            let error = method.error_coefficient(&weights, next);
            let estimate = method.error_coefficient(tableau.embedded, k);
            let Vibration {
                error: rounded,
                ratio,
            } = tableau.vibration;
            assert!((rounded / error - 1.0).abs() < 2e-3, "{error}");
            let exact = error / estimate;
            assert!((ratio / exact - 1.0).abs() < 2e-3, "{exact}");
        }
    }
}
