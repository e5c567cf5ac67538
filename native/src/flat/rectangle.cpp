#include "flat/rectangle.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <utility>

#include "base/errors.h"
#include "flat/dirichlet_problem.h"
#include "forms/certain_bounds.h"
#include "linear/dense.h"
#include "mesh/components.h"
#include "mesh/delaunay.h"
#include "mesh/half_edges.h"
#include "mesh/triangle_geometry.h"
#include "structure/certified_forms.h"
#include "uv/uv_map.h"

namespace holomorph::flat {
namespace {

using Turns = std::vector<double>;
using mesh::HalfedgeHandle;
using mesh::Labels;

// The vertices of the boundary, the surface on its left, from the lowest.
std::vector<int> around(const mesh::HalfEdges& half_edges, const mesh::BoundaryLoops& boundary) {
  std::vector<int> vertices;
  for (const HalfedgeHandle h : boundary.loops[0]) vertices.push_back(mesh::from_vertex(half_edges, h));
  // boundary_loops() has the hole on the left.
  std::reverse(vertices.begin() + 1, vertices.end());
  return vertices;
}

mesh::BoundaryLoops checked_boundary(const mesh::Surface& surface, const mesh::HalfEdges& half_edges) {
  auto boundary = mesh::boundary_loops(surface, half_edges);
  const auto type = mesh::topological_type(surface);
  if (type.genus == 0 && type.boundary_count == 1) return boundary;
  throw TopologyError("the surface has " + type.text() + "; rectangle corners need a disk");
}

// @param place #V index of each vertex in the loop, -1 for others
void check_corners(const std::vector<int>& corners, const std::vector<int>& place, const Labels& label) {
  if (corners.size() != 4)
    throw TopologyError("there are " + std::to_string(corners.size()) + " rectangle corners; four are needed");
  for (const int v : corners) {
    if (v < 0 || v >= static_cast<int>(place.size()))
      throw TopologyError("rectangle corner " + std::to_string(v) + " is not a vertex: there are " +
                          std::to_string(place.size()));
    if (std::count(corners.begin(), corners.end(), v) > 1)
      throw TopologyError("rectangle corner " + label(v) + " is given twice");
    if (place[v] < 0) throw TopologyError("rectangle corner " + label(v) + " does not lie on the boundary");
  }
}

FourSides sides_between(const std::vector<int>& loop, const std::vector<int>& corners, int vertex_count,
                        const Labels& label) {
  const int n = static_cast<int>(loop.size());
  std::vector<int> place(vertex_count, -1);
  for (int i = 0; i < n; ++i) place[loop[i]] = i;
  check_corners(corners, place, label);
  // Steps along the boundary from corner 0: corners in order have ascending ones.
  const auto steps = [&](int v) { return (place[v] - place[corners[0]] + n) % n; };
  std::vector<int> ordered(corners);
  std::sort(ordered.begin(), ordered.end(), [&](int a, int b) { return steps(a) < steps(b); });
  if (ordered != corners) {
    std::string order;
    for (const int v : ordered) order += (order.empty() ? "" : ", ") + label(v);
    throw TopologyError(
        "the rectangle corners are not in the order of the boundary, the surface on its left: that is " + order);
  }
  FourSides result;
  for (int i = 0; i < 4; ++i) {
    const int end = i < 3 ? steps(corners[i + 1]) : n;
    for (int s = steps(corners[i]); s <= end; ++s) result[i].push_back(loop[(place[corners[0]] + s) % n]);
  }
  return result;
}

// Least turn of a corner, in radians: between that of a square and that of an octagon.
constexpr double kCorner = std::numbers::pi / 4;

// Least turn of a mean direction: between those of a square, rounded to a fifth of its side, and of a blob.
constexpr double kMeanCorner = std::numbers::pi / 3;

// Parts of the boundary's length over which directions are averaged. Corners of a square are a fourth apart.
constexpr std::array<double, 5> kParts = {1.0 / 256, 1.0 / 128, 1.0 / 64, 1.0 / 32, 1.0 / 16};

// The boundary, the surface on its left, from the lowest vertex.
struct BorderLoop {
  std::vector<int> vertices;
  std::vector<double> lengths;  // lengths of the edges that leave each vertex
};

BorderLoop border_of(const mesh::Surface& surface, Execution& execution) {
  const auto half_edges = mesh::half_edges(surface, execution);
  const auto boundary = mesh::boundary_loops(surface, half_edges);
  BorderLoop result;
  for (const HalfedgeHandle h : boundary.loops[0]) {  // the hole on its left
    result.vertices.push_back(mesh::from_vertex(half_edges, h));
    result.lengths.push_back(surface.edge_lengths[mesh::edge_of(h)]);
  }
  std::reverse(result.vertices.begin() + 1, result.vertices.end());
  std::reverse(result.lengths.begin(), result.lengths.end());
  return result;
}

Turns exterior_angles(const mesh::Surface& surface, const BorderLoop& border) {
  std::vector<double> angle(surface.vertex_count, std::numbers::pi);
  for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
    for (int i = 0; i < 3; ++i) {
      const auto length = [&](int side) { return surface.edge_lengths[surface.triangle_edges[t][(i + side) % 3]]; };
      const double a = length(1), b = length(2), c = length(0);  // a opposite corner i
      angle[surface.triangles[t][i]] -= std::atan2(4 * mesh::triangle_area(a, b, c), (b - a) * (b + a) + c * c);
    }
  }
  Turns result;
  for (const int v : border.vertices) result.push_back(angle[v]);
  return result;
}

// The integral, along three rounds of the border, of its direction, which jumps by `turns` at the vertices. With three
// rounds, intervals may reach across the start on both sides.
class DirectionIntegral {
 public:
  DirectionIntegral(const std::vector<double>& lengths, const Turns& turns) {
    double direction = 0;
    for (std::size_t i = 0; i < 3 * turns.size(); ++i) {
      direction += turns[i % turns.size()];
      directions_.push_back(direction);
      places_.push_back(places_.back() + lengths[i % turns.size()]);
      integrals_.push_back(integrals_.back() + direction * lengths[i % turns.size()]);
    }
  }

  double place(std::size_t vertex) const { return places_[vertex]; }

  double at(double place) const {
    const auto after = std::upper_bound(places_.begin() + 1, places_.end() - 1, place) - places_.begin();
    return integrals_[after - 1] + directions_[after - 1] * (place - places_[after - 1]);
  }

 private:
  std::vector<double> places_{0}, integrals_{0}, directions_;
};

// Returns for each vertex the mean direction over `part` of the border's length after it, less the mean before it.
Turns mean_turns(const std::vector<double>& lengths, const Turns& turns, double part) {
  const DirectionIntegral integral(lengths, turns);
  const std::size_t n = turns.size();
  const double width = part * integral.place(n);
  Turns result;
  for (std::size_t i = n; i < 2 * n; ++i) {
    const double here = integral.place(i);
    // Both means at once: the second difference of the integral.
    result.push_back((integral.at(here + width) - 2 * integral.at(here) + integral.at(here - width)) / width);
  }
  return result;
}

// The vertices of the four stretches that turn by more than `kCorner`, where mean and own turn are largest together:
// the mean finds the place, the own turn the vertex. Empty where there are not four, or one turns too little, or back.
std::vector<int> four_corners(const Turns& means, const Turns& own) {
  const int n = static_cast<int>(means.size());
  const auto is_corner = [&](int i) { return means[i % n] > kCorner; };
  // A turn back: the border is not a rectangle.
  if (*std::min_element(means.begin(), means.end()) < -kCorner) return {};
  int start = 0;
  // Begins between corners, so that no stretch is cut in two.
  while (start < n && is_corner(start)) ++start;
  if (start == n) return {};
  std::vector<int> result;
  for (int i = start; i < start + n; ++i) {
    if (!is_corner(i)) continue;
    int best = i;
    double peak = 0;
    for (; is_corner(i); ++i) {
      peak = std::max(peak, means[i % n]);
      if (means[i % n] + own[i % n] > means[best % n] + own[best % n]) best = i;
    }
    if (peak < kMeanCorner || result.size() == 4) return {};
    result.push_back(best % n);
  }
  if (result.size() != 4) return {};
  std::sort(result.begin(), result.end());
  return result;
}

std::vector<int> sharp_corners(const Turns& turns) {
  std::vector<int> result;
  for (int i = 0; i < static_cast<int>(turns.size()); ++i) {
    if (std::abs(turns[i]) <= kCorner) continue;
    if (turns[i] < 0 || result.size() == 4) return {};
    result.push_back(i);
  }
  return result.size() == 4 ? result : std::vector<int>{};
}

std::vector<int> mean_corners(const std::vector<double>& lengths, const Turns& turns, const Turns& own) {
  for (const double part : kParts) {
    auto result = four_corners(mean_turns(lengths, turns, part), own);
    if (!result.empty()) return result;
  }
  return {};
}

// The edges of the border in the plane that is nearest to its vertices, seen so that it runs counter-clockwise.
std::vector<std::complex<double>> shadow(const mesh::Surface& surface, const BorderLoop& border) {
  const Eigen::Index n = static_cast<Eigen::Index>(border.vertices.size());
  Eigen::Matrix3Xd points(3, n);
  for (Eigen::Index i = 0; i < n; ++i)
    points.col(i) = Eigen::Map<const Eigen::Vector3d>(surface.polygons.vertices[border.vertices[i]].data());
  points.colwise() -= points.rowwise().mean().eval();
  points /= std::max(points.cwiseAbs().maxCoeff(), mesh::kSmallest);  // so that squares do not overflow
  // Eigenvectors ascend by eigenvalue: the first is the normal of the least-squares plane.
  const Eigen::Matrix3d axes = linear::eigenvectors(points * points.transpose());
  const Eigen::Matrix2Xd flat = axes.rightCols<2>().transpose() * points;
  std::vector<std::complex<double>> edges;
  double area = 0;
  for (Eigen::Index i = 0; i < n; ++i) {
    const Eigen::Vector2d a = flat.col(i), b = flat.col((i + 1) % n);
    area += a.x() * b.y() - a.y() * b.x();
    edges.emplace_back(b.x() - a.x(), b.y() - a.y());
  }
  if (area < 0) std::transform(edges.begin(), edges.end(), edges.begin(), [](auto z) { return std::conj(z); });
  return edges;
}

// Corners of the shadow at which the surface itself also turns.
std::vector<int> shadow_corners(const mesh::Surface& surface, const BorderLoop& border, const Turns& own) {
  const auto edges = shadow(surface, border);
  std::vector<double> lengths;
  Turns turns;
  std::complex<double> before = edges.back();
  for (const std::complex<double>& edge : edges) {
    lengths.push_back(std::abs(edge));
    turns.push_back(std::arg(edge * std::conj(before)));
    if (lengths.back() > 0) before = edge;  // one that is upright has no direction
  }
  const auto corners = mean_corners(lengths, turns, own);
  const Turns of_surface = mean_turns(border.lengths, own, kParts.back());
  const bool turns_too = std::all_of(corners.begin(), corners.end(), [&](int i) { return of_surface[i] > kCorner; });
  return turns_too ? corners : std::vector<int>{};
}

// u: 0 on side 3, 1 on side 1; v: 0 on side 0, 1 on side 2. Each has conditions, and so a system, of its own.
struct Coordinates {
  DirichletSolution u, v;
  double harmonicity() const { return std::max(u.harmonicity, v.harmonicity); }
};

Coordinates coordinates(const mesh::Discretisation& discretisation, const FourSides& sides, const Options& options,
                        double from, double to, Execution& execution) {
  const auto& [half_edges, lengths, weights, errors, metric_error, mollification, flips] = discretisation;
  const auto one = [&](int zero_side, int one_side) {
    std::vector<int> fixed = sides[zero_side];
    fixed.insert(fixed.end(), sides[one_side].begin(), sides[one_side].end());
    Eigen::MatrixXd f = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(half_edges.n_vertices()), 1);
    for (const int v : sides[one_side]) f(v, 0) = 1;
    return solve_dirichlet(discretisation, fixed, f, options, execution);
  };
  execution.stage("width", from, (from + to) / 2);
  Coordinates result{one(3, 1), {}};
  execution.stage("height", (from + to) / 2, to);
  result.v = one(0, 2);
  return result;
}

// Energies of u and of v that are certainly not below those of the surface, 1 x 1 each.
std::vector<Eigen::MatrixXd> certain_energies(const mesh::Discretisation& discretisation,
                                              const Coordinates& coordinates, Execution& execution) {
  topology::IntegerForms no_classes;
  no_classes.rows.resize(discretisation.weights.size());
  std::vector<Eigen::MatrixXd> result;
  for (const DirichletSolution* f : {&coordinates.u, &coordinates.v}) {
    const forms::RowMajorMatrix functions = f->functions;
    result.push_back(structure::certain_energies(discretisation, {no_classes, functions}, {1}, execution).certain[0]);
  }
  return result;
}

}  // namespace

FourSides rectangle_sides(const mesh::Surface& surface, const mesh::HalfEdges& half_edges,
                          const std::vector<int>& corners, const std::vector<int>& labels) {
  const auto boundary = checked_boundary(surface, half_edges);
  return sides_between(around(half_edges, boundary), corners, surface.vertex_count, Labels(labels));
}

std::vector<int> collapsed_triangles(const mesh::Surface& surface, const FourSides& sides) {
  std::vector<int> on(surface.vertex_count, 0);  // a bit for each side
  for (int i = 0; i < 4; ++i) {
    for (const int v : sides[i]) on[v] |= 1 << i;
  }
  std::vector<int> result;
  for (int t = 0; t < static_cast<int>(surface.triangles.size()); ++t) {
    const auto& [a, b, c] = surface.triangles[t];
    if (on[a] & on[b] & on[c]) result.push_back(t);
  }
  return result;
}

int boundary_length(const mesh::Surface& surface, Execution& execution) {
  return static_cast<int>(mesh::boundary_loops(surface, mesh::half_edges(surface, execution)).loops[0].size());
}

std::vector<int> quarter_corners(const mesh::Surface& surface, Execution& execution) {
  const auto half_edges = mesh::half_edges(surface, execution);
  const auto boundary = mesh::boundary_loops(surface, half_edges);
  const auto& loop = boundary.loops[0];  // the hole on its left: reversed at the end
  const int n = static_cast<int>(loop.size());
  if (n < 4) throw TopologyError("the boundary has three edges; four are needed for four corners");
  std::vector<double> until(n, 0.0);  // length from the first vertex to each
  for (int i = 1; i < n; ++i) until[i] = until[i - 1] + surface.edge_lengths[mesh::edge_of(loop[i - 1])];
  const double total = until.back() + surface.edge_lengths[mesh::edge_of(loop.back())];
  std::vector<int> corners;
  for (int k = 0, at = 0; k < 4; ++k, ++at) {
    // On to the vertex nearest to k quarters of the length. The corners still to come need a vertex each.
    while (at < n - (4 - k) && std::abs(until[at + 1] - k * total / 4) < std::abs(until[at] - k * total / 4)) ++at;
    corners.push_back(mesh::from_vertex(half_edges, loop[at]));
  }
  std::reverse(corners.begin() + 1, corners.end());
  return corners;
}

std::optional<std::vector<int>> clear_corners(const mesh::Surface& surface, Execution& execution) {
  const BorderLoop border = border_of(surface, execution);
  const Turns turns = exterior_angles(surface, border);
  std::vector<int> corners = sharp_corners(turns);
  if (corners.empty()) corners = mean_corners(border.lengths, turns, turns);
  if (corners.empty() && !surface.intrinsic()) corners = shadow_corners(surface, border, turns);
  if (corners.empty()) return {};
  for (int& corner : corners) corner = border.vertices[corner];
  return corners;
}

PlaneMap rectangle_map(const mesh::Surface& surface, const std::vector<int>& corners, const std::vector<int>& labels,
                       const Options& options, Execution& execution) {
  PlaneMap result;
  execution.stage("half-edges", 0.0, 0.1);
  auto half_edges = mesh::half_edges(surface, execution);
  const FourSides sides = rectangle_sides(surface, half_edges, corners, labels);
  result.corners = corners;
  result.collapsed_triangles = collapsed_triangles(surface, sides);

  execution.stage("intrinsic Delaunay", 0.1, 0.2);
  const auto delaunay = mesh::on_delaunay(surface, half_edges.copy(execution.workers()), execution);
  result.flip_count = static_cast<int>(delaunay.flips.size());
  result.mollification = delaunay.mollification;
  const bool flipped = result.flip_count > 0;
  const Coordinates sharp = coordinates(delaunay, sides, options, 0.2, flipped ? 0.6 : 1.0, execution);
  const auto certain = certain_energies(delaunay, sharp, execution);
  // The geometric mean of the bounds 1 / E(v) and E(u).
  result.modulus = std::sqrt(sharp.u.energies[0] * (1 / sharp.v.energies[0]));
  result.metric = delaunay.metric_error;
  // 1 / E(v) <= m <= E(u) by Dirichlet's principle: u is admissible for the modulus, and v for its inverse.
  const Eigen::MatrixXd lower = forms::below_inverse(certain[1]);
  if (result.mollification == 0) structure::require_ordered(lower, certain[0]);
  result.lower = lower(0, 0);
  result.upper = certain[0](0, 0);

  // Invariants come from the Delaunay triangulation, points from the triangles that are drawn (docs/method/surface.md).
  const Coordinates drawn = flipped ? coordinates(mesh::on_input(surface, std::move(half_edges), execution), sides,
                                                  options, 0.6, 1.0, execution)
                                    : sharp;
  result.points.resize(surface.vertex_count);
  result.points.real() = drawn.u.functions.col(0);
  result.points.imag() = result.modulus * drawn.v.functions.col(0);
  require_finite(result.points, "vertex", execution.workers());
  result.harmonicity = std::max(sharp.harmonicity(), drawn.harmonicity());
  result.solver = sharp.v.solver.residual > sharp.u.solver.residual ? sharp.v.solver : sharp.u.solver;
  execution.finish();
  result.seconds = execution.seconds();
  return result;
}

}  // namespace holomorph::flat
