#include "uv/balance.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <random>

#include "base/constants.h"
#include "base/errors.h"
#include "base/task_progress.h"
#include "linear/dense.h"
#include "uv/appearance.h"

namespace holomorph::uv {

namespace {

using Eigen::Index;
using Eigen::Matrix3Xd;
using Eigen::MatrixXcd;
using Eigen::Vector3d;

Vector3d position(const mesh::Surface& surface, int triangle, int corner) {
  const auto& p = surface.polygons.vertices[surface.triangles[triangle][corner]];
  return {p[0], p[1], p[2]};
}

// The triangles' centres, in the box of them all from -1 to 1.
Matrix3Xd centres(const mesh::Surface& surface, const std::vector<int>& triangles) {
  Matrix3Xd result(3, static_cast<Index>(triangles.size()));
  for (Index s = 0; s < result.cols(); ++s) {
    const int t = triangles[s];
    result.col(s) = (position(surface, t, 0) + position(surface, t, 1) + position(surface, t, 2)) / 3;
  }
  const Vector3d low = result.rowwise().minCoeff(), high = result.rowwise().maxCoeff();
  const double half = (high - low).maxCoeff() / 2;
  return (result.colwise() - (low + high) / 2) / std::max(half, std::numeric_limits<double>::min());
}

// A constant along each axis, a rotation about each, and from then on waves.
Matrix3Xd field(const Matrix3Xd& at, int which, std::mt19937_64& numbers) {
  const Vector3d axis = Vector3d::Unit(which % 3);
  if (which < 3) return axis.replicate(1, at.cols());
  if (which < 6) return at.colwise().cross(axis);
  // One number in [-1, 1) from each draw: the standard's distributions differ between libraries.
  const auto vector = [&] {
    Vector3d v;
    for (double& x : v) x = static_cast<double>(numbers() >> 11) * 0x1p-52 - 1.0;
    return v;
  };
  const Vector3d a = vector(), b = vector(), wave = 3 * vector();
  const Eigen::RowVectorXd phase = wave.transpose() * at;
  return a * phase.array().cos().matrix() + b * phase.array().sin().matrix();
}

// Returns A with |A| = 1, #triangles x count, whose gradient of u runs along smooth fields in space. The fields are
// fixed relative to the bounding box, so they do not depend on the surface's numbering. @pre the surface has positions
MatrixXcd even_fields(const mesh::Surface& surface, const std::vector<int>& triangles, int count) {
  const MatrixXcd frames = tangent_frames(surface, triangles);
  const Matrix3Xd at = centres(surface, triangles);
  MatrixXcd result(frames.cols(), count);
  std::mt19937_64 numbers(1);
  for (int i = 0; i < count; ++i) {
    const Matrix3Xd direction = field(at, i, numbers);
    // The field's components in the frame: A (e_x + i e_y) has the gradient of u along its tangential part.
    const Eigen::ArrayXcd A = frames.conjugate().cwiseProduct(direction.cast<Complex>()).colwise().sum().transpose();
    result.col(i) = A / (A.abs() + std::numeric_limits<double>::min());
  }
  return result;
}

}  // namespace

MatrixXcd tangent_frames(const mesh::Surface& surface, const std::vector<int>& triangles) {
  MatrixXcd result(3, static_cast<Index>(triangles.size()));
  for (Index s = 0; s < result.cols(); ++s) {
    const Vector3d origin = position(surface, triangles[s], 0);
    const Vector3d x = (position(surface, triangles[s], 1) - origin).stableNormalized();
    const Vector3d along2 = position(surface, triangles[s], 2) - origin;
    const Vector3d y = (along2 - along2.dot(x) * x).stableNormalized();
    result.col(s) = x.cast<Complex>() + Complex(0, 1) * y.cast<Complex>();
  }
  return result;
}

namespace {

using Eigen::Index;
using Eigen::MatrixXcd;
using Eigen::VectorXcd;
using Eigen::VectorXd;

// The floor under the density is lowered step by step, first from fixed starts on every kThinning-th sample, then from
// the best of their ends on all samples.
constexpr int kStarts = 16, kThinning = 4, kRoughSteps = 40, kKept = 6, kFineSteps = 100;
// From this many forms on, the numbers of starts and of steps fall in inverse proportion, as the cost of each grows
// faster.
constexpr int kManyForms = 64, kFewestSteps = 20;
constexpr double kUsualValues = 1000;     // evaluations of the objective in all descents
constexpr double kBalanceOperations = 4;  // for each entry of a matrix
// The judgement adds to the logarithm of the 95 % over 5 % quantile: the mean of s1 / s2, cut off here, and a price of
// flipped triangles.
constexpr double kMostSheared = 20;
constexpr double kSame = 1e-3;  // relative difference of the ends of two descents that are one
const std::vector<double> kRoughFloors = {1.0, 0.1}, kFineFloors = {0.01, 1e-3, kDensityFloor};

struct Candidate {
  double value;
  VectorXd x;
};

bool lower(const Candidate& a, const Candidate& b) { return a.value < b.value; }

// Columns orthonormal in the mean over the samples: the descent then does not depend on the basis that the forms were
// given in. @return #coefficients x #coefficients, real for real ones
MatrixXcd orthonormal(const MatrixXcd& M, Coefficients kind) {
  const Index n = M.cols();
  MatrixXcd gram = M.adjoint() * M / static_cast<double>(M.rows());
  if (kind == Coefficients::real) gram = gram.real().cast<Complex>().eval();
  // Keeps the matrix definite where forms are dependent on the samples.
  gram += 1e-14 * gram.diagonal().real().maxCoeff() * MatrixXcd::Identity(n, n);
  return linear::Cholesky(gram).inverse_upper();
}

// What a finished map is judged by, the less the better: the variance may be small and the map flipped.
double judgement(const SampledParts& parts, const VectorXcd& c) {
  Eigen::ArrayXd q = (parts.M * c).cwiseAbs2().array();
  double price = 0;
  if (parts.N.rows() > 0) {
    const Eigen::ArrayXd a = q.sqrt(), b = (parts.N * c).cwiseAbs().array();
    const double tiny = std::numeric_limits<double>::min();
    // s1 = |A| + |B| and s2 = | |A| - |B| |: their quotient, and below their product.
    price = ((a + b) / ((a - b).abs() + tiny)).min(kMostSheared).mean() + kFlipped * (b >= a).cast<double>().mean();
    q = (q - b.square()).abs() + kDensityFloor * q.mean() + tiny;
  }
  std::sort(q.begin(), q.end());
  return price + std::log(q[q.size() * 19 / 20] / q[q.size() / 20]);
}

// The best of the ends of the descents with each floor, the first from x.
Candidate finished(const SampledParts& parts, Coefficients kind, VectorXd x, int steps,
                   const std::function<void()>& tick) {
  Candidate best{INFINITY, {}};
  for (const double floor : kFineFloors) {
    descend(parts, kind, x, {floor}, steps, tick);
    const double value = judgement(parts, as_complex(x, kind));
    if (value < best.value) best = {value, x};
  }
  return best;
}

// Returns the forms nearest to given fields. Beyond these, as on intrinsic surfaces, come fixed pseudo-random forms.
std::vector<Candidate> starts(const MatrixXcd& M, const MatrixXcd& fields, Coefficients kind, int count) {
  const auto unknowns = (kind == Coefficients::real ? 1 : 2) * M.cols();
  std::vector<Candidate> list(count, {INFINITY, VectorXd(unknowns)});
  std::mt19937_64 numbers(1);  // fixed: the same surface gives the same coefficients
  for (int i = 0; i < count; ++i) {
    if (i < fields.cols()) {
      list[i].x = as_unknowns(M.adjoint() * fields.col(i) / static_cast<double>(M.rows()), kind);
    } else {
      for (auto& value : list[i].x) value = static_cast<double>(numbers() >> 11) * 0x1p-52 - 1.0;
    }
  }
  return list;
}

}  // namespace

VectorXcd lowest_variance(const mesh::Surface& surface, const std::vector<int>& triangles, const SampledParts& given,
                          Coefficients kind, Execution& execution) {
  const MatrixXcd basis = orthonormal(given.M, kind);
  const SampledParts parts{given.M * basis, given.N.rows() > 0 ? MatrixXcd(given.N * basis) : MatrixXcd()};
  const auto every = Eigen::seq(0, Eigen::last, kThinning);
  const SampledParts thinned{parts.M(every, Eigen::all),
                             parts.N.rows() > 0 ? MatrixXcd(parts.N(every, Eigen::all)) : MatrixXcd()};
  const auto fewer = [&](int count, int least) {
    return std::max(least, count * kManyForms / std::max(kManyForms, static_cast<int>(basis.cols())));
  };
  const int count = fewer(kStarts, 2);
  const MatrixXcd fields = surface.intrinsic() ? MatrixXcd() : even_fields(surface, triangles, count);
  std::vector<Candidate> candidates = starts(parts.M, fields, kind, count);
  // Descents are independent, so the result does not depend on the number of threads.
  TaskProgress watch(execution, kUsualValues, static_cast<double>(parts.M.size()) * kBalanceOperations);
  run_throwing(execution.workers(), static_cast<int>(candidates.size()), [&](int thread, int i) {
    descend(thinned, kind, candidates[i].x, kRoughFloors, kRoughSteps, [&] { watch(thread); });
    candidates[i].value = judgement(thinned, as_complex(candidates[i].x, kind));
  });
  std::stable_sort(candidates.begin(), candidates.end(), lower);
  const auto same = [](const Candidate& a, const Candidate& b) {
    return b.value - a.value <= kSame * std::abs(a.value);
  };
  // Descents that ended at one value are taken to have found one minimum.
  candidates.erase(std::unique(candidates.begin(), candidates.end(), same), candidates.end());
  if (const auto most = static_cast<std::size_t>(fewer(kKept, 1)); candidates.size() > most) candidates.resize(most);
  const int steps = fewer(kFineSteps, kFewestSteps);
  run_long_tasks(execution.workers(), static_cast<int>(candidates.size()), [&](int thread, int i) {
    candidates[i] = finished(parts, kind, std::move(candidates[i].x), steps, [&] { watch(thread); });
  });
  return basis * as_complex(held(std::ranges::min_element(candidates, lower), candidates).x, kind);
}

VectorXcd balanced_coefficients(const mesh::Surface& surface, const FormSamples& samples, const Eigen::MatrixXcd& basis,
                                Coefficients kind, Execution& execution) {
  if (basis.cols() == 1) return VectorXcd::Ones(1);
  VectorXcd c = lowest_variance(surface, samples.triangles, sampled_parts(surface, samples, basis), kind, execution);
  Eigen::Index largest;
  c.cwiseAbs().maxCoeff(&largest);
  const Complex phase = std::conj(c[largest]) / std::abs(c[largest]);
  return c * phase;  // the phase is free: the largest coefficient is made positive
}

}  // namespace holomorph::uv
