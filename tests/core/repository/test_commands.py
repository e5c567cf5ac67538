"""The commands of the pages: programs, options and names that they mention exist. Each block of code has a kind. And so
do the names that programs beside the library ask it for."""

import ast
import contextlib
import importlib
import io
import pkgutil
import re
import shlex

import holomorph
import pytest
import tomllib
from holomorph.__main__ import main
from holomorph.batch import recipe
from repository import ROOT

PAGES = sorted(
    str(path.relative_to(ROOT))
    for path in [*(ROOT / "docs").rglob("*.md"), *ROOT.glob("[CR]*.md")]
    if path.parent.name != "site"
)
BLOCK = re.compile(r"^```(\w*)\n(.*?)^```$", re.MULTILINE | re.DOTALL)
INLINE = re.compile(r"`([^`\n]+)`")
# What stands in a block: "python" is run by test_documentation, and an unnamed block after it is what it prints. Other
# unnamed blocks are commands. "py" needs meshes that are not ours; "text" is not code; the others have their own tests.
KINDS = {"", "python", "py", "text", "toml", "yaml", "cmake", "cpp", "math"}
# Commands of other programs, and the tests that run them; or "" where that takes a cluster.
ELSEWHERE = {
    "cmake": "tests/cpp/conftest.py",
    "c++": "tests/cpp/test_consumers.py",
    "build/examples/openmesh_uv": "tests/cpp/test_installed.py",
    "openssl": "tests/batch/test_dask.py",
    "dask": "tests/batch/test_dask.py",
    "export": "tests/batch/test_dask.py",
    "sbatch": "",
}

LIMITS = {"docs/python/verdicts.md"}  # tables of limits


def text_of(page):
    return (ROOT / page).read_text(encoding="utf-8")


def command_lines(page):
    """The commands of a page, in blocks and inside sentences, without their comments."""
    before, found = "", []
    for kind, body in BLOCK.findall(text_of(page)):
        if not kind and before != "python":
            found += re.sub(r"\\\n\s*", " ", body).splitlines()
        before = kind
    starts = ("scripts/", "python ", "holomorph batch", "holomorph compare", "holomorph relief")
    found += [code for code in INLINE.findall(BLOCK.sub("", text_of(page))) if code.startswith(starts)]
    return [re.split(r"\s+# ", line)[0] for line in found if line.strip()]


def helped(arguments):
    """What `python -m holomorph ARGUMENTS --help` prints."""
    written = io.StringIO()
    with contextlib.redirect_stdout(written), pytest.raises(SystemExit):
        main([*arguments, "--help"])
    return written.getvalue()


def described(words):
    """The text in which the options of a command are found: of the program, or of the page that lists them."""
    if words[:3] == ["python", "-m", "holomorph"] or words[0] == "holomorph":
        rest = words[3:] if words[0] == "python" else words[1:]
        return helped([word for word in rest[:1] if word in ("batch", "compare", "relief")])
    if words[0] == "blender":
        return (ROOT / words[words.index("--python") + 1]).exists() and text_of("docs/blender/headless.md")
    path = ROOT / (words[1] if words[0] == "python" else words[0])
    return path.read_text(encoding="utf-8") if path.is_file() else ""


def fault(line):
    """What is wrong with a command, or nothing."""
    words = shlex.split(line)
    if words[:2] == ["pip", "install"]:
        extras = re.findall(r"\[(\w+)\]", line)
        known = tomllib.loads(text_of("pyproject.toml"))["project"]["optional-dependencies"]
        return "" if set(extras) <= set(known) else f"{line}: no such extra"
    if words[:2] == ["blender", "-b"] and "--disable-autoexec" not in words:
        return f"{line}: a .blend file would run its scripts"
    if words[0] in ELSEWHERE:
        test = ELSEWHERE[words[0]]
        return "" if not test or (ROOT / test).is_file() else f"{line}: {test} is gone"
    text = described(words)
    after = words[words.index("--") :] if words[0] == "blender" else words
    missing = [word for word in after if re.fullmatch(r"--\w[\w-]*", word) and word not in text]
    return f"{line}: {missing or 'no such program'}" if missing or not text else ""


@pytest.mark.parametrize("page", PAGES)
def test_commands_are_those_of_programs(page):
    assert {kind for kind, _ in BLOCK.findall(text_of(page))} <= KINDS
    assert not [found for line in command_lines(page) if (found := fault(line))]


def test_a_wrong_command_is_found():
    for line in (
        "scripts/nothing",
        "blender -b --python-exit-code 1 --python addon/headless.py -- a.obj",
        "scripts/test --fast",
        "holomorph batch a --no",
        "pip install 'holomorph[all]'",
        "ls",
    ):
        assert fault(line)


@pytest.mark.parametrize("page", PAGES)
def test_tables_of_numbers_stand_beside_their_command(page):
    """Limits that are chosen are not measured."""
    text = text_of(page)
    cells = re.findall(r"(?<=\|) *~?\d[\d.,]*(?:e-?\d+)? *(?:%|s|ms|MB|GB)? *(?=\|)", text)
    assert len(cells) < 6 or page in LIMITS or re.search(r"(?:scripts|benchmarks|docs)/\w+", text)


@pytest.mark.parametrize("page", PAGES)
def test_recipes_can_be_read(page):
    for kind, body in BLOCK.findall(text_of(page)):
        if kind == "toml":
            recipe.of(tomllib.loads(body))


@pytest.mark.parametrize("page", PAGES)
def test_names_of_the_package_exist(page):
    for code in INLINE.findall(BLOCK.sub("", text_of(page))):
        found = re.match(r"holomorph\.([A-Za-z_][\w.]*)(?:$|\()", code)
        value = holomorph
        for name in found[1].split(".") if found else []:
            if not hasattr(value, name):
                importlib.import_module(f"holomorph.{name}")
            value = getattr(value, name)


def asked_names(text):
    """What a program imports from the library, and the attributes of its module."""
    for node in ast.walk(ast.parse(text)):
        if isinstance(node, ast.ImportFrom) and (node.module or "").startswith("holomorph"):
            yield from (f"{node.module}.{name.name}" for name in node.names)
        elif isinstance(node, ast.Attribute) and re.fullmatch(r"holomorph(\.\w+)+", name := ast.unparse(node)):
            yield name


@pytest.mark.parametrize(
    "program", [*ROOT.glob("benchmarks/*.py"), *ROOT.glob("docs/*.py")], ids=lambda path: path.name
)
def test_programs_ask_for_names_that_exist(program):
    for name in asked_names(program.read_text(encoding="utf-8")):
        pkgutil.resolve_name(name)


def test_a_name_that_is_gone_would_be_found():
    assert list(asked_names("from holomorph.quality import gone\nholomorph.quality.lost()")) == [
        "holomorph.quality.gone",
        "holomorph.quality.lost",
        "holomorph.quality",
    ]
    with pytest.raises(AttributeError):
        pkgutil.resolve_name("holomorph.quality.gone")
