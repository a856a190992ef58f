//! STABILITY.md, its pictures, and the tables of all runs.

use crate::output::{Data, Output, stamp};
use crate::stability::Maps;
use crate::stability::cases::{Check, cases};
use crate::stability::map::{AUTO, KnownSilent, METHODS, MadeMap, MapPanel, MapRun, known_silent};
use crate::stability::outcome::{OutcomeClass, is_beyond};
use looselink::stepper::SCHEMES;
use miette::Result;
use minijinja::{Value, context};
use numbers::{number, si};
use plot::{Axis, Color, Figure, Mark, Panel, palette};
use std::collections::BTreeMap;

/// Panels beside each other.
const COLUMNS: usize = 4;
/// The colours of outcomes, in their order: green where all is well, blue with a warning, grey and red where a run is stopped or
/// should have been, black for what must not happen.
const COLORS: [Color; 6] = {
    use palette::*;
    [GREEN, SKY, BLUE, GREY, VERMILION, BLACK]
};

/// Makes the pages and pictures of the records `maps`, `long`, `soak` and `fuzz`; one that is missing is an error.
pub fn render(data: &Data, out: &mut Output) -> Result<()> {
    let maps = data.read::<Maps>("maps")?;
    let long = data.read::<Vec<Check>>("long")?;
    let [soak, fuzz] = ["soak", "fuzz"].map(|name| data.read::<serde_json::Value>(name));
    let (soak, fuzz) = (soak?, fuzz?);
    let made = &maps.results.maps;
    for one in made {
        out.picture(&format!("stability/{}", one.name), &figure(one))?;
    }
    let runs: Vec<_> = made.iter().flat_map(MadeMap::runs).collect();
    let method = |(method, _): &(&str, &str)| {
        let own = || runs.iter().filter(|run| run.method == *method);
        let count = |class| own().filter(|run| run.is(class)).count();
        context! { method, counts => OutcomeClass::ALL.map(count) }
    };
    let map = |one: &MadeMap| {
        let (unit, accuracies) = (channel_unit(one), one.map.columns(AUTO));
        context! { unit, accuracies, ..Value::from_serialize(one) }
    };
    let check = |check: &Check| context! { holds => check.holds(), ..Value::from_serialize(check) };
    let checks = maps.results.checks.iter().chain(&long.results);
    let known = known_silent()?;
    let names = SCHEMES.iter().map(|scheme| scheme.name);
    let (soak_methods, soak_missing): (Vec<_>, Vec<_>) =
        names.partition(|name| !soak.results["tallies"][name].is_null());
    let page = context! {
        stamps => context! {
            maps => stamp(&maps.origin), long => stamp(&long.origin), soak => stamp(&soak.origin),
            fuzz => stamp(&fuzz.origin),
        },
        classes => OutcomeClass::ALL.map(OutcomeClass::name),
        names => BTreeMap::from(OutcomeClass::ALL.map(|class| (class, class.name()))),
        runs => runs.len(),
        totals => OutcomeClass::ALL.map(|class| runs.iter().filter(|run| run.is(class)).count()),
        methods => METHODS.iter().map(method).collect::<Vec<_>>(),
        large => made.iter().map(large).sum::<usize>(),
        silent => made.iter().flat_map(|one| silent(one, &known)).collect::<Vec<_>>(),
        checks => checks.map(check).collect::<Vec<_>>(),
        maps => made.iter().map(map).collect::<Vec<_>>(),
        titles => cases()?.into_iter().map(|case| case.title).collect::<Vec<_>>(),
        soak_methods, soak_missing,
        soak => &soak.results, fuzz => &fuzz.results,
    };
    out.page("STABILITY.md", "stability.md", &page)?;
    out.site_page("stability.md", "site/stability.md", &page)
}

/// Runs of a map that reached their end with an error that needs a warning.
fn large(one: &MadeMap) -> usize {
    let is_large = |run: &MapRun| {
        let bound = one.map.unsaid * run.range;
        run.cell.1.is_some_and(|error| is_beyond(error, bound))
    };
    one.runs().filter(is_large).count()
}

/// Runs of a map that are wrong in silence.
fn silent(one: &MadeMap, known: &[KnownSilent]) -> Vec<Value> {
    let runs = one.runs().filter(|run| run.is(OutcomeClass::Silent));
    let run = |run: MapRun| {
        let listed = known.iter().find(|known| known.has(&one.name, &run));
        let unit_of_errors = channel_unit(one);
        context! {
            because => listed.map_or("**not known**", |listed| &listed.because),
            map => &one.name, method => run.method, value => value(one, run.value),
            column => si(run.column, unit(run.method)),
            error => run.cell.1.map(|error| si(error, unit_of_errors)),
            range => si(run.range, unit_of_errors),
        }
    };
    runs.map(run).collect()
}

/// The unit of the columns of a panel.
fn unit(method: &str) -> &'static str {
    match method {
        AUTO => "m",
        _ => "s",
    }
}

/// A value of the parameter with its unit.
fn value(one: &MadeMap, value: f64) -> String {
    match &one.map.parameter.unit[..] {
        "" => number(value, 3),
        unit => si(value, unit),
    }
}

/// The unit of the channels that are compared, which follows from their names.
fn channel_unit(one: &MadeMap) -> &'static str {
    match one.map.channels.first() {
        Some(name) if name.ends_with(".ax") || name.ends_with(".ay") => "m/s²",
        _ => "m",
    }
}

/// A panel a method, a dot a run.
fn figure(one: &MadeMap) -> Figure {
    let map = &one.map;
    let count = map.parameter.values.len();
    let panel = |(index, panel): (usize, &MapPanel)| {
        let columns = map.columns(&panel.method);
        let label = match &panel.method[..] {
            AUTO => "Accuracy asked for",
            _ => "Step",
        };
        // the greatest value at the top, and the first panel of a row with the names of all
        let named = |v: &f64| match index % COLUMNS {
            0 => value(one, *v),
            _ => String::new(),
        };
        let mut y = Axis::categories(map.parameter.values.iter().rev().map(named).collect());
        y.label = map.parameter.label.clone();
        let classes = OutcomeClass::ALL.into_iter().zip(COLORS);
        let dots = |(class, color): (OutcomeClass, Color)| {
            let places = panel.cells.iter().enumerate().flat_map(|(v, row)| {
                let own = columns.iter().zip(row).filter(|(_, cell)| cell.0 == class);
                own.map(move |(column, _)| (*column, (count - 1 - v) as f64))
            });
            let (x, y): (Vec<f64>, Vec<f64>) = places.unzip();
            // the first panel has the legend of all
            let label = if index == 0 { &class.name() } else { "" };
            Mark::points(label, color, &x, &y, 15)
        };
        Panel {
            title: panel.method.clone(),
            note: String::new(),
            x: Axis::new(label, unit(&panel.method), 1.0).log(),
            y,
            marks: classes.map(dots).collect(),
        }
    };
    let caption = format!(
        "{}. Scene {}, {} long. Accurate: within {} of the reference in every row. {}",
        map.title,
        map.scene.display(),
        si(map.duration, "s"),
        si(map.tolerance, channel_unit(one)),
        map.remark
    );
    let panels = one.panels.iter().enumerate().map(panel);
    Figure::grid(panels.collect(), COLUMNS, caption)
}
