"""`lesk plot`, in this process: files, exit status and messages."""

from __future__ import annotations

import json

import pytest

from lesk.cli import main


@pytest.mark.parametrize(
    ("words", "ending"),
    [
        (["ggx", "--set", "alpha_x=0.3"], "png"),
        (["lambert", "--kind", "albedo", "--compare", "oren_nayar"], "svg"),
        (["ndf.ggx", "--set", "alpha_x=0.1,0.3"], "svg"),
    ],
)
def test_a_plot_is_written_and_named(words, ending, tmp_path, capsys):
    path = tmp_path / f"plot.{ending}"
    assert main(["plot", *words, "-o", str(path)]) == 0
    assert path.stat().st_size > 1000
    assert capsys.readouterr().out.strip() == str(path)


def test_json_says_what_was_drawn(tmp_path, capsys):
    path = tmp_path / "plot.svg"
    assert main(["plot", "ggx", "-o", str(path), "--json"]) == 0
    answer = {"version": 1, "output": str(path), "kind": "polar", "name": "ggx"}
    assert json.loads(capsys.readouterr().out) == answer


@pytest.mark.parametrize(
    ("words", "text"),
    [
        (["gxg"], "did you mean `ggx`?"),
        (["ggx", "--kind", "pie"], "`--kind` is `pie`"),
        (["ggx", "-o", "plot.bmp"], "`plot.bmp` ends in `.bmp`, but .png and .svg are accepted"),
        (["ggx", "--kind", "slice", "--compare", "ward"], "shows one model"),
        (["ggx", "-o", "no/such/folder/plot.png"], "cannot write `no/such/folder/plot.png`: there is no folder"),
    ],
)
def test_wrong_use_exits_2_and_explains(words, text, capsys, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    assert main(["plot", *words]) == 2
    said = capsys.readouterr()
    assert said.err.startswith("error: ") and text in said.err and said.out == ""
