#include "choice/map.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <sstream>
#include <utility>

#include "base/constants.h"
#include "uv/appearance.h"
#include "uv/direction.h"
#include "uv/evening.h"

namespace holomorph::choice {
namespace {

constexpr double kSlight = 1e-6;     // part of all slopes that may be rounding
constexpr double kMostSpread = 0.6;  // mean distance of the density's logarithm from its median: evening is lessened

double lengths(const mesh::Surface& surface, const std::vector<int>& edges) {
  double sum = 0;
  for (const int e : edges) sum += surface.edge_lengths[e];
  return sum;
}

// Mean distance of the logarithm of the density from that of its median, by area; collapsed triangles do not count.
double density_spread(const uv::Quality& quality) {
  if (!(quality.median_density > 0)) return 0;
  double sum = 0, all = 0;
  for (std::size_t t = 0; t < quality.area.size(); ++t) {
    if (!(quality.area[t] > 0)) continue;
    sum += quality.weights[t] * std::abs(std::log(quality.area[t] / quality.median_density));
    all += quality.weights[t];
  }
  return all > 0 ? sum / all : 0;
}

// Evened; shear grows with evenness and with how far densities differ: where squares of most sizes occur, evenness is
// lessened until no more shear than elsewhere comes of it.
uv::UvArray evened(AnyStructure& structure, const Eigen::VectorXcd& coefficients, const uv::UvArray& uv,
                   const uv::Quality& quality, double evenness, Execution& execution) {
  evenness *= std::min(1.0, kMostSpread / std::max(density_spread(quality), kMostSpread));
  const mesh::Surface& surface = *structure.triangulation();
  const uv::Kept kept = structure.kept(coefficients, execution);
  execution.stage("evening", 0.0, 1.0);
  const uv::UvArray added = uv::evened(surface, uv, kept, evenness, execution);
  uv::UvArray result = uv;
  for (Eigen::Index c = 0; c < result.rows(); ++c)
    result.row(c) += added.row(surface.polygons.corner_vertices[static_cast<std::size_t>(c)]);
  return result;
}

// The number of length 1 by which coefficients are multiplied until v runs up, or UVs where there are none.
Complex turn_upright(const Part& part, const AnyStructure& structure, const uv::UvArray& uv) {
  if (!part.has_positions()) return 1;
  const std::array<double, 3> up{0.0, part.up == uv::Up::kY ? 1.0 : 0.0, part.up == uv::Up::kZ ? 1.0 : 0.0};
  // Rows are level after a half turn, too; on a closed surface the slopes cancel, their squares do not.
  Complex level = 0, sum = 0;
  double length = 0;
  for (int t = 0; t < std::ssize(structure.triangulation()->triangles); ++t) {
    const Complex slope = uv::uphill(*structure.triangulation(), uv, t, up);
    const double own = std::abs(slope);
    if (own > 0) level -= slope * slope / own;
    sum += slope;
    length += own;
  }
  if (!(std::abs(level) > kSlight * length)) return 1;
  Complex turn = structure.is_real() ? 1.0 : std::sqrt(std::conj(level) / std::abs(level));
  if ((sum * turn).imag() < -kSlight * length) turn = -turn;
  if (structure.kind() != MapKind::kRectangle) return turn;
  constexpr Complex kQuarters[] = {{1, 0}, {0, 1}, {-1, 0}, {0, -1}};
  return kQuarters[(static_cast<int>(std::nearbyint(std::arg(turn) / (std::numbers::pi / 2))) + 4) % 4];
}

void turn_by(uv::UvArray& uv, Complex turn) {
  for (Eigen::Index c = 0; c < uv.rows(); ++c) {
    const Complex z = Complex(uv(c, 0), uv(c, 1)) * turn;
    uv.row(c) << z.real(), z.imag();
  }
}

}  // namespace

std::string size_range(const uv::Quality& quality) {
  std::ostringstream text;
  text.precision(3);
  text << std::sqrt(quality.density_ratio);
  return text.str();
}

Map::Map(PartPointer part, StructurePointer structure, LayoutPointer made, std::string why, Execution& execution,
         std::vector<SeamlessPointer> tilings, Eigen::VectorXcd coefficients)
    : part_(std::move(part)),
      structure_(std::move(structure)),
      why_(std::move(why)),
      layout_(std::move(made)),
      tilings_(std::move(tilings)),
      coefficients_(std::move(coefficients)) {
  measure(execution);
}

Map::Map(PartPointer part, StructurePointer structure, SeamlessPointer made, Execution& execution)
    : part_(std::move(part)),
      structure_(std::move(structure)),
      why_("it has no visible seams: size range " + size_range(made->quality)),
      tilings_{std::move(made)} {
  measure(execution);
}

void Map::measure(Execution& execution) {
  const bool is_of_forms = layout_ && layout_->islands == 0 && !is_tiled();
  if (is_of_forms && structure_->kind() == MapKind::kLog) pole_count_ = static_cast<int>(structure_->poles().size());
  for (const SeamlessPointer& tiling : tilings_) pole_count_ += static_cast<int>(tiling->poles.size());
  if (part_->has_positions()) {
    drawn_ = uv::drawn_densities(part_->surface->polygons, uv(), execution.workers());
  } else {
    drawn_ = {1, quality().median_density, quality().density_ratio};
  }
  cost_ = kInfinity;
  const uv::UvArray& map = uv();
  const double size = map.rows() > 0 ? (map.colwise().maxCoeff() - map.colwise().minCoeff()).maxCoeff() : 0;
  if (size > flat::kScattered * std::sqrt(density() * part_->area)) return;
  uv::Marks marks{.poles = pole_count_};
  if (layout_) marks.soft_seams = layout_->soft_length, marks.hard_seams = layout_->hard_length;
  for (const SeamlessPointer& tiling : tilings_) marks.cones += static_cast<int>(tiling->cones.size());
  cost_ = uv::cost(quality(), marks);
}

int Map::turns() const {
  int result = 1;
  for (const SeamlessPointer& tiling : tilings_) result = std::max(result, tiling->turns);
  return result;
}

double Map::drawn_range() const { return drawn_.low > 0 ? std::sqrt(drawn_.high / drawn_.low) : kInfinity; }

std::shared_ptr<const Map> Map::because(std::string why) const {
  auto result = std::make_shared<Map>(*this);
  result->why_ = std::move(why);
  return result;
}

MapPointer form_map(const PartPointer& part, const StructurePointer& structure, double evenness, bool is_upright,
                    std::string why, Execution& execution) {
  nested(execution, 0.0, 0.2, [&] { structure->prepare_uv(execution); });
  Eigen::VectorXcd coefficients =
      nested(execution, 0.2, 0.6, [&] { return structure->balanced_coefficients(execution); });
  const mesh::Surface& surface = *structure->triangulation();
  auto made = std::make_shared<flat::Layout>();
  made->evenness = evenness;
  made->uv = structure->uv(coefficients, execution);
  const Complex turn = is_upright ? turn_upright(*part, *structure, made->uv) : 1;
  if (turn != 1.0) {
    coefficients *= turn;
    made->uv = structure->uv(coefficients, execution);
  }
  made->quality = structure->quality(made->uv, execution);
  if (evenness > 0) {
    made->uv = nested(execution, 0.6, 1.0,
                      [&] { return evened(*structure, coefficients, made->uv, made->quality, evenness, execution); });
    uv::Quality quality = structure->quality(made->uv, execution);
    uv::set_evened_from(quality, made->quality, evenness);
    made->quality = std::move(quality);
  }
  if (is_upright && structure->form_count() == 0) turn_by(made->uv, turn);
  if (is_upright && part->has_positions())
    made->quality.direction = uv::direction(surface, made->uv, part->up, 1, execution.workers());
  const std::vector<int> seams = structure->seams(execution);
  for (const int e : seams) made->seams.push_back(surface.edges[e]);
  if (part->area > 0) made->soft_length = lengths(surface, seams) / std::sqrt(part->area);
  return std::make_shared<const Map>(part, structure, std::move(made), std::move(why), execution,
                                     std::vector<SeamlessPointer>(), std::move(coefficients));
}

}  // namespace holomorph::choice
