//! Named channels of one size: what an EXR file holds.

use crate::image::{Image, Transfer, check_size, zeros};
use crate::{ImageError, MAX_PIXELS};

/// The numbers of one channel, rows from the top.
#[derive(Clone, Debug, PartialEq)]
pub enum Samples {
    /// 32 bit floating point.
    Float(Vec<f32>),
    /// Kept as f32 here, written as 16 bit floating point: 11 bits of precision, at most 65504.
    Half(Vec<f32>),
    /// 32 bit unsigned integers, for ids.
    Uint(Vec<u32>),
}

impl Samples {
    /// How many numbers.
    pub fn len(&self) -> usize {
        match self {
            Self::Float(v) | Self::Half(v) => v.len(),
            Self::Uint(v) => v.len(),
        }
    }

    /// True without any number.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// One number as f32; an id beyond 2^24 is rounded.
    ///
    /// # Panics
    /// Beyond the end.
    pub fn get(&self, i: usize) -> f32 {
        match self {
            Self::Float(v) | Self::Half(v) => v[i],
            Self::Uint(v) => v[i] as f32,
        }
    }
}

/// One named channel, like `R`, `albedo.G` or `depth.Z`.
#[derive(Clone, Debug, PartialEq)]
pub struct Plane {
    /// The layer, a point and the channel; channels without a layer are the picture.
    pub name: String,
    /// Its numbers, rows from the top.
    pub samples: Samples,
}

/// Channels of one size with text attributes.
#[derive(Clone, Debug, PartialEq)]
pub struct Planes {
    width: u32,
    height: u32,
    planes: Vec<Plane>,
    /// Names and values of text attributes; written in the order of their names.
    pub attributes: Vec<(String, String)>,
    /// Luminance in cd/m² of RGB (1, 1, 1), where known: 1 for a film.
    pub white_luminance: Option<f32>,
}

impl Planes {
    /// No channels yet.
    ///
    /// # Errors
    /// A size of zero or beyond [`MAX_SIDE`](crate::MAX_SIDE) and [`MAX_PIXELS`].
    pub fn new(width: u32, height: u32) -> Result<Planes, ImageError> {
        check_size("image", width.into(), height.into())?;
        Ok(Planes { width, height, planes: Vec::new(), attributes: Vec::new(), white_luminance: None })
    }

    /// Adds a channel.
    ///
    /// # Errors
    /// A name that is empty, longer than 255 bytes or taken; another count of numbers than pixels.
    pub fn push(&mut self, name: &str, samples: Samples) -> Result<(), ImageError> {
        let pixels = self.width as usize * self.height as usize;
        if name.is_empty() || name.len() > 255 || name.contains('\0') || self.plane(name).is_some() {
            return Err(ImageError::invalid(format!("channel name `{name}` is empty, too long or taken")));
        }
        if samples.len() != pixels {
            let what = format!("channel `{name}` has {} numbers, but {pixels} pixels are there", samples.len());
            return Err(ImageError::invalid(what));
        }
        self.planes.push(Plane { name: name.to_string(), samples });
        Ok(())
    }

    /// Adds the channels of an image: `R`, `G`, `B`, `A` or `Y`, `A`, with the layer and a point before them where
    /// `layer` is not empty.
    ///
    /// # Errors
    /// As [`push`](Self::push), and an image of another size.
    pub fn push_image(&mut self, layer: &str, image: &Image) -> Result<(), ImageError> {
        if (image.width(), image.height()) != (self.width, self.height) {
            return Err(ImageError::invalid("an image of another size than its file"));
        }
        let n = image.channels();
        let names: &[&str] = [&["Y"][..], &["Y", "A"], &["R", "G", "B"], &["R", "G", "B", "A"]][n - 1];
        for (c, name) in names.iter().enumerate() {
            let name = if layer.is_empty() { (*name).to_string() } else { format!("{layer}.{name}") };
            let samples = image.data().iter().skip(c).step_by(n).copied().collect();
            self.push(&name, Samples::Float(samples))?;
        }
        Ok(())
    }

    /// Width in pixels.
    pub fn width(&self) -> u32 {
        self.width
    }

    /// Height in pixels.
    pub fn height(&self) -> u32 {
        self.height
    }

    /// All channels in the order in which they were added.
    pub fn planes(&self) -> &[Plane] {
        &self.planes
    }

    /// The channel of a name.
    pub fn plane(&self, name: &str) -> Option<&Plane> {
        self.planes.iter().find(|plane| plane.name == name)
    }

    /// The text of an attribute.
    pub fn attribute(&self, name: &str) -> Option<&str> {
        self.attributes.iter().find(|(n, _)| n == name).map(|(_, text)| text.as_str())
    }

    /// The names of all layers in order; the picture is the empty name.
    pub fn layers(&self) -> Vec<&str> {
        let mut layers = Vec::new();
        for plane in &self.planes {
            let layer = plane.name.rsplit_once('.').map_or("", |(layer, _)| layer);
            if !layers.contains(&layer) {
                layers.push(layer);
            }
        }
        layers
    }

    /// One layer as an image: its R, G, B (X, Y, Z) and A channels, or its Y or only channel.
    ///
    /// # Errors
    /// No such layer, or one whose channels make no picture.
    pub fn image(&self, layer: &str) -> Result<Image, ImageError> {
        let find = |name: &str| match layer {
            "" => self.plane(name),
            _ => self.plane(&format!("{layer}.{name}")),
        };
        let sets: [&[&str]; 6] =
            [&["R", "G", "B", "A"], &["R", "G", "B"], &["X", "Y", "Z"], &["Y", "A"], &["Y"], &["Z"]];
        let of_names = sets.iter().find_map(|names| names.iter().map(|n| find(n)).collect::<Option<Vec<_>>>());
        let alone = || {
            let mut own = self.planes.iter().filter(|p| p.name.rsplit_once('.').map_or("", |(l, _)| l) == layer);
            own.next().filter(|_| own.next().is_none()).map(|plane| vec![plane])
        };
        let planes = of_names.or_else(alone).ok_or_else(|| {
            let names: Vec<&str> = self.planes.iter().map(|p| p.name.as_str()).take(20).collect();
            ImageError::invalid(format!("no picture in layer `{layer}`; the channels are {}", names.join(", ")))
        })?;
        self.interleave(&planes)
    }

    /// The picture: the layer without a name, or the only layer that makes a picture.
    ///
    /// # Errors
    /// No such layer.
    pub fn picture(&self) -> Result<Image, ImageError> {
        let main = self.image("");
        if main.is_ok() {
            return main;
        }
        let mut pictures = self.layers().into_iter().filter(|layer| !layer.is_empty());
        match (pictures.next(), pictures.next()) {
            (Some(only), None) => self.image(only),
            _ => main,
        }
    }

    fn interleave(&self, planes: &[&Plane]) -> Result<Image, ImageError> {
        let pixels = self.width as usize * self.height as usize;
        debug_assert!(pixels as u64 <= MAX_PIXELS);
        let n = planes.len();
        let mut data = zeros("image", pixels * n)?;
        for (c, plane) in planes.iter().enumerate() {
            for i in 0..pixels {
                data[i * n + c] = plane.samples.get(i);
            }
        }
        Image::new(self.width, self.height, n, Transfer::Linear, data)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_image_pushed_as_a_layer_comes_back() {
        let image = Image::from_fn(3, 2, Transfer::Linear, |x, y| [x as f32, y as f32, 7.0]).unwrap();
        let mut planes = Planes::new(3, 2).unwrap();
        planes.push_image("", &image).unwrap();
        planes.push_image("albedo", &image).unwrap();
        assert_eq!(planes.layers(), ["", "albedo"]);
        assert_eq!(planes.image("albedo").unwrap(), image);
        assert!(planes.image("normal").is_err());
    }

    #[test]
    fn a_channel_of_another_size_or_a_taken_name_is_refused() {
        let mut planes = Planes::new(2, 2).unwrap();
        assert!(planes.push("Y", Samples::Float(vec![0.0; 3])).is_err());
        planes.push("Y", Samples::Uint(vec![1; 4])).unwrap();
        assert!(planes.push("Y", Samples::Float(vec![0.0; 4])).is_err());
        assert_eq!(planes.image("").unwrap().data(), [1.0; 4]);
    }
}
