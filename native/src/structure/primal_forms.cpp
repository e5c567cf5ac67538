#include "structure/primal_forms.h"

#include <cmath>
#include <utility>

#include "base/workers.h"
#include "forms/closed_forms.h"
#include "mesh/components.h"
#include "structure/conformal_structure.h"
#include "structure/pole_structure.h"
#include "uv/balance.h"

namespace holomorph::structure {

namespace {

// The intrinsic functions are taken as they are if at most this part of the energy could be gained. It bounds the
// squared relative distance between the forms.
constexpr double kNegligibleGain = 1e-9;

mesh::Discretisation on_own_triangles(const mesh::Surface& surface, Execution& execution) {
  return mesh::on_input(surface, mesh::half_edges(surface, execution), execution);
}

class KeptForms final : public PrimalForms {
 public:
  KeptForms(const Structure& structure, const Options& options)
      : structure_(structure), options_(options), functions_(structure.harmonic.functions) {
    report_ = structure.record.solver;
    // Without flips both triangulations are the same.
    ready_ = structure.record.flip_count == 0;
  }

  void prepare(Execution& execution) override {
    if (ready_) return;
    execution.stage("input triangulation", 0.0, 0.2);
    if (!is_negligible(execution)) solve_again(execution);
    execution.finish();
    ready_ = true;
  }

  uv::UvArray function(const Eigen::VectorXcd& p, Execution& execution) override {
    prepare(execution);
    Eigen::Matrix<double, Eigen::Dynamic, 2> coefficients(p.size(), 2);
    coefficients << p.real(), p.imag();
    uv::UvArray result(functions_->rows(), 2);
    for_rows(execution.workers(), static_cast<int>(result.rows()),
             [&](int v) { result.row(v).noalias() = functions_->row(v) * coefficients; });
    return result;
  }

  void write_edge_values(Eigen::Ref<forms::RowMajorMatrix> rows, Execution& execution) override {
    prepare(execution);
    forms::write_edge_values(*structure_.surface, forms(), rows);
  }

  uv::FormSamples samples(Execution& execution) override {
    prepare(execution);
    auto triangles = uv::sample_triangles(*structure_.surface);
    auto values = uv::values_on_sides(*structure_.surface, mesh::Sides(*structure_.surface), forms(), triangles);
    return {std::move(triangles), std::move(values)};
  }

 private:
  forms::ClosedForms forms() const { return {structure_.topology.classes, *functions_}; }

  // Whether the energies on the own triangles, none of them degenerate, leave nothing to be gained over the least ones.
  bool is_negligible(Execution& execution) const {
    if (!structure_.surface->repairs.zero_area_faces.empty()) return false;
    const Eigen::VectorXd here = forms::energies(*structure_.surface, forms(), execution);
    Eigen::VectorXd least(here.size());
    Eigen::Index first = 0;
    for (const Eigen::MatrixXd& G : structure_.harmonic.invariants.energies.gram) {
      least.segment(first, G.rows()) = G.diagonal();
      first += G.rows();
    }
    return ((here - least).array() <= kNegligibleGain * least.array()).all();
  }

  void solve_again(Execution& execution) {
    const auto own = on_own_triangles(*structure_.surface, execution);
    execution.stage("harmonic forms of the input triangulation", 0.2, 1.0);
    HarmonicSolver solver(own, structure_.record.memory, options_.boundary, execution);
    functions_ =
        std::make_shared<const forms::RowMajorMatrix>(harmonic_functions(structure_.topology, solver, execution));
    report_ = solver.report();
  }

  const Structure& structure_;
  const Options& options_;
  std::shared_ptr<const forms::RowMajorMatrix> functions_;
  bool ready_ = false;
};

// A few forms at a time, of a closed surface.
class StreamedForms final : public PrimalForms {
 public:
  explicit StreamedForms(const Structure& structure) : structure_(structure) {}

  void prepare(Execution& execution) override {
    if (solver_) return;
    execution.stage("input triangulation", 0.0, 0.3);
    own_ = std::make_unique<const mesh::Discretisation>(on_own_triangles(*structure_.surface, execution));
    execution.stage("solver of the input triangulation", 0.3, 1.0);
    MemoryPlan plan = structure_.record.memory;
    // A map is two right-hand sides, for which another solver may be the faster one.
    plan.choice = plan.map_choice;
    auto solver = std::make_unique<HarmonicSolver>(*own_, std::move(plan), Boundary::natural, execution);
    execution.finish();
    solver_ = std::move(solver);
    report_ = solver_->report();
  }

  uv::UvArray function(const Eigen::VectorXcd& p, Execution& execution) override {
    prepare(execution);
    Eigen::MatrixXd parts(p.size(), 2);
    parts << p.real(), p.imag();
    execution.stage("harmonic forms of the map", 0.0, 1.0);
    const auto B = forms::codifferentials(*structure_.surface, own_->weights, structure_.topology.classes, parts,
                                          execution.workers());
    uv::UvArray result = solver_->systems().solve(
        B, solver::Condition::natural, [&] { return forms::class_terms(structure_.topology.classes, parts); },
        execution);
    report_ = solver_->report();
    execution.finish();
    return result;
  }

  void write_edge_values(Eigen::Ref<forms::RowMajorMatrix> rows, Execution& execution) override {
    prepare(execution);
    execution.stage("harmonic forms", 0.0, 1.0);
    const auto& classes = structure_.topology.classes;
    const auto write = [&](int first, forms::RowMajorMatrix&& functions) {
      forms::write_edge_values(*structure_.surface, {classes, functions, first},
                               rows.middleRows(first, functions.cols()));
    };
    solver_->solve_in_blocks(classes, classes.form_count, execution, write);
    report_ = solver_->report();
    execution.finish();
  }

  uv::FormSamples samples(Execution&) override { return structure_.harmonic.samples; }

 private:
  const Structure& structure_;
  std::unique_ptr<const mesh::Discretisation> own_;
  std::unique_ptr<HarmonicSolver> solver_;
};

}  // namespace

std::unique_ptr<PrimalForms> primal_forms(const Structure& structure, const Options& options) {
  if (structure.record.memory.keep_forms) return std::make_unique<KeptForms>(structure, options);
  return std::make_unique<StreamedForms>(structure);
}

Eigen::VectorXcd balanced_coefficients(const Structure& structure, PrimalForms& forms, Execution& execution) {
  const auto& basis = structure.differentials;
  if (structure.topology.families.poles > 0) return Eigen::VectorXcd::Unit(basis.cols(), 0);
  // A single form leaves nothing to choose, and samples may cost a solve.
  const auto samples = basis.cols() > 1 ? forms.samples(execution) : uv::FormSamples();
  const auto kind = structure.topology.type.closed() ? uv::Coefficients::complex : uv::Coefficients::real;
  Eigen::VectorXcd c = uv::balanced_coefficients(*structure.surface, samples, basis, kind, execution);
  c /= std::sqrt(uv_area(structure, basis * c));
  return c;
}

uv::UvArray uv_map(const Structure& structure, PrimalForms& forms, const Eigen::VectorXcd& c, Execution& execution) {
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
  const auto forms = primal_forms(map.structure, options);
  map.coefficients = balanced_coefficients(map.structure, *forms, execution);
  map.uv = uv_map(map.structure, *forms, map.coefficients, execution);
  return map;
}

}  // namespace holomorph::structure
