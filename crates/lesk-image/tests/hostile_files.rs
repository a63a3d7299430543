//! Damaged, cut and invented image files: an error or an image, never a panic, and memory in proportion to the file.

use lesk_image::io::{self, png};
use lesk_image::{Image, Planes, Samples, Transfer};
use proptest::prelude::*;
use proptest::test_runner::RngSeed;
use std::alloc::{GlobalAlloc, Layout, System};
use std::cell::Cell;
use std::sync::LazyLock;

/// Memory that one decoding may take: files here are below 64 KiB, and deflate makes at most 1032 bytes of one, which
/// become f32 beside what the decoders hold.
const MAX_MEMORY: isize = 768 << 20;

thread_local! {
    static NOW: Cell<isize> = const { Cell::new(0) };
    static PEAK: Cell<isize> = const { Cell::new(0) };
}

/// Counts the memory of each thread.
struct Counting;

fn count(bytes: isize) {
    let now = NOW.get() + bytes;
    NOW.set(now);
    PEAK.set(PEAK.get().max(now));
}

// SAFETY: passes everything to the system's allocator; the counters are thread-local and take no memory.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        count(layout.size() as isize);
        unsafe { System.alloc(layout) }
    }
    unsafe fn dealloc(&self, ptr: *mut u8, layout: Layout) {
        count(-(layout.size() as isize));
        unsafe { System.dealloc(ptr, layout) }
    }
}

#[global_allocator]
static ALLOCATOR: Counting = Counting;

/// Decodes bytes and checks what came of it.
fn decode(bytes: &[u8]) {
    let before = NOW.get();
    PEAK.set(before);
    for result in [io::decode(bytes), io::exr::decode(bytes).and_then(|planes| planes.picture())] {
        match result {
            Ok(image) => {
                assert_eq!(image.data().len(), image.width() as usize * image.height() as usize * image.channels());
            }
            Err(error) => assert!(error.to_string().len() < 2000),
        }
    }
    let peak = PEAK.get() - before;
    assert!(peak < MAX_MEMORY, "{peak} bytes of memory for {} bytes of file", bytes.len());
}

fn gradient(width: u32, height: u32) -> Image {
    Image::from_fn(width, height, Transfer::Srgb, |x, y| {
        let t = (x * 7 + y * 13) as f32 * 0.1;
        [t.sin().abs(), x as f32 / width as f32, y as f32 / height as f32]
    })
    .unwrap()
}

fn exr_by_crate(compression: exr::prelude::Compression, tiles: Option<usize>) -> Vec<u8> {
    use exr::prelude::*;
    let blocks = tiles.map_or(Blocks::ScanLines, |side| Blocks::Tiles(Vec2(side, side)));
    let encoding = Encoding { compression, blocks, line_order: LineOrder::Increasing };
    let channels = SpecificChannels::rgb(|Vec2(x, y)| (x as f32 * 0.5, f16::from_f32(y as f32), (x * y) as u32));
    let mut bytes = std::io::Cursor::new(Vec::new());
    let image = Image::from_layer(Layer::new((40, 37), LayerAttributes::named("main"), encoding, channels));
    image.write().non_parallel().to_buffered(&mut bytes).unwrap();
    bytes.into_inner()
}

fn exr_of_two_parts() -> Vec<u8> {
    use exr::prelude::*;
    let layer = |name| {
        let channels = SpecificChannels::rgb(|Vec2(x, y)| (x as f32, y as f32, 1.0f32));
        Layer::new((20, 20), LayerAttributes::named(name), Encoding::SMALL_LOSSLESS, channels)
    };
    let mut bytes = std::io::Cursor::new(Vec::new());
    let image = Image::empty(ImageAttributes::with_size((20, 20))).with_layer(layer("one")).with_layer(layer("two"));
    image.write().non_parallel().to_buffered(&mut bytes).unwrap();
    bytes.into_inner()
}

fn own_exr() -> Vec<u8> {
    let mut planes = Planes::new(33, 20).unwrap();
    planes.push_image("", &gradient(33, 20)).unwrap();
    planes.push("id.object", Samples::Uint((0..660).collect())).unwrap();
    planes.push("depth.Z", Samples::Half(vec![0.5; 660])).unwrap();
    planes.attributes = vec![("unit".into(), "cd/m2".into())];
    io::exr::encode(&planes).unwrap()
}

fn jpeg() -> Vec<u8> {
    let mut bytes = Vec::new();
    let rgb: Vec<u8> = gradient(50, 40).data().iter().map(|v| (v * 255.0) as u8).collect();
    image::codecs::jpeg::JpegEncoder::new(&mut bytes).encode(&rgb, 50, 40, image::ExtendedColorType::Rgb8).unwrap();
    bytes
}

/// Good files of every format and kind.
static SEEDS: LazyLock<Vec<Vec<u8>>> = LazyLock::new(|| {
    use exr::prelude::Compression::{self, *};
    let mut seeds = vec![own_exr(), exr_of_two_parts(), jpeg(), io::hdr::encode(&gradient(40, 20)).unwrap()];
    let all: [Compression; 8] = [Uncompressed, RLE, ZIP1, ZIP16, PIZ, PXR24, B44A, DWAA(None)];
    seeds.extend(all.map(|c| exr_by_crate(c, None)));
    seeds.extend([ZIP16, PIZ, DWAB(None)].map(|c| exr_by_crate(c, Some(16))));
    seeds.push(png::encode(&gradient(40, 30), png::Depth::Eight, &[("note", "äöü")]).unwrap());
    seeds.push(png::encode(&gradient(40, 30), png::Depth::Sixteen, &[]).unwrap());
    seeds
});

#[test]
fn good_files_of_every_kind_are_read() {
    for (i, seed) in SEEDS.iter().enumerate() {
        let image = io::decode(seed).unwrap_or_else(|e| panic!("{i}: {e}"));
        assert!(image.count_non_finite() == 0 && seed.len() < 1 << 16, "{i}");
        decode(seed);
    }
}

#[test]
fn files_cut_anywhere_are_refused_or_read() {
    for seed in SEEDS.iter() {
        let step = (seed.len() / 300).max(1);
        (0..seed.len()).step_by(step).for_each(|end| decode(&seed[..end]));
    }
}

/// Replaces bytes at places: single ones, and numbers of four bytes that overflow what reads them.
fn damaged(seed: &[u8], changes: &[(prop::sample::Index, u8, u8)], head: bool) -> Vec<u8> {
    let mut bytes = seed.to_vec();
    for (at, kind, value) in changes {
        // headers are short: half of the cases change them only
        let range = if head { bytes.len().min(500) } else { bytes.len() };
        let at = at.index(range);
        let number: Option<u32> = match kind % 8 {
            0 => Some(0x7fff_ffff),
            1 => Some(0xffff_ffff),
            2 => Some(0x8000_0000),
            3 => Some(u32::from(*value) << 16),
            4 => Some(0),
            _ => None,
        };
        match number {
            Some(number) if at + 4 <= bytes.len() => bytes[at..at + 4].copy_from_slice(&number.to_le_bytes()),
            _ if kind % 8 == 7 => drop(bytes.remove(at)),
            _ if kind % 8 == 6 => bytes.insert(at, *value),
            _ => bytes[at] = *value,
        }
    }
    bytes
}

proptest! {
    // a fixed seed: 1 500 000 cases of a random seed found nothing more
    #![proptest_config(ProptestConfig {
        cases: 3000,
        rng_seed: RngSeed::Fixed(1),
        failure_persistence: None,
        ..ProptestConfig::default()
    })]

    #[test]
    fn damaged_files_are_refused_or_read(
        seed: prop::sample::Index,
        changes in prop::collection::vec((any::<prop::sample::Index>(), 0u8..=255, 0u8..=255), 1..6),
        head: bool,
    ) {
        decode(&damaged(seed.get::<Vec<u8>>(&SEEDS), &changes, head));
    }

    #[test]
    fn noise_behind_a_magic_number_is_refused(
        magic in prop::sample::select(vec![
            &b"\x76\x2f\x31\x01\x02\0\0\0"[..], b"\x89PNG\r\n\x1a\n", b"#?RADIANCE\n\n", b"\xff\xd8\xff\xe0",
        ]),
        noise in prop::collection::vec(0u8..=255, 0..200),
    ) {
        decode(&[magic, &noise].concat());
    }
}
