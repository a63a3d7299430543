//! Sensors: where in a scene light is measured, and what of it.
//!
//! A sensor is a point, a line, a grid, a luminance meter, a camera of readings or the eye of a glare observer.
//! [`Sensor::probes`] gives its single readings.

use crate::Camera;
use crate::error::Place;
use crate::tasks::Task;
use lesk_geometry::Transform;
use lesk_light::Spectrum;
use lesk_math::{Vec3, vec3};
use lesk_quantities::K_M;
use lesk_quantities::photometry::{Range, Vision};
use lesk_quantities::units::AVOGADRO;

/// Most readings of one sensor.
pub const MAX_PROBES: usize = 1 << 22;

/// Something that measures.
#[derive(Clone, Debug)]
pub struct Sensor {
    /// Its name in reports.
    pub name: String,
    /// Where its readings are taken.
    pub form: Form,
    /// How directions of light count; a luminance form ignores it.
    pub response: Response,
    /// The quantity that is reported.
    pub quantity: Quantity,
    /// The row of EN 12464-1 that it is checked against.
    pub task: Option<&'static Task>,
    /// Limits of its own, which replace those of the row.
    pub limits: Limits,
    /// Where it is stated.
    pub place: Place,
}

/// Where the readings of a sensor are taken. Lengths are metres, angles radians.
#[derive(Clone, Debug)]
pub enum Form {
    /// One point.
    Point {
        /// Position.
        position: [f64; 3],
    },
    /// Points at the centres of equal parts of a line.
    Line {
        /// One end.
        from: [f64; 3],
        /// The other end.
        to: [f64; 3],
        /// Number of points.
        count: usize,
    },
    /// Points at the centres of equal cells of a parallelogram.
    Grid {
        /// The corner of the first cell.
        corner: [f64; 3],
        /// The two edges from there.
        edges: [[f64; 3]; 2],
        /// Number of points along each edge.
        counts: [usize; 2],
    },
    /// The mean luminance of a cone.
    Luminance {
        /// Position.
        position: [f64; 3],
        /// The middle of the cone.
        direction: [f64; 3],
        /// From the axis to the edge; 0 is a single ray.
        half_angle: f64,
    },
    /// A picture of readings: luminance along each ray, or the illuminance of the surface that it meets.
    Camera {
        /// Local -z looks forward, +y up.
        world_from_local: Transform,
        /// Full horizontal opening.
        horizontal_fov: f64,
        /// Width and height in pixels.
        size: [u32; 2],
        /// Whether the surface's illuminance is read instead of its luminance.
        illuminance: bool,
    },
    /// The eye of an observer of glare (UGR).
    Glare {
        /// Position of the eye.
        position: [f64; 3],
        /// The line of sight.
        direction: [f64; 3],
        /// The direction that is up.
        up: [f64; 3],
    },
}

/// How light from a direction counts; every response reads pi L under a uniform sky of luminance L from all around,
/// a planar one under its upper half.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Response {
    /// The cosine to a normal: the illuminance of a plane.
    Planar {
        /// Unit.
        normal: [f64; 3],
    },
    /// The mean over the side of a thin cylinder: sin / pi of the angle to the axis.
    Cylindrical {
        /// Unit.
        axis: [f64; 3],
    },
    /// The same over the half of the side that faces a direction.
    Semicylindrical {
        /// Unit.
        axis: [f64; 3],
        /// Unit, perpendicular to the axis.
        facing: [f64; 3],
    },
    /// The mean over a small sphere: 1/4 from everywhere.
    Spherical,
    /// The mean over the half of a small sphere around a normal.
    Hemispherical {
        /// Unit.
        normal: [f64; 3],
    },
}

/// The quantity that is reported; watts and photons need a spectrum, which the light at the sensor is taken to have.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Quantity {
    /// lx, or cd/m² of a luminance form.
    Photometric,
    /// W/m², or W/m²/sr.
    Radiometric(Spectrum),
    /// µmol/m²/s of photons from 400 to 700 nm (PPFD), or µmol/m²/s/sr.
    Photons(Spectrum),
}

/// Wavelengths whose photons plants use: McCree, *The action spectrum, absorptance and quantum yield of photosynthesis in
/// crop plants*, 1972.
const PLANTS: Range = Range { first_nm: 400, last_nm: 700 };

/// Photons from 400 to 700 nm per lumen, µmol/(lm s).
fn photons_per_lumen(spectrum: Spectrum) -> f64 {
    // both crates know the names of `lesk_light`
    let spectrum = lesk_quantities::Spectrum::parse(&spectrum.to_string()).expect("the name of a spectrum");
    let photons = spectrum.photons_per_joule(Some(PLANTS)) * spectrum.energy(Some(PLANTS));
    let visible = Some(Range::VISIBLE);
    let lumens = spectrum.efficacy(visible, Vision::Photopic) * spectrum.energy(visible);
    photons / AVOGADRO * 1e6 / lumens
}

impl Quantity {
    /// The reported unit per lm (of luminances: per cd).
    pub fn per_lumen(self) -> f64 {
        match self {
            Quantity::Photometric => 1.0,
            Quantity::Radiometric(spectrum) => 1.0 / spectrum.efficacy(),
            Quantity::Photons(spectrum) => photons_per_lumen(spectrum),
        }
    }

    /// How lumens became the reported unit; empty where they did not.
    pub fn conversion(self) -> String {
        match self {
            Quantity::Photometric => String::new(),
            Quantity::Radiometric(spectrum) => spectrum.conversion(),
            Quantity::Photons(spectrum) => {
                let per_lumen = photons_per_lumen(spectrum);
                format!("{per_lumen:.6} umol/s of 400 to 700 nm per lm ({spectrum}, K_m = {K_M} lm/W)")
            }
        }
    }
}

/// What a sensor must read; `None` demands nothing.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Limits {
    /// Least mean maintained illuminance, lx.
    pub mean: Option<f64>,
    /// Least uniformity U0 = min / mean.
    pub uniformity: Option<f64>,
    /// Greatest UGR.
    pub ugr: Option<f64>,
}

/// How a scene is measured.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MeasureSettings {
    /// Maintained over initial illuminance.
    pub maintenance_factor: f64,
    /// Relative standard error that every reading shall reach.
    pub error: f64,
    /// Most reflections of a path.
    pub max_depth: u32,
}

impl Default for MeasureSettings {
    fn default() -> Self {
        // 1024: roulette ends paths long before, except between mirrors
        MeasureSettings { maintenance_factor: 1.0, error: 0.01, max_depth: 1024 }
    }
}

/// One reading.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Probe {
    /// Position, metres.
    pub position: Vec3<f64>,
    /// What is read there.
    pub reading: Reading,
}

/// What a probe reads.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Reading {
    /// The illuminance of a response, lx.
    Illuminance(Response),
    /// The mean luminance of a cone, cd/m².
    Luminance {
        /// Unit.
        direction: Vec3<f64>,
        /// Radians; 0 is a single ray.
        half_angle: f64,
    },
    /// The illuminance of the surface that a ray meets, on its near side, lx; 0 where it meets none.
    SurfaceIlluminance {
        /// Unit.
        direction: Vec3<f64>,
    },
}

impl Sensor {
    /// Readings of what a camera sees, of `size` pixels across and down: luminance, or the illuminance of surfaces.
    pub fn view_of(camera: &Camera, size: [u32; 2], illuminance: bool) -> Sensor {
        let (world_from_local, horizontal_fov) = (*camera.world_from_local(), camera.horizontal_fov());
        Sensor {
            name: "camera".into(),
            form: Form::Camera { world_from_local, horizontal_fov, size, illuminance },
            response: Response::Spherical,
            quantity: Quantity::Photometric,
            task: None,
            limits: Limits::default(),
            place: Place::NONE,
        }
    }

    /// Its limits: its own, else those of its row of EN 12464-1.
    pub fn limits(&self) -> Limits {
        let row = self.task.map_or(Limits::default(), Task::limits);
        Limits {
            mean: self.limits.mean.or(row.mean),
            uniformity: self.limits.uniformity.or(row.uniformity),
            ugr: self.limits.ugr.or(row.ugr),
        }
    }

    /// Whether it reads a luminance.
    pub fn is_luminance(&self) -> bool {
        matches!(self.form, Form::Luminance { .. } | Form::Camera { illuminance: false, .. })
    }

    /// The unit of its readings.
    pub fn unit(&self) -> &'static str {
        match (self.quantity, self.is_luminance()) {
            (Quantity::Photometric, false) => "lx",
            (Quantity::Photometric, true) => "cd/m2",
            (Quantity::Radiometric(_), false) => "W/m2",
            (Quantity::Radiometric(_), true) => "W/m2/sr",
            (Quantity::Photons(_), false) => "umol/m2/s",
            (Quantity::Photons(_), true) => "umol/m2/s/sr",
        }
    }

    /// Rows and columns of its readings; one row for a line, one of each for a point.
    pub fn shape(&self) -> [usize; 2] {
        match &self.form {
            Form::Line { count, .. } => [1, *count],
            Form::Grid { counts, .. } => [counts[1], counts[0]],
            Form::Camera { size, .. } => [size[1] as usize, size[0] as usize],
            Form::Point { .. } | Form::Luminance { .. } | Form::Glare { .. } => [1, 1],
        }
    }

    /// The places of a line or grid, or the one of a point; row by row.
    pub fn probes(&self) -> Vec<Probe> {
        let planar = |position: Vec3<f64>| Probe { position, reading: Reading::Illuminance(self.response) };
        match &self.form {
            Form::Point { position } => vec![planar(Vec3::from(*position))],
            Form::Line { from, to, count } => {
                let (from, to) = (Vec3::from(*from), Vec3::from(*to));
                (0..*count).map(|i| planar(from + (to - from) * middle(i, *count))).collect()
            }
            Form::Grid { corner, edges, counts } => {
                let [u, v] = edges.map(Vec3::from);
                let at = |row, column| Vec3::from(*corner) + u * middle(column, counts[0]) + v * middle(row, counts[1]);
                (0..counts[1])
                    .flat_map(|row| (0..counts[0]).map(move |c| (row, c)))
                    .map(|(r, c)| planar(at(r, c)))
                    .collect()
            }
            Form::Luminance { position, direction, half_angle } => {
                let reading =
                    Reading::Luminance { direction: Vec3::from(*direction).normalize(), half_angle: *half_angle };
                vec![Probe { position: Vec3::from(*position), reading }]
            }
            Form::Camera { world_from_local, horizontal_fov, size, illuminance } => {
                camera_probes(world_from_local, *horizontal_fov, *size, *illuminance)
            }
            // the vertical illuminance at the eye
            Form::Glare { position, direction, .. } => {
                let normal = Vec3::from(*direction).normalize().to_array();
                let reading = Reading::Illuminance(Response::Planar { normal });
                vec![Probe { position: Vec3::from(*position), reading }]
            }
        }
    }
}

/// The middle of part `i` of `count` equal parts of 0 to 1.
fn middle(i: usize, count: usize) -> f64 {
    (i as f64 + 0.5) / count as f64
}

fn camera_probes(place: &Transform, fov: f64, size: [u32; 2], illuminance: bool) -> Vec<Probe> {
    let [width, height] = size.map(f64::from);
    let tan = (0.5 * fov).tan();
    let position = place.point_f64(Vec3::ZERO);
    let probe = |x: u32, y: u32| {
        let right = (2.0 * (f64::from(x) + 0.5) / width - 1.0) * tan;
        let up = (1.0 - 2.0 * (f64::from(y) + 0.5) / height) * tan * height / width;
        let direction = place.vector_f64(vec3(right, up, -1.0)).normalize();
        let reading = match illuminance {
            true => Reading::SurfaceIlluminance { direction },
            // a pixel is a cone of about its own size
            false => Reading::Luminance { direction, half_angle: tan / width },
        };
        Probe { position, reading }
    };
    (0..size[1]).flat_map(|y| (0..size[0]).map(move |x| (x, y))).map(|(x, y)| probe(x, y)).collect()
}

/// The greatest spacing of the points of a calculation grid by EN 12464-1: p = 0.2 * 5^log10(d), metres, at most 10;
/// `d` is the longer side of the area.
pub fn grid_spacing(d: f64) -> f64 {
    (0.2 * 5f64.powf(d.log10())).min(10.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn grid_spacing_is_the_formula_of_the_standard() {
        // the formula at powers of ten, where 5^log10(d) is a power of 5; at most 10 m
        for (d, p) in [(0.1, 0.04), (1.0, 0.2), (10.0, 1.0), (100.0, 5.0), (1e4, 10.0)] {
            assert!((grid_spacing(d) - p).abs() <= 1e-12 * p, "{d} m: {}", grid_spacing(d));
        }
    }

    fn sensor(form: Form) -> Sensor {
        Sensor {
            name: String::new(),
            form,
            response: Response::Planar { normal: [0.0, 0.0, 1.0] },
            quantity: Quantity::Photometric,
            task: None,
            limits: Limits::default(),
            place: Place::NONE,
        }
    }

    #[test]
    fn points_of_a_grid_lie_in_the_middle_of_equal_cells_row_by_row() {
        let grid = Form::Grid { corner: [1.0, 2.0, 0.8], edges: [[3.0, 0.0, 0.0], [0.0, 2.0, 0.0]], counts: [3, 2] };
        let grid = sensor(grid);
        let places: Vec<_> = grid.probes().iter().map(|p| p.position.to_array()).collect();
        assert_eq!(grid.shape(), [2, 3]);
        let expected =
            [[1.5, 2.5, 0.8], [2.5, 2.5, 0.8], [3.5, 2.5, 0.8], [1.5, 3.5, 0.8], [2.5, 3.5, 0.8], [3.5, 3.5, 0.8]];
        for (place, expected) in places.iter().zip(expected) {
            assert!((Vec3::from(*place) - Vec3::from(expected)).length() < 1e-12, "{place:?}");
        }
        assert_eq!(places.len(), 6);
    }

    #[test]
    fn photons_of_equal_energy_light_are_the_integral_of_the_wavelength() {
        // per W/nm: (700² - 400²)/2 nm² / (h c N_A) = 1379.31 umol/s and 683.002 * 106.8564 nm = 72983 lm
        let (hc, avogadro) = (6.626_070_15e-34 * 299_792_458.0, 6.022_140_76e23);
        let photons = (700f64.powi(2) - 400f64.powi(2)) / 2.0 * 1e-9 / hc / avogadro * 1e6;
        let expected = photons / (683.002 * 106.856_399);
        let found = Quantity::Photons(Spectrum::E).per_lumen();
        assert!((found / expected - 1.0).abs() < 1e-6, "{found} is not {expected}");
        // daylight: about 54 lx per umol/m2/s (Thimijan & Heins, HortScience 18, 1983)
        assert!((1.0 / Quantity::Photons(Spectrum::D65).per_lumen() / 54.0 - 1.0).abs() < 0.05);
    }

    #[test]
    fn middle_of_a_camera_looks_forward() {
        let place = Transform::look_at(vec3(0.0, -4.0, 1.0), vec3(0.0, 0.0, 1.0), vec3(0.0, 0.0, 1.0)).unwrap();
        let form = Form::Camera { world_from_local: place, horizontal_fov: 1.0, size: [3, 3], illuminance: false };
        let probes = sensor(form).probes();
        let Reading::Luminance { direction, .. } = probes[4].reading else { panic!("a luminance") };
        assert!((direction - vec3(0.0, 1.0, 0.0)).length() < 1e-12);
        let Reading::Luminance { direction, .. } = probes[0].reading else { panic!("a luminance") };
        assert!(direction.x < 0.0 && direction.z > 0.0, "the first pixel is the upper left one");
    }
}
