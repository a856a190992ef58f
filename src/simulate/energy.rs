//! The energy that the integrator lost or gained, as a part of what it is compared with: one percentage for tables and warnings.

use super::Report;
use numbers::{number, share};

/// What the integrator did to the energy.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct EnergyError {
    /// Energy lost by the integrator where the magnitude is largest \[J\]; a negative loss is a gain.
    pub lost: f64,
    /// Its magnitude over the energy that it is compared with.
    pub part: f64,
    /// That energy, in words.
    pub of: &'static str,
}

impl Report {
    /// The largest energy that the integrator has lost or gained, over what the contacts dissipate; where no contact has ended, over what
    /// friction and damping dissipate with them; where these dissipate nothing, over the energy of the motion. The impacts are what a run
    /// with clearance is trusted for, and damping may dissipate far more than they do. A contact that stays closed dissipates as good
    /// as nothing. Absent in a static analysis.
    pub fn energy_error(&self) -> Option<EnergyError> {
        let (ledger, integration) = (self.ledger.as_ref()?, self.integration.as_ref()?);
        let [least, greatest] = integration.lost;
        let ends = [least, greatest, ledger.numerical];
        let lost = ends
            .into_iter()
            .max_by(|a, b| a.abs().total_cmp(&b.abs()))?;
        let dissipates = ledger.friction_dissipated + ledger.damping_dissipated > 0.0;
        let (whole, of) = match self.ended_contacts > 0 && ledger.contact_dissipated > 0.0 {
            true => (ledger.contact_dissipated, "what the contacts dissipate"),
            false if dissipates => (ledger.dissipated(), "the dissipated energy"),
            false => (integration.turnover, "the energy of the motion"),
        };
        Some(EnergyError {
            lost,
            part: match lost == 0.0 {
                true => 0.0,
                false => lost.abs() / whole,
            },
            of,
        })
    }
}

impl EnergyError {
    /// "lost" or "gained", joule, and the part.
    pub fn text(&self) -> String {
        let verb = match self.lost < 0.0 {
            true => "gained",
            false => "lost",
        };
        let joule = number(self.lost.abs(), 2);
        format!("{verb} {joule} J, {}", share(self.part, self.of))
    }
}
