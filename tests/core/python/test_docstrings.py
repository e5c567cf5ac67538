"""The docstring of each public function: an example that runs, what is raised, and where the method is from."""

import doctest
import inspect
import pydoc
import re

import holomorph
import numpy as np
import pytest
from repository import ROOT

FUNCTIONS = [name for name in dir(holomorph) if inspect.isfunction(getattr(holomorph, name))]
PARSER = doctest.DocTestParser()
MOST_LINES = 400


def run(name, text):
    """Runs the examples of a docstring, and returns how many there are."""
    found = PARSER.get_doctest(text, {"holomorph": holomorph, "np": np}, name, None, 0)
    written = []
    assert not doctest.DocTestRunner().run(found, out=written.append).failed, "".join(written)
    return len(found.examples)


@pytest.fixture(autouse=True)
def in_the_repository(monkeypatch):
    monkeypatch.chdir(ROOT)


@pytest.mark.parametrize("name", FUNCTIONS)
def test_the_example_runs(name):
    assert run(name, inspect.getdoc(getattr(holomorph, name))) >= 1


@pytest.mark.parametrize("name", FUNCTIONS)
def test_what_is_raised_and_the_source_are_told(name):
    text = inspect.getdoc(getattr(holomorph, name))
    assert re.search(r"\bRaises\b", text)
    source = re.search(r"^Source: (.*)$", text, re.MULTILINE)
    assert source and all((ROOT / page).exists() for page in re.findall(r"docs/[\w/-]+\.md", source[1]))


def test_help_fits_on_some_screens_and_names_all_that_is_public():
    assert len(pydoc.render_doc(holomorph, renderer=pydoc.plaintext).splitlines()) < MOST_LINES
    contents = holomorph.__doc__.partition("Contents.")[2]
    assert set(dir(holomorph)) - {"__version__"} <= set(re.findall(r"\w+", contents))


def test_the_example_of_the_package_runs():
    assert run("holomorph", holomorph.__doc__) >= 3
    assert len(FUNCTIONS) > 25
