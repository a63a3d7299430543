//! The samples of a band by face, so that what a face needs is computed once and its vertices are read together.

use crate::scan::Band;

/// A sample of a band: row within the band and column.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Spot(u32);

impl Spot {
    /// Columns stay below 15,000 and rows of a band below 2^16.
    #[inline]
    fn new(row: u32, column: u32) -> Spot {
        Spot(row << 16 | column)
    }

    #[inline(always)]
    pub fn row(self) -> u32 {
        self.0 >> 16
    }

    #[inline(always)]
    fn parity(self) -> usize {
        self.row() as usize & 1
    }

    #[inline(always)]
    pub fn column(self) -> u32 {
        self.0 & 0xffff
    }
}

/// Sorted samples.
#[derive(Default)]
pub(crate) struct Samples {
    /// The samples of the face with number `id` end here, those of even and those of odd rows; they begin where those of
    /// the face before end.
    ends: Vec<[u32; 2]>,
    spots: Vec<Spot>,
}

impl Samples {
    /// Sorts the covered samples of a band by its face numbers 1 to `faces`; those of a face go row by row, first the even
    /// rows of the band.
    pub fn sort(&mut self, band: &Band, faces: usize) {
        self.ends.clear();
        self.ends.resize(faces + 1, [0; 2]);
        each(band, |id, spot| self.ends[id as usize][spot.parity()] += 1);
        let mut sum = 0;
        for end in self.ends.as_flattened_mut() {
            // the first sample, until all are placed
            sum += std::mem::replace(end, sum);
        }
        self.spots.clear();
        self.spots.resize(sum as usize, Spot::default());
        each(band, |id, spot| {
            let at = &mut self.ends[id as usize][spot.parity()];
            self.spots[*at as usize] = spot;
            *at += 1;
        });
    }

    /// How many samples are covered.
    pub fn len(&self) -> usize {
        self.spots.len()
    }

    /// The samples of a face.
    #[inline]
    pub fn of(&self, id: u32) -> &[Spot] {
        &self.spots[self.ends[id as usize - 1][1] as usize..self.ends[id as usize][1] as usize]
    }
}

/// Samples that are looked at together.
const CHUNK: usize = 16;

/// All covered samples with their face numbers. Two rows at a time: neighbours in a row mostly show one face, and its count
/// would have to wait for the last change of itself.
#[inline(always)]
fn each(band: &Band, mut f: impl FnMut(u32, Spot)) {
    for y in band.rows.clone().step_by(2) {
        let row = y - band.rows.start;
        let upper = &band.ids[band.row(y)];
        let lower = if y + 1 < band.rows.end { &band.ids[band.row(y + 1)] } else { &[] };
        for (k, upper) in upper.chunks(CHUNK).enumerate() {
            let lower = lower.get(CHUNK * k..CHUNK * k + upper.len()).unwrap_or(&[0; CHUNK]);
            // most of a picture may be empty
            if upper.iter().chain(lower).fold(0, |any, id| any | id) == 0 {
                continue;
            }
            for (column, (&a, &b)) in upper.iter().zip(lower).enumerate() {
                let column = (CHUNK * k + column) as u32;
                if a != 0 {
                    f(a, Spot::new(row, column));
                }
                if b != 0 {
                    f(b, Spot::new(row + 1, column));
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use lesk_math::Isa;

    #[test]
    fn each_face_has_its_samples_row_by_row() {
        let mut band = Band::new(Isa::current());
        band.start(40, 7..10);
        let shown = [(7, 3, 2), (7, 4, 1), (8, 39, 2), (9, 0, 1), (9, 2, 2), (9, 17, 4)];
        for (y, x, id) in shown {
            let start = band.row(y).start;
            band.ids[start + x] = id;
        }
        let mut samples = Samples::default();
        samples.sort(&band, 4);
        let of = |id| samples.of(id).iter().map(|s| (s.row(), s.column())).collect::<Vec<_>>();
        assert_eq!(of(1), [(0, 4), (2, 0)]);
        assert_eq!(of(2), [(0, 3), (2, 2), (1, 39)]);
        assert_eq!(of(3), []);
        assert_eq!(of(4), [(2, 17)]);
        assert_eq!(samples.len(), 6);
    }
}
