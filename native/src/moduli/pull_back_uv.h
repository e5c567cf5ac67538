// UVs and derivatives carried along a map of surfaces: pull-back.
#pragma once

#include <Eigen/Core>
#include <array>
#include <complex>
#include <vector>

#include "base/execution.h"
#include "forms/closed_forms.h"
#include "mesh/half_edges.h"
#include "mesh/stars.h"
#include "mesh/surface.h"

namespace holomorph::moduli {

// The conformal map between two surfaces whose integer classes correspond, found by continuation.

/// A surface and n closed forms on its edges, n x #E. They are L^-1 h for the Gram matrix L L^T of h, so that the sum
/// of the squares of their integrals does not depend on the basis.
struct FormSurface {
  const mesh::Surface& surface;
  const forms::RowMajorMatrix& forms;
};

/// Where the map begins: a vertex of the first surface, a point of the second, and how far their integrals are apart.
struct MapStart {
  int vertex = 0;
  mesh::SurfacePoint image;
  Eigen::VectorXd residual;
};

struct ConformalImages {
  std::vector<int> vertices;               ///< those reached, in the order of the continuation
  std::vector<mesh::SurfacePoint> points;  ///< their images
  Eigen::MatrixXd residuals;               ///< n x #vertices: integrals on the first surface minus those on the second
};

/// Returns the change of the integrals along x and y of each triangle t (mesh::corners), columns 2 t and 2 t + 1 of n x
/// 2 #T.
Eigen::MatrixXd slopes(const FormSurface& side, Execution& execution);

/// Continues the map over the first surface. The integrals of corresponding forms from the start are the same at
/// corresponding points (Abel-Jacobi). It goes from vertex to vertex along the edges of the first surface, nearest
/// first. The image walks over the second surface until no direction brings its integrals nearer. The residuals that
/// remain show a wrong start, or forms that do not correspond.
/// @param most_vertices of the first surface that are mapped @throws Cancelled
/// Cost: O(#V n), and O(#T n) for the directions on the second surface.
class Continuation {
 public:
  Continuation(const FormSurface& from, const FormSurface& to, Execution& execution);

  ConformalImages run(const MapStart& start, std::size_t most_vertices, Execution& execution) const;

 private:
  auto slope(int triangle) const { return slopes_.middleCols<2>(2 * triangle); }
  void follow(mesh::SurfacePoint& point, Eigen::Ref<Eigen::VectorXd> residual) const;
  // Walks may end in a fold beside the right place: there they are made again from a neighbour that has found its own.
  void free_stuck(ConformalImages& images, Execution& execution) const;

  FormSurface from_, to_;
  mesh::HalfEdges from_links_, to_links_;
  mesh::Sides to_sides_;
  Eigen::MatrixXd slopes_;
};

/// Where a map takes the vertices of a surface of polygons: into triangles of another.
struct VertexImages {
  std::vector<int> triangles;                      ///< #V, -1 at isolated vertices
  std::vector<std::array<double, 3>> barycentric;  ///< #V
};

/// Pulls UVs at the corners of `to`, one for each polygon corner, back to the corners of `from`.
///
/// The UVs are continued from triangle to triangle over `to`. Across a cut, they are continued by the similarity that
/// brings the UVs on both sides of the edge together (a translation, for maps made of forms). All corners of a polygon
/// take the chart at its middle. So a texture that is continuous across a cut of `to` is continuous on `from`. Where it
/// breaks off, it breaks off along the nearest edges.
/// @pre every polygon's images are in one component of `to` @throws Cancelled
/// Cost: linear in both surfaces where polygons' images are small.
std::vector<std::complex<double>> carried_uv(const mesh::Surface& from, const VertexImages& images,
                                             const mesh::Surface& to, const std::vector<std::complex<double>>& uv,
                                             Execution& execution);

/// In each triangle of `from` the map is z -> p z + q conj(z), linear between the images of the corners. It is
/// conformal where q = 0, and folded where |q| > |p|. Each is laid out in its plane with the first side along the real
/// axis. The image is unfolded into the plane of a triangle of `to` that holds a corner's image.
struct MapDerivatives {
  std::vector<std::complex<double>> p, q;  ///< #T
};

/// @param sign -1 for a map that reverses the orientation: p and q are exchanged
/// Around a vertex whose angle is not 2 pi, unfolding depends on the way round. Of the planes of the three corners'
/// images, the one with the least |q / p| is taken.
/// @pre all images are in one component of `to` @throws Cancelled
/// Cost: linear in both surfaces where triangles' images are small.
MapDerivatives map_derivatives(const mesh::Surface& from, const VertexImages& images, const mesh::Surface& to, int sign,
                               Execution& execution);

}  // namespace holomorph::moduli
