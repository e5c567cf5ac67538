#include "tiles/pieces.h"

#include <algorithm>

#include "base/task_progress.h"
#include "base/workers.h"

namespace holomorph::tiles {
namespace {

constexpr double kBytesOfPiece = 500;  // a piece, with the cell that it is joined to

// The pieces of one chunk of triangles: inside nodes and segments are named ~0, ~1 ...
struct Part {
  Pieces pieces;
  std::vector<TriangleCut::Inside> nodes;
  int segment_count = 0;
};

class Cutting {
 public:
  Cutting(const mesh::Surface& surface, const TileCoordinates& coordinates, const EdgeNodes& edge_nodes,
          Pattern pattern)
      : surface_(surface), coordinates_(coordinates), edge_nodes_(edge_nodes), pattern_(pattern) {}

  Part part(int begin, int end, const std::function<void()>& report) const {
    TriangleCut cut(surface_, coordinates_, edge_nodes_, pattern_, report);
    Part result;
    for (int t = begin; t < end; ++t) {
      const int pole = pole_of(t);
      for (const Piece& piece : cut.cut(t)) append(piece, pole, cut, result.pieces);
    }
    result.nodes = cut.nodes();
    result.segment_count = cut.segment_count();
    return result;
  }

  std::array<double, 3> weights(const TriangleCut::Inside& node) const {
    const auto& p = coordinates_.points[node.triangle];
    const Point x{static_cast<double>(node.code[0] / 2) * coordinates_.unit,
                  static_cast<double>(node.code[1] / 2) * coordinates_.unit};
    std::array<double, 3> result;
    double sum = 0;
    // Barycentric coordinates are areas: the signs are exact, so no weight is negative by rounding.
    for (int i = 0; i < 3; ++i) sum += result[i] = orientation(p[(i + 1) % 3], p[(i + 2) % 3], x);
    for (double& weight : result) weight /= sum;
    return result;
  }

 private:
  int pole_of(int t) const {
    for (const int v : surface_.triangles[t]) {
      if (coordinates_.is_pole[v]) return v;
    }
    return kNone;
  }

  // Appends a piece. `is_wall` is by sides until all segments are known.
  static void append(const Piece& piece, int pole, const TriangleCut& cut, Pieces& pieces) {
    Code low = piece[0].code, high = low;
    for (std::size_t i = 0; i < piece.size(); ++i) {
      const PieceCorner &corner = piece[i], &next = piece[(i + 1) % piece.size()];
      for (int x = 0; x < 2; ++x) {
        low[x] = std::min(low[x], corner.code[x]);
        high[x] = std::max(high[x], corner.code[x]);
      }
      pieces.side_nodes.push_back(corner.node);
      pieces.side_segments.push_back(corner.segment);
      pieces.side_turns.push_back(cut.turn(corner.segment));
      pieces.side_points.push_back(corner.at);
      // In the star of a pole only the link is a wall: its triangles become one polygon.
      const bool is_link = pole != kNone && corner.node != pole && next.node != pole;
      pieces.is_wall.push_back(is_link || (pole == kNone && cut.is_on_line(corner, next)));
    }
    pieces.offsets.push_back(static_cast<int>(pieces.side_nodes.size()));
    pieces.tiles.push_back(cut.cell(low, high));
    pieces.poles.push_back(pole);
  }

  const mesh::Surface& surface_;
  const TileCoordinates& coordinates_;
  const EdgeNodes& edge_nodes_;
  Pattern pattern_;
};

// Appends the pieces of a chunk, whose inside nodes and segments follow those before; then `segments` is known.
void append_part(Pieces& all, const Part& part, const Cutting& cutting, int& segments) {
  const int first_node = static_cast<int>(all.nodes.triangles.size()), first_side = all.offsets.back();
  const auto named = [](int name, int first) { return name < 0 ? first + ~name : name; };
  for (const TriangleCut::Inside& node : part.nodes) all.nodes.push_back(node.triangle, cutting.weights(node));
  for (const int node : part.pieces.side_nodes) all.side_nodes.push_back(named(node, first_node));
  for (const int segment : part.pieces.side_segments) all.side_segments.push_back(named(segment, segments));
  segments += part.segment_count;
  for (std::size_t p = 1; p < part.pieces.offsets.size(); ++p)
    all.offsets.push_back(first_side + part.pieces.offsets[p]);
  const auto join = [](auto& list, const auto& more) { list.insert(list.end(), more.begin(), more.end()); };
  join(all.side_turns, part.pieces.side_turns);
  join(all.side_points, part.pieces.side_points);
  join(all.tiles, part.pieces.tiles);
  join(all.poles, part.pieces.poles);
}

}  // namespace

Locations edge_locations(const mesh::Surface& surface, const EdgeNodes& edge_nodes) {
  Locations result;
  result.triangles.assign(surface.vertex_count, 0);
  result.barycentric.assign(surface.vertex_count, {0, 0, 0});
  // Downwards, so that a vertex ends with the first of its triangles.
  for (int t = static_cast<int>(surface.triangles.size()) - 1; t >= 0; --t) {
    for (int i = 0; i < 3; ++i) {
      const int v = surface.triangles[t][i];
      result.triangles[v] = t;
      result.barycentric[v] = {0, 0, 0};
      result.barycentric[v][i] = 1;
    }
  }
  for (std::size_t e = 0; e < surface.edges.size(); ++e) {
    const int t = edge_nodes.sides[e] / 3, i = edge_nodes.sides[e] % 3;
    for (int k = edge_nodes.offsets[e]; k < edge_nodes.offsets[e + 1]; ++k) {
      std::array<double, 3> weights{};
      weights[(i + 1) % 3] = edge_nodes.weights[k];
      weights[i] = 1 - edge_nodes.weights[k];
      result.push_back(t, weights);
    }
  }
  return result;
}

Pieces pieces(const mesh::Surface& surface, const TileCoordinates& coordinates, const EdgeNodes& edge_nodes,
              Pattern pattern, Execution& execution) {
  const Cutting cutting(surface, coordinates, edge_nodes, pattern);
  const int count = static_cast<int>(surface.triangles.size()), chunks = chunk_count(count);
  const double inside =
      sum_over_rows(execution.workers(), count, 0.0, [&](int t, double& sum) { sum += tiles_in(coordinates, t); });
  const double most = inside + edge_nodes.offsets.back() + count;
  refuse_too_many(surface, most, kBytesOfPiece, "pieces of tiles");
  TaskProgress progress(execution, most / kReportedPieces / 2, kReportedPieces * kPieceWork);
  std::vector<Part> parts(chunks);
  run_throwing(execution.workers(), chunks, [&](int thread, int chunk) {
    parts[chunk] = cutting.part(chunk * kChunk, std::min((chunk + 1) * kChunk, count), [&] { progress(thread); });
  });
  Pieces all;
  all.nodes = edge_locations(surface, edge_nodes);
  all.group = coordinates.group;
  if (pattern == Pattern::bricks) all.middle[0] = 1;
  int segments = edge_nodes.offsets.back() + static_cast<int>(surface.edges.size());
  for (const Part& part : parts) {
    execution.report(1);
    append_part(all, part, cutting, segments);
  }
  all.is_wall.assign(segments, 0);
  std::size_t side = 0;
  for (const Part& part : parts) {
    for (const char is_wall : part.pieces.is_wall) all.is_wall[all.side_segments[side++]] |= is_wall;
  }
  // All segments of boundary edges are walls. An edge with k nodes has k + 1 segments, so that those of edge e begin at
  // offsets[e] + e.
  for (int e = 0; e < static_cast<int>(surface.edges.size()); ++e) {
    if (surface.edge_face_count[e] == 2) continue;
    for (int s = edge_nodes.offsets[e] + e; s <= edge_nodes.offsets[e + 1] + e; ++s) all.is_wall[s] = 1;
  }
  return all;
}

}  // namespace holomorph::tiles
