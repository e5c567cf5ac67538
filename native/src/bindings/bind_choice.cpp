// Which map a part gets, and how maps lie side by side.
#include <pybind11/eigen.h>
#include <pybind11/stl.h>

#include <memory>
#include <optional>
#include <tuple>
#include <utility>

#include "bindings/arrays.h"
#include "bindings/bindings.h"
#include "flat/arrangement.h"

namespace holomorph::bindings {
namespace {

using namespace pybind11::literals;
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
