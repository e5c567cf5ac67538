"""The job type for Flamenco, run by a JavaScript engine against the documented interface: the manager gives the script
`author` and a job with `settings` and `addTask`, and takes tasks of commands and dependencies."""

import json
import sys

import pytest
from batch_runs import BALANCED, outputs, run
from repository import ROOT

SCRIPT = ROOT / "examples" / "holomorph-uv-maps.js"
# https://flamenco.blender.org/usage/job-types/
MANAGER = """
const author = {
    Task: (name, type) => ({
        name, type, commands: [], dependencies: [],
        addCommand(command) { this.commands.push(command); },
        addDependency(task) { this.dependencies.push(task.name); },
    }),
    Command: (name, parameters) => ({ name, parameters }),
};
function tasksOf(settings) {
    const tasks = [];
    compileJob({ name: "job", settings, addTask: task => tasks.push(task) });
    return JSON.stringify(tasks);
}
"""
TYPES = {"string": str, "int32": int, "float": float, "bool": bool}
TASK_TYPES = ("blender", "ffmpeg", "file-management", "misc")


@pytest.fixture
def manager():
    quickjs = pytest.importorskip("quickjs")
    context = quickjs.Context()
    context.eval(MANAGER + SCRIPT.read_text(encoding="utf-8"))
    return context


def job_type(manager):
    return json.loads(manager.eval("JSON.stringify(JOB_TYPE)"))


def tasks(manager, **settings):
    defaults = {setting["key"]: setting["default"] for setting in job_type(manager)["settings"] if "default" in setting}
    return json.loads(manager.eval(f"tasksOf({json.dumps(defaults | settings)})"))


def test_settings_are_as_the_manager_takes_them(manager):
    found = job_type(manager)
    assert found["label"] and found["description"]
    for setting in found["settings"]:
        assert setting.keys() <= {"key", "type", "subtype", "required", "default", "description", "propargs", "visible"}
        assert setting.get("subtype", "dir_path") in ("dir_path", "file_path")
        assert setting.get("visible", "web") in ("visible", "hidden", "submission", "web")
        assert setting.get("required") or type(setting["default"]) is TYPES[setting["type"]]


def test_shares_then_the_overview(manager):
    found = tasks(manager, sources="/library", output="/maps", shares=3, recipe="/recipe.toml", memory="4G")
    *shares, overview = found
    assert [task["name"] for task in shares] == ["share-1-of-3", "share-2-of-3", "share-3-of-3"]
    assert overview["dependencies"] == [task["name"] for task in shares]
    assert all(task["type"] in TASK_TYPES for task in found)
    (command,) = shares[1]["commands"]
    assert command == {
        "name": "exec",
        "parameters": {
            "exe": "holomorph",
            "args": [
                "batch",
                "/library",
                "--out",
                "/maps",
                "--report-only",
                "--time",
                "1800",
                "--recipe",
                "/recipe.toml",
                "--memory",
                "4G",
                "--share",
                "2/3",
            ],
        },
    }


def test_its_commands_make_what_one_run_makes(manager, meshes, undisturbed, tmp_path):
    """The tasks are run as a worker would, one after the other."""
    (tmp_path / "recipe.toml").write_text(BALANCED)
    settings = {"sources": str(meshes), "output": str(tmp_path / "out"), "recipe": str(tmp_path / "recipe.toml")}
    for task in tasks(manager, **settings, shares=2, program=sys.executable):
        (command,) = task["commands"]
        assert not (tmp_path / "out/index.html").exists()
        result = run(*command["parameters"]["args"][1:])
        assert result.returncode == 0, result.stderr
    assert (tmp_path / "out/index.html").exists()
    assert outputs(tmp_path / "out") == undisturbed
