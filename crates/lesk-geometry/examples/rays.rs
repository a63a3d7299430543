//! Rays per second on noise-displaced spheres of 82 thousand and 1.3 million triangles, one thread: each ray alone, and 256
//! at once.
//!
//! `cargo run --release -p lesk-geometry --example rays [DIR]`: with a folder, meshes, rays and distances are also
//! written there, as plain little-endian numbers for other ray casters to read: `mesh_M.bin` (u32 vertex count, u32
//! triangle count, f32 positions, u32 indices), `rays_M_K.bin` (u32 count, f32 origin and direction each) and
//! `t_M_K.bin` (f32 distance each, infinite for a miss).

use lesk_geometry::{Caster, Geometry, Mesh, MeshData, Ray, Transform, World, WorldBuilder, icosphere};
use lesk_math::{Frame, Isa, Vec3, vec3};
use std::path::Path;
use std::sync::Arc;
use std::time::Instant;

/// A number in [0, 1) that depends on `i` and `k` only (integer hash: Wellons' lowbias32).
fn hash(i: u32, k: u32) -> f32 {
    let mut x = i.wrapping_mul(0x9e37_79b9) ^ k.wrapping_mul(0x85eb_ca6b);
    x = (x ^ (x >> 16)).wrapping_mul(0x7feb_352d);
    x = (x ^ (x >> 15)).wrapping_mul(0x846c_a68b);
    ((x ^ (x >> 16)) >> 8) as f32 / (1 << 24) as f32
}

/// Seven octaves of sums of sines along random directions.
fn displacement(p: Vec3<f64>) -> f64 {
    let (mut frequency, mut amplitude, mut sum) = (2.0, 0.25, 0.0);
    for octave in 0..7u32 {
        for wave in 0..6 {
            let r = |k| 2.0 * hash(6 * octave + wave, k) as f64 - 1.0;
            let direction = vec3(r(0), r(1), r(2)).normalize();
            sum += amplitude / 6.0 * (frequency * direction.dot(p) + std::f64::consts::PI * r(3)).sin();
        }
        frequency *= 2.1;
        amplitude *= 0.55;
    }
    sum
}

fn displaced_sphere(level: u32) -> Mesh {
    let MeshData { positions, triangles, .. } = icosphere(level).into_data();
    let moved = |p: &Vec3<f32>| {
        let wide = p.map(f64::from);
        (wide * (1.0 + displacement(wide))).map(|x| x as f32)
    };
    let data = MeshData { positions: positions.iter().map(moved).collect(), triangles, ..MeshData::default() };
    Mesh::new(data).expect("displaced vertices are finite").0
}

/// 1024 x 1024 rays from (0, 0, 4) in tiles of 8 x 8.
fn primary_rays() -> Vec<Ray> {
    let side = 1024;
    let ray = |i: usize| {
        let (tile, inside) = (i / 64, i % 64);
        let x = 8 * (tile % (side / 8)) + inside % 8;
        let y = 8 * (tile / (side / 8)) + inside / 8;
        let at = |v: usize| ((v as f32 + 0.5) / side as f32 * 2.0 - 1.0) * 0.4;
        Ray::new(vec3(0.0, 0.0, 4.0), vec3(at(x), at(y), -1.0).normalize())
    };
    (0..side * side).map(ray).collect()
}

/// One cosine-distributed ray per hit of a primary ray.
fn bounce_rays(world: &World, primary: &[Ray]) -> Vec<Ray> {
    let mut rays = Vec::new();
    for (i, ray) in primary.iter().enumerate() {
        let Some(hit) = world.intersect(ray) else { continue };
        let surface = world.surface(ray, &hit);
        let (u, phi) = (hash(i as u32, 1), hash(i as u32, 2) * std::f32::consts::TAU);
        let local = vec3(u.sqrt() * phi.cos(), u.sqrt() * phi.sin(), (1.0 - u).sqrt());
        rays.push(Ray::leaving(&surface, Frame::from_normal(surface.ng).world_from_local(local)));
    }
    rays
}

/// Seconds that this thread has run, where Linux tells; elsewhere wall time, in which other programs count too.
fn now(start: &Instant) -> f64 {
    let told = std::fs::read_to_string("/proc/thread-self/schedstat").ok();
    let nanoseconds = told.and_then(|text| text.split_whitespace().next()?.parse::<f64>().ok());
    nanoseconds.map_or_else(|| start.elapsed().as_secs_f64(), |ns| ns * 1e-9)
}

/// How many rays are cast at once: those of a wave of the path tracer.
const TOGETHER: usize = 256;

/// Median and best millions of rays per second of seven runs; `cast` gives the number of hits.
fn rate(rays: &[Ray], mut cast: impl FnMut(&[Ray]) -> usize) -> (f64, f64, usize) {
    let mut seconds = Vec::new();
    let mut hits = 0;
    let zero = Instant::now();
    for _ in 0..7 {
        let start = now(&zero);
        hits = rays.chunks(TOGETHER).map(&mut cast).sum();
        seconds.push(now(&zero) - start);
    }
    seconds.sort_by(f64::total_cmp);
    let per_second = |s: f64| rays.len() as f64 / s * 1e-6;
    (per_second(seconds[3]), per_second(seconds[0]), hits)
}

fn write(path: &Path, head: &[u32], body: impl Iterator<Item = [u8; 4]>) -> std::io::Result<()> {
    let mut bytes: Vec<u8> = head.iter().flat_map(|x| x.to_le_bytes()).collect();
    bytes.extend(body.flatten());
    std::fs::write(path, bytes)
}

fn write_mesh(path: &Path, mesh: &Mesh) -> std::io::Result<()> {
    let head = [mesh.positions().len() as u32, mesh.triangles().len() as u32];
    let positions = mesh.positions().iter().flat_map(|p| p.to_array()).map(f32::to_le_bytes);
    let indices = mesh.triangles().iter().flatten().map(|i| i.to_le_bytes());
    write(path, &head, positions.chain(indices))
}

fn write_rays(folder: &Path, suffix: &str, world: &World, rays: &[Ray]) -> std::io::Result<()> {
    let numbers = rays.iter().flat_map(|r| [r.o.to_array(), r.d.to_array()]).flatten();
    write(&folder.join(format!("rays_{suffix}.bin")), &[rays.len() as u32], numbers.map(f32::to_le_bytes))?;
    let t = rays.iter().map(|r| world.intersect(r).map_or(f32::INFINITY, |h| h.t).to_le_bytes());
    write(&folder.join(format!("t_{suffix}.bin")), &[], t)
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let folder = std::env::args().nth(1);
    println!("instruction set {}", Isa::current().name());
    for (name, level) in [("70k", 6), ("1M", 8)] {
        let mesh = Arc::new(displaced_sphere(level));
        let start = Instant::now();
        let mut builder = WorldBuilder::new();
        let geometry = builder.geometry(Geometry::Mesh(mesh.clone()));
        builder.instance(geometry, Transform::IDENTITY)?;
        let world = builder.build()?;
        let (triangles, bytes) = (mesh.triangles().len(), world.tree_bytes());
        let per_triangle = bytes / triangles;
        println!("{triangles} triangles: built in {:.3} s, {per_triangle} bytes each", start.elapsed().as_secs_f64());
        let primary = primary_rays();
        let bounce = bounce_rays(&world, &primary);
        for (kind, rays) in [("primary", &primary), ("bounce", &bounce)] {
            let (mut caster, mut found, mut occluded) = (Caster::default(), vec![], vec![]);
            let alone = rate(rays, |rays| rays.iter().filter(|r| world.intersect(r).is_some()).count());
            let together = rate(rays, |rays| {
                world.intersect_all(rays, &mut caster, &mut found);
                found.iter().flatten().count()
            });
            let alone_any = rate(rays, |rays| rays.iter().filter(|r| world.occluded(r)).count());
            let together_any = rate(rays, |rays| {
                world.occluded_all(rays, &mut caster, &mut occluded);
                occluded.iter().filter(|is| **is).count()
            });
            let share = 100 * alone.2 / rays.len();
            println!("  {kind}: {share} % hit; Mrays/s");
            for (query, (median, best, hits)) in
                [("nearest alone", alone), ("nearest", together), ("any alone", alone_any), ("any", together_any)]
            {
                assert_eq!(hits, alone.2, "{kind} {query}");
                println!("    {query:13} {median:6.2} (best {best:.2})");
            }
            if let Some(folder) = &folder {
                write_rays(Path::new(folder), &format!("{name}_{kind}"), &world, rays)?;
            }
        }
        if let Some(folder) = &folder {
            write_mesh(&Path::new(folder).join(format!("mesh_{name}.bin")), &mesh)?;
        }
    }
    Ok(())
}
