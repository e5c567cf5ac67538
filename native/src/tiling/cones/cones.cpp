#include "tiling/cones/cones.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
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

constexpr int kCandidates = 250;  // that cones of a round may be at
constexpr int kMostMoves = 600;
constexpr double kHandles = 0.3;           // weight of the square of what handles turn beyond whole k-th turns
constexpr double kNear = 0.06;             // roots of the area: opposite cones of a field that are nearer vanish
constexpr double kApart = 0.7;             // of the distance between centres of turns: two cones, at least
constexpr int kAround = 12, kOthers = 60;  // candidates around a cone in a round, and elsewhere
constexpr int kMostAround = 240;           // around all
constexpr int kMovesAtOnce = 16;           // between two looks at whether the search is cancelled
// Operations for two candidates: in each move, and for each loop.
constexpr double kPair = 2, kProduct = 0.25;
constexpr double kSeen = 5;     // price of a cone that is seen from everywhere, beside that of one that is hidden
constexpr double kGain = 1e-9;  // a move lowers the cost by more
// Parts of the price and of kHandles, one after the other: first cones come, then those that do not pay for themselves
// go.
constexpr double kParts[] = {0.03, 0.1, 0.3, 1};
constexpr double kLevels[] = {0.1, 1, 10};  // weights with which fields are pulled level
// Rounds: the distance of candidates from their cone, in spacings of kCandidates; part of kHandles.
struct Round {
  double reach, handles;
};
constexpr Round kFromField[] = {{0.5, 0.3}, {0.3, 1}, {0.3, 1}};
constexpr Round kFromLevel[] = {{0.6, 0.5}, {0.3, 1}, {0.15, 1}};

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
  }

  // Among all places. @param missing #V, of a field; none: placed by greed
  Cones anywhere(std::vector<int>* missing) {
    if (missing) annihilate(*missing);
    begin(all_places(), missing);
    for (const double part : kParts) search(part, part);
    return cones();
  }

  Cones in_patches(std::vector<int> missing) {
    annihilate(missing);
    std::vector<int> candidates = cones_of(missing);
    take_some(all_places(), kCandidates, candidates);
    return refined(missing, std::move(candidates), kFromField, kOthers);
  }

  Cones from_level(const std::vector<int>& missing) { return refined(missing, cones_of(missing), kFromLevel, 0); }

 private:
  std::vector<int> all_places() const {
    std::vector<int> all;
    for (int v = 0; v < net_.vertex_count(); ++v) {
      if (on_.is_place(v)) all.push_back(v);
    }
    return all;
  }

  static std::vector<int> cones_of(const std::vector<int>& missing) {
    std::vector<int> result;
    for (int v = 0; v < std::ssize(missing); ++v) {
      if (missing[v] != 0) result.push_back(v);
    }
    return result;
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
    std::map<int, int> left;  // what is to be placed in each patch
    if (!missing) left[0] = form_.total();
    for (int v = 0; missing && v < net_.vertex_count(); ++v) {
      if ((*missing)[v] != 0 && on_.patch(v) >= 0) left[on_.patch(v)] += (*missing)[v];
    }
    for (std::size_t i = 0; missing && i < places_.size(); ++i) {
      const int n = (*missing)[places_[i]];
      if (n == 0) continue;
      const auto near = std::ranges::find_if(near_[i], [&](std::size_t j) { return n_[j] != 0 && are_together(i, j); });
      const std::size_t united = near == near_[i].end() ? i : *near;
      add(united, (on_.is_hole(places_[i]) || !moves(i) ? n : std::clamp(n_[united] + n, least_, most_)) - n_[united]);
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
    const VectorXd change = 2 * unit * (Qn_ - form_.b()) + form_.Q().diagonal();
    int best = -1;
    for (const bool apart : {true, false}) {
      if (best >= 0) break;
      for (std::size_t i = 0; i < n_.size(); ++i) {
        if (on_.patch(places_[i]) != patch || !may_be(i, unit) || (apart && n_[i] == 0 && crowd_[i] > 0)) continue;
        if (best < 0 || change[static_cast<Eigen::Index>(i)] < change[best]) best = static_cast<int>(i);
      }
    }
    if (best < 0) throw SolverError("no cones fit this surface: it has too few vertices");
    add(best, unit);
  }

  void add(std::size_t i, int by) {
    const int was = n_[i] != 0 ? 1 : 0;
    n_[i] += by;
    Qn_ += by * form_.Q().col(static_cast<Eigen::Index>(i));
    const int more = (n_[i] != 0 ? 1 : 0) - was;
    for (const std::size_t j : near_[i]) crowd_[j] += more;
  }

  bool moves(std::size_t i) const { return on_.patch(places_[i]) >= 0; }
  bool are_together(std::size_t i, std::size_t j) const {
    return !on_.have_patches() || (moves(i) && on_.patch(places_[i]) == on_.patch(places_[j]));
  }

  bool may_be(std::size_t i, int change) const {
    if (!moves(i)) return false;
    return on_.is_hole(places_[i]) || (change > 0 ? n_[i] + change <= most_ : n_[i] + change >= least_);
  }

  bool are_near(std::size_t i, std::size_t j) const { return std::ranges::binary_search(near_[i], j); }

  void set(std::vector<int> candidates) {
    std::sort(candidates.begin(), candidates.end());
    candidates.erase(std::unique(candidates.begin(), candidates.end()), candidates.end());
    places_ = std::move(candidates);
    // Centres of k-th turns in a lattice whose tiles have the area 1.
    const double between = options_.k == 2 ? 0.5 : options_.k == 4 ? std::sqrt(0.5) : 1.075;
    near_ = on_.near(places_, std::pow(kApart * between, 2) * net_.whole_area / options_.tiles);
    form_.take(places_, [&] { execution_.report(0); });
    execution_.report(0);
    for (std::size_t from = 0; from < places_.size(); from += kCandidates) {
      const auto begin = places_.begin() + static_cast<std::ptrdiff_t>(from);
      exposure_.prepare({begin, begin + std::min<std::ptrdiff_t>(kCandidates, places_.end() - begin)},
                        execution_.workers());
      execution_.report(0);
    }
    prices_.resize(std::ssize(places_));
    for (Eigen::Index i = 0; i < prices_.size(); ++i) {
      const int v = places_[i];
      prices_[i] = on_.is_hole(v) ? 0 : options_.price * (1 + kSeen * exposure_(v));
    }
    n_.assign(places_.size(), 0);
    crowd_.assign(places_.size(), 0);
    Qn_ = VectorXd::Zero(prices_.size());
  }

  // Moves a whole cone, the best of all, while that lowers the cost; then n_i + 1, n_j - 1; and again.
  void search(double price_part, double handles_part) {
    if (n_.empty()) return;  // as on a torus without any
    // The field of the patches says how handles turn.
    const double kappa = on_.have_patches() ? 0 : kHandles * handles_part;
    const MatrixXd& flux = form_.flux();
    Moves moves{form_.Q(), {}, {}, price_part};
    if (kappa > 0 && flux.rows() > 0) moves.form.noalias() += kappa * flux.transpose() * flux;
    moves.diagonal = moves.form.diagonal();
    Execution::count(kProduct * static_cast<double>(n_.size() * n_.size() * flux.rows()));
    execution_.report(0);
    for (int move = 0; move < kMostMoves; ++move) {
      if (move % kMovesAtOnce == 0) execution_.report(0);
      moves.slope = Qn_ - form_.b();
      if (flux.rows() > 0) {
        VectorXd turned = form_.turning();
        for (std::size_t i = 0; i < n_.size(); ++i) {
          if (n_[i] != 0) turned += n_[i] * flux.col(static_cast<Eigen::Index>(i));
        }
        const VectorXd off = turned - form_.unit() * (turned / form_.unit()).array().round().matrix();
        moves.slope += kappa * flux.transpose() * off;
      }
      Move best = best_jump(moves);
      if (best.by == 0) best = best_pair(moves);
      if (best.by == 0) break;
      add(best.to, best.by);
      add(best.from, -best.by);
    }
  }

  // What moves of a state are compared by: the form with its handles, Q + kappa F^T F, and half the slope of the cost.
  struct Moves {
    MatrixXd form;
    VectorXd diagonal, slope;
    double price_part;
  };
  struct Move {
    double change = -kGain;
    std::size_t to = 0, from = 0;
    int by = 0;  // 0: none
  };

  Move best_jump(const Moves& moves) {
    Move best;
    for (std::size_t j = 0; j < n_.size(); ++j) {
      const int w = n_[j];
      if (w == 0 || on_.is_hole(places_[j])) continue;
      Execution::count(kPair * static_cast<double>(n_.size()));
      const auto from = static_cast<Eigen::Index>(j);
      const double price = moves.price_part * price_of(w);
      const double here = w * w * moves.diagonal[from] - 2 * w * moves.slope[from] - price * prices_[from];
      for (const std::size_t i : near_[j]) --crowd_[i];
      for (std::size_t i = 0; i < n_.size(); ++i) {
        const auto at = static_cast<Eigen::Index>(i);
        const double change = here + 2 * w * moves.slope[at] + price * prices_[at] +
                              w * w * (moves.diagonal[at] - 2 * moves.form(at, from));
        if (!(change < best.change) || n_[i] != 0 || crowd_[i] > 0 || on_.is_hole(places_[i]) || !are_together(i, j))
          continue;
        best = {change, i, j, w};
      }
      for (const std::size_t i : near_[j]) ++crowd_[i];
    }
    return best;
  }

  Move best_pair(const Moves& moves) const {
    VectorXd up(prices_.size()), down(prices_.size());
    for (std::size_t i = 0; i < n_.size(); ++i) {
      const auto at = static_cast<Eigen::Index>(i);
      const auto change = [&](int by) {
        if (!may_be(i, by) || (n_[i] == 0 && crowd_[i] > 0)) return kInfinity;
        return 2 * by * moves.slope[at] + moves.price_part * prices_[at] * (price_of(n_[i] + by) - price_of(n_[i]));
      };
      up[at] = change(1);
      down[at] = change(-1);
    }
    const double least_up = up.minCoeff();
    up += moves.diagonal;
    Move best;
    for (std::size_t j = 0; j < n_.size(); ++j) {
      const auto from = static_cast<Eigen::Index>(j);
      // The form is positive: without its part a change is bounded from below.
      if (!(down[from] + least_up < best.change)) continue;
      Execution::count(kPair * static_cast<double>(n_.size()));
      const double here = down[from] + moves.diagonal[from];
      for (std::size_t i = 0; i < n_.size(); ++i) {
        const auto at = static_cast<Eigen::Index>(i);
        const double change = here + up[at] - 2 * moves.form(at, from);
        if (!(change < best.change) || i == j || !are_together(i, j)) continue;
        if (n_[i] == 0 && n_[j] == 0 && are_near(i, j)) continue;
        best = {change, i, j, 1};
      }
    }
    return best;
  }

  // From these cones, among candidates ever nearer to them, and some elsewhere.
  template <class Rounds>
  Cones refined(const std::vector<int>& missing, std::vector<int> candidates, const Rounds& rounds, int others) {
    begin(std::move(candidates), &missing);
    search(1, rounds[0].handles);
    for (const Round& round : rounds) {
      const auto cones = std::max<std::ptrdiff_t>(std::ssize(n_) - std::ranges::count(n_, 0), 1);
      const int around = std::clamp(kMostAround / static_cast<int>(cones), 3, kAround);
      candidates.clear();
      const double reach = round.reach * spacing_ * round.reach * spacing_;
      for (std::size_t i = 0; i < places_.size(); ++i) {
        if (n_[i] == 0 && !on_.is_hole(places_[i])) continue;
        candidates.push_back(places_[i]);
        if (on_.is_hole(places_[i])) continue;
        take_some(on_.within(places_[i], reach), around, candidates);
      }
      take_some(places_, others, candidates);
      const std::vector<int> now = this->cones().missing;
      begin(std::move(candidates), &now);
      search(1, round.handles);
    }
    return cones();
  }

  Cones cones() const {
    Cones result{std::vector<int>(net_.vertex_count(), 0), form_.constant(), 0};
    for (std::size_t i = 0; i < places_.size(); ++i) {
      const auto at = static_cast<Eigen::Index>(i);
      result.missing[places_[i]] = n_[i];
      result.u2 += n_[i] * (Qn_[at] - 2 * form_.b()[at]);
      result.price += prices_[at] * price_of(n_[i]);
    }
    return result;
  }

  // Adds some of the list, evenly.
  static void take_some(const std::vector<int>& list, std::size_t count, std::vector<int>& taken) {
    count = std::min(count, list.size());
    for (std::size_t i = 0; i < count; ++i) taken.push_back(list[i * list.size() / count]);
  }

  Execution& execution_;
  const Net& net_;
  const ConeOptions options_;
  const ConePlaces on_;
  ScaleForm form_;
  std::vector<int> places_, n_;
  std::vector<int> crowd_;  // cones near a candidate
  VectorXd Qn_;
  VectorXd prices_;  // of a cone of one k-th turn at each candidate
  mesh::AmbientOcclusion exposure_;
  std::vector<std::vector<std::size_t>> near_;  // to each candidate, ascending
  int most_ = 0, least_ = 0;
  double spacing_ = 0;
};

}  // namespace

std::vector<Cones> find_cones(const mesh::Surface& surface, const ConeOptions& options, Execution& execution) {
  execution.report(0);
  const Net net(surface);
  Search search(surface, net, options, execution);
  std::vector<Cones> result{search.anywhere(nullptr)};
  for (const double weight : kLevels) {
    if (!options.along) break;
    execution.report(0);
    std::vector<int> missing =
        cones_of_field(net, level_field(net, surface.polygons.vertices, options.k, *options.along, weight), options.k);
    result.push_back(search.anywhere(&missing));
  }
  return result;
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
  return Search(surface, net, options, execution, patch).in_patches(missing);
}

}  // namespace holomorph::tiling
