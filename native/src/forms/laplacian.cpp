#include "forms/laplacian.h"

#include <algorithm>
#include <numeric>

#include "base/double_double.h"
#include "base/page_allocator.h"
#include "base/workers.h"

namespace holomorph::forms {

namespace {

using mesh::edge_of;
using mesh::HalfedgeHandle;
using mesh::HalfEdges;
using mesh::next;
using mesh::opposite;
using mesh::to_vertex;

// Columns up to this long, the diagonal included, are sorted by ranks.
constexpr int kShort = 16;

struct Entry {
  int row;
  double value;
};

// Calls each(place, vertex, weight of the edge) for the half-edges that leave v, in their order around it. @return
// their number
template <class Each>
int around(const HalfEdges& half_edges, std::span<const double> weights, int v, const Each& each) {
  const HalfedgeHandle start = half_edges.halfedge_handle(mesh::VertexHandle(v));
  if (!start.is_valid()) return 0;
  HalfedgeHandle h = start;
  int place = 0;
  do {
    each(place++, to_vertex(half_edges, h), weights[edge_of(h)]);
    h = next(half_edges, opposite(h));
  } while (h != start);
  return place;
}

// Column v of L where it has at most kShort entries, all in different rows: ascending, without a branch that depends on
// their order. @return how many entries it has; 0 where it is not such a column, and nothing is written
int write_distinct(const HalfEdges& half_edges, std::span<const double> weights, int v, int* rows, double* values) {
  int row[kShort] = {};
  double value[kShort];
  double diagonal = 0;
  const int others = around(half_edges, weights, v, [&](int place, int vertex, double weight) {
    const int kept = std::min(place, kShort - 1);
    row[kept] = vertex;
    value[kept] = -weight;
    diagonal += weight;
  });
  if (others >= kShort) return 0;
  const int count = others + 1;
  row[others] = v;
  value[others] = diagonal;
  // Sorting by ranks: the rank of a row is the number of smaller ones. The inner loop has a constant length.
  int rank[kShort] = {};
  for (int i = 0; i < count; ++i) {
    for (int j = 0; j < kShort; ++j) rank[j] += row[i] < row[j];
  }
  // Each pair of different rows counts once.
  if (std::accumulate(rank, rank + count, 0) != count * (count - 1) / 2) return 0;
  for (int i = 0; i < count; ++i) {
    rows[rank[i]] = row[i];
    values[rank[i]] = value[i];
  }
  return count;
}

// Any column: entries of edges with the same ends added up, loops left out. @return how many entries it has
int write_merged(const HalfEdges& half_edges, std::span<const double> weights, int v, int* rows, double* values) {
  std::vector<Entry> entries{{v, 0.0}};
  double diagonal = 0;
  around(half_edges, weights, v, [&](int, int vertex, double weight) {
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

// Where the columns of each chunk begin, and where the last ones end, if every edge has entries of its own.
std::vector<int> chunk_starts(const HalfEdges& half_edges, Workers& workers) {
  const int n = static_cast<int>(half_edges.n_vertices()), chunks = chunk_count(n);
  const int count = static_cast<int>(half_edges.n_halfedges()), block = 64 * kChunk;
  // Half-edges are counted in fixed blocks, each with counters of its own, so that no two threads write to one counter.
  std::vector<std::vector<int>> arriving((count + block - 1) / block, std::vector<int>(chunks, 0));
  workers.run(static_cast<int>(arriving.size()), [&](int, int i) {
    for (int h = i * block, end = std::min(h + block, count); h < end; ++h)
      ++arriving[i][to_vertex(half_edges, HalfedgeHandle(h)) / kChunk];
  });
  std::vector<int> start(chunks + 1, 0);
  for (int c = 0; c < chunks; ++c) {
    start[c + 1] = start[c] + std::min(kChunk, n - c * kChunk);
    for (const std::vector<int>& counts : arriving) start[c + 1] += counts[c];
  }
  return start;
}

// Closes the gaps between chunks that merging has left.
void close_gaps(const std::vector<int>& start, solver::Laplacian& L) {
  const int n = L.size();
  int* const ends = L.starts.data() + 1;
  int* const columns = L.columns.data();
  double* const weights = L.weights.data();
  int entries = 0;
  for (int c = 0; c < chunk_count(n); ++c) {
    const int first = c * kChunk, last = std::min(first + kChunk, n), begin = start[c], end = ends[last - 1];
    if (begin > entries) {
      std::copy(columns + begin, columns + end, columns + entries);
      std::copy(weights + begin, weights + end, weights + entries);
      for (int v = first; v < last; ++v) ends[v] -= begin - entries;
    }
    entries += end - begin;
  }
  L.columns.resize(entries);
  L.weights.resize(entries);
}

// The flux of all forms out of a vertex, and their energy there, half of that of its edges.
class AtVertex {
 public:
  AtVertex(const HalfEdges& half_edges, std::span<const double> weights, const FluxTerms& terms,
           const RowMajorMatrix& functions)
      : mesh_(half_edges), weights_(weights), terms_(terms), functions_(functions) {}

  std::vector<DoubleDouble> flux;

  void begin(int v) {
    flux.assign(functions_.cols(), {});
    for (Eigen::Index i = 0; i < terms_.sources.cols(); ++i) flux[i].high = terms_.sources(v, i);
  }

  void add(HalfedgeHandle h, Eigen::RowVectorXd& energies) {
    const int head = mesh::to_vertex(mesh_, h), tail = mesh::from_vertex(mesh_, h), e = mesh::edge_of(h);
    const double k = weights_[e], outer = terms_.outer_weights.empty() ? k : terms_.outer_weights[e];
    const bool everywhere = fill(terms_.eta, h, eta_), outside = fill(terms_.outer_eta, h, outer_eta_);
    for (Eigen::Index i = 0; i < functions_.cols(); ++i) {
      // The difference comes first, exactly: then a large weight multiplies a small number.
      DoubleDouble value = exact_sum(functions_(head, i), -functions_(tail, i));
      if (everywhere) value = value + DoubleDouble{eta_[i]};
      flux[i] = flux[i] + DoubleDouble{k} * value;
      const double whole = value.high + (outside ? outer_eta_[i] : 0);
      if (outside) flux[i] = flux[i] + DoubleDouble{outer} * DoubleDouble{outer_eta_[i]};
      // Half of an edge's energy goes to each end. Where outer < k, inside a star, the rest of k weighs df + eta
      // without the singular part.
      energies[i] += 0.5 * (outer * whole * whole + (k - outer) * value.high * value.high);
    }
  }

 private:
  bool fill(const AddValues& form, HalfedgeHandle h, Eigen::VectorXd& values) const {
    if (!form) return false;
    values.setZero(functions_.cols());
    form(h, values);
    return true;
  }

  const HalfEdges& mesh_;
  std::span<const double> weights_;
  const FluxTerms& terms_;
  const RowMajorMatrix& functions_;
  Eigen::VectorXd eta_, outer_eta_;
};

}  // namespace

// A chunk has space for all edges at its vertices, and is filled by one thread.
solver::Laplacian laplacian(const HalfEdges& half_edges, std::span<const double> weights, Execution& execution) {
  const int n = static_cast<int>(half_edges.n_vertices());
  Workers& workers = execution.workers();
  const std::vector<int> start = chunk_starts(half_edges, workers);
  execution.report(0.2);
  solver::Laplacian L{Array<int>(n + 1), Array<int>(start.back()), Array<double>(start.back())};
  int* const rows = L.columns.data();
  double* const values = L.weights.data();
  int* const ends = L.starts.data() + 1;
  L.starts[0] = 0;
  run_throwing(workers, chunk_count(n), [&](int chunk) {
    int place = start[chunk];
    for (int v = chunk * kChunk, last = std::min(v + kChunk, n); v < last; ++v) {
      const int written = write_distinct(half_edges, weights, v, rows + place, values + place);
      place += written > 0 ? written : write_merged(half_edges, weights, v, rows + place, values + place);
      ends[v] = place;
    }
  });
  execution.report(0.9);
  close_gaps(start, L);
  return L;
}

FluxTerms class_terms(const topology::IntegerForms& classes, int first, int count) {
  return {[&classes, first, count](HalfedgeHandle h, Eigen::VectorXd& values) {
    for (const auto& [i, value] : topology::forms_between(classes.rows[mesh::edge_of(h)], first, first + count))
      values[i - first] += mesh::sign(h) * value;
  }};
}

FluxTerms class_terms(const topology::IntegerForms& classes, const Eigen::MatrixXd& combinations) {
  return {[&classes, combinations](HalfedgeHandle h, Eigen::VectorXd& values) {
    for (const auto& [i, value] : classes.rows[mesh::edge_of(h)])
      values += mesh::sign(h) * value * combinations.row(i).transpose();
  }};
}

FluxTerms function_terms(const HalfEdges& half_edges, RowMajorMatrix functions) {
  return {[&half_edges, g = std::move(functions)](HalfedgeHandle h, Eigen::VectorXd& values) {
    values += (g.row(mesh::to_vertex(half_edges, h)) - g.row(mesh::from_vertex(half_edges, h))).transpose();
  }};
}

HarmonicResiduals harmonic_residuals(const HalfEdges& half_edges, std::span<const double> weights,
                                     const FluxTerms& terms, const RowMajorMatrix& functions, Workers& workers) {
  const int vertices = static_cast<int>(functions.rows()), chunks = chunk_count(vertices);
  const Eigen::RowVectorXd none = Eigen::RowVectorXd::Zero(functions.cols());
  HarmonicResiduals result{Eigen::MatrixXd(functions.rows(), functions.cols()), none};
  std::vector<Eigen::RowVectorXd> energies(chunks, none);
  run_throwing(workers, chunks, [&](int chunk) {
    AtVertex here(half_edges, weights, terms, functions);
    for (int v = chunk * kChunk, end = std::min(v + kChunk, vertices); v < end; ++v) {
      here.begin(v);
      const HalfedgeHandle start = half_edges.halfedge_handle(mesh::VertexHandle(v));
      HalfedgeHandle h = start;
      do {
        here.add(h, energies[chunk]);
        h = next(half_edges, mesh::opposite(h));
      } while (h != start);
      for (Eigen::Index i = 0; i < functions.cols(); ++i) result.R(v, i) = here.flux[i].value();
    }
  });
  for (const Eigen::RowVectorXd& part : energies) result.energies += part;
  return result;
}

}  // namespace holomorph::forms
