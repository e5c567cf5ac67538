#include "tiling/cones/cones.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <random>
#include <tuple>
#include <utility>

#include "base/constants.h"
#include "base/errors.h"
#include "mesh/triangle_tree.h"
#include "tiling/cones/scale_form.h"

namespace holomorph::tiling {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr int kCandidates = 250;  // that cones may be at
constexpr int kMostMoves = 400;
constexpr double kHandles = 0.3;           // weight of the square of what handles turn beyond whole k-th turns
constexpr double kNear = 0.06;             // roots of the area: opposite cones of a field that are nearer vanish
constexpr double kApart = 0.7;             // of the distance between centres of turns: two cones, at least
constexpr int kAround = 12, kOthers = 60;  // candidates around a cone in a round, and elsewhere
constexpr int kMostAround = 480;           // around all
constexpr int kMovesAtOnce = 16;           // between two looks at whether the search is cancelled
// Operations for two candidates: in each move, and for each loop.
constexpr double kPair = 2, kProduct = 0.25;
constexpr double kSeen = 5;     // price of a cone that is seen from everywhere, beside that of one that is hidden
constexpr double kGain = 1e-9;  // a move lowers the cost by more
// Rounds: the distance of candidates from their cone, in spacings of the first ones; part of kHandles.
struct Round {
  double reach, handles;
};
constexpr Round kFromCurvature[] = {{1.2, 0.1}, {0.6, 0.15}, {0.3, 0.25}, {0.6, 0.5}, {0.3, 1}};
constexpr Round kFromField[] = {{0.5, 0.3}, {0.3, 1}, {0.3, 1}};
constexpr Round kFromLevel[] = {{0.6, 0.5}, {0.3, 1}, {0.15, 1}};
constexpr double kLevels[] = {0.1, 1, 10};   // weights with which fields are pulled level
constexpr unsigned kSeeds[] = {1, 2, 3, 4};  // of the starts from curvature

// The price of a cone, over that of one k-th turn.
double price_of(int n) {
  const int size = std::abs(n);
  return size * (size + 1) / 2;
}

std::optional<std::array<double, 3>> up_of(const std::optional<Along>& along) {
  return along && !along->is_of_u ? std::optional(along->vector) : std::nullopt;
}

class Search {
 public:
  Search(const mesh::Surface& surface, const Net& net, const ConeOptions& options, Execution& execution,
         std::vector<int> patch = {})
      : execution_(execution),
        net_(net),
        options_(options),
        on_(surface, net, std::move(patch)),
        form_(net, options.k),
        exposure_(surface, up_of(options.along)) {
    most_ = options.k == 1 ? 0 : options.k == 2 ? 1 : 2;
    least_ = -options.k;
    spacing_ = std::sqrt(net.whole_area / kCandidates);
    spread_ = on_.spread(form_.without_cones(), kCandidates);
  }

  void report(double part) {
    part_ = part;
    execution_.report(part);
  }

  Cones from_field(std::vector<int> missing) {
    annihilate(missing);
    return from(missing, kFromField);
  }

  Cones from_level(const std::vector<int>& missing) { return from(missing, kFromLevel); }

  Cones from_curvature(unsigned seed) {
    random_.seed(seed);
    begin(spread_, nullptr);
    for (const double part : {0.1, 0.3, 1.0}) search(part, 0.1);
    return refined(kFromCurvature);
  }

 private:
  template <class Rounds>
  Cones from(const std::vector<int>& missing, const Rounds& rounds) {
    random_.seed(1);
    std::vector<int> candidates = spread_;
    for (int v = 0; v < net_.vertex_count(); ++v) {
      if (missing[v] != 0) candidates.push_back(v);
    }
    begin(std::move(candidates), &missing);
    search(1, rounds[0].handles);
    return refined(rounds);
  }

  // Pairs of opposite cones that are near, nearest first, vanish or become one.
  void annihilate(std::vector<int>& missing) const {
    const double near = kNear * kNear * net_.whole_area;
    for (;;) {
      std::vector<int> cones;
      for (int v = 0; v < net_.vertex_count(); ++v) {
        if (missing[v] != 0 && on_.is_place(v) && !on_.is_hole(v)) cones.push_back(v);
      }
      std::tuple<double, int, int> best{near, -1, -1};
      for (const int a : cones) {
        for (const int b : cones) {
          if (missing[a] > 0 && missing[b] < 0 && on_.patch(a) == on_.patch(b))
            best = std::min(best, {on_.squared_distance(a, b), a, b});
        }
      }
      const auto [distance, a, b] = best;
      if (a < 0) return;
      missing[a] += missing[b];
      missing[b] = 0;
    }
  }

  // Takes candidates, with Green's functions and the quadratic form. What is too much at one of them, or too near to
  // another cone, is placed anew. @param missing #V cones, none: placed by greed
  void begin(std::vector<int> candidates, const std::vector<int>* missing) {
    set(std::move(candidates));
    n_.assign(places_.size(), 0);
    std::map<int, int> left;  // what is to be placed in each patch
    if (!missing) left[0] = form_.total();
    for (int v = 0; missing && v < net_.vertex_count(); ++v) {
      if ((*missing)[v] != 0 && on_.patch(v) >= 0) left[on_.patch(v)] += (*missing)[v];
    }
    for (std::size_t i = 0; missing && i < places_.size(); ++i) {
      const int n = (*missing)[places_[i]];
      if (n == 0) continue;
      const auto near = std::ranges::find_if(near_[i], [&](std::size_t j) { return n_[j] != 0 && are_together(i, j); });
      int& united = near == near_[i].end() ? n_[i] : n_[*near];
      united = on_.is_hole(places_[i]) || !moves(i) ? n : std::clamp(united + n, least_, most_);
    }
    for (std::size_t i = 0; i < places_.size(); ++i) {
      if (n_[i] != 0 && moves(i)) left[on_.patch(places_[i])] -= n_[i];
    }
    for (auto& [patch, sum] : left) {
      for (; sum != 0; sum -= sum > 0 ? 1 : -1) add_to(patch, sum > 0 ? 1 : -1);
    }
  }

  // Adds a unit to a patch where it costs least.
  void add_to(int patch, int unit) {
    VectorXd n(n_.size());
    for (std::size_t i = 0; i < n_.size(); ++i) n[static_cast<Eigen::Index>(i)] = n_[i];
    const VectorXd change = 2 * unit * (form_.Q() * n - form_.b()) + form_.Q().diagonal();
    int best = -1;
    for (const bool apart : {true, false}) {
      if (best >= 0) break;
      for (std::size_t i = 0; i < n_.size(); ++i) {
        if (on_.patch(places_[i]) != patch || !may_be(i, unit) || (apart && crowd(i) > 0 && n_[i] == 0)) continue;
        if (best < 0 || change[static_cast<Eigen::Index>(i)] < change[best]) best = static_cast<int>(i);
      }
    }
    if (best < 0) throw SolverError("no cones fit this surface: it has too few vertices");
    n_[best] += unit;
  }

  bool moves(std::size_t i) const { return on_.patch(places_[i]) >= 0; }
  bool are_together(std::size_t i, std::size_t j) const {
    return !on_.have_patches() || (moves(i) && on_.patch(places_[i]) == on_.patch(places_[j]));
  }

  bool may_be(std::size_t i, int change) const {
    if (!moves(i)) return false;
    return on_.is_hole(places_[i]) || (change > 0 ? n_[i] + change <= most_ : n_[i] + change >= least_);
  }

  // The number of cones near a candidate.
  int crowd(std::size_t i) const {
    return static_cast<int>(std::ranges::count_if(near_[i], [&](std::size_t j) { return n_[j] != 0; }));
  }

  bool are_near(std::size_t i, std::size_t j) const { return std::ranges::binary_search(near_[i], j); }

  void set(std::vector<int> candidates) {
    std::sort(candidates.begin(), candidates.end());
    candidates.erase(std::unique(candidates.begin(), candidates.end()), candidates.end());
    places_ = std::move(candidates);
    // Centres of k-th turns in a lattice whose tiles have the area 1.
    const double between = options_.k == 2 ? 0.5 : options_.k == 4 ? std::sqrt(0.5) : 1.075;
    near_ = on_.near(places_, std::pow(kApart * between, 2) * net_.whole_area / options_.tiles);
    form_.take(places_, [&] { execution_.report(part_); });
    exposure_.prepare(places_, execution_.workers());
    prices_.resize(std::ssize(places_));
    for (Eigen::Index i = 0; i < prices_.size(); ++i) {
      const int v = places_[i];
      prices_[i] = on_.is_hole(v) ? 0 : options_.price * (1 + kSeen * exposure_(v));
    }
  }

  // Unit moves n_i + 1, n_j - 1, and jumps of a whole cone, the best of all while it lowers the cost.
  void search(double price_part, double handles_part) {
    const double kappa =
        on_.have_patches() ? 0 : kHandles * handles_part;  // the field of the patches says how handles turn
    const auto count = static_cast<Eigen::Index>(places_.size());
    const MatrixXd &flux = form_.flux(), Q = form_.Q() + kappa * flux.transpose() * flux;
    Execution::count(kProduct * static_cast<double>(count * count * flux.rows()));
    const VectorXd diagonal = Q.diagonal();
    VectorXd n(count), r(count), up(count), down(count);
    std::vector<int> crowds(places_.size());
    for (int move = 0; move < kMostMoves; ++move) {
      if (move % kMovesAtOnce == 0) execution_.report(part_);
      Execution::count(kPair * static_cast<double>(count * count));
      for (Eigen::Index i = 0; i < count; ++i) {
        n[i] = n_[i];
        crowds[i] = crowd(i);
      }
      VectorXd b = form_.b();
      if (flux.rows() > 0) {
        const VectorXd turned = (form_.turning() + flux * n) / form_.unit();
        b -= kappa * flux.transpose() * (form_.turning() - form_.unit() * turned.array().round().matrix());
      }
      r = Q * n - b;
      for (Eigen::Index i = 0; i < count; ++i) {
        const double p = price_part * prices_[i];
        const auto change = [&](int by) {
          if (!may_be(i, by) || (n_[i] == 0 && crowds[i] > 0)) return kInfinity;
          return 2 * by * r[i] + diagonal[i] + p * (price_of(n_[i] + by) - price_of(n_[i]));
        };
        up[i] = change(1);
        down[i] = change(-1);
      }
      double best = -kGain;
      Eigen::Index from = -1, to = -1;
      int carried = 1;
      for (Eigen::Index j = 0; j < count; ++j) {
        if (std::isinf(down[j])) continue;
        for (Eigen::Index i = 0; i < count; ++i) {
          const double change = up[i] + down[j] - 2 * Q(i, j);
          if (i == j || !(change < best) || (n_[i] == 0 && n_[j] == 0 && are_near(i, j))) continue;
          if (!are_together(i, j)) continue;
          best = change, to = i, from = j, carried = 1;
        }
      }
      for (Eigen::Index j = 0; j < count; ++j) {
        const int w = n_[j];
        if (w == 0 || on_.is_hole(places_[j])) continue;
        for (Eigen::Index i = 0; i < count; ++i) {
          if (n_[i] != 0 || on_.is_hole(places_[i]) || crowds[i] > (are_near(i, j) ? 1 : 0)) continue;
          if (!are_together(i, j)) continue;
          const double change = 2 * w * (r[i] - r[j]) + w * w * (diagonal[i] + diagonal[j] - 2 * Q(i, j)) +
                                price_part * (prices_[i] - prices_[j]) * price_of(w);
          if (change < best) best = change, to = i, from = j, carried = w;
        }
      }
      if (to < 0) break;
      n_[to] += carried;
      n_[from] -= carried;
    }
  }

  template <class Rounds>
  Cones refined(const Rounds& rounds) {
    for (const Round& round : rounds) {
      const auto cones = std::max<std::ptrdiff_t>(std::ssize(n_) - std::ranges::count(n_, 0), 1);
      const int around = std::clamp(kMostAround / static_cast<int>(cones), 3, kAround);
      std::vector<int> candidates, others = places_;
      const double reach = round.reach * spacing_ * round.reach * spacing_;
      for (std::size_t i = 0; i < places_.size(); ++i) {
        if (n_[i] == 0 && !on_.is_hole(places_[i])) continue;
        candidates.push_back(places_[i]);
        if (on_.is_hole(places_[i])) continue;
        std::vector<int> near = on_.within(places_[i], reach);
        draw(near, around, candidates);
      }
      draw(others, kOthers, candidates);
      std::vector<int> missing(net_.vertex_count(), 0);
      for (std::size_t i = 0; i < places_.size(); ++i) missing[places_[i]] = n_[i];
      begin(std::move(candidates), &missing);
      search(1, round.handles);
    }
    Cones result;
    result.missing.assign(net_.vertex_count(), 0);
    VectorXd n(n_.size());
    for (std::size_t i = 0; i < places_.size(); ++i) {
      result.missing[places_[i]] = n_[i];
      n[static_cast<Eigen::Index>(i)] = n_[i];
      result.cost += prices_[static_cast<Eigen::Index>(i)] * price_of(n_[i]);
    }
    result.cost += form_.constant() + n.dot(form_.Q() * n - 2 * form_.b());
    return result;
  }

  // Adds some of the list, drawn without putting back.
  void draw(std::vector<int>& list, int count, std::vector<int>& drawn) {
    for (int i = 0; i < count && i < std::ssize(list); ++i) {
      std::swap(list[i], list[i + random_() % (list.size() - i)]);
      drawn.push_back(list[i]);
    }
  }

  Execution& execution_;
  double part_ = 0;  // of the work that is done
  const Net& net_;
  const ConeOptions options_;
  const ConePlaces on_;
  ScaleForm form_;
  std::vector<int> spread_, places_, n_;
  VectorXd prices_;  // of a cone of one k-th turn at each candidate
  mesh::AmbientOcclusion exposure_;
  std::vector<std::vector<std::size_t>> near_;  // to each candidate, ascending
  int most_ = 0, least_ = 0;
  double spacing_ = 0;
  std::mt19937 random_;
};

}  // namespace

std::vector<Cones> find_cones(const mesh::Surface& surface, const ConeOptions& options, Execution& execution) {
  const Net net(surface);
  Search search(surface, net, options, execution);
  std::vector<Cones> found;
  const double starts = std::size(kSeeds) + (options.along ? std::size(kLevels) : 0);
  const auto report = [&] { search.report(static_cast<double>(found.size()) / starts); };
  report();
  if (options.along) {
    for (const double level : kLevels) {
      const std::vector<Complex> field = level_field(net, surface.polygons.vertices, options.k, *options.along, level);
      found.push_back(search.from_field(cones_of_field(net, field, options.k)));
      report();
    }
  }
  for (const unsigned seed : kSeeds) {
    found.push_back(search.from_curvature(seed));
    report();
  }
  std::stable_sort(found.begin(), found.end(), [](const Cones& a, const Cones& b) { return a.cost < b.cost; });
  const auto same = [](const Cones& a, const Cones& b) { return a.missing == b.missing; };
  found.erase(std::unique(found.begin(), found.end(), same), found.end());
  return found;
}

Cones refined_cones(const mesh::Surface& surface, const std::vector<int>& missing, const ConeOptions& options,
                    Execution& execution) {
  execution.report(0);
  const Net net(surface);
  return Search(surface, net, options, execution).from_level(missing);
}

Cones cones_in_patches(const mesh::Surface& surface, const Net& net, const std::vector<int>& patch,
                       const std::vector<int>& missing, const ConeOptions& options, Execution& execution) {
  execution.report(0);
  return Search(surface, net, options, execution, patch).from_field(missing);
}

}  // namespace holomorph::tiling
