//! The registry itself: every file has a line, every line a file, every parameter a meaning, every source an entry.

mod common;

use lesk_bsdf::kernels::MAX_PARAMS;
use lesk_bsdf::params::{Kind, flat_len};
use lesk_bsdf::registry;
use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};

fn source(folder: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("src").join(folder)
}

fn files(folder: &str) -> Vec<PathBuf> {
    let entries = fs::read_dir(source(folder)).expect("the sources are here");
    entries.map(|entry| entry.expect("an entry").path()).collect()
}

/// The keys of all entries of the bibliography.
fn bibliography() -> BTreeSet<String> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../references.bib");
    let text = fs::read_to_string(&path).unwrap_or_else(|e| panic!("{}: {e}", path.display()));
    let entry = |line: &str| Some(line.strip_prefix('@')?.split_once('{')?.1.trim_end_matches([',', ' ']).to_owned());
    text.lines().filter_map(entry).collect()
}

/// Words such as `walter2007` or `heitz2014b`.
fn citations(text: &str) -> BTreeSet<String> {
    let words = text.split(|c: char| !c.is_ascii_alphanumeric() && c != '_');
    let is_key = |word: &&str| {
        let name = word.trim_end_matches(|c: char| c.is_ascii_lowercase());
        let letters = name.trim_end_matches(|c: char| c.is_ascii_digit());
        let year = &name[letters.len()..];
        let suffix = word.len() - name.len();
        let authors = letters.len() >= 3 && letters.chars().all(|c| c.is_ascii_lowercase());
        authors && year.len() == 4 && (year.starts_with("1") || year.starts_with("20")) && suffix <= 1
    };
    words.filter(is_key).map(str::to_owned).collect()
}

#[test]
fn every_file_has_a_line_and_every_line_a_file() {
    let in_files: BTreeSet<String> = files("models")
        .iter()
        .map(|path| path.file_stem().expect("a name").to_string_lossy().into_owned())
        .filter(|name| name != "mod")
        .collect();
    let in_list: BTreeSet<String> = registry::all().map(|model| model.id().to_owned()).collect();
    assert_eq!(in_list, in_files);
}

#[test]
fn ids_are_unique_and_find_their_model() {
    let ids: Vec<&str> = registry::all().map(|model| model.id()).collect();
    assert_eq!(ids.iter().collect::<BTreeSet<_>>().len(), ids.len());
    for id in ids {
        assert_eq!(registry::find(id).map(|model| model.id()), Some(id));
        assert!(id.chars().all(|c| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '_'), "{id}");
    }
    assert!(registry::find("no_such_model").is_none());
}

#[test]
fn every_model_has_a_title_a_year_and_claims() {
    for model in registry::all() {
        let facts = model.model();
        assert!(!facts.title.is_empty() && !facts.claims.is_empty(), "{}", model.id());
        assert!((1600..=2100).contains(&facts.year), "{}: {}", model.id(), facts.year);
    }
}

#[test]
fn every_parameter_has_a_text_and_a_default_in_range() {
    for model in registry::all() {
        let mut names = BTreeSet::new();
        for spec in model.specs() {
            let name = format!("{} {}", model.id(), spec.name);
            assert!(names.insert(spec.name), "{name} stands twice");
            assert!(spec.doc.ends_with('.') && spec.doc.len() > 10, "{name}: `{}`", spec.doc);
            let [lo, hi] = spec.range;
            assert!(lo.is_finite() && lo < hi && hi.is_finite(), "{name}: {lo} to {hi}");
            let inside = |x: f64| (lo..=hi).contains(&x);
            assert!(spec.default.iter().all(|&x| inside(x)), "{name}: default {:?}", spec.default);
            assert!(inside(spec.slider[0]) && inside(spec.slider[1]), "{name}: slider {:?}", spec.slider);
            assert!(spec.slider[0] < spec.slider[1], "{name}: slider {:?}", spec.slider);
            assert!(!spec.log || spec.slider[0] > 0.0, "{name}: a logarithmic slider cannot start at 0");
            let defaults = if spec.kind == Kind::Color { vec![1, 3] } else { vec![1] };
            assert!(defaults.contains(&spec.default.len()), "{name}: {} defaults", spec.default.len());
        }
        assert!(flat_len(model.specs()) <= MAX_PARAMS, "{}", model.id());
    }
}

#[test]
fn every_claim_counterexample_and_limit_names_what_exists() {
    for model in registry::all() {
        let facts = model.model();
        let has = |name: &str| model.specs().iter().any(|spec| spec.name == name);
        for example in facts.counterexamples {
            assert!(example.params.iter().all(|(name, _)| has(name)), "{} {example:?}", model.id());
        }
        for limit in facts.limits {
            let other = registry::find(limit.equals).unwrap_or_else(|| panic!("{}: {limit:?}", model.id()));
            let theirs = |name: &str| other.specs().iter().any(|spec| spec.name == name);
            assert!(limit.at.iter().all(|(name, _)| has(name)), "{} {limit:?}", model.id());
            assert!(limit.with.iter().all(|(name, _)| theirs(name)), "{} {limit:?}", model.id());
            assert!(limit.link.iter().all(|(t, ours)| theirs(t) && has(ours)), "{} {limit:?}", model.id());
        }
    }
}

/// A property is claimed, perhaps under a condition, or refuted by a stored counterexample.
#[test]
fn every_property_of_every_model_is_claimed_or_refuted() {
    for model in registry::all() {
        for property in lesk_bsdf::model::Property::ALL {
            let claimed = model.model().claims.iter().any(|claim| claim.property == property);
            let refuted = model.model().counterexamples.iter().any(|example| example.property == property);
            assert!(claimed || refuted, "{} says nothing about {}", model.id(), property.name());
        }
    }
}

#[test]
fn every_citation_is_in_the_bibliography() {
    let known = bibliography();
    for model in registry::all() {
        let paper = model.model().paper;
        assert!(known.contains(paper), "{}: `{paper}` is not in references.bib", model.id());
    }
    for path in files("models").into_iter().chain(files("terms")) {
        let text = fs::read_to_string(&path).expect("readable");
        for key in citations(&text) {
            assert!(known.contains(&key), "{}: `{key}` is not in references.bib", path.display());
        }
    }
}
