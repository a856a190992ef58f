//! What the page of the ensembles shows.

use crate::ensembles::{BOTH, Ensemble, EnsembleRecord, MESHES, RETARDATIONS, damped_name};
use crate::exponents::{DURATION, LEFT_OUT};
use crate::methods::{HORIZON, Long};
use crate::runs::words;
use crate::variants::{STARTS, mesh_name};
use minijinja::{Value, context};
use statistics::{FAMILY_WISE, Interval, Welch, holm};

/// Distance of runs that have parted: the printed clearance \[m\].
const PARTED: f64 = 2e-5;

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

/// The values of the template.
pub fn values(record: &EnsembleRecord) -> Value {
    let of_all_starts = |e: &&Ensemble| e.values("error_peak").len() == STARTS;
    let ensembles: Vec<&Ensemble> = record.ensembles.iter().filter(of_all_starts).collect();
    let finer = ensembles.iter().filter(|e| e.changed.contains("elements"));
    let four = [record.ensemble(BOTH)].into_iter().chain(finer.copied());
    let two = MESHES.map(|n| record.ensemble(&mesh_name(n)));
    let meshes = MESHES.iter().cycle().zip(two.into_iter().chain(four));
    let meshes = meshes.map(|(elements, e)| context! { elements, ..shown(e) });
    let exponents = record.exponents.iter();
    let exponents = exponents.map(|x| context! { mean => x.mean(), ..Value::from_serialize(x) });
    let singles = [mesh_name(1)]
        .into_iter()
        .chain(RETARDATIONS.map(damped_name));
    let work = record.work.iter().map(|w| {
        let error = w.error.map(|error| error / w.size);
        context! { method => words(&w.method), error, ..Value::from_serialize(w) }
    });
    context! {
        starts => STARTS, level => FAMILY_WISE, duration => DURATION, left_out => LEFT_OUT, horizon => HORIZON,
        ensembles => ensembles.iter().copied().map(shown).collect::<Vec<_>>(),
        sizes => [3, 4].map(|case| sizes(record, case)),
        exponents => exponents.collect::<Vec<_>>(),
        meshes => meshes.collect::<Vec<_>>(),
        singles => singles.map(|name| shown(record.ensemble(&name))).collect::<Vec<_>>(),
        work => work.collect::<Vec<_>>(),
        long => record.long.iter().map(Long::shown).collect::<Vec<_>>(),
    }
}

/// An ensemble with its means.
fn shown(ensemble: &Ensemble) -> Value {
    context! { measures => ensemble.means(), ..Value::from_serialize(ensemble) }
}

/// Whether the size of the displacement makes a difference in a case.
fn sizes(record: &EnsembleRecord, case: u32) -> Value {
    let ensembles = record.sizes(case);
    // when the smallest displacement has grown to the clearance, at the smaller of the exponents
    let rates = record.exponents(case).map(|e| e.mean().mean);
    let parted = (PARTED / ensembles[0].moved).ln() / rates.fold(f64::INFINITY, f64::min);
    let rows = compared(&ensembles);
    context! { case, parted, rows, ensembles => ensembles.into_iter().map(shown).collect::<Vec<_>>() }
}

/// The means of three ensembles in all quantities, and the least p of their pairs by Welch's test; Holm's method takes all pairs and
/// quantities together.
fn compared(ensembles: &[&Ensemble]) -> Vec<Value> {
    let p = SHOWN.map(|(name, ..)| {
        let test = |(i, j): (usize, usize)| {
            let [one, other] = [i, j].map(|i| ensembles[i].values(name));
            Welch::of(one, other).p
        };
        [(0, 1), (0, 2), (1, 2)].map(test)
    });
    let p = holm(p.as_flattened());
    let rows = SHOWN.iter().zip(p.chunks(3));
    let rows = rows.map(|((name, words, unit), p)| {
        let means: Vec<Interval> = ensembles.iter().map(|e| e.mean(name)).collect();
        let p = p.iter().copied().fold(1.0, f64::min);
        context! { words, unit, means, p }
    });
    rows.collect()
}
