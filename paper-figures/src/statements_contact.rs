//! Statements about Figs. 7 to 9 and the conclusions: forces, contact, periodicity.

use crate::campaign::{DURATION, FROM};
use crate::ensembles::{RETARDATIONS, damped_name};
use crate::evidence::{Evidence, statement};
use crate::fig09;
use crate::interval::{CriterionVerdict, Interval};
use crate::measures::{PEAKS, SIMULTANEOUS};
use crate::runs::CaseRecording;
use crate::statement::{Basis, Statement};
use crate::warned::WarningSource;
use numbers::{digits, percent, si};

/// Cycles further apart than this fraction of their amplitude do not repeat.
const REPEATS: f64 = 0.01;
/// A motion is chaotic if neighbours part faster than e-fold in a cycle of one second \[1/s\].
const CHAOTIC: f64 = 1.0;

/// The statements.
pub fn statements(e: &Evidence) -> Vec<Statement> {
    let mut all = vec![
        same_phenomena(e),
        simultaneous_peaks(e),
        enlarged_forces(e),
        service_life(e),
    ];
    all.extend([sign_of_penetration(e), mostly_in_contact(e)]);
    all.extend([periodic_flexible(e), not_periodic_loose(e), chaotic(e)]);
    all.extend([smoother(e), nonlinear_interaction(e)]);
    all
}

fn newton(value: f64) -> String {
    si(value, "N")
}

fn hertz(value: f64) -> String {
    si(value, "Hz")
}

fn acceleration(value: f64) -> String {
    si(value, "m/s²")
}

fn same_phenomena(e: &Evidence) -> Statement {
    let mut text = Vec::new();
    let mut verdict = CriterionVerdict::Holds;
    let mut compare = |name: &str, words: &str, show: fn(f64) -> String| {
        let two = e.flexible.get(name);
        let three = e.loose().mean(name);
        text.push(format!(
            "{words} {}, {}, {}",
            show(two),
            three.reported(show),
            e.both().mean(name).reported(show)
        ));
        let grows = e.both().mean_with(e.loose(), name, |b, a| b / a);
        verdict = verdict.and(three.above(two)).and(grows.above(1.0));
    };
    compare("force_ripple", "rms of the force about its mean", newton);
    compare("force_frequency", "median frequency", hertz);
    Statement {
        measured: format!("in cases 2, 3 and 4, {}.", text.join("; ")),
        criterion: "both grow from case 2 to 3 and from 3 to 4",
        verdict,
        why: "The force of case 2 is the reaction of an ideal joint; Fig. 7a of the paper calls it a contact force.".into(),
        sources: e.all_cases(),
        ..statement("same phenomena", "Sect. 6, Fig. 7", "The same phenomena (larger and higher-frequency vibration from case 2 to 3 to 4) can be observed in the contact forces.")
    }
}

fn simultaneous_peaks(e: &Evidence) -> Statement {
    let of = |name: &str| [e.loose(), e.both()].map(|ensemble| ensemble.mean(name));
    let (one, any) = (of("peaks_with_b1"), of("peaks_with_any"));
    let chance = PEAKS as f64 * 2.0 * SIMULTANEOUS / (DURATION - FROM);
    Statement {
        measured: format!(
            "of the {PEAKS} highest acceleration peaks, within {} of one of the {PEAKS} highest force peaks of B1: case 3 {}, case 4 {}; of B1, B2 or B3: {}, {}.",
            si(SIMULTANEOUS, "s"),
            one[0].reported(percent),
            one[1].reported(percent),
            any[0].reported(percent),
            any[1].reported(percent)
        ),
        criterion: "at least 90 % with one of the three joints, in both cases",
        verdict: any[0].above(0.9).and(any[1].above(0.9)),
        why: format!(
            "Three legs act on the platform, so B1 alone cannot explain every peak. By chance it would be {} for one joint.",
            percent(chance)
        ),
        sources: e.ensembles(),
        ..statement(
            "simultaneous",
            "Sect. 6, Fig. 7",
            "The high peaks of the acceleration and of the contact force occur at the same time.",
        )
    }
}

fn enlarged_forces(e: &Evidence) -> Statement {
    let (one, two) = (e.ideal.get("force_peak"), e.flexible.get("force_peak"));
    let over = |reference: f64| {
        [e.loose(), e.both()].map(|ensemble| ensemble.mean_of("force_peak", |f| f / reference))
    };
    let (rigid, flexible) = (over(one), over(two));
    let verdict = rigid.iter().chain(&flexible).map(|i| i.above(1.5));
    Statement {
        measured: format!(
            "peak force in B1 of case 3 {} times that of case 1 ({}) and {} times that of case 2 ({}); of case 4 {} and {} times.",
            rigid[0].reported(digits),
            newton(one),
            flexible[0].reported(digits),
            newton(two),
            rigid[1].reported(digits),
            flexible[1].reported(digits)
        ),
        criterion: "above 1.5 times the forces of cases 1 and 2, in cases 3 and 4",
        verdict: verdict.fold(CriterionVerdict::Holds, CriterionVerdict::and),
        why: "After a loss of contact, the stiff contact stops the returning journal in a fraction of a millisecond.".into(),
        sources: with_ideal(e),
        ..statement("enlarged", "Sect. 6, 7, Fig. 7", "The contact forces are enlarged by the clearance.")
    }
}

/// Run 1, the fine run of case 2, and the ensembles.
fn with_ideal(e: &Evidence) -> Vec<WarningSource> {
    let mut sources = vec![e.c.ideal.source(), e.c.flexible.source()];
    sources.extend(e.ensembles());
    sources
}

fn service_life(e: &Evidence) -> Statement {
    let of = |reference: f64| {
        [e.loose(), e.both()]
            .map(|m| m.mean_of("force_cubic_mean", |load| (load / reference).powi(-3)))
    };
    let rigid = of(e.ideal.get("force_cubic_mean"));
    let flexible = of(e.flexible.get("force_cubic_mean"));
    let verdict = rigid.iter().chain(&flexible).map(|i| i.below(0.9));
    Statement {
        measured: format!(
            "life by the cubic-mean load of B1: {} (case 3) and {} (case 4) of that of case 1; {} and {} of that of case 2.",
            rigid[0].reported(percent),
            rigid[1].reported(percent),
            flexible[0].reported(percent),
            flexible[1].reported(percent)
        ),
        criterion: "life ~ (cubic-mean load)⁻³, as for rolling bearings, is below 90 % of that of case 1 and of case 2, in cases 3 and 4",
        verdict: verdict.fold(CriterionVerdict::Holds, CriterionVerdict::and),
        why: "Case 1 has no vibration; case 2 has the undamped vibration of its start. Wear and strength are not part of the model, so only the load spectrum can be compared.".into(),
        sources: with_ideal(e),
        ..statement("service life", "Sect. 1, 6, 7", "The enlarged contact forces decrease the service life of the components, or even lead to failure.")
    }
}

fn sign_of_penetration(e: &Evidence) -> Statement {
    let all = [e.loose(), e.both()].map(|ensemble| ensemble.values("force_only_in_contact"));
    let share = all.concat().into_iter().fold(1.0, f64::min);
    Statement {
        measured: format!(
            "least share of rows in a run that have no force without positive penetration: {}.",
            percent(share)
        ),
        criterion: "100 %",
        verdict: CriterionVerdict::of(share == 1.0),
        basis: Basis::Construction,
        why: "The contact law is evaluated for positive penetration only. The text writes \"passive\" for negative.".into(),
        sources: e.ensembles(),
        ..statement("sign", "Sect. 4.1, 6, Fig. 8", "Positive penetration means contact, negative means that journal and bearing are separated.")
    }
}

fn mostly_in_contact(e: &Evidence) -> Statement {
    let of = |name: &str| [e.loose(), e.both()].map(|ensemble| ensemble.mean(name));
    let (first, least) = (of("contact_b1"), of("contact_least"));
    Statement {
        measured: format!(
            "B1 is in contact {} (case 3) and {} (case 4) of the time; the joint with the least contact {} and {}.",
            first[0].reported(percent),
            first[1].reported(percent),
            least[0].reported(percent),
            least[1].reported(percent)
        ),
        criterion: "all six joints above 50 % in both cases",
        verdict: least[0].above(0.5).and(least[1].above(0.5)),
        why: "Inertia forces press journal and bearing together, except where the force along a leg changes sign.".into(),
        sources: e.ensembles(),
        ..statement("mostly in contact", "Sect. 6, 7, Fig. 8", "For most of the time the joint components keep contact.")
    }
}

fn spread(e: &Evidence, r: &CaseRecording) -> f64 {
    fig09::spread(&fig09::section(e.c, r).1)
}

fn periodic_flexible(e: &Evidence) -> Statement {
    let [coarse, fine, ..] = &e.c.sections;
    let repetition = [&e.flexible, &e.flexible_coarse].map(|m| m.get("repetition"));
    let quiet = e.e.single("quasi-static start");
    let damped = RETARDATIONS.map(|time| e.e.single(&damped_name(time)));
    let mut sources = e.case_2();
    sources.extend([coarse.source(), fine.source(), quiet.source()]);
    sources.extend(damped.map(|single| single.source()));
    Statement {
        measured: format!(
            "distance between the accelerations of cycles 2 and 3: {} at the finer step, {} at the coarser. Spread of the stroboscopic section over {} periods: {} at {}, {} at {}. Started in its quasi-static deformation: distance {}. With structural damping: {} at a retardation time of {}, {} at {}.",
            percent(repetition[0]),
            percent(repetition[1]),
            e.c.settings.periods,
            acceleration(spread(e, fine)),
            fine.plan.pace.label(),
            acceleration(spread(e, coarse)),
            coarse.plan.pace.label(),
            percent(quiet.measures.get("repetition")),
            percent(damped[0].measures.get("repetition")),
            si(RETARDATIONS[0], "s"),
            percent(damped[1].measures.get("repetition")),
            si(RETARDATIONS[1], "s")
        ),
        criterion: "the distance is below 1 % of the amplitude at both steps",
        verdict: CriterionVerdict::of(repetition.iter().all(|r| *r < REPEATS)),
        why: "The unstrained start excites an undamped vibration that is not commensurate with the period, so the motion becomes periodic only as numerical damping removes it. A quasi-static start, or structural damping, gives a periodic motion.".into(),
        sources,
        ..statement("periodic", "Sect. 6, 7, Fig. 9a", "Case 2 is a periodic motion; the mechanism with flexible links is a periodical system.")
    }
}

fn not_periodic_loose(e: &Evidence) -> Statement {
    let [_, _, loose, both] = &e.c.sections;
    let distance = [e.loose(), e.both()].map(|ensemble| ensemble.mean("repetition"));
    let mut sources = e.ensembles();
    sources.extend([loose.source(), both.source()]);
    Statement {
        measured: format!(
            "distance between the accelerations of cycles 2 and 3: case 3 {}, case 4 {}. Spread of the stroboscopic section over {} periods: {} and {}.",
            distance[0].reported(percent),
            distance[1].reported(percent),
            e.c.settings.periods,
            acceleration(spread(e, loose)),
            acceleration(spread(e, both))
        ),
        criterion: "the distance is above 1 % of the amplitude in both",
        verdict: distance[0].above(REPEATS).and(distance[1].above(REPEATS)),
        why: "Two different cycles do not prove chaos: see the Lyapunov exponents in the next statement.".into(),
        sources,
        ..statement("not periodic", "Sect. 6, 7, Fig. 9b, c", "Cases 3 and 4 are non-periodic: the curve does not repeat from cycle to cycle.")
    }
}

fn chaotic(e: &Evidence) -> Statement {
    let rate = |value: f64| format!("{} s⁻¹", digits(value));
    let of = |case: u32| -> Vec<(f64, Interval)> {
        let exponents = e.e.exponents(case);
        exponents.map(|x| (x.distance, x.mean())).collect()
    };
    let reported = |case: u32| {
        let each: Vec<String> = of(case)
            .into_iter()
            .map(|(distance, x)| format!("{} (d₀ = {distance:e})", x.reported(rate)))
            .collect();
        format!("case {case} {}", each.join(", "))
    };
    let above = |case: u32| {
        of(case)
            .iter()
            .map(|(_, x)| x.above(CHAOTIC))
            .fold(CriterionVerdict::Holds, CriterionVerdict::and)
    };
    let below = of(2)
        .iter()
        .map(|(_, x)| x.below(CHAOTIC))
        .fold(CriterionVerdict::Holds, CriterionVerdict::and);
    Statement {
        measured: format!(
            "largest Lyapunov exponent by Benettin's method: {}; {}; {}.",
            reported(2),
            reported(3),
            reported(4)
        ),
        criterion: "above 1 s⁻¹, one e-fold per cycle, in cases 3 and 4 and below it in case 2, for both initial distances d₀",
        verdict: above(3).and(above(4)).and(below),
        why: "Impacts amplify a small difference, and phases of lasting contact reduce it; the exponent is the net rate.".into(),
        sources: e.e.exponents.iter().map(|x| x.source()).collect(),
        ..statement("chaotic", "Sect. 6, Fig. 9", "The collision between the joint components causes chaotic motion.")
    }
}

fn smoother(e: &Evidence) -> Statement {
    let flexible = [&e.flexible, &e.flexible_coarse].map(|m| m.get("deviation_peak"));
    let ratio = e
        .loose()
        .mean_of("deviation_peak", |peak| flexible[0].max(flexible[1]) / peak);
    Statement {
        measured: format!(
            "largest deviation of the acceleration: case 2 {} at the finer step and {} at the coarser, case 3 {}; ratio of the larger value of case 2 to case 3: {}.",
            acceleration(flexible[0]),
            acceleration(flexible[1]),
            e.loose().mean("deviation_peak").reported(acceleration),
            ratio.reported(digits)
        ),
        criterion: "the ratio is below 0.5",
        verdict: ratio.below(0.5),
        why: "Flexibility adds a linear vibration, clearance adds impacts.".into(),
        sources: e.all_cases(),
        ..statement(
            "smoother",
            "Sect. 7",
            "The mechanism is influenced by the link flexibility in a smoother way than by the clearance.",
        )
    }
}

fn nonlinear_interaction(e: &Evidence) -> Statement {
    let flexible = e.flexible.get("deviation_rms");
    let ratio = e
        .both()
        .mean_with(e.loose(), "deviation_rms", |b, a| b / flexible.hypot(a));
    Statement {
        measured: format!(
            "rms deviation of the acceleration: case 2 {}, case 3 {}, case 4 {}; ratio of case 4 to the root of the sum of squares of cases 2 and 3: {}.",
            acceleration(flexible),
            e.loose().mean("deviation_rms").reported(acceleration),
            e.both().mean("deviation_rms").reported(acceleration),
            ratio.reported(digits)
        ),
        criterion: "the ratio differs from 1 by more than 0.1",
        verdict: ratio.within(0.9, 1.1).not(),
        why: "The squares of independent contributions would add up. Flexible links change the speed, stiffness and times of the impacts themselves.".into(),
        sources: e.all_cases(),
        ..statement("nonlinear", "Sect. 7", "Joint clearance and link flexibility interact with each other in a nonlinear way.")
    }
}
