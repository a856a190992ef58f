//! Arrays of numbers in one block of bytes, compressed by deflate and written in base64.

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use flate2::Compression;
use flate2::write::DeflateEncoder;
use serde::Serialize;
use std::io::Write;

/// Arrays begin at multiples of this many bytes, as views of a buffer must.
const ALIGNMENT: usize = 8;

/// Some arrays.
#[derive(Debug, Default)]
pub struct Pack {
    bytes: Vec<u8>,
}

/// Where an array stands.
#[derive(Debug, Clone, Copy, Serialize)]
pub struct Packed {
    /// Type of its elements.
    pub kind: &'static str,
    /// Its first byte.
    pub at: usize,
    /// Number of its elements.
    pub count: usize,
}

/// A number of an array.
pub trait Element: Copy {
    /// The name of its type.
    const KIND: &'static str;
    /// Appends its bytes, little-endian.
    fn write(self, bytes: &mut Vec<u8>);
}

macro_rules! element {
    ($($t:ident)*) => {$(
        impl Element for $t {
            const KIND: &'static str = stringify!($t);
            fn write(self, bytes: &mut Vec<u8>) {
                bytes.extend(self.to_le_bytes());
            }
        }
    )*};
}
element!(f64 f32 u32 u16);

impl Pack {
    /// Adds an array.
    pub fn add<T: Element>(&mut self, numbers: impl IntoIterator<Item = T>) -> Packed {
        self.bytes
            .resize(self.bytes.len().next_multiple_of(ALIGNMENT), 0);
        let (at, mut count) = (self.bytes.len(), 0);
        for number in numbers {
            number.write(&mut self.bytes);
            count += 1;
        }
        Packed {
            kind: T::KIND,
            at,
            count,
        }
    }

    /// All arrays as text.
    pub fn encode(&self) -> String {
        let mut encoder = DeflateEncoder::new(Vec::new(), Compression::best());
        let compressed = encoder
            .write_all(&self.bytes)
            .and_then(|()| encoder.finish());
        STANDARD.encode(compressed.expect("memory can be written"))
    }
}
