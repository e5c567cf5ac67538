#include "flat/island_search.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <span>
#include <utility>

#include "base/constants.h"
#include "mesh/components.h"
#include "mesh/cut_open.h"
#include "mesh/hard_edges.h"
#include "uv/appearance.h"

namespace holomorph::flat {
namespace {

constexpr double kFine = 0.3;  // cost of the squares, from which on no other angle is tried
// Length of hard edges over the square root of the area, from which on these shape the part.
constexpr double kMany = 1;
// Radians of curvature, all of it counted positive, up to which a part with several loops is tried.
constexpr double kFlatPart = kTwoPi;
constexpr double kStretched = 2.5;  // factor of lengths, from which on a piece is also tried with cuts to cone points
constexpr const char* kNoSeams = "no seams cut it open: mark some, or let hard edges be cut";
constexpr const char* kNoneSharp = "no edge is that sharp: choose a smaller angle, or mark seams";
constexpr int kMostCones = 32;          // cuts of each piece to cone points where these are asked for
constexpr int kCones = 8, kRounds = 4;  // at most: cuts of each piece to cone points in a round, and rounds

constexpr double kLeastSeams = 0.8;  // of the seams remains at least: some pieces fit edge to edge
// Times the cost that is wanted at most: cuts to cone points hardly bring it there.
constexpr double kHopeless = 2;
constexpr double kEven = 1e-9;   // of what is minded of conformal squares: evening leaves them as they are
constexpr double kParted = 0.1;  // of overlaps remains at most: they may go, or are cut apart

constexpr double kAlike = 1.1;                    // times a bound: islands are not looked for again for a bound so near
constexpr double kFlattening = 8, kEvening = 15;  // work for each triangle

// What is minded of the squares.
double squares_of(const Layout& islands) { return uv::cost_of_squares(islands.quality) - islands.overlap_cost(); }

double triangle_count(const Sheet& sheet) { return static_cast<double>(sheet.surface.triangles.size()); }

}  // namespace

// A layout that may be worth evening.
struct IslandSearch::Candidate {
  std::shared_ptr<const Flattened> flattened;
  Layout conformal;  // as they are laid out
  int rounds;        // of further cuts that may follow
};

IslandSearch::IslandSearch(const mesh::Surface& surface, const IslandOptions& options, Execution& execution)
    : given_(surface), options_(options) {
  auto oriented = mesh::in_one_orientation(surface, execution);
  sheet_.surface = std::move(oriented.surface);
  order_ = std::move(oriented.corner_index);
  sheet_.breaks = mesh::breaks(sheet_.surface);
  sheet_.area = mesh::area(sheet_.surface, execution.workers());
  sheet_.up = options.up;
  sheet_.is_upright = options.is_upright;
}

std::shared_ptr<const Layout> IslandSearch::best(double most, double work, Execution& execution) {
  const bool is_settled = known_ && asked_.work == kInfinity && known_->cost() < asked_.most;
  if (!is_settled && (most > kAlike * asked_.most || work > kAlike * asked_.work)) {
    asked_ = {most, work};
    if (auto found = search(most, {.left = work}, execution)) known_ = std::move(found);
  }
  return known_ && known_->cost() < most ? known_ : nullptr;
}

std::shared_ptr<const Layout> IslandSearch::at_once(double most, Execution& execution) {
  known_ = search(most, {.hopeless = kHopeless * most, .is_quick = true}, execution);
  return known_;
}

std::shared_ptr<const Layout> IslandSearch::search(double most, Run run, Execution& execution) const {
  execution.part(0, 0);  // how long it takes is not known
  const Execution::Within within(execution);
  std::optional<Layout> found;
  for (const double degrees : kHardAngles) {
    if (!is_tried(degrees, found || degrees > kSmoothAngle)) continue;
    const Cuts cuts(sheet_.surface, hard(degrees), true, execution);
    if (auto made = along(cuts, found ? cost(*found, run) : most, run, execution)) found = std::move(made);
    if (found && uv::cost_of_squares(found->quality) <= kFine) break;
  }
  return found ? std::make_shared<const Layout>(as_given(*std::move(found), execution)) : nullptr;
}

// Where no edge is hard a cut would be one through the smooth; but a disk, or what has little curvature, may be flat.
bool IslandSearch::is_tried(double degrees, bool is_wanted) const {
  const mesh::Surface& surface = sheet_.surface;
  if (degrees == kHardAngles[0]) {
    const auto type = mesh::topological_type(surface);
    const bool is_disk = type.genus == 0 && type.boundary_count == 1;
    if (is_disk || (type.boundary_count > 0 && mesh::curvature(surface, {}) < kFlatPart)) return true;
  }
  if (!is_wanted) return false;
  const std::vector<char> is_hard = hard(degrees);
  double length = 0;
  for (std::size_t e = 0; e < is_hard.size(); ++e) length += is_hard[e] ? surface.edge_lengths[e] : 0;
  return length > kMany * std::sqrt(sheet_.area);
}

std::vector<char> IslandSearch::hard(double degrees) const {
  std::vector<char> result(sheet_.breaks.size());
  std::ranges::transform(sheet_.breaks, result.begin(),
                         [most = mesh::radians(degrees)](double bend) { return bend > most ? 1 : 0; });
  return result;
}

std::shared_ptr<const Layout> IslandSearch::along(const ChosenCuts& chosen, Execution& execution) const {
  execution.part(0, 0);  // how long it takes is not known
  const Execution::Within within(execution);
  const mesh::Surface& surface = sheet_.surface;
  std::vector<char> is_cut = hard(chosen.hard_degrees > 0 ? chosen.hard_degrees : kInfinity);
  const std::span polygon_edges(surface.edges.data(), surface.polygon_edge_count);
  for (const auto& [a, b] : chosen.seams) {
    const int edge = mesh::edge_between(polygon_edges, std::min(a, b), std::max(a, b));
    if (edge >= 0) is_cut[edge] = 1;
  }
  Cuts cuts(surface, std::move(is_cut), chosen.hard_degrees > 0, execution);
  std::optional<Flattened> made = Flattened::of(sheet_, cuts, execution);
  const auto again = [&](const std::vector<char>& more) {
    if (!made || !cuts.add(more)) return false;
    made = Flattened::of(sheet_, cuts, execution);
    return true;
  };
  for (int count = 0; chosen.most_stretch > 0 && count < kMostCones && made; ++count) {
    if (!again(cuts.to_cones(made->pieces(), made->flat(), chosen.most_stretch, execution))) break;
  }
  uv::UvArray uv;
  for (int round = 0; made; ++round) {
    uv = made->evened(options_.evenness, execution);
    if (round == kRounds || !again(cuts.across_overlaps(made->pieces(), uv, execution))) break;
  }
  if (!made) throw TopologyError(chosen.hard_degrees > 0 ? kNoneSharp : kNoSeams);
  const bool is_evened = options_.evenness > 0;
  Layout result = made->laid_out(is_evened ? made->evened(0, execution) : uv, 0, nullptr, false, execution);
  if (is_evened) result = made->laid_out(uv, options_.evenness, &result, false, execution);
  return std::make_shared<const Layout>(as_given(std::move(result), execution));
}

// The best islands from these cuts on that cost less than `most`.
std::optional<Layout> IslandSearch::along(const Cuts& cuts, double most, Run& run, Execution& execution) const {
  std::vector<Candidate> left = candidates(cuts, most, kRounds, run, execution);
  std::optional<Layout> found;
  for (int round = 0; round < kRounds && !left.empty(); ++round) {
    const auto one = std::ranges::min_element(left, [&](const Candidate& a, const Candidate& b) {
      return guess(a.conformal, run) < guess(b.conformal, run);
    });
    if (!(guess(one->conformal, run) < most) && !std::isinf(most)) break;
    if (run.left <= 0 && std::isfinite(most)) break;
    const Candidate candidate = std::move(*one);
    left.erase(one);
    run.left -= kEvening * triangle_count(sheet_);
    const double evenness = squares_of(candidate.conformal) <= kEven ? 0 : options_.evenness;
    const uv::UvArray uv = candidate.flattened->evened(evenness, execution);
    Layout made = evenness == 0 ? candidate.conformal
                                : candidate.flattened->laid_out(uv, evenness, &candidate.conformal, true, execution);
    made.evenness = options_.evenness;
    const bool overlaps = made.overlap_cost() > 0;
    if (cost(made, run) < most) {
      most = cost(made, run);
      found = std::move(made);
    }
    if (!overlaps) continue;
    Cuts more = candidate.flattened->cuts();
    if (!more.add(more.across_overlaps(candidate.flattened->pieces(), uv, execution))) continue;
    auto parted = candidates(std::move(more), most, candidate.rounds, run, execution);
    std::ranges::move(parted, std::back_inserter(left));
  }
  return found;
}

// Those of cuts, and of further ones to cone points.
std::vector<IslandSearch::Candidate> IslandSearch::candidates(Cuts cuts, double most, int rounds, Run& run,
                                                              Execution& execution) const {
  std::vector<Candidate> result;
  for (int left = rounds - 1; left >= 0; --left) {
    auto made = flattened(cuts, most, run, execution);
    if (!made) break;
    Layout conformal = made->laid_out(made->evened(0, execution), 0, nullptr, true, execution);
    result.push_back({std::make_shared<const Flattened>(*std::move(made)), std::move(conformal), left});
    if (guess(result.back().conformal, run) >= run.hopeless ||
        !cut_to_cones(cuts, *result.back().flattened, most, run, execution))
      break;
  }
  return result;
}

// Nothing where seams alone cost too much, no work is left, or a piece has no flat map.
std::optional<Flattened> IslandSearch::flattened(const Cuts& cuts, double most, Run& run, Execution& execution) const {
  const auto [soft, hard] = visible_lengths(sheet_.surface, sheet_.area, sheet_.breaks, cuts.is_cut());
  const double seams = uv::cost_of_marks({soft, run.is_quick ? 0 : hard});
  if (kLeastSeams * seams >= most || run.left <= 0) return std::nullopt;
  run.left -= kFlattening * triangle_count(sheet_);
  return Flattened::of(sheet_, cuts, execution);
}

// Whether there was a piece to cut; of each one after the other, until none stretches.
bool IslandSearch::cut_to_cones(Cuts& cuts, const Flattened& first, double most, Run& run, Execution& execution) const {
  std::optional<Flattened> made;
  const Flattened* now = &first;
  int count = 0;
  while (now && count < kCones && cuts.add(cuts.to_cones(now->pieces(), now->flat(), kStretched, execution))) {
    made = flattened(cuts, most, run, execution);
    now = made ? &*made : nullptr;
    ++count;
  }
  return count > 0;
}

double IslandSearch::cost(const Layout& islands, const Run& run) const {
  if (!run.is_quick) return islands.cost();
  const auto& direction = islands.quality.direction;
  return islands.cost() - uv::kHardSeam * islands.hard_length - (direction ? uv::cost_of_direction(*direction) : 0);
}

// About what it costs when squares are evened, and what overlaps is cut apart.
double IslandSearch::guess(const Layout& islands, const Run& run) const {
  const double squares = squares_of(islands);
  if (!std::isfinite(squares)) return kInfinity;
  const double left = options_.evenness > 0 ? kEvenedCost : 1;
  return cost(islands, run) - (1 - left) * squares - std::max(islands.overlap_cost() - kParted, 0.0);
}

// With corners as they were given, where polygons were turned round.
Layout IslandSearch::as_given(Layout found, Execution& execution) const {
  if (order_.empty()) return found;
  uv::UvArray uv(found.uv.rows(), 2);
  for (std::size_t c = 0; c < order_.size(); ++c) uv.row(order_[c]) = found.uv.row(static_cast<Eigen::Index>(c));
  found.uv = std::move(uv);
  uv::Quality quality = uv::quality(given_, found.uv, execution.workers());
  quality.overlapping_part = found.quality.overlapping_part;
  quality.unseen_angle = found.quality.unseen_angle;
  if (options_.is_upright) quality.direction = uv::direction(given_, found.uv, options_.up, 1, execution.workers());
  found.quality = std::move(quality);
  return found;
}

std::shared_ptr<const Layout> island_map(const mesh::Surface& surface, const IslandOptions& options,
                                         Execution& execution) {
  IslandSearch search(surface, options, execution);
  return search.best(kInfinity, kInfinity, execution);
}

}  // namespace holomorph::flat
