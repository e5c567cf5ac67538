#include <pybind11/complex.h>
#include <pybind11/eigen.h>
#include <pybind11/stl.h>

#include "bindings/arrays.h"
#include "bindings/bindings.h"
#include "bindings/callback.h"
#include "bindings/records.h"
#include "tiling/tiling.h"

namespace holomorph::bindings {
namespace {

using namespace pybind11::literals;
using tiling::Placement;
using tiling::RoundedForm;
using tiling::Tiling;

/// `compute(execution)` without the interpreter's lock, which only the progress function takes.
template <class Compute>
auto unlocked(int threads, const py::object& progress, Compute compute) {
  Execution execution(threads, callback(progress));
  const py::gil_scoped_release released;
  return compute(execution);
}

Placement place(const std::shared_ptr<mesh::Surface>& surface, std::optional<int> count, std::vector<int> vertices,
                const std::vector<bool>& allowed, bool straight, std::vector<int> labels, const std::string& solver,
                int threads, const py::object& progress) {
  tiling::PoleOptions options{count,    std::move(vertices), {allowed.begin(), allowed.end()},
                              straight, std::move(labels),   {solver}};
  return unlocked(threads, progress, [&](Execution& execution) { return tiling::place(surface, options, execution); });
}

Tiling tile(const Placement& placement, double tiles, const std::array<std::complex<double>, 2>& lattice,
            std::optional<double> turn, std::optional<std::array<double, 3>> direction, double max_turn, int threads,
            const py::object& progress) {
  const tiling::TilingOptions options{tiles, {lattice[0], lattice[1]}, direction, turn, max_turn};
  return unlocked(threads, progress, [&](Execution& execution) { return tiling::tile(placement, options, execution); });
}

Tiling move_poles(const Placement& placement, const RoundedForm& form, const std::vector<std::pair<int, int>>& moves,
                  int threads, const py::object& progress) {
  std::vector<tiling::PoleMove> list;
  for (const auto& [pole, vertex] : moves) list.push_back({pole, vertex});
  return unlocked(threads, progress,
                  [&](Execution& execution) { return tiling::move_poles(placement, form, list, execution); });
}

}  // namespace

void bind_tiling(py::module_& m) {
  py::class_<RoundedForm, std::shared_ptr<RoundedForm>>(m, "RoundedForm")
      .def_property_readonly("tiles", [](const RoundedForm& form) { return form.problem->tiles; })
      .def("lattice", [](const RoundedForm& form) {
        return copy(std::vector{form.problem->lattice.a, form.problem->lattice.b});
      });
  py::class_<Tiling, std::shared_ptr<Tiling>>(m, "Tiling")
      .def("form", [](const Tiling& t) { return std::const_pointer_cast<RoundedForm>(t.form); })
      .def("uv", [](const Tiling& t) { return copy(t.uv); })
      .def("periods", [](const Tiling& t) { return copy(t.periods); })
      .def("poles", [](const Tiling& t) { return copy(t.poles); })
      .def("residues", [](const Tiling& t) { return copy(t.residues); })
      .def("surface", [](const Tiling& t) { return std::const_pointer_cast<mesh::Surface>(t.structure->surface); })
      .def("zeros", [](const Tiling& t) { return zeros_of_map(*t.structure->surface, t.uv, t.poles); })
      .def("seams", [](const Tiling& t) { return copy(t.structure->topology.seams); })
      .def_readonly("distortion", &Tiling::distortion)
      .def_readonly("beltrami_rms", &Tiling::beltrami_rms);
  py::class_<Placement, std::shared_ptr<Placement>>(m, "Placement")
      .def("poles", [](const Placement& p) { return copy(p.form.poles); })
      .def("residues", [](const Placement& p) { return copy(p.form.residues); })
      .def_readonly("density_ratio", &Placement::optimal_density_ratio);
  m.def("place_poles", &place, "surface"_a, py::kw_only(), "count"_a, "vertices"_a, "allowed"_a, "straight"_a,
        "labels"_a, "solver"_a, "threads"_a, "progress"_a);
  m.def("tile", &tile, "placement"_a, py::kw_only(), "tiles"_a, "lattice"_a, "turn"_a, "direction"_a, "max_turn"_a,
        "threads"_a, "progress"_a);
  m.def("move_poles", &move_poles, "placement"_a, "form"_a, "moves"_a, py::kw_only(), "threads"_a, "progress"_a);
}

}  // namespace holomorph::bindings
