"""The ways in which other projects get the library: each program tiles a mesh as the Python package does."""

import os
import shutil
import subprocess

import families
import holomorph
import numpy as np
import pytest
from holomorph.quality.appearance import cost
from programs import output
from repository import ROOT

PROGRAM = ROOT / "examples" / "tiled_uv.cpp"
MESHES = {"torus": families.torus(12, 8), "genus 2": families.block_with_holes(2, refine=2, jitter=0.1)}
BRACKET = np.ones((3, 2, 3), bool)
BRACKET[1:, :, 1:] = False
CONTAINS = """
cmake_minimum_required(VERSION 3.24)
project(consumer LANGUAGES CXX)
include(FetchContent)
FetchContent_Declare(holomorph SOURCE_DIR {root} EXCLUDE_FROM_ALL)
FetchContent_MakeAvailable(holomorph)
add_executable(tiled_uv {program})
target_link_libraries(tiled_uv PRIVATE holomorph::holomorph)
"""


def found_by_cmake(request, _folder):
    return request.getfixturevalue("examples") / "tiled_uv"


def found_by_pkg_config(request, folder):
    prefix = request.getfixturevalue("installed")("cpp")
    place = {**os.environ, "PKG_CONFIG_PATH": str(next(prefix.rglob("pkgconfig")))}
    command = ["pkg-config", "--cflags", "--libs", "holomorph"]
    options = subprocess.run(command, env=place, text=True, capture_output=True, check=True).stdout.split()
    output("c++", "-std=c++20", "-O2", PROGRAM, "-o", folder / "tiled_uv", *options)
    return folder / "tiled_uv"


def contained(_request, folder):
    """By FetchContent, which adds a folder that is there as add_subdirectory does; neither Python nor pybind11 is asked
    for. In a folder where ccache knows what scripts/build has compiled."""
    (folder / "CMakeLists.txt").write_text(CONTAINS.format(root=ROOT, program=PROGRAM), encoding="utf-8")
    build, ccache = ROOT / "build" / "cmake" / "consumer", shutil.which("ccache")
    shutil.rmtree(build, ignore_errors=True)
    options = ["-G", "Ninja", "-DCMAKE_BUILD_TYPE=Release", "-DCMAKE_CXX_COMPILER=c++"]
    options += ["-DCMAKE_DISABLE_FIND_PACKAGE_Python=ON", "-DCMAKE_DISABLE_FIND_PACKAGE_pybind11=ON"]
    if ccache:
        options += [f"-DCMAKE_CXX_COMPILER_LAUNCHER=env;CCACHE_BASEDIR={ROOT};CCACHE_NOHASHDIR=1;{ccache}"]
    output("cmake", "-S", folder, "-B", build, *options)
    output("cmake", "--build", build, "--parallel", "2", seconds=1500)
    shutil.copy(build / "tiled_uv", folder)
    shutil.rmtree(build)
    return folder / "tiled_uv"


@pytest.fixture(scope="module", params=[found_by_cmake, found_by_pkg_config, contained])
def program(request, tmp_path_factory):
    return request.param(request, tmp_path_factory.mktemp("consumer"))


@pytest.mark.timeout(1600)  # without ccache it compiles the library
@pytest.mark.parametrize("name", MESHES)
def test_each_way_gives_the_tiling_of_the_python_package(program, name, tmp_path):
    mesh = MESHES[name]
    surface = read_again(mesh, tmp_path / "mesh.obj")
    tiler = holomorph.automatic_structure(surface).tiler(evened=True)
    made = tiler.tile(64, evenness=0.5, direction=None)
    quality = made.quality
    expected = (
        f"{len(made.poles)} poles, angle distortion {quality.mean_angle:.17g}, size range {quality.size_range:.17g}, "
        f"cost {cost(quality):.17g}"
    )
    assert output(program, tmp_path / "mesh.obj").strip() == expected


ISLANDS = {"cube": families.cube(), "tube": families.cylinder(13, 8), "bracket": families.voxel_surface(BRACKET)}
TURNED = MESHES | {"bracket": families.voxel_surface(np.kron(BRACKET, np.ones((3, 3, 3))))}


def read_again(mesh, path):
    holomorph.Surface(mesh.vertices, [np.asarray(face) for face in mesh.faces]).write(path)
    return holomorph.Surface.read(path)


def assert_same(program, path, figures, uv):
    """A program prints these figures, and the UVs bit for bit."""
    found, *rows = output(program, path).strip().splitlines()
    assert found == figures
    assert np.array_equal([[float(value) for value in row.split()] for row in rows], uv)


@pytest.mark.parametrize("name", ISLANDS)
def test_islands_are_those_of_the_python_package(examples, name, tmp_path):
    made = holomorph.island_map(read_again(ISLANDS[name], tmp_path / "mesh.obj"), evenness=0.5)
    assert_same(examples / "island_uv", tmp_path / "mesh.obj", f"{made.islands} {made.cost:.17g}", made.uv)


@pytest.mark.parametrize("name", TURNED)
def test_tilings_that_turn_are_those_of_the_python_package(examples, name, tmp_path):
    surface = read_again(TURNED[name], tmp_path / "mesh.obj")
    made = holomorph.automatic_structure(surface).tile(turns=4, lines="whole", evenness=0.5)
    cones = len(made.cones)
    figures = f"{cones} {made.quality.mean_angle:.17g} {cost(made.quality, cones=cones):.17g}"
    assert_same(examples / "turned_uv", tmp_path / "mesh.obj", figures, made.uv)


CHOSEN = ISLANDS | MESHES | {"sphere": families.geodesic_sphere(4), "blade": families.saw_blade()}


@pytest.mark.parametrize("name", CHOSEN)
def test_the_map_of_the_button_is_that_of_the_python_package(examples, name, tmp_path):
    made = holomorph.automatic_map(read_again(CHOSEN[name], tmp_path / "mesh.obj"))
    assert_same(examples / "automatic_uv", tmp_path / "mesh.obj", f"{made.why}; cost {made.cost:.17g}", made.uv)
