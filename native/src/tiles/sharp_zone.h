// Near sharp edges, where a surface is moved along both its sides, and from where on it is moved straight up.
#pragma once

#include <Eigen/Core>
#include <algorithm>

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

}  // namespace holomorph::tiles
