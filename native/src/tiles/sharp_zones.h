// Near sharp edges, where a surface is moved along both its sides, and from where on it is moved straight up.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <vector>

#include "tiles/relief_sites.h"

namespace holomorph::tiles {

/// The vector by which both faces of an edge stay parallel to themselves. The normals differ at a sharp edge alone.
inline Eigen::Vector3d between_faces(const Eigen::Vector3d& one, const Eigen::Vector3d& other) {
  constexpr double least = 0.25;  // at sharper edges the vector is shorter
  const Eigen::Vector3d mean = (one + other) / 2, unit = (one.normalized() + other.normalized()) / 2;
  return one == other ? mean : Eigen::Vector3d(mean / std::max(unit.squaredNorm(), least));
}

/// What a point of a surface has of the nearest sharp edge. At the edge the vector by which the surface is moved
/// differs from that of the smooth part beside it by `aside`. From there on that gets less, in proportion to the
/// distance.
struct SharpZone {
  Eigen::Vector3d aside = Eigen::Vector3d::Zero();   ///< 0 for a point beyond all zones
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();  ///< a point of the edge
  Eigen::Vector3d out = Eigen::Vector3d::Zero();     ///< unit vector across the edge, out of the smooth part
  bool is_point = false;                             ///< the edge turns back there: the point alone counts

  bool is_empty() const { return aside.isZero(0); }

  /// @param along direction of the edge; 0 where it is that across `aside`
  static SharpZone at_edge(const Eigen::Vector3d& aside, const Eigen::Vector3d& origin, const Eigen::Vector3d& along,
                           bool is_point) {
    return {aside, origin, (aside - along * along.dot(aside)).normalized(), is_point};
  }

  /// How far a point is from the edge.
  double distance(const Eigen::Vector3d& point) const {
    const Eigen::Vector3d side = point - origin;
    return is_point ? side.norm() : std::max(-out.dot(side), 0.0);
  }

  /// What is left of `aside` at a point. @param width of zones
  Eigen::Vector3d rest(const Eigen::Vector3d& point, double width) const {
    return is_empty() ? aside : Eigen::Vector3d(aside * std::max(1 - distance(point) / width, 0.0));
  }
};

/// The zones of the sites of a relief, while sides are halved. They are half a depth wide, and so are triangles there:
/// then all that leans lies within a depth of an edge.
class SharpZones {
 public:
  /// @param sites which grow with the zones, and outlive them
  SharpZones(const std::vector<ReliefSite>& sites, double depth)
      : sites_(sites), width_(depth / 2), zones_(sites.size()), is_sharp_(sites.size(), 0) {}

  /// Takes up what a triangle at a vertex says of it.
  void add_corner(int v, const Eigen::Vector3d& normal) {
    if (differ(sites_[v].normal, normal)) is_sharp_[v] = 1;
  }

  /// Adds the zone of a new site in the middle of a side.
  void add_middle(const SharpZone& zone, int a, int b, bool is_sharp) {
    zones_.push_back(zone);
    is_sharp_.push_back(is_sharp ? 1 : 0);
    if (is_sharp) zones_.back().out = (sites_[b].position - sites_[a].position).normalized();
  }

  /// The zone of a vertex on a smooth part of the surface with this normal there.
  SharpZone of(int v, const Eigen::Vector3d& normal, bool is_reflex) const {
    if (!is_sharp_[v]) return zones_[v];
    if (!differ(sites_[v].normal, normal)) return {};
    return SharpZone::at_edge(sites_[v].normal - normal, sites_[v].position, zones_[v].out, is_reflex);
  }

  /// That of the middle of a side, to whose ends two others belong: the nearest edge counts.
  SharpZone between(const SharpZone& one, const SharpZone& other, int a, int b) const {
    const Eigen::Vector3d middle = (sites_[a].position + sites_[b].position) / 2;
    const auto away = [&](const SharpZone& zone) { return zone.is_empty() ? width_ : zone.distance(middle); };
    if (std::min(away(one), away(other)) >= width_) return {};
    return away(one) <= away(other) ? one : other;
  }

  Eigen::Vector3d rest(const SharpZone& zone, const Eigen::Vector3d& point) const { return zone.rest(point, width_); }

  /// How much too far a side goes across the zone of its end a: 0 for not at all, below 1.
  double excess(const SharpZone& zone, int a, int b) const {
    if (zone.is_empty()) return 0;
    const double across = std::abs(zone.distance(sites_[b].position) - zone.distance(sites_[a].position));
    return across > width_ ? 1 - width_ / across : 0;
  }

 private:
  static bool differ(const Eigen::Vector3d& one, const Eigen::Vector3d& other) {
    constexpr double rounding = 1e-9;
    return (one - other).norm() > rounding * one.norm();
  }

  const std::vector<ReliefSite>& sites_;
  double width_;
  std::vector<SharpZone> zones_;  // #V; on a sharp edge `out` alone is used, for its direction
  std::vector<char> is_sharp_;    // #V
};

}  // namespace holomorph::tiles
