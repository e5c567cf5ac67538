#include "tiling/maps/assemble.h"

#include <cassert>
#include <cmath>

#include "base/errors.h"
#include "base/workers.h"
#include "linear/dense.h"

namespace holomorph::tiling {
namespace {

using mesh::edge_of;
using mesh::HalfedgeHandle;
using topology::IntegerForms;

constexpr int kMantissa = 24;  // bits of the mantissa in single precision

// Returns the classes on the surface with some diagonals flipped. By closedness a diagonal is known once the two other
// sides of a triangle are. In every polygon some triangle has two sides of the polygon, so that this ends.
IntegerForms on_flipped(IntegerForms classes, const mesh::Surface& before, const mesh::Surface& after,
                        const mesh::HalfEdges& half_edges) {
  std::vector<int> pending;
  std::vector<char> unknown(after.edges.size(), 0);
  for (int e = after.polygon_edge_count; e < static_cast<int>(after.edges.size()); ++e) {
    if (before.edges[e] == after.edges[e]) continue;
    pending.push_back(e);
    unknown[e] = 1;
  }
  const auto resolve = [&](int e) {
    for (const HalfedgeHandle h : {HalfedgeHandle(2 * e), HalfedgeHandle(2 * e + 1)}) {
      const HalfedgeHandle a = mesh::next(half_edges, h), b = mesh::next(half_edges, a);
      if (unknown[edge_of(a)] || unknown[edge_of(b)]) continue;
      const int back = -mesh::sign(h);
      const auto along_a = topology::add({}, classes.rows[edge_of(a)], back * mesh::sign(a));
      classes.rows.set(e, topology::add(along_a, classes.rows[edge_of(b)], back * mesh::sign(b)));
      unknown[e] = 0;
      return true;
    }
    return false;
  };
  while (!pending.empty()) std::erase_if(pending, resolve);
  return classes;
}

// Takes the points of the lattice nearest to n + i m = X - sum r_i C_i as periods: the rest is rounding.
SeamlessForm form_of(const structure::Structure& s, const VectorXcd& X, const VectorXcd& r,
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
    // Along straight loops v does not change, and periods are real.
    form.periods[j] =
        straight ? Complex(std::round(period.real() / lattice.a.real()) * lattice.a.real()) : lattice.nearest(period);
  }
  if (!s.topology.type.closed())
    p.head(families.harmonic()) = s.holomorphic().differentials * (form.periods + from_poles);
  p.head(families.natural) = form.periods;
  // With straight loops the v-periods of the handles are those of the Dirichlet forms, i times real coefficients.
  // Together with u they are points of the lattice.
  const int handles = straight ? 2 * s.topology.type.genus : 0;
  for (Index j = families.natural; j < families.natural + handles; ++j) {
    auto& u = form.periods[j - families.natural];
    u = lattice.nearest(u + p[j]);
    p[j - families.natural] = u.real();
    p[j] = Complex(0, u.imag());
  }
  return form;
}

}  // namespace

SeamlessMaps::SeamlessMaps(std::shared_ptr<const PoleBasis> basis, bool straight, const std::vector<int>& vertices,
                           const std::vector<int>& labels, const structure::Options& options, Execution& execution)
    : basis_(std::move(basis)), straight_(straight) {
  const structure::Structure& plain = basis_->structure();
  structure::Poles poles{vertices, std::vector<Complex>(vertices.size(), 1.0), labels};
  if (vertices.empty()) {
    structure_ = {basis_, &plain};
  } else if (basis_->closed()) {
    // Any residues will do here: the maps take their own.
    poles.residues.back() = -static_cast<double>(vertices.size() - 1);
    set_up_closed(std::move(poles), options, execution);
    return;
  } else {
    structure_ = std::make_shared<structure::Structure>(
        structure::pole_structure(plain.surface, std::move(poles), options, execution));
    pole_parts_ = held(structure_->poles).harmonic_part;
  }
  change_ = change_of_basis(plain.topology.classes, *structure_);
  if (pole_parts_.size() > 0) pole_parts_ = linear::inverse(change_) * pole_parts_;
}

void SeamlessMaps::set_up_closed(structure::Poles poles, const structure::Options& options, Execution& execution) {
  cut_at(std::move(poles), execution);
  execution.stage("solver", 0.3, 0.6);
  solver_ = flipped_ ? nullptr : basis_->solver();
  if (!solver_) {
    solver_ = std::make_shared<const PoleBasis::Solver>([=, this](Execution& asking) {
      return std::make_unique<structure::HarmonicSolver>(discretisation(), 2, options, asking);
    });
    solver_->borrow(execution);  // made in this stage
  }
  const structure::Structure& plain = basis_->structure();
  change_ = change_of_basis(plain.topology.classes, *structure_);
  pole_parts_.resize(change_.rows(), structure_->topology.families.poles);
  if (change_.rows() == 0) return;
  // Away from the flipped diagonals the harmonic forms are those of the basis, and integers are all that is wanted.
  const auto& half_edges = discretisation().half_edges;
  const auto classes = on_flipped(plain.topology.classes, *plain.surface, *structure_->surface, half_edges);
  pole_parts_ = forms::harmonic_part(half_edges, pole_forms_, {classes, *plain.harmonic.functions},
                                     plain.harmonic.invariants.energies.gram[0]);
}

void SeamlessMaps::cut_at(structure::Poles poles, Execution& execution) {
  const auto& surface = basis_->structure().surface;
  if (surface->has_diagonals()) {
    auto made = structure::surface_with_poles(surface, std::move(poles), execution);
    flipped_ = std::move(made.discretisation);
    pole_forms_ = std::move(made.pole_forms);
    structure_ = std::make_shared<structure::Structure>(std::move(made.structure));
    return;
  }
  structure::Structure s;
  s.surface = surface;
  structure::check_poles(poles, surface->vertex_count, true);
  auto stars = mesh::stars(discretisation().half_edges, discretisation().lengths, poles.vertices, poles.labels);
  s.poles = structure::PoleData{std::move(poles), std::move(stars), {}};
  pole_forms_ = structure::cut_at_poles(s, discretisation(), execution);
  structure_ = std::make_shared<structure::Structure>(std::move(s));
}

SeamlessForm SeamlessMaps::form(const VectorXcd& X, const VectorXcd& residues, const TextureLattice& lattice) const {
  if (!solver_) return form_of(*structure_, change_ * X, residues, lattice, straight_);
  // The residues sum to 0, so that the last pole has no form of its own.
  const VectorXcd r = residues.head(residues.size() - 1);
  VectorXcd periods = X - pole_parts_ * r;
  for (Complex& period : periods) period = lattice.nearest(period);
  SeamlessForm result{change_ * periods, VectorXcd(structure_->topology.families.count())};
  result.coefficients << result.periods, r, Complex(0, 1) * r;
  return result;
}

uv::UvArray SeamlessMaps::function(const SeamlessForm& form, Execution& execution) const {
  if (!solver_) return function_of(*structure_, form, execution);
  const Execution::Within within(execution);
  execution.stage("function", 0.6, 1.0);
  const auto& topology = structure_->topology;
  const auto& families = topology.families;
  const auto natural = topology::first_forms(topology.classes, families.natural, families.natural);
  return forms::function_with_poles(discretisation().half_edges, discretisation().weights, pole_forms_, natural,
                                    form.periods, form.coefficients.segment(families.natural, families.poles),
                                    solver_->borrow(execution)->systems(), execution);
}

MatrixXd change_of_basis(const topology::IntegerForms& old, const structure::Structure& s) {
  const int count = s.topology.families.natural;
  // The periods of the old classes over the new loops, integers.
  MatrixXd N = MatrixXd::Zero(count, count);
  for (int i = 0; i < count; ++i) {
    for (const mesh::HalfedgeHandle h : s.topology.homology_basis[i]) {
      assert(!s.surface->is_diagonal(mesh::edge_of(h)));  // a diagonal may have been flipped
      for (const auto& [form, value] : topology::forms_between(old.rows[mesh::edge_of(h)], 0, count))
        N(i, form) += mesh::sign(h) * value;
    }
  }
  return N;
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
  // Moves the map to the origin, where single precision is finest.
  const Eigen::RowVector2d middle = (function.colwise().maxCoeff() + function.colwise().minCoeff()) / 2;
  function.rowwise() -= middle.array().round().matrix();
  uv::UvArray uv(static_cast<Index>(s.surface->polygons.corner_vertices.size()), 2);
  structure::write_uv_map(s, function, p, uv, execution.workers());
  // The spacing of single precision at the largest coordinate, known after a first pass. On this grid UVs that jump by
  // whole units are exact in single precision.
  const double grid = std::exp2(std::ceil(std::log2(uv.cwiseAbs().maxCoeff())) - kMantissa);
  function = (function / grid).array().round() * grid;
  structure::write_uv_map(s, function, p, uv, execution.workers());
  return uv;
}

}  // namespace holomorph::tiling
