#include "uv/uv_map.h"

#include <algorithm>
#include <cmath>
#include <unordered_map>

#include "base/constants.h"
#include "base/workers.h"
#include "mesh/surface.h"

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

// Numbers the sheets that occur. A sheet is the sum of the classes along a path from the first corner, a sparse row of
// integers; sheet 0 is the empty row.
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

// Faces, each after its parent, which lies across its half-edge `to_parent` (invalid at roots).
struct Walk {
  Array<int> order;
  Array<HalfedgeHandle> to_parent;
};

// Walks breadth first from the first face of each piece.
Walk walk_around(const mesh::HalfEdges& half_edges, const std::vector<char>& is_cut) {
  const int faces = static_cast<int>(half_edges.n_faces());
  Walk walk{{}, Array<HalfedgeHandle>(faces)};
  Array<char> visited(faces, 0);
  for (int root = 0; root < faces; ++root) {
    if (visited[root]) continue;
    visited[root] = 1;
    walk.order.push_back(root);
    for (std::size_t i = walk.order.size() - 1; i < walk.order.size(); ++i) {
      HalfedgeHandle h = half_edges.halfedge_handle(mesh::FaceHandle(walk.order[i]));
      for (int side = 0; side < 3; ++side, h = next(half_edges, h)) {
        const HalfedgeHandle o = opposite(h);
        if (is_cut[edge_of(h)] || !half_edges.face_handle(o).is_valid()) continue;
        const int across = mesh::face_of(half_edges, o);
        if (std::exchange(visited[across], 1)) continue;
        walk.to_parent[across] = o;
        walk.order.push_back(across);
      }
    }
  }
  return walk;
}

// #half-edges: sheet of the corner at which each starts, in its face; undefined for those without a face.
Array<int> sheets_at_starts(const mesh::HalfEdges& half_edges, const Walk& walk, SheetTable& table,
                            Execution& execution) {
  Array<int> at_start(half_edges.n_halfedges());
  for (std::size_t i = 0; i < walk.order.size(); ++i) {
    execution.step(i, walk.order.size(), 0.5, 1.0);
    const int f = walk.order[i];
    HalfedgeHandle h = walk.to_parent[f];
    if (h.is_valid()) {  // both ends have the sheets that they have in the parent
      at_start[h.idx()] = at_start[next(half_edges, opposite(h)).idx()];
      at_start[next(half_edges, h).idx()] = at_start[opposite(h).idx()];
    } else {
      h = half_edges.halfedge_handle(mesh::FaceHandle(f));
      at_start[h.idx()] = 0;
      at_start[next(half_edges, h).idx()] = table.after(0, h);
    }
    const HalfedgeHandle h1 = next(half_edges, h);
    // The third corner, along the side behind the one that is known.
    at_start[next(half_edges, h1).idx()] = table.after(at_start[h1.idx()], h1);
  }
  return at_start;
}

CoveringSheets sheets_of_corners(const mesh::Surface& surface, const mesh::HalfEdges& half_edges,
                                 const Array<int>& at_start, SheetTable&& table) {
  CoveringSheets result;
  result.corner_sheet.resize(surface.polygons.corner_vertices.size());
  for (int t = 0; t < static_cast<int>(surface.triangles.size()); ++t) {
    HalfedgeHandle h = half_edges.halfedge_handle(mesh::FaceHandle(t));
    for (int i = 0; i < 3; ++i, h = next(half_edges, h))
      result.corner_sheet[surface.triangle_corners[t][i]] = at_start[h.idx()];
  }
  result.sheets = std::move(table.sheets);
  return result;
}

UvArray real_and_imaginary(const Eigen::VectorXcd& p) {
  UvArray columns(p.size(), 2);
  columns << p.real(), p.imag();
  return columns;
}

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

CoveringSheets corner_sheets(const mesh::Surface& surface, const mesh::HalfEdges& half_edges,
                             const topology::FundamentalDomain& domain, const IntegerForms& classes,
                             Execution& execution) {
  SheetTable table(classes);
  const auto at_start = sheets_at_starts(half_edges, {domain.face_order, domain.to_parent_face}, table, execution);
  return sheets_of_corners(surface, half_edges, at_start, std::move(table));
}

CoveringSheets corner_sheets(const mesh::Surface& surface, const mesh::HalfEdges& half_edges,
                             const std::vector<int>& cut, const IntegerForms& classes, Execution& execution,
                             const std::vector<int>& labels) {
  std::vector<char> is_cut(surface.edges.size(), 0);
  for (const int e : cut) is_cut[e] = 1;
  SheetTable table(classes);
  const auto at_start = sheets_at_starts(half_edges, walk_around(half_edges, is_cut), table, execution);
  for (int e = 0; e < static_cast<int>(surface.edges.size()); ++e) {
    const HalfedgeHandle h(2 * e), o = opposite(h);
    if (is_cut[e] || !half_edges.face_handle(h).is_valid() || !half_edges.face_handle(o).is_valid()) continue;
    // Both faces have the same sheets at both ends. Otherwise a loop through this edge, inside the piece, has a period.
    if (at_start[h.idx()] == at_start[next(half_edges, o).idx()] &&
        at_start[o.idx()] == at_start[next(half_edges, h).idx()])
      continue;
    const auto [a, b] = surface.edges[e];
    const mesh::Labels label(labels);
    throw TopologyError("the cut does not leave disks: between the vertices " + label(a) + " and " + label(b) +
                        ", where it does not run, the map still jumps");
  }
  return sheets_of_corners(surface, half_edges, at_start, std::move(table));
}

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
