// Tilings, and what is made of their tiles.
#include <pybind11/complex.h>
#include <pybind11/eigen.h>
#include <pybind11/stl.h>

#include "bindings/arrays.h"
#include "bindings/bindings.h"
#include "bindings/records.h"
#include "mesh/self_intersections.h"
#include "tiles/cells.h"
#include "tiles/lines.h"
#include "tiles/places.h"
#include "tiles/relief.h"
#include "tiles/sharp_zones.h"
#include "tiling/tiling.h"
#include "turns/turned_tiling.h"

namespace holomorph::bindings {
namespace {

using namespace pybind11::literals;

using tiling::Placement;
using tiling::Tiling;

/// `compute(execution)` without the interpreter's lock, which only the progress function takes.
template <class Compute>
auto unlocked(int threads, const py::object& progress, Compute compute) {
  Execution execution(threads, callback(progress));
  const py::gil_scoped_release released;
  return compute(execution);
}

Placement place(const std::shared_ptr<mesh::Surface>& surface, std::optional<int> count, std::vector<int> vertices,
                const std::vector<bool>& allowed, bool straight, std::vector<int> labels, bool evened,
                const std::string& solver, const Placement* like, int threads, const py::object& progress) {
  tiling::PoleOptions options{
      count, std::move(vertices), {allowed.begin(), allowed.end()}, straight, std::move(labels), {solver}, evened};
  return unlocked(threads, progress,
                  [&](Execution& execution) { return tiling::place(surface, options, execution, like); });
}

Tiling tile(const Placement& placement, double tiles, const std::array<std::complex<double>, 2>& lattice,
            std::optional<double> turn, std::optional<std::array<double, 3>> direction, double max_turn,
            double evenness, bool size_counts, int threads, const py::object& progress) {
  const tiling::TilingOptions options{tiles,      {lattice[0], lattice[1]}, direction, turn, max_turn, evenness,
                                      size_counts};
  return unlocked(threads, progress, [&](Execution& execution) { return tiling::tile(placement, options, execution); });
}

Tiling move_poles(const Placement& placement, const Tiling& made, const std::vector<std::pair<int, int>>& moves,
                  double evenness, int threads, const py::object& progress) {
  std::vector<tiling::PoleMove> list;
  for (const auto& [pole, vertex] : moves) list.push_back({pole, vertex});
  return unlocked(threads, progress,
                  [&](Execution& execution) { return tiling::move_poles(placement, made, list, evenness, execution); });
}

Tiling evened(const Tiling& made, double evenness, int threads, const py::object& progress) {
  return unlocked(threads, progress, [&](Execution& execution) { return tiling::evened(made, evenness, execution); });
}

turns::Rows rows_named(const std::string& lines) {
  if (lines == "whole") return turns::Rows::kWhole;
  if (lines == "free") return turns::Rows::kFree;
  return lines == "mirror" ? turns::Rows::kMirror : turns::Rows::kNone;
}

std::unique_ptr<turns::TurnedTiler> turned_tiler(const std::shared_ptr<mesh::Surface>& surface, int turns,
                                                 std::optional<std::array<double, 3>> direction, bool is_of_u,
                                                 const std::string& up, const std::string& lines,
                                                 const Contiguous<int>& marked, std::vector<int> chosen, double price) {
  turns::TilerOptions options{turns, {}, up_axis(up), rows_named(lines), rows<int, 2>(marked), std::move(chosen),
                              price};
  if (direction) options.along = turns::Along{*direction, is_of_u};
  return unlocked(1, py::none(), [&](Execution& execution) {
    return std::make_unique<turns::TurnedTiler>(surface, options, execution);
  });
}

turns::TurnedTiling turned_tiling(turns::TurnedTiler& tiler, std::optional<double> tiles, double evenness, int threads,
                                  const py::object& progress) {
  return unlocked(threads, progress, [&](Execution& execution) {
    return tiler.tile(tiles.value_or(tiler.usual_tiles()), evenness, execution);
  });
}

// (#S, 4) edges, turns and translations
py::array jumps(const turns::TurnedTiling& made) {
  Eigen::Matrix<std::int64_t, Eigen::Dynamic, 4, Eigen::RowMajor> result(std::ssize(made.map.jumps), 4);
  for (Eigen::Index i = 0; i < result.rows(); ++i) {
    const turns::Jump& jump = made.map.jumps[i];
    result.row(i) << jump.edge, jump.turn, jump.translation[0], jump.translation[1];
  }
  return give_matrix(std::move(result));
}

uv::Quality quality_of_tiling(const Tiling& made, const std::optional<std::string>& up, int threads) {
  const std::optional<uv::Up> axis = up ? std::optional(up_axis(*up)) : std::nullopt;
  return unlocked(threads, py::none(), [&](Execution& execution) { return tiling::quality(made, axis, execution); });
}

void bind_turned_tiling(py::module_& m) {
  using turns::TurnedTiling;
  py::class_<TurnedTiling>(m, "TurnedTiling")
      .def("uv", [](const TurnedTiling& made) { return copy(made.map.uv); })
      .def("jumps", &jumps)
      .def("cones", [](const TurnedTiling& made) { return copy(made.map.cones); })
      .def("missing", [](const TurnedTiling& made) { return copy(made.map.missing); })
      .def("has_lines", [](const TurnedTiling& made) { return made.rows != turns::Rows::kNone; })
      .def_readonly("quality", &TurnedTiling::quality);
  py::class_<turns::TurnedTiler>(m, "TurnedTiler")
      .def(py::init(&turned_tiler), "surface"_a, py::kw_only(), "turns"_a, "direction"_a, "is_of_u"_a, "up"_a,
           "lines"_a, "marked"_a, "chosen"_a, "price"_a = turns::TilerOptions().price)
      .def("usual_tiles", &turns::TurnedTiler::usual_tiles)
      .def("tile", &turned_tiling, "tiles"_a, py::kw_only(), "evenness"_a, "threads"_a, "progress"_a);
  m.def(
      "found_lines",
      [](const mesh::Surface& surface, const Contiguous<int>& marked) {
        return give(turns::found_lines(surface, rows<int, 2>(marked)));
      },
      "surface"_a, "marked"_a);
  m.def(
      "are_whole", [](const Contiguous<int>& ends) { return turns::are_whole(rows<int, 2>(ends)); }, "ends"_a);
}

void bind_tiling(py::module_& m) {
  const auto conformal = [](auto member) { return [member](const Tiling& t) { return copy((*t.conformal).*member); }; };
  py::class_<Tiling>(m, "Tiling")
      .def("uv", [](const Tiling& t) { return copy(t.uv); })
      .def("tiles", [](const Tiling& t) { return t.conformal->form.problem->tiles; })
      .def("rounding",
           [](const Tiling& t) {
             const tiling::RoundingRecord& r = t.conformal->form.record;
             return std::tuple{r.integers, r.blocks, r.steps, r.excess};
           })
      .def("lattice",
           [](const Tiling& t) {
             const auto& lattice = t.conformal->form.problem->lattice;
             return copy(std::vector{lattice.a, lattice.b});
           })
      .def("periods", [](const Tiling& t) { return copy(t.conformal->seamless.periods); })
      .def("poles", conformal(&tiling::ConformalTiling::poles))
      .def("residues", conformal(&tiling::ConformalTiling::residues))
      .def("surface",
           [](const Tiling& t) { return std::const_pointer_cast<mesh::Surface>(t.conformal->structure->surface); })
      .def("zeros",
           [](const Tiling& t) { return zeros_of_map(*t.conformal->structure->surface, t.uv, t.conformal->poles); })
      .def("seams", [](const Tiling& t) { return copy(t.conformal->structure->topology.seams); })
      .def("distortion", [](const Tiling& t) { return t.conformal->distortion; })
      .def("beltrami_rms", [](const Tiling& t) { return t.conformal->beltrami_rms; });
  py::class_<Placement, std::shared_ptr<Placement>>(m, "Placement")
      .def("poles", [](const Placement& p) { return copy(p.form.poles); })
      .def("residues", [](const Placement& p) { return copy(p.form.residues); })
      .def_readonly("density_ratio", &Placement::optimal_density_ratio);
  m.def("place_poles", &place, "surface"_a, py::kw_only(), "count"_a, "vertices"_a, "allowed"_a, "straight"_a,
        "labels"_a, "evened"_a, "solver"_a, "like"_a, "threads"_a, "progress"_a);
  m.def("tile", &tile, "placement"_a, py::kw_only(), "tiles"_a, "lattice"_a, "turn"_a, "direction"_a, "max_turn"_a,
        "evenness"_a, "size_counts"_a, "threads"_a, "progress"_a);
  m.def("move_poles", &move_poles, "placement"_a, "tiling"_a, "moves"_a, py::kw_only(), "evenness"_a, "threads"_a,
        "progress"_a);
  m.def("quality_of_tiling", &quality_of_tiling, "tiling"_a, py::kw_only(), "up"_a, "threads"_a);
  m.def("evened_tiling", &evened, "tiling"_a, py::kw_only(), "evenness"_a, "threads"_a, "progress"_a);
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
  bind_tiling(m);
  bind_turned_tiling(m);
  bind_tiles(m);
}

}  // namespace holomorph::bindings
