"""The command line: what it prints, documented keys, exit statuses."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest

import lesk
from lesk.cli import COMMANDS, main
from lesk.cli.render import duration

SCENES = Path(__file__).parents[2] / "examples" / "scenes"

SCENE = """
version = 1
title = "ball"
[camera]
eye = [0, -4, 1]
target = [0, 0, 0]
fov = "40 deg"
[film]
size = [48, 32]
[materials.ball]
model = "ggx"
alpha_x = 0.3
alpha_y = 0.3
[[objects]]
shape = "sphere"
radius = "1 m"
material = "ball"
[[lights]]
type = "point"
position = [2, -3, 4]
flux = "1000 lm"
[environment]
type = "sky"
luminance = "20 cd/m2"
"""


@pytest.fixture
def scene(tmp_path: Path) -> Path:
    """A small scene file."""
    path = tmp_path / "ball.toml"
    path.write_text(SCENE)
    return path


def output(capsys: pytest.CaptureFixture[str], *words: str, status: int = 0) -> str:
    """Run a command; give its standard output."""
    assert main(list(words)) == status, capsys.readouterr().err
    return capsys.readouterr().out


def lesk_process(*words: str | Path, **more: object) -> subprocess.Popen[str]:
    """Start the command in a process of its own."""
    code = "import sys; from lesk.cli import main; sys.exit(main())"
    command = [sys.executable, "-c", code, *map(str, words)]
    return subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, **more)  # type: ignore[call-overload,no-any-return]


def test_help_lists_every_command(capsys: pytest.CaptureFixture[str]) -> None:
    text = output(capsys, "--help")
    assert all(name in text for name in COMMANDS)


@pytest.mark.parametrize("name", COMMANDS)
def test_every_command_has_help(name: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert "--json" in output(capsys, name, "--help")


def test_version_names_the_instruction_set(capsys: pytest.CaptureFixture[str]) -> None:
    assert output(capsys, "--version").split()[1] == lesk.__version__


def test_models_as_json_has_the_documented_keys(capsys: pytest.CaptureFixture[str]) -> None:
    data = json.loads(output(capsys, "models", "--json"))
    assert data["version"] == 1 and len(data["models"]) == 16
    for model in data["models"]:
        assert {"id", "title", "year", "paper", "parameters", "claims"} <= model.keys()


def test_eval_gives_the_published_value(capsys: pytest.CaptureFixture[str]) -> None:
    # models.md 4.90, geometry A: GGX aniso .2/.4 correlated, F = 1
    words = ["eval", "ggx", "--set", "alpha_x=0.2", "--set", "alpha_y=0.4", "--wi", "30,0", "--wo", "50,140", "--json"]
    data = json.loads(output(capsys, *words))
    assert data["version"] == 1 and {"f", "pdf", "albedo", "delta"} <= data.keys()
    assert data["f"] == pytest.approx([0.69615512] * 3, abs=5e-9)


def test_eval_lists_the_delta_lobes_of_glass(capsys: pytest.CaptureFixture[str]) -> None:
    data = json.loads(output(capsys, "eval", "dielectric", "--wo", "0,0", "--json"))
    weights = sorted(lobe["weight"][0] for lobe in data["delta"])
    # normal incidence, n = 1.5: R = 0.04; radiance leaving the denser side scales by 1/n^2
    assert weights == pytest.approx([0.04, 0.96 / 2.25], rel=1e-12)


@pytest.mark.parametrize(
    ("words", "hint"),
    [
        (["evl"], "did you mean `eval`?"),
        (["eval", "gxg"], "did you mean `ggx`?"),
        (["eval", "ggx", "--set", "alpha=1"], "did you mean `alpha_y`?"),
        (["eval", "ggx", "--set", "alpha_x=7"], "accepts 0.001 to 1"),
        (["eval", "ggx", "--set", "alpha_x"], "has no value"),
        (["eval", "ggx", "--wi", "30"], "polar angle and an azimuth"),
        (["shader", "ggx", "--to", "cg"], "`wgsl`"),
        (["render", "missing.toml", "-o", "a.exr"], "missing.toml"),
        (["render", "missing.toml", "-o", "a.tiff"], ".exr, .png, .hdr are accepted"),
        (["render", "missing.toml", "-o", "a.png", "--tonemap", "neutrl"], "did you mean `neutral`?"),
        (["render", "missing.toml", "-o", "a.png", "--ev100", "nan"], "-50 to 50 is accepted"),
        (["render", "missing.toml", "-o", "no/such/folder/a.png"], "make the folder first"),
        (["render", "missing.toml", "-o", "a.exr", "--time", "-1"], "`time` is -1"),
        (["render", "missing.toml", "-o", "a.exr", "--resume"], "there is no checkpoint `a.checkpoint`"),
        (["check", "lambert", "--html", "no/such/folder/a.html"], "make the folder first"),
        (["shader", "ggx", "-o", "no/such/folder/a.glsl"], "make the folder first"),
        (["plot", "ggx", "--kind", "polr"], "did you mean `polar`?"),
        (["eval", "ggx", "--wi", "nan,0"], "finite angles are accepted"),
        (["scene", "chek"], "did you mean `check`?"),
        (["models", "--nonsense"], "--help"),
    ],
)
def test_bad_input_is_status_2_with_a_hint(words: list[str], hint: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(words) == 2
    captured = capsys.readouterr()
    assert captured.out == ""
    assert captured.err.startswith("error: ") and hint in captured.err


def test_check_of_a_model_holds(capsys: pytest.CaptureFixture[str]) -> None:
    data = json.loads(output(capsys, "check", "lambert", "--json"))
    assert data["passed"] is True and data["models"][0]["id"] == "lambert"


def test_shader_is_text_on_standard_output(capsys: pytest.CaptureFixture[str]) -> None:
    assert "vec3 ggx_eval(vec3 wi, vec3 wo" in output(capsys, "shader", "ggx", "--to", "glsl")


@pytest.mark.parametrize("path", sorted(SCENES.glob("*.toml")), ids=lambda path: path.stem)
def test_example_scenes_are_right(path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert "fine" in output(capsys, "scene", "check", str(path))


def test_all_faults_of_a_scene_are_told_at_once(scene: Path, capsys: pytest.CaptureFixture[str]) -> None:
    scene.write_text(SCENE.replace("alpha_x = 0.3", "alpha_x = 3").replace("1000 lm", "1000 lx"))
    assert main(["scene", "check", str(scene)]) == 2
    text = capsys.readouterr().err
    assert "`alpha_x` is 3" in text and "`1000 lx`" in text and "ball.toml:" in text


def test_render_writes_the_same_bytes_twice(scene: Path, tmp_path: Path) -> None:
    for name in ("a.exr", "b.exr"):
        assert main(["render", str(scene), "-o", str(tmp_path / name), "--spp", "3", "--quiet"]) == 0
    assert (tmp_path / "a.exr").read_bytes() == (tmp_path / "b.exr").read_bytes()


def test_layers_and_picture_can_be_read_back(scene: Path, tmp_path: Path) -> None:
    path = tmp_path / "a.exr"
    words = ["--spp", "2", "--quiet", "--aovs", "--split", "direct,indirect"]
    assert main(["render", str(scene), "-o", str(path), *words]) == 0
    layers, attributes = lesk.image.read_layers(path)
    assert {"R", "variance.R", "direct.R", "indirect.B", "albedo.G", "depth.Z", "id.object"} <= layers.keys()
    assert attributes["unit"] == "cd/m2"
    assert not any("host" in key.lower() or "time" in key.lower() for key in attributes)
    assert lesk.image.read(path).shape == (32, 48, 3)


def test_failed_write_keeps_the_previous_picture(
    scene: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    full = tmp_path / "full.png"
    full.symlink_to("/dev/full")
    assert main(["render", str(scene), "-o", str(full), "--spp", "1", "--quiet"]) == 2
    assert "no space left on device" in capsys.readouterr().err


def test_killed_render_resumes_to_the_same_bytes(scene: Path, tmp_path: Path) -> None:
    whole, resumed, state = tmp_path / "whole.exr", tmp_path / "resumed.exr", tmp_path / "state"
    spp = 400
    assert main(["render", str(scene), "-o", str(whole), "--spp", str(spp), "--quiet"]) == 0
    words = ["render", scene, "-o", resumed, "--spp", str(spp), "--checkpoint", state]
    process = lesk_process(*words, "--checkpoint-every", "0.02", "--threads", "1")
    deadline = time.monotonic() + 60
    while not state.exists() and process.poll() is None and time.monotonic() < deadline:
        time.sleep(0.005)
    process.kill()
    process.communicate()
    assert state.exists() and not resumed.exists(), "the render was killed while it ran"
    assert main([*map(str, words), "--resume", "--quiet"]) == 0
    assert resumed.read_bytes() == whole.read_bytes()


def test_checkpoint_of_another_picture_is_refused(
    scene: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    state = tmp_path / "state"
    with pytest.raises(lesk.RenderInterrupted):
        lesk.render(scene, spp=100_000, checkpoint=state, progress=_interrupt)
    words = ["render", str(scene), "-o", str(tmp_path / "a.exr"), "--checkpoint", str(state), "--resume", "--seed", "5"]
    assert main(words) == 2
    assert "`seed` is `0` in it and `5` now" in capsys.readouterr().err


def _interrupt(_: lesk.Progress) -> None:
    raise KeyboardInterrupt


def test_ctrl_c_keeps_what_is_done(scene: Path, tmp_path: Path) -> None:
    path = tmp_path / "a.exr"
    process = lesk_process("render", scene, "-o", path, "--spp", "1000000")
    time.sleep(3)
    os.kill(process.pid, signal.SIGINT)
    start = time.monotonic()
    _, errors = process.communicate(timeout=30)
    assert time.monotonic() - start < 5
    assert process.returncode == 130 and "interrupted" in errors
    assert np.isfinite(lesk.image.read(path)).all()


def test_times_left_are_told_as_people_do():
    told = [duration(seconds) for seconds in (0.4, 42, 99.4, 99.6, 5999, 12_000)]
    assert told == ["0 s", "42 s", "99 s", "2 min", "1 h 40 min", "3 h 20 min"]


def test_nothing_but_the_data_goes_to_standard_output(scene: Path, tmp_path: Path) -> None:
    process = lesk_process("render", scene, "-o", tmp_path / "a.png", "--spp", "1", "--json")
    out, _ = process.communicate(timeout=60)
    assert process.returncode == 0
    assert {"version", "output", "ended", "seconds", "ev100", "relative_error"} <= json.loads(out).keys()
