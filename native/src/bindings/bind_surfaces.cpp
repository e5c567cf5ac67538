// Surfaces, and how they come in.
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>
#include <optional>

#include <array>
#include <filesystem>
#include <memory>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "bindings/arrays.h"
#include "bindings/bindings.h"
#include "mesh/components.h"
#include "mesh/cut_open.h"
#include "mesh/cutting.h"
#include "mesh/hard_edges.h"
#include "mesh/intrinsic_surface.h"
#include "mesh/io/read.h"
#include "mesh/io/read_stl.h"
#include "mesh/make_surface.h"
#include "mesh/stars.h"

namespace holomorph::bindings {
namespace {

using namespace pybind11::literals;

using mesh::Surface;
using SurfacePointer = std::shared_ptr<Surface>;

template <class Index>
SurfacePointer from_polygons(const Contiguous<double>& vertices, const Contiguous<Index>& corner_vertices,
                             const Contiguous<Index>& face_offsets) {
  mesh::BasicPolygons<Index> polygons{rows<double, 3>(vertices), values(corner_vertices), values(face_offsets)};
  const py::gil_scoped_release unlocked;
  Execution execution;
  return std::make_shared<Surface>(mesh::make_surface(std::move(polygons), execution));
}

SurfacePointer from_edge_lengths(int vertex_count, const Contiguous<std::int64_t>& faces,
                                 const Contiguous<double>& lengths, const Contiguous<std::int64_t>& face_edges) {
  const auto f = rows<std::int64_t, 3>(faces), names = rows<std::int64_t, 3>(face_edges);
  const auto l = rows<double, 3>(lengths);
  const py::gil_scoped_release unlocked;
  Execution execution;
  return std::make_shared<Surface>(mesh::make_intrinsic_surface(vertex_count, f, l, names, execution));
}

template <class Work>
auto without_lock(const Work& work) {
  const py::gil_scoped_release unlocked;
  return work();
}

/// A surface that is a part of a mesh; the indices are None where they are the surface's own.
struct Part {
  SurfacePointer surface;
  py::object vertex_index = py::none(), face_index = py::none(), corner_index = py::none();
  int given_vertex_count = 0;
  std::vector<mesh::Cut> cuts = {};
  std::vector<mesh::Pair> joined_vertices = {};
  std::vector<mesh::RefusedFaces> refused = {};
  std::vector<mesh::Pair> repeated_corners = {};
  std::vector<int> point_faces = {};
  std::vector<std::string> notes = {};
};

Part as_part(mesh::CutSurface part) {
  Part result{std::make_shared<Surface>(std::move(part.surface))};
  if (!part.vertex_index.empty()) result.vertex_index = copy(part.vertex_index);
  if (!part.face_index.empty()) result.face_index = copy(part.face_index);
  if (!part.corner_index.empty()) result.corner_index = copy(part.corner_index);
  result.given_vertex_count = part.given_vertex_count;
  result.cuts = std::move(part.cuts);
  result.joined_vertices = std::move(part.joined_vertices);
  result.refused = std::move(part.refused);
  result.repeated_corners = std::move(part.repeated_corners);
  result.point_faces = std::move(part.point_faces);
  return result;
}

template <class Index>
Part cut(const Contiguous<double>& vertices, const Contiguous<Index>& corner_vertices,
         const Contiguous<Index>& face_offsets) {
  mesh::BasicPolygons<Index> polygons{rows<double, 3>(vertices), values(corner_vertices), values(face_offsets)};
  return as_part(without_lock([&] {
    Execution execution;
    return mesh::cut_surface(std::move(polygons), execution);
  }));
}

// Indices into what was read become those of the file.
void number_as_in_file(std::vector<int>& index, const std::vector<int>& in_file) {
  if (index.empty()) {
    index = in_file;
  } else {
    for (int& i : index) i = in_file[i];
  }
}

// A file that was read, of which a surface is made once.
struct FileMesh {
  mesh::GivenPolygons polygons;

  static FileMesh read(const std::filesystem::path& path, bool weld) {
    return without_lock([&]() -> FileMesh {
      mesh::GivenPolygons polygons = mesh::read(path);
      return {weld ? mesh::welded(polygons) : std::move(polygons)};
    });
  }

  Part surface(bool strict) {
    const mesh::FileRecord file = polygons.file;
    mesh::CutSurface cut = without_lock([&]() -> mesh::CutSurface {
      Execution execution;
      if (!strict) return mesh::cut_surface(std::move(polygons), execution);
      mesh::Surface surface = mesh::make_surface(std::move(polygons), execution);
      mesh::refuse_wild_vertices(surface.polygons);
      const int count = surface.vertex_count;
      return {std::move(surface), {}, {}, {}, count, {}, {}, {}, {}, {}};
    });
    if (!file.face_index.empty()) {
      number_as_in_file(cut.face_index, file.face_index);
      number_as_in_file(cut.corner_index, file.corner_index);
      if (!cut.point_faces.empty()) number_as_in_file(cut.point_faces, file.face_index);
      for (mesh::Pair& pair : cut.repeated_corners) pair = {file.corner_index[pair[0]], file.corner_index[pair[1]]};
      for (mesh::RefusedFaces& refused : cut.refused) number_as_in_file(refused.faces, file.face_index);
      for (mesh::Cut& each : cut.cuts) {
        if (!each.faces.empty()) number_as_in_file(each.faces, file.face_index);
      }
    }
    Part part = as_part(std::move(cut));
    part.notes = file.notes;
    return part;
  }
};

std::vector<Part> components(const Surface& surface) {
  std::vector<mesh::Component> parts;
  {
    const py::gil_scoped_release unlocked;
    Execution execution;
    parts = mesh::components(surface, execution);
  }
  std::vector<Part> result;
  for (mesh::Component& part : parts) {
    result.push_back({std::make_shared<Surface>(std::move(part.surface)), copy(part.vertex_index),
                      copy(part.face_index), copy(part.corner_index)});
  }
  return result;
}

py::array edge_distances(const Surface& surface, const Contiguous<double>& lengths, const std::vector<int>& sources) {
  const auto l = values(lengths);
  return copy(without_lock([&] {
    Execution execution;
    return mesh::graph_distances(mesh::half_edges(surface, execution), l, sources);
  }));
}

// (reason, vertices, edges, faces) of each.
std::vector<std::tuple<std::string, py::array, py::array, py::array>> cuts(const Part& part) {
  constexpr std::array<const char*, 6> kReasons{"many_faces", "twice", "opposite", "one_sided", "repeated", "touching"};
  std::vector<std::tuple<std::string, py::array, py::array, py::array>> result;
  for (const mesh::Cut& cut : part.cuts) {
    result.emplace_back(kReasons[static_cast<std::size_t>(cut.reason)], copy(cut.vertices), copy_rows(cut.edges),
                        copy(cut.faces));
  }
  return result;
}

// (faces, reason) of each.
std::vector<std::pair<py::array, std::string>> refused(const Part& part) {
  std::vector<std::pair<py::array, std::string>> result;
  for (const mesh::RefusedFaces& each : part.refused) result.emplace_back(copy(each.faces), each.reason);
  return result;
}

// What reading and splitting give.
void bind_parts(py::module_& m) {
  using mesh::TopologicalType;
  py::class_<TopologicalType>(m, "TopologicalType")
      .def(py::init([](int genus, int boundary_count) {
             return TopologicalType{genus, boundary_count};
           }),
           py::arg("genus"), py::arg("boundary_count"))
      .def_readonly("genus", &TopologicalType::genus)
      .def_readonly("boundary_count", &TopologicalType::boundary_count)
      .def("text", &TopologicalType::text);
  py::class_<Part>(m, "Part")
      .def_readonly("surface", &Part::surface)
      .def_readonly("vertex_index", &Part::vertex_index)
      .def_readonly("face_index", &Part::face_index)
      .def_readonly("corner_index", &Part::corner_index)
      .def_readonly("given_vertex_count", &Part::given_vertex_count)
      .def_property_readonly("cuts", &cuts)
      .def_property_readonly(
          "joined_vertices",
          [](const py::object& self) { return view(self.cast<const Part&>().joined_vertices, self); })
      .def_property_readonly("refused", &refused)
      .def_property_readonly(
          "repeated_corners",
          [](const py::object& self) { return view(self.cast<const Part&>().repeated_corners, self); })
      .def_property_readonly("point_faces", [](const Part& part) { return copy(part.point_faces); })
      .def_readonly("notes", &Part::notes);
}

void bind_file(py::module_& m) {
  py::class_<FileMesh>(m, "FileMesh")
      .def_static("read", &FileMesh::read, py::arg("path"), py::arg("weld"))
      .def_property_readonly("vertices",
                             [](const FileMesh& f) {  // a copy: what they are in moves to the surface
                               const auto& points = f.polygons.vertices;
                               const auto* const data = points.empty() ? nullptr : points.front().data();
                               return py::array_t<double>({std::ssize(points), std::ptrdiff_t{3}}, data);
                             })
      .def_property_readonly("corner_vertices", [](const FileMesh& f) { return copy(f.polygons.corner_vertices); })
      .def_property_readonly("face_offsets", [](const FileMesh& f) { return copy(f.polygons.face_offsets); })
      .def_property_readonly("corner_index", [](const FileMesh& f) { return copy(f.polygons.file.corner_index); })
      .def("surface", &FileMesh::surface, py::arg("strict"));
}

using mesh::Surface;

using Flags = Contiguous<bool>;

std::vector<char> flags(const Flags& given) { return {given.data(), given.data() + given.size()}; }

py::array as_flags(std::vector<char> values) { return give(std::move(values)).attr("view")("bool"); }

// compute(execution), without the interpreter's lock.
template <class Compute>
auto executed(const Compute& compute) {
  const py::gil_scoped_release released;
  Execution execution;
  return compute(execution);
}

// (surface, (#V,) the vertex that each of its is a copy of)
std::pair<std::shared_ptr<Surface>, py::array> cut_open(const Surface& surface, const Flags& is_cut) {
  mesh::OpenSurface made = executed([&, cut = flags(is_cut)](Execution& e) { return mesh::cut_open(surface, cut, e); });
  return {std::make_shared<Surface>(std::move(made.surface)), give(std::move(made.vertex_index))};
}

// ((n,) vertices, (#T, 3) the copies at the corners of triangles)
std::pair<py::array, py::array> parted_vertices(const Surface& surface, const Flags& is_cut) {
  auto made = mesh::parted_vertices(surface, flags(is_cut));
  return {give(std::move(made.vertices)), copy_rows(made.of_triangles)};
}

}  // namespace

void bind_surfaces(py::module_& m) {
  const auto viewed = [](auto member) {
    return [member](py::object self) { return view(self.cast<const Surface&>().*member, self); };
  };
  const auto polygons = [](auto member) {
    return [member](py::object self) { return view(self.cast<const Surface&>().polygons.*member, self); };
  };
  const auto repairs = [](auto member) {
    return [member](py::object self) { return view(self.cast<const Surface&>().repairs.*member, self); };
  };
  py::class_<Surface, SurfacePointer> type(m, "Surface");
  bind_parts(m);
  bind_file(m);
  type.def_static("from_polygons", &from_polygons<int>, py::arg("vertices"), py::arg("corner_vertices").noconvert(),
                  py::arg("face_offsets").noconvert())
      .def_static("from_polygons", &from_polygons<std::int64_t>, py::arg("vertices"), py::arg("corner_vertices"),
                  py::arg("face_offsets"))
      .def_static("from_edge_lengths", &from_edge_lengths, py::arg("vertex_count"), py::arg("faces"),
                  py::arg("lengths"), py::arg("face_edges"))
      .def_static("cut", &cut<int>, py::arg("vertices"), py::arg("corner_vertices").noconvert(),
                  py::arg("face_offsets").noconvert())
      .def_static("cut", &cut<std::int64_t>, py::arg("vertices"), py::arg("corner_vertices"), py::arg("face_offsets"))
      .def("components", &components)
      .def("topology", &mesh::topological_type)
      .def("euler_characteristic", &mesh::euler_characteristic)
      .def("edge_distances", &edge_distances, py::arg("lengths"), py::arg("sources"))
      .def("refuse_wild_vertices",
           [](const Surface& s) {
             const py::gil_scoped_release unlocked;
             mesh::refuse_wild_vertices(s.polygons);
           })
      .def("sliver_owners", [](const Surface& s) { return copy(without_lock([&] { return mesh::sliver_owners(s); })); })
      .def("area",
           [](const Surface& s) {
             Workers workers;
             return mesh::area(s, workers);
           })
      .def("mollification",
           [](const Surface& s) {
             Execution execution;
             return mesh::mollification(s, execution);
           })
      .def_readonly("component_count", &Surface::component_count)
      .def_readonly("vertex_count", &Surface::vertex_count)
      .def_property_readonly("intrinsic", &Surface::intrinsic)
      .def_property_readonly("vertices", polygons(&mesh::Polygons::vertices))
      .def_property_readonly("corner_vertices", polygons(&mesh::Polygons::corner_vertices))
      .def_property_readonly("face_offsets", polygons(&mesh::Polygons::face_offsets))
      .def_property_readonly("triangles", viewed(&Surface::triangles))
      .def_property_readonly("triangle_corners", viewed(&Surface::triangle_corners))
      .def_property_readonly("triangle_edges", viewed(&Surface::triangle_edges))
      .def_property_readonly("triangle_faces", viewed(&Surface::triangle_faces))
      .def_property_readonly("edges", viewed(&Surface::edges))
      .def_property_readonly("edge_lengths", viewed(&Surface::edge_lengths))
      .def_property_readonly("reversed_faces", repairs(&mesh::Repairs::reversed_faces))
      .def_property_readonly("isolated_vertices", repairs(&mesh::Repairs::isolated_vertices))
      .def_property_readonly("zero_area_faces", repairs(&mesh::Repairs::zero_area_faces));
}

void bind_cuts(py::module_& m) {
  m.def("cut_open", &cut_open, "surface"_a, "is_cut"_a);
  m.def("parted_vertices", &parted_vertices, "surface"_a, "is_cut"_a);
  m.def(
      "bends", [](const Surface& surface) { return give(mesh::bends(surface)); }, "surface"_a);
  m.def(
      "breaks",
      [](const Surface& surface) { return give(executed([&](Execution&) { return mesh::breaks(surface); })); },
      "surface"_a);
  m.def(
      "face_normals", [](const Surface& surface) { return copy_rows(mesh::face_normals(surface)); }, "surface"_a);
  m.def("seen", py::vectorize(&mesh::seen), "breaks_off"_a);
  m.def(
      "curvature",
      [](const Surface& surface, const Flags& is_seam, double most) {
        return mesh::curvature(surface, flags(is_seam), most);
      },
      "surface"_a, "is_seam"_a, "most"_a);
  m.def(
      "on_border",
      [](const Surface& surface, const Flags& is_cut) { return as_flags(mesh::on_border(surface, flags(is_cut))); },
      "surface"_a, "is_cut"_a);
  m.def(
      "paths_to_border",
      [](const Surface& surface, const Flags& is_border, const Flags& starts) {
        return as_flags(executed([&, border = flags(is_border), from = flags(starts)](Execution& e) {
          return mesh::paths_to_border(surface, border, from, e);
        }));
      },
      "surface"_a, "is_border"_a, "starts"_a);
}

}  // namespace holomorph::bindings
