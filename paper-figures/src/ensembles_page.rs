//! Writes ENSEMBLES.md and its pictures from the record of `ensembles`.

use crate::ensembles::{MESHES, RETARDATIONS, damped_name};
use crate::exponents::{DURATION as EXPONENT_DURATION, KEPT_INTERVAL, LEFT_OUT};
use crate::figures::case_color;
use crate::interval::{Interval, OF_THREE, STARTS};
use crate::measures::Measures;
use crate::methods::HORIZON;
use crate::record::{BOTH, Ensemble, EnsembleRecord, Exponents, Single};
use crate::runs::words;
use crate::shuffles::{PAIRS, SHUFFLES, Test};
use crate::warned::{WarningSource, reported};
use numbers::{digits, percent, si};
use plot::{Axis, Color, Figure, Mark, Panel, palette};
use std::fmt::Write;

/// Probability below which a difference counts as more than chance.
const LEVEL: f64 = 0.05;
/// Distance of runs that have parted: the printed clearance \[m\].
const PARTED: f64 = 2e-5;

/// A measure, its words and how it is written.
struct ShownMeasure {
    name: &'static str,
    words: &'static str,
    show: fn(f64) -> String,
}

const SHOWN: [ShownMeasure; 12] = [
    shown("error_peak", "largest \\|e_x\\|", |v| si(v, "m")),
    shown("error_rms", "rms e_x", |v| si(v, "m")),
    shown("deviation_rms", "rms deviation of acceleration", |v| {
        si(v, "m/s²")
    }),
    shown("deviation_peak", "largest deviation of acceleration", |v| {
        si(v, "m/s²")
    }),
    shown("deviation_frequency", "its median frequency", |v| {
        si(v, "Hz")
    }),
    shown("repetition", "distance of cycles 2 and 3", percent),
    shown("force_peak", "peak force in B1", |v| si(v, "N")),
    shown("force_cubic_mean", "cubic-mean force in B1", |v| si(v, "N")),
    shown("contact_b1", "contact of B1", percent),
    shown("peaks_after_onset", "peaks that follow an onset", percent),
    shown("peaks_with_any", "peaks with a peak of force", percent),
    shown("onsets", "onsets in two cycles", digits),
];

const fn shown(name: &'static str, words: &'static str, show: fn(f64) -> String) -> ShownMeasure {
    ShownMeasure { name, words, show }
}

/// The ensembles of a case that differ by the size of the displacement alone, by that size.
fn sizes(record: &EnsembleRecord, case: u32, first: usize) -> Vec<&Ensemble> {
    let mut all = record.sizes(case, first);
    all.sort_by(|a, b| a.moved.total_cmp(&b.moved));
    all
}

/// The ensembles of case 4, by the number of elements.
fn meshes(record: &EnsembleRecord) -> Vec<&Ensemble> {
    let finer = record
        .ensembles
        .iter()
        .filter(|e| e.changed.contains("elements"));
    [record.ensemble(BOTH)].into_iter().chain(finer).collect()
}

/// The pictures.
pub fn figures(record: &EnsembleRecord) -> Vec<(&'static str, Figure)> {
    vec![
        ("ensembles-starts", starts_figure(record)),
        ("ensembles-exponents", exponents_figure(record)),
        ("ensembles-meshes", meshes_figure(record)),
        ("ensembles-methods", methods_figure(record)),
    ]
}

/// Begins the list of scenes of a caption.
const SCENES: &str = "Scenes in scenes/3rrr:";
/// The method of the ensembles.
const CONTROLLED: &str =
    "trapezoidal rule, requested accuracy 1\u{a0}µm and 100\u{a0}nJ over 10\u{a0}ms";

/// The steps of the exponents.
fn steps(record: &EnsembleRecord) -> String {
    let mut steps: Vec<String> = Vec::new();
    for e in &record.exponents {
        let step = e.how.rsplit(", ").next().unwrap_or_default();
        steps.push(format!("case {}: {step}", e.case));
    }
    steps.dedup();
    steps.join("; ")
}

/// How many runs warn of something; the page says of what.
fn warned(sources: usize, of: usize) -> String {
    match sources {
        0 => "No run warns of anything.".into(),
        n => format!("{n} of {of} runs warn of something; the tables of ENSEMBLES.md say of what."),
    }
}

fn warned_members<'a>(ensembles: impl Iterator<Item = &'a Ensemble>) -> (usize, usize) {
    let members = ensembles.flat_map(|e| &e.members);
    members.fold((0, 0), |(w, n), m| {
        (w + usize::from(!m.warnings.is_empty()), n + 1)
    })
}

fn starts_figure(record: &EnsembleRecord) -> Figure {
    let colors = [palette::BLUE, palette::VERMILION, palette::GREEN];
    let panel = |letter: &str, case: u32, first: usize| {
        let ensembles = sizes(record, case, first);
        let mut marks = Vec::new();
        for (i, (ensemble, color)) in ensembles.iter().zip(colors).enumerate() {
            let offset = 0.22 * (i as f64 - 1.0);
            let (mut x, mut y) = (Vec::new(), Vec::new());
            for (row, s) in SHOWN.iter().enumerate() {
                let of = ensemble.mean(s.name);
                let one = ensembles[1].mean(s.name).mean;
                let at = row as f64 + offset;
                x.push(of.mean / one);
                y.push(at);
                let ends = [(of.mean - of.half) / one, (of.mean + of.half) / one];
                marks.push(Mark::curve("", color, &ends, &[at; 2]).width(4));
            }
            let label = format!("{:e} m", ensemble.moved);
            marks.push(Mark::points(&label, color, &x, &y, 7));
        }
        let names = SHOWN
            .iter()
            .map(|s| s.words.replace('\\', "").replace("e_x", "eₓ"))
            .collect();
        Panel {
            title: format!(
                "{letter}) Case {case}, {} set",
                if first == 0 { "first" } else { "second" }
            ),
            note: String::new(),
            x: Axis::new("Mean over that of 1e-12 m", "", 1.0),
            y: Axis::categories(names),
            marks,
        }
    };
    let all = [(3, 0), (3, STARTS), (4, 0), (4, STARTS)];
    let all = all
        .iter()
        .flat_map(|(case, first)| sizes(record, *case, *first));
    let (warns, of) = warned_members(all);
    Figure {
        rows: vec![
            vec![panel("a", 3, 0), panel("b", 3, STARTS)],
            vec![panel("c", 4, 0), panel("d", 4, STARTS)],
        ],
        caption: format!(
            "Ensembles of {STARTS} runs each, whose starts are moved by three sizes of a displacement: means with 95 % \
             intervals, over the mean of the middle size. The starts of the second set lie in directions between those of the first. {SCENES} case3.toml and case4.toml; {CONTROLLED}; cycles 2 and 3. {}",
            warned(warns, of)
        ),
    }
}

fn exponents_figure(record: &EnsembleRecord) -> Figure {
    let mut marks = Vec::new();
    for e in &record.exponents {
        let t: Vec<f64> = (1..=e.growth.len())
            .map(|i| i as f64 * KEPT_INTERVAL)
            .collect();
        let first = record.exponents(e.case).next().map(|x| x.distance);
        let fine = first != Some(e.distance);
        let label = format!("case {}, d₀ = {:e}", e.case, e.distance);
        let mark = Mark::series(&label, case_color(e.case), &t, &e.growth);
        marks.push(mark.width(if fine { 3 } else { 7 }));
    }
    let runs = record.exponents.iter().flat_map(|e| &e.warnings);
    let warns = runs.clone().filter(|w| !w.is_empty()).count();
    let panel = Panel {
        title: "Growth of the distance between neighbouring motions".into(),
        note: "The slope is the largest Lyapunov exponent.".into(),
        x: Axis::new("Time t", "s", 1.0),
        y: Axis::new("Sum of ln(d/d₀), mean of the starts", "", 1.0),
        marks,
    };
    Figure {
        rows: vec![vec![panel]],
        caption: format!(
            "Benettin's method: a neighbouring motion is brought back to the distance d₀ every millisecond. {SCENES} \
             case2.toml to case4.toml; trapezoidal rule with equal steps ({}). Each line is the mean of {STARTS} starts. Thin \
             lines: the smaller d₀. {}",
            steps(record),
            warned(warns, runs.count())
        ),
    }
}

fn meshes_figure(record: &EnsembleRecord) -> Figure {
    let singles = MESHES.map(|n| record.single(&mesh_name(n)));
    let ensembles = meshes(record);
    let elements: Vec<f64> = MESHES.iter().map(|n| *n as f64).collect();
    let panel =
        |letter: &str, title: &str, label: &str, unit: &'static str, factor: f64, name: &str| {
            let two: Vec<f64> = singles.iter().map(|s| s.measures.get(name)).collect();
            let four: Vec<Interval> = ensembles.iter().map(|e| e.mean(name)).collect();
            let mean: Vec<f64> = four.iter().map(|i| i.mean).collect();
            let (green, red) = (case_color(2), case_color(4));
            let mut marks = vec![
                Mark::curve("case 2", green, &elements, &two).width(3),
                Mark::points("", green, &elements, &two, 7),
                Mark::curve("case 4, mean and 95 % interval", red, &elements, &mean).width(3),
                Mark::points("", red, &elements, &mean, 7),
            ];
            for (n, i) in elements.iter().zip(&four) {
                let ends = [i.mean - i.half, i.mean + i.half];
                marks.push(Mark::curve("", red, &[*n; 2], &ends).width(5));
            }
            Panel {
                title: format!("{letter}) {title}"),
                note: String::new(),
                x: Axis::new("Elements a link", "", 1.0)
                    .over(0.7, 11.0)
                    .log_at(elements.clone()),
                y: match name {
                    // case 4 has seventy times the error of case 2
                    "error_peak" => Axis::new(label, unit, factor).log(),
                    _ => Axis::new(label, unit, factor),
                },
                marks,
            }
        };
    let (warns, of) = warned_members(ensembles.iter().copied());
    let alone = singles.iter().filter(|s| !s.warnings.is_empty()).count();
    Figure {
        rows: vec![
            vec![
                panel(
                    "a",
                    "Displacement error",
                    "Largest |eₓ|",
                    "µm",
                    1e6,
                    "error_peak",
                ),
                panel(
                    "b",
                    "Acceleration",
                    "Rms deviation",
                    "m/s²",
                    1.0,
                    "deviation_rms",
                ),
            ],
            vec![
                panel(
                    "c",
                    "Frequency",
                    "Median frequency of the deviation",
                    "Hz",
                    1.0,
                    "deviation_frequency",
                ),
                panel(
                    "d",
                    "Force in joint B1",
                    "Peak force",
                    "N",
                    1.0,
                    "force_peak",
                ),
            ],
        ],
        caption: format!(
            "Cases 2 and 4 with finer meshes, over cycles 2 and 3. {SCENES} case2.toml and case4.toml; {CONTROLLED}. Case 2: one \
             run; case 4: {STARTS} runs. {}",
            warned(warns + alone, of + singles.len())
        ),
    }
}

const METHOD_COLORS: [(&str, Color); 6] = [
    ("bathe", palette::BLUE),
    ("trapezoidal", palette::VERMILION),
    ("generalized_alpha", palette::GREEN),
    ("hht", palette::PURPLE),
    ("dormand_prince", palette::BLACK),
    ("velocity_verlet", palette::ORANGE),
];

fn methods_figure(record: &EnsembleRecord) -> Figure {
    let panel = |case: u32, letter: &str| {
        let mut marks = Vec::new();
        for (method, color) in METHOD_COLORS {
            let runs = record
                .work
                .iter()
                .filter(|w| w.case == case && w.method == method);
            let points: Vec<(f64, f64)> = runs
                .filter_map(|w| Some((w.evaluations as f64, w.error? / w.size)))
                .collect();
            if points.is_empty() {
                continue;
            }
            let (x, y): (Vec<f64>, Vec<f64>) = points.into_iter().unzip();
            marks.push(Mark::curve(words(method), color, &x, &y).width(3));
            marks.push(Mark::points("", color, &x, &y, 6));
        }
        Panel {
            title: format!("{letter}) Case {case}"),
            note: String::new(),
            x: Axis::new("Evaluations of the elastic force of an element", "", 1.0).log(),
            y: Axis::new("Largest error of eₓ over largest |eₓ|", "", 1.0).log(),
            marks,
        }
    };
    let warns = record
        .work
        .iter()
        .filter(|w| !w.warnings.is_empty())
        .count();
    Figure {
        rows: vec![vec![panel(2, "a"), panel(4, "b")]],
        caption: format!(
            "Error of explicit (Dormand-Prince, velocity Verlet) and implicit methods against counted work, over the first {}. \
             {SCENES} case2.toml and case4.toml; equal steps from 100 µs to 0.2 µs. \
             An implicit evaluation includes the tangent. Runs that stop have no dot. {}",
            si(HORIZON, "s"),
            warned(warns, record.work.len())
        ),
    }
}

fn mesh_name(elements: usize) -> String {
    format!("{elements} elements a link")
}

/// The page.
pub fn page(record: &EnsembleRecord) -> String {
    let mut page = format!(
        "# Ensembles, exponents, meshes and methods\n\n{}\n\
         Generated by `cargo run --release -p paper-figures -- ensembles`; the numbers are in `figures/ensembles.json`.\n\n\
         Cases 3 and 4 of the paper are chaotic: two runs that differ by the rounding of one number part within \
         milliseconds. Their quantities are therefore means over {STARTS} runs. The runs of an ensemble differ in the start \
         of the platform alone, which the scene's `initial.bodies` moves by a tiny distance, each time in another of {STARTS} \
         directions. \"Mean ± half width\" is a mean with its 95 % interval (Student's t). Quantities are taken over the last \
         two of three cycles.\n\n\
         Runs of ensembles use the trapezoidal rule with a requested accuracy of 1 µm and 100 nJ over 10 ms: the cheapest \
         way found to an energy ledger that closes to a few per cent of the contact dissipation. Tables call it \
         \"controlled\". \"Energy lost\" \
         is the largest energy that the integrator has lost (negative: gained) by any row, over that dissipation; in case 2, \
         where nothing dissipates, over the largest elastic energy.\n\n",
        records::place("ensembles"),
    );
    page += &ensembles_section(record);
    page += &starts_section(record);
    page += &exponents_section(record);
    page += &meshes_section(record);
    page += &singles_section(record);
    page += &work_section(record);
    page += &long_section(record);
    page
}

fn ensembles_section(record: &EnsembleRecord) -> String {
    let mut text = String::from(
        "## The ensembles\n\n\
         A warning is printed once for all runs that have it, with the range of its numbers.\n\n\
         | ensemble | case | starts moved by | changed | energy lost | warnings |\n|---|---|---|---|---|---|\n",
    );
    for e in &record.ensembles {
        let changed = match (e.changed.as_str(), e.first) {
            ("", 0) => "–".into(),
            ("", _) => "directions between those of the first".into(),
            (changed, _) => format!("`{changed}`"),
        };
        let WarningSource { warnings, .. } = e.source();
        let _ = writeln!(
            text,
            "| {} | {} | {:e} m | {changed} | {} | {} |",
            e.name,
            e.case,
            e.moved,
            e.mean("energy_lost").reported(percent),
            reported(&warnings)
        );
    }
    text + "\n"
}

/// Three ensembles of a case that differ by the size of the displacement alone, and the test whether their means do.
struct Sizes<'a> {
    ensembles: Vec<&'a Ensemble>,
    test: Test,
}

impl Sizes<'_> {
    fn of(record: &EnsembleRecord, case: u32, first: usize) -> Sizes<'_> {
        let ensembles = sizes(record, case, first);
        let values = |s: &ShownMeasure| ensembles.iter().flat_map(|e| e.values(s.name)).collect();
        let quantities: Vec<Vec<f64>> = SHOWN.iter().map(values).collect();
        Sizes {
            test: Test::of(&quantities),
            ensembles,
        }
    }

    fn names(&self) -> String {
        let names: Vec<&str> = self.ensembles.iter().map(|e| e.name.as_str()).collect();
        names.join(", ")
    }

    /// The row of the table of tests.
    fn row(&self, case: u32) -> String {
        let Test { differing, .. } = self.test;
        let (quantity, pair) = self.test.largest();
        let (i, j) = PAIRS[pair];
        format!(
            "| {case} | {} | {differing} | {} | {} | {}: {} (ensembles {}, {}) | {} |\n",
            self.names(),
            digits(self.test.by_chance),
            p_value(self.test.p_differing),
            SHOWN[quantity].words,
            digits(self.test.apart[quantity][pair]),
            self.ensembles[i].name,
            self.ensembles[j].name,
            p_value(self.test.p[quantity][pair])
        )
    }

    /// The means of all quantities.
    fn table(&self, case: u32) -> String {
        let mut table = format!("| case {case} |");
        for e in &self.ensembles {
            let _ = write!(table, " {:e} m (ensemble {}) |", e.moved, e.name);
        }
        table += " p |\n|---|---|---|---|---|\n";
        for (i, s) in SHOWN.iter().enumerate() {
            let means = self
                .ensembles
                .iter()
                .map(|e| e.mean(s.name).reported(s.show));
            let cells: Vec<String> = means.collect();
            let p = p_value(self.test.least(i));
            let _ = writeln!(table, "| {} | {} | {p} |", s.words, cells.join(" | "));
        }
        table + "\n"
    }
}

/// What the tests of two sets of ensembles say of a case.
fn outcome(case: u32, sets: &[Sizes; 2]) -> String {
    let shown = |p: [f64; 2]| p.into_iter().all(|p| p < LEVEL);
    let whole = sets.each_ref().map(|s| s.test.p_differing);
    let single = |q: &usize| shown(sets.each_ref().map(|s| s.test.least(*q)));
    let found: Vec<&str> = (0..SHOWN.len())
        .filter(single)
        .map(|q| SHOWN[q].words)
        .collect();
    let mut text = format!("Case {case}: ");
    text += match shown(whole) {
        true => "**the number of differing means is above chance in both sets.**",
        false => "the number of differing means is not above chance in both sets.",
    };
    text += match found.is_empty() {
        true => " No single quantity differs in both sets.",
        false => " **These quantities differ in both sets:** ",
    };
    text += &found.join("; ");
    for (q, s) in SHOWN.iter().enumerate() {
        let least = sets.each_ref().map(|set| set.test.least(q));
        if least.iter().any(|p| *p < LEVEL) && !shown(least) {
            let [first, second] = least.map(p_value);
            let _ = write!(
                text,
                " \"{}\" differs in one set alone (p = {first} in the first, {second} in the second) and is taken for chance.",
                s.words
            );
        }
    }
    text
}

/// A p-value, of which the least is 1e-4.
fn p_value(p: f64) -> String {
    format!("{p:.4}")
}

/// When the smallest displacement has grown to the clearance, at the largest Lyapunov exponent of a case \[s\].
fn parting(record: &EnsembleRecord, case: u32) -> f64 {
    let rates = record.exponents(case).map(|e| e.mean().mean);
    let least = rates.fold(f64::INFINITY, f64::min);
    let moved = sizes(record, case, 0)[0].moved;
    (PARTED / moved).ln() / least
}

fn starts_section(record: &EnsembleRecord) -> String {
    let mut tests = String::new();
    let (mut tables, mut outcomes) = (String::new(), String::new());
    for case in [3, 4] {
        let sets = [0, STARTS].map(|first| Sizes::of(record, case, first));
        for set in &sets {
            tests += &set.row(case);
            tables += &set.table(case);
        }
        let _ = writeln!(outcomes, "* {}", outcome(case, &sets));
    }
    let parted = [3, 4].map(|case| si(parting(record, case), "s"));
    format!(
        "## The size of the displacement\n\n\
         ![Means of ensembles whose starts are moved by three sizes](figures/ensembles-starts.png)\n\n\
         Does it matter whether the starts differ by 1e-14, 1e-12 or 1e-10 m? If it does not, the size is a label without \
         meaning, and any other assignment of the {OF_THREE} runs of a case to the sizes is as likely as the actual one. A \
         permutation test compares the actual one with {SHUFFLES} random ones. Each run keeps all its quantities, so the test \
         is right although these depend on each other. It has two statistics: the number of pairs of means, out of {}, that \
         differ at the 95 % level (Student's t), and the largest difference of two means over its standard error. p is the \
         share of assignments whose statistic is at least the actual one. The p of a single quantity is corrected for all \
         quantities and pairs of the case: it refers to the largest difference of any of them.\n\n\
         Among several tests, p < {LEVEL} occurs by chance. The six ensembles are therefore made twice; in the second set the \
         starts lie in directions between those of the first. A difference made by the size would be there in both sets, and \
         it counts as found where p < {LEVEL} in both. [REPRODUCTION.md](REPRODUCTION.md) uses the first set.\n\n\
         | case | ensembles | pairs that differ | mean of the random assignments | p | largest difference, in standard errors | p |\n\
         |---|---|---|---|---|---|---|\n{tests}\n{outcomes}\n\
         Could the runs of the smallest displacement still be alike? At the exponents below it grows to the clearance within \
         {} in case 3 and {} in case 4. Quantities are taken after the first second.\n\n\
         In the following tables, p is the least of the three pairs.\n\n{tables}",
        SHOWN.len() * PAIRS.len(),
        parted[0],
        parted[1]
    )
}

fn exponents_section(record: &EnsembleRecord) -> String {
    let rate = |v: f64| format!("{} s⁻¹", digits(v));
    let mut text = format!(
        "## Largest Lyapunov exponents\n\n\
         ![Growth of the distance between neighbouring motions](figures/ensembles-exponents.png)\n\n\
         Benettin's method: a neighbouring motion is brought back to the distance d₀ every millisecond, and the exponent is \
         the mean rate of the logarithm of its growth. {} are run, of which the first {} are left out. d₀ is the norm of the \
         differences of all coordinates (m, 1, rad) and, times a millisecond, of their rates. Case 2 vibrates \
         without chaos; over this time the method gives a small exponent instead of zero.\n\n\
         | case | d₀ | method | exponent | warnings |\n|---|---|---|---|---|\n",
        si(EXPONENT_DURATION, "s"),
        si(LEFT_OUT, "s")
    );
    for e in &record.exponents {
        let _ = writeln!(
            text,
            "| {} | {:e} | {} | {} | {} |",
            e.case,
            e.distance,
            e.how,
            e.mean().reported(rate),
            reported(&e.source().warnings)
        );
    }
    for case in [3, 4] {
        let pair: Vec<&Exponents> = record.exponents(case).collect();
        if let [one, other] = pair.as_slice() {
            let words = if one.mean().differs(&other.mean()) {
                "differ at"
            } else {
                "do not differ at"
            };
            let _ = write!(
                text,
                "\nThe two exponents of case {case} {words} the 95 % level."
            );
        }
    }
    text + "\n\n"
}

fn meshes_section(record: &EnsembleRecord) -> String {
    let mut text = String::from(
        "## Meshes\n\n![Cases 2 and 4 with finer meshes](figures/ensembles-meshes.png)\n\n\
         | elements a link | case | largest \\|e_x\\| | rms deviation of acceleration | its median frequency | peak force in B1 | energy lost | warnings |\n\
         |---|---|---|---|---|---|---|---|\n",
    );
    for n in MESHES {
        let single = record.single(&mesh_name(n));
        text += &format!("| {n} | 2 | {} |\n", mesh_cells(single));
    }
    for (n, e) in MESHES.iter().zip(meshes(record)) {
        let show = |name: &str, unit: &str| e.mean(name).reported(|v| si(v, unit));
        let _ = writeln!(
            text,
            "| {n} | 4 | {} | {} | {} | {} | {} | {} |",
            show("error_peak", "m"),
            show("deviation_rms", "m/s²"),
            show("deviation_frequency", "Hz"),
            show("force_peak", "N"),
            e.mean("energy_lost").reported(percent),
            reported(&e.source().warnings)
        );
    }
    text + "\n"
}

fn mesh_cells(s: &Single) -> String {
    let show = |name: &str, unit: &str| si(s.measures.get(name), unit);
    [
        show("error_peak", "m"),
        show("deviation_rms", "m/s²"),
        show("deviation_frequency", "Hz"),
        show("force_peak", "N"),
        percent(s.measures.get("energy_lost")),
        reported(&s.warnings),
    ]
    .join(" | ")
}

fn singles_section(record: &EnsembleRecord) -> String {
    let mut text = String::from(
        "## Case 2 without the vibration of its start\n\n\
         As printed, the links start unstrained at full speed, which makes them vibrate, and nothing damps that vibration. \
         Two changes remove it. \"Quasi-static start\": the platform gets up to speed on the circle within 0.8 s, so smoothly \
         that the links follow in their quasi-static deformation. \"Retardation time\": the links have Kelvin-Voigt damping. \
         If cycles 2 and 3 then agree, the motion is periodic.\n\n\
         | case 2 | distance of cycles 2 and 3 | rms deviation of acceleration | largest \\|e_x\\| | warnings |\n\
         |---|---|---|---|---|\n",
    );
    let names = [mesh_name(1), "quasi-static start".into()];
    let damped = RETARDATIONS.map(damped_name);
    for name in names.iter().chain(&damped) {
        let single = record.single(name);
        let m: &Measures = &single.measures;
        let words = if *name == names[0] {
            "as printed"
        } else {
            name
        };
        let _ = writeln!(
            text,
            "| {words} | {} | {} | {} | {} |",
            percent(m.get("repetition")),
            si(m.get("deviation_rms"), "m/s²"),
            si(m.get("error_peak"), "m"),
            reported(&single.warnings)
        );
    }
    text + "\n"
}

fn work_section(record: &EnsembleRecord) -> String {
    let mut text = format!(
        "## Explicit and implicit methods\n\n\
         ![Error against work](figures/ensembles-methods.png)\n\n\
         Error of e_x over the first {}, against Dormand and Prince's method with a step of 50 ns, and the number of \
         evaluations of the elastic force of an element. An implicit evaluation includes the tangent, and a factorisation \
         follows it.\n\n\
         | case | method | step | evaluations | error over largest \\|e_x\\| | warnings |\n|---|---|---|---|---|---|\n",
        si(HORIZON, "s")
    );
    for w in &record.work {
        let error = w.error.map_or("–".into(), |error| digits(error / w.size));
        let evaluations = w.error.map_or("–".into(), |_| w.evaluations.to_string());
        let _ = writeln!(
            text,
            "| {} | {} | {} | {evaluations} | {error} | {} |",
            w.case,
            words(&w.method),
            si(w.step, "s"),
            reported(&w.warnings)
        );
    }
    text + "\n"
}

fn long_section(record: &EnsembleRecord) -> String {
    let mut text = String::from(
        "## Many cycles\n\n\
         Rms deviation of the acceleration in the last cycle over that in the second. The step of case 4 is far longer than \
         those that resolve contacts; its runs are an ensemble of starts.\n\n\
         | case | method | step | cycles | last over second cycle | warnings |\n|---|---|---|---|---|---|\n",
    );
    for l in &record.long {
        let _ = writeln!(
            text,
            "| {} | {} | {} | {} | {} | {} |",
            l.case,
            words(&l.method),
            si(l.step, "s"),
            l.cycles,
            l.reported(),
            reported(&l.source().warnings)
        );
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::record::{file, load};
    use miette::{IntoDiagnostic, Result, miette};

    #[test]
    fn the_page_is_what_the_record_gives() -> Result<()> {
        let path = file("ensembles.json").with_file_name("../ENSEMBLES.md");
        let stored = std::fs::read_to_string(path).into_diagnostic()?;
        // without the note on the state of the record
        let parts = stored.split_once("<!-- record: ensembles -->\n");
        let parts = parts
            .and_then(|(before, rest)| Some((before, rest.split_once("<!-- /record -->\n")?.1)));
        let (before, after) =
            parts.ok_or_else(|| miette!("no place for the state of the record"))?;
        let stored = format!("{before}{}{after}", records::place("ensembles"));
        let record: EnsembleRecord = load("ensembles.json")?;
        let same = stored == page(&record);
        assert!(
            same,
            "`cargo run --release -p paper-figures -- ensembles --page` brings the page up to date"
        );
        Ok(())
    }
}
