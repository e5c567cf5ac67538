"""What breaks something is found, told apart, made small, and has the same number on every machine."""

import os
import random
import subprocess
import sys
from pathlib import Path

import campaign
import minimise
import numpy as np
import oracle
import pytest
import worker

HERE = Path(__file__).resolve().parent
PLANTED = """
import os, signal, sys
import holomorph
import numpy as np

ENDS = {
    3: lambda: os.kill(os.getpid(), signal.SIGSEGV),
    5: lambda: {}["foreign"],
    7: lambda: np.linalg.inv(np.zeros((2, 2))),
    8: lambda: holomorph.Surface([], []),
    9: lambda: all(True for _ in iter(int, 1)),
}
made = iter(range(10**9))


def make(random):
    return int(sys.argv[3]) + next(made)


def execute(case):
    ENDS.get(case, str)()
"""


@pytest.fixture
def planted(tmp_path, monkeypatch):
    (tmp_path / "target_planted.py").write_text(PLANTED)
    monkeypatch.setenv("PYTHONPATH", os.pathsep.join([str(tmp_path), os.environ.get("PYTHONPATH", ""), *sys.path]))
    monkeypatch.setenv("HOLOMORPH_FUZZ_LIMIT", "1")


def test_whatever_breaks_is_found_and_the_rest_goes_on(planted, capsys):
    tally = campaign.Tally(0)
    for _ in range(5):
        campaign.turn("planted", tally, 0.5)
    kinds = tally.findings
    assert sorted(kinds.values()) == [[3], [5], [7], [9]]
    assert tally.findings["Timeout"] == [9]
    assert any("LinAlgError" in kind for kind in kinds) and any("KeyError" in kind for kind in kinds)
    assert tally.tried == tally.next and tally.tried > 20
    assert tally.answers["InvalidMesh"] == 1
    assert "planted 3:" in capsys.readouterr().out


BROKEN = """
def load(path):
    return path.read_text()


def save(case, stem):
    path = stem.with_suffix(".txt")
    path.write_text(case)
    return path


def smaller(case):
    return (case[:k] + case[k + 1 :] for k in range(len(case)))


def execute(case):
    assert "x" not in case, f"{len(case)} letters"
"""


def test_findings_are_made_small(tmp_path, monkeypatch):
    (tmp_path / "target_broken.py").write_text(BROKEN)
    monkeypatch.setenv("PYTHONPATH", os.pathsep.join([str(tmp_path), os.environ.get("PYTHONPATH", ""), *sys.path]))
    monkeypatch.syspath_prepend(tmp_path)
    kept = minimise.minimised("broken", worker.target_named("broken"), "abxcx", tmp_path / "found")
    assert kept.read_text() == "x"


SAVED = """
import sys
from pathlib import Path
sys.path.insert(0, sys.argv[1])
import worker
target = worker.target_named(sys.argv[2])
for number in range(30):
    print(target.save(worker.numbered(target, number), Path(sys.argv[3], str(number))).read_bytes())
"""


@pytest.mark.parametrize("name", worker.TARGETS)
def test_a_number_is_the_same_input_in_every_process(name, tmp_path):
    command = [sys.executable, "-c", SAVED, str(HERE), name, str(tmp_path)]
    one, other = (
        subprocess.run(command, capture_output=True, check=True, env=os.environ | {"PYTHONHASHSEED": seed}).stdout
        for seed in ("1", "2")
    )
    assert one == other and len(set(one.splitlines())) > 20


# ---- the oracle -----------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("lower", "upper"), [(1.0, 0.9), (np.eye(2), np.diag([1.0, 0.5])), (np.diag([1, 1e-20]), np.diag([1, 0.5e-20]))]
)
def test_bounds_that_cross_are_seen(lower, upper):
    oracle.check_order("bounds", upper, lower)
    with pytest.raises(AssertionError, match="bounds cross"):
        oracle.check_order("bounds", lower, upper)


def test_an_exact_value_outside_is_seen():
    oracle.check_contains("bounds", 1.0, 1.1, 1.05)
    for exact in (0.9, 1.2):
        with pytest.raises(AssertionError, match="without"):
            oracle.check_contains("bounds", 1.0, 1.1, exact)


def test_forms_that_are_not_definite_are_seen():
    assert oracle.is_positive_definite(np.diag([1e-30, 1e30]))
    assert not oracle.is_positive_definite(np.array([[1.0, 2.0], [2.0, 1.0]]))
    assert not oracle.is_positive_definite(np.diag([1.0, np.nan]))


def test_flat_meshes_are_what_they_are_called():
    """Against the areas: no triangle turned over, none missing."""
    import exact_meshes

    for seed in range(30):
        vertices, faces, _, height = exact_meshes.rectangle(random.Random(seed))
        a, b, c = (vertices[np.array(faces)[:, i]] for i in range(3))
        areas = np.cross(b - a, c - a)[:, 2] / 2
        assert (areas >= 0).all() and abs(areas.sum() - height) < 1e-12 * height
