// Tilings, and what is made of their tiles.
#include <pybind11/complex.h>
#include <pybind11/eigen.h>
#include <pybind11/stl.h>

#include "bindings/arrays.h"
#include "bindings/bindings.h"
#include "bindings/records.h"
#include "choice/quads.h"
#include "choice/tilers.h"
#include "mesh/triangle_tree.h"
#include "tiles/cells.h"
#include "tiles/lines_and_places.h"
#include "tiles/quads.h"
#include "tiles/relief.h"
#include "tiles/sharp_zones.h"
#include "tiling/cones/turned_tiling.h"

namespace holomorph::bindings {
namespace {

using namespace pybind11::literals;
using choice::BoundaryLines;
using choice::Heading;
using choice::SeamlessMap;
using choice::TileOptions;
using choice::Tiler;

const char* name_of(tiling::Rows rows) {
  constexpr std::array<const char*, 4> kNames{"none", "whole", "free", "mirror"};
  return kNames[static_cast<std::size_t>(rows)];
}

std::shared_ptr<choice::Part> part(const std::shared_ptr<mesh::Surface>& surface, const std::string& up,
                                   std::vector<int> labels) {
  return unlocked(1, py::none(), [&](Execution& execution) {
    return shared(choice::part_of(surface, up_axis(up), std::move(labels), execution));
  });
}

TileOptions tile_options(double tiles, double evenness, std::optional<int> count, std::vector<int> poles,
                         const std::vector<bool>& allowed, const std::array<Complex, 2>& lattice, bool is_upright,
                         std::optional<std::array<double, 3>> direction, std::optional<double> turn, double max_turn,
                         const std::string& boundary, std::optional<double> max_added,
                         const std::vector<std::pair<int, int>>& moves, int turns, const std::string& lines,
                         const Contiguous<int>& marked, std::optional<std::vector<int>> missing) {
  TileOptions result;
  result.tiles = tiles;
  result.evenness = evenness;
  result.poles = {count, std::move(poles), {allowed.begin(), allowed.end()}};
  result.lattice = lattice;
  using Kind = Heading::Kind;
  result.heading.kind = is_upright ? Kind::kUpright : direction ? Kind::kVector : Kind::kAny;
  if (direction) result.heading.vector = *direction;
  result.turn = turn;
  result.max_turn = max_turn;
  result.boundary = boundary == "straight" ? BoundaryLines::kStraight
                    : boundary == "free"   ? BoundaryLines::kFree
                                           : BoundaryLines::kAutomatic;
  result.max_added = max_added;
  for (const auto& [pole, vertex] : moves) result.moves.push_back({pole, vertex});
  result.turns = turns;
  result.rows = rows_named(lines);
  result.marked = rows<int, 2>(marked);
  result.missing = std::move(missing);
  return result;
}

void bind_tilings_of_parts(py::module_& m) {
  py::class_<choice::Part, std::shared_ptr<choice::Part>>(m, "WholePart")
      .def(py::init(&part), "surface"_a, "up"_a, "labels"_a);
  py::class_<TileOptions>(m, "TileOptions")
      .def(py::init(&tile_options), py::kw_only(), "tiles"_a, "evenness"_a, "count"_a, "poles"_a, "allowed"_a,
           "lattice"_a, "is_upright"_a, "direction"_a, "turn"_a, "max_turn"_a, "boundary"_a, "max_added"_a, "moves"_a,
           "turns"_a, "lines"_a, "marked"_a, "missing"_a);
  py::class_<SeamlessMap, std::shared_ptr<SeamlessMap>>(m, "SeamlessMap")
      .def_property_readonly("uv", [](const SeamlessMap& made) { return copy(made.uv); })
      .def_readonly("quality", &SeamlessMap::quality)
      .def_property_readonly("triangulation", [](const SeamlessMap& made) { return shared(made.triangulation); })
      .def_readonly("tiles", &SeamlessMap::tiles)
      .def_readonly("evenness", &SeamlessMap::evenness)
      .def_readonly("lattice", &SeamlessMap::lattice)
      .def_property_readonly("seams",
                             [](const py::object& self) { return view(self.cast<const SeamlessMap&>().seams, self); })
      .def_property_readonly("periods", [](const SeamlessMap& made) { return copy_rows(made.periods); })
      .def_property_readonly("poles", [](const SeamlessMap& made) { return copy(made.poles); })
      .def_property_readonly("residues", [](const SeamlessMap& made) { return copy(made.residues); })
      .def_property_readonly("zeros", [](const SeamlessMap& made) { return zeros_by_columns(made.zeros); })
      .def_readonly("added_distortion", &SeamlessMap::added_distortion)
      .def_readonly("beltrami_rms", &SeamlessMap::beltrami_rms)
      .def_readonly("optimal_size_range", &SeamlessMap::optimal_size_range)
      .def_property_readonly("rounding",
                             [](const SeamlessMap& made) {
                               const tiling::RoundingRecord& r = made.rounding;
                               return std::tuple{r.integers, r.blocks, r.steps, r.excess};
                             })
      .def_readonly("turns", &SeamlessMap::turns)
      .def_property_readonly("cones", [](const SeamlessMap& made) { return copy(made.cones); })
      .def_property_readonly("cone_angles", [](const SeamlessMap& made) { return copy(made.cone_angles); })
      .def_property_readonly("jumps", [](const SeamlessMap& made) { return copy_rows(made.jumps); })
      .def_property_readonly("lines", [](const SeamlessMap& made) { return name_of(made.rows); });
}

using MutableTiler = std::shared_ptr<Tiler>;
using MutableSeamless = std::shared_ptr<SeamlessMap>;

MutableTiler tiler(const std::shared_ptr<choice::Part>& part, const TileOptions& options, bool evened,
                   const std::string& solver, const Tiler* like, int threads, const py::object& progress) {
  return unlocked(threads, progress, [&](Execution& execution) {
    return std::make_shared<Tiler>(part, options.poles, options.boundary, evened, solver, nullptr, like, execution);
  });
}

void bind_tiler(py::module_& m) {
  py::class_<Tiler, MutableTiler>(m, "Tiler")
      .def(py::init(&tiler), "part"_a, "options"_a, py::kw_only(), "evened"_a, "solver"_a, "like"_a, "threads"_a,
           "progress"_a)
      .def("poles", [](const Tiler& own) { return copy(own.placement().form.poles); })
      .def("residues", [](const Tiler& own) { return copy(own.placement().form.residues); })
      .def("density_ratio", [](const Tiler& own) { return own.placement().optimal_density_ratio; })
      .def(
          "tile",
          [](const Tiler& own, const TileOptions& options, int threads, const py::object& progress) {
            return unlocked(threads, progress,
                            [&](Execution& execution) { return shared(own.tile(options, execution)); });
          },
          "options"_a, py::kw_only(), "threads"_a, "progress"_a)
      .def(
          "evened",
          [](const Tiler& own, const MutableSeamless& tiling, double evenness, int threads,
             const py::object& progress) {
            return unlocked(threads, progress,
                            [&](Execution& execution) { return shared(own.evened(*tiling, evenness, execution)); });
          },
          "tiling"_a, "evenness"_a, py::kw_only(), "threads"_a, "progress"_a)
      .def(
          "moved",
          [](const Tiler& own, const MutableSeamless& tiling, const TileOptions& options, int threads,
             const py::object& progress) {
            return unlocked(threads, progress, [&](Execution& execution) {
              return shared(own.moved(*tiling, options.moves, options.evenness, execution));
            });
          },
          "tiling"_a, "options"_a, py::kw_only(), "threads"_a, "progress"_a);
}

void bind_turned_tiling(py::module_& m) {
  m.def(
      "found_lines",
      [](const mesh::Surface& surface, const Contiguous<int>& marked) {
        return give(tiling::found_lines(surface, rows<int, 2>(marked)));
      },
      "surface"_a, "marked"_a);
}

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
                                 const Eigen::Matrix2i& steps, int turns, int threads) {
  const Eigen::Map<const tiles::Corners> corners(uv.data(), uv.shape(0), 2);
  const py::gil_scoped_release unlocked;
  Execution execution(threads);
  return tiles::tile_coordinates(surface, corners, {inverse_lattice, origin, steps, turns}, execution);
}

// What is found in the tiles, in a stage of its own.
template <class Find>
auto found(int threads, const py::object& progress, const Find& find) {
  Execution execution(threads, callback(progress));
  const py::gil_scoped_release unlocked;
  execution.stage("tiles", 0, 1);
  auto result = find(execution);
  execution.finish();
  return result;
}

Places places(const Surface& surface, const TileCoordinates& coordinates, int threads, const py::object& progress) {
  return found(threads, progress, [&](Execution& execution) { return tiles::places(surface, coordinates, execution); });
}

Lines lines(const Surface& surface, const TileCoordinates& coordinates, int threads, const py::object& progress) {
  return found(threads, progress, [&](Execution& execution) { return tiles::lines(surface, coordinates, execution); });
}

Cells cells(const Surface& surface, const TileCoordinates& coordinates, bool bricks, int threads,
            const py::object& progress) {
  const auto pattern = bricks ? tiles::Pattern::bricks : tiles::Pattern::grid;
  return found(threads, progress, [&](Execution& execution) {
    const tiles::EdgeNodes nodes = tiles::edge_nodes(surface, coordinates, execution);
    return tiles::cells(tiles::pieces(surface, coordinates, nodes, pattern, execution), execution);
  });
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
    pairs = mesh::self_intersections(points, corners, execution);
  }
  return copy_rows(pairs);
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

void bind_quads(py::module_& m) {
  using choice::Quads;
  using choice::Tilers;
  py::class_<Quads>(m, "Quads")
      .def_property_readonly("cells", [](const Quads& made) { return made.cells; })
      .def_property_readonly("lines", [](const Quads& made) { return name_of(made.map->rows); });
  py::class_<Tilers>(m, "Tilers")
      .def(py::init([](const std::shared_ptr<choice::Part>& part) { return std::make_unique<Tilers>(part); }), "part"_a)
      .def(
          "quads",
          [](Tilers& own, double faces, const std::string& lines, const Contiguous<int>& marked, double evenness,
             int threads, const py::object& progress) {
            return unlocked(threads, progress, [&](Execution& execution) {
              execution.stage("quads", 0.0, 1.0);
              return choice::quads(own, {faces, rows_named(lines), rows<int, 2>(marked), evenness}, execution);
            });
          },
          "faces"_a, "lines"_a, "marked"_a, py::kw_only(), "evenness"_a, "threads"_a, "progress"_a);
  m.def(
      "needed_vertices",
      [](const Contiguous<int>& offsets, const Contiguous<int>& corner_vertices, const Contiguous<bool>& is_needed) {
        return copy(tiles::needed_vertices({offsets.data(), static_cast<std::size_t>(offsets.size())},
                                           {corner_vertices.data(), static_cast<std::size_t>(corner_vertices.size())},
                                           {is_needed.data(), is_needed.data() + is_needed.size()}));
      },
      "offsets"_a, "corner_vertices"_a, "is_needed"_a);
}

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
      .def_property_readonly("is_whole", member(&Cells::is_whole))
      .def_property_readonly("turns", member(&Cells::turns));
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
  m.def(
      "corner_fans",
      [](const Surface& surface, const Contiguous<bool>& is_sharp) { return copy(corner_fans(surface, is_sharp)); },
      "surface"_a, "is_sharp"_a);
  m.def("crossings", &crossings, "vertices"_a, "triangles"_a, py::kw_only(), "threads"_a);
  m.def("lines", &lines, "surface"_a, "coordinates"_a, py::kw_only(), "threads"_a, "progress"_a);
  m.def("cells", &cells, "surface"_a, "coordinates"_a, py::kw_only(), "bricks"_a, "threads"_a, "progress"_a);
  m.def("tile_coordinates", &tile_coordinates, "surface"_a, "uv"_a, py::kw_only(), "inverse_lattice"_a, "origin"_a,
        "steps"_a, "turns"_a = 1, "threads"_a);
  m.def("places", &places, "surface"_a, "coordinates"_a, py::kw_only(), "threads"_a, "progress"_a);
}

}  // namespace

void bind_tilings(py::module_& m) {
  bind_tilings_of_parts(m);
  bind_tiler(m);
  bind_turned_tiling(m);
  bind_tiles(m);
  bind_quads(m);
}

}  // namespace holomorph::bindings
