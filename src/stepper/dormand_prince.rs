//! Explicit Runge-Kutta methods of Dormand and Prince: the pair of orders 5 and 4 (Dormand & Prince 1980, J. Comput. Appl. Math.
//! 6:19), and the method of order 8 with embedded formulas of orders 5 and 3 that is known as DOP853 (Prince & Dormand 1981, J.
//! Comput. Appl. Math. 7:67; Hairer, Nørsett & Wanner 1993, Solving Ordinary Differential Equations I, II.5 and II.10).
//!
//! Applied to y = (q, v) with stages Y_i = y + h sum_j a_ij F_j, F = (V, A). A_i is the solution of the acceleration level at
//! (Q_i, V_i). The end of the step is the first stage of the next. With constraint rows the acceleration level reduces the index,
//! and every step ends with a projection of q on Phi = 0 and of v on Phi_q v + Phi_t = 0 (Eich 1993, SIAM J. Numer. Anal. 30:1467),
//! which keeps the order.
//!
//! The local error of the pair is the difference e of its two solutions, of order h^5. DOP853 has two differences, e_5 of order
//! h^6 from its formula of order 5 and e_3 of order h^4 from that of order 3, and the estimate
//!
//! ```text
//! e = e_5 |e_5| / sqrt(|e_5|^2 + 0.01 |e_3|^2)
//! ```
//!
//! of order h^8, with norms over all coordinates or all velocities. The step continues with the solution of the highest order.

use super::{
    Estimate, EstimatedSolution, LocalError, Scheme, StepError, Stepper, Vibration, accumulate,
    add, integrate, sum,
};
use crate::checkpoint::carried;
use crate::newton::Newton;
use crate::system::{Shape, State, System, Work};
use std::ops::Range;

/// The coefficients of a method.
#[derive(Debug)]
struct ExplicitTableau {
    /// c_i and a_ij of all stages but the first.
    stages: &'static [(f64, &'static [f64])],
    /// Which of them are inside the step, one after the other in time, and of a high order.
    interior: Range<usize>,
    /// Weights of the stages at the end of the step.
    weights: &'static [f64],
    /// The weights of e, or of e_5: those of the step minus those of the embedded formula, of which the end of the step may be one
    /// more stage.
    difference: &'static [f64],
    /// The weights of e_3.
    of_order_3: Option<&'static [f64]>,
    /// The power of the step with which the estimate falls.
    order: f64,
    /// That of [`EstimatedSolution::Embedded`].
    weight: f64,
    /// Errors in a vibration.
    vibration: Vibration,
}

/// The pair of orders 5 and 4.
static FIVE_FOUR: ExplicitTableau = ExplicitTableau {
    stages: &[
        (1.0 / 5.0, &[1.0 / 5.0]),
        (3.0 / 10.0, &[3.0 / 40.0, 9.0 / 40.0]),
        (4.0 / 5.0, &[44.0 / 45.0, -56.0 / 15.0, 32.0 / 9.0]),
        (
            8.0 / 9.0,
            &[
                19372.0 / 6561.0,
                -25360.0 / 2187.0,
                64448.0 / 6561.0,
                -212.0 / 729.0,
            ],
        ),
        (
            1.0,
            &[
                9017.0 / 3168.0,
                -355.0 / 33.0,
                46732.0 / 5247.0,
                49.0 / 176.0,
                -5103.0 / 18656.0,
            ],
        ),
    ],
    interior: 0..0,
    weights: &[
        35.0 / 384.0,
        0.0,
        500.0 / 1113.0,
        125.0 / 192.0,
        -2187.0 / 6784.0,
        11.0 / 84.0,
    ],
    difference: &[
        71.0 / 57600.0,
        0.0,
        -71.0 / 16695.0,
        71.0 / 1920.0,
        -17253.0 / 339200.0,
        22.0 / 525.0,
        -1.0 / 40.0,
    ],
    of_order_3: None,
    order: 5.0,
    weight: 1.0,
    vibration: Vibration {
        error: 2.778e-4,
        ratio: 0.3434,
    },
};

/// DOP853.
static EIGHT: ExplicitTableau = ExplicitTableau {
    stages: &[
        (0.052_600_151_958_767_73, &[0.052_600_151_958_767_73]),
        (
            0.078_900_227_938_151_6,
            &[0.019_725_056_984_537_9, 0.059_175_170_953_613_7],
        ),
        (
            0.118_350_341_907_227_4,
            &[0.029_587_585_476_806_85, 0.0, 0.088_762_756_430_420_54],
        ),
        (
            0.281_649_658_092_772_6,
            &[
                0.241_365_134_159_266_7,
                0.0,
                -0.884_549_479_328_286_1,
                0.924_834_003_261_792,
            ],
        ),
        (
            1.0 / 3.0,
            &[
                1.0 / 27.0,
                0.0,
                0.0,
                0.170_828_608_729_473_86,
                0.125_467_687_566_822_42,
            ],
        ),
        (
            1.0 / 4.0,
            &[
                19.0 / 512.0,
                0.0,
                0.0,
                0.170_252_211_019_544_05,
                0.060_216_538_980_455_96,
                -9.0 / 512.0,
            ],
        ),
        (
            4.0 / 13.0,
            &[
                0.037_092_000_118_504_79,
                0.0,
                0.0,
                0.170_383_925_712_239_98,
                0.107_262_030_446_373_28,
                -0.015_319_437_748_624_402,
                0.008_273_789_163_814_023,
            ],
        ),
        (
            0.651_282_051_282_051_3,
            &[
                0.624_110_958_716_075_7,
                0.0,
                0.0,
                -3.360_892_629_446_941_4,
                -0.868_219_346_841_726,
                27.592_099_699_446_71,
                20.154_067_550_477_894,
                -43.489_884_181_069_96,
            ],
        ),
        (
            3.0 / 5.0,
            &[
                0.477_662_536_438_264_34,
                0.0,
                0.0,
                -2.488_114_619_971_667_7,
                -0.590_290_826_836_843,
                21.230_051_448_181_193,
                15.279_233_632_882_423,
                -33.288_210_968_984_86,
                -0.020_331_201_708_508_627,
            ],
        ),
        (
            6.0 / 7.0,
            &[
                -0.937_142_430_085_987_3,
                0.0,
                0.0,
                5.186_372_428_844_064,
                1.091_437_348_996_729_5,
                -8.149_787_010_746_927,
                -18.520_065_659_996_96,
                22.739_487_099_350_505,
                2.493_605_552_679_652_3,
                -3.046_764_471_898_219_6,
            ],
        ),
        (
            1.0,
            &[
                2.273_310_147_516_538,
                0.0,
                0.0,
                -10.534_495_466_737_25,
                -2.000_872_058_224_862_5,
                -17.958_931_863_118_8,
                27.948_884_529_419_96,
                -2.858_998_277_135_023_5,
                -8.872_856_933_530_63,
                12.360_567_175_794_303,
                0.643_392_746_015_763_6,
            ],
        ),
    ],
    interior: 6..8,
    weights: &[
        0.054_293_734_116_568_765,
        0.0,
        0.0,
        0.0,
        0.0,
        4.450_312_892_752_409,
        1.891_517_899_314_500_3,
        -5.801_203_960_010_585,
        0.311_164_366_957_819_9,
        -0.152_160_949_662_516_1,
        0.201_365_400_804_030_34,
        0.044_710_615_727_772_59,
    ],
    difference: &[
        0.013_120_044_994_194_88,
        0.0,
        0.0,
        0.0,
        0.0,
        -1.225_156_446_376_204_4,
        -0.495_758_949_657_250_2,
        1.664_377_182_454_986_4,
        -0.350_328_848_749_973_67,
        0.334_179_118_713_017_5,
        0.081_923_206_485_115_71,
        -0.022_355_307_863_886_294,
    ],
    of_order_3: Some(&[
        -0.189_800_754_072_407_62,
        0.0,
        0.0,
        0.0,
        0.0,
        4.450_312_892_752_409,
        1.891_517_899_314_500_3,
        -5.801_203_960_010_585,
        -0.422_682_321_323_791_9,
        -0.152_160_949_662_516_1,
        0.201_365_400_804_030_34,
        0.022_651_792_198_360_82,
    ]),
    order: 8.0,
    weight: 1.235,
    vibration: Vibration {
        error: 6.404e-8,
        ratio: 0.148,
    },
};

/// `method = "dormand_prince"`
pub static SCHEME: Scheme = Scheme {
    name: "dormand_prince",
    order: 5,
    is_explicit: true,
    keeps_constraints: true,
    parameters: &[],
    build: |_, shape| Box::new(DormandPrince::new(&FIVE_FOUR, shape)),
};

/// `method = "dop853"`
pub static ORDER_8: Scheme = Scheme {
    name: "dop853",
    order: 8,
    is_explicit: true,
    keeps_constraints: true,
    parameters: &[],
    build: |_, shape| Box::new(DormandPrince::new(&EIGHT, shape)),
};

/// A method with its memory.
#[derive(Debug)]
pub struct DormandPrince {
    tableau: &'static ExplicitTableau,
    /// All stages but the first.
    stages: Vec<State>,
    /// Changes of q or v.
    increment: Vec<f64>,
}

carried!(DormandPrince {} but { tableau, stages, increment });

impl DormandPrince {
    fn new(tableau: &'static ExplicitTableau, shape: Shape) -> DormandPrince {
        let stages = tableau.stages.iter();
        DormandPrince {
            tableau,
            stages: stages.map(|_| State::zeros(shape)).collect(),
            increment: vec![0.0; shape.unknowns],
        }
    }
}

impl Stepper for DormandPrince {
    fn step(
        &mut self,
        system: &dyn System,
        from: &State,
        t: f64,
        to: &mut State,
        newton: &mut Newton,
        work: &mut Work,
    ) -> Result<usize, StepError> {
        let shape = system.shape();
        let h = t - from.t;
        let mut clamps = 0;
        let ExplicitTableau {
            stages, weights, ..
        } = self.tableau;
        for (i, (c, row)) in stages.iter().enumerate() {
            let (done, rest) = self.stages.split_at_mut(i);
            let stage = &mut rest[0];
            stage.copy_memory(from);
            stage.t = if *c == 1.0 { t } else { from.t + c * h };
            system.prescribe(from, stage, work)?;
            let before = || [from].into_iter().chain(&*done);
            let row = || row.iter().copied();
            sum(h, row(), before(), |s| &s.v, &mut self.increment);
            let low = from.q_low.iter().zip(&self.increment);
            for (q, (start, (low, change))) in stage.q.iter_mut().zip(from.q.iter().zip(low)) {
                *q = start + (low + change);
            }
            sum(h, row(), before(), |s| &s.a, &mut self.increment);
            add(&from.v, &self.increment, &mut stage.v);
            newton.accelerate(system, stage, work)?;
            if weights[i + 1] != 0.0 {
                clamps += system.powers(stage, work);
            }
        }
        let stages = &self.stages;
        to.copy_memory(from);
        to.t = t;
        // the known coordinates of the last stage are those of the end
        if let Some(last) = stages.last() {
            to.copy_known(last);
        }
        let weights = || weights.iter().copied();
        let all = || [from].into_iter().chain(stages);
        sum(h, weights(), all(), |s| &s.a, &mut self.increment);
        add(&from.v, &self.increment, &mut to.v);
        sum(h, weights(), all(), |s| &s.v, &mut self.increment);
        let increments = self.increment.iter().copied();
        accumulate(from, increments, &mut to.q, &mut to.q_low);
        if shape.multipliers > 0 {
            newton.return_to_constraints(system, to, work)?;
        } else {
            newton.accelerate(system, to, work)?;
        }
        clamps += system.powers(to, work);
        to.integrals.copy_from_slice(&from.integrals);
        let before = [from].into_iter().chain(stages);
        for (weight, stage) in weights().zip(before).filter(|(weight, _)| *weight != 0.0) {
            integrate(h, &[(weight, &stage.powers)], &mut to.integrals);
        }
        Ok(clamps)
    }

    fn interior(&self) -> &[State] {
        &self.stages[self.tableau.interior.clone()]
    }

    fn estimate(&self) -> Estimate {
        Estimate {
            order: self.tableau.order,
            of: EstimatedSolution::Embedded {
                weight: self.tableau.weight,
                vibration: self.tableau.vibration,
            },
            implicit: false,
        }
    }

    fn local_error(&self, from: &State, to: &State, _: &State, error: &mut LocalError) {
        let h = to.t - from.t;
        let all = || [from].into_iter().chain(&self.stages).chain([to]);
        let difference = || self.tableau.difference.iter().copied();
        sum(h, difference(), all(), |s| &s.v, &mut error.q);
        sum(h, difference(), all(), |s| &s.a, &mut error.v);
        let Some(weights) = self.tableau.of_order_3 else {
            return;
        };
        let of_order_3 = |i: usize, level: fn(&State) -> &Vec<f64>| {
            let slopes = weights.iter().zip(all());
            h * slopes.map(|(w, s)| w * level(s)[i]).sum::<f64>()
        };
        combine_estimates(&mut error.q, |i| of_order_3(i, |s| &s.v));
        combine_estimates(&mut error.v, |i| of_order_3(i, |s| &s.a));
    }
}

/// e from e_5, in place, and e_3.
fn combine_estimates(e: &mut [f64], of_order_3: impl Fn(usize) -> f64) {
    let square_3: f64 = (0..e.len()).map(|i| of_order_3(i).powi(2)).sum();
    let square: f64 = e.iter().map(|e| e * e).sum();
    if square > 0.0 {
        let share = (square / (square + 0.01 * square_3)).sqrt();
        e.iter_mut().for_each(|e| *e *= share);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::stepper::order_conditions::{DORMAND_PRINCE, RungeKutta};

    impl ExplicitTableau {
        fn method(&self) -> RungeKutta {
            let rows = self.stages.iter().map(|(_, row)| row.to_vec());
            let end = [self.weights.to_vec()];
            RungeKutta([vec![]].into_iter().chain(rows).chain(end).collect())
        }
    }

    #[test]
    fn the_coefficients_satisfy_the_order_conditions() {
        for (tableau, order) in [(&FIVE_FOUR, 5), (&EIGHT, 8)] {
            let method = tableau.method();
            let ends = method.times(&vec![1.0; tableau.stages.len() + 2]);
            for (sum, (c, _)) in ends[1..].iter().zip(tableau.stages) {
                // rounding of coefficients up to 43
                assert!((sum - c).abs() < 1e-14, "{c}");
            }
            for i in tableau.interior.clone() {
                let powers = (1..=5).map(|k| (k, ends.iter().map(move |c| c.powi(k - 1))));
                for (k, powers) in powers {
                    let sum = method.times(&powers.collect::<Vec<f64>>())[i + 1];
                    let c = tableau.stages[i].0;
                    assert!((sum - c.powi(k) / f64::from(k)).abs() < 1e-14, "stage {i}");
                }
            }
            for nodes in 1..=order {
                let error = method.error(tableau.weights, nodes);
                assert!(error < 1e-14, "order {nodes}: {error}");
            }
            let differences = [
                Some((tableau.difference, if order == 8 { 5 } else { 4 })),
                tableau.of_order_3.map(|weights| (weights, 3)),
            ];
            for (weights, order) in differences.into_iter().flatten() {
                for nodes in 1..=order {
                    let error = method.difference(weights, nodes);
                    assert!(error < 1e-14, "embedded, order {nodes}: {error}");
                }
                assert!(method.difference(weights, order + 1) > 1e-4);
            }
        }
    }

    /// The principal error of the solution over that of its estimate, to four digits.
    #[test]
    fn the_weight_is_that_of_the_coefficients() {
        let five = FIVE_FOUR.method();
        let ratio = five.error(FIVE_FOUR.weights, 6) / five.difference(FIVE_FOUR.difference, 5);
        assert!((ratio / DORMAND_PRINCE - 1.0).abs() < 2e-3, "{ratio}");
        let eight = EIGHT.method();
        let [of_order_5, of_order_3] = [(EIGHT.difference, 6), (EIGHT.of_order_3.unwrap(), 4)]
            .map(|(weights, nodes)| eight.difference(weights, nodes));
        // for small steps e tends to 10 e_5 |e_5|/|e_3|
        let estimate = 10.0 * of_order_5 * of_order_5 / of_order_3;
        let weight = eight.error(EIGHT.weights, 9) / estimate / DORMAND_PRINCE;
        assert!((weight / EIGHT.weight - 1.0).abs() < 2e-3, "{weight}");
    }

    /// The error of the solution in a vibration, and its ratio to the estimate, to three digits.
    #[test]
    fn errors_in_a_vibration_are_those_of_the_coefficients() {
        let five = FIVE_FOUR.method();
        let estimate = five.coefficient(FIVE_FOUR.difference, 5).abs();
        check_vibration(
            &FIVE_FOUR,
            five.error_coefficient(FIVE_FOUR.weights, 6),
            estimate,
        );
        let eight = EIGHT.method();
        let [of_order_5, of_order_3] = [(EIGHT.difference, 6), (EIGHT.of_order_3.unwrap(), 4)]
            .map(|(weights, power)| eight.coefficient(weights, power).abs());
        let estimate = 10.0 * of_order_5 * of_order_5 / of_order_3;
        check_vibration(&EIGHT, eight.error_coefficient(EIGHT.weights, 9), estimate);
    }

    fn check_vibration(tableau: &ExplicitTableau, error: f64, estimate: f64) {
        let Vibration {
            error: rounded,
            ratio,
        } = tableau.vibration;
        assert!((rounded / error - 1.0).abs() < 2e-3, "{error}");
        assert!(
            (ratio * estimate / error - 1.0).abs() < 2e-3,
            "{}",
            error / estimate
        );
    }
}
