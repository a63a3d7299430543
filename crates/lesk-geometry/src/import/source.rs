//! A buffered stream of known length, read by lines, words and binary numbers.

use super::{Error, Result};
use std::io::Read;

/// The longest header line or number that is accepted, bytes.
const LONGEST: usize = 4096;

/// Byte order.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Endian {
    Little,
    Big,
}

/// A numeric type of a file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Scalar {
    I8,
    U8,
    I16,
    U16,
    I32,
    U32,
    F32,
    F64,
}

impl Scalar {
    pub fn parse(name: &str) -> Option<Self> {
        Some(match name {
            "char" | "int8" => Scalar::I8,
            "uchar" | "uint8" => Scalar::U8,
            "short" | "int16" => Scalar::I16,
            "ushort" | "uint16" => Scalar::U16,
            "int" | "int32" => Scalar::I32,
            "uint" | "uint32" => Scalar::U32,
            "float" | "float32" => Scalar::F32,
            "double" | "float64" => Scalar::F64,
            _ => return None,
        })
    }

    /// Bytes.
    pub fn size(self) -> usize {
        match self {
            Scalar::I8 | Scalar::U8 => 1,
            Scalar::I16 | Scalar::U16 => 2,
            Scalar::I32 | Scalar::U32 | Scalar::F32 => 4,
            Scalar::F64 => 8,
        }
    }

    pub fn is_integer(self) -> bool {
        !matches!(self, Scalar::F32 | Scalar::F64)
    }

    /// The number in the first bytes of `b`, little-endian; `b` holds at least eight.
    #[inline]
    fn decode(self, b: [u8; 8]) -> f64 {
        let low = [b[0], b[1], b[2], b[3]];
        match self {
            Scalar::I8 => b[0] as i8 as f64,
            Scalar::U8 => b[0] as f64,
            Scalar::I16 => i16::from_le_bytes([b[0], b[1]]) as f64,
            Scalar::U16 => u16::from_le_bytes([b[0], b[1]]) as f64,
            Scalar::I32 => i32::from_le_bytes(low) as f64,
            Scalar::U32 => u32::from_le_bytes(low) as f64,
            Scalar::F32 => f32::from_le_bytes(low) as f64,
            Scalar::F64 => f64::from_le_bytes(b),
        }
    }
}

/// A stream whose length is known, so that nothing larger is ever allocated.
pub(super) struct Source<R> {
    reader: R,
    buffer: Box<[u8]>,
    start: usize,
    end: usize,
    /// Bytes not yet in the buffer, at most.
    unread: u64,
}

impl<R: Read> Source<R> {
    pub fn new(reader: R, length: u64) -> Self {
        Source { reader, buffer: vec![0; 1 << 16].into(), start: 0, end: 0, unread: length }
    }

    /// Bytes left, at most.
    pub fn remaining(&self) -> u64 {
        self.unread + (self.end - self.start) as u64
    }

    /// Makes `n` bytes available, up to [`LONGEST`]; says whether there are that many.
    #[inline]
    fn fill(&mut self, n: usize) -> Result<bool> {
        if self.end - self.start >= n {
            return Ok(true);
        }
        self.refill(n)
    }

    #[cold]
    fn refill(&mut self, n: usize) -> Result<bool> {
        self.buffer.copy_within(self.start..self.end, 0);
        (self.start, self.end) = (0, self.end - self.start);
        while self.end < n && self.unread > 0 {
            let room = self.buffer[self.end..].len().min(self.unread.min(1 << 20) as usize);
            let space = &mut self.buffer[self.end..self.end + room];
            match self.reader.read(space) {
                Ok(0) => self.unread = 0,
                Ok(got) => {
                    self.end += got;
                    self.unread -= got as u64;
                }
                Err(e) if e.kind() == std::io::ErrorKind::Interrupted => {}
                Err(e) => return Err(Error::unreadable(&e)),
            }
        }
        Ok(self.end >= n)
    }

    fn cut_off() -> Error {
        Error::new("file ends too early").hint("it may have been cut off while it was copied")
    }

    /// The next line of text, without its end.
    pub fn line(&mut self) -> Result<String> {
        let mut line = Vec::new();
        while self.fill(1)? {
            let byte = self.buffer[self.start];
            self.start += 1;
            if byte == b'\n' {
                return Ok(String::from_utf8_lossy(&line).into_owned());
            }
            line.push(byte);
            if line.len() > LONGEST {
                return Err(Error::new(format!("line is longer than {LONGEST} bytes")));
            }
        }
        Err(Self::cut_off())
    }

    /// The next word as a number.
    pub fn word_as_number(&mut self) -> Result<f64> {
        while self.fill(1)? && self.buffer[self.start].is_ascii_whitespace() {
            self.start += 1;
        }
        self.fill(LONGEST)?;
        let bytes = &self.buffer[self.start..self.end];
        let length = bytes.iter().position(u8::is_ascii_whitespace).unwrap_or(bytes.len());
        if length == 0 {
            return Err(Self::cut_off());
        }
        let word = std::str::from_utf8(&bytes[..length.min(64)]).unwrap_or("");
        let number = word.parse::<f64>();
        let number = number.map_err(|_| Error::new(format!("`{}` is no number", word.escape_debug())))?;
        self.start += length;
        Ok(number)
    }

    /// The next binary number.
    #[inline]
    pub fn scalar(&mut self, scalar: Scalar, endian: Endian) -> Result<f64> {
        let n = scalar.size();
        if !self.fill(n)? {
            return Err(Self::cut_off());
        }
        let mut bytes = [0; 8];
        bytes[..n].copy_from_slice(&self.buffer[self.start..self.start + n]);
        if endian == Endian::Big {
            bytes[..n].reverse();
        }
        self.start += n;
        Ok(scalar.decode(bytes))
    }
}
