#include "forms/third_kind.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "forms/closed_forms.h"
#include "linear/dense.h"
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

using mesh::edge_of;
using mesh::HalfedgeHandle;
using mesh::HalfEdges;
using mesh::next;
using mesh::opposite;
using mesh::to_vertex;

// Calls each(a, h) for every half-edge h that leaves a vertex a of a link.
template <class Each>
void leaving_links(const HalfEdges& half_edges, const std::vector<mesh::Star>& stars, const Each& each) {
  for (const mesh::Star& star : stars) {
    for (const HalfedgeHandle link : star.link) {
      HalfedgeHandle h = link;
      do {
        each(mesh::from_vertex(half_edges, link), h);
        h = next(half_edges, opposite(h));
      } while (h != link);
    }
  }
}

// -d^T (k d f) over the faces outside the stars, f supported on the links: #V x m.
Eigen::MatrixXd codifferential_of_links(const HalfEdges& half_edges, const PoleForms& poles,
                                        const Eigen::SparseMatrix<double>& f) {
  const RowMajorMatrix values = f * poles.residues;
  Eigen::MatrixXd B = Eigen::MatrixXd::Zero(values.rows(), values.cols());
  leaving_links(half_edges, poles.stars, [&](int a, HalfedgeHandle h) {
    // f is 0 off the links, so h contributes by f(a) alone. An edge between two link vertices is visited from both.
    const double k = poles.outer_weights[edge_of(h)];
    B.row(a) -= k * values.row(a);
    B.row(to_vertex(half_edges, h)) += k * values.row(a);
  });
  return B;
}

// The right-hand sides, u in the first m columns, v in the others.
Eigen::MatrixXd right_hand_sides(const HalfEdges& half_edges, const PoleForms& poles, Workers& workers) {
  const auto m = poles.residues.cols();
  Eigen::MatrixXd B(poles.part.u.rows(), 2 * m);
  // The equations of third_kind.h. Classes continue u_s from pole to pole; v_s is single-valued and needs none.
  B.leftCols(m) = poles.part.b_u * poles.residues + codifferential_of_links(half_edges, poles, poles.part.u) +
                  codifferentials(half_edges, poles.outer_weights, poles.classes, workers);
  B.rightCols(m) = poles.part.b_v * poles.residues + codifferential_of_links(half_edges, poles, poles.part.v);
  return B;
}

// The fluxes that the right-hand sides are made of, m columns of u, then of v, each with the coefficients `of_u`,
// `of_v`.
FluxTerms pole_terms(const HalfEdges& half_edges, const PoleForms& poles, const Eigen::MatrixXd& of_u,
                     const Eigen::MatrixXd& of_v) {
  const Eigen::MatrixXd r_u = poles.residues * of_u, r_v = poles.residues * of_v;
  FluxTerms terms = function_terms(half_edges, poles.part.u * r_u + poles.part.v * r_v);
  terms.outer_eta = [of_links = std::move(terms.eta), of_classes = class_terms(poles.classes, of_u).eta](
                        HalfedgeHandle h, Eigen::VectorXd& values) {
    of_links(h, values);
    of_classes(h, values);
  };
  terms.eta = {};
  terms.outer_weights = poles.outer_weights;
  terms.sources = poles.part.b_u * r_u + poles.part.b_v * r_v;
  return terms;
}

// Largest |B - L X| at a vertex over the largest sum of the terms; the rows of v at fixed vertices are not equations.
double relative_residual(const HalfEdges& half_edges, std::span<const double> weights, const Eigen::MatrixXd& B,
                         const RowMajorMatrix& X, const std::vector<int>& fixed) {
  RowMajorMatrix rest = B, size = B.cwiseAbs();
  for (int e = 0; e < static_cast<int>(weights.size()); ++e) {
    const int head = to_vertex(half_edges, HalfedgeHandle(2 * e)),
              tail = to_vertex(half_edges, HalfedgeHandle(2 * e + 1));
    for (Eigen::Index j = 0; j < X.cols(); ++j) {
      const double flux = weights[e] * (X(head, j) - X(tail, j));
      rest(head, j) -= flux;
      rest(tail, j) += flux;
      size(head, j) += std::abs(flux);
      size(tail, j) += std::abs(flux);
    }
  }
  for (const int v : fixed) rest.row(v).tail(rest.cols() / 2).setZero();
  return (rest.cwiseAbs().colwise().maxCoeff().array() / size.colwise().maxCoeff().array()).maxCoeff();
}

// n x 1: values of the first n forms.
Eigen::VectorXd along(const HalfEdges& half_edges, const ClosedForms& forms, Eigen::Index n, HalfedgeHandle h) {
  const int e = edge_of(h);
  return mesh::sign(h) * edge_values(half_edges, forms, e, e + 1).row(0).head(n).transpose();
}

// n x m: b_u . (values of h_j measured from the pole).
Eigen::MatrixXd flux_products(const HalfEdges& half_edges, const PoleForms& poles, const ClosedForms& harmonic,
                              Eigen::Index n) {
  const RowMajorMatrix b_u = poles.part.b_u * poles.residues;
  Eigen::MatrixXd products = Eigen::MatrixXd::Zero(n, b_u.cols());
  for (const mesh::Star& star : poles.stars) {
    for (const HalfedgeHandle h : star.link)
      products += along(half_edges, harmonic, n, opposite(next(half_edges, h))) * b_u.row(to_vertex(half_edges, h));
  }
  return products;
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

Eigen::MatrixXd pole_residues(Eigen::Index stars, bool closed) {
  Eigen::MatrixXd residues = Eigen::MatrixXd::Identity(stars, closed ? stars - 1 : stars);
  if (closed) residues.bottomRows(1).setConstant(-1);
  return residues;
}

PoleFunctions pole_functions(const HalfEdges& half_edges, std::span<const double> weights, const PoleForms& poles,
                             RefinedSolver& solver, const std::vector<int>& fixed, Execution& execution) {
  const auto m = poles.residues.cols();
  const Eigen::MatrixXd B = right_hand_sides(half_edges, poles, execution.workers());
  std::vector<solver::Condition> conditions(2 * m, solver::Condition::natural);
  if (!fixed.empty()) std::fill(conditions.begin() + m, conditions.end(), solver::Condition::dirichlet);
  const Eigen::MatrixXd identity = Eigen::MatrixXd::Identity(2 * m, 2 * m);
  const RowMajorMatrix X = solver.solve(
      B, conditions, [&] { return pole_terms(half_edges, poles, identity.topRows(m), identity.bottomRows(m)); },
      execution);
  return {X.leftCols(m) + poles.part.u * poles.residues, X.rightCols(m) + poles.part.v * poles.residues,
          relative_residual(half_edges, weights, B, X, fixed)};
}

RowMajorMatrix function_with_poles(const HalfEdges& half_edges, std::span<const double> weights, const PoleForms& poles,
                                   const topology::IntegerForms& natural, const Eigen::VectorXcd& p,
                                   const Eigen::VectorXcd& r, RefinedSolver& solver, Execution& execution) {
  Eigen::MatrixXd periods(p.size(), 2), of_u(r.size(), 2), of_v(r.size(), 2);
  periods << p.real(), p.imag();
  // (Re r + i Im r)(u + i v): the real part is Re r u - Im r v, the imaginary part Im r u + Re r v.
  of_u << r.real(), r.imag();
  of_v << -r.imag(), r.real();
  Workers& workers = execution.workers();
  const Eigen::MatrixXd all = right_hand_sides(half_edges, poles, workers);
  Eigen::MatrixXd B = all.leftCols(r.size()) * of_u + all.rightCols(r.size()) * of_v;
  if (p.size() > 0) B += codifferentials(half_edges, weights, natural, periods, workers);
  const auto terms = [&] {
    FluxTerms both = pole_terms(half_edges, poles, of_u, of_v);
    if (p.size() > 0) both.eta = class_terms(natural, periods).eta;
    return both;
  };
  const RowMajorMatrix X = solver.solve(B, solver::Condition::natural, terms, execution);
  return X + poles.part.u * (poles.residues * of_u) + poles.part.v * (poles.residues * of_v);
}

Eigen::MatrixXd harmonic_part(const HalfEdges& half_edges, const PoleForms& poles, const ClosedForms& harmonic,
                              const Eigen::MatrixXd& gram_matrix) {
  const auto n = gram_matrix.rows();
  // <u_s, h_j> outside the stars has two parts: that of the classes, and that of d(u_s), which along h, leaving a, is
  // -u_s(a).
  Eigen::MatrixXd P = class_products(half_edges, poles.outer_weights, poles.classes, harmonic).leftCols(n).transpose();
  const RowMajorMatrix u = poles.part.u * poles.residues;
  leaving_links(half_edges, poles.stars, [&](int a, HalfedgeHandle h) {
    P -= poles.outer_weights[edge_of(h)] * along(half_edges, harmonic, n, h) * u.row(a);
  });
  return linear::Cholesky(gram_matrix).solve(Eigen::MatrixXd(P - flux_products(half_edges, poles, harmonic, n)));
}

Eigen::MatrixXd harmonic_part(const HalfEdges& half_edges, std::span<const double> weights, const PoleForms& poles,
                              const RowMajorMatrix& u, const ClosedForms& harmonic,
                              const Eigen::MatrixXd& gram_matrix) {
  const auto n = gram_matrix.rows();
  const RowMajorMatrix f = u - poles.part.u * poles.residues;
  Eigen::MatrixXd P = Eigen::MatrixXd::Zero(n, u.cols());
  for (int e = 0; e < static_cast<int>(weights.size()); ++e) {
    const HalfedgeHandle h(2 * e);
    const int head = to_vertex(half_edges, h), tail = mesh::from_vertex(half_edges, h);
    // Outside the stars the form is that of u, with its class. Inside, where u_s is subtracted, df alone counts.
    const double outer = poles.outer_weights[e], inner = weights[e] - outer;
    Eigen::RowVectorXd whole = u.row(head) - u.row(tail);
    for (const auto& [i, value] : poles.classes.rows[e]) whole[i] += value;
    P += along(half_edges, harmonic, n, h) * (outer * whole + inner * (f.row(head) - f.row(tail)));
  }
  return linear::Cholesky(gram_matrix).solve(Eigen::MatrixXd(P - flux_products(half_edges, poles, harmonic, n)));
}

}  // namespace holomorph::forms
