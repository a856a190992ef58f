//! Entries of the energy ledger: what is integrated over time along with the motion.

/// An entry of the ledger \[J\], the integral of a power \[W\].
#[derive(Debug, PartialEq, Eq)]
pub struct Entry {
    /// Its channel is `energy.NAME`.
    pub name: &'static str,
    /// Its side of the balance.
    pub side: Side,
}

/// The side of the balance: what is stored has grown by what is supplied, less what is lost.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Side {
    /// Energy that comes from outside.
    Supplied,
    /// Energy that is lost; its power is never negative.
    Lost,
    /// A part of another entry, or another view of it.
    Neither,
}

/// The work of drives and applied forces.
pub static WORK: Entry = Entry {
    name: "work",
    side: Side::Supplied,
};
/// What contacts dissipate along their normals.
pub static CONTACT: Entry = Entry {
    name: "contact_dissipated",
    side: Side::Lost,
};
/// What friction dissipates.
pub static FRICTION: Entry = Entry {
    name: "friction_dissipated",
    side: Side::Lost,
};
/// What dampers and structural damping dissipate.
pub static DAMPING: Entry = Entry {
    name: "damping_dissipated",
    side: Side::Lost,
};
/// The contact energy that is dropped while a force is clamped, a part of [`CONTACT`].
pub static CLAMP: Entry = Entry {
    name: "clamp",
    side: Side::Neither,
};

/// The entries of every mechanism, the first ones.
pub static STANDARD: [&Entry; 5] = [&WORK, &CONTACT, &FRICTION, &DAMPING, &CLAMP];
/// The index of [`WORK`].
pub const OF_WORK: usize = 0;
/// The index of [`FRICTION`].
pub const OF_FRICTION: usize = 2;

/// The powers that a term adds to \[W\].
#[derive(Debug)]
pub struct Powers<'a> {
    /// Those of all entries.
    pub all: &'a mut [f64],
    /// The indices of the entries of the term.
    pub own: &'a [usize],
}

impl Powers<'_> {
    /// Adds to an entry of the term.
    #[inline]
    pub fn add(&mut self, entry: usize, power: f64) {
        self.all[self.own[entry]] += power;
    }
}
