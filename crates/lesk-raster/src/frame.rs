//! A picture: vertices to the screen, faces into bands of rows, bands to light.

use crate::band::{BandJob, Buffers};
use crate::clip::{Clipped, clip};
use crate::error::{Error, Result};
use crate::lanes::{Points, Work};
use crate::lights::at;
use crate::memory::{AHEAD, prefetch};
use crate::prepare::{Prepared, Vertex};
use crate::scan::centres;
use crate::shade::{Kind, Shader};
use crate::view::{Screen, View};
use crate::{FlatPoint, Mode, Settings};
use lesk_bsdf::kernels::BLOCK;
use lesk_geometry::World;
use lesk_image::{Aov, Film, FilmSpec, Sample};
use lesk_math::{CHANNELS, Vec3, vec3};
use lesk_scene::Scene;
use rayon::prelude::*;
use std::collections::HashMap;
use std::sync::Arc;
use std::time::{Duration, Instant};

/// Rows of a band: its depths and face numbers stay in the second-level cache.
const BAND: u32 = 32;

/// Faces that are placed together.
const CHUNK: usize = 4096;

/// Entries of a bin with this bit are numbers of clipped faces.
const CLIPPED: u32 = 1 << 31;

/// How much was done.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Count {
    /// Faces of the scene.
    pub faces: u64,
    /// Faces that may show: not turned away, not beside the screen, not too small to cover a sample.
    pub drawn: u64,
    /// Vertices, split where normals or texture coordinates differ.
    pub vertices: u64,
    /// Samples that a face covers.
    pub samples: u64,
    /// Points at which light was computed: faces, vertices or samples; vertices once for each side that their faces show.
    pub evaluations: u64,
    /// Wall-clock time of the frame, without preparing the scene.
    pub elapsed: Duration,
}

/// A face of a bin.
#[derive(Clone, Copy)]
pub(crate) struct Placed {
    /// Its number, or [`CLIPPED`] with that of a clipped one.
    pub entry: u32,
    /// The kind of its surface, as a number in `kinds`.
    pub kind: u32,
    /// Vertices and places of a whole triangle, so that nobody has to look for them again.
    pub triangle: Option<([u32; 3], [Screen; 3])>,
}

/// Chunks of faces, sorted into bands.
#[derive(Default)]
pub(crate) struct Chunk {
    pub bins: Vec<Vec<Placed>>,
    clipped: Vec<Clipped>,
}

impl Chunk {
    /// What is left of the face of an entry, if it was cut.
    #[inline]
    pub fn clipped(&self, entry: u32) -> Option<&Clipped> {
        (entry & CLIPPED != 0).then(|| &self.clipped[(entry & !CLIPPED) as usize])
    }
}

/// A scene whose faces and vertices are ready, for any number of frames.
pub struct Raster {
    pub(crate) scene: Arc<Scene>,
    pub(crate) settings: Settings,
    pub(crate) prepared: Prepared,
    pub(crate) view: View,
    /// The kind of each object, as a number in `kinds`.
    pub(crate) kind_of: Vec<u32>,
    pub(crate) kinds: Vec<Kind>,
    obstacles: Option<World>,
    pub(crate) screen: Vec<Screen>,
    /// The memory of the last frame.
    chunks: Vec<Chunk>,
    /// Light of vertices ([`corner_light`]) or faces, for the modes that interpolate or repeat it.
    pub(crate) light: Vec<[f32; 3]>,
}

/// What a sample shows.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SampleHit {
    /// Number of the face, from 0; with barycentric interpolation, of the triangle.
    pub face: u32,
    /// First-hit values.
    pub aov: Aov,
}

/// The samples of a frame.
#[derive(Clone, Debug, Default)]
pub struct Frame {
    /// Samples across and down.
    pub width: u32,
    /// Samples down.
    pub height: u32,
    /// Samples along each side of a pixel.
    pub supersampling: u32,
    /// Linear Rec.709 whose Y is cd/m², three numbers per sample, row by row.
    pub rgb: Vec<f32>,
    /// What each sample shows, where the settings ask for it.
    pub hits: Vec<Option<SampleHit>>,
    /// What was done.
    pub work: Count,
}

impl Raster {
    /// Makes faces and vertices.
    ///
    /// # Errors
    /// Settings out of range, analytic normals of a surface that has none, a film that is too large.
    pub fn new(scene: Arc<Scene>, settings: &Settings) -> Result<Self> {
        settings.check().map_err(|problem| Error::from_text(&problem))?;
        let prepared = Prepared::new(&scene, settings)?;
        let view = View::new(&scene, settings.supersampling, prepared.extent)?;
        let obstacles = if settings.shadows { Some(prepared.world(|_| None)?) } else { None };
        let mut number: HashMap<Kind, u32> = HashMap::new();
        let mut kinds = Vec::new();
        let kind_of = scene.objects.iter().map(|object| {
            let kind = Kind { material: object.material, light: object.light };
            *number.entry(kind).or_insert_with(|| {
                kinds.push(kind);
                kinds.len() as u32 - 1
            })
        });
        let kind_of = kind_of.collect();
        let settings = settings.clone();
        Ok(Raster {
            scene,
            settings,
            prepared,
            view,
            kind_of,
            kinds,
            obstacles,
            screen: vec![],
            chunks: vec![],
            light: vec![],
        })
    }

    /// The surfaces as the rasteriser sees them, for rays: one mesh per object, in the order of the scene. Surfaces that
    /// shine stay as they are: light is drawn from points of theirs.
    ///
    /// # Errors
    /// More triangles than a world can hold.
    pub fn world(&self) -> Result<World> {
        let world = &self.scene.world;
        self.prepared.world(|object| {
            let shines = self.scene.objects[object].light.is_some();
            shines.then(|| (world.geometry_of(object as u32).clone(), *world.place(object as u32)))
        })
    }

    /// Warnings for the user, one sentence each.
    pub fn warnings(&self) -> Vec<String> {
        let mut out: Vec<String> = self.settings.classic.iter().filter_map(|c| c.warning()).collect();
        if self.scene.camera.lens_radius() > 0.0 {
            out.push("the lens of the camera is left out: the rasteriser has pinholes only".into());
        }
        if self.settings.classic.is_none() {
            let second = |m: &&lesk_scene::Material| {
                m.bindings().iter().any(|b| b.uv_set > 0) || m.normal_map().is_some_and(|map| map.uv_set > 0)
            };
            out.extend(self.scene.materials.iter().filter(second).map(|m| {
                format!("material `{}` wants a second set of texture coordinates: the first one counts here", m.name())
            }));
            let mirrors = self.scene.materials.iter().filter(|m| {
                let mut params = [0.0; lesk_scene::MAX_PARAMS];
                let params = m.params([0.5; 2], &mut params);
                let wo = vec3(0.6, 0.0, 0.8);
                m.model().delta(params, wo).is_some_and(|[a, b]| a.probability + b.probability >= 1.0)
            });
            out.extend(
                mirrors
                    .map(|m| format!("material `{}` reflects in single directions only: it is black here", m.name())),
            );
        }
        out
    }

    /// Draws a frame.
    pub fn frame(&mut self) -> Frame {
        let mut frame = Frame::default();
        self.draw(&mut frame);
        frame
    }

    /// Draws a frame into the memory of an earlier one.
    pub fn draw(&mut self, frame: &mut Frame) {
        let start = Instant::now();
        self.place_vertices();
        let chunks = self.place_faces();
        let obstacles = self.obstacles.take();
        let shader = Shader::new(&self.scene, &self.settings, self.view.eye, obstacles.as_ref());
        let (light, before) = self.light_of_corners(&shader, &chunks);
        self.light = light;
        (frame.width, frame.height) = (self.view.width, self.view.height);
        frame.supersampling = self.settings.supersampling;
        let samples = frame.width as usize * frame.height as usize;
        frame.rgb.resize(3 * samples, 0.0);
        frame.hits.clear();
        frame.hits.resize(if self.settings.aovs { samples } else { 0 }, None);
        let counts = self.bands(&shader, &chunks, frame);
        drop(shader);
        let drawn = chunks.iter().map(|c| c.bins.iter().map(Vec::len).sum::<usize>() as u64).sum();
        let phong = self.settings.shading == Mode::Phong;
        frame.work = Count {
            faces: self.prepared.face_count() as u64,
            drawn,
            vertices: self.prepared.vertices.len() as u64,
            samples: counts,
            evaluations: if phong { counts } else { before },
            elapsed: start.elapsed(),
        };
        self.obstacles = obstacles;
        self.chunks = chunks;
    }

    fn bands(&self, shader: &Shader, chunks: &[Chunk], frame: &mut Frame) -> u64 {
        let row = 3 * frame.width as usize * BAND as usize;
        let per_band = frame.width as usize * BAND as usize;
        let keeps_hits = self.settings.aovs;
        let mut hit_bands: Vec<&mut [Option<SampleHit>]> = frame.hits.chunks_mut(per_band).collect();
        if !keeps_hits {
            hit_bands.resize_with(frame.rgb.len().div_ceil(row), || &mut []);
        }
        let needs = self.kinds.iter().map(|&kind| shader.needs(kind)).collect();
        let mapped = self.kinds.iter().map(|&kind| shader.is_mapped(kind)).collect();
        let job = BandJob { raster: self, shader, chunks, needs, mapped };
        frame
            .rgb
            .par_chunks_mut(row)
            .zip(hit_bands)
            .enumerate()
            .map_init(
                || Buffers::new(shader.isa),
                |buffers, (band, (rgb, hits))| {
                    let first = band as u32 * BAND;
                    let rows = first..(first + BAND).min(self.view.height);
                    job.run(buffers, band, rows, rgb, hits)
                },
            )
            .sum()
    }

    fn place_vertices(&mut self) {
        let Raster { view, prepared, screen, .. } = self;
        screen.resize(prepared.vertices.len(), Screen::default());
        let vertices = prepared.vertices.par_chunks(CHUNK);
        screen.par_chunks_mut(CHUNK).zip(vertices).for_each(|(places, vertices)| {
            for (place, v) in places.iter_mut().zip(vertices) {
                *place = view.snap(view.project(v.p));
            }
        });
    }

    /// Sorts faces into bands, in their order.
    fn place_faces(&mut self) -> Vec<Chunk> {
        let bands = self.view.height.div_ceil(BAND) as usize;
        let faces = self.prepared.face_count();
        let mut chunks = std::mem::take(&mut self.chunks);
        chunks.resize_with(faces.div_ceil(CHUNK), Chunk::default);
        chunks.par_iter_mut().enumerate().for_each(|(chunk, out)| {
            out.bins.iter_mut().for_each(Vec::clear);
            out.bins.resize_with(bands, Vec::new);
            out.clipped.clear();
            for face in chunk * CHUNK..((chunk + 1) * CHUNK).min(faces) {
                let later = self.prepared.face((face + AHEAD).min(faces - 1));
                later.iter().for_each(|&v| prefetch(&self.screen[v as usize]));
                self.place_face(face, out);
            }
        });
        chunks
    }

    #[inline]
    fn place_face(&self, face: usize, out: &mut Chunk) {
        let corners = self.prepared.face(face);
        let kind = self.kind_of[self.prepared.objects[face] as usize];
        let screen = |v: u32| self.screen[v as usize];
        if let &[a, b, c] = corners {
            let places = [screen(a), screen(b), screen(c)];
            if places.iter().all(|s| s.x != Screen::CLIP) {
                let placed = Placed { entry: face as u32, kind, triangle: Some(([a, b, c], places)) };
                self.sort(placed, places.into_iter(), out);
                return;
            }
        }
        if corners.iter().any(|&v| screen(v).x == Screen::CLIP) {
            if let Some(clipped) = clip(&self.prepared, &self.view, face as u32) {
                let placed = Placed { entry: CLIPPED | out.clipped.len() as u32, kind, triangle: None };
                let shown = self.sort(placed, clipped.corners.iter().map(|c| c.screen), out);
                if shown {
                    out.clipped.push(clipped);
                }
            }
            return;
        }
        self.sort(Placed { entry: face as u32, kind, triangle: None }, corners.iter().map(|&v| screen(v)), out);
    }

    /// Adds a face to its bands; `false` where it cannot show.
    #[inline(always)]
    fn sort(&self, placed: Placed, corners: impl Iterator<Item = Screen> + Clone, out: &mut Chunk) -> bool {
        let (mut low, mut high) = ([i32::MAX; 2], [i32::MIN; 2]);
        for c in corners.clone() {
            low = [low[0].min(c.x), low[1].min(c.y)];
            high = [high[0].max(c.x), high[1].max(c.y)];
        }
        let columns = centres(low[0], high[0], self.view.width);
        let rows = centres(low[1], high[1], self.view.height);
        if columns.is_empty() || rows.is_empty() || (self.settings.cull && signed_area(corners) >= 0) {
            return false;
        }
        for band in rows.start / BAND..=(rows.end - 1) / BAND {
            out.bins[band as usize].push(placed);
        }
        true
    }

    /// Light of all vertices (Gouraud) or faces (flat) that may show, and how many they are.
    fn light_of_corners(&self, shader: &Shader, chunks: &[Chunk]) -> (Vec<[f32; 3]>, u64) {
        let gouraud = match self.settings.shading {
            Mode::Phong => return (Vec::new(), 0),
            Mode::Gouraud => true,
            Mode::Flat => false,
        };
        let count = if gouraud { 2 * self.prepared.vertices.len() } else { self.prepared.face_count() };
        let mut kind = vec![u32::MAX; count];
        let entries = chunks.iter().flat_map(|c| c.bins.iter().flatten().map(move |p| (c, p.entry)));
        for (chunk, entry) in entries {
            let clipped = chunk.clipped(entry);
            let face = clipped.map_or(entry, |c| c.face) as usize;
            let own = self.kind_of[self.prepared.objects[face] as usize];
            if gouraud {
                let corners = self.prepared.face(face);
                let back = self.shows_back(corners, clipped);
                corners.iter().for_each(|&v| kind[corner_light(v, back)] = own);
            } else {
                kind[face] = own;
            }
        }
        let mut order: Vec<u32> = (0..count as u32).filter(|&i| kind[i as usize] != u32::MAX).collect();
        let group = |i: u32| (kind[i as usize], gouraud && i & 1 == 1);
        order.sort_by_key(|&i| group(i));
        let mut light = vec![[0.0; 3]; count];
        let blocks: Vec<&[u32]> = order.chunk_by(|&a, &b| group(a) == group(b)).flat_map(|c| c.chunks(BLOCK)).collect();
        let lit: Vec<Vec<[f32; 3]>> = blocks
            .par_iter()
            .map_init(
                || (Points::new(), Work::new()),
                |(points, work), block| {
                    points.n = 0;
                    block.iter().for_each(|&i| self.add_corner(gouraud, i as usize, points));
                    let (kind, back) = group(block[0]);
                    shader.shade(self.kinds[kind as usize], gouraud.then_some(back), points, work);
                    (0..points.n).map(|i| [0, 1, 2].map(|c| work.sum[c.min(CHANNELS - 1)][i])).collect()
                },
            )
            .collect();
        for (block, lit) in blocks.iter().zip(&lit) {
            block.iter().zip(lit).for_each(|(&i, l)| light[i as usize] = *l);
        }
        let evaluations = order.len() as u64;
        (light, evaluations)
    }

    /// Whether a face turns its back to the viewer: one answer for all of its corners.
    pub(crate) fn shows_back(&self, corners: &[u32], clipped: Option<&Clipped>) -> bool {
        match clipped {
            Some(clipped) => signed_area(clipped.corners.iter().map(|c| c.screen)) >= 0,
            None => signed_area(corners.iter().map(|&v| self.screen[v as usize])) >= 0,
        }
    }

    /// Adds a vertex with its own normal as that of its surface, or a face with its point.
    fn add_corner(&self, gouraud: bool, index: usize, points: &mut Points) {
        let data = &self.prepared;
        let (p, n, uv, [x, y, z, hand]) = if gouraud {
            let Vertex { p, n, uv } = data.vertices[index / 2];
            (p, n, uv, data.tangents.get(index / 2).copied().unwrap_or([0.0, 0.0, 0.0, 1.0]))
        } else {
            let face = data.face(index);
            let count = match self.settings.flat_point {
                FlatPoint::Centroid => face.len(),
                FlatPoint::First => 1,
            };
            let mean = |of: &dyn Fn(usize) -> f64| {
                face[..count].iter().map(|&v| of(v as usize)).sum::<f64>() as f32 / count as f32
            };
            let position = |k: usize| mean(&|v| f64::from(data.vertices[v].p.to_array()[k]));
            let uv = [0, 1].map(|k| mean(&|v| f64::from(data.vertices[v].uv[k])));
            let n = data.face_normal(index).map(|x| x as f32);
            (vec3(position(0), position(1), position(2)), n, uv, data.whole_tangent(index))
        };
        let i = points.n;
        let origin = if gouraud { p } else { self.above(index, p, n) };
        for c in 0..3 {
            points.p[c][i] = p.to_array()[c];
            points.origin[c][i] = origin.to_array()[c];
            points.ns[c][i] = n.to_array()[c];
            points.ng[c][i] = n.to_array()[c];
            points.tangent[c][i] = [x, y, z][c];
            points.along[c][i] = [x, y, z][c];
        }
        points.hand[i] = hand;
        points.uv[0][i] = uv[0];
        points.uv[1][i] = uv[1];
        points.n += 1;
    }
}

impl Raster {
    /// The point of a face that is as high above its mean plane as the highest corner, on the side of the viewer: the point
    /// itself may lie behind a bent face.
    fn above(&self, face: usize, p: Vec3<f32>, n: Vec3<f32>) -> Vec3<f32> {
        let side = if n.dot(self.view.eye - p) < 0.0 { -1.0 } else { 1.0 };
        let height = |&v: &u32| (self.prepared.vertices[v as usize].p - p).dot(n) * side;
        p + n * (side * self.prepared.face(face).iter().map(height).fold(0.0, f32::max))
    }
}

/// Where the light of a vertex stands, as a corner of faces that show their front or their back.
#[inline]
pub(crate) fn corner_light(vertex: u32, back: bool) -> usize {
    2 * vertex as usize + usize::from(back)
}

/// Twice the signed area on the screen, square steps: negative where corners run counter-clockwise for the viewer (y is
/// down).
#[inline]
fn signed_area(corners: impl Iterator<Item = Screen>) -> i64 {
    let cross = |a: Screen, b: Screen| i64::from(a.x) * i64::from(b.y) - i64::from(b.x) * i64::from(a.y);
    let mut corners = corners;
    let Some(first) = corners.next() else { return 0 };
    let (last, sum) = corners.fold((first, 0), |(before, sum), corner| (corner, sum + cross(before, corner)));
    sum + cross(last, first)
}

impl Frame {
    /// The frame as a film: every pixel holds its samples.
    ///
    /// # Errors
    /// A film that memory cannot hold.
    pub fn film(&self) -> std::result::Result<Film, lesk_image::ImageError> {
        let s = self.supersampling.max(1);
        let spec = FilmSpec {
            width: self.width / s,
            height: self.height / s,
            splits: Vec::new(),
            aovs: !self.hits.is_empty(),
        };
        let mut film = Film::new(spec)?;
        for (k, rgb) in self.rgb.as_chunks::<3>().0.iter().enumerate() {
            let (x, y) = (k as u32 % self.width / s, k as u32 / self.width / s);
            let aov = self.hits.get(k).copied().flatten().map(|h| h.aov);
            film.add(x, y, &Sample { radiance: *rgb, splits: &[], aov });
        }
        Ok(film)
    }
}

/// First-hit values of a shaded point.
pub(crate) fn aov(
    points: &Points,
    i: usize,
    albedo: [f32; 3],
    eye: Vec3<f32>,
    object: u32,
    material: Option<u32>,
) -> Aov {
    Aov {
        albedo,
        normal: at(&points.ns, i).to_array(),
        depth: (at(&points.p, i) - eye).length(),
        object: object + 1,
        material: material.map_or(0, |m| m + 1),
    }
}
