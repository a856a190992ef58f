//! What the page of the ensembles shows, and its pictures.

use crate::ensembles::{
    BATHE, BOTH, Ensemble, EnsembleRecord, LOOSE, MESHES, RETARDATIONS, STARTS, bathe_name,
    damped_name, mesh_name,
};
use crate::exponents::{DURATION, LEFT_OUT};
use crate::methods::{HORIZON, METHODS};
use crate::runs::words;
use crate::shown::mean;
use minijinja::{Value, context};
use numbers::si;
use plot::{Axis, Figure, Mark, Panel, palette};
use statistics::{FAMILY_WISE, Interval, Welch, holm};
use std::collections::BTreeMap;

/// Distance of runs that have parted: the printed clearance \[m\].
const PARTED: f64 = 2e-5;

/// Methods in colour; the others are grey.
const COLORED: [&str; 6] = [
    "bathe",
    "trapezoidal",
    "esdirk5",
    "dormand_prince",
    "dop853",
    "velocity_verlet",
];
/// Measures, their words and units.
const SHOWN: [(&str, &str, &str); 12] = [
    ("error_peak", "largest |eₓ|", "m"),
    ("error_rms", "rms eₓ", "m"),
    ("deviation_rms", "rms deviation of acceleration", "m/s²"),
    (
        "deviation_peak",
        "largest deviation of acceleration",
        "m/s²",
    ),
    ("deviation_frequency", "its median frequency", "Hz"),
    ("repetition", "distance of cycles 2 and 3", "%"),
    ("force_peak", "peak force in B1", "N"),
    ("force_cubic_mean", "cubic-mean force in B1", "N"),
    ("contact_b1", "contact of B1", "%"),
    ("peaks_after_onset", "peaks that follow an onset", "%"),
    ("peaks_with_any", "peaks with a peak of force", "%"),
    ("onsets", "onsets in two cycles", ""),
];

/// The ensembles of case 4, by the number of elements.
fn meshes(record: &EnsembleRecord) -> Vec<&Ensemble> {
    let all = record.ensembles.iter();
    let finer = all.filter(|e| e.changed.contains("elements"));
    [record.ensemble(BOTH)].into_iter().chain(finer).collect()
}

/// Error against work.
pub fn figure(record: &EnsembleRecord) -> Figure {
    let panel = |title: &str, case: u32| {
        let curve = |method: &&str| {
            let all = record.work.iter();
            let runs = all.filter(|w| w.case == case && w.method == *method);
            let color = COLORED.iter().position(|colored| colored == method);
            let color = color.map_or(palette::GREY, |i| palette::SERIES[i]);
            let points = runs.filter_map(|w| Some((w.evaluations as f64, w.error? / w.size)));
            let (x, y): (Vec<f64>, Vec<f64>) = points.unzip();
            let line = Mark::curve(words(method), color, &x, &y).width(3);
            let marks = [line, Mark::points("", color, &x, &y, 6)];
            marks.into_iter().filter(|mark| !mark.x.is_empty())
        };
        Panel {
            title: title.into(),
            note: String::new(),
            x: Axis::new("Evaluations of the elastic force of an element", "", 1.0).log(),
            y: Axis::new("Largest error of eₓ over largest |eₓ|", "", 1.0).log(),
            marks: METHODS.iter().flat_map(curve).collect(),
        }
    };
    Figure {
        rows: vec![vec![panel("a) Case 2", 2), panel("b) Case 4", 4)]],
        caption: format!(
            "Error of explicit (Dormand-Prince, DOP853, velocity Verlet) and implicit methods against counted work, over the first \
             {}. Scenes case2.toml and case4.toml; equal steps from 100 µs to 0.2 µs. An implicit evaluation includes the \
             tangent. Runs that stop have no dot.",
            si(HORIZON, "s")
        ),
    }
}

/// The values of the template.
pub fn values(record: &EnsembleRecord) -> Value {
    let of_case = |e: &&Ensemble| e.case > 2 && !e.name.starts_with("Bathe");
    let ensembles = record.ensembles.iter().filter(of_case).map(means);
    let exponents = record.exponents.iter().map(|x| {
        let mean = x.mean();
        context! { mean, ..Value::from_serialize(x) }
    });
    let two = MESHES.map(|n| record.ensemble(&mesh_name(n)));
    let four = meshes(record);
    let elements = MESHES.into_iter().cycle();
    let meshes = elements.zip(two.into_iter().chain(four));
    let meshes = meshes.map(|(elements, e)| context! { elements, ..means(e) });
    let singles = [mesh_name(1), "quasi-static start".to_owned()];
    let singles = singles.into_iter().chain(RETARDATIONS.map(damped_name));
    let work = record.work.iter().map(|w| {
        let error = w.error.map(|error| error / w.size);
        context! { method => words(&w.method), error, ..Value::from_serialize(w) }
    });
    let long = record.long.iter().map(|l| {
        context! { method => words(&l.method), ..l.shown() }
    });
    context! {
        starts => STARTS, level => FAMILY_WISE, duration => DURATION, left_out => LEFT_OUT, horizon => HORIZON,
        ensembles => ensembles.collect::<Vec<_>>(),
        sizes => [3, 4].map(|case| sizes(record, case)),
        cases => compared(&[LOOSE, BOTH].map(|name| record.ensemble(name)), &[(0, 1)]),
        exponents => exponents.collect::<Vec<_>>(),
        meshes => meshes.collect::<Vec<_>>(),
        singles => singles.map(|name| means(record.ensemble(&name))).collect::<Vec<_>>(),
        bathe => energy(record),
        work => work.collect::<Vec<_>>(),
        long => long.collect::<Vec<_>>(),
    }
}

/// An ensemble with its means; of a single run its values.
fn means(ensemble: &Ensemble) -> Value {
    let measures = ensemble.measures.iter();
    let measures = measures.map(|(name, values)| (name.clone(), mean(values)));
    let measures: BTreeMap<String, Value> = measures.collect();
    context! { measures, ..Value::from_serialize(ensemble) }
}

/// Energy that Bathe's method gains in cases 3 and 4, over that dissipated in contacts: mean and range over some starts, for this
/// page and for README.md.
pub fn energy(record: &EnsembleRecord) -> Vec<Value> {
    let range = |values: Vec<f64>| {
        let mean = values.iter().sum::<f64>() / values.len() as f64;
        let least = values.iter().copied().fold(f64::INFINITY, f64::min);
        let largest = values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        context! { mean, least, largest }
    };
    let pairs = [3, 4].map(|case| BATHE.map(|step| (case, step)));
    let pairs = pairs.concat().into_iter();
    let row = |(case, step)| {
        let runs = record.ensemble(&bathe_name(case, step));
        let whole = runs
            .values("energy_lost")
            .iter()
            .map(|lost| -lost)
            .collect();
        let cycles = runs.values("energy_gained_in_cycles");
        let (starts, whole, cycles) = (cycles.len(), range(whole), range(cycles.to_vec()));
        context! { case, step, starts, whole, cycles }
    };
    pairs.map(row).collect()
}

/// Whether the size of the displacement makes a difference in a case.
fn sizes(record: &EnsembleRecord, case: u32) -> Value {
    let ensembles = record.sizes(case);
    // when the smallest displacement has grown to the clearance, at the smaller of the exponents
    let rates = record.exponents(case).map(|e| e.mean().mean);
    let parted = (PARTED / ensembles[0].moved).ln() / rates.fold(f64::INFINITY, f64::min);
    let rows = compared(&ensembles, &[(0, 1), (0, 2), (1, 2)]);
    context! { case, parted, rows, ensembles => ensembles.into_iter().map(means).collect::<Vec<_>>() }
}

/// The means of some ensembles in all quantities, and the least p of the pairs by Welch's test; Holm's method takes all pairs and
/// quantities together.
fn compared(ensembles: &[&Ensemble], pairs: &[(usize, usize)]) -> Vec<Value> {
    let test = |name: &str, (i, j): &(usize, usize)| {
        let [one, other] = [*i, *j].map(|i| ensembles[i].values(name));
        Welch::of(one, other).p
    };
    let all = SHOWN
        .iter()
        .flat_map(|(name, ..)| pairs.iter().map(|pair| test(name, pair)));
    let p = holm(&all.collect::<Vec<f64>>());
    let rows = SHOWN.iter().zip(p.chunks(pairs.len()));
    let rows = rows.map(|((name, words, unit), p)| {
        let means: Vec<Interval> = ensembles.iter().map(|e| e.mean(name)).collect();
        let p = p.iter().copied().fold(1.0, f64::min);
        context! { words, unit, means, p }
    });
    rows.collect()
}
