#include "uv/density_objective.h"

#include <algorithm>
#include <complex>
#include <numeric>

#include "base/constants.h"
#include "linear/blas.h"
#include "mesh/triangle_geometry.h"
#include "mesh/triangle_tree.h"

namespace holomorph::uv {
namespace {

using Eigen::MatrixXcd;
using Eigen::MatrixXd;
using Eigen::VectorXcd;
using Eigen::VectorXd;

constexpr double kDistortion = 3;  // weight of the distortion against the variance

// A triangle in the plane: corner 0 at 0, corner 1 at a > 0, corner 2 at x + i y.
struct Placed {
  double a, x, y;

  Placed(const mesh::Surface& surface, int triangle) {
    const auto [side0, side1, side2] = surface.triangle_edges[triangle];
    a = surface.edge_lengths[side0];
    const double b = surface.edge_lengths[side1], c = surface.edge_lengths[side2];
    x = (a * a + (c - b) * (c + b)) / (2 * a);
    y = 2 * mesh::triangle_area(a, b, c) / a;
  }

  // h_x - i h_y of forms with the values h(e0), h(e1) on sides 0 and 1: h(e0) = a h_x, h(e0) + h(e1) = x h_x + y h_y
  template <class Row0, class Row1>
  Eigen::RowVectorXcd derivative(const Row0& on_side0, const Row1& on_side1) const {
    if (!(y > 0)) return Eigen::RowVectorXcd::Zero(on_side0.size());
    const Eigen::RowVectorXd h_x = on_side0 / a, h_y = (on_side0 + on_side1 - x * h_x) / y;
    return h_x.cast<Complex>() - Complex(0, 1) * h_y.cast<Complex>();
  }
};

// The triangles in an order that the numbering does not decide, where there are positions.
std::vector<int> in_order(const mesh::Surface& surface) {
  if (surface.intrinsic()) {
    std::vector<int> order(surface.triangles.size());
    std::iota(order.begin(), order.end(), 0);
    return order;
  }
  std::vector<std::array<double, 3>> centres(surface.triangles.size(), {0, 0, 0});
  for (std::size_t t = 0; t < centres.size(); ++t) {
    for (const int v : surface.triangles[t]) {
      for (int i = 0; i < 3; ++i) centres[t][i] += surface.polygons.vertices[v][i] / 3;
    }
  }
  return mesh::spatial_order(centres);
}

// The matrix that takes the unknowns to the parts, real parts above imaginary ones. Real products take half the time of
// complex ones.
MatrixXd on_unknowns(const MatrixXcd& parts, Coefficients kind) {
  const Eigen::Index rows = parts.rows(), g = parts.cols();
  MatrixXd result(2 * rows, kind == Coefficients::real ? g : 2 * g);
  result.leftCols(g) << parts.real(), parts.imag();
  if (kind == Coefficients::complex) result.rightCols(g) << -parts.imag(), parts.real();
  return result;
}

// |z|^2 of numbers whose real parts are above their imaginary ones.
Eigen::ArrayXd squares(const VectorXd& z) {
  const Eigen::Index rows = z.size() / 2;
  return z.head(rows).array().square() + z.tail(rows).array().square();
}

VectorXd weighted(const Eigen::ArrayXd& weights, const VectorXd& z) {
  VectorXd result(z.size());
  result << weights.matrix().cwiseProduct(z.head(weights.size())),
      weights.matrix().cwiseProduct(z.tail(weights.size()));
  return result;
}

}  // namespace

// Triangles at equal steps through the total area, along a curve through space where there are positions.
std::vector<int> sample_triangles(const mesh::Surface& surface, int most_per_triangle) {
  const std::vector<int> order = in_order(surface);
  std::vector<double> until;
  until.reserve(order.size());
  double total = 0;
  for (const int t : order) {
    const auto& s = surface.triangle_edges[t];
    total += mesh::triangle_area(surface.edge_lengths[s[0]], surface.edge_lengths[s[1]], surface.edge_lengths[s[2]]);
    until.push_back(total);
  }
  const auto count = static_cast<int>(std::min<std::size_t>(kSamples, most_per_triangle * order.size()));
  std::vector<int> samples;
  for (int i = 0; i < count; ++i) {
    const double at = total * (i + 0.5) / count;
    const auto found = std::lower_bound(until.begin(), until.end() - 1, at);
    samples.push_back(order[found - until.begin()]);
  }
  return samples;
}

forms::RowMajorMatrix values_on_sides(const mesh::Surface& surface, const mesh::Sides& sides,
                                      const forms::ClosedForms& forms, const std::vector<int>& triangles) {
  forms::RowMajorMatrix values(2 * static_cast<Eigen::Index>(triangles.size()), forms.functions.cols());
  Eigen::Index row = 0;
  for (const int t : triangles) {
    for (const int i : {0, 1}) {
      const mesh::HalfedgeHandle h = sides(t, i);
      values.row(row++) = mesh::sign(h) * forms::edge_values(surface, forms, mesh::edge_of(h), mesh::edge_of(h) + 1);
    }
  }
  return values;
}

// For a harmonic form h, A = (h_x - i h_y) / 2, and B = conj(A).
SampledParts sampled_parts(const mesh::Surface& surface, const FormSamples& samples, const MatrixXcd& basis) {
  MatrixXcd parts(static_cast<Eigen::Index>(samples.triangles.size()), samples.on_sides.cols());
  for (Eigen::Index s = 0; s < parts.rows(); ++s) {
    const Placed placed(surface, samples.triangles[s]);
    parts.row(s) = 0.5 * placed.derivative(samples.on_sides.row(2 * s), samples.on_sides.row(2 * s + 1));
  }
  // Both from the same four real products, which take half as long as two complex ones.
  const MatrixXd x = parts.real(), y = parts.imag(), u = basis.real(), v = basis.imag();
  const MatrixXd xu = x * u, xv = x * v, yu = y * u, yv = y * v;
  const Complex i(0, 1);
  return {(xu - yv) + i * (xv + yu), (xu + yv) + i * (xv - yu)};
}

// du + i dv = A dz with A = v_y + i v_x.
MatrixXcd parts_of_imaginary(const mesh::Surface& surface, const std::vector<int>& triangles,
                             const forms::RowMajorMatrix& v) {
  MatrixXcd parts(static_cast<Eigen::Index>(triangles.size()), v.cols());
  for (Eigen::Index s = 0; s < parts.rows(); ++s) {
    const auto [p, q, r] = surface.triangles[triangles[s]];
    const Placed placed(surface, triangles[s]);
    parts.row(s) = Complex(0, 1) * placed.derivative(v.row(q) - v.row(p), v.row(r) - v.row(q));
  }
  return parts;
}

VectorXcd as_complex(const VectorXd& x, Coefficients kind) {
  const auto g = kind == Coefficients::real ? x.size() : x.size() / 2;
  VectorXcd c = VectorXcd::Zero(g);
  c.real() = x.head(g);
  if (kind == Coefficients::complex) c.imag() = x.tail(g);
  return c;
}

VectorXd as_unknowns(const VectorXcd& c, Coefficients kind) {
  if (kind == Coefficients::real) return c.real();
  VectorXd x(2 * c.size());
  x << c.real(), c.imag();
  return x;
}

namespace {

// Variance over the samples of log(q / mean q + floor), q = |A|^2, plus 3 times the mean of
// r = |B|^2 / (|A|^2 + |B|^2 + floor mean q); and the gradient by (Re c, Im c). The second term is nearly 0 for a good
// map. Without it |A| may be even where B, the discretisation error, is larger and flips the map.
class DensityObjective {
 public:
  DensityObjective(const SampledParts& parts, Coefficients kind);
  void set_floor(double floor) { floor_ = floor; }
  double operator()(const Eigen::VectorXd& x, Eigen::VectorXd& gradient) const;

 private:
  Eigen::VectorXd parts(const Eigen::MatrixXd& M, const Eigen::VectorXd& x) const;
  Eigen::VectorXd transposed(const Eigen::MatrixXd& M, const Eigen::VectorXd& w) const;

  // Real parts of A and B above imaginary ones, of each unknown; where these are many, of the coefficients alone.
  Eigen::MatrixXd M_, N_;
  bool are_many_;
  Eigen::Index columns_;  // of the unknowns, a row for each coefficient: real and imaginary parts
  double floor_ = 0;
};

DensityObjective::DensityObjective(const SampledParts& parts, Coefficients kind)
    : M_(on_unknowns(parts.M, kind)),
      N_(on_unknowns(parts.N, kind)),
      are_many_(parts.M.cols() > linear::kSmall),
      columns_(kind == Coefficients::complex ? 2 : 1) {
  if (!are_many_) return;
  // (P + iQ) (x + iy) from [P; Q] [x, y]: half of what is read from memory.
  M_ = M_.leftCols(parts.M.cols()).eval();
  N_ = N_.leftCols(parts.N.cols()).eval();
}

VectorXd DensityObjective::parts(const MatrixXd& M, const VectorXd& x) const {
  if (!are_many_) return M * x;
  const Eigen::Index half = M.rows() / 2;
  const MatrixXd products = linear::thin_product(M, Eigen::Map<const MatrixXd>(x.data(), M.cols(), columns_));
  VectorXd result = products.col(0);
  if (columns_ == 1) return result;
  result.head(half) -= products.col(1).tail(half);
  result.tail(half) += products.col(1).head(half);
  return result;
}

VectorXd DensityObjective::transposed(const MatrixXd& M, const VectorXd& w) const {
  if (!are_many_) return M.transpose() * w;
  const Eigen::Index half = M.rows() / 2;
  MatrixXd both(M.rows(), columns_);
  both.col(0) = w;
  if (columns_ == 2) both.col(1) << w.tail(half), -w.head(half);
  return linear::thin_transposed_product(M, both).reshaped();
}

double DensityObjective::operator()(const VectorXd& x, VectorXd& gradient) const {
  const VectorXd A = parts(M_, x);
  const Eigen::ArrayXd q = squares(A);
  const double mean = q.mean(), count = static_cast<double>(q.size());
  // The floor keeps the logarithm finite at zeros of the form, where q = 0. Divided by the mean, q is independent of
  // the scale of the form.
  const Eigen::ArrayXd y = (q / mean + floor_).log(), deviation = y - y.mean();
  const Eigen::ArrayXd inverse = 1 / (q + floor_ * mean);
  // Derivatives by q and b of each sample, and through the mean, which is the same for all samples.
  double value = deviation.square().mean(), through_mean = -2 * (deviation * q * inverse).mean() / mean;
  Eigen::ArrayXd by_q = 2 * deviation * inverse;
  gradient.setZero(x.size());
  if (N_.rows() > 0) {
    const VectorXd B = parts(N_, x);
    const Eigen::ArrayXd b = squares(B), sum = 1 / (q + b + floor_ * mean), r = b * sum;
    // r = b / (q + b + floor mean): its derivatives by q, by b, and through the mean.
    value += kDistortion * r.mean();
    through_mean -= kDistortion * floor_ * (r * sum).mean();
    by_q -= kDistortion * r * sum;
    const Eigen::ArrayXd by_b = kDistortion * (1 - r) * sum / count;
    gradient += 2 * transposed(N_, weighted(by_b, B));
  }
  by_q = (by_q + through_mean) / count;
  gradient += 2 * transposed(M_, weighted(by_q, A));
  return value;
}

}  // namespace

double descend(const SampledParts& parts, Coefficients kind, VectorXd& x, const std::vector<double>& floors,
               int most_steps, const std::function<void()>& tick) {
  double variance = INFINITY;
  DensityObjective objective(parts, kind);
  for (const double floor : floors) {
    objective.set_floor(floor);
    variance = minimise(
        [&](const VectorXd& at, VectorXd& gradient) {
          tick();
          return objective(at, gradient);
        },
        x, {.most_steps = most_steps});
    x.normalize();  // the variance does not depend on the scale
  }
  return variance;
}

}  // namespace holomorph::uv
