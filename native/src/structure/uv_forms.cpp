#include "structure/uv_forms.h"

#include <algorithm>

#include "base/chunks.h"
#include "forms/codifferential.h"
#include "mesh/intrinsic_triangulation.h"
#include "structure/double_cover.h"
#include "uv/balance.h"

namespace holomorph::structure {
namespace {

// Largest relative gain in energy that is given away; it bounds the squared relative distance between the forms.
constexpr double kNegligibleGain = 1e-9;

// The surface's own triangles and their weights.
struct OwnTriangles {
  mesh::IntrinsicTriangulation triangulation;
  Array<double> weights;

  OwnTriangles(const mesh::Surface& surface, Execution& execution)
      : triangulation(
            mesh::intrinsic_triangulation(surface, mesh::half_edges(surface, execution), execution.workers())),
        weights(mesh::cotangent_weights(triangulation, execution)) {
    triangulation.forget_metric();
  }
};

class KeptForms final : public UvForms {
 public:
  KeptForms(Structure& structure, const Options& options)
      : structure_(structure), options_(options), forms_{structure.topology.classes, {}} {
    forms_.functions.swap(structure.functions);
    report_ = structure.solver;
    ready_ = structure.flip_count == 0;
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
    uv::UvArray result(forms_.functions.rows(), 2);
    for_rows(execution.workers(), static_cast<int>(result.rows()),
             [&](int v) { result.row(v).noalias() = forms_.functions.row(v) * coefficients; });
    return result;
  }

  void write_edge_values(Eigen::Ref<forms::RowMajorMatrix> rows, Execution& execution) override {
    prepare(execution);
    forms::write_edge_values(*structure_.surface, forms_, rows);
  }

  uv::FormSamples samples(Execution& execution) override {
    prepare(execution);
    auto triangles = uv::sample_triangles(*structure_.surface);
    auto values = uv::values_on_sides(*structure_.surface, mesh::Sides(*structure_.surface), forms_, triangles);
    return {std::move(triangles), std::move(values)};
  }

 private:
  // Whether the energies on the own triangles, none of them degenerate, leave nothing to be gained over the least ones.
  // The functions are given up where they do, and a call that was cancelled since then solves at once.
  bool is_negligible(Execution& execution) {
    if (forms_.functions.size() == 0 || !structure_.surface->repairs.zero_area_faces.empty()) return false;
    const Eigen::VectorXd here = forms::energies(*structure_.surface, forms_, execution);
    Eigen::VectorXd least(here.size());
    Eigen::Index first = 0;
    for (const Eigen::MatrixXd& G : structure_.gram) {
      least.segment(first, G.rows()) = G.diagonal();
      first += G.rows();
    }
    return ((here - least).array() <= kNegligibleGain * least.array()).all();
  }

  void solve_again(Execution& execution) {
    forms_.functions.resize(0, 0);
    const Topology& topology = structure_.topology;
    const OwnTriangles own(*structure_.surface, execution);
    const auto& half_edges = own.triangulation.half_edges;
    const int natural = topology.families.natural;
    const auto classes =
        harmonic_classes(topology, half_edges, topology::first_forms(topology.classes, natural, natural));
    execution.stage("harmonic forms of the input triangulation", 0.2, 1.0);
    auto solved = solve(half_edges, own.weights, classes, execution);
    add_loop_indicators(topology, solved.functions);
    forms_.functions.swap(solved.functions);
    report_ = std::move(solved.solver);
  }

  HarmonicFunctions solve(const mesh::HalfEdges& half_edges, std::span<const double> weights,
                          const topology::IntegerForms& classes, Execution& execution) const {
    const int natural = structure_.topology.families.natural;
    if (options_.boundary == Boundary::double_cover)
      return solve_on_double(half_edges, weights, classes, natural, options_, execution);
    HarmonicSystems systems(half_edges, weights, mesh::boundary_vertices(structure_.topology.boundary),
                            structure_.memory.choice, execution);
    return systems.solve(classes, natural, structure_.memory.block, execution);
  }

  Structure& structure_;
  const Options& options_;
  forms::ClosedForms forms_;
  bool ready_ = false;
};

// A few forms at a time, of a closed surface.
class StreamedForms final : public UvForms {
 public:
  StreamedForms(const Structure& structure, const Options& options) : structure_(structure), options_(options) {}

  void prepare(Execution& execution) override {
    if (systems_) return;
    execution.stage("input triangulation", 0.0, 0.3);
    own_ = std::make_unique<OwnTriangles>(*structure_.surface, execution);
    execution.stage("solver of the input triangulation", 0.3, 1.0);
    // A complex combination of forms is two right-hand sides.
    const Extent extent{structure_.surface->vertex_count, static_cast<std::int64_t>(own_->weights.size()), 2};
    const auto choice = plan_memory(extent, options_.solver, options_.memory_limit, Keeping::as_many_as_fit).choice;
    auto systems = std::make_unique<HarmonicSystems>(own_->triangulation.half_edges, own_->weights, std::vector<int>{},
                                                     choice, execution);
    execution.finish();
    systems_ = std::move(systems);
    report_ = systems_->report();
  }

  uv::UvArray function(const Eigen::VectorXcd& p, Execution& execution) override {
    prepare(execution);
    Eigen::MatrixXd parts(p.size(), 2);
    parts << p.real(), p.imag();
    execution.stage("harmonic forms of the map", 0.0, 1.0);
    const auto B = forms::codifferentials(*structure_.surface, own_->weights, structure_.topology.classes, parts,
                                          execution.workers());
    uv::UvArray result = systems_->solver().solve(
        B, solver::Condition::natural, [&] { return forms::class_terms(structure_.topology.classes, parts); },
        execution);
    report_ = systems_->report();
    execution.finish();
    return result;
  }

  void write_edge_values(Eigen::Ref<forms::RowMajorMatrix> rows, Execution& execution) override {
    prepare(execution);
    execution.stage("harmonic forms", 0.0, 1.0);
    forms::ClosedForms block{structure_.topology.classes, {}};
    const auto write = [&](int first, forms::RowMajorMatrix&& functions) {
      block.first = first;
      block.functions.swap(functions);
      forms::write_edge_values(*structure_.surface, block, rows.middleRows(first, block.functions.cols()));
    };
    systems_->solve_in_blocks(block.classes, block.classes.form_count, structure_.memory.block, execution, write);
    report_ = systems_->report();
    execution.finish();
  }

  uv::FormSamples samples(Execution&) override { return structure_.samples; }

 private:
  const Structure& structure_;
  const Options& options_;
  std::unique_ptr<OwnTriangles> own_;
  std::unique_ptr<HarmonicSystems> systems_;
};

}  // namespace

std::unique_ptr<UvForms> uv_forms(Structure& structure, const Options& options) {
  if (structure.memory.keep_forms) return std::make_unique<KeptForms>(structure, options);
  return std::make_unique<StreamedForms>(structure, options);
}

}  // namespace holomorph::structure
