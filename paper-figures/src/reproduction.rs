//! Writes REPRODUCTION.md: the figures, every statement of the paper and what decides it.

use crate::campaign::{Campaign, DURATION, FROM};
use crate::evidence::Evidence;
use crate::fig05::CLAIMED;
use crate::interval::{CriterionVerdict, OF_THREE, STARTS};
use crate::kinematics::MechanismGeometry;
use crate::measures::energy_lost;
use crate::numbers::Numbers;
use crate::signal::peak;
use crate::statement::{Basis, Statement};
use crate::{
    statements_acceleration, statements_contact, statements_error, statements_introduction,
    statements_model, statements_setup,
};
use looselink::body::FlexibleLink;
use numbers::{digits, percent, si};
use std::fmt::Write;

/// Pairs of statements whose criteria exclude each other, and why.
const CONFLICTS: [(&str, &str, &str); 3] = [
    (
        "very different",
        "slightly",
        "in case 2 the first requires a deviation above 25 % of the ideal acceleration, the second a deviation below 25 %",
    ),
    (
        "geometry",
        "error 3",
        "for the printed lengths and clearance the kinematic bound lies below the criterion of the second, whatever the contact law",
    ),
    (
        "steady",
        "velocities",
        "links that start unstrained with the velocities of the rigid mechanism vibrate; the model has no damping (eq. 17), so only numerical damping can make case 2 steady",
    ),
];

/// The page.
pub fn page(e: &Evidence, numbers: &mut Numbers) -> String {
    let statements = statements(e);
    let mut page = format!(
        "# Reproduction of Zhang & Zhang 2017\n\n{}\n\
         `cargo run --release -p paper-figures` writes this page. The scenes have the printed parameters, and assumed values, \
         marked as such, for those that are not printed; nothing is tuned. [SCANS.md](SCANS.md) varies the assumed values. \
         [ENSEMBLES.md](ENSEMBLES.md) has the ensembles, the Lyapunov exponents and the comparisons of meshes and methods. All \
         numbers are in `figures/numbers.json` and `figures/ensembles.json`.\n\n\
         {}\n\n\
         Only the text of the paper was compared, not its curves: they are not available as data and were not digitised. \
         Quantities are taken from the last two of three cycles, {FROM} s to {DURATION} s, as in the paper.\n\n\
         Cases 3 and 4 are chaotic, so a single run decides nothing. Each verdict on them rests on {OF_THREE} runs: three \
         ensembles of {STARTS}, in which the platform starts 1e-14, 1e-12 or 1e-10 m from the printed start, in a different \
         direction in every run. These runs use the trapezoidal rule with a requested accuracy of 1 µm and 100 nJ over 10 ms \
         (\"controlled\"). \"a ± b\" is a mean and the half width of its 95 % interval (Student's t). A statement is undecided \
         where this interval contains the limit of its criterion. In the ensembles the integrator loses or gains less than 5 % \
         of the contact dissipation, unless a warning beside the verdict says otherwise.\n\n",
        records::place("reproduction"),
        count(&statements, numbers)
    );
    for (figure, about) in [
        (5, "Displacement error of the platform along x"),
        (6, "Acceleration of the platform along x"),
        (7, "Force in joint B1"),
        (8, "Penetration in joint B1"),
        (9, "Phase portraits and stroboscopic sections"),
    ] {
        let _ = write!(
            page,
            "## Fig. {figure}: {about}\n\n![Fig. {figure}: {about}](figures/fig{figure}.png)\n\n"
        );
    }
    page += "## All statements\n\n| | where | the paper says | verdict |\n|---|---|---|---|\n";
    page.extend((1..).zip(&statements).map(|(i, s)| s.row(i)));
    page += "\n## Criteria that exclude each other\n\nFor the printed parameters, the two statements of a pair cannot both hold:\n\n";
    for (one, other, why) in CONFLICTS {
        let number = |key: &str| {
            statements
                .iter()
                .position(|s| s.key == key)
                .map_or(0, |i| i + 1)
        };
        let _ = writeln!(page, "* {} and {}: {why}.", number(one), number(other));
    }
    page += "\n## Statement by statement\n\n";
    page.extend((1..).zip(&statements).map(|(i, s)| s.paragraph(i)));
    page += &sizes_alone(e, &statements);
    page += "## Two arguments that need no simulation\n\n";
    page += &bound_argument(e, numbers);
    page += &stiffness_argument(e.c, numbers);
    page += &runs_table(e, numbers);
    keep(e, numbers);
    page
}

fn statements(e: &Evidence) -> Vec<Statement> {
    let mut statements = statements_introduction::statements(e);
    statements.extend(statements_model::statements(e));
    statements.extend(statements_setup::statements(e));
    statements.extend(statements_error::statements(e));
    statements.extend(statements_acceleration::statements(e));
    statements.extend(statements_contact::statements(e));
    statements
}

/// Which verdicts would be others if cases 3 and 4 were judged by the runs of one size of the displacement alone.
fn sizes_alone(e: &Evidence, together: &[Statement]) -> String {
    let mut text = format!(
        "## One size of the displacement alone\n\n\
         The verdicts on cases 3 and 4 rest on three sizes of the displacement together. Verdicts that the {STARTS} runs of \
         one size alone would change:\n\n"
    );
    for (e, moved) in e.of_each_size() {
        let alone = statements(&e);
        let pairs = (1..).zip(together.iter().zip(&alone));
        let changed: Vec<String> = pairs
            .filter(|(_, (all, one))| all.verdict != one.verdict)
            .map(|(i, (all, one))| {
                format!(
                    "statement {i} from \"{}\" to \"{}\"",
                    all.verdict(),
                    one.verdict()
                )
            })
            .collect();
        let changed = match changed.is_empty() {
            true => "none".into(),
            false => changed.join("; "),
        };
        let _ = writeln!(text, "* {moved:e} m: {changed}.");
    }
    text + "\n"
}

/// How many statements came out how, in words.
fn count(statements: &[Statement], numbers: &mut Numbers) -> String {
    let of = |basis: Basis, verdict: CriterionVerdict| {
        let found = statements.iter().filter(|s| s.verdict == verdict);
        found.filter(|s| s.basis == basis).count()
    };
    let undecided = statements
        .iter()
        .filter(|s| s.verdict == CriterionVerdict::Undecided)
        .count();
    numbers.put("statements", statements.len() as f64);
    numbers.put("statements.undecided", undecided as f64);
    let reported: Vec<String> = [
        (Basis::Measurement, "measurement"),
        (Basis::Construction, "construction"),
        (Basis::Assumption, "an assumed value"),
    ]
    .into_iter()
    .map(|(basis, name)| {
        let (holds, fails) = (
            of(basis, CriterionVerdict::Holds),
            of(basis, CriterionVerdict::Fails),
        );
        numbers.put(format!("statements.by_{name}.hold"), holds as f64);
        numbers.put(format!("statements.by_{name}.do_not_hold"), fails as f64);
        format!("| by {name} | {holds} | {fails} |\n")
    })
    .collect();
    format!(
        "{} statements of the paper can be checked. Undecided: {undecided}. The others are decided as follows:\n\n\
         | | hold | do not hold |\n|---|---|---|\n{}\n\
         \"By construction\": the equations or the scene allow no other outcome. \"By an assumed value\": the outcome depends \
         on a value that the paper does not give.",
        statements.len(),
        reported.concat()
    )
}

/// Keeps what was measured.
fn keep(e: &Evidence, numbers: &mut Numbers) {
    let runs = [
        ("case1", &e.ideal),
        ("case2", &e.flexible),
        ("case2_coarse", &e.flexible_coarse),
    ];
    for (name, measures) in runs {
        for (what, value) in &measures.0 {
            numbers.put(format!("{name}.{what}"), *value);
        }
    }
    for ensemble in &e.e.ensembles {
        for what in ensemble.members[0].measures.0.keys() {
            let mean = ensemble.mean(what);
            let name = format!("ensemble.{}.{what}", ensemble.name);
            numbers.put(format!("{name}.mean"), mean.mean);
            numbers.put(format!("{name}.half_width_95"), mean.half);
        }
    }
}

fn bound_argument(e: &Evidence, numbers: &mut Numbers) -> String {
    let g = &e.c.geometry;
    let slack = 2.0 * g.clearance;
    let printed = numbers.put("bound.printed", g.largest_bound_x(slack));
    let shrink = |p: [f64; 2]| p.map(|v| v / 3f64.sqrt());
    let side = MechanismGeometry {
        base: g.base.map(shrink),
        ..g.clone()
    };
    let side_bound = numbers.put("bound.side", side.largest_bound_x(slack));
    let mixed: Vec<f64> = (0..3)
        .flat_map(|leg| {
            [1.0, -1.0].map(|sign| std::array::from_fn(|i| if i == leg { -sign } else { sign }))
        })
        .map(|elbow| MechanismGeometry { elbow, ..g.clone() }.largest_bound_x(slack))
        .collect();
    let least = numbers.put(
        "bound.mixed_least",
        mixed.iter().copied().fold(f64::INFINITY, f64::min),
    );
    let most = numbers.put(
        "bound.mixed_most",
        mixed.iter().copied().fold(0.0, f64::max),
    );
    let used = [e.loose(), e.both()].map(|ensemble| ensemble.mean("bound_used"));
    format!(
        "**Case 3 cannot reach ±0.2 mm.** For rigid links, at every instant and in every leg, \
         | ‖C − B‖ − l₂ | ≤ |e_B| + |e_C|, and each eccentricity is at most the clearance plus the penetration. With \
         the velocity Jacobian J of the leg lengths this gives |e_x| ≤ Σᵢ |J⁻¹|ₓᵢ · 2 (c + penetration). Without \
         penetration its largest value on the path is:\n\n\
         | interpretation of the geometry | largest bound of \\|e_x\\| | over the paper's 0.2 mm |\n|---|---|---|\n\
         | as printed: 0.4 m is the circumradius, equal elbows | {} | {} |\n\
         | 0.4 m is the side of the fixed triangle | {} | {} |\n\
         | mixed elbows (near-singular), six combinations | {} to {} | {} to {} |\n\n\
         The bound is sharp: the largest error over the bound at the same instant is {} in case 3 and {} in case 4, whose \
         bound includes the stretch of the links. The text says \"circumscribed circle\", so the first row is the printed \
         geometry.\n\n",
        si(printed, "m"),
        digits(printed / CLAIMED),
        si(side_bound, "m"),
        digits(side_bound / CLAIMED),
        si(least, "m"),
        si(most, "m"),
        digits(least / CLAIMED),
        digits(most / CLAIMED),
        used[0].reported(digits),
        used[1].reported(digits),
    )
}

fn stiffness_argument(c: &Campaign, numbers: &mut Numbers) -> String {
    let link = c.flexible.scene.bodies.iter().find_map(|b| {
        let FlexibleLink {
            link,
            youngs_modulus,
            ..
        } = b.kind.get()?;
        Some((link.area * youngs_modulus, link.length))
    });
    let (axial, length) = link.unwrap_or((f64::NAN, f64::NAN));
    let stiffness = numbers.put("case2.axial_stiffness", axial / length);
    let strain = ["link1.strain", "link2.strain", "link3.strain"]
        .map(|name| peak(c.flexible.between(name, FROM, DURATION).1))
        .into_iter()
        .fold(0.0, f64::max);
    let strain = numbers.put("case2.largest_strain", strain);
    format!(
        "**Case 2 cannot reach ±0.2 mm.** Pin-ended links move the platform only by changing length. \
         Their axial stiffness is E A / l₂ = {}. The largest axial strain of the run ({}) is {}: a stretch of {} under a force \
         of {}. An error of 0.2 mm would need a stretch of that order, and so a force of about {}.\n\n",
        si(stiffness, "N/m"),
        c.flexible.plan.pace.label(),
        digits(strain),
        si(strain * length, "m"),
        si(strain * axial, "N"),
        si(CLAIMED * stiffness, "N"),
    )
}

fn runs_table(e: &Evidence, numbers: &mut Numbers) -> String {
    let mut table = String::from(
        "## The runs\n\n\"Energy lost\" is the largest energy that the integrator has lost (negative: gained) by any row, over the contact \
         dissipation or, in case 2, over the largest elastic energy.\n\n\
         | run | scene | changed | duration | method | steps | Newton iterations | onsets | energy lost | warnings |\n\
         |---|---|---|---|---|---|---|---|---|---|\n",
    );
    for r in e.c.runs() {
        let p = &r.plan;
        let changed = if p.overrides.is_empty() {
            "–".into()
        } else {
            format!("`{}`", p.overrides.join("`, `"))
        };
        let lost = if p.case == 1 {
            "–".into()
        } else {
            percent(energy_lost(r))
        };
        let _ = writeln!(
            table,
            "| {} | `{}` | {changed} | {} s | {} | {} | {} | {} | {lost} | {} |",
            r.number,
            p.scene_name(),
            digits(p.duration),
            p.pace.label(),
            r.report.steps,
            r.report.newton_iterations,
            r.report.onsets,
            reported(&r.warnings)
        );
        let report = serde_json::to_value(&r.report).unwrap_or_default();
        numbers.put_value(format!("run.{}", r.number), report);
        numbers.put_value(
            format!("run.{}.warnings", r.number),
            r.warnings.clone().into(),
        );
    }
    table += "\n| ensemble | case | start displaced by | changed | method | energy lost | warnings |\n|---|---|---|---|---|---|---|\n";
    for ensemble in &e.e.ensembles {
        let changed = if ensemble.changed.is_empty() {
            "–".into()
        } else {
            format!("`{}`", ensemble.changed)
        };
        let _ = writeln!(
            table,
            "| {} | {} | {:e} m | {changed} | {} | {} | {} |",
            ensemble.name,
            ensemble.case,
            ensemble.moved,
            ensemble.how,
            ensemble.mean("energy_lost").reported(percent),
            reported(&ensemble.source().warnings)
        );
    }
    table
}

fn reported(warnings: &[String]) -> String {
    if warnings.is_empty() {
        "none".into()
    } else {
        warnings.join("; ")
    }
}
