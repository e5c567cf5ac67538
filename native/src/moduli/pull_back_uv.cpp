#include "moduli/pull_back_uv.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "base/constants.h"
#include "base/workers.h"
#include "linear/dense.h"
#include "mesh/half_edges.h"
#include "mesh/stars.h"

namespace holomorph::moduli {

namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::Vector2d;
using Eigen::VectorXd;

constexpr int kSteps = 12;        // walks for one vertex, at most
constexpr double kGain = 0.99;    // a walk that leaves more of the residual is the last
constexpr double kStuck = 1.5;    // times a neighbour's residual: the walk of this vertex ended too early
constexpr double kFine = 1e-6;    // least residual, in units of a loop's integral, of a walk that is stuck
constexpr double kFreeing = 0.1;  // part of the work that freeing is, about

// Calls visit(h) with each half-edge that leaves the vertex, those of the boundary included.
template <class Visit>
void for_each_leaving(const mesh::HalfEdges& links, int vertex, const Visit& visit) {
  const auto first = links.halfedge_handle(mesh::VertexHandle(vertex));
  auto h = first;
  do {
    visit(h);
    h = mesh::next(links, mesh::opposite(h));
  } while (h != first);
}

// UVs of a surface, continued from one triangle over its neighbours.

// z -> turn z + shift
struct PlaneSimilarity {
  std::complex<double> turn = 1, shift = 0;

  std::complex<double> operator()(std::complex<double> z) const { return turn * z + shift; }
  std::complex<double> inverse(std::complex<double> z) const { return (z - shift) / turn; }
  PlaneSimilarity operator*(const PlaneSimilarity& first) const {
    return {turn * first.turn, turn * first.shift + shift};
  }
};

// Each triangle has a chart, its corners in the plane. From that of a first triangle they are continued, breadth
// first, across each edge by the similarity that brings its ends in both charts together.
class ContinuedCharts {
 public:
  using Corners = std::array<std::complex<double>, 3>;

  /// @param corners of each triangle. @pre the surface outlives this
  ContinuedCharts(const mesh::Surface& surface, std::vector<Corners> corners, Execution& execution);

  void begin(int triangle);

  /// A point of a triangle in the chart of the first one. @pre both are in one component
  std::complex<double> at(int triangle, const std::array<double, 3>& barycentric);

  /// Returns the similarity to that chart from the chart of the triangle in which the point lies, among the triangles
  /// visited.
  PlaneSimilarity chart_at(std::complex<double> z) const;

 private:
  struct Sheet {
    int triangle;
    PlaneSimilarity frame;
  };

  void add(int triangle, const PlaneSimilarity& frame);
  void grow();

  std::vector<Corners> corners_;
  mesh::HalfEdges links_;
  mesh::Sides sides_;
  std::vector<int> place_;  // #T in sheets_, -1: not visited
  std::vector<Sheet> sheets_;
  std::size_t next_ = 0;
};

using Corners = ContinuedCharts::Corners;

/// The one that takes an edge to another; a translation where one of them is a point.
PlaneSimilarity between(Complex begin, Complex end, Complex to_begin, Complex to_end) {
  if (begin == to_begin && end == to_end) return {};
  const Complex turn = (to_end - to_begin) / (end - begin);
  if (!std::isnormal(std::norm(turn))) return {1, to_begin - begin};
  return {turn, to_begin - turn * begin};
}

double cross(Complex a, Complex b) { return a.real() * b.imag() - a.imag() * b.real(); }

/// The least barycentric coordinate of a point.
double depth(const std::array<Complex, 3>& corner, Complex z) {
  const double area = cross(corner[1] - corner[0], corner[2] - corner[0]);
  double least = INFINITY;
  for (int i = 0; i < 3; ++i) {
    const Complex a = corner[i], b = corner[(i + 1) % 3];
    least = std::min(least, cross(b - a, z - a) / area);
  }
  return std::isfinite(least) ? least : -INFINITY;
}

ContinuedCharts::ContinuedCharts(const mesh::Surface& surface, std::vector<Corners> corners, Execution& execution)
    : corners_(std::move(corners)),
      links_(mesh::half_edges(surface, execution)),
      sides_(surface),
      place_(surface.triangles.size(), -1) {}

void ContinuedCharts::begin(int triangle) {
  for (const Sheet& sheet : sheets_) place_[sheet.triangle] = -1;
  sheets_.clear();
  next_ = 0;
  add(triangle, {});
}

Complex ContinuedCharts::at(int triangle, const std::array<double, 3>& barycentric) {
  while (place_[triangle] < 0) grow();
  Complex sum = 0;
  for (int i = 0; i < 3; ++i) sum += barycentric[i] * corners_[triangle][i];
  return sheets_[place_[triangle]].frame(sum);
}

PlaneSimilarity ContinuedCharts::chart_at(Complex z) const {
  PlaneSimilarity frame;
  double most = -INFINITY;
  for (const Sheet& sheet : sheets_) {
    const double inside = depth(corners_[sheet.triangle], sheet.frame.inverse(z));
    if (inside > most) {
      most = inside;
      frame = sheet.frame;
    }
  }
  return frame;
}

void ContinuedCharts::add(int triangle, const PlaneSimilarity& frame) {
  place_[triangle] = static_cast<int>(sheets_.size());
  sheets_.push_back({triangle, frame});
}

// The neighbours of the first triangle whose neighbours have not been looked at.
void ContinuedCharts::grow() {
  const auto [triangle, frame] = sheets_[next_++];
  const Corners& here = corners_[triangle];
  for (int i = 0; i < 3; ++i) {
    const auto across = mesh::opposite(sides_(triangle, i));
    const int other = mesh::face_of(links_, across);
    if (other < 0 || place_[other] >= 0) continue;
    int j = 0;
    while (sides_(other, j) != across) ++j;
    const Corners& there = corners_[other];
    add(other, frame * between(there[(j + 1) % 3], there[j], here[i], here[(i + 1) % 3]));
  }
}

// p and q with to = p from + q conj(from) + constant.
std::pair<Complex, Complex> derivatives(const Corners& from, const Corners& to) {
  const Complex a = from[1] - from[0], b = from[2] - from[0], c = to[1] - to[0], d = to[2] - to[0];
  const Complex determinant = a * std::conj(b) - b * std::conj(a);
  return {(c * std::conj(b) - d * std::conj(a)) / determinant, (a * d - b * c) / determinant};
}

}  // namespace

MatrixXd slopes(const FormSurface& side, Execution& execution) {
  const mesh::Surface& surface = side.surface;
  const mesh::Sides sides(surface);
  const auto count = static_cast<int>(surface.triangles.size());
  MatrixXd result(side.forms.rows(), 2 * count);
  for_rows(execution.workers(), count, [&](int t) {
    const auto corner = mesh::corners(surface, t);
    const auto along = [&](int i) -> VectorXd {
      const auto h = sides(t, i);
      return mesh::sign(h) * side.forms.col(mesh::edge_of(h));
    };
    Eigen::Matrix2d frame;
    frame << corner[1].real(), corner[2].real(), corner[1].imag(), corner[2].imag();
    auto slope = result.middleCols<2>(2 * t);
    // Sides 0 and 2, both seen from corner 0: the values of the forms on them over their places give the slopes.
    slope << along(0), -along(2);
    slope = (slope * frame.inverse()).eval();
  });
  return result;
}

Continuation::Continuation(const FormSurface& from, const FormSurface& to, Execution& execution)
    : from_(from),
      to_(to),
      from_links_(mesh::half_edges(from.surface, execution)),
      to_links_(mesh::half_edges(to.surface, execution)),
      to_sides_(to.surface),
      slopes_(slopes(to, execution)) {}

ConformalImages Continuation::run(const MapStart& start, std::size_t most_vertices, Execution& execution) const {
  const auto count = static_cast<std::size_t>(from_.surface.vertex_count);
  most_vertices = std::min(most_vertices, count);
  ConformalImages images;
  images.residuals.resize(start.residual.size(), static_cast<Index>(most_vertices));
  std::vector<char> is_reached(count, 0);
  const auto take = [&](int vertex, mesh::SurfacePoint point, const VectorXd& residual) {
    is_reached[vertex] = 1;
    const auto place = static_cast<Index>(images.vertices.size());
    images.residuals.col(place) = residual;
    follow(point, images.residuals.col(place));
    images.vertices.push_back(vertex);
    images.points.push_back(point);
  };
  execution.stage("following the forms", 0, 1 - kFreeing);
  take(start.vertex, start.image, start.residual);
  for (std::size_t i = 0; i < images.vertices.size(); ++i) {
    execution.report(static_cast<double>(i) / static_cast<double>(most_vertices));
    for_each_leaving(from_links_, images.vertices[i], [&](mesh::HalfedgeHandle h) {
      const int vertex = mesh::to_vertex(from_links_, h);
      if (is_reached[vertex] || images.vertices.size() == most_vertices) return;
      // Along an edge the integrals of the forms grow by its values. The image of the new vertex starts at that of the
      // old one, and walks until its integrals have grown alike.
      const VectorXd step = mesh::sign(h) * from_.forms.col(mesh::edge_of(h));
      take(vertex, images.points[i], images.residuals.col(static_cast<Index>(i)) + step);
    });
  }
  execution.stage("freeing stuck points", 1 - kFreeing, 1);
  free_stuck(images, execution);
  return images;
}

void Continuation::free_stuck(ConformalImages& images, Execution& execution) const {
  std::vector<Index> place(from_.surface.vertex_count, -1);
  for (std::size_t i = 0; i < images.vertices.size(); ++i) place[images.vertices[i]] = static_cast<Index>(i);
  std::vector<Index> queue(images.vertices.size());
  std::iota(queue.begin(), queue.end(), Index{0});
  // Each success lowers a norm by a factor, so that this ends.
  while (!queue.empty()) {
    const auto left = static_cast<double>(queue.size()) / static_cast<double>(images.vertices.size());
    execution.report(1 - std::min(1.0, left));
    const Index i = queue.back();
    queue.pop_back();
    for_each_leaving(from_links_, images.vertices[i], [&](mesh::HalfedgeHandle h) {
      const Index j = place[mesh::to_vertex(from_links_, h)];
      if (j < 0 || images.residuals.col(j).norm() <= std::max(kFine, kStuck * images.residuals.col(i).norm())) return;
      VectorXd residual = images.residuals.col(i) + mesh::sign(h) * from_.forms.col(mesh::edge_of(h));
      mesh::SurfacePoint point = images.points[i];
      follow(point, residual);
      if (kStuck * residual.norm() >= images.residuals.col(j).norm()) return;
      images.residuals.col(j) = residual;
      images.points[j] = point;
      queue.push_back(j);
    });
  }
}

void Continuation::follow(mesh::SurfacePoint& point, Eigen::Ref<VectorXd> residual) const {
  double left = residual.norm();
  for (int n = 0; n < kSteps; ++n) {
    const auto across = slope(point.triangle);
    // Gauss-Newton: the step in the plane of the triangle that reduces the residual most, in the sense of least
    // squares.
    const Vector2d step =
        linear::solve_symmetric(Eigen::Matrix2d(across.transpose() * across), Vector2d(across.transpose() * residual));
    for (const auto& [triangle, dz] : mesh::walk(to_.surface, to_links_, to_sides_, point, {step[0], step[1]}))
      residual -= slope(triangle) * Vector2d(dz.real(), dz.imag());
    const double now = residual.norm();
    if (now > kGain * left) return;
    left = now;
  }
}

std::vector<Complex> carried_uv(const mesh::Surface& from, const VertexImages& images, const mesh::Surface& to,
                                const std::vector<Complex>& uv, Execution& execution) {
  std::vector<ContinuedCharts::Corners> charts(to.triangles.size());
  std::transform(to.triangle_corners.begin(), to.triangle_corners.end(), charts.begin(), [&](const auto& corners) {
    return ContinuedCharts::Corners{uv[corners[0]], uv[corners[1]], uv[corners[2]]};
  });
  ContinuedCharts continued(to, std::move(charts), execution);
  const auto& [vertices, corner_vertices, face_offsets, file] = from.polygons;
  std::vector<Complex> carried(corner_vertices.size());
  for (std::size_t f = 0; f + 1 < face_offsets.size(); ++f) {
    execution.report(static_cast<double>(f) / static_cast<double>(face_offsets.size()));
    const auto begin = carried.begin() + face_offsets[f], end = carried.begin() + face_offsets[f + 1];
    continued.begin(images.triangles[corner_vertices[face_offsets[f]]]);
    std::transform(corner_vertices.begin() + face_offsets[f], corner_vertices.begin() + face_offsets[f + 1], begin,
                   [&](int v) { return continued.at(images.triangles[v], images.barycentric[v]); });
    // The polygon, in one piece over seams of the map, goes into the chart that lies under its middle.
    Complex middle = 0;
    for (auto z = begin; z != end; ++z) middle += *z / static_cast<double>(end - begin);
    const PlaneSimilarity chart = continued.chart_at(middle);
    std::transform(begin, end, begin, [&](Complex z) { return chart.inverse(z); });
  }
  return carried;
}

MapDerivatives map_derivatives(const mesh::Surface& from, const VertexImages& images, const mesh::Surface& to, int sign,
                               Execution& execution) {
  std::vector<Corners> charts;
  const auto count = static_cast<int>(from.triangles.size());
  for (int t = 0; t < static_cast<int>(to.triangles.size()); ++t) charts.push_back(mesh::corners(to, t));
  ContinuedCharts unfolded(to, std::move(charts), execution);
  MapDerivatives result{std::vector<Complex>(count), std::vector<Complex>(count)};
  for (int t = 0; t < count; ++t) {
    execution.report(static_cast<double>(t) / count);
    const Corners here = mesh::corners(from, t);
    // The unfolding depends on where it begins, as the surface is curved. Of three, the one with the least dilatation
    // is taken.
    for (int start = 0; start < 3; ++start) {
      unfolded.begin(images.triangles[from.triangles[t][start]]);
      Corners there;
      for (int i = 0; i < 3; ++i) {
        const int vertex = from.triangles[t][i];
        there[i] = unfolded.at(images.triangles[vertex], images.barycentric[vertex]);
      }
      auto [p, q] = derivatives(here, there);
      if (sign < 0) std::swap(p, q);
      if (start > 0 && !(std::abs(q) * std::abs(result.p[t]) < std::abs(result.q[t]) * std::abs(p))) continue;
      result.p[t] = p;
      result.q[t] = q;
    }
  }
  return result;
}

}  // namespace holomorph::moduli
