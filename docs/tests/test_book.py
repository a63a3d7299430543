"""The parts of the book's build that compute something."""

import re
import sys
import xml.etree.ElementTree as ET
from pathlib import Path

import pytest

sys.path.insert(0, str(Path(__file__).parents[1] / "_ext"))

import gallery_pages
import model_pages
import scene_pages
import svg_math

MODEL = {
    "id": "phong",
    "title": "Phong",
    "year": 1975,
    "paper": "phong1975",
    "doc": "Shiny.\n\n$$ f = k_s $$",
    "parameters": [
        {
            "name": "diffuse",
            "doc": "Share of\nmatte light.",
            "kind": "color",
            "default": [0.5, 0.25, 1.0],
            "range": [0.0, 1.0],
            "unit": "",
        }
    ],
    "claims": [
        {"property": "isotropic", "when": None},
        {"property": "passive", "when": "diffuse <= 1"},
    ],
    "counterexamples": [{"property": "reciprocal", "because": "divides by one cosine"}],
}


def test_a_page_names_the_paper_and_every_parameter():
    page = model_pages.page(MODEL)
    assert "{cite:t}`phong1975`" in page
    assert "| `diffuse` | color | 1 | 0.5, 0.25, 1 | 0 to 1 | Share of matte light. |" in page


def test_a_property_is_claimed_conditional_refuted_or_open():
    holds = {name: text for name, text, _ in model_pages.claim_rows(MODEL)}
    assert holds["isotropic"] == "always"
    assert holds["passive"] == "where `diffuse <= 1`"
    assert holds["reciprocal"] == "no: divides by one cosine"
    assert holds["smooth"] == "not claimed"


def test_a_page_that_did_not_change_is_not_written_again(tmp_path):
    model_pages.write(tmp_path, [MODEL])
    before = (tmp_path / "phong.md").stat().st_mtime_ns
    (tmp_path / "gone.md").touch()
    model_pages.write(tmp_path, [MODEL])
    assert (tmp_path / "phong.md").stat().st_mtime_ns == before
    assert sorted(p.name for p in tmp_path.iterdir()) == ["claims.txt", "index.md", "phong.md"]


@pytest.mark.parametrize("latex", [r"\frac{D\,F\,G}{4\cos\theta_i}", r"\begin{aligned} a &= b \end{aligned}"])
def test_a_formula_is_one_svg_that_carries_its_source(latex):
    svg = ET.fromstring(svg_math.draw(latex, display=True))
    assert svg.tag.endswith("svg")
    assert svg.get("aria-label") == latex


def test_a_fraction_in_a_line_hangs_below_its_baseline():
    style = ET.fromstring(svg_math.draw(r"\frac12", display=False)).get("style")
    assert float(style.removeprefix("vertical-align: ").removesuffix("px")) < 0


def test_every_paper_that_a_source_names_is_in_the_references():
    root = Path(__file__).parents[2]
    known = set(re.findall(r"^@\w+\{(\w+),$", (root / "references.bib").read_text(), re.MULTILINE))
    named = {
        (key, str(source.relative_to(root)))
        for source in root.glob("crates/*/src/**/*.rs")
        for key in re.findall(r"\b[a-z]{4,}(?:1[789]|20)\d\d[a-z]?\b", source.read_text())
    }
    assert {(key, source) for key, source in named if key not in known} == set()


def test_a_figure_of_the_gallery_appears_once():
    figures = {"a": {"title": "A", "caption": "What it shows.", "animated": False}}
    ideas = [
        {"slide": name, "says": "one idea", "figures": ["a"], "commands": [], "open": ""}
        for name in ("First", "Second")
    ]
    page = gallery_pages.gallery(ideas, figures)
    assert page.count("```{figure} a.png") == 1 and page.count("(#figure-a)") == 1
    assert "$ lesk figure a -o a.png" in page


def test_a_row_of_the_errata_has_both_numbers():
    row = {"id": "x", "slide": "S", "difference": "d", "case": "c", "unit": "lm", "slide_value": 680.0}
    page = gallery_pages.errata([{**row, "paper_value": 683.002, "command": "lesk lecture errata x"}])
    assert "| c | 680 lm | 683.002 lm |" in page and page.count("$ lesk lecture errata x") == 1


def test_the_scene_reference_names_every_key_of_the_schema():
    import lesk

    schema = lesk.scene.schema()
    text = scene_pages.reference(schema)

    def names(value):
        if isinstance(value, dict):
            yield from value.get("properties", {})
            yield from (name for inner in value.values() for name in names(inner))
        elif isinstance(value, list):
            yield from (name for inner in value for name in names(inner))

    # parameters of models stand on their own pages
    materials = {name for one in schema["$defs"]["material"]["oneOf"] for name in one["properties"]}
    assert {
        name for name in set(names(schema)) - materials - scene_pages.CHAPTERS.keys() if f"`{name}`" not in text
    } == set()


def test_the_reference_says_what_a_key_accepts():
    assert scene_pages.accepted({"type": "integer", "minimum": 1, "maximum": 256}) == "an integer, 1 to 256"
    assert scene_pages.accepted({"enum": ["a", "b"]}) == "`a`, `b`"
    assert scene_pages.accepted({"type": "array", "items": {"type": "number"}, "minItems": 3}) == "3 numbers"
    assert scene_pages.accepted({"type": "string", "examples": ["1 lm"]}) == 'a quantity like `"1 lm"`'
