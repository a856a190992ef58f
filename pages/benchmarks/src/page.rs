//! The page.

use crate::Measured;
use crate::family::Family;
use crate::figures::{self, curves};
use crate::growth::{self, SizeCost, SizeOf, exponent};
use crate::meshes::ERRORS;
use crate::rivals::{Code, ConvergedSolution, RivalCurve, STUDIES, best, study};
use crate::standings::{self, LEVELS, Standing};
use accuracy::settings::{RATIOS, TOLERANCES};
use miette::Result;
use numbers::{digits, si};
use std::path::Path;
use studies::precision::Times;
use verify::ida_of_system::LinearSolver;

/// What BENCHMARKS.md says.
///
/// # Errors
/// When a study cannot be read.
pub fn page(root: &Path, measured: &Measured) -> Result<String> {
    let mut out = format!(
        "# What the program costs\n\n{}\n\
         How many instructions a step takes, how costs grow with the size of a mechanism, and how long other programs take for \
         the same error. The baseline is an earlier commit of this program, built and run beside the present one. \
         `cargo run --release -p benchmarks` measures all of it and writes this page; \
         [pages/benchmarks/benchmarks.json](pages/benchmarks/benchmarks.json) has every number. [ACCURACY.md](ACCURACY.md) has \
         the errors and processor times of every method of this program. Measured on {}.\n\n",
        records::place("benchmarks"),
        measured.machine
    );
    out += &short(measured);
    out += &steps(measured);
    out += &sizes(measured);
    out += &rivals(root, measured)?;
    Ok(out)
}

/// Conclusions.
fn short(measured: &Measured) -> String {
    let ratios = measured.steps.iter().filter_map(|step| {
        let before = step.before?.instructions as f64;
        Some((step.now.instructions as f64 / before, step.time_ratio?))
    });
    let (instructions, times): (Vec<f64>, Vec<f64>) = ratios.unzip();
    let range = |values: &[f64]| {
        let least = values.iter().copied().fold(f64::INFINITY, f64::min);
        let most = values.iter().copied().fold(0.0, f64::max);
        format!("{} to {}", digits(least), digits(most))
    };
    let compile = |family: Family| match largest(measured, family) {
        Some(cost) => si(cost.compile, "s"),
        None => String::new(),
    };
    let exponents = |cost: &SizeOf| {
        let all = Family::ALL.map(|family| growth_of(measured, family, cost));
        range(&all.into_iter().flatten().collect::<Vec<f64>>())
    };
    let bodies = measured.sizes.iter().map(|cost| cost.bodies);
    let most_bodies = bodies.max().unwrap_or(0);
    let seconds: Vec<f64> = measured.steps.iter().map(|step| step.seconds).collect();
    let [least, most] = [f64::min, f64::max].map(|of| seconds.iter().copied().reduce(of));
    format!(
        "## In short\n\n\
         * A step takes {} to {} of processor time. These are {} of the instructions and {} of the time of the baseline, commit {}.\n\
         * A chain of {most_bodies} bodies is compiled in {} with ideal joints and in {} with play.\n\
         * From {} to {most_bodies} bodies the costs of {} kinds of mechanism grow with these powers of their number (1: in proportion to it): compilation {}, a step {} in time and {} in instructions, memory {}.\n{}\n",
        si(least.unwrap_or(0.0), "s"),
        si(most.unwrap_or(0.0), "s"),
        range(&instructions),
        range(&times),
        measured.baseline,
        compile(Family::Chain),
        compile(Family::LooseChain),
        most_bodies / 10,
        Family::ALL.len(),
        exponents(&|cost| Some(cost.compile)),
        exponents(&|cost| Some(cost.step)),
        exponents(&|cost| Some(cost.instructions? as f64)),
        exponents(&|cost| Some(cost.memory? as f64)),
        compared(measured),
    )
}

/// The largest mechanism of a kind.
fn largest(measured: &Measured, family: Family) -> Option<&SizeCost> {
    let sizes = measured.sizes.iter().filter(|cost| cost.family == family);
    sizes.max_by_key(|cost| cost.bodies)
}

/// The exponent of a cost of a kind, where it has been measured.
fn growth_of(measured: &Measured, family: Family, cost: &SizeOf) -> Option<f64> {
    let (bodies, costs) = figures::sizes(measured, family, cost);
    (bodies.len() > 1).then(|| exponent(&bodies, &costs))
}

/// How long the other codes take, and where they are faster.
fn compared(measured: &Measured) -> String {
    let (mut out, mut faster) = (String::new(), Vec::new());
    let all = Standing::all(&measured.rivals.curves);
    for standing in all.iter().filter(|s| s.method.is_none()) {
        let (Some([median, least]), name) = (standing.summary(), standing.rival.name()) else {
            continue;
        };
        let ratios = standing.ratios.iter();
        let most = ratios.clone().map(|r| r.ratio).fold(0.0, f64::max);
        out += &format!(
            "* {name} takes {} to {} times as long as Looselink, {} times in the median over {} pairs of a study and an error, \
             each with its fastest method.\n",
            digits(least),
            digits(most),
            digits(median),
            standing.ratios.len()
        );
        faster.extend(ratios.filter(|r| r.ratio < 1.0).map(|r| {
            let (error, ratio) = (si(r.error, "m"), digits(r.ratio));
            format!("{name} in {} at {error} ({ratio} times)", r.study)
        }));
    }
    out + &match faster.is_empty() {
        true => "* No other code is faster in any of these pairs.\n".to_owned(),
        false => format!(
            "* Another code is faster here (its time over that of Looselink): {}.\n",
            faster.join(", ")
        ),
    }
}

/// The table of steps.
fn steps(measured: &Measured) -> String {
    let mut out = String::from(
        "## A step\n\n![Instructions of a step](pages/benchmarks/figures/steps.png)\n\n\
         The floating-point operations are additions, subtractions, multiplications, divisions and roots; those of the \
         mathematical library are not among them. `./test.sh --all` counts the instructions of the program that its tests compile \
         ([counts.json](pages/benchmarks/counts.json)) and fails where a number has changed by more than 2 %.\n\n\
         | step of 10 µs | instructions | operations | baseline | ratio of instructions | processor time | ratio of times |\n\
         |---|---|---|---|---|---|---|\n",
    );
    for step in &measured.steps {
        let now = step.now.instructions;
        let (before, ratio) = match step.before {
            Some(before) => {
                let ratio = now as f64 / before.instructions as f64;
                (before.instructions.to_string(), digits(ratio))
            }
            None => Default::default(),
        };
        out += &format!(
            "| {} | {now} | {} | {before} | {ratio} | {} | {} |\n",
            step.name,
            step.now.operations,
            si(step.seconds, "s"),
            step.time_ratio.map_or(String::new(), digits),
        );
    }
    out + "\n"
}

/// Costs of the largest mechanism of each kind.
fn largest_mechanisms(measured: &Measured) -> String {
    let mut out = "| mechanism | bodies | compilation | a step | instructions of a step | memory |\n|---|---|---|---|---|---|\n".to_owned();
    for family in Family::ALL {
        let Some(cost) = largest(measured, family) else {
            continue;
        };
        let cell = |of: &SizeOf, text: &dyn Fn(f64) -> String| {
            let exponent = growth_of(measured, family, of).map(digits);
            match (of(cost).map(text), exponent) {
                (Some(cost), Some(exponent)) => format!("{cost} ({exponent})"),
                (cost, _) => cost.unwrap_or_default(),
            }
        };
        let seconds = |x| si(x, "s");
        let cells = [
            cell(&|cost| Some(cost.compile), &seconds),
            cell(&|cost| Some(cost.step), &seconds),
            cell(&|cost| Some(cost.instructions? as f64), &|n| n.to_string()),
            cell(&|cost| Some(cost.memory? as f64), &|bytes| si(bytes, "B")),
        ];
        out += &format!(
            "| {} | {} | {} |\n",
            family.name(),
            cost.bodies,
            cells.join(" | ")
        );
    }
    out + "\n"
}

/// Growth.
fn sizes(measured: &Measured) -> String {
    let mut out = format!(
        "## Growth with the size\n\n![Costs over the size](pages/benchmarks/figures/growth.png)\n\n\
         The table has the costs of the largest mechanisms, and in brackets the exponent of their growth over the largest decade. \
         The instructions of a step are those of a run over its {} steps, two rows included. Its time also depends on \
         the caches of the processor, into which the data of a large mechanism do not fit.\n\n\
         {}\
         The next table shows the processor time to reach an error, with ~ where it is interpolated between two runs; a cell is \
         empty where the steps tried do not reach it.\n\n\
         | case 2, 20 ms: elements a link | ",
        growth::STEPS,
        largest_mechanisms(measured)
    );
    let columns: Vec<(&str, usize)> = curves(measured)
        .into_iter()
        .flat_map(|curve| (0..ERRORS.len()).map(move |k| (curve, k)))
        .collect();
    let heads = columns
        .iter()
        .map(|(curve, k)| format!("{curve}, {}", si(ERRORS[*k], "m")));
    out += &heads.collect::<Vec<String>>().join(" | ");
    out += &format!(" |\n|---|{}\n", "---|".repeat(columns.len()));
    for elements in crate::meshes::ELEMENTS {
        let cells = columns.iter().map(|(curve, k)| {
            let all = measured.meshes.iter();
            let mut own = all.filter(|m| m.elements == elements && m.curve == *curve);
            let time = own.find_map(|mesh| mesh.times[*k]);
            time.map_or(String::new(), |t| marked(t.seconds, t.is_interpolated))
        });
        let cells: Vec<String> = cells.collect();
        out += &format!("| {elements} | {} |\n", cells.join(" | "));
    }
    out
}

/// A time, with a mark where no run was made.
fn marked(seconds: f64, is_interpolated: bool) -> String {
    let mark = if is_interpolated { "~" } else { "" };
    format!("{mark}{}", si(seconds, "s"))
}

/// Other codes.
fn rivals(root: &Path, measured: &Measured) -> Result<String> {
    let studies = STUDIES.iter().map(|name| {
        let duration = study(root, name)?.duration;
        Ok(format!("{name} {}", si(duration, "s")))
    });
    let durations: Vec<String> = studies.collect::<Result<_>>()?;
    let curves = &measured.rivals.curves;
    let ratios = RATIOS.map(digits).join(", ");
    let mut out = format!(
        "\n## Other codes\n\n![Error against processor time, all codes](pages/benchmarks/figures/rivals.png)\n\n\
         Exudyn 1.13.6 has the same mechanisms with the same data ([benches/peers/exudyn](benches/peers/exudyn)), in the fastest \
         formulation that was found for it. IDA is the BDF code of SUNDIALS: once on Looselink's residual and tangent (index 1), \
         whose velocities are eliminated from Newton's matrix, and once in the second implementation, in full coordinates \
         (stabilised index 2). BDF of orders above 2 is unstable on a part of the imaginary axis, so IDA has a curve for each of the \
         largest orders 2, 3 and 5. Each has the settings with which it is fastest in the study, tried on all tolerances: the \
         relative tolerance is {ratios} times that of the run, and on our equations the matrix is sparse (KLU) or dense. Its \
         loosest tolerance is {:e}; where that run is more accurate than the error in the table, its time stands there all the \
         same. The contact laws are the same, but Exudyn does not clamp forces that pull; its cable element has another strain. On \
         one core, one after the other in one run.\n\n\
         The [studies](studies) simulate the first milliseconds of a mechanism: {durations}. The error is the largest difference of \
         a position from a converged solution: {solutions}. The table shows the fastest time to reach it, and in brackets how many \
         times as long the other code takes; a dash where it does not reach the error. Times with ~ are interpolated between two \
         runs; the ratios in the section above and in the next table are of runs that were made.\n\n\
         | study | error | Looselink | Exudyn | IDA on our equations | IDA, second implementation |\n|---|---|---|---|---|---|\n",
        TOLERANCES[0],
        durations = durations.join(", "),
        solutions = solutions(&measured.rivals.solutions),
    );
    for study in STUDIES {
        for error in LEVELS {
            let of = |code| best(curves, study, code, error, Times::Interpolated);
            let Some(own) = of(Code::Looselink) else {
                continue;
            };
            let cell = |code| {
                of(code).map_or("-".to_owned(), |t| {
                    let ratio = digits(t.seconds / own.seconds);
                    let time = marked(t.seconds, t.is_interpolated);
                    format!("{time} ({ratio}): {}", t.method)
                })
            };
            out += &format!(
                "| {study} | {} | {}: {} | {} | {} | {} |\n",
                si(error, "m"),
                marked(own.seconds, own.is_interpolated),
                own.method,
                cell(Code::Exudyn),
                cell(Code::IdaOnOurs),
                cell(Code::Ida)
            );
        }
    }
    out += &format!(
        "\nOne method alone against the fastest method of another code: the median of the ratios of their times, the least one, and \
         the number of pairs of a study and an error; then how many errors only our method reaches, and only the other code.\n\n{}",
        standings::table(&Standing::all(curves))
    );
    out += &settings(curves);
    Ok(out)
}

/// From which solutions errors are measured, and how far these are apart.
fn solutions(all: &[ConvergedSolution]) -> String {
    let own = |s: &&ConvergedSolution| s.of == s.code && s.of != Code::Looselink;
    let codes: Vec<&str> = all.iter().filter(own).map(|s| s.code.name()).collect();
    let Some(code) = codes.first() else {
        return "Looselink's".to_owned();
    };
    let distances = all.iter().filter(own).filter_map(|s| {
        let distance = s.difference_from_looselink?;
        Some(format!("{} {}", s.study, si(distance, "m")))
    });
    let distances: Vec<String> = distances.collect();
    let distances = match distances.is_empty() {
        true => "how far they are apart was not measured".to_owned(),
        false => format!("they differ by: {}", distances.join(", ")),
    };
    format!("its own for {code}, Looselink's for all others ({distances})")
}

/// The settings of IDA in every study.
fn settings(curves: &[RivalCurve]) -> String {
    let mut out = "\n| study | code | method | relative tolerance over that of the run | matrix |\n|---|---|---|---|---|\n".to_owned();
    for curve in curves {
        let Some(settings) = curve.settings else {
            continue;
        };
        let matrix = match settings.linear_solver {
            LinearSolver::Klu => "sparse, KLU",
            LinearSolver::Dense => "dense",
        };
        out += &format!(
            "| {} | {} | {} | {} | {matrix} |\n",
            curve.study,
            curve.code.name(),
            curve.method,
            digits(settings.ratio)
        );
    }
    out
}
