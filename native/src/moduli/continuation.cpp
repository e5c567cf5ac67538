#include "moduli/continuation.h"

#include <Eigen/LU>
#include <algorithm>
#include <numeric>

#include "base/chunks.h"
#include "linear/dense.h"

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

}  // namespace holomorph::moduli
