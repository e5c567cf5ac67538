"""Annotations: every public function has them, the stub of the native core is true, and type checkers find a user's
script clean."""

import ast
import importlib.machinery
import importlib.util
import inspect
import os
import re
import shutil
import subprocess
import sys
from functools import cached_property
from pathlib import Path

import holomorph
import numpy as np
import pytest
from holomorph import _native
from repository import ROOT

SCRIPT = Path(__file__).with_name("user_script.py")
FOLDER = Path(holomorph.__file__).parent
STUB = FOLDER / "_native.pyi"
WRONG = "\n\nperiods: int = holomorph.Tiler.tile(3)\n"


def functions():
    """(name, function) of all public functions, methods and properties."""
    for name in dir(holomorph):
        value = getattr(holomorph, name)
        members = vars(value) if inspect.isclass(value) or inspect.ismodule(value) else {"": value}
        for kind in value.__mro__ if inspect.isclass(value) else ():
            members = vars(kind) | members if kind.__module__.startswith("holomorph") else members
        for member, entry in members.items():
            entry = getattr(entry, "fget", None) or getattr(entry, "func", None) or getattr(entry, "__func__", entry)
            is_ours = getattr(entry, "__module__", "").startswith("holomorph")
            if inspect.isfunction(entry) and is_ours and (not member.startswith("_") or member == "__init__"):
                yield f"{name}.{member}", entry


def test_type_checkers_take_the_same_names_for_public():
    """Those that the source imports as themselves."""
    tree = ast.parse(Path(holomorph.__file__).read_text("utf-8"))
    imported = [alias for node in ast.walk(tree) if isinstance(node, ast.ImportFrom) for alias in node.names]
    names = [alias.name for alias in imported if alias.asname == alias.name]
    assert sorted(names) == sorted(dir(holomorph)) and not hasattr(holomorph, "__all__")


def test_every_public_function_is_annotated():
    found = dict(functions())
    assert {"Surface.read", "ConformalStructure.period_matrix", "conformal_structure.", "report.plain"} <= set(found)
    wrong = []
    for name, function in found.items():
        signature = inspect.signature(function)
        parameters = [p for p in signature.parameters.values() if p.name not in ("self", "cls")]
        if signature.return_annotation is signature.empty:
            wrong.append(name)
        wrong += [f"{name}({p.name})" for p in parameters if p.annotation is p.empty]
    assert not wrong


def test_help_is_readable():
    """Names of types stand there as in the source, not all that a name stands for."""
    texts = {name: str(inspect.signature(function)) for name, function in functions()}
    assert not [name for name, text in texts.items() if len(text) > 800 or "typing." in text]


def test_cached_properties_are_looked_at():
    assert isinstance(vars(holomorph.Surface)["triangles"], cached_property)
    assert "Surface.triangles" in dict(functions())


# ---- the stub of the native core -----------------------------------------------------------------------------------


def bound():
    """{name: value} of all that the native core binds, members of its classes too."""
    found = {name: value for name, value in vars(_native).items() if not name.startswith("__")}
    for name, kind in list(found.items()):
        if inspect.isclass(kind) and not issubclass(kind, Exception):
            members = {member for member in vars(kind) if not member.startswith("_") or member == "__init__"}
            found |= {f"{name}.{member}": getattr(kind, member) for member in members}
    return found


def test_the_stub_is_what_the_script_writes(monkeypatch):
    pytest.importorskip("pybind11_stubgen")
    loader = importlib.machinery.SourceFileLoader("stubs", str(ROOT / "scripts" / "stubs"))
    script = importlib.util.module_from_spec(importlib.util.spec_from_loader("stubs", loader))
    loader.exec_module(script)
    assert script.STUB.read_text(encoding="utf-8") == script.generated(), "run scripts/stubs"


def test_every_bound_member_has_a_signature():
    tree = ast.parse(STUB.read_text(encoding="utf-8"))
    declared = {}
    for node in tree.body:
        for inner in [node, *getattr(node, "body", [])]:
            prefix = "" if inner is node else f"{node.name}."
            name = getattr(inner, "name", None) or getattr(getattr(inner, "target", None), "id", "")
            declared[prefix + name] = inner
    members = bound()
    assert len(members) > 350 and not [name for name in members if name not in declared and "__init__" not in name]
    functions = [node for node in declared.values() if isinstance(node, ast.FunctionDef)]
    parameters = [one for node in functions for one in node.args.args + node.args.kwonlyargs if one.arg != "self"]
    assert all(node.returns for node in functions) and all(one.annotation for one in parameters)
    assert not [one.arg for one in parameters if re.fullmatch(r"arg\d", one.arg)]
    assert "__getattr__" not in declared


def test_the_stub_has_the_errors_of_the_native_core():
    tree = ast.parse(STUB.read_text(encoding="utf-8"))
    stub = {node.name: [base.id for base in node.bases] for node in tree.body if isinstance(node, ast.ClassDef)}
    errors = {
        name: value for name, value in bound().items() if isinstance(value, type) and issubclass(value, Exception)
    }
    assert {name: stub[name] for name in errors} == {
        name: [base.__name__ for base in value.__bases__] for name, value in errors.items()
    }
    assert isinstance(_native.__version__, str)


def test_the_stub_passes_mypy(tmp_path):
    pytest.importorskip("mypy")
    copy = shutil.copy(STUB, tmp_path / "core.pyi")
    command = [sys.executable, "-m", "mypy", "--strict", "--cache-dir=cache", str(copy)]
    run = subprocess.run(command, capture_output=True, text=True, timeout=600, cwd=tmp_path)
    assert run.returncode == 0, run.stdout


# ---- scripts of users ----------------------------------------------------------------------------------------------


def checker(name):
    """The command that checks a file, or skips."""
    if name == "mypy":
        pytest.importorskip("mypy")
        return [sys.executable, "-m", "mypy", "--strict", "--follow-imports=silent", "--cache-dir=cache"]
    program = shutil.which("pyright") or pytest.skip("no program pyright")
    return [program, "--pythonpath", sys.executable]


def checked(name, path, folder):
    """The finished process, in an empty folder."""
    environment = os.environ | {"MYPYPATH": str(FOLDER.parent), "PYTHONPATH": str(FOLDER.parent)}
    settings = f'{{"typeCheckingMode": "strict", "extraPaths": ["{FOLDER.parent}", "{Path(np.__file__).parents[1]}"]}}'
    (folder / "pyrightconfig.json").write_text(settings)
    command = [*checker(name), str(path)]
    return subprocess.run(command, capture_output=True, text=True, timeout=600, cwd=folder, env=environment)


@pytest.mark.parametrize("name", ["mypy", "pyright"])
def test_a_user_s_script_is_clean(name, tmp_path):
    script = tmp_path / "script.py"
    script.write_text(SCRIPT.read_text(encoding="utf-8"), encoding="utf-8")
    run = checked(name, script, tmp_path)
    assert run.returncode == 0, run.stdout + run.stderr
    script.write_text(script.read_text(encoding="utf-8") + WRONG, encoding="utf-8")
    run = checked(name, script, tmp_path)
    assert run.returncode == 1 and "script.py" in run.stdout, run.stdout + run.stderr
