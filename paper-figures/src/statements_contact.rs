//! Statements about Figs. 7 to 9 and the conclusions: forces, contact, periodicity.

use crate::campaign::{Campaign, DURATION, FROM, TWIN_CHANGE, TWIN_DURATION, TWIN_STEP};
use crate::fig09;
use crate::measures::AllMeasures;
use crate::numbers::Numbers;
use crate::runs::Recording;
use crate::signal::{coincidence, growth_rate, peak, peaks};
use crate::statement::Statement;
use crate::statements_acceleration::{PEAKS, PEAKS_APART, SIMULTANEOUS};
use plot::{digits, percent, si};

/// Cycles further apart than this fraction of their amplitude do not repeat.
const REPEATS: f64 = 0.01;

/// The statements.
pub fn statements(c: &Campaign, m: &AllMeasures, numbers: &mut Numbers) -> Vec<Statement> {
    let mut all = vec![
        same_phenomena(m),
        simultaneous_peaks(c, numbers),
        enlarged_forces(m),
        service_life(m),
    ];
    all.extend([sign_of_penetration(c, numbers), mostly_in_contact(m)]);
    all.extend([
        periodic_flexible(c, m, numbers),
        not_periodic_loose(c, m, numbers),
        chaotic(c, numbers),
    ]);
    all.extend([smoother(m), nonlinear_interaction(m)]);
    all
}

fn same_phenomena(m: &AllMeasures) -> Statement {
    let ripple = [
        m.flexible.force_ripple,
        m.loose.force_ripple,
        m.both.force_ripple,
    ];
    let frequency = [
        m.flexible.force_frequency,
        m.loose.force_frequency,
        m.both.force_frequency,
    ];
    Statement {
        place: "Sect. 6, Fig. 7",
        says: "The same phenomena (larger and higher-frequency vibration from case 2 to 3 to 4) can be observed in the contact forces.",
        measured: format!("Rms about the mean {}, {}, {} N and median frequency {}, {}, {} Hz in cases 2, 3, 4 (h = {}).", digits(ripple[0]), digits(ripple[1]), digits(ripple[2]), digits(frequency[0]), digits(frequency[1]), digits(frequency[2]), si(m.both.step, "s")),
        criterion: "both grow from case 2 to 3 to 4",
        holds: ripple.is_sorted() && frequency.is_sorted(),
        factor: None,
        why: "The force of case 2 is the reaction of an ideal joint; Fig. 7a of the paper calls it a contact force.".into(),
    }
}

fn simultaneous_peaks(c: &Campaign, numbers: &mut Numbers) -> Statement {
    let mut share = |r: &Recording, name: &str| {
        let t = &r.t[r.rows(FROM, DURATION)];
        let apart = (PEAKS_APART / r.plan.interval) as usize;
        let of = |y: &[f64], count| {
            peaks(y, count, apart)
                .into_iter()
                .map(|i| t[i])
                .collect::<Vec<f64>>()
        };
        let acceleration = of(&c.acceleration_deviation(r), PEAKS);
        let force = |joint: &str| {
            of(
                r.between(&format!("{joint}.force"), FROM, DURATION).1,
                PEAKS,
            )
        };
        let one = coincidence(&acceleration, &force("B1"), SIMULTANEOUS);
        let any: Vec<f64> = ["B1", "B2", "B3"]
            .iter()
            .flat_map(|joint| force(joint))
            .collect();
        let any = coincidence(&acceleration, &any, SIMULTANEOUS);
        (
            numbers.put(format!("{name}.peaks_with_b1"), one),
            numbers.put(format!("{name}.peaks_with_any"), any),
        )
    };
    let (loose, both) = (share(&c.loose, "case3"), share(&c.both, "case4"));
    let chance = PEAKS as f64 * 2.0 * SIMULTANEOUS / (DURATION - FROM);
    Statement {
        place: "Sect. 6, Fig. 7",
        says: "The high peaks of the acceleration and of the contact force occur at the same time.",
        measured: format!(
            "Of the {PEAKS} highest acceleration peaks, within {} of one of the {PEAKS} highest force peaks of B1: case 3 {}, case 4 {}; of B1, B2 or B3: {}, {} (h = {}).",
            si(SIMULTANEOUS, "s"),
            percent(loose.0),
            percent(both.0),
            percent(loose.1),
            percent(both.1),
            si(c.settings.fine, "s")
        ),
        criterion: "at least 90 % with one of the three joints, in both cases",
        holds: loose.1 >= 0.9 && both.1 >= 0.9,
        factor: None,
        why: format!(
            "Three legs push the platform, so B1 alone cannot account for every peak. Chance would give {} for one joint.",
            percent(chance)
        ),
    }
}

fn enlarged_forces(m: &AllMeasures) -> Statement {
    let reference = m.ideal.force_peak;
    let ratio = [&m.flexible, &m.loose, &m.both].map(|m| m.force_peak / reference);
    Statement {
        place: "Sect. 6, 7, Fig. 7",
        says: "The contact forces are enlarged by the clearance.",
        measured: format!("Peak force in B1 over that of case 1 ({}): case 2 {}, case 3 {}, case 4 {} (h = {}).", si(reference, "N"), digits(ratio[0]), digits(ratio[1]), digits(ratio[2]), si(m.both.step, "s")),
        criterion: "above 1.5 in cases 3 and 4",
        holds: ratio[1] > 1.5 && ratio[2] > 1.5,
        factor: None,
        why: "After a loss of contact the journal returns with a speed that a stiff contact stops in a fraction of a millisecond.".into(),
    }
}

fn service_life(m: &AllMeasures) -> Statement {
    let ratio =
        [&m.loose, &m.both].map(|x| (x.force_cubic_mean / m.ideal.force_cubic_mean).powi(-3));
    Statement {
        place: "Sect. 6, 7",
        says: "The enlarged contact forces decrease the service life of the components, or even lead to failure.",
        measured: format!("Cubic-mean load of B1 gives {} (case 3) and {} (case 4) of the life of case 1 (h = {}).", percent(ratio[0]), percent(ratio[1]), si(m.both.step, "s")),
        criterion: "life ~ (cubic-mean load)^-3, as for rolling bearings, falls below 90 % in both",
        holds: ratio.iter().all(|r| *r < 0.9),
        factor: None,
        why: "Neither wear nor strength is part of the model, so failure cannot be decided here; the load spectrum can.".into(),
    }
}

fn sign_of_penetration(c: &Campaign, numbers: &mut Numbers) -> Statement {
    let consistent = |r: &Recording| {
        let (delta, force) = (r.column("B1.penetration"), r.column("B1.force"));
        delta
            .iter()
            .zip(force)
            .filter(|(d, f)| **d > 0.0 || **f == 0.0)
            .count() as f64
            / delta.len() as f64
    };
    let share = consistent(&c.loose).min(consistent(&c.both));
    numbers.put("b1.force_only_in_contact", share);
    Statement {
        place: "Sect. 6, Fig. 8",
        says: "Positive penetration means contact, negative means that journal and bearing are separated.",
        measured: format!(
            "In {} of the rows of cases 3 and 4 there is no force without positive penetration (h = {}).",
            percent(share),
            si(c.settings.fine, "s")
        ),
        criterion: "in all rows",
        holds: share == 1.0,
        factor: None,
        why: "By construction of the contact law; the text writes \"passive\" for negative.".into(),
    }
}

fn mostly_in_contact(m: &AllMeasures) -> Statement {
    let (loose, both) = (
        m.loose.contact.unwrap_or_default(),
        m.both.contact.unwrap_or_default(),
    );
    Statement {
        place: "Sect. 6, 7, Fig. 8",
        says: "For most of the time the joint components keep contact.",
        measured: format!("B1 is in contact {} (case 3) and {} (case 4) of the time; the joint that is least, {} and {} (h = {}).", percent(loose.0), percent(both.0), percent(loose.1), percent(both.1), si(m.both.step, "s")),
        criterion: "B1 above 50 % in both cases",
        holds: loose.0 > 0.5 && both.0 > 0.5,
        factor: None,
        why: "Inertia forces press the journals against the bearings except where their direction along a leg changes.".into(),
    }
}

fn periodic_flexible(c: &Campaign, m: &AllMeasures, numbers: &mut Numbers) -> Statement {
    let [coarse, fine, ..] = &c.sections;
    let mut spread = |r: &Recording, name: &str| {
        numbers.put(
            format!("{name}.section_spread"),
            fig09::spread(&fig09::section(c, r).1),
        )
    };
    let spreads = [spread(coarse, "case2_coarse"), spread(fine, "case2")];
    let repetition = [m.flexible.repetition, m.flexible_coarse.repetition];
    Statement {
        place: "Sect. 6, 7, Fig. 9a",
        says: "Case 2 is a periodic motion; the mechanism with flexible links is a periodical system.",
        measured: format!(
            "Distance between the accelerations of cycles 2 and 3: {} at h = {}, {} at h = {}. Spread of the stroboscopic section over {} periods: {} m/s² at h = {}, {} m/s² at h = {}.",
            percent(repetition[0]), si(m.flexible.step, "s"), percent(repetition[1]), si(m.flexible_coarse.step, "s"), c.settings.periods,
            digits(spreads[1]), si(fine.plan.step, "s"), digits(spreads[0]), si(coarse.plan.step, "s")
        ),
        criterion: "the distance is below 1 % of the amplitude at both steps",
        holds: repetition.iter().all(|r| *r < REPEATS),
        factor: None,
        why: "Undamped ringing is not commensurate with the period: the motion repeats as far as the step has damped the start.".into(),
    }
}

fn not_periodic_loose(c: &Campaign, m: &AllMeasures, numbers: &mut Numbers) -> Statement {
    let [_, _, loose, both] = &c.sections;
    let mut spread = |r: &Recording, name: &str| {
        numbers.put(
            format!("{name}.section_spread"),
            fig09::spread(&fig09::section(c, r).1),
        )
    };
    let spreads = [spread(loose, "case3"), spread(both, "case4")];
    Statement {
        place: "Sect. 6, 7, Fig. 9b, c",
        says: "Cases 3 and 4 are non-periodic: the curve does not repeat from cycle to cycle.",
        measured: format!(
            "Distance between the accelerations of cycles 2 and 3: case 3 {}, case 4 {} (h = {}). Spread of the stroboscopic section over {} periods: {} and {} m/s² (h = {}).",
            percent(m.loose.repetition), percent(m.both.repetition), si(m.both.step, "s"), c.settings.periods, digits(spreads[0]), digits(spreads[1]), si(loose.plan.step, "s")
        ),
        criterion: "the distance is above 1 % of the amplitude in both",
        holds: m.loose.repetition > REPEATS && m.both.repetition > REPEATS,
        factor: None,
        why: "Two cycles that differ are not yet chaos; the stroboscopic section over many periods and the row below say more.".into(),
    }
}

fn chaotic(c: &Campaign, numbers: &mut Numbers) -> Statement {
    // from ten times the displacement that the change itself makes to a twentieth of the clearance
    let (floor, ceiling) = (
        20.0 * TWIN_CHANGE * c.geometry.clearance,
        0.05 * c.geometry.clearance,
    );
    let mut text = Vec::new();
    let mut holds = true;
    for (case, (one, other)) in (2..).zip(&c.twins) {
        let pairs = one.column("error.x").iter().zip(other.column("error.x"));
        let apart: Vec<f64> = pairs.map(|(a, b)| a - b).collect();
        let rate = growth_rate(&one.t, &apart, floor, ceiling);
        numbers.put(format!("case{case}.twin_growth_rate"), rate.unwrap_or(0.0));
        let largest = numbers.put(format!("case{case}.twin_largest_distance"), peak(&apart));
        holds &= rate.is_some() == (case > 2);
        text.push(match rate {
            Some(rate) => format!(
                "case {case} e-fold in {}, largest {}",
                si(1.0 / rate, "s"),
                si(largest, "m")
            ),
            None => format!(
                "case {case} never reach {}, largest {}",
                si(ceiling, "m"),
                si(largest, "m")
            ),
        });
    }
    Statement {
        place: "Sect. 6, Fig. 9",
        says: "The collision between the joint components causes chaotic motion.",
        measured: format!("Two runs of {} that differ by {TWIN_CHANGE:e} in one parameter part in e_x: {} (h = {}).", si(TWIN_DURATION, "s"), text.join("; "), si(TWIN_STEP, "s")),
        criterion: "twins part to a twentieth of the clearance in cases 3 and 4 and not in case 2",
        holds,
        factor: None,
        why: "Sensitivity to a tiny change is the mark of chaos, but parting twins alone do not prove it: impacts multiply a difference, phases of lasting contact shrink it again.".into(),
    }
}

fn smoother(m: &AllMeasures) -> Statement {
    let crest = |m: &crate::measures::Measures| peak(&m.deviation);
    Statement {
        place: "Sect. 7",
        says: "The mechanism is influenced by the link flexibility in a smoother way than by the clearance.",
        measured: format!(
            "Largest deviation of the acceleration: case 2 {} m/s² (h = {}) and {} m/s² (h = {}), case 3 {} m/s² (h = {}).",
            digits(crest(&m.flexible)),
            si(m.flexible.step, "s"),
            digits(crest(&m.flexible_coarse)),
            si(m.flexible_coarse.step, "s"),
            digits(crest(&m.loose)),
            si(m.loose.step, "s")
        ),
        criterion: "case 2 is less than half of case 3 at both steps",
        holds: crest(&m.flexible).max(crest(&m.flexible_coarse)) < 0.5 * crest(&m.loose),
        factor: None,
        why: "Flexibility adds a linear vibration, clearance adds impacts.".into(),
    }
}

fn nonlinear_interaction(m: &AllMeasures) -> Statement {
    let apart = m.flexible.deviation_rms.hypot(m.loose.deviation_rms);
    let ratio = m.both.deviation_rms / apart;
    Statement {
        place: "Sect. 7",
        says: "Joint clearance and link flexibility interact with each other in a nonlinear way.",
        measured: format!("Rms deviation of the acceleration in case 4: {} m/s²; independent contributions of cases 2 and 3 would give {} m/s² (h = {}).", digits(m.both.deviation_rms), digits(apart), si(m.both.step, "s")),
        criterion: "differs by more than 10 % from the root of the sum of squares",
        holds: (ratio - 1.0).abs() > 0.1,
        factor: None,
        why: "A flexible link changes the impacts themselves: their speed, their stiffness and their times.".into(),
    }
}
