//! The restitution that contact laws deliver.

use crate::scene::Scene;
use numbers::number;
use serde::Serialize;
use std::fmt;

/// A difference that impacts show: the digits with which coefficients of restitution are measured.
const NOTICED: f64 = 0.01;

/// What a law makes of the restitution that it is given.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct DeliveredRestitution {
    /// The joints.
    pub joints: Vec<String>,
    /// The law.
    pub law: &'static str,
    /// The coefficient that the scene gives.
    pub asked: f64,
    /// That of a free impact.
    pub delivered: f64,
}

impl fmt::Display for DeliveredRestitution {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let [asked, delivered] = [self.asked, self.delivered].map(|x| number(x, 3));
        write!(
            f,
            "{}: {} with a restitution of {asked} delivers {delivered} in a free impact",
            self.joints.join(", "),
            self.law
        )
    }
}

impl DeliveredRestitution {
    /// True where impacts show the difference.
    pub(super) fn differs(&self) -> bool {
        (self.delivered - self.asked).abs() > NOTICED
    }
}

/// What the laws of all joints with clearance deliver, those alike together.
pub(super) fn delivered(scene: &Scene) -> Vec<DeliveredRestitution> {
    let mut all: Vec<DeliveredRestitution> = Vec::new();
    for joint in &scene.joints {
        let Some(contact) = joint.contact() else {
            continue;
        };
        let (law, asked) = (contact.law.name, contact.restitution);
        let delivered = contact.normal_law().delivered_restitution();
        let alike = all.iter_mut();
        let mut alike =
            alike.filter(|d| d.law == law && d.asked == asked && d.delivered == delivered);
        match alike.next() {
            Some(group) => group.joints.push(joint.name.clone()),
            None => all.push(DeliveredRestitution {
                joints: vec![joint.name.clone()],
                law,
                asked,
                delivered,
            }),
        }
    }
    all
}
