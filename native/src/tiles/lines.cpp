#include "tiles/lines.h"

#include <algorithm>

#include "base/chunks.h"
#include "base/task_progress.h"
#include "tiles/triangle_cut.h"

namespace holomorph::tiles {
namespace {

using Segment = std::array<int, 2>;  // from a node to a node, with what is less on the left

// The segments of lines across the triangles of a chunk, and along their sides. A side belongs to the first triangle at
// its edge.
std::vector<Segment> segments(const mesh::Surface& surface, const TileCoordinates& coordinates,
                              const EdgeNodes& edge_nodes, int begin, int end, const std::function<void()>& report) {
  TriangleCut cut(surface, coordinates, edge_nodes, Pattern::columns, report);
  std::vector<Segment> result;
  for (int t = begin; t < end; ++t) {
    const auto& pieces = cut.cut(t);
    // The last side of a piece that was cut away is the cut.
    for (std::size_t p = 0; p + 1 < pieces.size(); ++p)
      result.push_back({pieces[p].back().node, pieces[p].front().node});
    const auto code = [&](int i) { return code_of(coordinates.points[t][i % 3], coordinates.unit)[0]; };
    for (int i = 0; i < 3; ++i) {
      const auto& [a, b] = std::pair{surface.triangles[t][i], surface.triangles[t][(i + 1) % 3]};
      const bool is_first = edge_nodes.sides[surface.triangle_edges[t][i]] == 3 * t + i;
      const bool is_spoke = coordinates.is_pole[a] || coordinates.is_pole[b];
      if (!is_first || is_spoke || code(i) != code(i + 1) || !is_line(code(i))) continue;
      result.push_back(code(i + 2) < code(i) ? Segment{a, b} : Segment{b, a});
    }
  }
  return result;
}

// Chains segments at nodes where exactly two meet.
class Chains {
 public:
  Chains(const std::vector<Segment>& segments, int nodes) : segments_(segments), offsets_(nodes + 1, 0) {
    for (const auto& segment : segments) {
      for (const int node : segment) ++offsets_[node + 1];
    }
    for (int n = 0; n < nodes; ++n) offsets_[n + 1] += offsets_[n];
    at_node_.resize(2 * segments.size());
    std::vector<int> next(offsets_.begin(), offsets_.end() - 1);
    for (int s = 0; s < std::ssize(segments); ++s) {
      for (const int node : segments[s]) at_node_[next[node]++] = s;
    }
  }

  /// follow(nodes, is_closed) for each chain: those with ends first.
  template <class Follow>
  void run(const Follow& follow) {
    std::vector<char> seen(segments_.size(), 0);
    const auto nodes = static_cast<int>(offsets_.size()) - 1;
    // First the chains with ends, where not exactly two segments meet. What is left after them are closed chains.
    for (const bool closed : {false, true}) {
      for (int n = 0; n < nodes; ++n) {
        if (!closed && degree(n) == 2) continue;
        for (int i = offsets_[n]; i < offsets_[n + 1]; ++i) {
          if (!seen[at_node_[i]]) follow(chain(n, at_node_[i], seen), closed);
        }
      }
    }
  }

 private:
  int degree(int node) const { return offsets_[node + 1] - offsets_[node]; }

  std::vector<int> chain(int node, int segment, std::vector<char>& seen) const {
    const int start = node;
    std::vector<int> result{node};
    std::ptrdiff_t along = 0;
    while (true) {
      seen[segment] = 1;
      const auto& [a, b] = segments_[segment];
      along += node == a ? 1 : -1;
      node = node == a ? b : a;
      if (node == start && degree(node) == 2) break;
      result.push_back(node);
      if (degree(node) != 2) break;
      const int first = at_node_[offsets_[node]];
      segment = first == segment ? at_node_[offsets_[node] + 1] : first;
    }
    // Segments may disagree where triangles are flipped: the majority decides the direction.
    if (along < 0) std::reverse(result.begin(), result.end());
    return result;
  }

  const std::vector<Segment>& segments_;
  std::vector<int> offsets_, at_node_;  // segments at each node
};

}  // namespace

Lines lines(const mesh::Surface& surface, const TileCoordinates& coordinates, Execution& execution) {
  const EdgeNodes nodes = edge_nodes(surface, coordinates, execution);
  const int count = static_cast<int>(surface.triangles.size()), chunks = chunk_count(count);
  std::vector<std::vector<Segment>> parts(chunks);
  const double expected = static_cast<double>(nodes.codes.size()) + count;
  TaskProgress progress(execution, expected / kReportedPieces / 2, kReportedPieces * kPieceWork);
  run_throwing(execution.workers(), chunks, [&](int thread, int chunk) {
    parts[chunk] = segments(surface, coordinates, nodes, chunk * kChunk, std::min((chunk + 1) * kChunk, count),
                            [&] { progress(thread); });
  });
  std::vector<Segment> all;
  for (const auto& part : parts) all.insert(all.end(), part.begin(), part.end());
  if (coordinates.is_mirrored) {
    for (Segment& segment : all) std::swap(segment[0], segment[1]);
  }
  const Locations places = edge_locations(surface, nodes);
  execution.report(1);
  Lines result;
  Chains(all, static_cast<int>(places.triangles.size())).run([&](const std::vector<int>& chain, bool is_closed) {
    for (const int node : chain) result.points.push_back(places.triangles[node], places.barycentric[node]);
    result.offsets.push_back(static_cast<int>(result.points.triangles.size()));
    result.is_closed.push_back(is_closed);
  });
  return result;
}

}  // namespace holomorph::tiles
