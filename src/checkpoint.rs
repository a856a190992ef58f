//! What a run carries from step to step, as bytes from which it goes on bit for bit.
//!
//! One function writes and reads a value, so that the two cannot differ. `carried!` makes it from the names of the fields:
//! first those that are carried, then those that follow from the scene or are computed anew in every step. A field in neither
//! list does not compile.

/// The values of a run on their way to a file or back, in words of 64 bits.
#[derive(Debug)]
pub struct Checkpoint {
    bytes: Vec<u8>,
    /// Where the next word is read; `None` while values are written.
    at: Option<usize>,
    /// True where something else was read than is there.
    is_misfit: bool,
}

/// A value that a run carries from step to step.
pub trait Carried {
    /// Writes the value into the checkpoint, or replaces it with the one that is read there.
    fn carry(&mut self, checkpoint: &mut Checkpoint);
}

/// The bytes are not those of a checkpoint of this run.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[error("the checkpoint does not fit the scene")]
pub struct Misfit;

impl Checkpoint {
    /// The bytes of what `carry` carries.
    pub fn written(carry: impl FnOnce(&mut Checkpoint)) -> Vec<u8> {
        let mut checkpoint = Checkpoint {
            bytes: Vec::new(),
            at: None,
            is_misfit: false,
        };
        carry(&mut checkpoint);
        checkpoint.bytes
    }

    /// Replaces what `carry` carries with what was written.
    ///
    /// # Errors
    /// When the bytes were written by something else; what was carried is then of no use.
    pub fn read(bytes: Vec<u8>, carry: impl FnOnce(&mut Checkpoint)) -> Result<(), Misfit> {
        let mut checkpoint = Checkpoint {
            bytes,
            at: Some(0),
            is_misfit: false,
        };
        carry(&mut checkpoint);
        match checkpoint.left() == Some(0) && !checkpoint.is_misfit {
            true => Ok(()),
            false => Err(Misfit),
        }
    }

    /// Bytes that were not read yet.
    fn left(&self) -> Option<usize> {
        Some(self.bytes.len() - self.at?)
    }

    /// Writes a word, or reads one instead.
    fn word(&mut self, word: u64) -> u64 {
        let Some(at) = self.at else {
            self.bytes.extend(word.to_le_bytes());
            return word;
        };
        match self.bytes[at..].first_chunk() {
            Some(bytes) => {
                self.at = Some(at + bytes.len());
                u64::from_le_bytes(*bytes)
            }
            None => {
                self.is_misfit = true;
                0
            }
        }
    }
}

impl Carried for f64 {
    fn carry(&mut self, checkpoint: &mut Checkpoint) {
        *self = f64::from_bits(checkpoint.word(self.to_bits()));
    }
}

impl Carried for u64 {
    fn carry(&mut self, checkpoint: &mut Checkpoint) {
        *self = checkpoint.word(*self);
    }
}

impl Carried for u32 {
    fn carry(&mut self, checkpoint: &mut Checkpoint) {
        *self = checkpoint.word(u64::from(*self)) as u32;
    }
}

impl Carried for usize {
    fn carry(&mut self, checkpoint: &mut Checkpoint) {
        *self = checkpoint.word(*self as u64) as usize;
    }
}

impl Carried for bool {
    fn carry(&mut self, checkpoint: &mut Checkpoint) {
        *self = checkpoint.word(u64::from(*self)) != 0;
    }
}

impl<T: Carried, const N: usize> Carried for [T; N] {
    fn carry(&mut self, checkpoint: &mut Checkpoint) {
        self.iter_mut().for_each(|x| x.carry(checkpoint));
    }
}

/// As many values as the scene has of something: their number is not carried, but checked.
impl<T: Carried> Carried for Vec<T> {
    fn carry(&mut self, checkpoint: &mut Checkpoint) {
        let mut length = self.len();
        length.carry(checkpoint);
        match length == self.len() {
            true => self.iter_mut().for_each(|x| x.carry(checkpoint)),
            false => checkpoint.is_misfit = true,
        }
    }
}

/// Carries values whose number changes during the run, `most` at most.
pub fn carry_list<T: Carried + Default>(
    list: &mut Vec<T>,
    most: usize,
    checkpoint: &mut Checkpoint,
) {
    let mut length = list.len();
    length.carry(checkpoint);
    match length <= most {
        true => list.resize_with(length, T::default),
        false => checkpoint.is_misfit = true,
    }
    list.iter_mut().for_each(|x| x.carry(checkpoint));
}

impl<T: Carried + Default> Carried for Option<T> {
    fn carry(&mut self, checkpoint: &mut Checkpoint) {
        let mut is_there = self.is_some();
        is_there.carry(checkpoint);
        match is_there {
            true => self.get_or_insert_default().carry(checkpoint),
            false => *self = None,
        }
    }
}

impl<T: Carried + ?Sized> Carried for Box<T> {
    fn carry(&mut self, checkpoint: &mut Checkpoint) {
        (**self).carry(checkpoint);
    }
}

/// Carries some fields of a type, lists among them up to a length; the others follow from the scene or are computed anew in every
/// step.
macro_rules! carried {
    (
        $type:ident { $($carried:ident),* $(,)? }
        $(and up to $most:ident of { $($list:ident),* })?
        but { $($other:ident),* $(,)? }
    ) => {
        impl $crate::checkpoint::Carried for $type {
            #[allow(unused_variables, reason = "some carry nothing")]
            fn carry(&mut self, checkpoint: &mut $crate::checkpoint::Checkpoint) {
                let $type { $($carried,)* $($($list,)*)? $($other: _,)* } = self;
                $($crate::checkpoint::Carried::carry($carried, checkpoint);)*
                $($($crate::checkpoint::carry_list($list, $most, checkpoint);)*)?
            }
        }
    };
}
pub(crate) use carried;

#[cfg(test)]
mod tests {
    use super::*;

    #[derive(Debug, Clone, PartialEq)]
    struct Everything {
        x: f64,
        counts: Vec<[u64; 2]>,
        flags: [bool; 3],
        optional: Option<u32>,
        index: usize,
        constant: f64,
    }
    carried!(Everything { x, counts, flags, optional, index } but { constant });

    fn everything() -> Everything {
        Everything {
            x: -0.0,
            counts: vec![[1, u64::MAX], [3, 4]],
            flags: [true, false, true],
            optional: Some(7),
            index: 5,
            constant: 1.0,
        }
    }

    fn nothing() -> Everything {
        Everything {
            x: 0.0,
            counts: vec![[0; 2]; 2],
            flags: [false; 3],
            optional: None,
            index: 0,
            constant: 1.0,
        }
    }

    #[test]
    fn what_is_written_is_read_into_something_else() {
        let (mut from, mut to) = (everything(), nothing());
        let bytes = Checkpoint::written(|c| from.carry(c));
        Checkpoint::read(bytes, |c| to.carry(c)).unwrap();
        assert_eq!(to, from);
        assert!(to.x.is_sign_negative());
        let bytes = Checkpoint::written(|c| nothing().carry(c));
        Checkpoint::read(bytes, |c| to.carry(c)).unwrap();
        assert_eq!(to, nothing());
    }

    #[test]
    fn other_bytes_are_refused() {
        let bytes = Checkpoint::written(|c| everything().carry(c));
        let read = |bytes: Vec<u8>| Checkpoint::read(bytes, |c| nothing().carry(c));
        for length in 0..bytes.len() {
            assert_eq!(read(bytes[..length].to_vec()), Err(Misfit), "{length}");
        }
        assert_eq!(read([&bytes[..], &[0; 8]].concat()), Err(Misfit));
        let mut more = everything();
        more.counts.push([0; 2]);
        assert_eq!(read(Checkpoint::written(|c| more.carry(c))), Err(Misfit));
    }

    #[test]
    fn lists_grow_to_their_bound() {
        let bytes = Checkpoint::written(|c| carry_list(&mut vec![1.0, 2.0, 3.0], 3, c));
        let mut list = vec![0.0];
        Checkpoint::read(bytes.clone(), |c| carry_list(&mut list, 3, c)).unwrap();
        assert_eq!(list, [1.0, 2.0, 3.0]);
        let short = Checkpoint::read(bytes, |c| carry_list(&mut vec![0.0], 2, c));
        assert_eq!(short, Err(Misfit));
    }
}
