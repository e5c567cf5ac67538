#include "mesh/metric_errors.h"

#include <algorithm>
#include <cmath>

#include "base/constants.h"
#include "base/double_double.h"
#include "base/workers.h"
#include "mesh/triangle_geometry.h"

namespace holomorph::mesh {
namespace {

// Error of a length from positions: 1 of each difference, 3 of its square, 5 of their sum, half that and 1 of the root;
// error of a given length: the caller's.
constexpr double kOfDistance = 3.5 * kUnit, kOfGivenLength = 2.5 * kUnit;
// Error of a cotangent, b^2 - a^2 + c^2 over 4 A, in parts of the largest one of its triangle and of itself: 3 of b^2 -
// a^2, 1 of c^2, whose sizes add up to the numerator of a or of b; 1 of the sum, 5.5 of the area (Kahan's order), 1 of
// the quotient.
constexpr double kOfLargest = 3 * kUnit, kOfCotangent = 7.5 * kUnit;
// The same in twice the precision (Joldes et al. 2017, doi:10.1145/3121432), in parts of |b^2 - a^2| / 4 A, 3 of the
// difference, and of the cotangent: 3 of the sum, 21 of the area, 15 of the quotient.
constexpr double kOfSharpSquares = 3 * kUnit * kUnit, kOfSharpCotangent = 39 * kUnit * kUnit;
// Error of the errors of cotangents themselves: 1 of a product, 5 of the sum with the others of an edge, half of each.
constexpr double kOfErrors = 3 * kUnit;
// Covers the rounding of these bounds themselves, sums of few terms that are all positive, and products of units.
constexpr double kSlack = 1 + 32 * kUnit;

std::array<HalfedgeHandle, 3> around(const Metric& t, HalfedgeHandle h) {
  const HalfedgeHandle h1 = next(t.half_edges, h);
  return {h, h1, next(t.half_edges, h1)};
}

std::array<double, 3> sides_at(const Metric& t, HalfedgeHandle h) {
  const auto [h0, h1, h2] = around(t, h);
  return {t.lengths[edge_of(h0)], t.lengths[edge_of(h1)], t.lengths[edge_of(h2)]};
}

const FaceError& error_at(const Metric& t, HalfedgeHandle h) { return t.errors[t.half_edges.face_handle(h).idx()]; }

double largest_cotangent(const Metric& t, HalfedgeHandle h) {
  const auto [h0, h1, h2] = around(t, h);
  return std::max(
      {std::abs(t.cotangents[h0.idx()]), std::abs(t.cotangents[h1.idx()]), std::abs(t.cotangents[h2.idx()])});
}

bool is_thin_at(const Metric& t, HalfedgeHandle h) {
  return !t.half_edges.is_boundary(h) && !(largest_cotangent(t, h) <= kThin);
}

struct Cotangent {
  DoubleDouble value;
  double error;
};

// The cotangent opposite h; in a thin triangle to all digits, of the lengths as they are.
Cotangent cotangent_at(const Metric& t, HalfedgeHandle h) {
  const double given = t.cotangents[h.idx()];
  const Cotangent rounded{{given}, kSlack * (kOfLargest * largest_cotangent(t, h) + kOfCotangent * std::abs(given))};
  if (!is_thin_at(t, h)) return rounded;
  const auto [a, b, c] = sides_at(t, h);
  const DoubleDouble others = exact_sum(b, c), apart = exact_sum(b, -c), whole{a};
  const DoubleDouble area = (whole + others) * (others - whole) * (whole - apart) * (whole + apart);  // 16 A^2
  if (!(area.high > 0)) return rounded;
  const DoubleDouble squares = exact_product(b, b) - exact_product(a, a), root = sqrt(area);
  const DoubleDouble sharp = (squares + exact_product(c, c)) / root;
  return {sharp,
          kSlack * (kOfSharpSquares * std::abs(squares.high) / root.high + kOfSharpCotangent * std::abs(sharp.high))};
}

// Relative error of a map with the error x, followed by one with y.
double both(double x, double y) { return std::min(1.0, x + y + x * y); }

// What a side of an edge adds to its error.
double error_of_side(const Metric& t, HalfedgeHandle h) {
  if (t.half_edges.is_boundary(h)) return 0;
  const double error = error_at(t, h).mean;
  const auto [sharp, rounding] = cotangent_at(t, h);
  const double cotangent = sharp.value();
  return 0.5 * error * cotangent + 0.5 * (1 + error) * rounding + kSlack * kOfErrors * error * std::abs(cotangent);
}

}  // namespace

// A length l_i that is off by delta_i changes the metric by (2 l_i + delta_i) delta_i |grad lambda_j| |grad lambda_k|;
// these gradients are l_j / 2A and l_k / 2A long. Where that is eta, energies, sqrt(det g) g^-1, change by no more than
// 1 / sqrt(1 - eta), for the eigenvalues of the change differ by eta at most: so what is returned, eta + eta^2, is
// nearly twice as large as needed, and covers its own rounding and that of the delta_i.
double energy_growth(const std::array<RoundedLength, 3>& sides, double* open) {
  const auto& [a, b, c] = sides;
  const auto part = [](const RoundedLength& x, double y, double z) {
    return (2 * x.length + x.error) * x.error * y * z;
  };
  const double bound = (part(a, b.length, c.length) + part(b, c.length, a.length) + part(c, a.length, b.length)) / 4;
  const double area = triangle_area(a.length, b.length, c.length), eta = bound / (area * area);
  const bool is_open = !(eta < 0.5);
  if (open) *open = is_open ? std::sqrt(std::max(bound, area * area)) : area;
  return is_open ? 1 : eta * (1 + eta);
}

double length_error(const Surface& surface) { return surface.intrinsic() ? kOfGivenLength : kOfDistance; }

Array<FaceError> metric_errors(const Metric& t, const Surface& surface, Workers& workers) {
  Array<FaceError> errors(t.half_edges.n_faces());
  const bool given = !surface.metric_errors.empty();
  const double of_length = length_error(surface);
  for_rows(workers, static_cast<int>(t.half_edges.n_halfedges()), [&](int i) {
    const HalfedgeHandle h(i);
    if (t.half_edges.is_boundary(h) || !is_first_of_face(t.half_edges, h)) return;
    const int f = t.half_edges.face_handle(h).idx();
    if (given) {
      errors[f] = {surface.metric_errors[f], surface.metric_errors[f]};
      return;
    }
    const auto [a, b, c] = sides_at(t, h);
    const double error = energy_growth({{{a, of_length * a}, {b, of_length * b}, {c, of_length * c}}});
    errors[f] = {error, error};
  });
  return errors;
}

FacesBeside faces_beside(const Metric& t, HalfedgeHandle h) {
  const auto area = [&t](HalfedgeHandle side) {
    double open = 0;
    const auto [a, b, c] = sides_at(t, side);
    energy_growth({{{a, kOfDistance * a}, {b, kOfDistance * b}, {c, kOfDistance * c}}}, &open);
    return open;
  };
  return {{error_at(t, h), error_at(t, opposite(h))}, {area(h), area(opposite(h))}};
}

// Each new face has the same part of both old ones, so of their errors as much as that part may hold; gradients are
// constant on it, and its energy is spread by area. The new length changes that area, too, by no more than energies.
std::array<FaceError, 2> errors_after_flip(const Metric& t, HalfedgeHandle h, const FacesBeside& before, double error) {
  const auto& [errors, areas] = before;
  const double whole = areas[0] + areas[1], largest = std::max(errors[0].largest, errors[1].largest);
  const auto after = [&](HalfedgeHandle side) {
    const auto [a, b, c] = sides_at(t, side);
    const double growth = energy_growth({{{a, error}, {b, 0}, {c, 0}}});
    const double part = std::min(1.0, triangle_area(a, b, c) / whole);
    double mean = 0;
    for (const int i : {0, 1}) mean += std::min(errors[i].mean / part, errors[i].largest) * areas[i] / whole;
    mean = std::min(largest, kSlack * mean * (1 + growth));
    return FaceError{both(mean, growth), both(largest, growth)};
  };
  return {after(h), after(opposite(h))};
}

void sharpen_weights(const Metric& t, Array<double>& weights, Workers& workers) {
  for_rows(workers, static_cast<int>(weights.size()), [&](int e) {
    const HalfedgeHandle h(2 * e);
    if (is_thin_at(t, h) || is_thin_at(t, opposite(h)))
      weights[e] = 0.5 * (cotangent_at(t, h).value + cotangent_at(t, opposite(h)).value).value();
  });
}

Array<double> energy_errors(const Metric& t, const Array<double>& weights, Workers& workers) {
  if (t.errors.empty()) return {};
  Array<double> errors(weights.size());
  for_rows(workers, static_cast<int>(errors.size()), [&](int e) {
    const HalfedgeHandle h(2 * e);
    errors[e] = error_of_side(t, h) + error_of_side(t, opposite(h)) + kSlack * kUnit * std::abs(weights[e]);
  });
  return errors;
}

FaceWeights face_weights(const Metric& t, HalfedgeHandle h) {
  // Forms need not be constant on the face, so that its largest error counts.
  const double error = t.errors.empty() ? 0 : error_at(t, h).largest;
  FaceWeights result;
  const auto side = around(t, h);
  for (int i = 0; i < 3; ++i) {
    const auto [sharp, rounding] = cotangent_at(t, side[i]);
    const double cotangent = result.cotangents[i] = sharp.value();
    result.errors[i] =
        error * cotangent + (1 + error) * rounding + kSlack * kUnit * (1 + 6 * error) * std::abs(cotangent);
  }
  return result;
}

double largest_error(const Metric& t) {
  double largest = 0;
  for (const FaceError& error : t.errors) largest = std::max(largest, error.largest);
  return largest;
}

}  // namespace holomorph::mesh
