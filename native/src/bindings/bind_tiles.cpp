#include <pybind11/eigen.h>
#include <pybind11/stl.h>

#include "bindings/arrays.h"
#include "bindings/bindings.h"
#include "bindings/callback.h"
#include "mesh/crossings.h"
#include "tiles/cells.h"
#include "tiles/corner_fans.h"
#include "tiles/lines.h"
#include "tiles/places.h"
#include "tiles/relief.h"

namespace holomorph::bindings {
namespace {

using namespace pybind11::literals;
using mesh::Surface;
using tiles::Cells;
using tiles::Lines;
using tiles::Locations;
using tiles::Places;
using tiles::Relief;
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

Lines lines(const Surface& surface, const TileCoordinates& coordinates, int threads) {
  const py::gil_scoped_release unlocked;
  Execution execution(threads);
  return tiles::lines(surface, coordinates, execution);
}

Cells cells(const Surface& surface, const TileCoordinates& coordinates, bool bricks, int threads) {
  const py::gil_scoped_release unlocked;
  Execution execution(threads);
  const auto pattern = bricks ? tiles::Pattern::bricks : tiles::Pattern::grid;
  const tiles::EdgeNodes nodes = tiles::edge_nodes(surface, coordinates, execution);
  return tiles::cells(tiles::pieces(surface, coordinates, nodes, pattern, execution));
}

std::vector<int> corner_fans(const Surface& surface, const Contiguous<bool>& is_sharp) {
  return tiles::corner_fans(surface, {is_sharp.data(), is_sharp.data() + is_sharp.size()});
}

// The pixels have the top row first.
Relief relief(const Surface& surface, const TileCoordinates& coordinates, const Contiguous<double>& normals,
              const Contiguous<double>& corner_normals, const Contiguous<bool>& are_reflex,
              const Contiguous<double>& shares, const Contiguous<double>& pixels, double depth, double level,
              double tolerance, int most_triangles, const py::object& progress) {
  std::vector<tiles::ReliefSite> sites(surface.vertex_count);
  for (int v = 0; v < surface.vertex_count; ++v) {
    sites[v] = {Eigen::Vector3d(surface.polygons.vertices[v].data()), Eigen::Vector3d(normals.data(v, 0)),
                shares.at(v)};
  }
  std::vector<tiles::SmoothCorners> corners(surface.triangles.size());
  for (std::size_t c = 0; c < 3 * corners.size(); ++c) {
    const auto row = static_cast<py::ssize_t>(c);
    corners[c / 3].normals[c % 3] = Eigen::Vector3d(corner_normals.data(row, 0));
    corners[c / 3].are_reflex[c % 3] = are_reflex.at(row);
  }
  using Pixels = tiles::HeightImage::Pixels;
  Pixels copied = Eigen::Map<const Pixels>(pixels.data(), pixels.shape(0), pixels.shape(1)).colwise().reverse();
  Execution execution(1, callback(progress));
  const py::gil_scoped_release unlocked;
  execution.stage("refining", 0, 1);
  const tiles::HeightImage image(std::move(copied));
  const tiles::ReliefOptions options{
      .level = level, .tolerance = tolerance, .most_triangles = most_triangles, .depth = depth};
  Relief made = tiles::relief(surface, coordinates, sites, corners, image, options, execution);
  execution.finish();
  return made;
}

py::array crossings(const Contiguous<double>& vertices, const Contiguous<int>& triangles, int threads) {
  const auto points = rows<double, 3>(vertices);
  const auto corners = rows<int, 3>(triangles);
  std::vector<mesh::Pair> pairs;
  {
    const py::gil_scoped_release unlocked;
    Execution execution(threads);
    pairs = mesh::crossings(points, corners, execution);
  }
  py::array_t<int> result({static_cast<py::ssize_t>(pairs.size()), py::ssize_t{2}});
  if (!pairs.empty()) std::memcpy(result.mutable_data(), pairs.data(), pairs.size() * sizeof(mesh::Pair));
  return read_only(std::move(result));
}

// A view of a list.
template <class Result, class List>
auto member(List Result::*list) {
  return [list](const py::object& result) { return view(result.cast<const Result&>().*list, result); };
}

// The same of where points lie.
template <class Result, class List>
auto located(Locations Result::*points, List tiles::Locations::*list) {
  return [=](const py::object& result) { return view((result.cast<const Result&>().*points).*list, result); };
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
  py::class_<Cells>(m, "Cells")
      .def_property_readonly("triangles", located(&Cells::vertices, &Locations::triangles))
      .def_property_readonly("barycentric", located(&Cells::vertices, &Locations::barycentric))
      .def_property_readonly("offsets", member(&Cells::offsets))
      .def_property_readonly("corner_vertices", member(&Cells::corner_vertices))
      .def_property_readonly("corner_points", member(&Cells::corner_points))
      .def_property_readonly("is_needed", member(&Cells::is_needed))
      .def_property_readonly("tiles", member(&Cells::tiles))
      .def_property_readonly("poles", member(&Cells::poles))
      .def_property_readonly("is_whole", member(&Cells::is_whole));
  py::class_<Lines>(m, "Lines")
      .def_property_readonly("triangles", located(&Lines::points, &Locations::triangles))
      .def_property_readonly("barycentric", located(&Lines::points, &Locations::barycentric))
      .def_property_readonly("offsets", member(&Lines::offsets))
      .def_property_readonly("is_closed", member(&Lines::is_closed));
  py::class_<Places>(m, "Places")
      .def_property_readonly("triangles", member(&Places::triangles))
      .def_property_readonly("barycentric", member(&Places::barycentric))
      .def_property_readonly("numbers", member(&Places::numbers))
      .def_readonly("flipped", &Places::flipped);
  py::class_<Relief>(m, "Relief")
      .def_property_readonly("positions", member(&Relief::positions))
      .def_property_readonly("offsets", member(&Relief::offsets))
      .def_property_readonly("heights", member(&Relief::heights))
      .def_property_readonly("triangles", member(&Relief::triangles))
      .def_property_readonly("tiles", member(&Relief::tiles))
      .def_property_readonly("parents", member(&Relief::parents))
      .def_readonly("error", &Relief::error)
      .def_readonly("is_full", &Relief::is_full);
  m.def("relief", &relief, "surface"_a, "coordinates"_a, py::kw_only(), "normals"_a, "corner_normals"_a, "are_reflex"_a,
        "shares"_a, "pixels"_a, "depth"_a, "level"_a, "tolerance"_a, "most_triangles"_a, "progress"_a);
  m.def("corner_fans",
        [](const Surface& surface, const Contiguous<bool>& is_sharp) { return copy(corner_fans(surface, is_sharp)); });
  m.def("crossings", &crossings, "vertices"_a, "triangles"_a, py::kw_only(), "threads"_a);
  m.def("lines", &lines, "surface"_a, "coordinates"_a, py::kw_only(), "threads"_a);
  m.def("cells", &cells, "surface"_a, "coordinates"_a, py::kw_only(), "bricks"_a, "threads"_a);
  m.def("tile_coordinates", &tile_coordinates, "surface"_a, "uv"_a, py::kw_only(), "inverse_lattice"_a, "origin"_a,
        "steps"_a, "threads"_a);
  m.def("places", &places, "surface"_a, "coordinates"_a, py::kw_only(), "threads"_a);
}

}  // namespace holomorph::bindings
