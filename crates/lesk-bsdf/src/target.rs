//! Where the outputs of a batch go.

/// Where the next outputs of `n` directions go.
#[derive(Debug)]
pub enum Target<'a, T = f32> {
    /// One output.
    Row(&'a mut [T]),
    /// Several outputs, as many as the number says, those of a direction one after the other.
    Interleaved(&'a mut [T], usize),
    /// One output, as whether it is not 0.
    Flags(&'a mut [bool]),
}

impl<'a, T> Target<'a, T> {
    /// How many outputs it takes.
    pub fn width(&self) -> usize {
        if let Target::Interleaved(_, width) = self { *width } else { 1 }
    }
    /// The number of directions that it has room for.
    pub fn rows(&self) -> usize {
        match self {
            Target::Row(row) => row.len(),
            Target::Interleaved(rows, width) => rows.len() / width,
            Target::Flags(flags) => flags.len(),
        }
    }
    /// The part for the first `rows` directions, and the rest.
    ///
    /// # Panics
    /// If there are fewer.
    pub fn split_at(self, rows: usize) -> (Target<'a, T>, Target<'a, T>) {
        match self {
            Target::Row(all) => {
                let (first, rest) = all.split_at_mut(rows);
                (Target::Row(first), Target::Row(rest))
            }
            Target::Interleaved(all, width) => {
                let (first, rest) = all.split_at_mut(rows * width);
                (Target::Interleaved(first, width), Target::Interleaved(rest, width))
            }
            Target::Flags(all) => {
                let (first, rest) = all.split_at_mut(rows);
                (Target::Flags(first), Target::Flags(rest))
            }
        }
    }
}
