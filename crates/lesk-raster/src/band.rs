//! One band of rows: which face each sample shows, then its light.

use crate::clip::Clipped;
use crate::frame::{Chunk, Placed, Raster, SampleHit, aov, corner_light};
use crate::inside::{Line, Row, Triangle, Weighted, unclip};
use crate::lanes::{Points, Work};
use crate::lights::at;
use crate::memory::{AHEAD, prefetch};
use crate::prepare::triangle_normal;
use crate::run::{Face, LANES, Place};
use crate::samples::{Samples, Spot};
use crate::scan::{Band, Crossing};
use crate::shade::{Kind, Shader};
use crate::{Mode, Space};
use lesk_bsdf::kernels::BLOCK;
use lesk_math::{CHANNELS, Isa, Vec3};
use std::ops::Range;

/// What a thread keeps from band to band.
pub(crate) struct Buffers {
    band: Band,
    samples: Samples,
    crossings: Vec<Crossing>,
    corners: Vec<crate::view::Screen>,
    /// One block of waiting points per kind of surface.
    waiting: Vec<Option<Box<Points>>>,
    work: Box<Work>,
    row: Row,
    weights: Weighted,
    whole: Weighted,
}

impl Buffers {
    pub fn new(isa: Isa) -> Buffers {
        Buffers {
            band: Band::new(isa),
            samples: Samples::default(),
            crossings: Vec::new(),
            corners: Vec::new(),
            waiting: Vec::new(),
            work: Work::new(),
            row: Row::default(),
            weights: Vec::new(),
            whole: Vec::new(),
        }
    }
}

/// What all bands share.
pub(crate) struct BandJob<'a> {
    pub raster: &'a Raster,
    pub shader: &'a Shader<'a>,
    pub chunks: &'a [Chunk],
    /// Of each kind, whether texture coordinates and whether tangents matter.
    pub needs: Vec<[bool; 2]>,
    /// Of each kind, whether a map bends its normals.
    pub mapped: Vec<bool>,
}

/// Where a band goes.
struct Output<'o> {
    rgb: &'o mut [f32],
    hits: &'o mut [Option<SampleHit>],
    first_row: u32,
    width: u32,
    /// What has the code 1.
    white: f32,
}

impl Output<'_> {
    /// Row and column of the film, and the number within the band.
    #[inline]
    fn place(&self, spot: Spot) -> ([u32; 2], u32) {
        ([spot.column(), self.first_row + spot.row()], spot.row() * self.width + spot.column())
    }

    #[inline]
    fn write(&mut self, target: u32, light: [f32; 3]) {
        let at = 3 * target as usize;
        self.rgb[at..at + 3].copy_from_slice(&light);
    }
}

impl BandJob<'_> {
    /// Draws a band; returns how many samples are covered.
    pub fn run(
        &self,
        buffers: &mut Buffers,
        band: usize,
        rows: Range<u32>,
        rgb: &mut [f32],
        hits: &mut [Option<SampleHit>],
    ) -> u64 {
        let width = self.raster.view.width;
        buffers.waiting.resize_with(self.raster.kinds.len(), || None);
        buffers.band.start(width, rows.clone());
        let faces = self.cover(buffers, band);
        let mut out = Output { rgb, hits, first_row: rows.start, width, white: self.white() };
        self.clear(&buffers.band, &mut out);
        let mut samples = std::mem::take(&mut buffers.samples);
        samples.sort(&buffers.band, faces as usize);
        let mut id = 0;
        for chunk in self.chunks {
            let bin = &chunk.bins[band];
            for (k, placed) in bin.iter().enumerate() {
                id += 1;
                if let Some((corners, _)) = bin.get(k + AHEAD).and_then(|p| p.triangle)
                    && !samples.of(id + AHEAD as u32).is_empty()
                {
                    corners.iter().for_each(|&v| prefetch(&self.raster.prepared.vertices[v as usize]));
                }
                let spots = samples.of(id);
                if !spots.is_empty() {
                    self.shade_face(buffers, chunk, placed, spots, &mut out);
                }
            }
        }
        for kind in 0..self.raster.kinds.len() {
            self.flush(buffers, kind as u32, &mut out);
        }
        let covered = samples.len() as u64;
        buffers.samples = samples;
        covered
    }

    /// What is behind all faces.
    fn clear(&self, band: &Band, out: &mut Output) {
        out.rgb.fill(0.0);
        let Some(background) = self.shader.background() else { return };
        for y in band.rows.clone() {
            for (x, &id) in band.ids[band.row(y)].iter().enumerate() {
                if id == 0 {
                    let light = background(self.raster.view.world_ray(x as u32, y));
                    let light = self.shader.show([0, 1, 2].map(|c| light.0[c.min(CHANNELS - 1)]), out.white);
                    out.write((y - band.rows.start) * out.width + x as u32, light);
                }
            }
        }
    }

    fn white(&self) -> f32 {
        if self.raster.settings.classic.as_ref().is_some_and(|c| !c.lights.is_empty()) {
            return 1.0;
        }
        let ev100 = self.raster.scene.film.ev100.unwrap_or(0.0);
        lesk_quantities::exposure::saturation_luminance(ev100) as f32
    }

    /// Decides which face each sample of the band shows: 1 for the first of the band, and so on. Returns how many there are.
    fn cover(&self, buffers: &mut Buffers, number: usize) -> u32 {
        let raster = self.raster;
        let Buffers { band, corners, crossings, .. } = buffers;
        let mut id = 0;
        for chunk in self.chunks {
            for placed in &chunk.bins[number] {
                id += 1;
                if let Some((_, screen)) = placed.triangle {
                    band.triangle(id, screen);
                    continue;
                }
                corners.clear();
                match chunk.clipped(placed.entry) {
                    Some(clipped) => corners.extend(clipped.corners.iter().map(|c| c.screen)),
                    None => {
                        let face = raster.prepared.face(placed.entry as usize);
                        corners.extend(face.iter().map(|&v| raster.screen[v as usize]));
                    }
                }
                band.polygon(id, corners, crossings);
            }
        }
        id
    }

    /// Light of the samples of a face: at once where it is known already, else when its block is full.
    fn shade_face(&self, buffers: &mut Buffers, chunk: &Chunk, placed: &Placed, spots: &[Spot], out: &mut Output) {
        let raster = self.raster;
        let clipped = chunk.clipped(placed.entry);
        let face = clipped.map_or(placed.entry, |c| c.face);
        let mode = raster.settings.shading;
        if mode == Mode::Flat && out.hits.is_empty() {
            let light = self.shader.show(raster.light[face as usize], out.white);
            spots.iter().for_each(|&spot| out.write(out.place(spot).1, light));
            return;
        }
        let kind = placed.kind;
        let plain = mode == Mode::Phong && !self.shader.raises() && !self.mapped[kind as usize];
        match placed.triangle {
            Some((corners, _)) if plain => self.shade_triangle(buffers, [face, kind], corners, spots, out),
            _ => self.shade_polygon(buffers, [face, kind], clipped, spots, out),
        }
    }

    /// The common case, without detours: a triangle in Phong shading.
    fn shade_triangle(
        &self,
        buffers: &mut Buffers,
        [face, kind]: [u32; 2],
        corners: [u32; 3],
        mut spots: &[Spot],
        out: &mut Output,
    ) {
        let (data, view) = (&self.raster.prepared, &self.raster.view);
        let corners = corners.map(|v| data.vertices[v as usize]);
        let positions = corners.map(|v| v.p);
        let surface = Surface::new(self, [face, kind], triangle_normal(positions));
        let [textured, anisotropic] = self.needs[surface.kind as usize];
        let face = Face {
            number: face,
            inside: Triangle::new(view, positions, self.raster.settings.correction),
            corners,
            normal: surface.normal,
            tangent: anisotropic.then_some(surface.tangent),
            textured: textured || !out.hits.is_empty(),
        };
        let place = Place { view, first_row: out.first_row, width: out.width };
        while !spots.is_empty() {
            let points = waiting(&mut buffers.waiting, surface.kind);
            let room = (BLOCK - points.n) / LANES * LANES;
            if room == 0 {
                self.flush(buffers, surface.kind, out);
                continue;
            }
            let (these, rest) = spots.split_at(spots.len().min(room));
            self.shader.lanes.run(&face, place, these, points);
            spots = rest;
        }
    }

    /// Any other face, in any mode.
    fn shade_polygon(
        &self,
        buffers: &mut Buffers,
        [face, kind]: [u32; 2],
        clipped: Option<&Clipped>,
        spots: &[Spot],
        out: &mut Output,
    ) {
        let raster = self.raster;
        let mode = raster.settings.shading;
        let corners = raster.prepared.face(face as usize);
        let surface = Surface::new(self, [face, kind], raster.prepared.face_normal(face as usize).map(|x| x as f32));
        let back = mode == Mode::Gouraud && raster.shows_back(corners, clipped);
        let triangle = match (corners, clipped) {
            (&[a, b, c], None) => Some(self.triangle([a, b, c])),
            _ => None,
        };
        for row in spots.chunk_by(|a, b| a.row() == b.row()) {
            let ([_, y], _) = out.place(row[0]);
            let line = triangle.map(|t| t.row(raster.view.line(y)));
            match clipped {
                Some(clipped) => buffers.row.clipped(clipped, y),
                None if line.is_none() => buffers.row.face(corners, &raster.screen, y),
                None => {}
            }
            for &spot in row {
                let ([x, _], target) = out.place(spot);
                self.weigh(buffers, corners, line.as_ref(), clipped, x);
                if mode == Mode::Phong || !out.hits.is_empty() {
                    self.wait(buffers, &surface, target, out);
                }
                let light = match mode {
                    Mode::Phong => continue,
                    Mode::Flat => raster.light[surface.face as usize],
                    Mode::Gouraud => {
                        let mut light = [0.0f64; 3];
                        for &(v, w) in &buffers.whole {
                            let own = raster.light[corner_light(v, back)];
                            (0..3).for_each(|c| light[c] += w * f64::from(own[c]));
                        }
                        light.map(|l| l as f32)
                    }
                };
                out.write(target, self.shader.show(light, out.white));
            }
        }
    }

    fn triangle(&self, corners: [u32; 3]) -> Triangle {
        let positions = corners.map(|v| self.raster.prepared.vertices[v as usize].p);
        Triangle::new(&self.raster.view, positions, self.raster.settings.correction)
    }

    /// Vertices with their weights at a sample, into `buffers.whole`.
    fn weigh(&self, buffers: &mut Buffers, corners: &[u32], line: Option<&Line>, clipped: Option<&Clipped>, x: u32) {
        let Buffers { row, weights, whole, .. } = buffers;
        if let (Some(line), &[a, b, c]) = (line, corners) {
            let [u, v] = line.weights(self.raster.view.column(x)).map(f64::from);
            whole.clear();
            whole.extend([(a, 1.0 - u - v), (b, u), (c, v)]);
            return;
        }
        row.weights(x, self.raster.settings.correction, weights);
        match clipped {
            Some(clipped) => unclip(clipped, corners, weights, whole),
            None => {
                whole.clear();
                whole.extend(weights.iter().map(|&(corner, w)| (corners[corner as usize], w)));
            }
        }
    }

    /// What the normal map of a point goes along: the interpolated tangent; in flat shading that of the face.
    fn turn(&self, points: &mut Points, i: usize, surface: &Surface, weighted: &Weighted) {
        let data = &self.raster.prepared;
        let mut sum = [0.0f64; 4];
        for &(v, w) in weighted {
            let own = data.tangents.get(v as usize).copied().unwrap_or_default();
            (0..4).for_each(|c| sum[c] += w * f64::from(own[c]));
        }
        let [x, y, z, hand] = match self.raster.settings.shading {
            Mode::Flat => data.whole_tangent(surface.face as usize),
            _ => sum.map(|x| x as f32),
        };
        (0..3).for_each(|c| points.along[c][i] = [x, y, z][c]);
        points.hand[i] = if hand < 0.0 { -1.0 } else { 1.0 };
    }

    /// Where rays of light start from a point of a face.
    fn raise(&self, points: &mut Points, i: usize, face: u32, weighted: &Weighted) {
        let data = &self.raster.prepared;
        let p = at(&points.p, i);
        let side = if at(&points.ng, i).dot(self.raster.view.eye - p) < 0.0 { -1.0 } else { 1.0 };
        let corner = |&(v, w): &(u32, f64)| {
            let vertex = &data.vertices[v as usize];
            (w, vertex.p.map(f64::from), vertex.n.map(f64::from) * side)
        };
        let raised = lesk_geometry::raised(p.map(f64::from), weighted.iter().map(corner)).map(|x| x as f32);
        // spans across a bent face pass behind the triangles that rays meet
        let start = raised + at(&points.ng, i) * (side as f32 * data.depth(face as usize));
        (0..3).for_each(|c| points.origin[c][i] = start.to_array()[c]);
    }

    /// Adds the point of `buffers.whole` to the block of its kind.
    fn wait(&self, buffers: &mut Buffers, surface: &Surface, target: u32, out: &mut Output) {
        let data = &self.raster.prepared;
        let points = waiting(&mut buffers.waiting, surface.kind);
        let i = points.n;
        let (mut p, mut n, mut uv) = ([0.0f64; 3], [0.0f64; 3], [0.0f64; 2]);
        for &(v, w) in &buffers.whole {
            let vertex = &data.vertices[v as usize];
            let (position, normal) = (vertex.p.to_array(), vertex.n.to_array());
            for c in 0..3 {
                p[c] += w * f64::from(position[c]);
                n[c] += w * f64::from(normal[c]);
            }
            (0..2).for_each(|c| uv[c] += w * f64::from(vertex.uv[c]));
        }
        for c in 0..3 {
            points.p[c][i] = p[c] as f32;
            points.ns[c][i] = if self.raster.settings.shading == Mode::Flat { surface.normal[c] } else { n[c] as f32 };
        }
        (0..2).for_each(|c| points.uv[c][i] = uv[c] as f32);
        surface.add(points, target);
        if self.shader.raises() {
            self.raise(points, i, surface.face, &buffers.whole);
        }
        if surface.mapped {
            self.turn(points, i, surface, &buffers.whole);
        }
        if points.n == BLOCK {
            self.flush(buffers, surface.kind, out);
        }
    }

    /// Shades the waiting points of a kind.
    fn flush(&self, buffers: &mut Buffers, kind: u32, out: &mut Output) {
        let Buffers { waiting, work, .. } = buffers;
        let Some(points) = waiting[kind as usize].as_mut().filter(|p| p.n > 0) else { return };
        let surface: Kind = self.raster.kinds[kind as usize];
        self.shader.shade(surface, None, points, work);
        if self.raster.settings.shading == Mode::Phong {
            let light = |i: usize| [0, 1, 2].map(|c| work.sum[c.min(CHANNELS - 1)][i]);
            match self.raster.settings.space {
                Space::Linear => (0..points.n).for_each(|i| out.write(points.target[i], light(i))),
                Space::Gamma => {
                    (0..points.n).for_each(|i| out.write(points.target[i], self.shader.show(light(i), out.white)));
                }
            }
        }
        for i in 0..if out.hits.is_empty() { 0 } else { points.n } {
            let albedo = self.shader.albedo(surface, points, work, i);
            let face = points.face[i];
            let object = self.raster.prepared.objects[face as usize];
            let aov = aov(points, i, albedo, self.raster.view.eye, object, surface.material);
            out.hits[points.target[i] as usize] = Some(SampleHit { face, aov });
        }
        points.n = 0;
    }
}

/// What all points of a face share.
struct Surface {
    face: u32,
    kind: u32,
    mapped: bool,
    normal: [f32; 3],
    tangent: [f32; 3],
}

impl Surface {
    fn new(job: &BandJob, [face, kind]: [u32; 2], normal: Vec3<f32>) -> Surface {
        let anisotropic = job.needs[kind as usize][1];
        let tangent = if anisotropic { job.raster.prepared.tangent(face as usize) } else { Vec3::ZERO };
        let mapped = job.mapped[kind as usize];
        Surface { face, kind, mapped, normal: normal.to_array(), tangent: tangent.to_array() }
    }

    /// Fills what a point has from its face, and counts it.
    #[inline(always)]
    fn add(&self, points: &mut Points, target: u32) {
        let i = points.n;
        for c in 0..3 {
            points.ng[c][i] = self.normal[c];
            points.tangent[c][i] = self.tangent[c];
        }
        points.target[i] = target;
        points.face[i] = self.face;
        points.n = i + 1;
    }
}

fn waiting(all: &mut [Option<Box<Points>>], kind: u32) -> &mut Points {
    all[kind as usize].get_or_insert_with(Points::new)
}
