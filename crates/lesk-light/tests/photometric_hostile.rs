//! Hostile luminaire files: whatever the bytes are, reading ends with a result or a message, within 64 MB.

use lesk_light::photometry::{Coordinates, Generation, Photometry, ReadOptions, Web};
use proptest::prelude::*;
use std::alloc::{GlobalAlloc, Layout, System};
use std::cell::Cell;

/// Counts what this thread has allocated now and the most there was: other tests run on other threads meanwhile.
struct Counting;

thread_local! {
    static NOW: Cell<isize> = const { Cell::new(0) };
    static MOST: Cell<isize> = const { Cell::new(0) };
}

fn count(bytes: isize) {
    NOW.set(NOW.get() + bytes);
    MOST.set(MOST.get().max(NOW.get()));
}

// SAFETY: everything is passed on to the system's allocator
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        count(layout.size() as isize);
        // SAFETY: as the caller promises
        unsafe { System.alloc(layout) }
    }

    unsafe fn dealloc(&self, place: *mut u8, layout: Layout) {
        count(-(layout.size() as isize));
        // SAFETY: as the caller promises
        unsafe { System.dealloc(place, layout) }
    }
}

#[global_allocator]
static COUNTING: Counting = Counting;

/// Reads bytes; gives whether they were accepted and how much memory that took, the bytes included.
fn read(bytes: &[u8]) -> (bool, usize) {
    let before = NOW.get();
    MOST.set(before);
    let mut accepted = false;
    for lamp_set in [0, 3] {
        if let Ok(photometry) = Photometry::parse(bytes, ReadOptions { strict: false, lamp_set }) {
            accepted = true;
            assert!(photometry.flux().is_finite() && photometry.flux() >= 0.0);
            assert!(photometry.intensity(0.3, 1.0).is_finite());
        }
        let _ = Photometry::parse(bytes, ReadOptions { strict: true, lamp_set });
    }
    (accepted, (MOST.get() - before) as usize + bytes.len())
}

fn seeds() -> Vec<String> {
    let (v, h) = ([0.0, 30.0, 60.0, 90.0], [0.0, 90.0, 180.0, 270.0, 360.0]);
    let values = (0..20).map(|i| f64::from(i % 4)).collect();
    let photometry = Photometry::new(Web::new(Coordinates::C, v.to_vec(), h.to_vec(), values));
    let mut texts = vec![photometry.to_eulumdat().unwrap()];
    texts.extend(Generation::ALL.map(|generation| photometry.to_ies(generation).unwrap()));
    texts
}

const LIMIT: usize = 64 << 20;

#[test]
fn a_file_cut_anywhere_is_refused_or_read() {
    for text in seeds() {
        assert!(read(text.as_bytes()).0);
        for end in 0..text.len() {
            read(&text.as_bytes()[..end]);
        }
    }
}

#[test]
fn huge_counts_are_refused_before_anything_is_kept() {
    for counts in ["2000000000 2000000000", "16384 32", "524288 1", "1 524288", "1e300 1", "-1 5", "724 724"] {
        let text = format!("IESNA:LM-63-2002\nTILT=NONE\n1 -1 1 {counts} 1 2 0 0 0\n1 1 10\n0 90\n0\n1 1\n");
        let (accepted, memory) = read(text.as_bytes());
        assert!(!accepted && memory < 1 << 20, "{counts}: {memory}");
    }
    let many_lamps = "x\n1\n1\n1\n0\n2\n90\n\n\n\n\n\n".to_string() + &"0\n".repeat(13) + "2000000000\n";
    assert!(!read(many_lamps.as_bytes()).0);
}

#[test]
fn the_largest_files_stay_within_64_mb() {
    // a quadrant of the largest legal table unfolds to four times its size
    let (nv, nh) = (2048, 256);
    let head = format!("IESNA:LM-63-2002\nTILT=NONE\n1 -1 1 {nv} {nh} 1 2 0 0 0\n1 1 10\n");
    let angles = |n: usize| (0..n).map(|i| format!("{}\n", 90.0 * i as f64 / (n - 1) as f64)).collect::<String>();
    let full = head + &angles(nv) + &angles(nh) + &"7\n".repeat(nv * nh);
    let (accepted, memory) = read(full.as_bytes());
    assert!(!accepted, "one value per line and the largest table have too many lines");
    assert!(memory < LIMIT, "{memory}");
    let (accepted, memory) = read(full.replace("7\n7\n", "7 7\n").as_bytes());
    assert!(accepted && memory < LIMIT, "{memory}");
    for filler in ["\n", "[A]\n", "\r", "1 ", ",", "[MORE] x\n", "\u{e9}\n", "TILT=\n"] {
        let mut bytes = format!("IESNA91\n{}", filler.repeat((8 << 20) / filler.len() - 8)).into_bytes();
        for byte in [0xff, b'x'] {
            *bytes.last_mut().unwrap() = byte;
            let (_, memory) = read(&bytes);
            assert!(memory < LIMIT, "{filler:?}: {memory}");
        }
    }
    let (accepted, memory) = read(&vec![b'1'; 9 << 20]);
    assert!(!accepted && memory < 10 << 20, "{memory}");
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(2000))]

    #[test]
    fn any_bytes_end_in_a_result(bytes in prop::collection::vec(any::<u8>(), 0..400)) {
        prop_assert!(read(&bytes).1 < 1 << 20);
    }

    #[test]
    fn mutated_files_end_in_a_result(
        which in 0usize..6,
        edits in prop::collection::vec((any::<prop::sample::Index>(), 0usize..12), 1..12),
    ) {
        const WORDS: [&str; 12] = ["", "-", "nan", "1e308", "\n", ",", "99999999", "0", "\x1a", "[", "TILT=INCLUDE\n1\n2\n0 90\n1 1\n", "\u{feff}"];
        let mut text = seeds().swap_remove(which);
        for (place, word) in edits {
            let mut at = place.index(text.len() + 1);
            while !text.is_char_boundary(at) {
                at -= 1;
            }
            let end = (at..=text.len()).find(|e| *e > at && text.is_char_boundary(*e)).unwrap_or(text.len());
            text.replace_range(at..if word % 2 == 0 { end } else { at }, WORDS[word]);
        }
        prop_assert!(read(text.as_bytes()).1 < 4 << 20);
    }
}
