//! STABILITY.md, its pictures, and the tables of all runs.

use crate::output::{Data, Output, stamp};
use crate::stability::Maps;
use crate::stability::cases::{Check, cases};
use crate::stability::map::{AUTO, KnownSilent, METHODS, MadeMap, MapCell, MapPanel, known_silent};
use crate::stability::outcome::OutcomeClass;
use miette::Result;
use minijinja::{Value, context};
use numbers::{number, si};
use plot::{Axis, Color, Figure, Mark, Panel, palette};

/// Panels beside each other.
const COLUMNS: usize = 4;

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
    let checks = || maps.results.checks.iter().chain(&long.results);
    let titles: Vec<String> = cases()?.into_iter().map(|case| case.title).collect();
    let known = known_silent()?;
    let page = context! {
        stamps => context! {
            maps => stamp(&maps.origin), long => stamp(&long.origin), soak => stamp(&soak.origin),
            fuzz => stamp(&fuzz.origin),
        },
        classes => OutcomeClass::ALL.map(OutcomeClass::name),
        runs => made.iter().map(|one| one.runs().count()).sum::<usize>(),
        methods => methods(made),
        silent => made.iter().flat_map(|one| silent(one, &known)).collect::<Vec<_>>(),
        saved => rivalry(made, |bathe, trapezoidal| gone(trapezoidal) && !gone(bathe)),
        lost => rivalry(made, |b, t| t == OutcomeClass::Accurate && b != OutcomeClass::Accurate),
        checks => checks().map(row).collect::<Vec<_>>(),
        maps => made.iter().map(table).collect::<Vec<_>>(),
        titles, soak => &soak.results, fuzz => &fuzz.results,
    };
    out.page("STABILITY.md", "stability.md", &page)?;
    out.site_page("stability.md", "site/stability.md", &page)
}

/// A criterion as the tables have it.
fn row(check: &Check) -> Value {
    let shown = |x: f64| number(x, 4);
    let asked = &check.criterion;
    let bound = match (asked.least, asked.most) {
        (Some(least), Some(most)) if least == most => "yes".to_owned(),
        (Some(least), Some(most)) => format!("{} to {}", shown(least), shown(most)),
        (Some(least), None) => format!("at least {}", shown(least)),
        (None, most) => most.map_or(String::new(), |most| format!("at most {}", shown(most))),
    };
    let found = match &bound[..] {
        "yes" => if check.holds() { "yes" } else { "no" }.to_owned(),
        _ => check.value.map_or("no number".to_owned(), shown),
    };
    context! { case => check.case, asks => &asked.asks, found, bound, holds => check.holds() }
}

/// How many runs of every method ended how.
fn methods(made: &[MadeMap]) -> Vec<Value> {
    let counted = METHODS.iter().map(|(method, _)| {
        let runs = || {
            made.iter()
                .flat_map(MadeMap::runs)
                .filter(|run| run.0 == *method)
        };
        let count = |class| runs().filter(|run| run.3.0 == class).count();
        context! { method, counts => OutcomeClass::ALL.map(count) }
    });
    counted.collect()
}

/// The unit of the columns of a panel.
fn unit(one: &MadeMap, method: &str) -> &'static str {
    match method {
        AUTO => channel_unit(one),
        _ => "s",
    }
}

/// Runs of a map that are wrong in silence.
fn silent(one: &MadeMap, known: &[KnownSilent]) -> Vec<Value> {
    let runs = one.runs().filter(|run| run.3.0 == OutcomeClass::Silent);
    let run = |(method, parameter, column, cell): (&str, f64, f64, &MapCell)| {
        let mut known = known.iter();
        let listed = known.find(|k| k.is(&one.name, method, parameter, column));
        context! {
            because => listed.map_or("**not known**", |listed| &listed.because),
            map => &one.name, method, value => value(one, parameter),
            column => si(column, unit(one, method)),
            error => cell.1.map(|error| si(error, channel_unit(one))),
        }
    };
    runs.map(run).collect()
}

fn gone(class: OutcomeClass) -> bool {
    matches!(class, OutcomeClass::Failed | OutcomeClass::Refused)
}

/// In which maps how many runs of Bathe's scheme and the trapezoidal rule with the same step differ in this way.
fn rivalry(made: &[MadeMap], differ: fn(OutcomeClass, OutcomeClass) -> bool) -> String {
    let counts = made.iter().filter_map(|one| {
        let of = |method| one.runs().filter(move |run| run.0 == method);
        let pairs = of("Bathe").zip(of("trapezoidal"));
        let count = pairs.filter(|(b, t)| differ(b.3.0, t.3.0)).count();
        (count > 0).then(|| format!("{count} in {}", one.name))
    });
    match &counts.collect::<Vec<String>>()[..] {
        [] => "none".to_owned(),
        counts => counts.join(", "),
    }
}

/// A map with all its runs.
fn table(one: &MadeMap) -> Value {
    let cell = |MapCell(class, error, said): &MapCell| {
        let error = error.map_or(String::new(), |error| format!(" {}", number(error, 2)));
        let said = said.map_or(String::new(), |said| format!(" ({})", said + 1));
        format!("{}{error}{said}", class.name())
    };
    let panel = |panel: &MapPanel| {
        let columns = one.map.columns(&panel.method).into_iter();
        let rows = one.map.parameter.values.iter().zip(&panel.cells);
        let rows = rows.map(|(v, row)| {
            let cells: Vec<String> = row.iter().map(cell).collect();
            context! { value => value(one, *v), cells }
        });
        context! {
            method => &panel.method, rows => rows.collect::<Vec<_>>(),
            columns => columns.map(|c| si(c, unit(one, &panel.method))).collect::<Vec<_>>(),
        }
    };
    context! {
        name => &one.name, title => &one.map.title, remark => &one.map.remark,
        parameter => &one.map.parameter.label, large => one.map.unsaid, said => &one.said,
        tolerance => si(one.map.tolerance, channel_unit(one)),
        panels => one.panels.iter().map(panel).collect::<Vec<_>>(),
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

/// The colour of an outcome: green where all is well, blue with a warning, grey and red where a run is stopped or should have
/// been, black for what must not happen.
fn color(class: OutcomeClass) -> Color {
    match class {
        OutcomeClass::Accurate => palette::GREEN,
        OutcomeClass::Coarse => palette::SKY,
        OutcomeClass::Damped => palette::BLUE,
        OutcomeClass::Refused => palette::GREY,
        OutcomeClass::Failed => palette::VERMILION,
        OutcomeClass::Silent => palette::BLACK,
    }
}

/// An axis of positive values in the prefixed unit in which the largest is below a thousand.
fn prefixed(label: &str, unit: &str, values: &[f64]) -> Axis {
    const PREFIXES: [(&str, f64); 4] = [("n", 1e9), ("µ", 1e6), ("m", 1e3), ("", 1.0)];
    let largest = values.iter().copied().fold(0.0, f64::max);
    let fits = |(_, factor): &&(&str, f64)| largest * factor < 1e3;
    let (prefix, factor) = PREFIXES.iter().find(fits).unwrap_or(&PREFIXES[3]);
    Axis::new(label, &format!("{prefix}{unit}"), *factor).log()
}

/// A panel a method, a dot a run.
fn figure(one: &MadeMap) -> Figure {
    let map = &one.map;
    let count = map.parameter.values.len();
    let panel = |(index, panel): (usize, &MapPanel)| {
        let columns = map.columns(&panel.method);
        let x = match &panel.method[..] {
            AUTO => prefixed("Accuracy asked for", "m", &columns),
            _ => prefixed("Step", "s", &columns),
        };
        // the greatest value at the top
        let left = index % COLUMNS == 0;
        let names = map.parameter.values.iter().rev();
        let mut y = Axis::categories(match left {
            true => names.map(|v| value(one, *v)).collect(),
            false => vec![String::new(); count],
        });
        y.label = map.parameter.label.clone();
        let dots = |class: OutcomeClass| {
            let places = panel.cells.iter().enumerate().flat_map(|(v, row)| {
                let own = columns.iter().zip(row).filter(|(_, cell)| cell.0 == class);
                own.map(move |(column, _)| (*column, (count - 1 - v) as f64))
            });
            let (x, y): (Vec<f64>, Vec<f64>) = places.unzip();
            // the first panel has the legend of all
            let label = if index == 0 { &class.name() } else { "" };
            Mark::points(label, color(class), &x, &y, 15)
        };
        Panel {
            title: panel.method.clone(),
            note: String::new(),
            x,
            y,
            marks: OutcomeClass::ALL.map(dots).to_vec(),
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
    Figure::grid(
        one.panels.iter().enumerate().map(panel).collect(),
        COLUMNS,
        caption,
    )
}
