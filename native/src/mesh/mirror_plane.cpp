#include "mesh/mirror_plane.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "linear/dense.h"

namespace holomorph::mesh {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double kFarthest = 0.01;  // an image may be from the surface, in square roots of the area
constexpr int kImages = 500;        // at most, that are looked at
constexpr double kBetter = 0.9;     // an earlier plane stays where a later one is not nearer than this part

struct Moments {
  double area = 0;
  Vector3d first = Vector3d::Zero();
  Matrix3d second = Matrix3d::Zero();
};

// Integrals of 1, x and x x^T over the area.
Moments moments(const Surface& surface) {
  Moments sum;
  for (const Triple& t : surface.triangles) {
    std::array<Vector3d, 3> p;
    for (int i = 0; i < 3; ++i) p[i] = Vector3d(surface.polygons.vertices[t[i]].data());
    const Vector3d total = p[0] + p[1] + p[2];
    const double area = (p[1] - p[0]).cross(p[2] - p[0]).norm() / 2;
    sum.area += area;
    sum.first += area / 3 * total;
    // The integral of x x^T over a triangle is area / 12 (s s^T + sum of p p^T), s the sum of its corners p.
    sum.second += area / 12 * (total * total.transpose());
    for (const Vector3d& corner : p) sum.second += area / 12 * (corner * corner.transpose());
  }
  return sum;
}

// The mean of the squared distances of images from the surface; infinite if one is farther than `farthest`.
double mean_square(const Surface& surface, const TriangleTree& tree, const MirrorPlane& plane, double farthest) {
  const auto& vertices = surface.polygons.vertices;
  const auto count = std::min<std::size_t>(kImages, vertices.size());
  const auto step = static_cast<double>(vertices.size()) / static_cast<double>(count);
  double sum = 0;
  for (std::size_t i = 0; i < count; ++i) {
    // Spread by the golden ratio, so that a surface that is not an image of its own is known after a few.
    const double part = std::fmod(static_cast<double>(i) * std::numbers::phi, 1.0);
    const auto v = std::min(vertices.size() - 1, static_cast<std::size_t>(part * step * static_cast<double>(count)));
    const double distance = tree.nearest(plane.image(Vector3d(vertices[v].data()))).second;
    if (distance > farthest) return INFINITY;
    sum += distance * distance;
  }
  return sum / static_cast<double>(count);
}

}  // namespace

std::optional<MirrorPlane> mirror_plane(const Surface& surface, const TriangleTree& tree) {
  const Moments sum = moments(surface);
  if (!(sum.area > 0)) return std::nullopt;
  const Vector3d centroid = sum.first / sum.area;
  const Matrix3d spread = sum.second / sum.area - centroid * centroid.transpose();
  Eigen::Matrix<double, 3, 6> axes;
  // A plane of symmetry goes through the centroid, across an axis of inertia. On a round shape those are arbitrary: the
  // axes of space are tried first.
  axes << Matrix3d::Identity(), linear::eigenvectors(spread);
  std::optional<MirrorPlane> best;
  double least = INFINITY;
  for (const auto& axis : axes.colwise()) {
    const MirrorPlane plane{centroid, axis};
    const double distance = mean_square(surface, tree, plane, kFarthest * std::sqrt(sum.area));
    if (!(distance < kBetter * least)) continue;
    best = plane;
    least = distance;
  }
  return best;
}

}  // namespace holomorph::mesh
