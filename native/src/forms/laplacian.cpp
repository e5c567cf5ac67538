#include <algorithm>
#include <numeric>

#include "base/chunks.h"
#include "forms/harmonic_basis.h"

namespace holomorph::forms {
namespace {

using mesh::edge_of;
using mesh::HalfedgeHandle;
using mesh::HalfEdges;
using mesh::next;
using mesh::opposite;
using mesh::to_vertex;

// Rows up to this long are sorted by insertion.
constexpr int kShort = 64;

struct Neighbour {
  int vertex;
  double weight;
};

// Calls each(vertex, weight of the edge) for the neighbours of v in their order around it; loops are left out.
template <class Each>
void around(const HalfEdges& mesh, const std::vector<double>& weights, int v, const Each& each) {
  const HalfedgeHandle start = mesh.halfedge_handle(mesh::VertexHandle(v));
  HalfedgeHandle h = start;
  do {
    if (to_vertex(mesh, h) != v) each(to_vertex(mesh, h), weights[edge_of(h)]);
    h = next(mesh, opposite(h));
  } while (h != start);
}

// Column v of L: entries ascending, those of edges with the same ends added up. @return how many there are
int short_column(const HalfEdges& mesh, const std::vector<double>& weights, int v, int* rows, double* values) {
  rows[0] = v;
  int count = 1;
  around(mesh, weights, v, [&](int vertex, double weight) {
    int place = count;
    while (place > 0 && rows[place - 1] > vertex) --place;
    if (place > 0 && rows[place - 1] == vertex) {
      values[place - 1] -= weight;
      return;
    }
    std::copy_backward(rows + place, rows + count, rows + count + 1);
    std::copy_backward(values + place, values + count, values + count + 1);
    rows[place] = vertex;
    values[place] = -weight;
    ++count;
  });
  return count;
}

int long_column(const HalfEdges& mesh, const std::vector<double>& weights, int v, int* rows, double* values) {
  std::vector<Neighbour> ring{{v, 0.0}};
  around(mesh, weights, v, [&](int vertex, double weight) { ring.push_back({vertex, weight}); });
  std::stable_sort(ring.begin(), ring.end(),
                   [](const Neighbour& a, const Neighbour& b) { return a.vertex < b.vertex; });
  int count = 0;
  for (const auto& [vertex, weight] : ring) {
    if (count > 0 && rows[count - 1] == vertex) {
      values[count - 1] -= weight;
    } else {
      rows[count] = vertex;
      values[count++] = -weight;
    }
  }
  return count;
}

// The entry at v itself, by which the column sums to 0.
void set_diagonal(int v, int count, const int* rows, double* values) {
  double sum = 0;
  double* diagonal = values;
  for (int i = 0; i < count; ++i) {
    if (rows[i] == v) {
      diagonal = values + i;
    } else {
      sum -= values[i];
    }
  }
  *diagonal = sum;
}

}  // namespace

// Every column has room for all edges at its vertex, and is filled by one thread; what edges with the same ends leave
// empty is closed at the end.
solver::Laplacian laplacian(const HalfEdges& mesh, const std::vector<double>& weights, Progress& progress) {
  const int n = static_cast<int>(mesh.n_vertices());
  std::vector<int> start(n + std::size_t{1}, 1), counts(n);
  start[0] = 0;
  for (int h = 0; h < 2 * static_cast<int>(weights.size()); ++h) ++start[to_vertex(mesh, HalfedgeHandle(h)) + 1];
  std::partial_sum(start.begin(), start.end(), start.begin());
  solver::Laplacian L(n, n);
  L.resizeNonZeros(start[n]);
  int* const rows = L.innerIndexPtr();
  double* const values = L.valuePtr();
  const auto is_long = [&](int v) { return start[v + 1] - start[v] > kShort; };
  for (int v = 0; v < n; ++v) {
    if (is_long(v)) counts[v] = long_column(mesh, weights, v, rows + start[v], values + start[v]);
  }
  progress.report(0.2);
  Workers workers;
  for_rows(workers, n, [&](int v) {
    if (!is_long(v)) counts[v] = short_column(mesh, weights, v, rows + start[v], values + start[v]);
    set_diagonal(v, counts[v], rows + start[v], values + start[v]);
  });
  progress.report(0.9);
  int* const end = L.outerIndexPtr() + 1;
  end[-1] = 0;
  for (int v = 0; v < n; ++v) {
    end[v] = end[v - 1] + counts[v];
    if (end[v - 1] == start[v]) continue;
    std::copy_n(rows + start[v], counts[v], rows + end[v - 1]);
    std::copy_n(values + start[v], counts[v], values + end[v - 1]);
  }
  L.resizeNonZeros(end[n - 1]);
  return L;
}

}  // namespace holomorph::forms
