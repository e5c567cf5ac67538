"""The library is installed and the examples are built against it once."""

import os
import shutil
from pathlib import Path

import pytest
from programs import output
from repository import ROOT


@pytest.fixture(scope="session")
def folder(tmp_path_factory):
    return Path(os.environ.get("HOLOMORPH_TEST_OUTPUT") or tmp_path_factory.mktemp("cpp"))


@pytest.fixture(scope="session")
def installed(folder):
    """install(component): the folder into which that component alone is installed from the build HOLOMORPH_BUILD."""
    build = Path(os.environ["HOLOMORPH_BUILD"])

    def install(component):
        prefix = folder / f"installed-{component}"
        output("cmake", "--install", build, "--component", component, "--prefix", prefix)
        return prefix

    return install


@pytest.fixture(scope="session")
def examples(installed, folder):
    """The folder of the programs, built against the installed package and nothing of the checkout."""
    build = folder / "examples"
    options = [f"-DCMAKE_PREFIX_PATH={installed('cpp')}", "-DCMAKE_CXX_FLAGS=-Wall -Wextra -Werror", "-G", "Ninja"]
    if shutil.which("ccache"):
        options.append("-DCMAKE_CXX_COMPILER_LAUNCHER=ccache")
    output("cmake", "-S", ROOT / "examples", "-B", build, *options)
    output("cmake", "--build", build)
    return build
