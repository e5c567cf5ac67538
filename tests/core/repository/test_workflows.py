"""The workflows run suites and scripts that exist, and all of them at least once a week."""

import re

import pytest
from repository import ROOT

FOLDER = ROOT / ".github"
WORKFLOWS = sorted(FOLDER.rglob("*.yml"))
ON_PUSH = {"lint", "native", "core", "asan", "blender-3.4", "bpy-5.2"}
ELSEWHERE = {"platforms"}  # has a workflow of its own, on the systems themselves


@pytest.fixture
def suites(monkeypatch):
    monkeypatch.syspath_prepend(ROOT / "scripts")
    import suites

    return suites


def job(name):
    """The text of a job of the workflow of the tests."""
    text = (FOLDER / "workflows" / "tests.yml").read_text(encoding="utf-8")
    return re.search(rf"^  {name}:\n((?:(?:    .*)?\n)+)", text, re.MULTILINE)[1]


def named(name):
    return re.split(r",\s+", re.search(r"suite: \[([^]]*)\]", job(name))[1])


def test_suites_exist_and_each_runs_every_week(suites):
    push, weekly = named("push"), named("weekly")
    assert set(push) == ON_PUSH and "schedule" in job("weekly") and "if:" not in job("push")
    assert sorted(push + weekly) == sorted(set(suites.SUITES) - ELSEWHERE)


def test_scripts_exist():
    called = {name for path in WORKFLOWS for name in re.findall(r"scripts/[\w.-]+", path.read_text(encoding="utf-8"))}
    assert {"scripts/test", "scripts/package-extension"} <= called
    assert not [name for name in called if not (ROOT / name).exists()]


def test_actions_of_the_repository_exist():
    used = [use for path in WORKFLOWS for use in re.findall(r"uses: \./(\S+)", path.read_text(encoding="utf-8"))]
    assert used and all((ROOT / use / "action.yml").exists() for use in used)
