// Progressive meshes.
#include <pybind11/stl.h>

#include <cstring>
#include <memory>

#include "bindings/arrays.h"
#include "bindings/bindings.h"
#include "mesh/corner_turns.h"
#include "mesh/make_surface.h"
#include "progressive/corner_values.h"
#include "progressive/file_format.h"
#include "progressive/progressive_mesh.h"
#include "progressive/refinement.h"
#include "progressive/simplify.h"
#include "topology/pulled_back_classes.h"

namespace holomorph::bindings {
namespace {

using progressive::ProgressiveMesh;
using Pointer = std::shared_ptr<ProgressiveMesh>;
using SurfacePointer = std::shared_ptr<mesh::Surface>;

Pointer make(const mesh::Surface& surface, const std::string& order, const std::string& corner_type,
             const py::bytes& corner_data, const std::vector<int>& kept, const py::object& progress_function) {
  const std::string_view data = corner_data;
  Execution execution(0, callback(progress_function));
  const py::gil_scoped_release unlocked;
  const auto which = order == "quadric" ? progressive::Order::quadric : progressive::Order::independent;
  auto mesh = std::make_shared<ProgressiveMesh>(progressive_mesh(surface, which, execution, kept));
  mesh->corner_type = corner_type;
  mesh->corner_data.assign(data.begin(), data.end());
  return mesh;
}

Pointer from_bytes(const py::bytes& bytes) {
  const std::string_view data = bytes;
  const py::gil_scoped_release unlocked;
  return std::make_shared<ProgressiveMesh>(progressive::from_bytes(data));
}

py::bytes to_bytes(const ProgressiveMesh& mesh) {
  std::vector<char> bytes;
  {
    const py::gil_scoped_release unlocked;
    bytes = progressive::to_bytes(mesh);
  }
  return {bytes.data(), bytes.size()};
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

/// Columns of the splits.
struct Splits {
  py::array v_s, v_l, v_r, slot_l, slot_r;
};

Splits splits(const ProgressiveMesh& mesh) {
  const auto column = [&mesh](auto member) {
    std::vector<int> values;
    values.reserve(mesh.splits.size());
    for (const auto& split : mesh.splits) values.push_back(split.*member);
    return copy(values);
  };
  using progressive::Split;
  return {column(&Split::v_s), column(&Split::v_l), column(&Split::v_r), column(&Split::slot_l),
          column(&Split::slot_r)};
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
struct LevelCorners {
  py::array values, corners;
};

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
    result.push_back({read_only(rows), copy(level.corners)});
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
  py::class_<Splits>(m, "Splits")
      .def_readonly("v_s", &Splits::v_s)
      .def_readonly("v_l", &Splits::v_l)
      .def_readonly("v_r", &Splits::v_r)
      .def_readonly("slot_l", &Splits::slot_l)
      .def_readonly("slot_r", &Splits::slot_r);
  py::class_<LevelCorners>(m, "LevelCorners")
      .def_readonly("values", &LevelCorners::values)
      .def_readonly("corners", &LevelCorners::corners);
  py::class_<ProgressiveMesh, Pointer>(m, "ProgressiveMesh")
      .def_static("make", &make, py::arg("surface"), py::arg("order"), py::arg("corner_type"), py::arg("corner_data"),
                  py::arg("kept"), py::arg("progress"))
      .def_static("from_bytes", &from_bytes, py::arg("bytes"))
      .def("to_bytes", &to_bytes)
      .def("level", &level, py::arg("splits"))
      .def("restored", &restored)
      .def("splits", &splits)
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
      .def("original_corners",
           [](const ProgressiveMesh& mesh) {
             const auto corners = progressive::original_corners(mesh);
             py::array_t<int> array({static_cast<py::ssize_t>(corners.size()), py::ssize_t{3}});
             if (!corners.empty())
               std::memcpy(array.mutable_data(), corners.data(), sizeof(corners[0]) * corners.size());
             return read_only(std::move(array));
           })
      .def_property_readonly("base_vertex_count", &ProgressiveMesh::base_vertex_count)
      .def_property_readonly("vertex_count", &ProgressiveMesh::vertex_count)
      .def_property_readonly("base_triangle_count",
                             [](const ProgressiveMesh& mesh) { return mesh.base.triangles.size(); })
      .def_property_readonly("positions", viewed(&ProgressiveMesh::positions))
      .def_property_readonly("vertex_index", viewed(&ProgressiveMesh::vertex_index))
      .def_property_readonly("triangle_index", viewed(&ProgressiveMesh::triangle_index))
      .def_property_readonly("face_offsets", viewed(&ProgressiveMesh::face_offsets))
      .def_readonly("corner_type", &ProgressiveMesh::corner_type)
      .def_property_readonly("corner_data", [](const ProgressiveMesh& mesh) {
        return py::bytes(mesh.corner_data.data(), mesh.corner_data.size());
      });
}

}  // namespace holomorph::bindings
