// paper_solver MESH: the paper's multiresolution algorithm against conjugate gradients begun at zero, on the same
// linear system: one connected surface, with boundary its double, as many right-hand sides as it has classes. Prints
// one line of JSON: seconds of processor time, and iterations, to each relative residual. To be run with one thread.
#include <ctime>
#include <iostream>

#include "forms/closed_forms.h"
#include "forms/laplacian.h"
#include "mesh/components.h"
#include "mesh/io/read.h"
#include "mesh/make_surface.h"
#include "progressive/simplify.h"
#include "structure/certified_forms.h"
#include "structure/harmonic_solver.h"
#include "structure/paper_forms.h"
#include "topology/fundamental_domain.h"

namespace {

using namespace holomorph;

constexpr double kResiduals[] = {1e-4, 1e-6, 1e-8, 1e-10};
// Plain conjugate gradients are not followed further: minutes, and no news.
constexpr int kMostIterations = 40'000;

double processor_seconds() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

template <class Work>
auto timed(double& seconds, Work work) {
  const double start = processor_seconds();
  auto result = work();
  seconds = processor_seconds() - start;
  return result;
}

struct System {
  solver::Laplacian L;
  Eigen::MatrixXd B;
};

System system_of(const mesh::HalfEdges& half_edges, const Array<double>& weights,
                 const topology::IntegerForms& classes) {
  Execution silent;
  return {forms::laplacian(half_edges, weights, silent),
          forms::codifferentials(half_edges, weights, classes, silent.workers())};
}

System system_of(const mesh::Surface& surface, const mesh::Discretisation& discretisation,
                 const structure::PaperLevels& levels) {
  Execution silent;
  const auto& half_edges = discretisation.half_edges;
  const auto topology = structure::find_topology(surface, half_edges, silent, levels.bases);
  const auto classes = structure::classes_on(topology, half_edges, {});
  if (levels.closed()) return system_of(half_edges, discretisation.weights, classes);
  const auto both = structure::doubled(discretisation, silent);
  return system_of(both.cover.half_edges, both.weights,
                   structure::extended(half_edges, both.cover, classes, topology.families.natural));
}

// Conjugate gradients from `start` to each residual; prints [iterations, seconds], [] from the first one not reached.
void print_run(const System& system, const Eigen::MatrixXd& start, solver::Scaling scaling) {
  Execution silent;
  bool reached = true;
  const char* separator = "[";
  for (const double residual : kResiduals) {
    solver::GradientReport report;
    double seconds = 0;
    if (reached) {
      const solver::GradientOptions options{scaling, residual, kMostIterations};
      Eigen::MatrixXd X = start;
      report = timed(seconds, [&] { return solver::conjugate_gradients(system.L, system.B, X, options, silent); });
    }
    reached = report.converged;
    std::cout << separator << '[';
    if (reached) std::cout << report.iterations << ", " << seconds;
    std::cout << ']';
    separator = ", ";
  }
  std::cout << ']';
}

void print_paper(const System& system, const structure::PaperLevels& levels, solver::Scaling scaling) {
  structure::PaperOptions options;
  options.scaling = scaling;
  Execution silent;
  double seconds = 0;
  const auto start =
      timed(seconds, [&] { return structure::paper_estimation(levels, thresholds(levels, options), options, silent); });
  std::cout << "{\"levels_seconds\": " << seconds << ", \"levels\": [";
  const char* separator = "";
  for (const auto& level : start.levels) {
    std::cout << separator << '[' << level.faces << ", " << level.iterations << ']';
    separator = ", ";
  }
  std::cout << "], \"surface\": ";
  print_run(system, start.functions, scaling);
  std::cout << '}';
}

}  // namespace

int main(int count, char** arguments) {
  if (count != 2) return 2;
  Execution silent;
  const auto surface = mesh::component(mesh::make_surface(mesh::read(arguments[1]), silent), 0, silent).surface;
  const auto discretisation = mesh::on_input(surface, mesh::half_edges(surface, silent), silent);
  const mesh::HalfEdges& half_edges = discretisation.half_edges;
  double collapsing = 0, levels_made = 0, homology = 0;
  timed(homology, [&] {
    const auto domain = topology::fundamental_domain(surface, half_edges, silent);
    topology::homology_basis(half_edges, domain);
    return topology::natural_classes(half_edges, domain);
  });
  timed(collapsing, [&] { return progressive::progressive_mesh(surface, progressive::Order::quadric, silent); });
  const auto levels = timed(levels_made, [&] { return structure::paper_levels(surface, silent); });
  const System system = system_of(surface, discretisation, levels);
  std::cout << "{\"faces\": " << surface.triangles.size() << ", \"right_hand_sides\": " << system.B.cols()
            << ", \"homology_of_surface\": " << homology << ", \"progressive_mesh\": " << collapsing
            << ", \"homology_of_base\": " << levels_made - collapsing << ", \"plain\": ";
  const Eigen::MatrixXd zero = Eigen::MatrixXd::Zero(system.B.rows(), system.B.cols());
  print_run(system, zero, solver::Scaling::none);
  std::cout << ", \"scaled\": ";
  print_run(system, zero, solver::Scaling::diagonal);
  std::cout << ", \"paper_plain\": ";
  print_paper(system, levels, solver::Scaling::none);
  std::cout << ", \"paper\": ";
  print_paper(system, levels, solver::Scaling::diagonal);
  std::cout << "}\n";
  return 0;
}
