#include <pybind11/complex.h>
#include <pybind11/eigen.h>
#include <pybind11/stl.h>

#include "bindings/arrays.h"
#include "bindings/bindings.h"
#include "bindings/callback.h"
#include "tiling/pole_placement.h"

namespace holomorph::bindings {
namespace {

py::tuple try_poles(const std::shared_ptr<mesh::Surface>& surface, int count, bool real, int threads) {
  Execution execution(threads);
  tiling::Landscape landscape(surface, {}, execution);
  tiling::PlacementRules rules;
  rules.kind = real ? uv::Coefficients::real : uv::Coefficients::complex;
  auto poles = tiling::without_more_poles(landscape, rules, execution);
  const double before = tiling::density_ratio(tiling::density(landscape, poles, execution));
  poles = tiling::with_more_poles(landscape, rules, poles, count, execution);
  const double after = tiling::density_ratio(tiling::density(landscape, poles, execution));
  return py::make_tuple(copy(poles.vertices), copy(poles.residues), poles.variance, before, after);
}

}  // namespace

void bind_tiling(py::module_& m) { m.def("try_poles", &try_poles); }

}  // namespace holomorph::bindings
