#include "structure/balanced_map.h"

#include <cmath>
#include <utility>

#include "mesh/components.h"
#include "structure/conformal_structure.h"
#include "structure/pole_structure.h"

namespace holomorph::structure {

Eigen::VectorXcd balanced_coefficients(const Structure& structure, UvForms& forms, Execution& execution) {
  const auto& basis = structure.differentials;
  if (structure.topology.families.poles > 0) return Eigen::VectorXcd::Unit(basis.cols(), 0);
  // A single form leaves nothing to choose, and samples may cost a solve.
  const auto samples = basis.cols() > 1 ? forms.samples(execution) : uv::FormSamples();
  const auto kind = structure.topology.type.closed() ? uv::Coefficients::complex : uv::Coefficients::real;
  Eigen::VectorXcd c = uv::balanced_coefficients(*structure.surface, samples, basis, kind, execution);
  c /= std::sqrt(uv_area(structure, basis * c));
  return c;
}

uv::UvArray uv_map(const Structure& structure, UvForms& forms, const Eigen::VectorXcd& c, Execution& execution) {
  const Eigen::VectorXcd p = structure.differentials * c;
  uv::UvArray corners(structure.surface->polygons.corner_vertices.size(), 2);
  write_uv_map(structure, forms.function(p, execution), p, corners, execution.workers());
  return corners;
}

BalancedMap balanced_map(std::shared_ptr<const mesh::Surface> surface, const Options& options, Execution& execution) {
  const auto type = mesh::topological_type(*surface);
  const bool has_forms = type.form_count() > 0;
  BalancedMap map{has_forms ? conformal_structure(std::move(surface), options, execution)
                            : pole_structure(std::move(surface), Poles{}, options, execution),
                  {},
                  {}};
  const auto forms = uv_forms(map.structure, options);
  map.coefficients = balanced_coefficients(map.structure, *forms, execution);
  map.uv = uv_map(map.structure, *forms, map.coefficients, execution);
  return map;
}

}  // namespace holomorph::structure
