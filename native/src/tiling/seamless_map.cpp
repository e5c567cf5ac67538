#include "tiling/seamless_map.h"

#include <cassert>
#include <cmath>

#include "base/chunks.h"

namespace holomorph::tiling {

using Complex = std::complex<double>;
using Eigen::Index;
using Eigen::VectorXcd;

constexpr int kMantissa = 24;  // bits of a single precision number

Eigen::MatrixXd change_of_basis(const topology::IntegerForms& old, const structure::Structure& s) {
  const int count = s.topology.families.natural;
  Eigen::MatrixXd N = Eigen::MatrixXd::Zero(count, count);
  for (int i = 0; i < count; ++i) {
    for (const mesh::HalfedgeHandle h : s.topology.homology_basis[i]) {
      assert(!s.surface->is_diagonal(mesh::edge_of(h)));  // a diagonal may have been flipped
      for (const auto& [form, value] : topology::forms_between(old.rows[mesh::edge_of(h)], 0, count))
        N(i, form) += mesh::sign(h) * value;
    }
  }
  return N;
}

SeamlessForm seamless_form(const structure::Structure& s, const VectorXcd& X, const VectorXcd& r,
                           const TextureLattice& lattice, bool straight) {
  const auto& families = s.topology.families;
  SeamlessForm form{VectorXcd(families.natural), VectorXcd::Zero(families.count())};
  auto& p = form.coefficients;
  p.segment(families.harmonic(), families.poles) = r;
  p.tail(families.poles) = Complex(0, 1) * r;
  const VectorXcd from_poles =
      s.poles ? VectorXcd(s.poles->harmonic_part * r) : VectorXcd(VectorXcd::Zero(families.natural));
  for (Index j = 0; j < form.periods.size(); ++j) {
    const Complex period = X[j] - from_poles[j];
    form.periods[j] =
        straight ? Complex(std::round(period.real() / lattice.a.real()) * lattice.a.real()) : lattice.nearest(period);
  }
  if (!s.topology.type.closed())
    p.head(families.harmonic()) = s.holomorphic().differentials * (form.periods + from_poles);
  p.head(families.natural) = form.periods;
  // The v-periods of the handles.
  const int handles = straight ? 2 * s.topology.type.genus : 0;
  for (Index j = families.natural; j < families.natural + handles; ++j) {
    auto& u = form.periods[j - families.natural];
    u = lattice.nearest(u + p[j]);
    p[j - families.natural] = u.real();
    p[j] = Complex(0, u.imag());
  }
  return form;
}

uv::UvArray function_of(const structure::Structure& s, const SeamlessForm& form, Execution& execution) {
  Eigen::Matrix<double, Eigen::Dynamic, 2> parts(form.coefficients.size(), 2);
  parts << form.coefficients.real(), form.coefficients.imag();
  const forms::RowMajorMatrix& functions = *s.harmonic.functions;
  uv::UvArray function(functions.rows(), 2);
  for_rows(execution.workers(), static_cast<int>(function.rows()),
           [&](int v) { function.row(v).noalias() = functions.row(v) * parts; });
  return function;
}

uv::UvArray seamless_uv(const structure::Structure& s, const SeamlessForm& form, uv::UvArray function,
                        Execution& execution) {
  const auto& p = form.coefficients;
  const Eigen::RowVector2d middle = (function.colwise().maxCoeff() + function.colwise().minCoeff()) / 2;
  function.rowwise() -= middle.array().round().matrix();
  uv::UvArray uv(static_cast<Index>(s.surface->polygons.corner_vertices.size()), 2);
  structure::write_uv_map(s, function, p, uv, execution.workers());
  const double grid = std::exp2(std::ceil(std::log2(uv.cwiseAbs().maxCoeff())) - kMantissa);
  function = (function / grid).array().round() * grid;
  structure::write_uv_map(s, function, p, uv, execution.workers());
  return uv;
}

}  // namespace holomorph::tiling
