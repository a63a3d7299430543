//! Image files and tone mapping over NumPy arrays of shape (height, width, channels).

use crate::errors;
use lesk_image::falsecolor::{self, Scale};
use lesk_image::io::png::{self, Depth};
use lesk_image::io::{self, exr};
use lesk_image::{Image, ImageError, Plane, Planes, Samples, ToneMapper, Transfer, tonemap};
use numpy::{
    IntoPyArray, PyArray3, PyArrayMethods, PyReadonlyArray2, PyReadonlyArray3, PyUntypedArray, PyUntypedArrayMethods,
};
use pyo3::prelude::*;
use std::path::PathBuf;

pub fn array<'py>(py: Python<'py>, image: Image) -> PyResult<Bound<'py, PyArray3<f32>>> {
    let shape = [image.height() as usize, image.width() as usize, image.channels()];
    image.into_data().into_pyarray(py).reshape(shape)
}

fn image_of(array: &PyReadonlyArray3<'_, f32>, transfer: Transfer) -> Result<Image, ImageError> {
    let [height, width, channels] = [0, 1, 2].map(|axis| array.shape()[axis]);
    let side = |n: usize| u32::try_from(n).unwrap_or(u32::MAX);
    let data = array.as_array().iter().copied().collect();
    Image::new(side(width), side(height), channels, transfer, data)
}

fn transfer(encoded: bool) -> Transfer {
    if encoded { Transfer::Srgb } else { Transfer::Linear }
}

/// The picture of a file, and whether its numbers are sRGB-encoded.
#[pyfunction]
pub fn read_image(py: Python<'_>, path: PathBuf, linear: bool) -> PyResult<(Bound<'_, PyArray3<f32>>, bool)> {
    let read = || io::read(&path).map(|image| if linear { image.to_linear() } else { image });
    let image = py.detach(read).map_err(errors::image)?;
    let encoded = image.transfer() == Transfer::Srgb;
    Ok((array(py, image)?, encoded))
}

/// Channels by name, attributes by name, and the luminance of white in cd/m² where the file states it.
type Layers<'py> = (Vec<(String, Bound<'py, PyAny>)>, Vec<(String, String)>, Option<f32>);

/// All channels of a file with its attributes.
#[pyfunction]
pub fn read_planes(py: Python<'_>, path: PathBuf) -> PyResult<Layers<'_>> {
    let planes = py.detach(|| io::read_planes(&path)).map_err(errors::image)?;
    let channels = planes.planes().iter().map(|plane| Ok((plane.name.clone(), channel(py, &planes, plane)?)));
    Ok((channels.collect::<PyResult<_>>()?, planes.attributes.clone(), planes.white_luminance))
}

/// One channel as an array of shape (height, width).
pub fn channel<'py>(py: Python<'py>, planes: &Planes, plane: &Plane) -> PyResult<Bound<'py, PyAny>> {
    let shape = [planes.height() as usize, planes.width() as usize];
    Ok(match &plane.samples {
        Samples::Float(v) | Samples::Half(v) => v.clone().into_pyarray(py).reshape(shape)?.into_any(),
        Samples::Uint(v) => v.clone().into_pyarray(py).reshape(shape)?.into_any(),
    })
}

/// Writes a picture; the ending of the name decides on the format. `depth` is 8 or 16 bits of a PNG.
#[pyfunction]
pub fn write_image(
    py: Python<'_>,
    path: PathBuf,
    image: PyReadonlyArray3<'_, f32>,
    encoded: bool,
    depth: u8,
) -> PyResult<()> {
    let image = image_of(&image, transfer(encoded)).map_err(errors::image)?;
    let write = || match (io::Format::of_name(&path), depth) {
        (Some(io::Format::Png), 16) => {
            let bytes = png::encode(&image, Depth::Sixteen, &[]).map_err(|error| error.at(&path))?;
            io::write_bytes(&path, &bytes)
        }
        _ => io::write(&path, &image),
    };
    py.detach(write).map_err(errors::image)
}

/// One channel that Python passes.
#[derive(FromPyObject)]
pub enum Channel<'py> {
    Float(PyReadonlyArray2<'py, f32>),
    Uint(PyReadonlyArray2<'py, u32>),
}

/// Writes named channels with attributes as an EXR file.
#[pyfunction]
pub fn write_planes(
    py: Python<'_>,
    path: PathBuf,
    channels: Vec<(String, Channel<'_>)>,
    attributes: Vec<(String, String)>,
) -> PyResult<()> {
    let shape = |array: &Bound<'_, PyUntypedArray>| [array.shape()[1], array.shape()[0]];
    let size = channels.first().map_or([0, 0], |(_, channel)| match channel {
        Channel::Float(a) => shape(a.as_untyped()),
        Channel::Uint(a) => shape(a.as_untyped()),
    });
    let [width, height] = size.map(|n| u32::try_from(n).unwrap_or(u32::MAX));
    let mut planes = Planes::new(width, height).map_err(errors::image)?;
    for (name, channel) in &channels {
        let samples = match channel {
            Channel::Float(a) => Samples::Float(a.as_array().iter().copied().collect()),
            Channel::Uint(a) => Samples::Uint(a.as_array().iter().copied().collect()),
        };
        planes.push(name, samples).map_err(errors::image)?;
    }
    planes.attributes = attributes;
    py.detach(|| exr::write(&path, &planes)).map_err(errors::image)
}

/// The EV100 that a meter reads for a linear picture in cd/m²; none for a black one.
#[pyfunction]
pub fn meter(image: PyReadonlyArray3<'_, f32>) -> PyResult<Option<f64>> {
    Ok(tonemap::meter(&image_of(&image, Transfer::Linear).map_err(errors::image)?))
}

/// The names of the tone mappers.
#[pyfunction]
pub fn tone_mappers() -> Vec<&'static str> {
    ToneMapper::ALL.map(ToneMapper::name).to_vec()
}

/// Exposes, tone maps and encodes a linear picture in cd/m².
#[pyfunction]
pub fn develop<'py>(
    py: Python<'py>,
    image: PyReadonlyArray3<'py, f32>,
    ev100: f64,
    mapper: &str,
) -> PyResult<Bound<'py, PyArray3<f32>>> {
    let mapper: ToneMapper = mapper.parse().map_err(errors::parameter)?;
    let image = image_of(&image, Transfer::Linear).map_err(errors::image)?;
    array(py, py.detach(|| tonemap::develop(&image, ev100, mapper)))
}

/// The luminance of a linear picture in false colours from `low` to `high`, cd/m².
#[pyfunction]
pub fn false_color<'py>(
    py: Python<'py>,
    image: PyReadonlyArray3<'py, f32>,
    low: f64,
    high: f64,
    log: bool,
) -> PyResult<Bound<'py, PyArray3<f32>>> {
    let scale = if log { Scale::log(low, high) } else { Scale::linear(low, high) }.map_err(errors::parameter)?;
    let image = image_of(&image, Transfer::Linear).map_err(errors::image)?;
    array(py, py.detach(|| falsecolor::luminance(&image, scale)))
}
