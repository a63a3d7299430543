//! Saving and restoring a film exactly: the sums as little-endian f64.

use super::{COUNT, Film};
use crate::ImageError;
use std::io::{self, Read, Write};

const MAGIC: [u8; 8] = *b"LESKFLM1";
/// Numbers per buffer: 64 KiB.
const BLOCK: usize = 8192;

impl Film {
    /// Bytes that [`save`](Self::save) writes.
    pub fn saved_size(&self) -> u64 {
        self.header().len() as u64 + 8 + 8 * self.data.len() as u64
    }

    /// Writes size, layers and all sums, bit by bit.
    ///
    /// # Errors
    /// What the writer says.
    pub fn save(&self, out: &mut dyn Write) -> io::Result<()> {
        out.write_all(&self.header())?;
        out.write_all(&self.rejected.to_le_bytes())?;
        let mut buffer = Vec::with_capacity(BLOCK * 8);
        for block in self.data.chunks(BLOCK) {
            buffer.clear();
            buffer.extend(block.iter().flat_map(|v| v.to_le_bytes()));
            out.write_all(&buffer)?;
        }
        Ok(())
    }

    /// Replaces all sums by saved ones. The film must have the size and layers of the saved one.
    ///
    /// # Errors
    /// Another size or other layers, bytes that end early, numbers that no film can hold; the film then keeps its size
    /// and holds no samples.
    pub fn restore(&mut self, from: &mut dyn Read) -> Result<(), ImageError> {
        let result = self.restore_sums(from);
        if result.is_err() {
            self.data.fill(0.0);
            self.rejected = 0;
        }
        result
    }

    fn restore_sums(&mut self, from: &mut dyn Read) -> Result<(), ImageError> {
        let early = |_| ImageError::malformed("film", "it ends before its sums do");
        let expected = self.header();
        let mut header = vec![0; expected.len()];
        from.read_exact(&mut header).map_err(early)?;
        if header != expected {
            return Err(ImageError::malformed("film", self.mismatch(&header)));
        }
        let mut rejected = [0; 8];
        from.read_exact(&mut rejected).map_err(early)?;
        self.rejected = u64::from_le_bytes(rejected);
        let mut buffer = vec![0; BLOCK * 8];
        for block in self.data.chunks_mut(BLOCK) {
            let bytes = &mut buffer[..block.len() * 8];
            from.read_exact(bytes).map_err(early)?;
            for (value, bytes) in block.iter_mut().zip(bytes.as_chunks::<8>().0) {
                *value = f64::from_le_bytes(*bytes);
            }
        }
        self.check_sums()
    }

    fn check_sums(&self) -> Result<(), ImageError> {
        let stride = self.layout.stride();
        for (i, record) in self.data.chunks_exact(stride).enumerate() {
            let n = record[COUNT];
            if !record.iter().all(|v| v.is_finite()) || n < 0.0 || n.fract() != 0.0 {
                let (x, y) = (i % self.spec.width as usize, i / self.spec.width as usize);
                return Err(ImageError::malformed("film", format!("pixel ({x}, {y}) holds numbers that are no sums")));
            }
        }
        Ok(())
    }

    /// Magic, size and layers.
    fn header(&self) -> Vec<u8> {
        let mut bytes = MAGIC.to_vec();
        bytes.extend(self.spec.width.to_le_bytes());
        bytes.extend(self.spec.height.to_le_bytes());
        bytes.extend([u8::from(self.spec.aovs), self.spec.splits.len() as u8]);
        for name in &self.spec.splits {
            bytes.push(name.len() as u8);
            bytes.extend(name.as_bytes());
        }
        bytes
    }

    fn mismatch(&self, header: &[u8]) -> String {
        if header[..8] != MAGIC {
            return "its first bytes are not `LESKFLM1`".to_string();
        }
        let number = |at: usize| u32::from_le_bytes([header[at], header[at + 1], header[at + 2], header[at + 3]]);
        let (width, height) = (number(8), number(12));
        if (width, height) != (self.spec.width, self.spec.height) {
            return format!("it is {width} x {height}, but {} x {} is needed", self.spec.width, self.spec.height);
        }
        "its layers are not those of this film".to_string()
    }
}
