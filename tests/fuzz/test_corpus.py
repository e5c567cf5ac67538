"""What once broke something does so no more: the files in corpus, each of the target that its folder is named after."""

from pathlib import Path

import oracle
import pytest
import worker

HERE = Path(__file__).resolve().parent
CORPUS = sorted(path for path in (HERE / "corpus").glob("*/*") if path.parent.name != "operator")


@pytest.mark.parametrize("path", CORPUS, ids=lambda path: f"{path.parent.name}/{path.name}")
def test_a_finding_is_answered(path):
    target = worker.target_named(path.parent.name)
    assert oracle.answer(target.execute, target.load(path))


@pytest.mark.parametrize("name", worker.TARGETS)
def test_a_case_is_kept_as_it_is(name, tmp_path):
    target = worker.target_named(name)
    for number in range(20):
        case = worker.numbered(target, number)
        path = target.save(case, tmp_path / "case")
        content = path.read_bytes()
        assert target.save(target.load(path), tmp_path / "again").read_bytes() == content
