// Maps in islands, and how rectangles are packed.
#include <pybind11/eigen.h>
#include <pybind11/stl.h>
#include <optional>
#include <tuple>

#include <algorithm>
#include <memory>
#include <utility>

#include "bindings/arrays.h"
#include "bindings/bindings.h"
#include "flat/arrangement.h"
#include "flat/pieces.h"
#include "flat/split_overlaps.h"

namespace holomorph::bindings {
namespace {

using namespace pybind11::literals;
// (#F,) the part of each polygon
py::array parted(const mesh::Surface& surface, const Contiguous<double>& uv, const py::object& progress) {
  const uv::UvArray flat = Eigen::Map<const uv::UvArray>(uv.data(), uv.shape(0), 2);
  std::vector<int> parts;
  Execution execution(1, callback(progress));
  {
    const py::gil_scoped_release unlocked;
    execution.stage("overlaps", 0.0, 1.0);
    parts = flat::parted(surface, flat, execution);
  }
  return give(std::move(parts));
}

py::array as_array(const std::vector<flat::Extent>& rows) {
  py::array_t<double> result({static_cast<py::ssize_t>(rows.size()), py::ssize_t{2}});
  std::copy_n(rows.data()->data(), result.size(), result.mutable_data());
  return read_only(std::move(result));
}

// ((n, 2) lower left corners, side)
std::pair<py::array, double> pack(const Contiguous<double>& sizes, double margin) {
  const flat::Packing made = flat::pack(rows<double, 2>(sizes), margin);
  return {as_array(made.corners), made.side};
}

using SurfacePointer = std::shared_ptr<mesh::Surface>;

// [(surface, indices of its vertices, polygons and corners)]
using Parts = std::vector<std::tuple<SurfacePointer, py::array, py::array, py::array>>;

Parts given(std::vector<mesh::Component> parts) {
  Parts result;
  for (mesh::Component& part : parts) {
    result.emplace_back(std::make_shared<mesh::Surface>(std::move(part.surface)), give(std::move(part.vertex_index)),
                        give(std::move(part.face_index)), give(std::move(part.corner_index)));
  }
  return result;
}

Parts cut_apart(const mesh::Surface& surface, const Contiguous<int>& names) {
  std::vector<mesh::Component> parts;
  {
    const std::vector<int> own = values(names);
    const py::gil_scoped_release unlocked;
    Execution execution;
    parts = flat::cut_apart(surface, own, execution);
  }
  return given(std::move(parts));
}

// (the parts, how far the cut is seen)
std::pair<Parts, double> cut_in_hiding(const mesh::Surface& surface, const std::optional<std::array<double, 3>>& up,
                                       int threads, const py::object& progress) {
  flat::CutInHiding cut;
  {
    Execution execution(threads, callback(progress));
    const py::gil_scoped_release unlocked;
    cut = flat::cut_in_hiding(surface, up, execution);
  }
  return {given(std::move(cut.parts)), cut.seen};
}

using flat::Arrangement;
using flat::Laid;
using flat::Square;

// A map: surface, its area, (#C, 2) UVs, their density, whether it is a tiling, its turns, and the corners of the mesh.
using Given = std::tuple<std::shared_ptr<mesh::Surface>, double, Contiguous<double>, double, bool, int,
                         std::optional<Contiguous<int>>>;

std::vector<Laid> laid(const std::vector<Given>& maps) {
  std::vector<Laid> result;
  for (const auto& [surface, area, uv, density, is_tiled, turns, corners] : maps) {
    if (uv.ndim() != 2 || uv.shape(0) != std::ssize(surface->polygons.corner_vertices) || uv.shape(1) != 2)
      throw py::value_error("a map needs a row of two UVs for each corner of its surface");
    result.push_back({surface.get(),
                      area,
                      {uv.data(), uv.shape(0), 2},
                      density,
                      is_tiled,
                      turns,
                      corners ? corners->data() : nullptr});
  }
  return result;
}

// compute(maps, workers), without the interpreter's lock.
template <class Compute>
auto of_maps(const std::vector<Given>& given, const Compute& compute) {
  const std::vector<Laid> maps = laid(given);
  const py::gil_scoped_release unlocked;
  Workers workers;
  return compute(maps, workers);
}

Square square(const std::vector<Given>& maps, const Arrangement& arrangement) {
  return of_maps(maps, [&](const auto& own, Workers& workers) { return Square(own, arrangement, workers); });
}

// The facade has checked that there are so many corners.
uv::UvArray arranged(const std::vector<Given>& maps, int corners, const Arrangement& arrangement) {
  return of_maps(maps,
                 [&](const auto& own, Workers& workers) { return flat::arranged(own, corners, arrangement, workers); });
}

double unit_length(const std::vector<Given>& maps, const Arrangement& arrangement) {
  return of_maps(maps, [&](const auto& own, Workers& workers) { return flat::unit_length(own, arrangement, workers); });
}

uv::UvArray on_grid(uv::UvArray uv) {
  flat::round_to_grid(uv);
  return uv;
}

}  // namespace

void bind_islands(py::module_& m) {
  m.def("parted", &parted, "surface"_a, "uv"_a, "progress"_a);
  m.def("cut_apart", &cut_apart, "surface"_a, "names"_a);
  m.def("cut_in_hiding", &cut_in_hiding, "surface"_a, "up"_a, py::kw_only(), "threads"_a, "progress"_a);
  m.def("pack", &pack, "sizes"_a, "margin"_a);
  m.def("fitting_margin", &flat::fitting_margin, "margin"_a, "count"_a);
}

void bind_choice(py::module_& m) {
  py::class_<Arrangement>(m, "Arrangement")
      .def(py::init([](double density, double rotation, double margin, double per_length, int quarters) {
             return Arrangement{density, rotation, margin, per_length, quarters};
           }),
           "density"_a, "rotation"_a, "margin"_a, "per_length"_a, "quarters"_a);
  py::class_<Square>(m, "Square")
      .def_property_readonly("filling", &Square::filling)
      .def_property_readonly("used", &Square::used)
      .def_property_readonly("sizes", &Square::sizes);
  m.attr("scattered") = flat::kScattered;
  m.def("square", &square, "maps"_a, "arrangement"_a);
  m.def("arranged", &arranged, "maps"_a, "corners"_a, "arrangement"_a);
  m.def("unit_length", &unit_length, "maps"_a, "arrangement"_a);
  m.def("on_grid", &on_grid, "uv"_a);
}

}  // namespace holomorph::bindings
