#include <pybind11/eigen.h>
#include <pybind11/stl.h>

#include "bindings/arrays.h"
#include "bindings/bindings.h"
#include "tiles/places.h"

namespace holomorph::bindings {
namespace {

using namespace pybind11::literals;
using mesh::Surface;
using tiles::Places;
using tiles::TileCoordinates;

// The facade has checked the shapes.
TileCoordinates tile_coordinates(const Surface& surface, const Contiguous<double>& uv,
                                 const Eigen::Matrix2d& inverse_lattice, const Eigen::Vector2d& origin,
                                 const Eigen::Matrix2i& steps, int threads) {
  const Eigen::Map<const tiles::Corners> corners(uv.data(), uv.shape(0), 2);
  const py::gil_scoped_release unlocked;
  Execution execution(threads);
  return tiles::tile_coordinates(surface, corners, {inverse_lattice, origin, steps}, execution);
}

Places places(const Surface& surface, const TileCoordinates& coordinates, int threads) {
  const py::gil_scoped_release unlocked;
  Execution execution(threads);
  return tiles::places(surface, coordinates, execution);
}

std::vector<int> poles(const TileCoordinates& coordinates) {
  std::vector<int> result;
  for (int v = 0; v < std::ssize(coordinates.is_pole); ++v) {
    if (coordinates.is_pole[v]) result.push_back(v);
  }
  return result;
}

}  // namespace

void bind_tiles(py::module_& m) {
  py::class_<TileCoordinates>(m, "TileCoordinates").def("poles", [](const TileCoordinates& c) {
    return copy(poles(c));
  });
  py::class_<Places>(m, "Places")
      .def_property_readonly("triangles", [](py::object p) { return view(p.cast<const Places&>().triangles, p); })
      .def_property_readonly("barycentric", [](py::object p) { return view(p.cast<const Places&>().barycentric, p); })
      .def_property_readonly("numbers", [](py::object p) { return view(p.cast<const Places&>().numbers, p); })
      .def_readonly("flipped", &Places::flipped);
  m.def("tile_coordinates", &tile_coordinates, "surface"_a, "uv"_a, py::kw_only(), "inverse_lattice"_a, "origin"_a,
        "steps"_a, "threads"_a);
  m.def("places", &places, "surface"_a, "coordinates"_a, py::kw_only(), "threads"_a);
}

}  // namespace holomorph::bindings
