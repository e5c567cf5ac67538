#include <algorithm>
#include <numeric>

#include "base/chunks.h"
#include "base/page_allocator.h"
#include "forms/harmonic_basis.h"

namespace holomorph::forms {
namespace {

using mesh::edge_of;
using mesh::HalfedgeHandle;
using mesh::HalfEdges;
using mesh::next;
using mesh::opposite;
using mesh::to_vertex;

// Columns up to this long are sorted by ranks.
constexpr int kShort = 16;

struct Entry {
  int row;
  double value;
};

// Calls each(place, vertex, weight of the edge) for the half-edges that leave v, in their order around it.
template <class Each>
void around(const HalfEdges& mesh, const std::vector<double>& weights, int v, const Each& each) {
  const HalfedgeHandle start = mesh.halfedge_handle(mesh::VertexHandle(v));
  if (!start.is_valid()) return;
  HalfedgeHandle h = start;
  int place = 0;
  do {
    each(place++, to_vertex(mesh, h), weights[edge_of(h)]);
    h = next(mesh, opposite(h));
  } while (h != start);
}

// Column v of L where it has `count` <= kShort entries, all in different rows: ascending, without a branch that depends
// on their order. @return whether they are in different rows; else nothing is written
bool write_distinct(const HalfEdges& mesh, const std::vector<double>& weights, int v, int count, int* rows,
                    double* values) {
  int row[kShort] = {};
  double value[kShort];
  double diagonal = 0;
  around(mesh, weights, v, [&](int place, int vertex, double weight) {
    row[place] = vertex;
    value[place] = -weight;
    diagonal += weight;
  });
  row[count - 1] = v;
  value[count - 1] = diagonal;
  int rank[kShort] = {};
  for (int i = 0; i < count; ++i) {
    for (int j = 0; j < kShort; ++j) rank[j] += row[i] < row[j];
  }
  // Each pair of different rows counts once.
  if (std::accumulate(rank, rank + count, 0) != count * (count - 1) / 2) return false;
  for (int i = 0; i < count; ++i) {
    rows[rank[i]] = row[i];
    values[rank[i]] = value[i];
  }
  return true;
}

// Any column: entries of edges with the same ends added up, loops left out. @return how many entries it has
int write_merged(const HalfEdges& mesh, const std::vector<double>& weights, int v, int* rows, double* values) {
  std::vector<Entry> entries{{v, 0.0}};
  double diagonal = 0;
  around(mesh, weights, v, [&](int, int vertex, double weight) {
    if (vertex == v) return;
    entries.push_back({vertex, -weight});
    diagonal += weight;
  });
  entries[0].value = diagonal;
  std::stable_sort(entries.begin(), entries.end(), [](const Entry& a, const Entry& b) { return a.row < b.row; });
  int count = 0;
  for (const auto& [row, value] : entries) {
    if (count > 0 && rows[count - 1] == row) {
      values[count - 1] += value;
    } else {
      rows[count] = row;
      values[count++] = value;
    }
  }
  return count;
}

// Where each column begins if every edge has an entry of its own, behind the ones before.
std::vector<int> column_starts(const HalfEdges& mesh) {
  std::vector<int> start(mesh.n_vertices() + 1, 1);
  start[0] = 0;
  for (int h = 0; h < static_cast<int>(mesh.n_halfedges()); ++h) ++start[to_vertex(mesh, HalfedgeHandle(h)) + 1];
  std::partial_sum(start.begin(), start.end(), start.begin());
  return start;
}

// Moves the columns together over the entries that merging has left empty.
void close_gaps(const std::vector<int>& start, const std::vector<int>& counts, solver::Laplacian& L) {
  int* const end = L.outerIndexPtr() + 1;
  end[-1] = 0;
  for (std::size_t v = 0; v < counts.size(); ++v) {
    end[v] = end[v - 1] + counts[v];
    if (end[v - 1] == start[v]) continue;
    std::copy_n(L.innerIndexPtr() + start[v], counts[v], L.innerIndexPtr() + end[v - 1]);
    std::copy_n(L.valuePtr() + start[v], counts[v], L.valuePtr() + end[v - 1]);
  }
  L.resizeNonZeros(L.outerIndexPtr()[counts.size()]);
}

}  // namespace

// Every column has room for all edges at its vertex, and is filled by one thread.
solver::Laplacian laplacian(const HalfEdges& mesh, const std::vector<double>& weights, Progress& progress) {
  const int n = static_cast<int>(mesh.n_vertices());
  const std::vector<int> start = column_starts(mesh);
  progress.report(0.2);
  solver::Laplacian L(n, n);
  L.resizeNonZeros(start[n]);
  int* const rows = L.innerIndexPtr();
  double* const values = L.valuePtr();
  advise_large_pages(rows, start[n] * sizeof(int));
  advise_large_pages(values, start[n] * sizeof(double));
  std::vector<int> counts(n);
  Workers workers;
  run_throwing(workers, chunk_count(n), [&](int chunk) {
    for (int v = chunk * kChunk, last = std::min(v + kChunk, n); v < last; ++v) {
      const int begin = start[v], count = start[v + 1] - begin;
      const bool written = count <= kShort && write_distinct(mesh, weights, v, count, rows + begin, values + begin);
      counts[v] = written ? count : write_merged(mesh, weights, v, rows + begin, values + begin);
    }
  });
  progress.report(0.9);
  close_gaps(start, counts, L);
  return L;
}

}  // namespace holomorph::forms
