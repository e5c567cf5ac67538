"""The faults of scripts/mutate can be planted: their texts are there, once, and so are their tests."""

import pytest
from repository import ROOT


@pytest.fixture(scope="module")
def mutations():
    with pytest.MonkeyPatch.context() as patch:
        patch.syspath_prepend(ROOT / "scripts")
        from mutations import MUTATIONS
    return MUTATIONS


def test_each_changes_one_text(mutations):
    found = {name: (ROOT / fault.file).read_text().count(fault.old) for name, fault in mutations.items()}
    assert [name for name, count in found.items() if count != 1] == []
    assert all(fault.old != fault.new for fault in mutations.values())


def test_each_has_tests(mutations):
    suites = "".join(path.read_text() for path in (ROOT / "tests" / "native").rglob("*.cpp"))
    for fault in mutations.values():
        assert fault.tests
        for test in fault.tests:
            if test.startswith("native:"):
                assert test.removeprefix("native:").strip("*") in suites
            else:
                assert (ROOT / test.partition("::")[0]).is_file()
