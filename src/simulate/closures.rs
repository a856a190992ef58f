//! Contacts that the steps do not resolve: closed for a few steps only, or closing and opening repeatedly (chatter).

use crate::checkpoint::carried;
use crate::model::Model;
use crate::system::Changed;
use serde::Serialize;

/// A contact, or the flight between two, is brief if it has fewer steps than this: the steps do not resolve it.
const FEW_STEPS: u64 = 4;
/// This many brief contacts with brief flights between them are chatter.
const CHATTER: u64 = 10;
/// Stretches of chatter that the summary lists.
const LISTED: usize = 10;

/// A period of chatter: a joint closed and opened repeatedly, within a few steps each.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Chatter {
    /// The joint.
    pub joint: String,
    /// First onset \[s\].
    pub from: f64,
    /// Last loss of contact \[s\].
    pub to: f64,
    /// Onsets in between.
    pub onsets: u64,
}

/// Follows every contact.
#[derive(Debug)]
pub(super) struct Closures {
    contacts: Vec<Closure>,
    /// Contacts that were lost.
    pub ended: u64,
    /// Those of them that were closed for a few steps only.
    pub brief: u64,
    /// The first stretches of chatter.
    listed: Vec<Stretch>,
}

carried!(Closures { contacts, ended, brief } and up to LISTED of { listed } but {});

/// A period of chatter of a contact; see [`Chatter`].
#[derive(Debug, Clone, Copy, Default)]
struct Stretch {
    contact: usize,
    from: f64,
    to: f64,
    onsets: u64,
}

carried!(Stretch { contact, from, to, onsets } but {});

#[derive(Debug, Clone, Copy, Default)]
struct Closure {
    /// Steps since the contact last closed or opened.
    steps: u64,
    /// Brief contacts in succession, with brief flights between them.
    streak: u64,
    /// Onset of the first of them \[s\].
    from: f64,
    /// Index of the present period of chatter in the list.
    listed: Option<usize>,
}

carried!(Closure { steps, streak, from, listed } but {});

impl Closures {
    pub fn new(contacts: usize) -> Closures {
        let start = Closure {
            steps: FEW_STEPS,
            ..Closure::default()
        };
        Closures {
            contacts: vec![start; contacts],
            ended: 0,
            brief: 0,
            listed: Vec::with_capacity(LISTED),
        }
    }

    /// Records an accepted step to time t that ends with these changes.
    pub fn step(&mut self, t: f64, changed: &[Changed]) {
        for contact in &mut self.contacts {
            contact.steps += 1;
        }
        for change in changed {
            let c = match *change {
                Changed::Onset { contact, .. } | Changed::Loss { contact } => contact,
                Changed::Switch { .. } => continue,
            };
            let contact = &mut self.contacts[c];
            let brief = contact.steps < FEW_STEPS;
            contact.steps = 0;
            if !brief {
                (contact.streak, contact.listed) = (0, None);
            }
            if change.closed().is_some() {
                if contact.streak == 0 {
                    contact.from = t;
                }
                continue;
            }
            self.ended += 1;
            if !brief {
                continue;
            }
            self.brief += 1;
            contact.streak += 1;
            if let Some(place) = contact.listed {
                let stretch = &mut self.listed[place];
                (stretch.to, stretch.onsets) = (t, contact.streak);
            } else if contact.streak == CHATTER && self.listed.len() < LISTED {
                contact.listed = Some(self.listed.len());
                self.listed.push(Stretch {
                    contact: c,
                    from: contact.from,
                    to: t,
                    onsets: contact.streak,
                });
            }
        }
    }

    /// The first periods of chatter.
    pub fn chatter(&self, model: &Model) -> Vec<Chatter> {
        let named = |stretch: &Stretch| {
            let joint = model.contact_joint(stretch.contact);
            Chatter {
                joint: joint.map_or(String::new(), |j| model.joints()[j].name.clone()),
                from: stretch.from,
                to: stretch.to,
                onsets: stretch.onsets,
            }
        };
        self.listed.iter().map(named).collect()
    }
}
