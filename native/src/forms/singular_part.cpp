#include "forms/singular_part.h"

#include <array>
#include <cmath>

#include "mesh/triangle_geometry.h"

namespace holomorph::forms {
namespace {

using mesh::edge_of;
using mesh::HalfedgeHandle;
using mesh::HalfEdges;
using mesh::next;
using mesh::opposite;

// A triangle (p, a, b) of a star, seen from p. The line ab has the distance `height` from p. The coordinate t along it
// is 0 at the foot of p, t0 at a and t1 at b.
struct StarTriangle {
  int a, b;
  double angle, length, height, t0, t1;
  double log_a, log_b;  // logarithms of the lengths of the spokes, relative to their mean

  StarTriangle(const HalfEdges& half_edges, std::span<const double> lengths, HalfedgeHandle link, double angle_at_p,
               double unit)
      : a(mesh::from_vertex(half_edges, link)), b(mesh::to_vertex(half_edges, link)), angle(angle_at_p) {
    const HalfedgeHandle from_b = next(half_edges, link), to_a = next(half_edges, from_b);
    length = lengths[edge_of(link)];
    const double at_a = lengths[edge_of(to_a)], at_b = lengths[edge_of(from_b)];
    height = 2 * mesh::triangle_area(length, at_a, at_b) / length;
    // The law of cosines. The product keeps the digits of nearly equal spokes.
    t0 = -((at_a - at_b) * (at_a + at_b) + length * length) / (2 * length);
    t1 = t0 + length;
    log_a = std::log(at_a / unit);
    log_b = std::log(at_b / unit);
  }

  double log_ratio() const { return log_b - log_a; }
  // int alpha' phi_b and int (t / r^2) phi_b along the edge, phi_b = (t - t0) / length
  double flux_of_log() const { return (height * log_ratio() - t0 * angle) / length; }
  double flux_of_angle() const { return (length - height * angle - t0 * log_ratio()) / length; }
  // int of log r, and of alpha seen from the foot, minus the linear interpolants
  double excess_of_log() const {
    return t1 * log_b - t0 * log_a - length + height * angle - length * (log_a + log_b) / 2;
  }
  double excess_of_angle() const {
    const auto integral = [this](double t) {
      return t * std::atan(t / height) - height / 2 * std::log(height * height + t * t);
    };
    return integral(t1) - integral(t0) - length * (std::atan(t0 / height) + std::atan(t1 / height)) / 2;
  }
};

// The unit of r. It adds a constant to v_s on the star, which g takes away again. Logarithms near 0 keep their digits.
double mean_spoke(const HalfEdges& half_edges, std::span<const double> lengths, const mesh::Star& star) {
  double sum = 0;
  for (const HalfedgeHandle h : star.link) sum += lengths[edge_of(next(half_edges, h))];
  return sum / static_cast<double>(star.size());
}

using Triplets = std::vector<Eigen::Triplet<double>>;

Eigen::SparseMatrix<double> assembled(const HalfEdges& half_edges, std::size_t columns, const Triplets& entries) {
  Eigen::SparseMatrix<double> result(static_cast<Eigen::Index>(half_edges.n_vertices()),
                                     static_cast<Eigen::Index>(columns));
  result.setFromTriplets(entries.begin(), entries.end());
  return result;
}

}  // namespace

StarPart star_part(const HalfEdges& half_edges, std::span<const double> lengths, const mesh::Star& star) {
  const double scale = 1 / star.total_angle, unit = mean_spoke(half_edges, lengths, star);
  const std::size_t count = star.size();
  StarPart part{std::vector<double>(count), std::vector<double>(count), std::vector<double>(count),
                std::vector<double>(count)};
  double alpha = -star.angles[0];  // 0 at the end of link[0]
  for (std::size_t j = 0; j < count; ++j) {
    const StarTriangle t(half_edges, lengths, star.link[j], star.angles[j], unit);
    alpha += t.angle;
    part.u[j] = alpha * scale;
    part.v[j] = -t.log_b * scale;
    // `flux` is shared between the hat functions of a and b. `excess` is tested with the normal derivatives of the
    // three hat functions, which sum to 0: at_p, at_b, and what remains for a.
    const std::size_t at_a = (j + count - 1) % count;
    const double at_b = -t.t0 / t.length / t.height, at_p = -1 / t.height;
    const auto add = [&](double flux_b, double flux, double excess, std::vector<double>& b, double& b_at_pole) {
      b_at_pole += scale * at_p * excess;
      b[at_a] += scale * (flux - flux_b - (at_p + at_b) * excess);
      b[j] += scale * (flux_b + at_b * excess);
    };
    add(t.flux_of_log(), t.angle, -t.excess_of_log(), part.b_v, part.b_v_at_pole);
    add(t.flux_of_angle(), t.log_ratio(), t.excess_of_angle(), part.b_u, part.b_u_at_pole);
  }
  return part;
}

SingularPart singular_part(const HalfEdges& half_edges, std::span<const double> lengths,
                           const std::vector<mesh::Star>& stars) {
  Triplets u, v, b_u, b_v;
  for (int i = 0; i < static_cast<int>(stars.size()); ++i) {
    const mesh::Star& star = stars[i];
    const StarPart part = star_part(half_edges, lengths, star);
    b_u.emplace_back(star.vertex, i, part.b_u_at_pole);
    b_v.emplace_back(star.vertex, i, part.b_v_at_pole);
    for (std::size_t j = 0; j < star.size(); ++j) {
      const int b = mesh::to_vertex(half_edges, star.link[j]);
      u.emplace_back(b, i, part.u[j]);
      v.emplace_back(b, i, part.v[j]);
      b_u.emplace_back(b, i, part.b_u[j]);
      b_v.emplace_back(b, i, part.b_v[j]);
    }
  }
  const auto matrix = [&](const Triplets& entries) { return assembled(half_edges, stars.size(), entries); };
  return {matrix(u), matrix(v), matrix(b_u), matrix(b_v)};
}

Array<double> outer_weights(const HalfEdges& half_edges, std::span<const double> lengths, Array<double> weights,
                            const std::vector<mesh::Star>& stars) {
  for (const mesh::Star& star : stars) {
    for (const HalfedgeHandle h : star.link) {
      // Both faces of a spoke are in the star. A link edge keeps its outer face.
      weights[edge_of(next(half_edges, h))] = 0;
      const HalfedgeHandle outer = opposite(h), outer1 = next(half_edges, outer), outer2 = next(half_edges, outer1);
      const double a = lengths[edge_of(outer)], b = lengths[edge_of(outer1)], c = lengths[edge_of(outer2)];
      weights[edge_of(h)] = 0.5 * mesh::cotangent(a, b, c, mesh::triangle_area(a, b, c));
    }
  }
  return weights;
}

}  // namespace holomorph::forms
