// Progressive meshes.
#include <pybind11/stl.h>

#include <algorithm>
#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "bindings/arrays.h"
#include "bindings/bindings.h"
#include "mesh/corner_turns.h"
#include "mesh/make_surface.h"
#include "progressive/corner_values.h"
#include "progressive/refinement.h"
#include "progressive/simplify.h"
#include "topology/pulled_back_classes.h"

namespace holomorph::bindings {
namespace {

using progressive::ProgressiveMesh;
using Pointer = std::shared_ptr<ProgressiveMesh>;
using SurfacePointer = std::shared_ptr<mesh::Surface>;

Pointer progressive_of(const mesh::Surface& surface, const std::string& order, const std::vector<int>& kept,
                       const py::object& progress) {
  const auto which = order == "quadric" ? progressive::Order::quadric : progressive::Order::independent;
  return unlocked(0, progress, [&](Execution& execution) {
    return std::make_shared<ProgressiveMesh>(progressive_mesh(surface, which, execution, kept));
  });
}

/// Checks what the facade does not: it has looked at shapes.
Pointer of_arrays(const Contiguous<int>& base_triangles, const Contiguous<int>& split_vertices,
                  const Contiguous<std::uint8_t>& split_slots, const Contiguous<double>& positions,
                  const Contiguous<int>& vertex_index, const Contiguous<int>& triangle_index,
                  const Contiguous<int>& triangle_corners, const Contiguous<int>& face_offsets) {
  auto mesh = std::make_shared<ProgressiveMesh>();
  const auto base = rows<int, 3>(base_triangles), vertices = rows<int, 3>(split_vertices);
  const auto slots = rows<std::uint8_t, 2>(split_slots);
  for (std::size_t k = 0; k < vertices.size(); ++k)
    mesh->splits.push_back({vertices[k][0], vertices[k][1], vertices[k][2], slots[k][0], slots[k][1]});
  mesh->positions = rows<double, 3>(positions);
  mesh->vertex_index = values(vertex_index);
  mesh->triangle_index = values(triangle_index);
  mesh->triangle_corners = rows<int, 3>(triangle_corners);
  mesh->face_offsets = values(face_offsets);
  const py::gil_scoped_release unlocked;
  // The base has no isolated vertices.
  std::size_t count = 0;
  for (const mesh::Triple& triangle : base) {
    for (const int v : triangle) count = std::max(count, static_cast<std::size_t>(std::max(v, 0)) + 1);
  }
  progressive::set_base(*mesh, base, count);
  progressive::check(*mesh);
  return mesh;
}

SurfacePointer level(const ProgressiveMesh& mesh, int splits) {
  const py::gil_scoped_release unlocked;
  Execution execution;
  return std::make_shared<mesh::Surface>(mesh::make_surface(progressive::level(mesh, splits), execution));
}

SurfacePointer restored(const ProgressiveMesh& mesh) {
  const py::gil_scoped_release unlocked;
  Execution execution;
  return std::make_shared<mesh::Surface>(mesh::make_surface(progressive::restored(mesh), execution));
}

/// v_s, v_l, v_r of each split.
py::array split_vertices(const ProgressiveMesh& mesh) {
  std::vector<int> result;
  result.reserve(3 * mesh.splits.size());
  for (const progressive::Split& split : mesh.splits) result.insert(result.end(), {split.v_s, split.v_l, split.v_r});
  return give(std::move(result), {std::ssize(mesh.splits), 3});
}

py::array split_slots(const ProgressiveMesh& mesh) {
  std::vector<std::uint8_t> result;
  result.reserve(2 * mesh.splits.size());
  for (const progressive::Split& split : mesh.splits) result.insert(result.end(), {split.slot_l, split.slot_r});
  return give(std::move(result), {std::ssize(mesh.splits), 2});
}

std::vector<py::array> lift_loops(const ProgressiveMesh& mesh, int splits, const std::vector<std::vector<int>>& loops) {
  std::vector<std::vector<int>> lifted;
  {
    const py::gil_scoped_release unlocked;
    lifted = topology::lift_loops(mesh, splits, loops);
  }
  std::vector<py::array> result;
  for (const auto& loop : lifted) result.push_back(copy(loop));
  return result;
}

/// The values at a level's corners, and the corners of the original whose data they have.
using LevelCorners = std::pair<py::array, py::array>;

std::vector<LevelCorners> collapsed_corner_values(const ProgressiveMesh& mesh, const Contiguous<double>& array,
                                                  const std::vector<int>& splits, const std::vector<int>& turns) {
  const std::vector<double> given = values(array);
  const int width = static_cast<int>(array.shape(1));
  std::vector<progressive::CornerValues> levels;
  {
    const py::gil_scoped_release unlocked;
    levels = progressive::collapsed_corner_values(mesh, given, width, splits, turns);
  }
  std::vector<LevelCorners> result;
  for (const auto& level : levels) {
    const py::array rows = copy(level.values).attr("reshape")(-1, width);
    result.emplace_back(read_only(rows), copy(level.corners));
  }
  return result;
}

/// The vertices at which UVs turn around by less or more than a full turn.
py::array cones(const mesh::Surface& surface, const Contiguous<double>& uv, int turns) {
  const Eigen::Map<const Eigen::Matrix<double, Eigen::Dynamic, 2, Eigen::RowMajor>> rows(uv.data(), uv.shape(0), 2);
  const mesh::CornerTurns found(surface, rows, mesh::TurnGroup::of_plane(turns));
  std::vector<int> result;
  for (int v = 0; v < surface.vertex_count; ++v) {
    if (found.around(v) != 0) result.push_back(v);
  }
  return copy(result);
}

}  // namespace

void bind_progressive_meshes(py::module_& m) {
  m.def("cones", &cones, py::arg("surface"), py::arg("uv"), py::arg("turns"));
  const auto viewed = [](auto member) {
    return [member](py::object self) { return view(self.cast<const ProgressiveMesh&>().*member, self); };
  };
  py::class_<ProgressiveMesh, Pointer>(m, "ProgressiveMesh")
      .def_static("make", &progressive_of, py::arg("surface"), py::arg("order"), py::arg("kept"), py::arg("progress"))
      .def_static("of_arrays", &of_arrays, py::arg("base_triangles"), py::arg("split_vertices"), py::arg("split_slots"),
                  py::arg("positions"), py::arg("vertex_index"), py::arg("triangle_index"), py::arg("triangle_corners"),
                  py::arg("face_offsets"))
      .def("level", &level, py::arg("splits"))
      .def("restored", &restored)
      .def("split_count", &progressive::split_count, py::arg("triangle_count"))
      .def(
          "vertex_map",
          [](const ProgressiveMesh& mesh, int splits) { return copy(progressive::vertex_map(mesh, splits)); },
          py::arg("splits"))
      .def("lift_loops", &lift_loops, py::arg("splits"), py::arg("loops"))
      .def("collapsed_corner_values", &collapsed_corner_values, py::arg("values"), py::arg("splits"), py::arg("turns"))
      .def(
          "base_half_edges",
          [](const ProgressiveMesh& mesh, const mesh::Surface& surface, const std::vector<int>& map) {
            return copy(topology::base_half_edges(mesh.base, surface, map));
          },
          py::arg("surface"), py::arg("vertex_map"))
      .def_property_readonly("base_vertex_count", &ProgressiveMesh::base_vertex_count)
      .def_property_readonly(
          "base_triangles",
          [](py::object self) { return view(self.cast<const ProgressiveMesh&>().base.triangles, self); })
      .def_property_readonly("split_vertices", &split_vertices)
      .def_property_readonly("split_slots", &split_slots)
      .def_property_readonly("triangle_corners",
                             [](const ProgressiveMesh& mesh) { return copy_rows(progressive::original_corners(mesh)); })
      .def_property_readonly("positions", viewed(&ProgressiveMesh::positions))
      .def_property_readonly("vertex_index", viewed(&ProgressiveMesh::vertex_index))
      .def_property_readonly("triangle_index", viewed(&ProgressiveMesh::triangle_index))
      .def_property_readonly("face_offsets", viewed(&ProgressiveMesh::face_offsets));
}

}  // namespace holomorph::bindings
