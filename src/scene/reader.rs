//! From the tree to a [`Scene`]: the tables that stand alone; bodies, joints and motion have files of their own.

use super::file::read_file;
use super::{Analysis, integrator, kinds, motion, smallest_clearance};
use super::{Assumption, ChannelPattern, Integrator, Output, Scene, SimulationTable};
use crate::body::Materials;
use crate::document::{
    Field, Fields, Key, Node, SceneError, Sources, Span, Takes, apply_overrides, check_overrides,
    check_texts, document, is_scene, no_scene,
};
use crate::interaction::Names;
use crate::motion::FunctionReader;
use crate::registry::Registry;
use indexmap::IndexMap;
use std::path::Path;

/// Relative error allowed in `interval / step`: decimal fractions are not exact in binary.
const WHOLE: f64 = 1e-9;

/// The keys of a scene.
pub(super) static SCENE: [Key; 14] = [
    Key::new(
        "format",
        Takes::Whole(1, 1),
        "the version of the scene language: `format = 1`",
    ),
    Key::new("title", Takes::Text, "one line that says what the scene is"),
    Key::table(
        "assumptions",
        "values that the source of the scene does not give, see [Assumptions](#assumptions)",
    )
    .or("none"),
    Key::table(
        "simulation",
        "the table of duration, gravity and kind of analysis",
    ),
    Key::table("integrator", "the table of method, step and tolerances"),
    Key::table("output", "the table of what is recorded, and how often"),
    Key::table("materials", "named materials").or("none"),
    Key::table("sections", "named cross-sections").or("none"),
    Key::table("contacts", "named contacts of joints with clearance").or("none"),
    Key::table(
        "bodies",
        "named bodies, exactly one of them of type `\"ground\"`",
    ),
    Key::table("joints", "named joints").or("none"),
    Key::table("drives", "named prescribed motions").or("none"),
    Key::table("forces", "named springs and loads").or("none"),
    Key::table("initial", "where the motion starts").or("none"),
];

/// The keys of `[simulation]`.
pub(super) static SIMULATION: [Key; 4] = [
    Key::word(
        "analysis",
        &["dynamic", "static"],
        "motion over time, or equilibrium under growing loads",
    )
    .or("`\"dynamic\"`"),
    Key::positive(
        "duration",
        "s",
        "the simulated time from t = 0; of a static analysis the t of the full load",
    ),
    Key::vector("gravity", "m/s2", "[gx, gy]", "the gravity vector").or("no weight"),
    Key::word(
        "at_limit",
        &["stop", "follow"],
        "what a static analysis does where the load cannot grow or its equilibrium branches: end there, or follow the path by its arc length",
    )
    .or("`\"stop\"`"),
];

/// The keys of `[output]`.
pub(super) static OUTPUT: [Key; 5] = [
    Key::positive(
        "interval",
        "s",
        "the time between rows, a whole multiple of `step` and at most `duration`",
    ),
    Key::new(
        "channels",
        Takes::List,
        "the list of recorded channels, such as [\"platform.*\"]; `*` stands for any sequence of characters",
    ),
    Key::name_in("format", "formats", "the format of the tables, see below").or("`\"csv\"`"),
    Key::new(
        "motion",
        Takes::Boolean,
        "whether `motion.bin` is written, which `looselink view` shows",
    )
    .or("`true`"),
    Key::non_negative(
        "extremes_from",
        "s",
        "the time from which extremes and the closing table count, at most `duration`; it leaves the start out",
    )
    .or("0"),
];

impl Scene {
    /// Reads a scene file, applies `path=value` overrides in order, checks every field.
    ///
    /// # Errors
    /// The first fault found, with the place it stands at.
    pub fn load(path: &Path, overrides: &[String]) -> Result<Scene, SceneError> {
        Scene::load_with(&Registry::standard(), path, overrides)
    }

    /// As [`Scene::load`], with the kinds of a registry.
    ///
    /// # Errors
    /// The first fault found, with the place it stands at.
    pub fn load_with(
        registry: &Registry,
        path: &Path,
        overrides: &[String],
    ) -> Result<Scene, SceneError> {
        let name = path.display().to_string();
        let unreadable =
            |cause: String| SceneError::unreadable(format!("cannot read `{name}`: {cause}"));
        if path.is_dir() {
            let help = "give the path of a scene file such as scenes/3rrr/case4.toml";
            return Err(unreadable("it is a directory".into()).with_help(help));
        }
        let bytes = read_file(path).map_err(|e| unreadable(e.to_string()))?;
        String::from_utf8(bytes)
            .map_err(|error| {
                let at = error.utf8_error().valid_up_to();
                let text = String::from_utf8_lossy(error.as_bytes());
                let sources = Sources::new(&name, &text, &[]);
                // The replacement character takes three bytes at the same place.
                let span = Span::new(0, at..at + char::REPLACEMENT_CHARACTER.len_utf8());
                SceneError::new(&sources, span, "the scene is not UTF-8 text", "here")
            })
            .and_then(|text| Scene::parse_with(registry, &name, &text, overrides))
    }

    /// Reads a scene from text; `name` stands for the file in errors.
    ///
    /// # Errors
    /// The first fault found, with the place it stands at.
    pub fn parse(name: &str, text: &str, overrides: &[String]) -> Result<Scene, SceneError> {
        Scene::parse_with(&Registry::standard(), name, text, overrides)
    }

    /// As [`Scene::parse`], with the kinds of a registry.
    ///
    /// # Errors
    /// The first fault found, with the place it stands at.
    pub fn parse_with(
        registry: &Registry,
        name: &str,
        text: &str,
        overrides: &[String],
    ) -> Result<Scene, SceneError> {
        let sources = Sources::new(name, text, overrides);
        let tree = document(&sources)?;
        let is_scene = is_scene(&tree);
        Scene::read(registry, &sources, tree).map_err(|error| match is_scene {
            true => error,
            false => error.or(no_scene(&sources)),
        })
    }

    /// The scene of a document.
    fn read(registry: &Registry, sources: &Sources, mut tree: Node) -> Result<Scene, SceneError> {
        check_overrides(sources)?;
        apply_overrides(sources, &mut tree)?;
        check_texts(sources, &tree)?;

        let mut root = Fields::root(sources, &tree)?;
        let format = root.required("format", SCENE[0].purpose)?;
        if format.integer()? != 1 {
            let written = format.written();
            let message = format!("this program reads scene format 1, not {written}");
            return Err(format.fault(message, "unknown format"));
        }
        root.declare(&[], &SCENE)?;
        let title = root.field("title")?.line()?.to_owned();
        let simulation = simulation(&root)?;
        let functions = FunctionReader::new(registry.functions.clone(), simulation.duration);
        let materials = Materials::read(&root, functions)?;
        let bodies = kinds::bodies(&root, &materials, registry)?;
        let by_name = bodies.iter().map(|b| (b.name.clone(), b.kind.clone()));
        let by_name = by_name.collect();
        let none = IndexMap::new();
        let mut names = Names::new(&by_name, &none, &materials.functions);
        let joints = kinds::joints(&root, &names, &materials, registry)?;
        names.joints = &joints;
        let forces = kinds::forces(&root, &names, registry)?;
        let clearance = smallest_clearance(joints.values());
        let integrator = integrator::read(&root, &simulation, clearance, registry)?;
        let output = output(&root, &simulation, &integrator, registry)?;
        let drives = motion::Drives::read(&root, &names)?;
        let initial = motion::initial(&root, &names)?;
        Ok(Scene {
            assumptions: assumptions(&root)?,
            title,
            simulation,
            integrator,
            output,
            materials: materials.materials,
            joints: joints.into_values().collect(),
            bodies,
            drives: drives.kinematics,
            motions: drives.motions,
            forces,
            initial,
            notes: materials.functions.notes(),
            sources: sources.clone(),
        })
    }
}

impl SimulationTable {
    /// The time that a field gives, refused where it exceeds the duration \[s\].
    pub(super) fn check_time(&self, field: &Field) -> Result<f64, SceneError> {
        let time = field.number()?;
        match time > self.duration {
            true => Err(field.must(&format!(
                "not be longer than the duration of {} s",
                self.duration
            ))),
            false => Ok(time),
        }
    }
}

fn simulation(root: &Fields) -> Result<SimulationTable, SceneError> {
    let mut table = root.field("simulation")?.fields()?;
    table.declare(&[], &SIMULATION)?;
    let analysis = match table.optional_word("analysis")? {
        Some(1) => Analysis::Static,
        _ => Analysis::Dynamic,
    };
    let follows_limits = table.optional_word("at_limit")?;
    let field = table.optional("at_limit");
    if let Some(field) = field.filter(|_| analysis == Analysis::Dynamic) {
        let message = "`simulation.at_limit` belongs to a static analysis";
        return Err(field.fault(message, "a motion has no load path"));
    }
    Ok(SimulationTable {
        analysis,
        duration: table.number("duration")?,
        gravity: table.optional_vector("gravity")?,
        follows_limits: follows_limits == Some(1),
    })
}

fn output(
    root: &Fields,
    simulation: &SimulationTable,
    integrator: &Integrator,
    registry: &Registry,
) -> Result<Output, SceneError> {
    let mut table = root.field("output")?.fields()?;
    table.declare(&[], &OUTPUT)?;
    let field = table.field("interval")?;
    let interval = table.number("interval")?;
    if let Some(step) = integrator.step() {
        check_interval(&field, interval, step)?;
    }
    simulation.check_time(&field)?;
    let field = table.field("channels")?;
    let mut channels = Vec::new();
    for item in field.items()? {
        channels.push(ChannelPattern {
            pattern: item.text()?.to_owned(),
            span: item.node.span,
        });
    }
    if channels.is_empty() {
        return Err(field.fault("`output.channels` names no channel", "empty"));
    }
    if let Some(field) = table.optional("extremes_from") {
        simulation.check_time(&field)?;
    }
    let formats: Vec<_> = registry.formats.iter().map(|f| (f.name, *f)).collect();
    let format = table.optional("format").map(|f| f.choice(&formats));
    Ok(Output {
        interval,
        channels,
        format: format.transpose()?.unwrap_or(registry.formats[0]),
        motion: table.optional_boolean("motion")?.unwrap_or(true),
        extremes_from: table.optional_number("extremes_from")?.unwrap_or(0.0),
    })
}

fn check_interval(field: &Field, interval: f64, step: f64) -> Result<(), SceneError> {
    let ratio = interval / step;
    let whole = ratio.round();
    if whole >= 1.0 && (ratio - whole).abs() <= WHOLE * whole {
        return Ok(());
    }
    let [below, above] = [ratio.floor() * step, (ratio.floor() + 1.0) * step].map(decimal);
    let near = if ratio < 1.0 {
        above
    } else {
        format!("{below} or {above}")
    };
    let message = format!(
        "`{}` must be a whole multiple of `integrator.step` = {step:?}, not {}",
        field.path,
        field.written()
    );
    let error = field.fault(message, format!("{} steps", decimal(ratio)));
    Err(error.with_help(format!("nearest valid: {near}")))
}

/// Ten significant digits, without the dust of binary fractions.
fn decimal(x: f64) -> String {
    match format!("{x:.9e}").parse::<f64>() {
        Ok(rounded) => format!("{rounded:?}"),
        Err(_) => x.to_string(),
    }
}

fn assumptions(root: &Fields) -> Result<Vec<Assumption>, SceneError> {
    let mut result = Vec::new();
    let Some(table) = root.optional("assumptions") else {
        return Ok(result);
    };
    for field in table.fields()?.entries() {
        if field.is_table() {
            let error = field.key_fault(format!("`{}` is a table", field.path), "not a path");
            let help = "write the path in quotes: \"materials.steel.density\" = \"why\"";
            return Err(error.with_help(help));
        }
        let (mut node, mut above) = (root.whole.node, String::new());
        for part in field.name.split('.') {
            let Some(child) = node.child(part) else {
                return Err(field.key_fault(node.lacks(&above, part), "no such field"));
            };
            node = child;
            above = format!("{above}{part}.");
        }
        result.push(Assumption {
            path: field.name.clone(),
            value: root.whole.sources.written(node.span).to_owned(),
            reason: field.text()?.to_owned(),
        });
    }
    Ok(result)
}
