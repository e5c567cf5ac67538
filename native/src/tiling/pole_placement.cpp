#include "tiling/pole_placement.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <optional>

#include "base/chunks.h"
#include "base/errors.h"
#include "mesh/graph_distances.h"
#include "structure/puncture_choice.h"
#include "tiling/leverage.h"
#include "tiling/pole_candidates.h"
#include "uv/balance.h"

namespace holomorph::tiling {
namespace {

using Complex = std::complex<double>;
using Eigen::Index;
using Eigen::MatrixXcd;
using Eigen::VectorXcd;

// Poles by themselves.
constexpr int kCounts[] = {2, 4, 8, 12, 16};
constexpr double kEvenWithout = 3, kEvenWith = 6;
constexpr int kThinning = 3;             // every third sample is enough to tell which candidates are worth a trial
constexpr int kTried = 2, kRefined = 2;  // candidates that are optimised when a pole is added, and when one moves
constexpr int kSweeps = 3;
constexpr double kLeverage = 0.06, kEnough = 0.4;  // weight of the leverage; singular values that are enough
constexpr double kGain = 1e-3;                     // less is no gain
constexpr int kSteps = 25;                         // of the minimiser
// Residues that a new pole is tried with, relative to the root of mean density times area.
constexpr double kTrialSizes[] = {0.1, 0.3, 1.0};
constexpr int kTrialPhases = 6;
const std::vector<double> kFromAfar = {1.0, 0.1, 0.01, 1e-3, uv::kDensityFloor}, kFromNear = {uv::kDensityFloor},
                          kWithTrial = {0.03, uv::kDensityFloor};

MatrixXcd thinned(const MatrixXcd& samples) { return samples(Eigen::seq(0, Eigen::last, kThinning), Eigen::all); }

class Search {
 public:
  Search(Landscape& landscape, const PlacementRules& rules, Execution& execution)
      : landscape_(landscape),
        rules_(rules),
        execution_(execution),
        candidates_(landscape, rules.allowed),
        theta_(landscape.holomorphic().M) {
    if (landscape.closed() && landscape.form_count() > 0) leverage_.emplace(landscape);
    first_triangle_.assign(landscape.surface().vertex_count, -1);
    for (int t = static_cast<int>(landscape.surface().triangles.size()) - 1; t >= 0; --t) {
      for (const int v : landscape.surface().triangles[t]) first_triangle_[v] = t;
    }
  }

  // The best form with these poles, from the coefficients given. @pre their columns and leverage are prepared
  void optimise(Poles& poles, const std::vector<double>& floors) {
    const uv::SampledParts parts{columns(poles.vertices), {}};
    Eigen::VectorXd x = uv::as_unknowns(unknowns(poles), rules_.kind);
    uv::descend(parts, rules_.kind, x, floors, kSteps);
    set(uv::as_complex(x, rules_.kind), poles);
    poles.variance = objective(poles, (parts.M * unknowns(poles)).cwiseAbs2().array());
  }

  void refine(Poles& poles) {
    prepare_leverage(poles.vertices);
    optimise(poles, kFromNear);
  }

  Poles begin() {
    Poles poles;
    poles.vertices = rules_.fixed;
    if (poles.vertices.empty() && landscape_.form_count() == 0) poles.vertices = first_poles();
    const auto k = static_cast<Index>(poles.vertices.size());
    poles.residues = VectorXcd::Ones(k);
    if (landscape_.closed() && k > 0) poles.residues[k - 1] = -static_cast<double>(k - 1);
    poles.coefficients = VectorXcd::Zero(landscape_.form_count());
    if (landscape_.form_count() > 0 && k == 0) {
      const uv::SampledParts& parts = landscape_.holomorphic();
      poles.coefficients = landscape_.form_count() == 1 ? VectorXcd::Ones(1)
                                                        : uv::lowest_variance(parts, rules_.kind, execution_.workers());
    }
    prepare_leverage(poles.vertices);
    optimise(poles, kFromAfar);
    return poles;
  }

  // Up to `count`. @return whether there was room for so many
  bool add(Poles& poles, int count) {
    while (static_cast<int>(poles.vertices.size()) < count && add_one(poles)) {
    }
    return static_cast<int>(poles.vertices.size()) >= count;
  }

  // The same poles at better places.
  Poles settled(Poles poles) {
    for (int i = 0; i < kSweeps && sweep(poles); ++i) execution_.report(static_cast<double>(i) / kSweeps);
    return poles;
  }

 private:
  bool add_one(Poles& poles) {
    std::vector<Trial> trials = trials_everywhere(poles);
    std::vector<Poles> tried;
    for (const Trial& trial : trials) {
      if (static_cast<int>(tried.size()) == kTried) break;
      const bool known =
          std::any_of(tried.begin(), tried.end(), [&](const Poles& p) { return p.vertices.back() == trial.vertex; });
      if (!known) tried.push_back(joined(poles, trial));
    }
    if (tried.empty()) return false;
    landscape_.poles(vertices_of(tried), execution_);
    prepare_leverage(vertices_of(tried));
    run_throwing(execution_.workers(), static_cast<int>(tried.size()), [&](int i) { optimise(tried[i], kWithTrial); });
    poles = best(std::move(tried));
    return true;
  }

  // One sweep over all poles; whether one moved.
  bool sweep(Poles& poles) {
    bool moved = false;
    for (Index i = 0; i < poles.residues.size(); ++i) {
      execution_.report(static_cast<double>(i) / static_cast<double>(poles.residues.size()));
      if (std::find(rules_.fixed.begin(), rules_.fixed.end(), poles.vertices[i]) != rules_.fixed.end()) continue;
      moved |= exchange(poles, i);
    }
    return moved;
  }

  struct Trial {
    double value;
    int vertex;
    Complex residue;
  };

  static std::vector<int> vertices_of(const std::vector<Poles>& list) {
    std::vector<int> all;
    for (const Poles& poles : list) all.insert(all.end(), poles.vertices.begin(), poles.vertices.end());
    return all;
  }

  static Poles best(std::vector<Poles> list) {
    return *std::min_element(list.begin(), list.end(),
                             [](const Poles& a, const Poles& b) { return a.variance < b.variance; });
  }

  // Closed: the last pole takes the rest.
  MatrixXcd columns(const std::vector<int>& vertices) {
    MatrixXcd poles = landscape_.poles(vertices, execution_);
    if (landscape_.closed() && poles.cols() > 0)
      poles = (poles.leftCols(poles.cols() - 1).colwise() - poles.col(poles.cols() - 1)).eval();
    MatrixXcd all(theta_.rows(), theta_.cols() + poles.cols());
    all << theta_, poles;
    return all;
  }

  VectorXcd unknowns(const Poles& poles) const {
    const Index free = std::max<Index>(0, poles.residues.size() - (landscape_.closed() ? 1 : 0));
    VectorXcd x(poles.coefficients.size() + free);
    x << poles.coefficients, poles.residues.head(free);
    return x;
  }

  void set(const VectorXcd& x, Poles& poles) const {
    const Index n = poles.coefficients.size(), free = x.size() - n;
    poles.coefficients = x.head(n);
    poles.residues.head(free) = x.tail(free);
    if (poles.residues.size() > free) poles.residues[free] = -x.tail(free).sum();
  }

  double objective(const Poles& poles, const Eigen::ArrayXd& density) {
    return uv::log_variance(density) + leverage_term(poles.vertices, poles.residues, leverage_metric(density));
  }

  // kLeverage mean log(1 + (kEnough / sigma)^2) over the singular values of [r_i tau_i] in the weighted Gram matrix.
  double leverage_term(const std::vector<int>& vertices, const VectorXcd& residues, const MatrixXcd& metric) const {
    const auto g = theta_.cols();
    if (!leverage_ || residues.size() < g) return 0;
    MatrixXcd rows(g, residues.size());
    for (Index i = 0; i < residues.size(); ++i) rows.col(i) = residues[i] * tau_.at(vertices[i]);
    const MatrixXcd V = metric * rows;
    MatrixXcd S = V * V.adjoint();
    S += 1e-9 * MatrixXcd::Identity(g, g);
    const MatrixXcd sum = S + kEnough * kEnough * MatrixXcd::Identity(g, g);
    return kLeverage / static_cast<double>(g) *
           (std::log(std::abs(sum.determinant())) - std::log(std::abs(S.determinant())));
  }

  MatrixXcd leverage_metric(const Eigen::ArrayXd& density) const {
    if (!leverage_) return {};
    const Eigen::LLT<MatrixXcd> metric(weighted_gram(theta_, density));
    return MatrixXcd(metric.matrixU()) * std::sqrt(landscape_.area());
  }

  // Before threads look it up.
  void prepare_leverage(std::vector<int> vertices) {
    if (!leverage_) return;
    std::erase_if(vertices, [&](int v) { return tau_.contains(v); });
    std::vector<int> triangles;
    for (const int v : vertices) triangles.push_back(first_triangle_[v]);
    const MatrixXcd tau = leverage_->tau(triangles);
    for (std::size_t i = 0; i < vertices.size(); ++i) tau_.emplace(vertices[i], tau.col(static_cast<Index>(i)));
  }

  std::vector<int> first_poles() {
    if (!rules_.allowed.empty()) return first_allowed_poles();
    if (landscape_.closed()) return structure::far_apart(landscape_.surface(), landscape_.half_edges());
    return {structure::deepest_vertex(landscape_.surface(), landscape_.half_edges())};
  }

  // The same where poles are not allowed everywhere: candidates far from each other.
  std::vector<int> first_allowed_poles() {
    std::vector<int> poles;
    for (const std::size_t count = landscape_.closed() ? 2 : 1; poles.size() < count;) {
      const std::vector<int> candidates = candidates_.everywhere(poles);
      if (candidates.empty())
        throw TopologyError("the vertices where poles may be have no room for " + std::to_string(count));
      const auto distance = mesh::graph_distances(landscape_.half_edges(), landscape_.lengths(),
                                                  {poles.empty() ? candidates.front() : poles.front()});
      poles.push_back(*std::max_element(candidates.begin(), candidates.end(),
                                        [&](int a, int b) { return distance[a] < distance[b]; }));
    }
    return poles;
  }

  // All candidates with all trial residues beside the form as it is, the best first.
  std::vector<Trial> trials_everywhere(const Poles& poles) {
    const std::vector<int> candidates = candidates_.everywhere(poles.vertices);
    const MatrixXcd green = thinned(landscape_.poles(candidates, execution_));
    const VectorXcd A = thinned(columns(poles.vertices) * unknowns(poles));
    const double scale = std::sqrt(A.cwiseAbs2().mean() * landscape_.area());
    const int phases = rules_.kind == uv::Coefficients::real ? 2 : kTrialPhases;
    std::vector<Trial> trials;
    for (const int v : candidates) {
      for (const double size : kTrialSizes) {
        for (int j = 0; j < phases; ++j)
          trials.push_back({0, v, std::polar(size * scale, 2 * std::numbers::pi * j / phases)});
      }
    }
    const int each = static_cast<int>(std::size(kTrialSizes)) * phases;
    run_throwing(execution_.workers(), static_cast<int>(candidates.size()), [&](int i) {
      for (int j = i * each; j < (i + 1) * each; ++j)
        trials[j].value = uv::log_variance((A + trials[j].residue * green.col(i)).cwiseAbs2().array());
    });
    std::stable_sort(trials.begin(), trials.end(), [](const Trial& a, const Trial& b) { return a.value < b.value; });
    return trials;
  }

  // With the trial's pole; the others share what it needs on a closed surface.
  Poles joined(const Poles& poles, const Trial& trial) const {
    Poles more = poles;
    const Index k = poles.residues.size();
    if (landscape_.closed() && k > 0) more.residues.array() -= trial.residue / static_cast<double>(k);
    more.vertices.push_back(trial.vertex);
    more.residues.conservativeResize(k + 1);
    more.residues[k] = landscape_.closed() && k == 0 ? 0 : trial.residue;
    return more;
  }

  // Scores all candidates for pole i with everything else as it is, and optimises the best ones.
  bool exchange(Poles& poles, Index i) {
    std::vector<int> others = poles.vertices;
    others.erase(others.begin() + i);
    const std::vector<int> candidates = candidates_.for_move(poles.vertices[i], others);
    if (candidates.empty()) return false;
    const MatrixXcd green = thinned(landscape_.poles(candidates, execution_));
    const VectorXcd A = columns(poles.vertices) * unknowns(poles);
    const VectorXcd without = thinned(A - poles.residues[i] * landscape_.poles({poles.vertices[i]}, execution_).col(0));
    prepare_leverage(candidates);
    prepare_leverage(poles.vertices);
    const MatrixXcd metric = leverage_metric(A.cwiseAbs2().array());
    std::vector<std::pair<double, int>> scores(candidates.size());
    run_throwing(execution_.workers(), static_cast<int>(candidates.size()), [&](int j) {
      std::vector<int> vertices = poles.vertices;
      vertices[i] = candidates[j];
      const Eigen::ArrayXd density = (without + poles.residues[i] * green.col(j)).cwiseAbs2().array();
      scores[j] = {uv::log_variance(density) + leverage_term(vertices, poles.residues, metric), candidates[j]};
    });
    std::sort(scores.begin(), scores.end());
    std::vector<Poles> tried;
    for (int j = 0; j < std::min<int>(kRefined, static_cast<int>(scores.size())); ++j) {
      tried.push_back(poles);
      tried.back().vertices[i] = scores[j].second;
    }
    run_throwing(execution_.workers(), static_cast<int>(tried.size()), [&](int j) { optimise(tried[j], kFromNear); });
    Poles found = best(std::move(tried));
    if (found.variance > poles.variance * (1 - kGain)) return false;
    poles = std::move(found);
    return true;
  }

  Landscape& landscape_;
  const PlacementRules& rules_;
  Execution& execution_;
  PoleCandidates candidates_;
  MatrixXcd theta_;
  std::optional<Leverage> leverage_;
  std::vector<int> first_triangle_;
  std::map<int, VectorXcd> tau_;
};

}  // namespace

Poles placed_poles(Landscape& landscape, const PlacementRules& rules, int count, Execution& execution) {
  const int least = landscape.form_count() > 0 ? 0 : landscape.closed() ? 2 : 1;
  if (count < least || (count == 1 && landscape.closed())) {
    throw TopologyError(std::to_string(count) + (count == 1 ? " pole is" : " poles are") + " not enough: " +
                        (landscape.closed() ? "on a closed surface the residues sum to 0, so two or more are needed"
                                            : "a disk needs one or more"));
  }
  Search search(landscape, rules, execution);
  Poles poles = search.begin();
  if (!search.add(poles, count)) {
    throw TopologyError("there is room for " + std::to_string(poles.vertices.size()) + " poles, not for " +
                        std::to_string(count) + ": their stars must be apart; take fewer, or subdivide the mesh");
  }
  return search.settled(std::move(poles));
}

Poles placed_poles(Landscape& landscape, const PlacementRules& rules, Execution& execution) {
  Search search(landscape, rules, execution);
  Poles added = search.begin(), best = added;
  double least = density_ratio(density(landscape, best, execution));
  for (const int count : kCounts) {
    if (least <= (best.vertices.empty() ? kEvenWithout : kEvenWith) || !search.add(added, count)) break;
    Poles settled = search.settled(added);
    const double ratio = density_ratio(density(landscape, settled, execution));
    if (ratio > least) continue;
    least = ratio;
    best = std::move(settled);
  }
  return best;
}

Poles optimised(Landscape& landscape, const PlacementRules& rules, Poles start, Execution& execution) {
  Search(landscape, rules, execution).refine(start);
  return start;
}

Eigen::ArrayXd density(Landscape& landscape, const Poles& poles, Execution& execution) {
  return (landscape.holomorphic().M * poles.coefficients + landscape.poles(poles.vertices, execution) * poles.residues)
      .cwiseAbs2()
      .array();
}

double density_ratio(const Eigen::ArrayXd& density) {
  std::vector<double> sorted(density.begin(), density.end());
  std::sort(sorted.begin(), sorted.end());
  const auto at = [&](double q) {
    return sorted[static_cast<std::size_t>(q * static_cast<double>(sorted.size() - 1))];
  };
  return at(0.95) / at(0.05);
}

}  // namespace holomorph::tiling
