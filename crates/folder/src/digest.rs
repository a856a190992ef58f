//! The size of a file and its CRC-32, by which a damaged or edited one is known.

use serde::{Deserialize, Serialize};
use std::io::{self, Read};

/// Bytes that are read at a time.
const PIECE: usize = 1 << 16;

/// Number of bytes and their CRC-32 (ISO 3309, as in gzip).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct Digest {
    /// Number of bytes.
    pub bytes: u64,
    /// Their CRC-32.
    pub crc32: u32,
}

impl Digest {
    /// That of some bytes.
    pub fn of(bytes: &[u8]) -> Digest {
        let mut digesting = Digesting::default();
        digesting.update(bytes);
        digesting.digest()
    }

    /// That of what is read, up to a number of bytes.
    ///
    /// # Errors
    /// When it cannot be read.
    pub fn read(from: impl Read, at_most: u64) -> io::Result<Digest> {
        let mut from = from.take(at_most);
        let mut digesting = Digesting::default();
        let mut piece = vec![0; PIECE];
        loop {
            match from.read(&mut piece)? {
                0 => return Ok(digesting.digest()),
                n => digesting.update(&piece[..n]),
            }
        }
    }
}

/// A digest of bytes as they come.
#[derive(Debug, Clone, Default)]
pub struct Digesting {
    bytes: u64,
    hasher: crc32fast::Hasher,
}

impl Digesting {
    /// Continues after the bytes of a digest.
    pub fn after(digest: Digest) -> Digesting {
        Digesting {
            bytes: digest.bytes,
            hasher: crc32fast::Hasher::new_with_initial_len(digest.crc32, digest.bytes),
        }
    }

    /// Adds bytes.
    pub fn update(&mut self, bytes: &[u8]) {
        self.bytes += bytes.len() as u64;
        self.hasher.update(bytes);
    }

    /// That of all bytes so far.
    pub fn digest(&self) -> Digest {
        Digest {
            bytes: self.bytes,
            crc32: self.hasher.clone().finalize(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{Digest, Digesting};

    /// The check value of the catalogue of CRC algorithms.
    #[test]
    fn the_digest_is_that_of_gzip_whatever_the_pieces() {
        let whole = Digest::of(b"123456789");
        assert_eq!((whole.bytes, whole.crc32), (9, 0xcbf4_3926));
        for cut in 0..=9 {
            let mut digesting = Digesting::after(Digest::of(&b"123456789"[..cut]));
            digesting.update(&b"123456789"[cut..]);
            assert_eq!(digesting.digest(), whole);
        }
        assert_eq!(Digest::read(&b"123456789abc"[..], 9).unwrap(), whole);
    }
}
