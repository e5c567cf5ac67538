"""How the command ends: by one sentence and a status that is documented, whatever is closed, full, short or pressed."""

import os
import subprocess
import sys

import families
import pytest
from holomorph.commands.console import INTERRUPTED
from repository import SUPPORT
from solved import surface_of

pytestmark = pytest.mark.skipif(sys.platform != "linux", reason="signals, devices and limits of Linux")
INTERRUPTING = SUPPORT / "interrupting"
SECONDS = 120


@pytest.fixture(scope="module")
def mesh(tmp_path_factory):
    path = tmp_path_factory.mktemp("mesh") / "torus.obj"
    surface_of(families.torus(12, 8)).write(path)
    return path


def run(*arguments, **options):
    """The finished process; its error stream as text."""
    command = [sys.executable, "-m", "holomorph", *map(str, arguments)]
    return subprocess.run(command, stderr=subprocess.PIPE, text=True, timeout=SECONDS, **options)


def assert_one_sentence(done, status, words):
    assert done.returncode == status, done.stderr
    (line,) = done.stderr.splitlines()
    assert line.startswith("holomorph: ") and words in line


@pytest.mark.parametrize("encoding", ["cp1252", "ascii", "cp932"])
@pytest.mark.parametrize("name", ["\u7acb", "\u00fc", "\U0001f9ca"])
def test_letters_that_the_console_lacks_are_escaped(name, encoding, mesh, tmp_path):
    path = tmp_path / f"{name}.obj"
    path.write_bytes(mesh.read_bytes())
    environment = os.environ | {"PYTHONIOENCODING": encoding}
    done = run(path, "--output", tmp_path / "o.glb", env=environment, stdout=subprocess.PIPE, encoding=encoding)
    assert done.returncode == 0 and not done.stderr and (tmp_path / "o.glb").exists()
    wanted = name.encode(encoding, "backslashreplace").decode(encoding)
    assert f"{wanted}.obj: " in done.stdout
    done = run(
        "batch",
        path,
        "--out",
        tmp_path / name,
        "--workers",
        "1",
        env=environment,
        stdout=subprocess.PIPE,
        encoding=encoding,
    )
    assert done.returncode == 0 and "1 done" in done.stdout


@pytest.mark.parametrize(
    "when",
    [
        "numpy",
        "holomorph._native",
        "holomorph.mesh.surface",
        "holomorph.batch.mapping",
        "holomorph.commands.console",
        "zlib",
    ],
)
def test_interrupted_while_it_starts(when, mesh):
    """At the import of a module, the last of which NumPy needs."""
    environment = os.environ | {"HOLOMORPH_TEST_INTERRUPT": when}
    environment["PYTHONPATH"] = os.pathsep.join([str(INTERRUPTING), os.environ.get("PYTHONPATH", "")])
    assert_one_sentence(run(mesh, env=environment, stdout=subprocess.DEVNULL), INTERRUPTED, "interrupted")


def test_interrupted_while_it_ends(mesh, tmp_path):
    """Everything is done: it ends as if nothing had happened."""
    environment = os.environ | {"HOLOMORPH_TEST_INTERRUPT": "cpython._PySys_ClearAuditHooks"}
    environment["PYTHONPATH"] = os.pathsep.join([str(INTERRUPTING), os.environ.get("PYTHONPATH", "")])
    done = run(mesh, "--report", tmp_path / "report.json", env=environment)
    assert done.returncode == 0 and not done.stderr and (tmp_path / "report.json").stat().st_size


def test_the_program_that_imports_the_package_keeps_its_signals_and_environment():
    before = "import os, signal; before = signal.getsignal(signal.SIGINT), dict(os.environ); import holomorph; "
    check = before + "assert before == (signal.getsignal(signal.SIGINT), dict(os.environ))"
    subprocess.run(
        ["bash", "-c", f'ulimit -v 3000000; exec {sys.executable} -c "{check}"'], check=True, timeout=SECONDS
    )


CALLS = {"mesh": lambda mesh: [mesh], "compare": lambda mesh: ["compare", mesh, mesh], "help": lambda mesh: ["--help"]}


@pytest.mark.parametrize("name", CALLS)
def test_full_standard_output(name, mesh):
    with open("/dev/full", "w") as full:
        assert_one_sentence(run(*CALLS[name](mesh), stdout=full), 1, "standard output: No space left")


@pytest.mark.parametrize("name", CALLS)
def test_nobody_reads_standard_output(name, mesh):
    """As in `| head -1`, which ends."""
    reader, writer = os.pipe()
    os.close(reader)
    try:
        assert_one_sentence(run(*CALLS[name](mesh), stdout=writer), 1, "standard output: Broken pipe")
    finally:
        os.close(writer)


def close_outputs():
    os.close(1)
    os.close(2)


def test_closed_standard_output(mesh):
    assert_one_sentence(run(mesh, preexec_fn=lambda: os.close(1)), 1, "standard output: Bad file descriptor")


def test_closed_outputs(mesh, tmp_path):
    """Files do not get their numbers, and what would be said."""
    files = tmp_path / "out.obj", tmp_path / "report.json"
    command = [sys.executable, "-m", "holomorph", mesh, "--output", files[0], "--report", files[1]]
    assert subprocess.run(command, preexec_fn=close_outputs).returncode == 0
    assert files[0].read_text().startswith("v ") and files[1].read_text().startswith("{")
    command[3] = tmp_path / "nowhere.obj"
    assert subprocess.run(command, preexec_fn=close_outputs).returncode == 2


@pytest.mark.parametrize("stream", ["/dev/full", "/dev/null"])
def test_an_error_stream_that_cannot_be_written(stream, mesh, tmp_path):
    """The status is that of the job, and that of options that are misspelled."""
    with open(stream, "w") as full:
        for arguments, status in (((mesh, "--report", tmp_path / "r.json"), 0), (("nowhere.obj",), 2), (("--no",), 2)):
            command = [sys.executable, "-m", "holomorph", *map(str, arguments)]
            assert subprocess.run(command, stderr=full).returncode == status


@pytest.mark.parametrize("megabytes", [100, 300, 330, 400, 500, 700, 1000, 1500])
def test_little_memory(megabytes, mesh, tmp_path):
    """It is done, or one sentence says that memory is short; it never waits for any. GNU's OpenMP has a sentence of its
    own."""
    import resource

    def limit():
        resource.setrlimit(resource.RLIMIT_AS, (megabytes << 20, megabytes << 20))

    done = run(mesh, "--report", tmp_path / "report.json", preexec_fn=limit)
    assert done.returncode in (0, 1) and len(done.stderr.splitlines()) == done.returncode, done.stderr
    if megabytes < 320:
        assert_one_sentence(done, 1, "ulimit -v")


def test_what_nothing_foresaw(tmp_path):
    """One sentence, a status of its own, and a report to send, that says where it happened."""
    code = "import sys; from holomorph.commands import console; sys.exit(console.ended(lambda: {}['no such\\nkey']))"
    command = [sys.executable, "-c", code, "batch", "a b.obj"]
    environment = os.environ | {"TMPDIR": str(tmp_path)}
    done = subprocess.run(command, env=environment, stderr=subprocess.PIPE, text=True, timeout=SECONDS)
    assert_one_sentence(done, 70, "a fault of Holomorph, not of the data: KeyError")
    (report,) = tmp_path.iterdir()
    assert str(report) in done.stderr
    told = report.read_text()
    assert "in <lambda>" in told and "'a b.obj'" in told and report.stat().st_mode & 0o077 == 0


def test_what_nothing_foresaw_where_no_report_can_be_written(tmp_path):
    code = "import sys; from holomorph.commands import console; sys.exit(console.ended(lambda: 1 / 0))"
    limited = ["bash", "-c", f'ulimit -f 0; exec {sys.executable} -c "$1"', "-", code]
    done = subprocess.run(
        limited, env=os.environ | {"TMPDIR": "/dev/full"}, stderr=subprocess.PIPE, text=True, timeout=SECONDS
    )
    assert_one_sentence(done, 70, "the report could not be written")


def test_a_name_in_a_sentence(mesh, tmp_path):
    """Neither a line more, nor what a terminal acts on."""
    done = run(mesh, "--output", tmp_path / "two\nlines\x1b[2J\udcff" / "out.obj")
    assert_one_sentence(done, 2, "two\\nlines\\x1b[2J\\xff")
