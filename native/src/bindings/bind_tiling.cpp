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
                const std::string& solver, int threads, const py::object& progress) {
  tiling::PoleOptions options{
      count, std::move(vertices), {allowed.begin(), allowed.end()}, straight, std::move(labels), {solver}, evened};
  return unlocked(threads, progress, [&](Execution& execution) { return tiling::place(surface, options, execution); });
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

}  // namespace

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
        "labels"_a, "evened"_a, "solver"_a, "threads"_a, "progress"_a);
  m.def("tile", &tile, "placement"_a, py::kw_only(), "tiles"_a, "lattice"_a, "turn"_a, "direction"_a, "max_turn"_a,
        "evenness"_a, "size_counts"_a, "threads"_a, "progress"_a);
  m.def("move_poles", &move_poles, "placement"_a, "tiling"_a, "moves"_a, py::kw_only(), "evenness"_a, "threads"_a,
        "progress"_a);
  m.def("evened_tiling", &evened, "tiling"_a, py::kw_only(), "evenness"_a, "threads"_a, "progress"_a);
}

}  // namespace holomorph::bindings
