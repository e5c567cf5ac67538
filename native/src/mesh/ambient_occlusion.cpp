#include "mesh/ambient_occlusion.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/chunks.h"
#include "base/execution.h"

namespace holomorph::mesh {
namespace {

using Eigen::Vector3d;

constexpr int kRays = 128;         // over the whole sphere, of which half are above a vertex
constexpr double kLowest = 0.1;    // least cosine with the normal: lower rays meet the faces around the vertex
constexpr double kRay = 1000;      // operations, about
constexpr double kBegin = 0.0025;  // height above the vertex where rays begin, in square roots of the area

// Direction i of a Fibonacci lattice on the sphere, nearly evenly spread.
Vector3d direction(int i) {
  const double z = 1 - (2 * i + 1.0) / kRays, radius = std::sqrt(1 - z * z);
  const double angle = 2 * std::numbers::pi * std::numbers::phi * i;
  return {radius * std::cos(angle), radius * std::sin(angle), z};
}

}  // namespace

AmbientOcclusion::AmbientOcclusion(const Surface& surface, const std::optional<std::array<double, 3>>& up)
    : surface_(surface), tree_(surface), normals_(surface.vertex_count, Vector3d::Zero()), weights_(kRays, 1) {
  for (int i = 0; up && i < kRays; ++i)
    weights_[i] = std::clamp(0.5 + direction(i).dot(Vector3d(up->data())), 0.0, 1.0);
  double area = 0;
  for (const Triple& t : surface.triangles) {
    std::array<Vector3d, 3> p;
    for (int i = 0; i < 3; ++i) p[i] = Vector3d(surface.polygons.vertices[t[i]].data());
    const Vector3d normal = (p[1] - p[0]).cross(p[2] - p[0]) / 2;
    area += normal.norm();
    for (const int v : t) normals_[v] += normal;
  }
  for (Vector3d& normal : normals_) normal = normal.stableNormalized();
  begin_ = kBegin * std::sqrt(area);
}

void AmbientOcclusion::prepare(const std::vector<int>& vertices, Workers& workers) {
  std::vector<int> missing;
  for (const int v : vertices) {
    if (known_.emplace(v, 0).second) missing.push_back(v);
  }
  Execution::count(kRay * kRays / 2 * static_cast<double>(missing.size()));
  std::vector<double> values(missing.size());
  run_throwing(workers, static_cast<int>(missing.size()), [&](int i) { values[i] = found(missing[i]); });
  for (std::size_t i = 0; i < missing.size(); ++i) known_[missing[i]] = values[i];
}

double AmbientOcclusion::found(int vertex) const {
  const Vector3d& normal = normals_[vertex];
  const Vector3d start = Vector3d(surface_.polygons.vertices[vertex].data()) + begin_ * normal;
  double all = 0, open = 0;
  for (int i = 0; i < kRays; ++i) {
    const Vector3d ray = direction(i);
    const double cosine = ray.dot(normal);
    if (cosine < kLowest) continue;
    all += cosine;
    if (weights_[i] > 0 && !tree_.meets(start, ray, 0)) open += weights_[i] * cosine;
  }
  return all > 0 ? open / all : 1;
}

}  // namespace holomorph::mesh
