#include "uv/uv_map.h"

#include "base/chunks.h"

namespace holomorph::uv {
namespace {

UvArray real_and_imaginary(const Eigen::VectorXcd& p) {
  UvArray columns(p.size(), 2);
  columns << p.real(), p.imag();
  return columns;
}

}  // namespace

UvArray uv_map(const mesh::Surface& surface, const CornerSheets& sheets, const forms::RowMajorMatrix& functions,
               const Eigen::VectorXcd& p, Workers& workers) {
  return uv_map(surface, sheets, UvArray(functions * real_and_imaginary(p)), p, workers);
}

UvArray uv_map(const mesh::Surface& surface, const CornerSheets& sheets, const UvArray& at_vertex,
               const Eigen::VectorXcd& p, Workers& workers) {
  UvArray uv(static_cast<Eigen::Index>(surface.polygons.corner_vertices.size()), 2);
  write_uv_map(surface, sheets, at_vertex, p, uv, workers);
  return uv;
}

void write_uv_map(const mesh::Surface& surface, const CornerSheets& sheets, const UvArray& at_vertex,
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

}  // namespace holomorph::uv
