"""The examples of docs/cpp.md and of the two public headers are compiled, by the CMake lines of the page."""

import re

from programs import output
from repository import ROOT

PROGRAM = """
#include <holomorph/holomorph.h>
#include <holomorph/openmesh.h>
#include <OpenMesh/Core/IO/MeshIO.hh>
#include <OpenMesh/Core/Mesh/PolyMesh_ArrayKernelT.hh>
using Mesh = OpenMesh::PolyMesh_ArrayKernelT<OpenMesh::DefaultTraitsDouble>;
void of_arrays(const holomorph::mesh::Polygons& polygons) {{
{0}
}}
void chosen(const std::shared_ptr<holomorph::mesh::Surface>& part, holomorph::Execution& execution) {{
{1}
}}
void balanced(const std::shared_ptr<holomorph::mesh::Surface>& part, holomorph::Execution& execution) {{
{2}
}}
void tiled(const std::shared_ptr<holomorph::mesh::Surface>& part, holomorph::Execution& execution) {{
{3}
}}
void of_a_mesh(Mesh& mesh, holomorph::Execution& execution) {{
{4}
}}
void with_forms(Mesh& mesh, const holomorph::openmesh::SurfaceOfMesh& part, holomorph::structure::Structure& structure,
                holomorph::structure::PrimalForms* forms, holomorph::Execution& execution) {{
{5}
}}
void of_a_file() {{
{6}
}}
void of_openmesh(Mesh& mesh) {{
{7}
}}
int main() {{}}
"""
PROJECT = """
cmake_minimum_required(VERSION 3.25)
project(page LANGUAGES CXX)
add_executable(program program.cpp)
"""


def blocks(kind):
    text = (ROOT / "docs" / "cpp.md").read_text(encoding="utf-8")
    return re.findall(rf"^```{kind}\n(.*?)^```$", text, re.MULTILINE | re.DOTALL)


def header_example(name):
    """The indented lines of the first comment."""
    text = (ROOT / "native" / "include" / "holomorph" / name).read_text(encoding="utf-8")
    return "\n".join(re.findall(r"^//   (.*)$", text.split("#pragma once")[0], re.MULTILINE))


def test_examples_are_compiled(installed, tmp_path):
    (tmp_path / "CMakeLists.txt").write_text(PROJECT + "".join(blocks("cmake")), encoding="utf-8")
    examples = [*blocks("cpp"), header_example("holomorph.h"), header_example("openmesh.h")]
    (tmp_path / "program.cpp").write_text(PROGRAM.format(*examples), encoding="utf-8")
    output("cmake", "-S", tmp_path, "-B", tmp_path / "build", f"-DCMAKE_PREFIX_PATH={installed('cpp')}", "-G", "Ninja")
    output("cmake", "--build", tmp_path / "build")
