#include "uv/uv_map.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/chunks.h"

namespace holomorph::uv {
namespace {

UvArray real_and_imaginary(const Eigen::VectorXcd& p) {
  UvArray columns(p.size(), 2);
  columns << p.real(), p.imag();
  return columns;
}

constexpr double kInfinity = std::numeric_limits<double>::infinity();

struct Extent {
  double low[2] = {kInfinity, kInfinity}, high[2] = {-kInfinity, -kInfinity}, area = 0;

  Extent& operator+=(const Extent& other) {
    for (int i = 0; i < 2; ++i) {
      low[i] = std::min(low[i], other.low[i]);
      high[i] = std::max(high[i], other.high[i]);
    }
    area += other.area;
    return *this;
  }
};

}  // namespace

UvArray uv_map(const mesh::Surface& surface, const CoveringSheets& sheets, const forms::RowMajorMatrix& functions,
               const Eigen::VectorXcd& p, Workers& workers) {
  return uv_map(surface, sheets, UvArray(functions * real_and_imaginary(p)), p, workers);
}

UvArray uv_map(const mesh::Surface& surface, const CoveringSheets& sheets, const UvArray& at_vertex,
               const Eigen::VectorXcd& p, Workers& workers) {
  UvArray uv(static_cast<Eigen::Index>(surface.polygons.corner_vertices.size()), 2);
  write_uv_map(surface, sheets, at_vertex, p, uv, workers);
  return uv;
}

void write_uv_map(const mesh::Surface& surface, const CoveringSheets& sheets, const UvArray& at_vertex,
                  const Eigen::VectorXcd& p, Eigen::Ref<UvArray> uv, Workers& workers) {
  const UvArray coefficients = real_and_imaginary(p);
  // One translation for each sheet; there are few sheets.
  UvArray translation = UvArray::Zero(static_cast<Eigen::Index>(sheets.sheets.size()), 2);
  for (std::size_t s = 0; s < sheets.sheets.size(); ++s) {
    for (const auto& [k, value] : sheets.sheets[s])
      translation.row(static_cast<Eigen::Index>(s)) += value * coefficients.row(k);
  }
  const auto& corner_vertices = surface.polygons.corner_vertices;
  for_rows(workers, static_cast<int>(uv.rows()),
           [&](int c) { uv.row(c) = at_vertex.row(corner_vertices[c]) + translation.row(sheets.corner_sheet[c]); });
}

Frame frame(const mesh::Surface& surface, const Eigen::Ref<const UvArray>& uv, double rotation, Workers& workers) {
  const double cosine = std::cos(rotation), sine = std::sin(rotation);
  const auto add_triangle = [&](int t, Extent& extent) {
    double at[3][2];
    for (int i = 0; i < 3; ++i) {
      const int corner = surface.triangle_corners[t][i];
      const double u = uv(corner, 0), v = uv(corner, 1);
      at[i][0] = cosine * u - sine * v;
      at[i][1] = sine * u + cosine * v;
      for (int k = 0; k < 2; ++k) {
        extent.low[k] = std::min(extent.low[k], at[i][k]);
        extent.high[k] = std::max(extent.high[k], at[i][k]);
      }
    }
    extent.area +=
        // Absolute values: flipped triangles do not take area away.
        0.5 * std::abs((at[1][0] - at[0][0]) * (at[2][1] - at[0][1]) - (at[1][1] - at[0][1]) * (at[2][0] - at[0][0]));
  };
  const Extent extent = sum_over_rows(workers, static_cast<int>(surface.triangles.size()), Extent(), add_triangle);
  return {{extent.low[0], extent.low[1]}, {extent.high[0], extent.high[1]}, extent.area};
}

void place(const Eigen::Ref<const UvArray>& uv, const Placement& placement, const int* rows, double* placed,
           Workers& workers) {
  const auto [factor, origin, target] = placement;
  for_rows(workers, static_cast<int>(uv.rows()), [&, factor = factor, origin = origin, target = target](int c) {
    const double x = uv(c, 0) - origin.real(), y = uv(c, 1) - origin.imag();
    double* row = placed + 2 * static_cast<std::ptrdiff_t>(rows ? rows[c] : c);
    row[0] = factor.real() * x - factor.imag() * y + target.real();
    row[1] = factor.real() * y + factor.imag() * x + target.imag();
  });
}

}  // namespace holomorph::uv
