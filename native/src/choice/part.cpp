#include "choice/part.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <unordered_map>
#include <utility>

namespace holomorph::choice {
namespace {

// Rounding of differences of coordinates in single precision, relative to the largest coordinate.
constexpr double kSingle = 0x1p-22;
constexpr double kNear = 1.001;         // times the rounding of two names, for that of the sums themselves
constexpr double kMostRounding = 1e-3;  // over the mean edge: parts so far from the origin are not known to be alike

// Weights at random, but always alike.
class Weights {
 public:
  double operator()(std::size_t i) {
    while (values_.size() <= i) {
      const double n = static_cast<double>(values_.size() + 1);
      values_.push_back(std::sin(n * n));
    }
    return values_[i];
  }

 private:
  std::vector<double> values_;
};

template <class Values>
double mean(const Values& values) {
  double sum = 0;
  for (const double value : values) sum += value;
  return sum / static_cast<double>(values.size());
}

struct Shape {
  const mesh::Surface* surface = nullptr;
  double mean_length = 0;
  std::vector<double> heights;  // #V above their mean, none of an intrinsic surface
  double size = 0;              // root of the area
  double rounding = 0;          // of the lengths, and of the heights
  // A mean of lengths and heights over the size, weighted: those of two copies differ by no more than their `rounding`,
  // over their sizes, and hardly two others have the same.
  double name = 0;
};

Shape shape_of(const Part& part, Weights& weights) {
  const mesh::Surface& surface = *part.surface;
  Shape result{&surface, mean(surface.edge_lengths), {}, std::sqrt(part.area)};
  double largest = 0;
  if (part.has_positions()) {
    const int up = static_cast<int>(part.up);
    for (const auto& point : surface.polygons.vertices) {
      result.heights.push_back(point[up]);
      for (const double x : point) largest = std::max(largest, std::abs(x));
    }
    const double middle = mean(result.heights);
    for (double& height : result.heights) height -= middle;
  } else {
    largest = *std::ranges::max_element(surface.edge_lengths);
  }
  result.rounding = kSingle * largest;
  double sum = 0, all = 0;
  std::size_t i = 0;
  const auto add = [&](double value) {
    const double weight = weights(i++);
    sum += weight * value;
    all += std::abs(weight);
  };
  for (const double length : surface.edge_lengths) add(length);
  for (const double height : result.heights) add(height);
  result.name = sum / (all * result.size);
  return result;
}

template <class Values>
bool are_near(const Values& own, const Values& others, double scale, double tolerance) {
  for (std::size_t i = 0; i < own.size(); ++i) {
    if (!(std::abs(own[i] - scale * others[i]) <= tolerance)) return false;
  }
  return true;
}

// Lengths of one over those of another; 0 where it is no copy. @pre the same triangles
double scale_of(const Shape& one, const Shape& other) {
  if (!(one.size > 0 && other.size > 0) || one.heights.size() != other.heights.size()) return 0;
  const double scale = one.size / other.size, tolerance = one.rounding + scale * other.rounding;
  if (tolerance > kMostRounding * one.mean_length) return 0;
  if (std::abs(one.mean_length - scale * other.mean_length) > tolerance) return 0;
  const bool is_copy = are_near(one.surface->edge_lengths, other.surface->edge_lengths, scale, tolerance) &&
                       are_near(one.heights, other.heights, scale, tolerance);
  return is_copy ? scale : 0;
}

// Shapes of the same triangles, none a copy of another.
class Known {
 public:
  bool has_triangles_of(const mesh::Surface& surface) const {
    const mesh::Surface& own = *shapes_.begin()->second.surface;
    return own.polygons.face_offsets == surface.polygons.face_offsets && own.triangles == surface.triangles;
  }

  void add(int index, Shape shape) {
    if (shape.size > 0) {
      names_.insert({shape.name, index});
      rounding_ = std::max(rounding_, shape.rounding / shape.size);
    }
    shapes_.emplace(index, std::move(shape));
  }

  /// The copy that a shape is of the first of these; of none: the scale 0.
  Copy copy_of(const Shape& shape) const {
    if (!(shape.size > 0)) return {0, 0};
    const double reach = kNear * (rounding_ + shape.rounding / shape.size);
    std::vector<int> near;
    for (auto at = names_.lower_bound({shape.name - reach, -1}); at != names_.end() && at->first <= shape.name + reach;
         ++at)
      near.push_back(at->second);
    std::ranges::sort(near);
    for (const int index : near) {
      if (const double scale = scale_of(shape, shapes_.at(index)); scale > 0) return {index, scale};
    }
    return {0, 0};
  }

 private:
  std::set<std::pair<double, int>> names_;
  std::map<int, Shape> shapes_;
  double rounding_ = 0;  // the largest of their names
};

}  // namespace

std::vector<Copy> copies(const std::vector<PartPointer>& parts, Execution& execution) {
  std::vector<Copy> result;
  std::unordered_multimap<std::size_t, Known> alike;
  Weights weights;
  for (std::size_t k = 0; k < parts.size(); ++k) {
    const mesh::Surface& surface = *parts[k]->surface;
    Execution::count(static_cast<double>(surface.edges.size()));
    execution.report(static_cast<double>(k) / static_cast<double>(parts.size()));
    Shape shape = shape_of(*parts[k], weights);
    const std::size_t hash = hash_of(surface.triangles);
    const auto [begin, end] = alike.equal_range(hash);
    const auto known =
        std::find_if(begin, end, [&](const auto& each) { return each.second.has_triangles_of(surface); });
    const int index = static_cast<int>(k);
    if (known == end) {
      alike.emplace(hash, Known())->second.add(index, std::move(shape));
      result.push_back({index});
      continue;
    }
    const Copy copy = known->second.copy_of(shape);
    result.push_back(copy.scale > 0 ? copy : Copy{index});
    if (!(copy.scale > 0)) known->second.add(index, std::move(shape));
  }
  return result;
}

PartPointer part_of(std::shared_ptr<const mesh::Surface> surface, uv::Up up, std::vector<int> labels,
                    Execution& execution) {
  const mesh::TopologicalType type = mesh::topological_type(*surface);
  const double area = mesh::area(*surface, execution.workers());
  return std::make_shared<const Part>(Part{std::move(surface), up, std::move(labels), type, area});
}

}  // namespace holomorph::choice
