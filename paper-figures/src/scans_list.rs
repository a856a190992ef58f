//! The list of parameter scans, one at a time around the printed and assumed values.

use crate::campaign::controlled;
use crate::kinematics::MechanismGeometry;
use crate::runs::{RunPace, RunPlan};
use crate::scans::{Scan, ScanEntry};
use numbers::{digits, si};
use plot::Axis;

/// Thickness of the moving platform in Table 1 \[m\].
const THICKNESS: f64 = 0.01;
/// Time between recorded rows, a whole multiple of every step scanned \[s\].
pub const INTERVAL: f64 = 2e-5;

/// An entry for every value and case; `change` gives the overrides of a value. The
/// value `base` is overridden too, so that its label is right whatever the scene says.
fn entries(
    cases: &[u32],
    values: &[(f64, String)],
    base: f64,
    change: impl Fn(f64) -> Vec<String>,
) -> Vec<ScanEntry> {
    let mut entries = Vec::new();
    for &case in cases {
        for (value, label) in values {
            entries.push(ScanEntry {
                label: label.clone(),
                at: *value,
                baseline: *value == base,
                plan: RunPlan {
                    overrides: change(*value),
                    ..controlled(case, INTERVAL)
                },
                outcome: Err("not run".into()),
            });
        }
    }
    entries
}

/// All scans, their runs not yet made.
pub fn all(geometry: &MechanismGeometry) -> Vec<Scan> {
    let with = |values: &[f64], unit: &str| {
        values
            .iter()
            .map(|v| (*v, si(*v, unit)))
            .collect::<Vec<_>>()
    };
    let plain = |values: &[f64]| values.iter().map(|v| (*v, digits(*v))).collect::<Vec<_>>();
    let one = |path: &'static str| move |value: f64| vec![format!("{path}={value:?}")];
    let friction = |slip: &'static str| {
        let change = move |c: f64| {
            if c == 0.0 {
                return Vec::new();
            }
            vec![format!(
                "contacts.pin.friction={{ law = \"ambrosio\", coefficient = {c:?}, v0 = 1e-4, v1 = 1e-3, slip = \"{slip}\" }}"
            )]
        };
        entries(&[3, 4], &plain(&[0.0, 0.05, 0.1, 0.3]), 0.0, change)
    };
    let scan = |slug, title, axis, entries| Scan {
        slug,
        title,
        axis,
        entries,
    };
    let modulus = with(&[7e8, 2e9, 7e9, 2e10, 7e10, 2e11, 7e11], "Pa");
    let clearance = with(&[2e-6, 6e-6, 2e-5, 6e-5, 2e-4], "m");
    let coefficient = || Axis::new("Friction coefficient", "", 1.0);
    vec![
        scan(
            "youngs-modulus",
            "Young's modulus of the passive links (printed 7 GPa, aluminium 70 GPa)",
            Axis::new("Young's modulus", "Pa", 1.0).log(),
            entries(
                &[2, 4],
                &modulus,
                7e9,
                one("materials.passive.youngs_modulus"),
            ),
        ),
        scan(
            "clearance",
            "Radial clearance (printed 20 µm)",
            Axis::new("Radial clearance", "µm", 1e6).log(),
            entries(&[3, 4], &clearance, 2e-5, one("contacts.pin.clearance")),
        ),
        scan(
            "platform-mass",
            "Platform mass, by its thickness (assumed: a full triangular plate)",
            Axis::new("Platform mass over assumed", "", 1.0).log(),
            entries(
                &[2, 3, 4],
                &plain(&[0.1, 0.3, 1.0, 3.0, 10.0]),
                1.0,
                |factor| {
                    vec![format!(
                        "bodies.platform.plate.thickness={:?}",
                        factor * THICKNESS
                    )]
                },
            ),
        ),
        scan(
            "restitution",
            "Restitution coefficient (assumed 0.9)",
            Axis::new("Restitution coefficient", "", 1.0),
            entries(
                &[3, 4],
                &plain(&[0.3, 0.5, 0.7, 0.9, 1.0]),
                0.9,
                one("contacts.pin.restitution"),
            ),
        ),
        scan(
            "bearing-radius",
            "Bearing radius (assumed 10 mm); contact stiffness follows eq. 25",
            Axis::new("Bearing radius", "mm", 1e3).log(),
            entries(
                &[3, 4],
                &with(&[2.5e-3, 5e-3, 1e-2, 2e-2, 4e-2], "m"),
                1e-2,
                one("contacts.pin.bearing_radius"),
            ),
        ),
        scan(
            "contact-stiffness",
            "Contact stiffness, by the Young's modulus of the pins (assumed 70 GPa)",
            Axis::new("Young's modulus of the pins", "Pa", 1.0).log(),
            entries(
                &[3, 4],
                &with(&[7e8, 7e9, 7e10, 7e11], "Pa"),
                7e10,
                one("materials.aluminium.youngs_modulus"),
            ),
        ),
        scan(
            "friction-paper",
            "Friction with the printed slip velocity (assumed: none)",
            coefficient(),
            friction("paper"),
        ),
        scan(
            "friction-material",
            "Friction with the slip of the material (assumed: none)",
            coefficient(),
            friction("material"),
        ),
        scan(
            "reading",
            "Reading of the geometry",
            Axis::new("Reading", "", 1.0).over(0.5, 6.5),
            readings(geometry),
        ),
        scan(
            "step",
            "Step of Bathe's method",
            Axis::new("Step h", "µs", 1e6).log(),
            steps(),
        ),
    ]
}

/// The step changes nothing else, so its plans carry no override.
fn steps() -> Vec<ScanEntry> {
    let step = |case, h: f64| ScanEntry {
        label: si(h, "s"),
        at: h,
        baseline: false,
        plan: RunPlan {
            pace: RunPace::bathe(h),
            ..controlled(case, INTERVAL)
        },
        outcome: Err("not run".into()),
    };
    [2, 3, 4]
        .into_iter()
        .flat_map(|case| [2e-5, 1e-5, 5e-6, 2e-6, 1e-6].map(|h| step(case, h)))
        .collect()
}

/// Readings of "0.4 m" and of the elbow branch.
fn readings(printed: &MechanismGeometry) -> Vec<ScanEntry> {
    let flipped = |legs: [f64; 3]| {
        let elbow = std::array::from_fn(|i| printed.elbow[i] * legs[i]);
        MechanismGeometry {
            elbow,
            ..printed.clone()
        }
    };
    let side = MechanismGeometry {
        base: printed.base.map(|p| p.map(|v| v / 3f64.sqrt())),
        ..printed.clone()
    };
    let readings = [
        (
            "circumradius 0.4 m, equal elbows (printed)",
            printed.clone(),
        ),
        (
            "circumradius 0.4 m, all elbows mirrored",
            flipped([-1.0; 3]),
        ),
        ("side 0.4 m (circumradius 0.2309 m)", side),
        ("elbow of leg 1 mirrored", flipped([-1.0, 1.0, 1.0])),
        ("elbow of leg 2 mirrored", flipped([1.0, -1.0, 1.0])),
        ("elbow of leg 3 mirrored", flipped([1.0, 1.0, -1.0])),
    ];
    let values: Vec<(f64, String)> = readings
        .iter()
        .enumerate()
        .map(|(i, (label, _))| ((i + 1) as f64, label.to_string()))
        .collect();
    entries(&[2, 3, 4], &values, 1.0, |value| {
        let g = &readings[value as usize - 1].1;
        let start = g.pose(0.0);
        let point =
            |path: &str, i: usize, p: [f64; 2]| format!("{path}{}=[{:?}, {:?}]", i + 1, p[0], p[1]);
        let base = (0..3)
            .filter(|&i| g.base[i] != printed.base[i])
            .map(|i| point("bodies.ground.points.A", i, g.base[i]));
        base.chain((0..3).map(|i| point("initial.sketch.B", i, g.pin(i, start))))
            .collect()
    })
}
