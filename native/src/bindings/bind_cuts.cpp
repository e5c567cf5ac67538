// Where surfaces break off, and where they are cut.
#include <pybind11/stl.h>

#include <array>
#include <memory>
#include <optional>
#include <utility>

#include "bindings/arrays.h"
#include "bindings/bindings.h"
#include "mesh/cut_open.h"
#include "mesh/hard_edges.h"

namespace holomorph::bindings {
namespace {

using namespace pybind11::literals;
using mesh::Surface;

using Flags = Contiguous<bool>;

std::vector<char> flags(const Flags& given) { return {given.data(), given.data() + given.size()}; }

py::array as_flags(std::vector<char> values) { return give(std::move(values)).attr("view")("bool"); }

// compute(execution), without the interpreter's lock.
template <class Compute>
auto unlocked(const Compute& compute) {
  const py::gil_scoped_release released;
  Execution execution;
  return compute(execution);
}

// (surface, (#V,) the vertex that each of its is a copy of)
std::pair<std::shared_ptr<Surface>, py::array> cut_open(const Surface& surface, const Flags& is_cut) {
  mesh::OpenSurface made = unlocked([&, cut = flags(is_cut)](Execution& e) { return mesh::cut_open(surface, cut, e); });
  return {std::make_shared<Surface>(std::move(made.surface)), give(std::move(made.vertex_index))};
}

// ((n,) vertices, (#T, 3) the copies at the corners of triangles)
std::pair<py::array, py::array> parted_vertices(const Surface& surface, const Flags& is_cut) {
  auto made = mesh::parted_vertices(surface, flags(is_cut));
  return {give(std::move(made.vertices)), copy_rows(made.of_triangles)};
}

}  // namespace

void bind_cuts(py::module_& m) {
  m.def("cut_open", &cut_open, "surface"_a, "is_cut"_a);
  m.def("parted_vertices", &parted_vertices, "surface"_a, "is_cut"_a);
  m.def(
      "bends", [](const Surface& surface) { return give(mesh::bends(surface)); }, "surface"_a);
  m.def(
      "breaks",
      [](const Surface& surface) { return give(unlocked([&](Execution&) { return mesh::breaks(surface); })); },
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
      "cuts_to_tips",
      [](const Surface& surface, const Flags& is_seam) {
        return as_flags(
            unlocked([&, seam = flags(is_seam)](Execution& e) { return mesh::cuts_to_tips(surface, seam, e); }));
      },
      "surface"_a, "is_seam"_a);
  m.def(
      "on_border",
      [](const Surface& surface, const Flags& is_cut) { return as_flags(mesh::on_border(surface, flags(is_cut))); },
      "surface"_a, "is_cut"_a);
  m.def(
      "paths_to_border",
      [](const Surface& surface, const Flags& is_border, const Flags& starts) {
        return as_flags(unlocked([&, border = flags(is_border), from = flags(starts)](Execution& e) {
          return mesh::paths_to_border(surface, border, from, e);
        }));
      },
      "surface"_a, "is_border"_a, "starts"_a);
}

}  // namespace holomorph::bindings
