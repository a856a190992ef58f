//! Texts that somebody else wrote, such as titles, names, units and paths, where they are shown: what no text may hold, and how a
//! text is written on a terminal ([`harmless`]), in [`xml`], in [`markdown`] and in [`csv`].

mod characters;
pub mod csv;
pub mod markdown;
pub mod xml;

pub use characters::{described, harmful, harmful_in_line, harmless, harmless_line, is_invisible};
