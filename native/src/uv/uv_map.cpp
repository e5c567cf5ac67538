#include "uv/uv_map.h"

#include <algorithm>
#include <cmath>
#include <complex>

#include "mesh/triangle_geometry.h"

namespace holomorph::uv {
namespace {

using Complex = std::complex<double>;

// A triangle has collapsed where s2 is below this fraction of s1: what is left of it is rounding.
constexpr double kCollapsed = 1e-12;

struct Weighted {
  double value, weight;
};

// The value below which the fraction `part` of the total weight lies, by halving the range in which it is: linear time.
double weighted_quantile(std::vector<Weighted>& items, double part) {
  double wanted = 0;
  for (const auto& item : items) wanted += part * item.weight;
  auto begin = items.begin(), end = items.end();
  while (end - begin > 1) {
    const auto middle = begin + (end - begin) / 2;
    std::nth_element(begin, middle, end, [](const Weighted& a, const Weighted& b) { return a.value < b.value; });
    double below = 0;
    for (auto item = begin; item != middle; ++item) below += item->weight;
    if (below >= wanted) {
      end = middle;
    } else {
      wanted -= below;
      begin = middle;
    }
  }
  return begin->value;
}

UvArray real_and_imaginary(const Eigen::VectorXcd& p) {
  UvArray columns(p.size(), 2);
  columns << p.real(), p.imag();
  return columns;
}

}  // namespace

UvArray uv_map(const mesh::Surface& surface, const CornerSheets& sheets, const forms::RowMajorMatrix& functions,
               const Eigen::VectorXcd& p) {
  return uv_map(surface, sheets, UvArray(functions * real_and_imaginary(p)), p);
}

UvArray uv_map(const mesh::Surface& surface, const CornerSheets& sheets, const UvArray& at_vertex,
               const Eigen::VectorXcd& p) {
  const UvArray coefficients = real_and_imaginary(p);
  UvArray translation = UvArray::Zero(static_cast<Eigen::Index>(sheets.sheets.size()), 2);
  for (std::size_t s = 0; s < sheets.sheets.size(); ++s) {
    for (const auto& [k, value] : sheets.sheets[s])
      translation.row(static_cast<Eigen::Index>(s)) += value * coefficients.row(k);
  }
  const auto& corner_vertices = surface.polygons.corner_vertices;
  UvArray uv(static_cast<Eigen::Index>(corner_vertices.size()), 2);
  for (Eigen::Index c = 0; c < uv.rows(); ++c)
    uv.row(c) = at_vertex.row(corner_vertices[c]) + translation.row(sheets.corner_sheet[c]);
  return uv;
}

Quality quality(const mesh::Surface& surface, const UvArray& uv) {
  const std::size_t count = surface.triangles.size();
  Quality result{std::vector<double>(count, 1.0), std::vector<double>(count, 0.0), std::vector<char>(count, 0), 0, 0};
  std::vector<double> areas(count, 0.0);
  double total = 0, sum = 0;
  for (std::size_t t = 0; t < count; ++t) {
    const auto& sides = surface.triangle_edges[t];
    const double a = surface.edge_lengths[sides[0]], b = surface.edge_lengths[sides[1]],
                 c = surface.edge_lengths[sides[2]];
    if (mesh::is_degenerate(a, b, c)) continue;
    areas[t] = mesh::triangle_area(a, b, c);
    // The triangle laid out with side 0 on the real axis and corner 2 at `apex`; the map is A z + B conj(z).
    const Complex apex((a * a + (c - b) * (c + b)) / (2 * a), 2 * areas[t] / a);
    const auto at = [&](int i) {
      return Complex(uv(surface.triangle_corners[t][i], 0), uv(surface.triangle_corners[t][i], 1));
    };
    const Complex along = (at(1) - at(0)) / a;  // A + B
    const Complex B = (along * apex - (at(2) - at(0))) / Complex(0, 2 * apex.imag()), A = along - B;
    const double larger = std::abs(A) + std::abs(B), smaller = std::abs(std::abs(A) - std::abs(B));
    result.area[t] = larger * smaller;
    if (larger > 0 && !(smaller > kCollapsed * larger)) {
      result.angle[t] = INFINITY;
      continue;
    }
    result.flipped[t] = std::abs(B) > std::abs(A);
    result.angle[t] = larger > 0 ? larger / smaller : 1.0;
    total += areas[t];
    sum += areas[t] * result.angle[t];
  }
  result.mean_angle = total > 0 ? sum / total : INFINITY;
  std::vector<Weighted> items(count);
  for (std::size_t t = 0; t < count; ++t) items[t] = {result.area[t], areas[t]};
  const double high = weighted_quantile(items, 0.95);
  result.density_ratio = high / weighted_quantile(items, 0.05);
  return result;
}

}  // namespace holomorph::uv
