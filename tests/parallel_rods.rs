//! Bodies with hundreds of joints: rods side by side, of which most are redundant, and pendulums, of which none is.

use crate::support::{difference, run_scene};
use looselink::scene::Scene;

/// Points of a platform to which rods are joined, 0.1 m apart.
const PLACES: usize = 10;

/// What rods of 0.5 m do.
#[derive(Debug, Clone, Copy)]
enum Rods {
    /// Carry the platform, without mass.
    Massless,
    /// Carry it as links of this model.
    Links(&'static str),
    /// Hang on it as links of this model, while it turns about its first point.
    Pendulums(&'static str),
}

const ALL: [Rods; 5] = [
    Rods::Massless,
    Rods::Links("rigid"),
    Rods::Links("flexible"),
    Rods::Pendulums("rigid"),
    Rods::Pendulums("flexible"),
];

impl Rods {
    /// A platform with as many rods at each of its points. All of a point together have the mass and the stiffness of one.
    fn scene(self, at_each: usize) -> Scene {
        let points: Vec<String> = (0..PLACES)
            .map(|p| format!("points.p{p} = [{}, 0.0]", 0.1 * p as f64))
            .collect();
        let points = points.join(", ");
        let mut text = format!(
            r#"
format = 1
title = "parallel rods"
simulation = {{ duration = 0.05, gravity = [0.0, -9.81] }}
integrator = {{ method = "bathe", step = 1e-3 }}
output = {{ interval = 1e-3, channels = ["platform.*"] }}
materials.part = {{ density = {:e}, youngs_modulus = {:e} }}
sections.bar = {{ width = 0.01, height = 0.01 }}
bodies.ground = {{ type = "ground", {points} }}
bodies.platform = {{ type = "rigid_body", mass = 10.0, inertia = 1.0, {points} }}
"#,
            8e3 / at_each as f64,
            2e11 / at_each as f64
        );
        let pin = |name: String, bearing: String, journal: String| {
            format!(
                "joints.{name} = {{ type = \"revolute\", model = \"ideal\", bearing = \"{bearing}\", journal = \"{journal}\" }}\n"
            )
        };
        match self {
            Rods::Massless => {
                text += "initial.bodies.platform = { x = 0.3, y = -0.4, theta = 0.0 }\n";
            }
            Rods::Links(_) => {}
            Rods::Pendulums(_) => {
                text += &pin("axle".into(), "ground.p0".into(), "platform.p0".into());
                text += "initial.bodies.platform = { x = 0.0, y = 0.0, theta = 0.0 }\n";
            }
        }
        for k in 0..PLACES * at_each {
            let p = k % PLACES;
            let x = 0.1 * p as f64 + 0.3;
            if let Rods::Links(model) | Rods::Pendulums(model) = self {
                text += &format!(
                    "bodies.r{k} = {{ type = \"link\", model = \"{model}\", length = 0.5, section = \"bar\", material = \"part\", elements = 1 }}\n"
                );
            }
            let (ground, platform) = (format!("ground.p{p}"), format!("platform.p{p}"));
            let [start, end] = ["start", "end"].map(|end| format!("r{k}.{end}"));
            text += &match self {
                Rods::Massless => format!(
                    "joints.r{k} = {{ type = \"rod\", first = \"{ground}\", second = \"{platform}\", length = 0.5 }}\n"
                ),
                Rods::Links(_) => {
                    pin(format!("a{k}"), ground, start)
                        + &pin(format!("b{k}"), end, platform)
                        + &format!("initial.sketch.b{k} = [{x}, -0.4]\n")
                }
                Rods::Pendulums(_) => {
                    pin(format!("b{k}"), platform, start)
                        + &format!("initial.sketch.r{k}.end = [{x}, -0.4]\n")
                }
            };
        }
        Scene::parse("rods", &text, &[]).unwrap_or_else(|e| panic!("{e}"))
    }
}

#[test]
fn many_rods_move_a_platform_as_a_few_of_their_mass_and_stiffness() {
    for rods in ALL {
        let [(few, of_few), (many, of_many)] = [1, 20].map(|n| run_scene(&rods.scene(n)));
        let names = ["platform.x", "platform.y", "platform.theta"];
        let off = difference([&few, &many], names, 1e-3).value();
        // what Newton's method and closing leave, over 50 steps
        assert!(off < 1e-9, "{rods:?}: {off:e}");
        assert_eq!([of_few.fallbacks, of_many.fallbacks], [0, 0], "{rods:?}");
        let redundant = |count: usize| match rods {
            // two rods leave the platform parallel to the ground
            Rods::Massless => count - 2,
            // each has an angle of its own and two rows at its end
            Rods::Links("rigid") => count - 2,
            _ => 0,
        };
        for (report, count) in [(of_few, PLACES), (of_many, 20 * PLACES)] {
            assert_eq!(report.redundant.len(), redundant(count), "{rods:?}");
        }
    }
}

#[test]
fn the_work_of_a_run_grows_with_the_number_of_rods() {
    for rods in ALL {
        let [few, many] = [15, 60].map(|n| run_scene(&rods.scene(n)).1);
        let a_factorisation = |report: &looselink::simulate::Report| {
            report.operations as f64 / report.factorisations as f64
        };
        let growth = a_factorisation(&many) / a_factorisation(&few);
        // proportional, with some fill; dense it would be 64
        assert!(growth < 5.0, "{rods:?}: {growth}");
    }
}
