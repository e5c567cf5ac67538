#include "choice/untiled.h"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <utility>

#include "base/constants.h"
#include "choice/automatic_structure.h"
#include "mesh/hard_edges.h"
#include "uv/appearance.h"

namespace holomorph::choice {
namespace {

// The work on a tiling, in millionths of about a second, for each triangle of the level on which poles are placed, and
// of the part; how much of it is spent on islands where there is a tiling, and what is spent on them in any case.
constexpr double kPlaced = 40, kLevel = 10'000, kRoundedPart = 8;
constexpr double kBudget = 0.4, kLeastWork = 100'000;

// Times that, where all else is poor, with more triangles than that; with fewer as much as they take.
constexpr double kLonger = 5;
constexpr int kQuickTriangles = 25'000;

// What ask() finds; nothing where islands collapse or cannot be made: another map may be.
template <class Ask>
LayoutPointer found_or_none(const Ask& ask) {
  const LayoutPointer found = unless_refused(ask, [](const Error&) { return LayoutPointer(); });
  return found && std::isfinite(found->cost()) ? found : nullptr;
}

// How it is flattened, in one sentence.
std::string how(const flat::Layout& flat) {
  std::ostringstream text;
  text.precision(3);
  text << "it flattens ";
  if (flat.seams.empty()) {
    text << "in one piece";
  } else {
    text << "along its " << (flat.soft_length <= kMostSoft ? "hard edges" : "seams") << " into " << flat.islands
         << (flat.islands == 1 ? " piece" : " pieces");
  }
  text << ": size range " << std::sqrt(flat.quality.density_ratio);
  return text.str();
}

double distance(const std::array<double, 3>& a, const std::array<double, 3>& b) {
  return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
}

}  // namespace

Untiled::Untiled(PartPointer part, StructurePointer structure, double evenness, bool is_upright, Execution& execution)
    : part_(std::move(part)), structure_(std::move(structure)), evenness_(evenness), is_upright_(is_upright) {
  if (!part_->has_positions() || !(part_->area > 0)) return;
  const flat::IslandOptions options{evenness, part_->up, is_upright};
  search_ = std::make_unique<flat::IslandSearch>(*part_->surface, options, execution);
}

MapPointer Untiled::at_once(Execution& execution) {
  if (!may_flatten()) return nullptr;
  LayoutPointer flat = found_or_none([&] { return search_->at_once(kGood, execution); });
  if (flat && uv::cost_of_squares(flat->quality) > kFlat) {
    const LayoutPointer better = found_or_none([&] { return search_->best(flat->cost(), work(), execution); });
    flat = better ? better : flat;
  }
  return map(flat, "", execution);
}

MapPointer Untiled::islands(double most, double work, Execution& execution) {
  if (!search_) return nullptr;
  return map(found_or_none([&] { return search_->best(most, work, execution); }), "", execution);
}

MapPointer Untiled::instead(const std::string& why, Execution& execution) {
  if (!search_) return nullptr;
  LayoutPointer flat = found_or_none([&] { return search_->best(kInfinity, much_work(), execution); });
  if (!flat) flat = found_or_none([&] { return search_->best(kInfinity, kInfinity, execution); });
  return flat ? map(flat, "it has " + why + "; " + how(*flat), execution) : nullptr;
}

MapPointer Untiled::along(const flat::ChosenCuts& cuts, Execution& execution) const {
  if (!search_) throw TopologyError("islands need a surface with positions and an area");
  return map(search_->along(cuts, execution), "", execution);
}

MapPointer Untiled::balanced(const std::string& why, Execution& execution) {
  return form_map(part_, structure(execution), evenness_, is_upright_, why, execution);
}

MapPointer Untiled::best(const std::string& why, Execution& execution) {
  MapPointer best = may_flatten() ? islands(kInfinity, work(), execution) : nullptr;
  if (best && best->cost() < kPoor) return best;
  best = best ? cheaper(best, unless_refused([&] { return balanced(why, execution); },
                                             [](const Error&) { return MapPointer(); }))
              : balanced(why, execution);
  return best->cost() < kPoor ? best : cheaper(best, islands(best->cost(), much_work(), execution));
}

MapPointer Untiled::one_island(const SeamlessMap& tiling, const std::string& why, Execution& execution) const {
  if (!part_->has_positions()) return nullptr;
  auto flat = std::make_shared<flat::Layout>();
  const double density = tiling.quality.median_density;
  flat->uv = tiling.uv / std::sqrt(density);
  flat->seams = tiling.seams;
  flat->islands = 1;
  const auto& points = part_->surface->polygons.vertices;
  for (const auto& [a, b] : tiling.seams) flat->soft_length += distance(points[a], points[b]);
  flat->soft_length /= std::sqrt(part_->area);
  flat->quality = uv::of_density(tiling.quality, 1);
  flat->evenness = tiling.evenness;
  return map(flat, why, execution);
}

MapPointer Untiled::map(LayoutPointer flat, std::string why, Execution& execution) const {
  if (!flat) return nullptr;
  if (why.empty()) why = how(*flat);
  return std::make_shared<const Map>(part_, structure_, std::move(flat), std::move(why), execution);
}

const StructurePointer& Untiled::structure(Execution& execution) {
  if (!structure_) structure_ = automatic_structure(part_, {}, execution);
  return structure_;
}

bool Untiled::may_flatten() {
  if (!search_) return false;
  if (!may_flatten_) {
    const mesh::Surface& surface = *part_->surface;
    const std::vector<double> breaks = mesh::breaks(surface);
    std::vector<char> is_hard;
    double hard = 0;
    for (std::size_t e = 0; e < breaks.size(); ++e) {
      is_hard.push_back(breaks[e] > mesh::radians(flat::kHardAngles.back()));
      if (breaks[e] > mesh::radians(flat::kHardAngles.front())) hard += surface.edge_lengths[e];
    }
    const bool is_edged = part_->triangle_count() <= kQuickTriangles && hard >= kEdged * std::sqrt(part_->area);
    may_flatten_ = is_edged || mesh::curvature(surface, is_hard, mesh::kTip) <= kMostCurved;
  }
  return *may_flatten_;
}

double Untiled::much_work() const { return part_->triangle_count() > kQuickTriangles ? kLonger * work() : kInfinity; }

double Untiled::work() const {
  const double count = part_->triangle_count();
  return kLeastWork + kBudget * (kPlaced * std::min(count, kLevel) + kRoundedPart * count);
}

}  // namespace holomorph::choice
