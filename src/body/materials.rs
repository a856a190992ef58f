//! `[materials]` and `[sections]`.

use crate::document::{Field, Fields, Key, NumberRange, SceneError, derived, named};
use crate::motion::FunctionReader;
use indexmap::IndexMap;

/// `[materials.NAME]`
#[derive(Debug, Clone, Copy)]
pub struct Material {
    /// Density \[kg/m3\].
    pub density: f64,
    /// Young's modulus \[Pa\].
    pub youngs_modulus: Option<f64>,
    /// Poisson's ratio.
    pub poissons_ratio: Option<f64>,
}

/// `[sections.NAME]`: a rectangle.
#[derive(Debug, Clone, Copy)]
pub struct Section {
    /// Area \[m2\].
    pub area: f64,
    /// Second moment of area about the axis normal to the plane \[m4\].
    pub second_moment: f64,
}

/// What bodies and contacts are made of, and what reads the functions of time by which bodies move.
#[derive(Debug)]
pub struct Materials {
    /// Materials by name.
    pub(crate) materials: IndexMap<String, Material>,
    sections: IndexMap<String, Section>,
    /// What reads functions of time.
    pub functions: FunctionReader,
}

/// The keys of a material.
pub static MATERIAL: [Key; 3] = [
    Key::positive("density", "kg/m3", "the mass per volume"),
    Key::positive(
        "youngs_modulus",
        "Pa",
        "Young's modulus, needed by flexible links, and by contacts that name the material",
    )
    .or("none"),
    Key::within(
        "poissons_ratio",
        NumberRange::Within(-1.0, 0.5),
        "Poisson's ratio, needed by contacts that name the material",
    )
    .or("none"),
];

/// The keys of a section.
pub static SECTION: [Key; 2] = [
    Key::positive("width", "m", "the size in the plane, that of bending"),
    Key::positive("height", "m", "the size normal to the plane"),
];

impl Materials {
    /// The tables of a scene.
    pub(crate) fn read(root: &Fields, functions: FunctionReader) -> Result<Materials, SceneError> {
        Ok(Materials {
            materials: named(root.optional("materials"), material)?,
            sections: named(root.optional("sections"), section)?,
            functions,
        })
    }

    /// The material that a key names.
    ///
    /// # Errors
    /// There is none of this name.
    pub fn material(&self, table: &Fields, key: &'static str) -> Result<Material, SceneError> {
        let field = table.field(key)?;
        Ok(*field.lookup("material", &self.materials)?.1)
    }

    /// The section that a key names.
    ///
    /// # Errors
    /// There is none of this name.
    pub fn section(&self, table: &Fields, key: &'static str) -> Result<Section, SceneError> {
        let field = table.field(key)?;
        Ok(*field.lookup("section", &self.sections)?.1)
    }

    /// Young's modulus of the material that a key names \[Pa\].
    ///
    /// # Errors
    /// The material has none.
    pub fn youngs_modulus(&self, table: &Fields, key: &'static str) -> Result<f64, SceneError> {
        let material = self.material(table, key)?;
        has(
            material.youngs_modulus,
            &table.field(key)?,
            "youngs_modulus",
        )
    }

    /// (1 - nu^2)/E of eq. 25 of the material that a key names \[1/Pa\].
    ///
    /// # Errors
    /// The material lacks one of them.
    pub fn compliance(&self, table: &Fields, key: &'static str) -> Result<f64, SceneError> {
        let material = self.material(table, key)?;
        let field = table.field(key)?;
        let nu = has(material.poissons_ratio, &field, "poissons_ratio")?;
        let e = has(material.youngs_modulus, &field, "youngs_modulus")?;
        Ok((1.0 - nu * nu) / e)
    }
}

/// A value of the material that `field` names.
fn has(value: Option<f64>, field: &Field, key: &str) -> Result<f64, SceneError> {
    value.ok_or_else(|| {
        let name = field.written();
        let message = format!(
            "the material {name} has no `{key}`, which `{}` needs",
            field.path
        );
        field.fault(message, format!("no `{key}`"))
    })
}

fn material(field: &Field) -> Result<Material, SceneError> {
    let mut table = field.fields()?;
    table.declare(&[], &MATERIAL)?;
    Ok(Material {
        poissons_ratio: table.optional_number("poissons_ratio")?,
        density: table.number("density")?,
        youngs_modulus: table.optional_number("youngs_modulus")?,
    })
}

fn section(field: &Field) -> Result<Section, SceneError> {
    let mut table = field.fields()?;
    table.declare(&[], &SECTION)?;
    let (width, height) = (table.number("width")?, table.number("height")?);
    Ok(Section {
        area: derived(field, "an area", width * height)?,
        second_moment: derived(field, "a second moment", height * width.powi(3) / 12.0)?,
    })
}
