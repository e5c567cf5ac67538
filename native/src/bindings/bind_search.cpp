// The structure of a part of any kind, and the search for its map.
#include <pybind11/complex.h>
#include <pybind11/eigen.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/constants.h"
#include "bindings/arrays.h"
#include "bindings/bindings.h"
#include "bindings/records.h"
#include "choice/any_structure.h"
#include "choice/automatic_map.h"
#include "choice/automatic_structure.h"
#include "choice/map_search.h"
#include "choice/truncated.h"
#include "choice/untiled.h"

namespace holomorph::bindings {
namespace {

using namespace pybind11::literals;
using namespace choice;

using Shared = std::shared_ptr<AnyStructure>;
using MutableMap = std::shared_ptr<Map>;
using MutablePart = std::shared_ptr<Part>;

constexpr std::array<const char*, 6> kKinds{"forms", "strip", "log", "disk", "rectangle", "flat"};

MapKind kind_named(const std::string& name) {
  return static_cast<MapKind>(std::ranges::find(kKinds, name) - kKinds.begin());
}

// The solution of a structure made of forms, also of a coarse log map.
StructurePointer solved(const Shared& made) {
  if (const auto forms = std::dynamic_pointer_cast<Forms>(made)) return forms->solved();
  const auto truncated = std::dynamic_pointer_cast<Truncated>(made);
  return truncated ? truncated->solved() : nullptr;
}

std::shared_ptr<flat::PlaneMap> plane_map_of(const Shared& made) {
  const auto plane = std::dynamic_pointer_cast<PlaneStructure>(made);
  return plane ? shared(plane->map()) : nullptr;
}

void bind_any_structure(py::module_& m) {
  py::class_<AnyStructure, Shared>(m, "AnyStructure")
      .def_property_readonly("kind", [](const AnyStructure& made) { return kKinds[static_cast<int>(made.kind())]; })
      .def_property_readonly("is_truncated",
                             [](const Shared& made) { return bool(std::dynamic_pointer_cast<Truncated>(made)); })
      .def_property_readonly("solved", &solved)
      .def_property_readonly("plane_map", &plane_map_of)
      .def(
          "uv",
          [](AnyStructure& made, const Eigen::VectorXcd& coefficients, int threads) {
            return give_matrix(
                unlocked(threads, py::none(), [&](Execution& execution) { return made.uv(coefficients, execution); }));
          },
          "coefficients"_a, "threads"_a)
      .def(
          "tile",
          [](AnyStructure& made, const TileOptions& options, int threads, const py::object& progress) {
            return unlocked(threads, progress, [&](Execution& execution) {
              execution.stage("tiling", 0.0, 1.0);
              return shared(made.tilers().tile(options, execution));
            });
          },
          "options"_a, py::kw_only(), "threads"_a, "progress"_a)
      .def(
          "tiler",
          [](AnyStructure& made, const TileOptions& options, bool evened, int threads, const py::object& progress) {
            return unlocked(threads, progress, [&](Execution& execution) {
              execution.stage("tiling", 0.0, 1.0);
              return shared(nested(execution, 0.0, 1.0, [&] {
                return made.tilers().tiler(options.poles, options.boundary, evened, execution);
              }));
            });
          },
          "options"_a, py::kw_only(), "evened"_a, "threads"_a, "progress"_a)
      .def(
          "seams",
          [](AnyStructure& made, int threads) {
            return give(unlocked(threads, py::none(), [&](Execution& execution) { return made.seams(execution); }));
          },
          "threads"_a);
  m.def(
      "forms_structure",
      [](const std::string& kind, const MutablePart& part, const StructurePointer& solved) -> Shared {
        return std::make_shared<Forms>(kind_named(kind), part, solved);
      },
      "kind"_a, "part"_a, "solved"_a);
  m.def(
      "plane_structure",
      [](const std::string& kind, const MutablePart& part, const std::shared_ptr<flat::PlaneMap>& map,
         double modulus) -> Shared { return std::make_shared<PlaneStructure>(kind_named(kind), part, map, modulus); },
      "kind"_a, "part"_a, "map"_a, "modulus"_a);
  m.def(
      "automatic_structure",
      [](const MutablePart& part, const std::string& solver, int threads, std::int64_t memory_limit,
         const py::object& progress) {
        return unlocked(threads, progress, [&](Execution& execution) {
          return choice::automatic_structure(part, {solver, memory_limit}, execution);
        });
      },
      "part"_a, py::kw_only(), "solver"_a, "threads"_a, "memory_limit"_a, "progress"_a);
}

constexpr std::array<const char*, 5> kMains{"automatic", "seamless", "untiled", "balanced", "islands"};

// The facade has checked the names.
Request request(const MutablePart& part, const Shared& structure, const std::string& main, double evenness,
                const TileOptions& tiling, const std::string& lines, const Contiguous<int>& seams, double hard_edges,
                double most_stretch, double effort) {
  Request result;
  result.part = part;
  result.structure = structure;
  result.main = static_cast<Main>(std::ranges::find(kMains, main) - kMains.begin());
  result.evenness = evenness;
  result.tiling = tiling;
  if (lines != "automatic") result.rows = rows_named(lines);
  result.cuts = {rows<int, 2>(seams), hard_edges, most_stretch};
  result.effort = effort;
  return result;
}

const char* kind(const Map& made) {
  if (made.tiling()) return "tiling";
  return made.is_tiled() ? "mixed" : made.is_in_islands() ? "islands" : "forms";
}

// What a layout says; nothing of a tiling, which has no visible seams.
template <class Value>
auto of_layout(Value flat::Layout::*member) {
  return [member](const Map& made) { return made.layout() ? *made.layout().*member : Value(); };
}

std::vector<std::shared_ptr<SeamlessMap>> tilings(const Map& made) {
  std::vector<std::shared_ptr<SeamlessMap>> result;
  for (const SeamlessPointer& tiling : made.tilings()) result.push_back(shared(tiling));
  return result;
}

void bind_maps_of_parts(py::module_& m) {
  py::class_<Map, MutableMap>(m, "Map")
      .def_property_readonly("kind", &kind)
      .def_property_readonly("uv", [](const Map& made) { return copy(made.uv()); })
      .def_property_readonly("quality", &Map::quality)
      .def_property_readonly("evenness", &Map::evenness)
      .def_property_readonly("why", &Map::why)
      .def_property_readonly("structure", [](const Map& made) { return made.structure(); })
      .def_property_readonly("seams",
                             [](const py::object& self) { return view(self.cast<const Map&>().seams(), self); })
      .def_property_readonly("soft_length", of_layout(&flat::Layout::soft_length))
      .def_property_readonly("hard_length", of_layout(&flat::Layout::hard_length))
      .def_property_readonly("islands", of_layout(&flat::Layout::islands))
      .def_property_readonly("tilings", &tilings)
      .def_property_readonly("coefficients", [](const Map& made) { return copy(made.coefficients()); });
  m.def(
      "form_map",
      [](const Shared& structure, double evenness, bool is_upright, const std::string& why, int threads,
         const py::object& progress) {
        return unlocked(threads, progress, [&](Execution& execution) {
          execution.stage("map", 0.0, 1.0);
          return shared(choice::form_map(structure->part(), structure, evenness, is_upright, why, execution));
        });
      },
      "structure"_a, py::kw_only(), "evenness"_a, "is_upright"_a, "why"_a, "threads"_a, "progress"_a);
  m.def(
      "island_map",
      [](const MutablePart& part, double evenness, int threads, const py::object& progress) {
        return unlocked(threads, progress, [&](Execution& execution) {
          execution.stage("map", 0.0, 1.0);
          Untiled untiled(part, nullptr, evenness, true, execution);
          return shared(untiled.islands(kInfinity, kInfinity, execution));
        });
      },
      "part"_a, py::kw_only(), "evenness"_a, "threads"_a, "progress"_a);
}

using Window2 = std::optional<std::pair<double, double>>;

SizePolicy size_policy(double density, int tries, std::optional<double> tolerance, const Window2& window, double near) {
  SizePolicy result{density, tries, tolerance, {}, near};
  if (window) result.window = Window{window->first, window->second};
  return result;
}

Window2 window_of(const SizePolicy& size) {
  return size.window ? std::optional(std::pair(size.window->low, size.window->high)) : std::nullopt;
}

void bind_map_objects(py::module_& m) {
  py::class_<Request>(m, "Request")
      .def(py::init(&request), "part"_a, "structure"_a, py::kw_only(), "main"_a, "evenness"_a, "tiling"_a, "lines"_a,
           "seams"_a, "hard_edges"_a, "most_stretch"_a, "effort"_a);
  py::class_<SizePolicy>(m, "SizePolicy")
      .def(py::init(&size_policy), "density"_a, "tries"_a, "tolerance"_a, "window"_a, "near"_a)
      .def_static(
          "of_tiles",
          [](const std::vector<MutablePart>& parts, double tiles) {
            return SizePolicy::of_tiles({parts.begin(), parts.end()}, tiles);
          },
          "parts"_a, "tiles"_a)
      .def_static("of_density", &SizePolicy::of_density, "density"_a, "tolerance"_a)
      .def_readonly("density", &SizePolicy::density)
      .def_readonly("tries", &SizePolicy::tries)
      .def_readonly("tolerance", &SizePolicy::tolerance)
      .def_property_readonly("window", &window_of)
      .def_readonly("near", &SizePolicy::near);
  py::class_<Made>(m, "Made")
      .def_property_readonly("map", [](const Made& made) { return shared(made.map); })
      .def_property_readonly("first", [](const Made& made) { return made.copy.first; })
      .def_property_readonly("scale", [](const Made& made) { return made.copy.scale; })
      .def("raise_refusal", [](const Made& made) {
        if (made.refused) std::rethrow_exception(made.refused);
      });
  m.def(
      "map_objects",
      [](const std::vector<std::vector<Request>>& objects, const SizePolicy& size, int threads,
         const py::object& progress) {
        std::vector<std::pair<std::vector<Made>, SizePolicy>> result;
        for (MappedParts& made :
             unlocked(threads, progress, [&](Execution& execution) { return map_objects(objects, size, execution); }))
          result.emplace_back(std::move(made.parts), made.size);
        return result;
      },
      "objects"_a, "size"_a, py::kw_only(), "threads"_a, "progress"_a);
  m.def(
      "copies",
      [](const std::vector<MutablePart>& parts, const py::object& progress) {
        const auto found = unlocked(1, progress, [&](Execution& execution) {
          execution.stage("copies", 0.0, 1.0);
          return copies({parts.begin(), parts.end()}, execution);
        });
        std::vector<std::pair<int, double>> result;
        for (const Copy& copy : found) result.emplace_back(copy.first, copy.scale);
        return result;
      },
      "parts"_a, "progress"_a);
  m.def(
      "form_count", [](const Part& part) { return form_count(part); }, "part"_a);
  m.def("has_too_many_forms", &has_too_many_forms, "part"_a);
  m.def("is_outline", &is_outline, "part"_a);
}

}  // namespace

void bind_search(py::module_& m) {
  bind_any_structure(m);
  bind_maps_of_parts(m);
  bind_map_objects(m);
}

}  // namespace holomorph::bindings
