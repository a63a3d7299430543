//! NumPy arrays as the rows of a batch: any strides, either float type, broadcast, read where they lie.

use crate::value_error;
use lesk_bsdf::batch::Target;
use lesk_math::rng::Stream;
use numpy::ndarray::{ArrayViewD, Axis, Ix2, Slice};
use numpy::{Element, PyArrayDyn, PyArrayMethods, PyReadonlyArrayDyn};
use pyo3::prelude::*;
use rayon::prelude::*;

/// Rows that are gathered at a time: what a thread copies stays in its caches.
const GATHERED: usize = 4096;

/// An array that Python passes.
pub enum Source<'py> {
    Single(PyReadonlyArrayDyn<'py, f32>),
    Double(PyReadonlyArrayDyn<'py, f64>),
}

// not derived: that makes an exception of Python for each type that does not fit, which takes 10 us
impl<'py> FromPyObject<'_, 'py> for Source<'py> {
    type Error = PyErr;

    fn extract(object: Borrowed<'_, 'py, PyAny>) -> PyResult<Source<'py>> {
        if let Ok(array) = object.cast::<PyArrayDyn<f32>>() {
            Ok(Source::Single(array.try_readonly()?))
        } else {
            Ok(Source::Double(object.extract()?))
        }
    }
}

/// Finds NumPy's interface, which takes 0.15 ms at the first array otherwise.
#[pyfunction]
pub fn find_numpy(py: Python<'_>) -> PyResult<()> {
    PyArrayDyn::<f32>::zeros(py, Vec::new(), false).try_readwrite()?;
    Ok(())
}

/// A float type of NumPy.
pub trait Number: Element + Copy + Default + Send + Sync {
    fn from_f32(x: f32) -> Self;
    fn from_f64(x: f64) -> Self;
    /// The next number in [0, 1).
    fn random(stream: &mut Stream) -> Self;
    /// The array itself, if it holds this type.
    fn own<'v>(view: &'v View<'_>) -> Option<&'v ArrayViewD<'v, Self>>;
}

impl Number for f32 {
    fn from_f32(x: f32) -> f32 {
        x
    }
    fn from_f64(x: f64) -> f32 {
        x as f32
    }
    fn random(stream: &mut Stream) -> f32 {
        stream.next_f32()
    }
    fn own<'v>(view: &'v View<'_>) -> Option<&'v ArrayViewD<'v, f32>> {
        if let View::Single(v) = view { Some(v) } else { None }
    }
}

impl Number for f64 {
    fn from_f32(x: f32) -> f64 {
        x.into()
    }
    fn from_f64(x: f64) -> f64 {
        x
    }
    fn random(stream: &mut Stream) -> f64 {
        stream.next_f64()
    }
    fn own<'v>(view: &'v View<'_>) -> Option<&'v ArrayViewD<'v, f64>> {
        if let View::Double(v) = view { Some(v) } else { None }
    }
}

/// The memory of a [`Source`], without Python.
pub enum View<'a> {
    Single(ArrayViewD<'a, f32>),
    Double(ArrayViewD<'a, f64>),
}

/// One input of a batch of `n`: its last axis is a row of `width` numbers, of which there are `n`, or one for all.
pub struct Input<'a> {
    view: View<'a>,
    width: usize,
    uniform: bool,
    planes: bool,
}

impl<'a> Input<'a> {
    pub fn new(source: &'a Source<'_>, width: usize, n: usize) -> PyResult<Input<'a>> {
        let view = match source {
            Source::Single(a) => View::Single(a.as_array()),
            Source::Double(a) => View::Double(a.as_array()),
        };
        let (shape, strides) = match &view {
            View::Single(v) => (v.shape(), v.strides()),
            View::Double(v) => (v.shape(), v.strides()),
        };
        let len: usize = shape.iter().product();
        if shape.last() != Some(&width) || (len != width && len != n * width) {
            return Err(value_error(format!("an input of shape {shape:?} has not 1 or {n} rows of {width}")));
        }
        // one row, or one that NumPy repeats
        let still = shape.iter().zip(strides).rev().skip(1).all(|(&length, &stride)| length == 1 || stride == 0);
        Ok(Input { view, width, uniform: len > 0 && still, planes: false })
    }

    /// Whoever reads the parts takes [`Part::Planes`] too.
    pub fn allow_planes(self) -> Input<'a> {
        Input { planes: true, ..self }
    }

    /// Rows `start..start + rows` (or the only one), in place where they lie as `T` one after the other.
    fn part<'s, T: Number>(&'s self, start: usize, rows: usize, scratch: &'s mut Vec<T>) -> Part<'s, T> {
        let (start, rows) = if self.uniform { (0, 1) } else { (start, rows) };
        if let Some(all) = self.rows() {
            return Part::Rows(&all[start * self.width..(start + rows) * self.width]);
        }
        if let Some(planes) = self.planes() {
            return Part::Planes(planes.map(|plane| &plane[start..start + rows]));
        }
        scratch.clear();
        match &self.view {
            View::Single(v) => gather(v, start, rows, scratch, T::from_f32),
            View::Double(v) => gather(v, start, rows, scratch, T::from_f64),
        }
        Part::Rows(scratch)
    }

    /// The whole input, where it lies as `T` one row after the other.
    fn rows<T: Number>(&self) -> Option<&[T]> {
        T::own(&self.view)?.as_slice()
    }

    /// The whole input, where each of its three components lies as `T` in an array of its own.
    fn planes<T: Number>(&self) -> Option<[&[T]; 3]> {
        if !self.planes || self.uniform || self.width != 3 {
            return None;
        }
        let view = T::own(&self.view)?;
        let last = Axis(view.ndim() - 1);
        let plane = |c: usize| view.view().index_axis_move(last, c).to_slice();
        Some([plane(0)?, plane(1)?, plane(2)?])
    }

    fn is_in_place<T: Number>(&self) -> bool {
        self.uniform || self.rows::<T>().is_some() || self.planes::<T>().is_some()
    }
}

/// Appends rows of a view, counted over all its axes but the last.
fn gather<S: Copy, T>(view: &ArrayViewD<S>, start: usize, rows: usize, out: &mut Vec<T>, convert: impl Fn(S) -> T) {
    let leading = &view.shape()[..view.ndim() - 1];
    let Some((&run, outer)) = leading.split_last() else {
        return out.extend(view.iter().map(|&x| convert(x)));
    };
    let end = start + rows;
    let mut at = start;
    while at < end {
        let mut plane = view.view();
        let mut rest = at / run;
        // the outer axes from the last on: each takes its digit of the row's number
        for axis in (0..outer.len()).rev() {
            plane = plane.index_axis_move(Axis(axis), rest % outer[axis]);
            rest /= outer[axis];
        }
        let from = at % run;
        let to = run.min(from + end - at);
        // the fixed number of axes makes the loop fast
        let plane = plane.into_dimensionality::<Ix2>().expect("the outer axes are gone");
        for row in plane.slice_axis(Axis(0), Slice::from(from..to)).rows() {
            out.extend(row.iter().map(|&x| convert(x)));
        }
        at += to - from;
    }
}

/// Some rows of an input.
#[derive(Clone, Copy)]
pub enum Part<'a, T> {
    /// One after the other.
    Rows(&'a [T]),
    /// Each of the three components in an array of its own.
    Planes([&'a [T]; 3]),
}

/// Rows `start..start + n` of all inputs, each with one row (used for all) or `n` rows.
pub struct Rows<'a, T> {
    pub start: usize,
    pub n: usize,
    inputs: Vec<Part<'a, T>>,
    widths: &'a [usize],
}

impl<'a, T: Copy> Rows<'a, T> {
    pub fn len(&self) -> usize {
        self.inputs.len()
    }

    /// All rows of an input, and whether it has only one.
    pub fn input(&self, input: usize) -> (Part<'a, T>, bool) {
        let part = self.inputs[input];
        (part, matches!(part, Part::Rows(values) if values.len() == self.widths[input]))
    }

    /// Row `i` of an input.
    ///
    /// # Panics
    /// If the input was allowed to come as planes, and does.
    pub fn row(&self, input: usize, i: usize) -> &'a [T] {
        let width = self.widths[input];
        match self.inputs[input] {
            Part::Rows(values) if values.len() == width => values,
            Part::Rows(values) => &values[i * width..(i + 1) * width],
            Part::Planes(_) => panic!("rows are read from an input that may come as planes"),
        }
    }
}

/// How many of `n` rows a part should have: an equal share for each thread, but at least `grain`.
pub fn share(n: usize, grain: usize) -> usize {
    // asking for the threads starts them, which costs more than a small batch
    if n <= grain { grain } else { n.div_ceil(rayon::current_num_threads()).max(grain).next_multiple_of(ALIGNED_ROWS) }
}

/// Whatever a row holds, this many end on a border of a cache line if the first starts on one.
const ALIGNED_ROWS: usize = 64;

/// Cuts a batch into parts of at most `size` rows, with one of the `chunks(rows per part)` of the output for each, runs
/// them on all threads and sums what they return.
pub fn in_parts<T: Number, C: Send>(
    inputs: &[Input],
    n: usize,
    size: usize,
    chunks: impl FnOnce(usize) -> Vec<C>,
    run: impl Fn(&Rows<T>, C) -> usize + Sync,
) -> usize {
    let in_place = inputs.iter().all(Input::is_in_place::<T>);
    let size = if in_place { size } else { size.min(GATHERED) };
    let widths: Vec<usize> = inputs.iter().map(|input| input.width).collect();
    let scratch = || vec![Vec::new(); inputs.len()];
    let part = |scratch: &mut Vec<Vec<T>>, k: usize, chunk: C| {
        let start = k * size;
        let rows = size.min(n - start);
        let inputs = inputs.iter().zip(scratch).map(|(input, s)| input.part(start, rows, s)).collect();
        run(&Rows { start, n: rows, inputs, widths: &widths }, chunk)
    };
    let mut chunks = chunks(size);
    // handing over to another thread and waiting for it costs more than a small batch
    if chunks.len() <= 1 || rayon::current_num_threads() == 1 {
        let mut scratch = scratch();
        return chunks.drain(..).enumerate().map(|(k, chunk)| part(&mut scratch, k, chunk)).sum();
    }
    chunks.into_par_iter().enumerate().map_init(scratch, |scratch, (k, chunk)| part(scratch, k, chunk)).sum()
}

/// Cuts targets into parts of `size` rows.
pub fn cut<T>(mut targets: Vec<Target<T>>, size: usize) -> Vec<Vec<Target<T>>> {
    let mut parts = Vec::new();
    while targets.iter().any(|target| target.rows() > 0) {
        let halves = targets.into_iter().map(|target| {
            let rows = size.min(target.rows());
            target.split_at(rows)
        });
        let (part, rest) = halves.unzip();
        parts.push(part);
        targets = rest;
    }
    parts
}

/// Writes the outputs of row `i`.
pub fn put<T: Number>(targets: &mut [Target<T>], i: usize, mut values: &[f64]) {
    for target in targets {
        let (these, rest) = values.split_at(target.width());
        values = rest;
        match target {
            Target::Row(row) => row[i] = T::from_f64(these[0]),
            Target::Interleaved(rows, width) => {
                for (to, from) in rows[i * *width..].iter_mut().zip(these) {
                    *to = T::from_f64(*from);
                }
            }
            Target::Flags(flags) => flags[i] = these[0] != 0.0,
        }
    }
}
