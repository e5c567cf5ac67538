#include "islands/split_overlaps.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <unordered_map>

namespace holomorph::islands {

namespace {

constexpr double kTouching = 1e-6;     // largest depth of two triangles that only touch, over their size
constexpr double kLeastWidth = 1e-12;  // least width of a triangle: twice its area over its squared sides

double cross(Complex a, Complex b) { return (std::conj(a) * b).imag(); }

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
  for (const Points* t : {&a, &b}) {
    const Complex one = (*t)[1] - (*t)[0], other = (*t)[2] - (*t)[0];
    if (!(cross(one, other) > kLeastWidth * (std::norm(one) + std::norm(other)))) return false;
  }
  return !side_parts(a, b) && !side_parts(b, a);
}

namespace {

constexpr double kMostSquares = 64;  // along the grid, from 0 to the farthest corner

// Triangles in the plane by the squares of a grid that they meet.
class Grid {
 public:
  explicit Grid(double width) : width_(width > 0 ? width : 1) {}

  void add(const Points& triangle) {
    const int index = static_cast<int>(triangles_.size());
    triangles_.push_back(triangle);
    for_squares(triangle, [&](std::uint64_t square) {
      squares_[square].push_back(index);
      return true;
    });
  }

  bool overlaps(const Points& triangle) const {
    const Box box = box_of(triangle);
    return !for_squares(triangle, [&](std::uint64_t square) {
      const auto found = squares_.find(square);
      return found == squares_.end() || std::none_of(found->second.begin(), found->second.end(), [&](int other) {
               return box.meets(box_of(triangles_[other])) && overlap(triangle, triangles_[other]);
             });
    });
  }

 private:
  // Visits the squares that the triangle's box meets, while `visit` answers true. @return whether it always did
  template <class Visit>
  bool for_squares(const Points& triangle, const Visit& visit) const {
    const Box box = box_of(triangle);
    const auto first = [&](double low) { return static_cast<std::int64_t>(std::floor(low / width_)); };
    for (auto x = first(box.left); x <= first(box.right); ++x) {
      for (auto y = first(box.low); y <= first(box.high); ++y) {
        if (!visit((static_cast<std::uint64_t>(x) << 32) ^ (static_cast<std::uint64_t>(y) & 0xffffffffu))) return false;
      }
    }
    return true;
  }

  double width_;
  std::vector<Points> triangles_;
  std::unordered_map<std::uint64_t, std::vector<int>> squares_;
};

class Parts {
 public:
  Parts(const mesh::Surface& surface, const uv::UvArray& uv) : surface_(surface), uv_(uv) {
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
    Grid grid(width);
    std::vector<int> queue{start};
    queued_for_[start] = part;
    for (std::size_t next = 0; next < queue.size(); ++next) {
      const int face = queue[next];
      const auto& own = triangles_[face];
      // A polygon that overlaps stays unmarked, for a later part.
      if (std::any_of(own.begin(), own.end(), [&](int t) { return grid.overlaps(points(t)); })) continue;
      for (const int t : own) grid.add(points(t));
      part_[face] = part;
      for (const int other : neighbours_[face]) {
        // A polygon is tried once for each part: one that overlapped an earlier part may fit this one.
        if (part_[other] >= 0 || queued_for_[other] == part) continue;
        queued_for_[other] = part;
        queue.push_back(other);
      }
    }
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
  std::vector<int> part_, queued_for_;
  std::vector<std::vector<int>> triangles_, neighbours_;  // each polygon's
};

}  // namespace

std::vector<int> parted(const mesh::Surface& surface, const uv::UvArray& uv) {
  if (!uv.allFinite()) return {surface.face_component.begin(), surface.face_component.end()};
  return Parts(surface, uv).found();
}

}  // namespace holomorph::islands
