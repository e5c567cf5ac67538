#include "pipeline/sphere_map.h"

#include <cmath>
#include <numbers>

#include "base/errors.h"
#include "mesh/triangle_geometry.h"

namespace holomorph::pipeline {
namespace {

// #V a third of the area of the faces around each vertex; nothing at the punctures, where no height is known.
Eigen::VectorXd vertex_areas(const PuncturedStructure& s) {
  Eigen::VectorXd areas = Eigen::VectorXd::Zero(s.at_vertex.size());
  const auto& length = s.surface.edge_lengths;
  for (std::size_t t = 0; t < s.surface.triangles.size(); ++t) {
    const auto [a, b, c] = s.surface.triangle_edges[t];
    const double area = mesh::triangle_area(length[a], length[b], length[c]);
    for (const int v : s.surface.triangles[t]) areas[v] += area / 3;
  }
  for (const mesh::Star& star : s.stars) areas[star.vertex] = 0;
  return areas;
}

// The shift for which the mean of tanh(x + shift) is 0: it grows with the shift, so halving finds it.
double balancing_shift(const Eigen::VectorXd& x, const Eigen::VectorXd& areas) {
  double low = -x.maxCoeff(), high = -x.minCoeff();
  for (double middle = (low + high) / 2; low < middle && middle < high; middle = (low + high) / 2)
    ((x.array() + middle).tanh().matrix().dot(areas) < 0 ? low : high) = middle;
  return (low + high) / 2;
}

}  // namespace

PointArray sphere_map(const PuncturedStructure& s) {
  if (!s.closed || s.handle_part.size() > 0 || s.stars.size() != 2) {
    throw TopologyError("only a closed surface of genus 0 with two punctures has a map to the sphere here");
  }
  // -log |z| = 2 pi v, and the height (1 - |z|^2) / (1 + |z|^2) is its hyperbolic tangent.
  const Eigen::VectorXcd angle = 2 * std::numbers::pi / s.punctures.residues[0] * s.at_vertex;
  const Eigen::VectorXd areas = vertex_areas(s), turn = angle.real();
  Eigen::VectorXd rise = angle.imag();
  for (const mesh::Star& star : s.stars) rise[star.vertex] = rise[mesh::to_vertex(s.half_edges, star.link[0])];
  rise.array() += balancing_shift(rise, areas);
  PointArray points(rise.size(), 3);
  const Eigen::ArrayXd radius = rise.array().cosh().inverse();
  points << radius * turn.array().cos(), radius * turn.array().sin(), rise.array().tanh();
  points.row(s.stars[0].vertex) << 0, 0, 1;
  points.row(s.stars[1].vertex) << 0, 0, -1;
  return points;
}

}  // namespace holomorph::pipeline
