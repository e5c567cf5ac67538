#include "flat/split_overlaps.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <unordered_map>

namespace holomorph::flat {

namespace {

constexpr double kTouching = 1e-6;     // largest depth of two triangles that only touch, over their size
constexpr double kLeastWidth = 1e-12;  // least width of a triangle: twice its area over its squared sides

double cross(Complex a, Complex b) { return (std::conj(a) * b).imag(); }

// Twice the area over the sum of the squares of two sides.
double width_of(const Points& t) {
  const Complex one = t[1] - t[0], other = t[2] - t[0];
  return cross(one, other) / (std::norm(one) + std::norm(other));
}

// Whether a side of `a` separates the two triangles, up to kTouching. Convex figures in the plane are apart if and only
// if a side of one of them separates them.
bool side_parts(const Points& a, const Points& b) {
  for (int i = 0; i < 3; ++i) {
    const Complex side = a[(i + 1) % 3] - a[i];
    const double length = std::abs(side);
    if (!(length > 0)) continue;
    double deepest = 0, inner = 0;
    for (int j = 0; j < 3; ++j) {
      deepest = std::max(deepest, cross(side, b[j] - a[i]) / length);
      inner = std::max(inner, cross(side, a[j] - a[i]) / length);
    }
    if (deepest <= kTouching * std::max(length, inner)) return true;
  }
  return false;
}

}  // namespace

void Box::add(Complex z) {
  left = std::min(left, z.real()), right = std::max(right, z.real());
  low = std::min(low, z.imag()), high = std::max(high, z.imag());
}

Box box_of(const Points& triangle) {
  Box box;
  for (const Complex z : triangle) box.add(z);
  return box;
}

bool overlap(const Points& a, const Points& b) {
  if (!(width_of(a) > kLeastWidth && width_of(b) > kLeastWidth)) return false;
  return !side_parts(a, b) && !side_parts(b, a);
}

namespace {

constexpr double kMostSquares = 64;  // along the grid, from 0 to the farthest corner

// Whether the segment runs inside the triangle, deeper than kTouching, or along a side in its direction. The triangle
// is counter-clockwise; what the segment bounds is on its left.
bool enters(const Points& triangle, Complex start, Complex end) {
  double first = 0, last = 1;  // the part of the segment that is inside the sides so far
  bool is_along = false;
  for (int i = 0; i < 3; ++i) {
    const Complex a = triangle[i], side = triangle[(i + 1) % 3] - a;
    const double length = std::abs(side), inner = cross(side, triangle[(i + 2) % 3] - a) / length;
    const double least = kTouching * std::max(length, inner);
    const double at_start = cross(side, start - a) / length, at_end = cross(side, end - a) / length;
    if (std::max(std::abs(at_start), std::abs(at_end)) <= least && (std::conj(side) * (end - start)).real() > 0) {
      is_along = true;
      continue;
    }
    if (!(at_start > least || at_end > least)) return false;
    if (at_start > least && at_end > least) continue;
    const double crossing = (at_start - least) / (at_start - at_end);
    at_start > least ? last = std::min(last, crossing) : first = std::max(first, crossing);
  }
  return is_along ? last - first > kTouching : first < last;
}

// The boundary of a part of a map, as segments with the part on their left, by the squares of a grid that they meet.
// Segments between two triangles are no more in it: so what is around one vertex costs as little as anything else.
class Border {
 public:
  explicit Border(double width) : width_(width > 0 ? width : 1) {}

  bool has(int edge) const { return live_.contains(edge); }

  // Adds a segment, or removes the one of this edge.
  void toggle(int edge, Complex start, Complex end) {
    if (live_.erase(edge) > 0) return;
    live_[edge] = static_cast<int>(segments_.size());
    for_squares({start, end, end}, [&](std::uint64_t square) {
      squares_[square].push_back(static_cast<int>(segments_.size()));
      return true;
    });
    segments_.push_back({edge, start, end});
  }

  // Whether a segment enters the triangle.
  bool meets(const Points& triangle) {
    return !for_squares(triangle, [&](std::uint64_t square) {
      const auto found = squares_.find(square);
      if (found == squares_.end()) return true;
      std::erase_if(found->second, [&](int k) { return !is_live(k); });
      Execution::count(static_cast<double>(found->second.size()));
      return std::ranges::none_of(found->second,
                                  [&](int k) { return enters(triangle, segments_[k].start, segments_[k].end); });
    });
  }

  // Whether the part lies around a point. Looks at all segments.
  bool is_around(Complex z) const {
    int winding = 0;
    for (const auto& [edge, k] : live_) {
      const Complex a = segments_[k].start - z, b = segments_[k].end - z;
      if ((a.imag() > 0) == (b.imag() > 0)) continue;
      const double side = cross(a, b);
      if (b.imag() > 0 ? side > 0 : side < 0) winding += b.imag() > 0 ? 1 : -1;
    }
    Execution::count(static_cast<double>(live_.size()));
    return winding != 0;
  }

 private:
  struct Segment {
    int edge;
    Complex start, end;
  };

  bool is_live(int k) const {
    const auto found = live_.find(segments_[k].edge);
    return found != live_.end() && found->second == k;
  }

  std::int64_t square_at(double x) const { return static_cast<std::int64_t>(std::floor(x / width_)); }

  // Visits the squares that a triangle meets, column by column, while `visit` answers true. @return whether it always
  // did
  template <class Visit>
  bool for_squares(const Points& triangle, const Visit& visit) {
    const Box box = box_of(triangle);
    for (auto x = square_at(box.left); x <= square_at(box.right); ++x) {
      const Box column = within(triangle, static_cast<double>(x) * width_, static_cast<double>(x + 1) * width_);
      const double margin = kTouching * width_;  // the ends in a column are rounded
      for (auto y = square_at(column.low - margin); y <= square_at(column.high + margin); ++y) {
        Execution::count(1);
        if (!visit((static_cast<std::uint64_t>(x) << 32) ^ (static_cast<std::uint64_t>(y) & 0xffffffffu))) return false;
      }
    }
    return true;
  }

  // The box of the part of a triangle between two verticals.
  static Box within(const Points& triangle, double left, double right) {
    Box box;
    for (int i = 0; i < 3; ++i) {
      const Complex a = triangle[i], b = triangle[(i + 1) % 3];
      if (left <= a.real() && a.real() <= right) box.add(a);
      for (const double x : {left, right}) {
        if ((a.real() < x) != (b.real() < x)) box.add(a + (x - a.real()) / (b.real() - a.real()) * (b - a));
      }
    }
    return box;
  }

  double width_;
  std::vector<Segment> segments_;
  std::unordered_map<int, int> live_;  // edge to segment
  std::unordered_map<std::uint64_t, std::vector<int>> squares_;
};

class Parts {
 public:
  Parts(const mesh::Surface& surface, const uv::UvArray& uv, Execution& execution)
      : surface_(surface), uv_(uv), execution_(execution) {
    const std::size_t count = surface.polygons.face_offsets.size() - 1;
    part_.assign(count, -1);
    triangles_.resize(count);
    neighbours_.resize(count);
    std::vector<int> first(surface.polygon_edge_count, -1);
    for (int t = 0; t < static_cast<int>(surface.triangles.size()); ++t) {
      const int face = surface.triangle_faces[t];
      triangles_[face].push_back(t);
      for (const int e : surface.triangle_edges[t]) {
        if (surface.is_diagonal(e)) continue;
        if (first[e] < 0) {
          first[e] = face;
        } else {
          neighbours_[face].push_back(first[e]);
          neighbours_[first[e]].push_back(face);
        }
      }
    }
  }

  std::vector<int> found() {
    const double width = square_width();
    queued_for_.assign(part_.size(), -1);
    int part = 0;
    for (int face = 0; face < static_cast<int>(part_.size()); ++face) {
      if (part_[face] < 0) grow(face, part++, width);
    }
    return std::move(part_);
  }

 private:
  // Twice the side of a triangle of the mean area, so that a square has few; but long triangles are not to meet many.
  double square_width() const {
    double area = 0;
    for (std::size_t t = 0; t < surface_.triangles.size(); ++t) {
      const Points p = points(static_cast<int>(t));
      area += std::abs((std::conj(p[1] - p[0]) * (p[2] - p[0])).imag()) / 2;
    }
    const double width = 2 * std::sqrt(area / std::max<double>(1, static_cast<double>(surface_.triangles.size())));
    return std::max(width, uv_.cwiseAbs().maxCoeff() / kMostSquares);
  }

  void grow(int start, int part, double width) {
    Border border(width);
    std::vector<int> queue{start};
    queued_for_[start] = part;
    for (std::size_t next = 0; next < queue.size(); ++next) {
      const int face = queue[next];
      execution_.report(static_cast<double>(start) / static_cast<double>(part_.size()));
      // A polygon that overlaps stays unmarked, for a later part.
      if (overlaps(face, border)) continue;
      for (const int t : triangles_[face]) add(t, border);
      part_[face] = part;
      for (const int other : neighbours_[face]) {
        // A polygon is tried once for each part: one that overlapped an earlier part may fit this one.
        if (part_[other] >= 0 || queued_for_[other] == part) continue;
        queued_for_[other] = part;
        queue.push_back(other);
      }
    }
  }

  // Only triangles that are counter-clockwise and have an area overlap. What lies at the border of the part, on its
  // other side, lies in it only where the border enters.
  bool overlaps(int face, Border& border) const {
    const auto& own = triangles_[face];
    const auto is_beside = [&](int t) {
      return std::ranges::any_of(surface_.triangle_edges[t], [&](int e) { return border.has(e); });
    };
    const bool is_upright = std::ranges::none_of(own, [&](int t) { return width_of(points(t)) < -kLeastWidth; });
    const bool are_beside = is_upright && std::ranges::any_of(own, is_beside);
    return std::ranges::any_of(own, [&](int t) {
      const Points p = points(t);
      if (!(width_of(p) > kLeastWidth)) return false;
      return border.meets(p) || (!are_beside && !is_beside(t) && border.is_around((p[0] + p[1] + p[2]) / 3.0));
    });
  }

  // A flipped triangle is left out, so that what follows it is compared with what it lies on.
  void add(int t, Border& border) const {
    const Points p = points(t);
    if (width_of(p) < -kLeastWidth) return;
    for (int i = 0; i < 3; ++i) border.toggle(surface_.triangle_edges[t][i], p[i], p[(i + 1) % 3]);
  }

  Points points(int t) const {
    Points result;
    for (int i = 0; i < 3; ++i) {
      const int corner = surface_.triangle_corners[t][i];
      result[i] = Complex(uv_(corner, 0), uv_(corner, 1));
    }
    return result;
  }

  const mesh::Surface& surface_;
  const uv::UvArray& uv_;
  Execution& execution_;
  std::vector<int> part_, queued_for_;
  std::vector<std::vector<int>> triangles_, neighbours_;  // each polygon's
};

}  // namespace

std::vector<int> parted(const mesh::Surface& surface, const uv::UvArray& uv, Execution& execution) {
  if (!uv.allFinite()) return {surface.face_component.begin(), surface.face_component.end()};
  return Parts(surface, uv, execution).found();
}

}  // namespace holomorph::flat
