//! `[materials]` and `[sections]`.

use super::error::SceneError;
use super::field::Field;
use super::names::derived;

/// `[materials.NAME]`
pub(super) struct Material {
    pub density: f64,
    pub youngs_modulus: Option<f64>,
    poissons_ratio: Option<f64>,
}

/// `[sections.NAME]`: a rectangle.
pub(super) struct Section {
    pub area: f64,
    pub second_moment: f64,
}

impl Material {
    /// (1 - nu^2) / E of eq. 25 \[1/Pa\]; `field` names the material.
    pub(super) fn compliance(&self, field: &Field) -> Result<f64, SceneError> {
        let nu = self
            .poissons_ratio
            .ok_or_else(|| lacks(field, "poissons_ratio"))?;
        let e = self
            .youngs_modulus
            .ok_or_else(|| lacks(field, "youngs_modulus"))?;
        Ok((1.0 - nu * nu) / e)
    }
}

/// A fault: the material that `field` names has no `key`.
pub(super) fn lacks(field: &Field, key: &str) -> SceneError {
    let name = field.written();
    let message = format!(
        "the material {name} has no `{key}`, which `{}` needs",
        field.path
    );
    field.fault(message, format!("no `{key}`"))
}

pub(super) fn material(field: &Field) -> Result<Material, SceneError> {
    let mut table = field.fields()?;
    table.only(&["density", "youngs_modulus", "poissons_ratio"])?;
    let poissons_ratio = table.optional("poissons_ratio");
    let poissons_ratio = poissons_ratio.map(|nu| match nu.number()? {
        x if x > -1.0 && x <= 0.5 => Ok(x),
        _ => Err(nu.must("lie above -1 and not above 0.5")),
    });
    Ok(Material {
        density: table
            .required("density", "the mass per volume [kg/m3]")?
            .positive()?,
        youngs_modulus: table
            .optional("youngs_modulus")
            .map(|e| e.positive())
            .transpose()?,
        poissons_ratio: poissons_ratio.transpose()?,
    })
}

pub(super) fn section(field: &Field) -> Result<Section, SceneError> {
    let mut table = field.fields()?;
    table.only(&["width", "height"])?;
    let width = table
        .required("width", "the size in the plane, that of bending [m]")?
        .positive()?;
    let height = table
        .required("height", "the size normal to the plane [m]")?
        .positive()?;
    Ok(Section {
        area: derived(field, "an area", width * height)?,
        second_moment: derived(field, "a second moment", height * width.powi(3) / 12.0)?,
    })
}
