#include "tiles/sharp_zones.h"

#include <algorithm>
#include <cmath>

#include "mesh/union_find.h"

namespace holomorph::tiles {
namespace {

bool differ(const Eigen::Vector3d& one, const Eigen::Vector3d& other) {
  constexpr double rounding = 1e-9;
  return (one - other).norm() > rounding * one.norm();
}

}  // namespace

std::vector<int> corner_fans(const mesh::Surface& surface, const std::vector<char>& is_sharp) {
  const int count = static_cast<int>(surface.triangles.size());
  mesh::UnionFind fans(3 * surface.triangles.size());
  std::vector<int> first(surface.edges.size(), -1);  // 3 t + i of the first side at each edge
  for (int s = 0; s < 3 * count; ++s) {
    const auto corner = [&](int of, int step) { return of / 3 * 3 + (of % 3 + step) % 3; };
    int& other = first[surface.triangle_edges[s / 3][s % 3]];
    if (other != -1 && !is_sharp[surface.triangle_edges[s / 3][s % 3]]) {
      fans.join(corner(s, 0), corner(other, 1));
      fans.join(corner(s, 1), corner(other, 0));
    }
    other = s;
  }
  std::vector<int> result(3 * surface.triangles.size());
  for (int s = 0; s < 3 * count; ++s) result[s] = fans.lowest(s);
  return result;
}

Eigen::Vector3d between_faces(const Eigen::Vector3d& one, const Eigen::Vector3d& other) {
  constexpr double least = 0.25;  // at sharper edges the vector is shorter
  const Eigen::Vector3d mean = (one + other) / 2, unit = (one.normalized() + other.normalized()) / 2;
  return one == other ? mean : Eigen::Vector3d(mean / std::max(unit.squaredNorm(), least));
}

SharpZone SharpZone::at_edge(const Eigen::Vector3d& aside, const Eigen::Vector3d& origin, const Eigen::Vector3d& along,
                             bool is_point) {
  return {aside, origin, (aside - along * along.dot(aside)).normalized(), is_point};
}

double SharpZone::distance(const Eigen::Vector3d& point) const {
  const Eigen::Vector3d side = point - origin;
  return is_point ? side.norm() : std::max(-out.dot(side), 0.0);
}

Eigen::Vector3d SharpZone::rest(const Eigen::Vector3d& point, double width) const {
  return is_empty() ? aside : Eigen::Vector3d(aside * std::max(1 - distance(point) / width, 0.0));
}

void SharpZones::add_corner(int v, const Eigen::Vector3d& normal) {
  if (differ(sites_[v].normal, normal)) is_sharp_[v] = 1;
}

void SharpZones::add_middle(const SharpZone& zone, int a, int b, bool is_sharp) {
  zones_.push_back(zone);
  is_sharp_.push_back(is_sharp ? 1 : 0);
  if (is_sharp) zones_.back().out = (sites_[b].position - sites_[a].position).normalized();
}

SharpZone SharpZones::of(int v, const Eigen::Vector3d& normal, bool is_reflex) const {
  if (!is_sharp_[v]) return zones_[v];
  if (!differ(sites_[v].normal, normal)) return {};
  return SharpZone::at_edge(sites_[v].normal - normal, sites_[v].position, zones_[v].out, is_reflex);
}

SharpZone SharpZones::between(const SharpZone& one, const SharpZone& other, int a, int b) const {
  const Eigen::Vector3d middle = (sites_[a].position + sites_[b].position) / 2;
  const auto away = [&](const SharpZone& zone) { return zone.is_empty() ? width_ : zone.distance(middle); };
  if (std::min(away(one), away(other)) >= width_) return {};
  return away(one) <= away(other) ? one : other;
}

double SharpZones::excess(const SharpZone& zone, int a, int b) const {
  if (zone.is_empty()) return 0;
  const double across = std::abs(zone.distance(sites_[b].position) - zone.distance(sites_[a].position));
  return across > width_ ? 1 - width_ / across : 0;
}

}  // namespace holomorph::tiles
