//! Scenes to start from.

/// A commented scene that a user makes his own.
#[derive(Debug)]
pub struct Template {
    /// How `looselink new` calls it; the commands in its first lines call it so, too.
    pub name: &'static str,
    /// What it is, in a few words.
    pub purpose: &'static str,
    text: &'static str,
}

/// All of them, from the simplest to the most complex but for the empty one.
pub static TEMPLATES: [Template; 6] = [
    Template {
        name: "pendulum",
        purpose: "a disc that swings",
        text: include_str!("../templates/pendulum.toml"),
    },
    Template {
        name: "crane",
        purpose: "a load that swings on an elastic rope; its trolley follows a table",
        text: include_str!("../templates/crane.toml"),
    },
    Template {
        name: "slider-crank",
        purpose: "a slider-crank with play in the wrist pin",
        text: include_str!("../templates/slider-crank.toml"),
    },
    Template {
        name: "four-bar",
        purpose: "a four-bar linkage with a loose pin; its coupler can bend",
        text: include_str!("../templates/four-bar.toml"),
    },
    Template {
        name: "3rrr",
        purpose: "the 3-RRR parallel mechanism with flexible links and loose joints",
        text: include_str!("../templates/3rrr.toml"),
    },
    Template {
        name: "empty",
        purpose: "the ground, a body and a joint; everything else as comments",
        text: include_str!("../templates/empty.toml"),
    },
];

impl Template {
    /// The scene, with the commands that simulate it from `file` to `out`.
    pub fn scene(&self, file: &str, out: &str) -> String {
        let Template { name, text, .. } = self;
        // a name in the place of one must not be replaced again
        const OUT: &str = "{out}";
        text.replace(&format!("out/{name}"), OUT)
            .replace(&format!("{name}.toml"), file)
            .replace(OUT, out)
    }
}
