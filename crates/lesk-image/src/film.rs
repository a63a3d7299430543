//! Film: what a render adds up, per pixel.
//!
//! A sample belongs to one pixel (filters are sampled, see [`filter`](crate::filter)) and a pixel belongs to one tile, so
//! the sums of a pixel depend on the order of its own samples only: the same samples give the same bits for any number of
//! threads, and a film that is saved and restored goes on as if nothing had happened.

mod output;
mod state;

use crate::ImageError;
use crate::image::{check_size, zeros};

/// Names that a split layer cannot have, because the film writes layers of these names.
const RESERVED: [&str; 6] = ["variance", "albedo", "normal", "depth", "id", "samples"];
/// Split layers of one film.
const MAX_SPLITS: usize = 64;

/// Size and layers of a film.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct FilmSpec {
    /// Width in pixels.
    pub width: u32,
    /// Height in pixels.
    pub height: u32,
    /// Names of light-path layers, like `direct` or `caustic`.
    pub splits: Vec<String>,
    /// Keep albedo, normal, depth and ids.
    pub aovs: bool,
}

impl FilmSpec {
    /// A film of RGB mean and variance only.
    pub fn new(width: u32, height: u32) -> FilmSpec {
        FilmSpec { width, height, splits: Vec::new(), aovs: false }
    }

    fn check(&self) -> Result<usize, ImageError> {
        let pixels = check_size("film", self.width.into(), self.height.into())?;
        if self.splits.len() > MAX_SPLITS {
            let what = format!("{} split layers, but at most {MAX_SPLITS} are accepted", self.splits.len());
            return Err(ImageError::invalid(what));
        }
        for (i, name) in self.splits.iter().enumerate() {
            let plain = (1..=24).contains(&name.len()) && name.bytes().all(|b| b.is_ascii_alphanumeric() || b == b'_');
            if !plain || RESERVED.contains(&name.as_str()) || self.splits[..i].contains(name) {
                let what = format!("split layer `{name}` is taken or not made of 1 to 24 letters, digits and `_`");
                return Err(ImageError::invalid(what));
            }
        }
        Ok(pixels)
    }
}

/// First-hit values of one sample.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Aov {
    /// Reflectance, 0 to 1.
    pub albedo: [f32; 3],
    /// Shading normal in world space, unit length.
    pub normal: [f32; 3],
    /// Distance from the camera along the ray, m.
    pub depth: f32,
    /// Number of the object, from 1.
    pub object: u32,
    /// Number of the material, from 1.
    pub material: u32,
}

/// What one camera path adds to its pixel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sample<'a> {
    /// Linear Rec.709 RGB whose Y is cd/m².
    pub radiance: [f32; 3],
    /// One colour per split layer, in the order of [`FilmSpec::splits`]; empty adds nothing to them.
    pub splits: &'a [[f32; 3]],
    /// The first hit; `None` where the path left the scene.
    pub aov: Option<Aov>,
}

impl Sample<'_> {
    /// A sample of light only.
    pub fn of(radiance: [f32; 3]) -> Sample<'static> {
        Sample { radiance, splits: &[], aov: None }
    }
}

/// A rectangle of pixels, inside a film.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Tile {
    /// Left column.
    pub x: u32,
    /// Top row.
    pub y: u32,
    /// Columns.
    pub width: u32,
    /// Rows.
    pub height: u32,
}

impl Tile {
    /// All pixels in film coordinates, row by row.
    pub fn pixels(self) -> impl Iterator<Item = (u32, u32)> {
        (self.y..self.y + self.height).flat_map(move |y| (self.x..self.x + self.width).map(move |x| (x, y)))
    }
}

/// Where the sums of one pixel lie within its record of f64.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Layout {
    aovs: bool,
    splits: usize,
}

const COUNT: usize = 0;
const SUM: usize = 1;
const SQUARES: usize = 4;
const AOVS: usize = 7;
const ALBEDO: usize = AOVS;
const NORMAL: usize = AOVS + 3;
const DEPTH: usize = AOVS + 6;
const HITS: usize = AOVS + 7;
const OBJECT: usize = AOVS + 8;
const MATERIAL: usize = AOVS + 9;
const AOV_NUMBERS: usize = 10;

impl Layout {
    fn of(spec: &FilmSpec) -> Layout {
        Layout { aovs: spec.aovs, splits: spec.splits.len() }
    }
    fn split(self, i: usize) -> usize {
        AOVS + if self.aovs { AOV_NUMBERS } else { 0 } + 3 * i
    }
    fn stride(self) -> usize {
        self.split(self.splits)
    }
}

/// Sums of all samples so far.
#[derive(Clone, Debug, PartialEq)]
pub struct Film {
    spec: FilmSpec,
    layout: Layout,
    data: Vec<f64>,
    rejected: u64,
}

impl Film {
    /// A film without samples.
    ///
    /// # Errors
    /// A size outside the limits, names of split layers that are taken or not plain, memory that is not there.
    pub fn new(spec: FilmSpec) -> Result<Film, ImageError> {
        let pixels = spec.check()?;
        let layout = Layout::of(&spec);
        let data = zeros("film", pixels * layout.stride())?;
        Ok(Film { spec, layout, data, rejected: 0 })
    }

    /// Size and layers.
    pub fn spec(&self) -> &FilmSpec {
        &self.spec
    }

    /// Width in pixels.
    pub fn width(&self) -> u32 {
        self.spec.width
    }

    /// Height in pixels.
    pub fn height(&self) -> u32 {
        self.spec.height
    }

    /// Samples whose light was NaN or infinite; they count as black.
    pub fn rejected(&self) -> u64 {
        self.rejected
    }

    /// Tiles of at most `side` pixels that cover the film once, row by row.
    ///
    /// # Panics
    /// If `side` is 0.
    pub fn tiles(&self, side: u32) -> Vec<Tile> {
        assert!(side > 0, "a tile has at least one pixel");
        let (w, h) = (self.spec.width, self.spec.height);
        let column = |y: u32| {
            (0..w).step_by(side as usize).map(move |x| Tile { x, y, width: side.min(w - x), height: side.min(h - y) })
        };
        (0..h).step_by(side as usize).flat_map(column).collect()
    }

    /// A copy of the sums of a tile, to add samples to.
    ///
    /// # Panics
    /// If the tile is not inside the film.
    pub fn take(&self, tile: Tile) -> FilmTile {
        self.assert_inside(tile);
        let row_numbers = tile.width as usize * self.layout.stride();
        let mut data = Vec::with_capacity(row_numbers * tile.height as usize);
        for y in tile.y..tile.y + tile.height {
            let at = self.at(tile.x, y);
            data.extend_from_slice(&self.data[at..at + row_numbers]);
        }
        FilmTile { tile, layout: self.layout, data, rejected: 0 }
    }

    /// Puts the sums of a tile back in place of those that [`take`](Self::take) copied.
    ///
    /// # Panics
    /// If the tile comes from a film of another size or other layers.
    pub fn put(&mut self, tile: FilmTile) {
        self.assert_inside(tile.tile);
        assert!(tile.layout == self.layout, "a tile of another film");
        let row_numbers = tile.tile.width as usize * self.layout.stride();
        for (row, source) in tile.data.chunks_exact(row_numbers).enumerate() {
            let at = self.at(tile.tile.x, tile.tile.y + row as u32);
            self.data[at..at + row_numbers].copy_from_slice(source);
        }
        self.rejected += tile.rejected;
    }

    /// Adds one sample to one pixel. Renderers with threads use [`take`](Self::take) and [`put`](Self::put).
    ///
    /// # Panics
    /// Outside the film, or with another number of splits than the film has.
    pub fn add(&mut self, x: u32, y: u32, sample: &Sample) {
        let at = self.at(x, y);
        let stride = self.layout.stride();
        self.rejected += u64::from(!add(&mut self.data[at..at + stride], self.layout, sample));
    }

    fn at(&self, x: u32, y: u32) -> usize {
        assert!(x < self.spec.width && y < self.spec.height, "pixel ({x}, {y}) is outside the film");
        (y as usize * self.spec.width as usize + x as usize) * self.layout.stride()
    }

    fn assert_inside(&self, tile: Tile) {
        let inside = |start: u32, length: u32, end: u32| start.checked_add(length).is_some_and(|e| e <= end);
        let fits = inside(tile.x, tile.width, self.spec.width) && inside(tile.y, tile.height, self.spec.height);
        assert!(fits && tile.width > 0, "{tile:?} is not inside the film");
    }
}

/// The sums of the pixels of one tile, owned by one thread.
#[derive(Clone, Debug, PartialEq)]
pub struct FilmTile {
    tile: Tile,
    layout: Layout,
    data: Vec<f64>,
    rejected: u64,
}

impl FilmTile {
    /// The rectangle.
    pub fn tile(&self) -> Tile {
        self.tile
    }

    /// Samples that the pixel holds, in film coordinates.
    ///
    /// # Panics
    /// Outside the tile.
    pub fn sample_count(&self, x: u32, y: u32) -> u64 {
        self.data[self.at(x, y) + COUNT] as u64
    }

    /// Adds one sample to one pixel, in film coordinates. Light that is NaN or infinite counts as black and as rejected.
    ///
    /// # Panics
    /// Outside the tile, or with another number of splits than the film has.
    #[inline]
    pub fn add(&mut self, x: u32, y: u32, sample: &Sample) {
        let at = self.at(x, y);
        let stride = self.layout.stride();
        self.rejected += u64::from(!add(&mut self.data[at..at + stride], self.layout, sample));
    }

    #[inline]
    fn at(&self, x: u32, y: u32) -> usize {
        let (column, row) = (x.wrapping_sub(self.tile.x), y.wrapping_sub(self.tile.y));
        assert!(column < self.tile.width && row < self.tile.height, "pixel ({x}, {y}) is outside {:?}", self.tile);
        (row as usize * self.tile.width as usize + column as usize) * self.layout.stride()
    }
}

/// Adds a sample to the record of its pixel; false if its light was not finite.
#[inline]
fn add(record: &mut [f64], layout: Layout, sample: &Sample) -> bool {
    assert!(sample.splits.is_empty() || sample.splits.len() == layout.splits, "another number of split layers");
    let first = record[COUNT] == 0.0;
    record[COUNT] += 1.0;
    let finite = sample.radiance.iter().chain(sample.splits.as_flattened()).all(|v| v.is_finite());
    if finite {
        for c in 0..3 {
            let v = f64::from(sample.radiance[c]);
            record[SUM + c] += v;
            record[SQUARES + c] += v * v;
        }
        for (i, split) in sample.splits.iter().enumerate() {
            accumulate(&mut record[layout.split(i)..], *split);
        }
    }
    if layout.aovs {
        add_aov(record, first, sample.aov);
    }
    finite
}

fn add_aov(record: &mut [f64], first: bool, aov: Option<Aov>) {
    let Some(aov) = aov else { return };
    let numbers = aov.albedo.iter().chain(&aov.normal).chain([&aov.depth]);
    if !numbers.into_iter().all(|v| v.is_finite()) {
        return;
    }
    accumulate(&mut record[ALBEDO..], aov.albedo);
    accumulate(&mut record[NORMAL..], aov.normal);
    record[DEPTH] += f64::from(aov.depth);
    record[HITS] += 1.0;
    if first {
        record[OBJECT] = f64::from(aov.object);
        record[MATERIAL] = f64::from(aov.material);
    }
}

fn accumulate(sums: &mut [f64], color: [f32; 3]) {
    for c in 0..3 {
        sums[c] += f64::from(color[c]);
    }
}

#[cfg(test)]
#[path = "film/tests.rs"]
mod tests;
