#include "forms/third_kind.h"

#include <algorithm>

#include "forms/closed_forms.h"
#include "linear/dense.h"

namespace holomorph::forms {
namespace {

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
