"""A batch that is killed at each step of what it writes: results are whole, and the same command goes on."""

import os
import subprocess
from pathlib import Path

import pytest
from batch_runs import SECONDS, command, outputs, run, statuses, torus_obj

KILLING = Path(__file__).with_name("killing")
RECIPE = "[maps]\nmain = 'balanced'\n[levels]\nlevels = 1\n[output]\nformats = ['obj', 'glb']\n"
CRASHED = {"torus.obj": "crashed"}
MOST = 60  # steps, more than there are


@pytest.fixture
def arguments(tmp_path):
    (tmp_path / "recipe.toml").write_text(RECIPE)
    (tmp_path / "source").mkdir()
    torus_obj(tmp_path / "source" / "torus.obj")
    return tmp_path / "source", "--recipe", tmp_path / "recipe.toml", "--workers", 1


def killed(step, who, arguments, out):
    """The exit status."""
    paths = os.pathsep.join([str(KILLING), os.environ.get("PYTHONPATH", "")])
    planted = {"HOLOMORPH_TEST_STEP": str(step), "HOLOMORPH_TEST_FOLDER": str(out), "HOLOMORPH_TEST_KILLED": who}
    environment = os.environ | planted | {"PYTHONPATH": paths}
    call = command(*arguments, "--out", out, "--retry")
    return subprocess.run(call, env=environment, capture_output=True, timeout=SECONDS).returncode


@pytest.mark.parametrize("who", ["worker", "run"])
def test_killed_at_each_step(who, arguments, tmp_path):
    """With results of another recipe there already: they stay, or the new ones are there, or a record of crashes."""
    source, option, recipe, *rest = arguments
    out, new = tmp_path / "out", tmp_path / "new"
    assert run(*arguments, "--out", new).returncode == 0
    expected = outputs(new)
    (tmp_path / "old.toml").write_text(RECIPE + "[tiling]\ntiles = 3\n")
    assert run(source, option, tmp_path / "old.toml", *rest, "--out", out).returncode == 0
    old, steps = outputs(out), 0
    while steps < MOST and killed(steps, who, arguments, out) != 0:
        assert outputs(out, is_killed=True) in (old, expected) or (who, statuses(out)) == ("worker", CRASHED)
        assert (out / "index.html").read_bytes().rstrip().endswith(b"</html>")
        assert (out / "summary.csv").read_bytes().count(b"\n") == 2
        steps += 1
    assert 3 < steps < MOST
    assert run(*arguments, "--out", out, "--retry").returncode == 0
    assert outputs(out) == expected
