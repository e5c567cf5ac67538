#include "uv/corner_sheets.h"

#include <unordered_map>

namespace holomorph::uv {
namespace {

using mesh::edge_of;
using mesh::HalfedgeHandle;
using mesh::next;
using mesh::opposite;
using topology::IntegerForms;

struct RowHash {
  std::size_t operator()(const IntegerForms::Row& row) const {
    std::size_t hash = 1469598103934665603ull;  // FNV-1a over the entries
    for (const auto& [form, value] : row) {
      hash = (hash ^ static_cast<std::size_t>(form)) * 1099511628211ull;
      hash = (hash ^ static_cast<std::size_t>(value)) * 1099511628211ull;
    }
    return hash;
  }
};

class SheetTable {
 public:
  explicit SheetTable(const IntegerForms& classes) : classes_(classes) { number({}); }

  // The sheet at the end of h when `sheet` is the one at its start, in the same face.
  int after(int sheet, HalfedgeHandle h) {
    const auto& row = classes_.rows[edge_of(h)];
    return row.empty() ? sheet : number(topology::add(sheets[sheet], row, mesh::sign(h)));
  }

  std::vector<IntegerForms::Row> sheets;

 private:
  int number(IntegerForms::Row row) {
    const auto [entry, is_new] = numbers_.try_emplace(std::move(row), static_cast<int>(sheets.size()));
    if (is_new) sheets.push_back(entry->first);
    return entry->second;
  }

  const IntegerForms& classes_;
  std::unordered_map<IntegerForms::Row, int, RowHash> numbers_;
};

}  // namespace

CornerSheets corner_sheets(const mesh::Surface& surface, const mesh::HalfEdges& mesh,
                           const topology::FundamentalDomain& domain, const IntegerForms& classes, Progress& progress) {
  SheetTable table(classes);
  std::vector<int> at_start(mesh.n_halfedges(), 0);  // sheet of the corner at which a half-edge starts, in its face
  for (std::size_t i = 0; i < domain.face_order.size(); ++i) {
    progress.step(i, domain.face_order.size(), 0.5, 1.0);
    const int f = domain.face_order[i];
    HalfedgeHandle h = domain.to_parent_face[f];
    if (h.is_valid()) {  // both ends are on the sheets that they are on in the parent
      at_start[h.idx()] = at_start[next(mesh, opposite(h)).idx()];
      at_start[next(mesh, h).idx()] = at_start[opposite(h).idx()];
    } else {
      h = mesh.halfedge_handle(mesh::FaceHandle(f));
      at_start[next(mesh, h).idx()] = table.after(0, h);
    }
    const HalfedgeHandle h1 = next(mesh, h);
    at_start[next(mesh, h1).idx()] = table.after(at_start[h1.idx()], h1);
  }
  CornerSheets result;
  result.corner_sheet.assign(surface.polygons.corner_vertices.size(), 0);
  for (int t = 0; t < static_cast<int>(surface.triangles.size()); ++t) {
    HalfedgeHandle h = mesh.halfedge_handle(mesh::FaceHandle(t));
    for (int i = 0; i < 3; ++i, h = next(mesh, h))
      result.corner_sheet[surface.triangle_corners[t][i]] = at_start[h.idx()];
  }
  result.sheets = std::move(table.sheets);
  return result;
}

}  // namespace holomorph::uv
