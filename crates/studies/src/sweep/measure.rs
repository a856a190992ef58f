//! What is measured of a run: numbers taken from the rows of channels, and from the contacts of joints.

use super::Recorded;
use looselink::simulate::Impact;
use serde::Deserialize;

/// `[measures.NAME]`
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Measure {
    /// Name of its kind, see [`SERIES`] and [`CONTACTS`].
    pub of: String,
    /// Channels; of several the magnitude of their vector is measured.
    #[serde(default)]
    pub channels: Vec<String>,
    /// Joints with clearance.
    #[serde(default)]
    pub joints: Vec<String>,
    /// Start of the part of the run that is measured \[s\].
    #[serde(default)]
    pub from: f64,
    /// End of that part \[s\]; the end of the run unless given.
    pub to: Option<f64>,
    /// Of a quantile: the part of the rows below it.
    pub quantile: Option<f64>,
}

/// A measure of rows: times \[s\] and values of equal number, one row at least; the fraction of a quantile.
#[derive(Debug)]
pub struct SeriesMeasure {
    /// Its name.
    pub name: &'static str,
    /// What it is, in a line.
    pub purpose: &'static str,
    /// The unit, from that of the channel.
    unit: fn(&str) -> String,
    of: fn(t: &[f64], x: &[f64], quantile: f64) -> f64,
}

/// A measure of contacts within a part of a run of some length \[s\].
#[derive(Debug)]
pub struct ContactMeasure {
    /// Its name.
    pub name: &'static str,
    /// What it is, in a line.
    pub purpose: &'static str,
    unit: &'static str,
    /// The channel of a joint whose rows count as well: what is known of a contact that is closed when the part begins.
    channel: Option<&'static str>,
    of: fn(contacts: &[Impact], joints: usize, part: [f64; 2]) -> f64,
}

/// All measures of rows.
pub static SERIES: [SeriesMeasure; 8] = [
    SeriesMeasure {
        name: "least",
        purpose: "the least value",
        unit: same,
        of: |_, x, _| x.iter().copied().fold(f64::INFINITY, f64::min),
    },
    SeriesMeasure {
        name: "largest",
        purpose: "the largest value",
        unit: same,
        of: |_, x, _| x.iter().copied().fold(f64::NEG_INFINITY, f64::max),
    },
    SeriesMeasure {
        name: "largest_magnitude",
        purpose: "the largest magnitude",
        unit: same,
        of: |_, x, _| x.iter().fold(0.0, |most: f64, x| most.max(x.abs())),
    },
    SeriesMeasure {
        name: "mean",
        purpose: "the mean of the rows; of a channel `contact` the share of rows in contact",
        unit: same,
        of: |_, x, _| x.iter().sum::<f64>() / x.len() as f64,
    },
    SeriesMeasure {
        name: "rms",
        purpose: "the root mean square of the rows",
        unit: same,
        of: |_, x, _| (x.iter().map(|x| x * x).sum::<f64>() / x.len() as f64).sqrt(),
    },
    SeriesMeasure {
        name: "quantile",
        purpose: "the value below which the fraction `quantile` of the rows lies, linear between rows in their order",
        unit: same,
        of: |_, x, quantile| {
            let mut sorted = x.to_vec();
            sorted.sort_by(f64::total_cmp);
            super::statistics::quantile(&sorted, quantile)
        },
    },
    SeriesMeasure {
        name: "integral",
        purpose: "the integral over time by the trapezoidal rule between rows; of a force its impulse",
        unit: |unit| match unit {
            "1" => "s".to_owned(),
            unit => format!("{unit} s"),
        },
        of: |t, x, _| {
            let steps = t.windows(2).zip(x.windows(2));
            steps
                .map(|(t, x)| 0.5 * (t[1] - t[0]) * (x[0] + x[1]))
                .sum()
        },
    },
    SeriesMeasure {
        name: "last",
        purpose: "the value of the last row",
        unit: same,
        of: |_, x, _| x[x.len() - 1],
    },
];

/// All measures of contacts.
pub static CONTACTS: [ContactMeasure; 5] = [
    ContactMeasure {
        name: "contacts",
        purpose: "the number of contacts that begin",
        unit: "1",
        channel: None,
        of: |contacts, _, part| begun(contacts, part).count() as f64,
    },
    ContactMeasure {
        name: "contact_share",
        purpose: "the share of time in contact, mean over the joints",
        unit: "1",
        channel: None,
        of: |contacts, joints, [from, to]| {
            let within = |c: &Impact| (c.end.unwrap_or(to).min(to) - c.t.max(from)).max(0.0);
            contacts.iter().map(within).sum::<f64>() / (joints as f64 * (to - from))
        },
    },
    ContactMeasure {
        name: "largest_impact_velocity",
        purpose: "the largest velocity at which a contact begins; 0 where none begins",
        unit: "m/s",
        channel: None,
        of: |contacts, _, part| {
            begun(contacts, part).fold(0.0, |most: f64, c| most.max(c.impact_velocity))
        },
    },
    ContactMeasure {
        name: "largest_contact_force",
        purpose: "the largest force of the contacts that begin, and of the rows",
        unit: "N",
        channel: Some("force"),
        of: |contacts, _, part| {
            begun(contacts, part).fold(0.0, |most: f64, c| most.max(c.largest_force))
        },
    },
    ContactMeasure {
        name: "deepest_penetration",
        purpose: "the largest penetration of the contacts that begin, and of the rows",
        unit: "m",
        channel: Some("penetration"),
        of: |contacts, _, part| {
            begun(contacts, part).fold(0.0, |most: f64, c| most.max(c.deepest_penetration))
        },
    },
];

/// The contacts that begin within a part of a run.
fn begun(contacts: &[Impact], [from, to]: [f64; 2]) -> impl Iterator<Item = &Impact> {
    contacts.iter().filter(move |c| (from..=to).contains(&c.t))
}

fn same(unit: &str) -> String {
    unit.to_owned()
}

/// A kind of measure.
enum MeasureKind {
    Series(&'static SeriesMeasure),
    Contacts(&'static ContactMeasure),
}

impl Measure {
    fn kind(&self) -> Option<MeasureKind> {
        let series = SERIES.iter().find(|kind| kind.name == self.of);
        let contacts = CONTACTS.iter().find(|kind| kind.name == self.of);
        series
            .map(MeasureKind::Series)
            .or(contacts.map(MeasureKind::Contacts))
    }

    /// Names of all kinds.
    pub fn kinds() -> impl Iterator<Item = &'static str> + Clone {
        let series = SERIES.iter().map(|kind| kind.name);
        series.chain(CONTACTS.iter().map(|kind| kind.name))
    }

    /// Checks what can be seen without the scene.
    ///
    /// # Errors
    /// What is wrong, without the name of the measure.
    pub(super) fn check(&self) -> Result<(), String> {
        let Some(kind) = self.kind() else {
            let kinds: Vec<&str> = Measure::kinds().collect();
            let hint = looselink::document::did_you_mean(&self.of, kinds.iter().copied());
            return Err(format!(
                "has the unknown kind `{}`{hint}; kinds of `of`: {}",
                self.of,
                kinds.join(", ")
            ));
        };
        let (wanted, other, [needed, unneeded]) = match kind {
            MeasureKind::Series(_) => (&self.channels, &self.joints, ["channels", "joints"]),
            MeasureKind::Contacts(_) => (&self.joints, &self.channels, ["joints", "channels"]),
        };
        if wanted.is_empty() || !other.is_empty() {
            return Err(format!(
                "needs `{needed}` and no `{unneeded}`, because it is of kind `{}`",
                self.of
            ));
        }
        if let Some(channel) = self.channels.iter().find(|name| name.contains('*')) {
            return Err(format!("needs names of single channels, not `{channel}`"));
        }
        if let Some(name) = (1..wanted.len())
            .map(|k| &wanted[k])
            .find(|name| wanted.iter().filter(|other| other == name).count() > 1)
        {
            return Err(format!("names `{name}` twice"));
        }
        match (self.of.as_str(), self.quantile) {
            ("quantile", Some(q)) if (0.0..=1.0).contains(&q) => {}
            ("quantile", _) => return Err("needs a `quantile` from 0 to 1".to_owned()),
            (_, Some(_)) => {
                return Err(format!("is of kind `{}`, which has no `quantile`", self.of));
            }
            _ => {}
        }
        if !(self.from >= 0.0 && self.to.is_none_or(|to| to > self.from)) {
            return Err("needs `from` at 0 s or later, and `to` after it".to_owned());
        }
        Ok(())
    }

    /// The channels that must be recorded for it.
    pub(super) fn recorded(&self) -> Vec<String> {
        match self.kind() {
            Some(MeasureKind::Contacts(kind)) => {
                let of_joint = |channel| self.joints.iter().map(move |j| format!("{j}.{channel}"));
                kind.channel.into_iter().flat_map(of_joint).collect()
            }
            _ => self.channels.clone(),
        }
    }

    /// Its unit, where that of a channel is known.
    pub(super) fn unit(&self, unit_of: impl Fn(&str) -> String) -> String {
        match self.kind() {
            Some(MeasureKind::Series(kind)) => (kind.unit)(&unit_of(&self.channels[0])),
            Some(MeasureKind::Contacts(kind)) => kind.unit.to_owned(),
            None => String::new(),
        }
    }

    /// In words, for captions.
    pub fn description(&self) -> String {
        let names = [&self.channels[..], &self.joints[..]].concat();
        let names = match names.len() {
            0..=2 => names.join(", "),
            n => format!("{}, {} and {} more", names[0], names[1], n - 2),
        };
        let of = match self.quantile {
            Some(quantile) => format!("{quantile} quantile"),
            None => self.of.replace('_', " "),
        };
        let from = (self.from > 0.0).then(|| format!(", from {} s", self.from));
        let to = self.to.map(|to| format!(", to {to} s"));
        [
            format!("{of} of {names}"),
            from.unwrap_or_default(),
            to.unwrap_or_default(),
        ]
        .concat()
    }

    /// Its value in a run that has come to its end; none where the part of the run has no row, or the number is not finite.
    pub fn value(&self, recorded: &Recorded) -> Option<f64> {
        let (from, to) = (self.from, self.to.unwrap_or(recorded.end).min(recorded.end));
        if from >= to {
            return None;
        }
        let first = recorded.t.partition_point(|t| *t < from);
        let behind = recorded.t.partition_point(|t| *t <= to);
        let value = match self.kind()? {
            MeasureKind::Series(kind) => {
                let series = recorded.magnitude(&self.channels, first..behind)?;
                if series.is_empty() {
                    return None;
                }
                let t = &recorded.t[first..behind];
                (kind.of)(t, &series, self.quantile.unwrap_or(0.5))
            }
            MeasureKind::Contacts(kind) => {
                let contacts = recorded.contacts.iter();
                let own = contacts.filter(|contact| self.joints.contains(&contact.joint));
                let own: Vec<Impact> = own.cloned().collect();
                let mut value = (kind.of)(&own, self.joints.len(), [from, to]);
                for channel in self.recorded() {
                    let rows = recorded.magnitude(&[channel], first..behind)?;
                    value = rows.into_iter().fold(value, f64::max);
                }
                value
            }
        };
        Some(value).filter(|value| value.is_finite())
    }
}
