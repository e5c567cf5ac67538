"""What scripts/test says of suites that fail, crash, take too long or cannot run."""

import importlib.machinery
import importlib.util
import os
import re
import subprocess
import sys

import pytest
from repository import ROOT

CRASH = "import faulthandler, os, signal; faulthandler.enable(); os.kill(os.getpid(), signal.SIGSEGV)"
TESTS = "import pytest\ndef test_a(): pass\ndef test_b(): assert 0\ndef test_c(): pytest.skip('no')\n"


@pytest.fixture
def program(monkeypatch, tmp_path):
    monkeypatch.syspath_prepend(ROOT / "scripts")
    loader = importlib.machinery.SourceFileLoader("run_tests", str(ROOT / "scripts" / "test"))
    module = importlib.util.module_from_spec(importlib.util.spec_from_loader("run_tests", loader))
    loader.exec_module(module)
    monkeypatch.setattr(module, "RESULTS", tmp_path)
    return module


@pytest.fixture
def run(program, monkeypatch):
    """run(command, ...): the answer of a suite that has these commands."""

    def run(*commands, with_long=False, **options):
        suite = program.SUITES["lint"]._replace(commands=[list(command) for command in commands], **options)
        monkeypatch.setitem(program.SUITES, "small", suite)
        return program.run("small", with_long)

    return run


def python(code):
    return [sys.executable, "-c", code]


def test_tests_are_counted_and_failed_ones_named(run, tmp_path, capfd):
    (tmp_path / "test_small.py").write_text(TESTS)
    pytest_command = [sys.executable, "-m", "pytest", "-p", "no:cacheprovider", tmp_path / "test_small.py"]
    answer = run([*pytest_command, "--junit-xml", tmp_path / "small.xml"])
    assert answer[:3] == (1, 1, 1) and re.fullmatch(r"small: FAILED \S*test_small::test_b", *answer[3])
    lines = capfd.readouterr().out.splitlines()
    assert lines[0] == answer[3][0] and lines[-1].startswith("small: 1 passed, 1 failed, 1 skipped, ")
    assert (tmp_path / "small.log").read_text().splitlines()[-1] in lines


@pytest.mark.parametrize("with_long", [False, True])
def test_long_tests_are_left_out_of_the_default(run, tmp_path, with_long):
    (tmp_path / "test_small.py").write_text(
        "import pytest\n@pytest.mark.long\ndef test_a(): pass\ndef test_b(): pass\n"
    )
    pytest_command = [sys.executable, "-m", "pytest", "-p", "no:cacheprovider", tmp_path / "test_small.py"]
    answer = run([*pytest_command, "--junit-xml", tmp_path / "small.xml"], with_long=with_long)
    assert answer[:3] == (1 + with_long, 0, 0)


def test_a_line_of_the_log_counts(run):
    assert run(python("print('5 passed, 0 failed')")) == (5, 0, 0, [])
    assert run(python("print('3 passed, 2 failed'); exit(1)"))[:3] == (3, 2, 0)


def test_a_crash_is_a_failure_and_says_where(run, tmp_path):
    folder = tmp_path / "tests"
    folder.mkdir()
    (folder / "test_crash.py").write_text(f"def crash():\n    {CRASH}\n\n\ncrash()\n")
    passed, failed, skipped, lines = run(
        [sys.executable, folder / "test_crash.py"], python("print('5 passed, 0 failed')")
    )
    assert (passed, failed, skipped) == (5, 1, 0)
    assert lines[1] == "small: FAILED     at tests/test_crash.py:2 in crash"
    assert re.fullmatch(r"small: FAILED ended with exit code 139: Segmentation fault", lines[0])


def test_a_suite_that_takes_too_long_is_ended(program, run, monkeypatch):
    monkeypatch.setattr(program, "MINUTES", 0)
    assert run(python("import time; time.sleep(600)")) == (0, 1, 0, ["small: FAILED timed out"])


INTERRUPTED = """
import importlib.machinery, importlib.util, pathlib, sys
sys.path.insert(0, {scripts!r})
loader = importlib.machinery.SourceFileLoader("run_tests", {scripts!r} + "/test")
program = importlib.util.module_from_spec(importlib.util.spec_from_loader("run_tests", loader))
loader.exec_module(program)
program.RESULTS, program.set_up = pathlib.Path({folder!r}), lambda suites: ""
program.SUITES["lint"] = program.SUITES["lint"]._replace(commands=[[sys.executable, "-c", {code!r}]])
sys.argv = ["test", "--suite", "lint"]
program.main()
"""


def test_an_interrupted_run_ends_its_suites(tmp_path):
    pipe = tmp_path / "pipe"  # whose reader sees its end when the last process that has it open is gone
    os.mkfifo(pipe)
    code = f"import time; pipe = open({str(pipe)!r}, 'w'); pipe.write('here'); pipe.flush(); time.sleep(600)"
    program = INTERRUPTED.format(scripts=str(ROOT / "scripts"), folder=str(tmp_path), code=code)
    process = subprocess.Popen([sys.executable, "-c", program], stderr=subprocess.DEVNULL)
    with pipe.open() as reader:
        assert reader.read(4) == "here"
        process.terminate()
        assert reader.read() == ""
    assert process.wait() != 0


def test_no_test_is_a_failure(run, tmp_path):
    assert run(python("")) == (0, 1, 0, ["small: FAILED ran no test"])
    broken = f"open({str(tmp_path / 'small.xml')!r}, 'w').write('<testsuites>')"
    assert run(python(broken))[1] == 1
    assert run(python("exit(7)")) == (0, 1, 0, ["small: FAILED ended with exit code 7"])


def test_what_cannot_run_is_skipped(program, run, monkeypatch):
    monkeypatch.setattr(program, "BLENDER", "no-such-program")
    assert run(python("exit(1)"), blender="needed") == (0, 0, 1, [])
    assert run(python("exit(1)"), python="9.9") == (0, 0, 1, [])
    monkeypatch.setattr(program.shutil, "which", lambda name: None)
    assert run(python("exit(1)"), debian="trixie") == (0, 0, 1, [])


def test_a_debian_that_cannot_be_installed_is_skipped(program, run, monkeypatch, capsys):
    monkeypatch.setattr(program.shutil, "which", lambda name: name)
    monkeypatch.setattr(program.os, "geteuid", lambda: 0)
    monkeypatch.setattr(
        program.subprocess,
        "run",
        lambda command, **_: subprocess.CompletedProcess(command, 0 if command[0] == "unshare" else 1),
    )
    assert run(python("exit(1)"), debian="woody") == (0, 0, 1, [])
    assert capsys.readouterr().out == "small: skipped, Debian woody cannot be installed in a folder now\n"


def test_all_suites_have_a_row(program):
    rows = set(program.SUITES)
    assert set(program.DEFAULT) < set(program.ALL) == rows - set(program.ON_DEMAND)
    assert program.chosen([]) == (program.DEFAULT, False) and program.chosen(["--all"]) == (program.ALL, True)
    assert program.chosen(["--suite", "fuzz", "--suite", "lint"]) == (["fuzz", "lint"], True)
    with pytest.raises(SystemExit, match="2"):
        program.chosen(["--suite", "nothing"])


def test_what_the_sanitizers_run_is_there(program):
    """pytest ends with an error where one of its tests is not."""
    for name in importlib.import_module("suites").SANITIZED:
        path, _, test = name.partition("::")
        assert f"def {test}" in (ROOT / "tests" / "core" / path).read_text("utf-8"), name
