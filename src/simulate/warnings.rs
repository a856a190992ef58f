//! What a user should know of a run before the numbers are used.

use super::{Integration, Report};
use numbers::{number, share};

/// Warn of energy lost or gained by the integrator beyond this part of what contacts or dampers dissipate ...
const OF_DISSIPATED: f64 = 0.05;
/// ... or beyond this part of the energy in play.
const OF_TURNOVER: f64 = 0.01;
/// Relative change of accelerations from step to step of a vibration with six steps a period.
const UNRESOLVED: f64 = 1.0;
/// Beyond this strain, or curvature times height, a material is linear in no textbook, and a section neither stays plane nor keeps
/// its size: at -1/2 the centre line has no length. A tenth of it is where steel has long yielded and rubber is linear.
const NOT_SMALL: f64 = 0.2;
/// Warn of an estimated error beyond this part of the largest range of motion.
const OF_TRAVEL: f64 = 0.01;

impl Report {
    /// One line for every reason why results are in doubt: [`Report::error_warnings`] first, then what no theory in use covers.
    /// Facts about a run are [`Report::notes`].
    pub fn warnings(&self) -> Vec<String> {
        let mut warnings = self.error_warnings();
        warnings.extend(self.validity_warnings());
        warnings
    }

    /// Warnings that the motion itself may be off: by the energy that the integrator lost or gained, by its estimated error, by
    /// accelerations or contacts that the steps do not resolve.
    pub fn error_warnings(&self) -> Vec<String> {
        let mut warnings = Vec::new();
        if self.ended_at_limit {
            return warnings;
        }
        if !self.integration.as_ref().is_some_and(Integration::rests) {
            warnings.extend(self.energy_warning());
            warnings.extend(self.error_warning());
            warnings.extend(self.acceleration_warning());
        }
        warnings.extend(self.chatter.iter().map(|chatter| {
            format!(
                "{} chatters from t = {} s to {} s: {} contacts, each shorter than four steps",
                chatter.joint,
                number(chatter.from, 7),
                number(chatter.to, 7),
                chatter.onsets
            )
        }));
        if self.accuracy.is_none() && self.brief_contacts > 0 {
            warnings.push(format!(
                "{} of {} contacts lasted fewer than four steps: reduce integrator.step to resolve them",
                self.brief_contacts, self.ended_contacts
            ));
        }
        warnings
    }

    /// Where a drive, a law or a theory does not hold, or does not do what its name says.
    fn validity_warnings(&self) -> Vec<String> {
        let overrun = self.overrun.iter().map(|(joint, overrun)| {
            format!(
                "the penetration in {joint} is too large: its journal goes {} m deep into a bearing of radius {} m, where no contact law \
                 holds: check the units of its stiffness and of Young's modulus",
                number(overrun.penetration, 2),
                number(overrun.bearing_radius, 2)
            )
        });
        let strained = self
            .strain
            .iter()
            .filter(|(_, strain)| strain.largest() > NOT_SMALL);
        let strained = strained.map(|(name, strain)| {
            format!(
                "{name} has {}, where the theory of slender elastic links does not hold: check Young's modulus (that of steel is \
                 2.1e11 Pa), its section and the loads",
                strain.description()
            )
        });
        let creep = self.creep.iter().map(|(joint, creep)| {
            format!(
                "{joint} creeps: from t = {} s to {} s it slides by {} m at a slip at which its friction law cannot hold a body that \
                 should stick; friction \"elasto_plastic\" can",
                number(creep.from, 4),
                number(creep.to, 4),
                number(creep.distance, 2)
            )
        });
        let giving = self.giving_friction.iter().map(|(joint, from)| {
            format!(
                "from t = {} s on the slip in {joint} is at times beyond 4 g/s1, where the bristles of its friction law may give energy: \
                 reduce s1, or let it fall with the slip by v_d",
                number(*from, 4)
            )
        });
        let implausible = self.implausible.iter().cloned();
        implausible
            .chain(self.drive_doubt.clone())
            .chain(overrun)
            .chain(strained)
            .chain(creep)
            .chain(giving)
            .collect()
    }

    fn energy_warning(&self) -> Option<String> {
        let (error, integration) = (self.energy_error()?, self.integration.as_ref()?);
        let key = match self.accuracy {
            Some(_) => "integrator.accuracy",
            None => "integrator.step",
        };
        let changes_motion = error.lost.abs() > OF_TURNOVER * integration.turnover;
        // where nothing is dissipated the part is that of the motion
        let changes_losses = error.part > OF_DISSIPATED;
        (changes_motion || changes_losses)
            .then(|| format!("the integrator {}: reduce {key}", error.text()))
    }

    fn acceleration_warning(&self) -> Option<String> {
        let integration = self.integration.as_ref()?;
        let change = integration.acceleration_change;
        (change > UNRESOLVED).then(|| {
            format!(
                "the acceleration of {} changes by {} times its own size (rms) from one step to the next: the steps do not \
                 resolve a vibration, so accelerations and forces are unreliable",
                integration.acceleration_change_of,
                number(change, 2)
            )
        })
    }

    fn error_warning(&self) -> Option<String> {
        // the control of the step knows more of the errors: which of them the projection and the vibrations undo
        if self.accuracy.is_some() {
            return None;
        }
        let integration = self.integration.as_ref()?;
        let (error, travel) = (integration.estimated_error, integration.travel);
        (error > OF_TRAVEL * travel).then(|| {
            format!(
                "the estimated error of {} is {} m, {}",
                integration.estimated_error_of,
                number(error, 2),
                share(
                    error / travel,
                    &format!("the largest range of motion, {} m", number(travel, 2))
                )
            )
        })
    }
}
