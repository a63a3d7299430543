//! NumPy arrays as the rows of a batch: any strides, either float type, broadcast, read where they lie.

use crate::value_error;
use lesk_math::rng::Stream;
use numpy::ndarray::{ArrayViewD, Axis, Ix2, Slice};
use numpy::{Element, PyReadonlyArrayDyn};
use pyo3::prelude::*;
use rayon::prelude::*;

/// Rows that are gathered at a time: what a thread copies stays in its caches.
const GATHERED: usize = 4096;

/// An array that Python passes.
#[derive(FromPyObject)]
pub enum Source<'py> {
    Single(PyReadonlyArrayDyn<'py, f32>),
    Double(PyReadonlyArrayDyn<'py, f64>),
}

/// A float type of NumPy.
pub trait Number: Element + Copy + Default + Send + Sync {
    fn from_f32(x: f32) -> Self;
    fn from_f64(x: f64) -> Self;
    fn is_zero(self) -> bool;
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
    fn is_zero(self) -> bool {
        self == 0.0
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
    fn is_zero(self) -> bool {
        self == 0.0
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
        Ok(Input { view, width, uniform: len > 0 && still })
    }

    /// Rows `start..start + rows` (or the only one), in place where they lie as `T` one after the other.
    fn rows<'s, T: Number>(&'s self, start: usize, rows: usize, scratch: &'s mut Vec<T>) -> &'s [T] {
        let (start, rows) = if self.uniform { (0, 1) } else { (start, rows) };
        if let Some(all) = self.direct() {
            return &all[start * self.width..(start + rows) * self.width];
        }
        scratch.clear();
        match &self.view {
            View::Single(v) => gather(v, start, rows, scratch, T::from_f32),
            View::Double(v) => gather(v, start, rows, scratch, T::from_f64),
        }
        scratch
    }

    fn direct<T: Number>(&self) -> Option<&[T]> {
        T::own(&self.view)?.as_slice()
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

/// Rows `start..start + n` of all inputs, each with one row (used for all) or `n` rows.
pub struct Rows<'a, T> {
    pub start: usize,
    pub n: usize,
    inputs: Vec<&'a [T]>,
    widths: &'a [usize],
}

impl<'a, T: Copy> Rows<'a, T> {
    pub fn len(&self) -> usize {
        self.inputs.len()
    }

    /// All rows of an input, and whether it has only one.
    pub fn input(&self, input: usize) -> (&'a [T], bool) {
        let values = self.inputs[input];
        (values, values.len() == self.widths[input])
    }

    /// Row `i` of an input.
    pub fn row(&self, input: usize, i: usize) -> &'a [T] {
        let (values, width) = (self.inputs[input], self.widths[input]);
        if values.len() == width { values } else { &values[i * width..(i + 1) * width] }
    }
}

/// An equal share of `n` rows for each thread, but at least `grain`.
pub fn share(n: usize, grain: usize) -> usize {
    n.div_ceil(rayon::current_num_threads()).max(grain)
}

/// Cuts a batch into parts of at most `size` rows, with one of the `chunks(rows per part)` of the output for each, runs
/// them on all threads and sums what they return.
pub fn in_parts<T: Number, C: Send>(
    inputs: &[Input],
    n: usize,
    size: usize,
    chunks: impl FnOnce(usize) -> Vec<C>,
    run: impl Fn(&Rows<T>, C) -> usize + Sync,
) -> usize {
    let direct = inputs.iter().all(|input| input.uniform || input.direct::<T>().is_some());
    let size = if direct { size } else { size.min(GATHERED) };
    let widths: Vec<usize> = inputs.iter().map(|input| input.width).collect();
    chunks(size)
        .into_par_iter()
        .enumerate()
        .map_init(
            || vec![Vec::new(); inputs.len()],
            |scratch, (k, chunk)| {
                let start = k * size;
                let rows = size.min(n - start);
                let inputs = inputs.iter().zip(scratch).map(|(input, s)| input.rows(start, rows, s)).collect();
                run(&Rows { start, n: rows, inputs, widths: &widths }, chunk)
            },
        )
        .sum()
}
