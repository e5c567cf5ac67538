"""The code does not grow: each room has a ceiling of lines and of types."""

import sys

import pytest
from repository import ROOT

sys.path.insert(0, str(ROOT / "scripts"))
import size

SLACK = 40  # lines by which a room may be below its ceiling before that goes down


def test_no_room_is_above_its_ceiling():
    now, known = size.sizes(), size.ceilings()
    above = {room: (found, known.get(room)) for room, found in now.items() if not fits(found, known.get(room, (0, 0)))}
    assert not above, "what was added takes the place of something: see scripts/size.py"
    assert fits(map(sum, zip(*(known[room] for room in now))), known["all"])


def fits(found, ceiling):
    return all(count <= most for count, most in zip(found, ceiling))


def test_ceilings_go_down_with_what_is_deleted():
    now, known = size.sizes(), size.ceilings()
    assert {*now, "all"} == set(known), "run scripts/size.py --lower"
    high = {room: most - now[room][0] for room, (most, _) in known.items() if room != "all"}
    assert max(high.values()) <= SLACK, "run scripts/size.py --lower"


@pytest.mark.parametrize(
    ("text", "lines", "types"),
    [
        ("", 0, 0),
        ("// a\n\nint x;  // b\n/* c\nd */ int y;\n", 2, 0),
        ('auto text = "// no comment";\nauto more = R"(a\n// b\n)";\n', 4, 0),
        ("struct A {\n};\nstruct B;\nenum class C { a };\ntemplate <class T>\nclass D final : public A {};\n", 6, 3),
        ("const int k = 1'000'000;  // struct E {\n", 1, 0),
    ],
)
def test_lines_of_cpp(text, lines, types):
    assert size.cpp_size(text) == (lines, types)


@pytest.mark.parametrize(
    ("text", "lines", "types"),
    [
        ("", 0, 0),
        ('"""a\nb"""\n# c\nx = 1  # d\n', 1, 0),
        ('class A:\n    """b"""\n\n    c = """d\n\ne"""\n', 3, 1),
        ("f(\n    1,\n    # no\n    2,\n)\n", 4, 0),
    ],
)
def test_lines_of_python(text, lines, types):
    assert size.python_size(text) == (lines, types)


def test_a_ceiling_only_goes_down():
    now = {"a": (10, 2), "b": (20, 1)}
    assert size.lowered(now, {}) == {"a": (10, 2), "b": (20, 1), "all": (30, 3)}
    known = {"a": (8, 5), "gone": (9, 9), "all": (29, 9)}
    assert size.lowered(now, known) == {"a": (8, 2), "b": (20, 1), "all": (29, 3)}
