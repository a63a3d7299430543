//! One band of rows: which face each sample shows, then its light.

use crate::frame::{CLIPPED, Chunk, Raster, SampleHit, aov, corner_light};
use crate::inside::{Row, Triangle, Weighted, unclip};
use crate::lanes::{Points, Work};
use crate::scan::{Band, Crossing};
use crate::settings::Mode;
use crate::shade::{Kind, Shader};
use lesk_bsdf::kernels::BLOCK;
use lesk_math::{CHANNELS, Vec3};
use std::ops::Range;

/// What a thread keeps from band to band.
pub(crate) struct Buffers {
    band: Band,
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
    pub fn new() -> Buffers {
        Buffers {
            band: Band::new(),
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
}

/// Where a band goes.
struct Output<'o> {
    rgb: &'o mut [f32],
    hits: &'o mut [Option<SampleHit>],
}

/// Samples of one row that show the same face.
#[derive(Clone, Copy)]
struct Run {
    y: u32,
    start: u32,
    end: u32,
    /// Sample of the band at which it starts.
    target: u32,
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
        self.cover(buffers, band);
        let mut out = Output { rgb, hits };
        let white = self.white();
        let background = self.shader.background();
        let mut covered = 0;
        for y in rows.clone() {
            let row = buffers.band.row(y);
            let mut x = 0;
            while x < width {
                let id = buffers.band.ids[row.start + x as usize];
                let same = buffers.band.ids[row.clone()][x as usize..].iter().take_while(|&&other| other == id);
                let run = Run { y, start: x, end: x + same.count() as u32, target: row.start as u32 + x };
                x = run.end;
                if id == 0 {
                    for k in 0..run.end - run.start {
                        let light = background.as_ref().map_or([0.0; 3], |f| {
                            let c = f(self.raster.view.world_ray(run.start + k, y));
                            [0, 1, 2].map(|i| c.0[i.min(CHANNELS - 1)])
                        });
                        write(&mut out, run.target + k, self.shader.show(light, white));
                    }
                    continue;
                }
                covered += u64::from(run.end - run.start);
                self.shade_run(buffers, id - 1, run, white, &mut out);
            }
        }
        for kind in 0..self.raster.kinds.len() {
            self.flush(buffers, kind as u32, white, &mut out);
        }
        covered
    }

    fn white(&self) -> f32 {
        if self.raster.settings.classic.as_ref().is_some_and(|c| !c.lights.is_empty()) {
            return 1.0;
        }
        let ev100 = self.raster.scene.film.ev100.unwrap_or(0.0);
        lesk_quantities::exposure::saturation_luminance(ev100) as f32
    }

    /// Decides which face each sample of the band shows.
    fn cover(&self, buffers: &mut Buffers, band: usize) {
        let raster = self.raster;
        let faces = raster.prepared.face_count() as u32;
        for chunk in self.chunks {
            for &entry in &chunk.bins[band] {
                let Buffers { band, corners, crossings, .. } = &mut *buffers;
                if entry & CLIPPED != 0 {
                    let number = entry & !CLIPPED;
                    corners.clear();
                    corners.extend(chunk.clipped[number as usize].corners.iter().map(|c| c.screen));
                    band.polygon(1 + faces + chunk.offset + number, corners, crossings);
                    continue;
                }
                match raster.prepared.face(entry as usize) {
                    &[a, b, c] => band.triangle(1 + entry, [a, b, c].map(|v| raster.screen[v as usize])),
                    face => {
                        corners.clear();
                        corners.extend(face.iter().map(|&v| raster.screen[v as usize]));
                        band.polygon(1 + entry, corners, crossings);
                    }
                }
            }
        }
    }

    fn clipped(&self, number: u32) -> &crate::clip::Clipped {
        let chunk = self.chunks.partition_point(|c| c.offset <= number) - 1;
        &self.chunks[chunk].clipped[(number - self.chunks[chunk].offset) as usize]
    }

    /// Light of the samples of a run: at once where it is known already, else when its block is full.
    fn shade_run(&self, buffers: &mut Buffers, id: u32, run: Run, white: f32, out: &mut Output) {
        let raster = self.raster;
        let faces = raster.prepared.face_count() as u32;
        let clipped = (id >= faces).then(|| self.clipped(id - faces));
        let face = clipped.map_or(id as usize, |c| c.face as usize);
        let mode = raster.settings.shading;
        if mode == Mode::Flat && out.hits.is_empty() {
            let light = self.shader.show(raster.light[face], white);
            (0..run.end - run.start).for_each(|k| write(out, run.target + k, light));
            return;
        }
        let corners = raster.prepared.face(face);
        let surface = Surface::new(self, face);
        let back = mode == Mode::Gouraud && raster.shows_back(corners, clipped);
        if let (&[a, b, c], None, Mode::Phong) = (corners, clipped, mode) {
            self.triangle_run(buffers, [a, b, c], &surface, run, white, out);
            return;
        }
        let triangle = match (corners, clipped) {
            (&[a, b, c], None) => Some(self.triangle([a, b, c], run.y)),
            (_, Some(clipped)) => {
                buffers.row.clipped(clipped, run.y);
                None
            }
            _ => {
                buffers.row.face(&raster.prepared, &raster.screen, face, run.y);
                None
            }
        };
        for k in 0..run.end - run.start {
            let x = run.start + k;
            self.weigh(buffers, corners, triangle.as_ref(), clipped, x, run.y);
            let target = run.target + k;
            if mode == Mode::Phong || !out.hits.is_empty() {
                self.wait(buffers, &surface, target, white, out);
            }
            match mode {
                Mode::Phong => {}
                Mode::Flat => write(out, target, self.shader.show(raster.light[face], white)),
                Mode::Gouraud => {
                    let mut light = [0.0f64; 3];
                    for &(v, w) in &buffers.whole {
                        let own = raster.light[corner_light(v, back)];
                        (0..3).for_each(|c| light[c] += w * f64::from(own[c]));
                    }
                    write(out, target, self.shader.show(light.map(|l| l as f32), white));
                }
            }
        }
    }

    fn triangle(&self, corners: [u32; 3], y: u32) -> Triangle {
        let positions = corners.map(|v| self.raster.prepared.positions[v as usize]);
        Triangle::new(&self.raster.view, positions, y, self.raster.settings.correction)
    }

    /// Vertices with their weights at a sample, into `buffers.whole`.
    fn weigh(
        &self,
        buffers: &mut Buffers,
        corners: &[u32],
        triangle: Option<&Triangle>,
        clipped: Option<&crate::clip::Clipped>,
        x: u32,
        y: u32,
    ) {
        let Buffers { row, weights, whole, .. } = buffers;
        if let (Some(triangle), &[a, b, c]) = (triangle, corners) {
            let [u, v] = triangle.weights(self.raster.view.ray(x, y).x).map(f64::from);
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

    /// The common case, without detours: a triangle in Phong shading.
    fn triangle_run(
        &self,
        buffers: &mut Buffers,
        corners: [u32; 3],
        surface: &Surface,
        run: Run,
        white: f32,
        out: &mut Output,
    ) {
        let data = &self.raster.prepared;
        let triangle = self.triangle(corners, run.y);
        let [p0, p1, p2] = corners.map(|v| data.positions[v as usize].to_array());
        let [n0, n1, n2] = corners.map(|v| data.normals[v as usize].to_array());
        let [t0, t1, t2] = corners.map(|v| data.uvs[v as usize]);
        let mut x = run.start;
        while x < run.end {
            let points = waiting(&mut buffers.waiting, surface.kind);
            let count = (run.end - x).min((BLOCK - points.n) as u32);
            for k in 0..count {
                let [u, v] = triangle.weights(self.raster.view.ray(x + k, run.y).x);
                let i = points.n + k as usize;
                for c in 0..3 {
                    points.p[c][i] = p0[c] + (p1[c] - p0[c]) * u + (p2[c] - p0[c]) * v;
                    points.ns[c][i] = n0[c] + (n1[c] - n0[c]) * u + (n2[c] - n0[c]) * v;
                    points.ng[c][i] = surface.normal[c];
                    points.tangent[c][i] = surface.tangent[c];
                }
                for c in 0..2 {
                    points.uv[c][i] = t0[c] + (t1[c] - t0[c]) * u + (t2[c] - t0[c]) * v;
                }
                points.target[i] = run.target + (x - run.start) + k;
            }
            points.n += count as usize;
            x += count;
            if points.n == BLOCK {
                self.flush(buffers, surface.kind, white, out);
            }
        }
    }

    /// Adds the point of `buffers.whole` to the block of its kind.
    fn wait(&self, buffers: &mut Buffers, surface: &Surface, target: u32, white: f32, out: &mut Output) {
        let data = &self.raster.prepared;
        let points = waiting(&mut buffers.waiting, surface.kind);
        let i = points.n;
        let (mut p, mut n, mut uv) = ([0.0f64; 3], [0.0f64; 3], [0.0f64; 2]);
        for &(v, w) in &buffers.whole {
            let v = v as usize;
            let (position, normal) = (data.positions[v].to_array(), data.normals[v].to_array());
            for c in 0..3 {
                p[c] += w * f64::from(position[c]);
                n[c] += w * f64::from(normal[c]);
            }
            (0..2).for_each(|c| uv[c] += w * f64::from(data.uvs[v][c]));
        }
        for c in 0..3 {
            points.p[c][i] = p[c] as f32;
            points.ns[c][i] = if self.raster.settings.shading == Mode::Flat { surface.normal[c] } else { n[c] as f32 };
            points.ng[c][i] = surface.normal[c];
            points.tangent[c][i] = surface.tangent[c];
        }
        (0..2).for_each(|c| points.uv[c][i] = uv[c] as f32);
        points.target[i] = target;
        points.n += 1;
        if points.n == BLOCK {
            self.flush(buffers, surface.kind, white, out);
        }
    }

    /// Shades the waiting points of a kind.
    fn flush(&self, buffers: &mut Buffers, kind: u32, white: f32, out: &mut Output) {
        let Buffers { waiting, work, .. } = buffers;
        let Some(points) = waiting[kind as usize].as_mut().filter(|p| p.n > 0) else { return };
        let surface: Kind = self.raster.kinds[kind as usize];
        self.shader.shade(surface, None, points, work);
        let phong = self.raster.settings.shading == Mode::Phong;
        for i in 0..points.n {
            if phong {
                let light = [0, 1, 2].map(|c| work.sum[c.min(CHANNELS - 1)][i]);
                write(out, points.target[i], self.shader.show(light, white));
            }
            if let Some(slot) = out.hits.get_mut(points.target[i] as usize) {
                let albedo = self.shader.albedo(surface, points, work, i);
                let face = self.face_at(&buffers.band, points.target[i]);
                let object = self.raster.prepared.objects[face as usize];
                let aov = aov(points, i, albedo, self.raster.view.eye, object, surface.material);
                *slot = Some(SampleHit { face, aov });
            }
        }
        points.n = 0;
    }

    /// The face that a sample of the band shows.
    fn face_at(&self, band: &Band, target: u32) -> u32 {
        let faces = self.raster.prepared.face_count() as u32;
        let id = band.ids[target as usize] - 1;
        if id >= faces { self.clipped(id - faces).face } else { id }
    }
}

/// What all points of a face share.
struct Surface {
    kind: u32,
    normal: [f32; 3],
    tangent: [f32; 3],
}

impl Surface {
    fn new(job: &BandJob, face: usize) -> Surface {
        let data = &job.raster.prepared;
        let kind = job.raster.kind_of[data.objects[face] as usize];
        let [_, anisotropic] = job.shader.needs(job.raster.kinds[kind as usize]);
        let tangent = if anisotropic { data.tangent(face) } else { Vec3::ZERO };
        Surface { kind, normal: data.face_normal(face).map(|x| x as f32).to_array(), tangent: tangent.to_array() }
    }
}

fn waiting(all: &mut [Option<Box<Points>>], kind: u32) -> &mut Points {
    all[kind as usize].get_or_insert_with(Points::new)
}

#[inline]
fn write(out: &mut Output, target: u32, light: [f32; 3]) {
    let at = 3 * target as usize;
    out.rgb[at..at + 3].copy_from_slice(&light);
}
