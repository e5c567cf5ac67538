// What a relief knows of vertices and corners, and of sharp edges: near these a surface is moved along both its sides,
// and from where on it is moved straight up.
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "mesh/surface.h"

namespace holomorph::tiles {

/// (3 #T) For corner i of triangle t, at 3 t + i, the lowest corner of those at its vertex that edges which are not
/// sharp join it to.
/// @param is_sharp #E
std::vector<int> corner_fans(const mesh::Surface& surface, const std::vector<char>& is_sharp);

/// The quantities at a vertex that are interpolated linearly on every triangle.
struct ReliefSite {
  Eigen::Vector3d position;
  Eigen::Vector3d normal;  ///< by which a height of 1 moves the surface, over the depth
  double share = 1;  ///< factor of the height; 0 at all vertices of triangles at poles, where UVs do not fit together
};

/// The normals at the corners of a triangle, each of the smooth part of the surface around it: across a sharp edge they
/// differ. Elsewhere they are those of the vertices.
using CornerNormals = std::array<Eigen::Vector3d, 3>;

/// What the corners of a triangle have of the smooth part around them.
struct SmoothCorners {
  CornerNormals normals;
  std::array<bool, 3> are_reflex{};  ///< it takes more than half of the vertex's surroundings
};

/// The vector by which both faces of an edge stay parallel to themselves. The normals differ at a sharp edge alone.
Eigen::Vector3d between_faces(const Eigen::Vector3d& one, const Eigen::Vector3d& other);

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
                           bool is_point);

  /// How far a point is from the edge.
  double distance(const Eigen::Vector3d& point) const;

  /// What is left of `aside` at a point. @param width of zones
  Eigen::Vector3d rest(const Eigen::Vector3d& point, double width) const;
};

/// The zones of the sites of a relief, while sides are halved. They are half a depth wide, and so are triangles there:
/// then all that leans lies within a depth of an edge.
class SharpZones {
 public:
  /// @param sites which grow with the zones, and outlive them
  SharpZones(const std::vector<ReliefSite>& sites, double depth)
      : sites_(sites), width_(depth / 2), zones_(sites.size()), is_sharp_(sites.size(), 0) {}

  /// Takes up what a triangle at a vertex says of it.
  void add_corner(int v, const Eigen::Vector3d& normal);

  /// Adds the zone of a new site in the middle of a side.
  void add_middle(const SharpZone& zone, int a, int b, bool is_sharp);

  /// The zone of a vertex on a smooth part of the surface with this normal there.
  SharpZone of(int v, const Eigen::Vector3d& normal, bool is_reflex) const;

  /// That of the middle of a side, to whose ends two others belong: the nearest edge counts.
  SharpZone between(const SharpZone& one, const SharpZone& other, int a, int b) const;

  Eigen::Vector3d rest(const SharpZone& zone, const Eigen::Vector3d& point) const { return zone.rest(point, width_); }

  /// How much too far a side goes across the zone of its end a: 0 for not at all, below 1.
  double excess(const SharpZone& zone, int a, int b) const;

 private:
  const std::vector<ReliefSite>& sites_;
  double width_;
  std::vector<SharpZone> zones_;  // #V; on a sharp edge `out` alone is used, for its direction
  std::vector<char> is_sharp_;    // #V
};

}  // namespace holomorph::tiles
