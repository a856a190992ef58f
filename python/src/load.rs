//! A load on a point as a Python callable of the motion of the point: F(t, x, y, vx, vy).

use super::callable::{NUMBER, Role, call, finite, is_given, number, wrong_result};
use looselink::document::Key;
use looselink::effect::Effect;
use looselink::interaction::ForceKind;
use looselink::interaction::point_law::{LoadGradient, PointLaw, PointLoad, differences};
use looselink::math::plane::Vec2;
use pyo3::prelude::*;
use std::sync::Arc;

pub static LOAD: ForceKind = ForceKind {
    name: "callable",
    keys: &[Key::point("point", "where it acts"), NUMBER],
    read: |table, names| {
        let point = names.point(&table.field("point")?)?;
        let number = number(table)?;
        let law = CallableLaw {
            path: table.path().to_owned(),
            number,
            has_tangent: is_given(number, Role::Tangent),
        };
        let law = Arc::new(law);
        Ok(Arc::new(PointLoad { point, law }))
    },
};

/// F as a callable. Once one has raised an exception it is not a number.
#[derive(Debug)]
struct CallableLaw {
    path: String,
    number: usize,
    has_tangent: bool,
}

impl PointLaw for CallableLaw {
    fn effect(&self) -> Effect {
        "callable_load"
    }

    fn force(&self, t: f64, r: Vec2, v: Vec2) -> Vec2 {
        let force = call(self.number, Role::Function, |load| {
            let result = load.call1((t, r.x, r.y, v.x, v.y))?;
            let force = result.extract();
            let force: [f64; 2] =
                force.map_err(|_| wrong_result(&self.path, "(fx, fy)", &result))?;
            finite(&self.path, t, &force)?;
            Ok(force)
        });
        force.unwrap_or([f64::NAN; 2]).into()
    }

    fn gradient(&self, t: f64, r: Vec2, v: Vec2, force: Vec2) -> LoadGradient {
        if !self.has_tangent {
            return differences(|r, v| self.force(t, r, v), r, v, force);
        }
        let gradient = call(self.number, Role::Tangent, |tangent| {
            let result = tangent.call1((t, r.x, r.y, v.x, v.y))?;
            let wanted = "two rows of the derivatives by x, y, vx, vy as its tangent";
            let gradient = result.extract();
            let gradient: [[f64; 4]; 2] =
                gradient.map_err(|_| wrong_result(&self.path, wanted, &result))?;
            finite(&self.path, t, gradient.as_flattened())?;
            Ok(gradient)
        });
        let gradient = gradient.unwrap_or([[f64::NAN; 4]; 2]);
        LoadGradient::from_row_slice(gradient.as_flattened())
    }
}
