// One triangle, cut along the lines between tiles.
#pragma once

#include <algorithm>
#include <cstdint>
#include <functional>
#include <limits>
#include <map>
#include <utility>

#include "tiles/tile_coordinates.h"

namespace holomorph::tiles {

// Where edges cross the lines between tiles.

/// Tile coordinates as far as combinatorics need them: 2 m where one is the whole number m, 2 m + 1 between m and m
/// + 1.
using Code = std::array<std::int64_t, 2>;

inline bool is_line(std::int64_t code) { return code % 2 == 0; }

/// The nodes on edge e are offsets[e] .. offsets[e + 1] - 1. They follow side i of the first triangle t at the edge,
/// with 3 t + i = sides[e]. An edge that ends at a pole has none.
struct EdgeNodes {
  std::vector<int> sides;       ///< #E
  std::vector<int> offsets;     ///< #E + 1
  std::vector<Code> codes;      ///< in that triangle
  std::vector<double> weights;  ///< of the end of the side, strictly between 0 and 1
};

/// Finds the nodes strictly between the ends of each edge, in an order that is decided exactly. A crossing of two lines
/// at one point is one node.
/// Cost: linear in edges and nodes. @throws SolverError for too many
EdgeNodes edge_nodes(const mesh::Surface& surface, const TileCoordinates& coordinates, Execution& execution);

/// Returns the code of a point, whose coordinates are integers.
Code code_of(const Point& point, double unit);

/// A corner of a piece of a triangle, and the segment from it to the next one, counter-clockwise as the triangle.
struct PieceCorner {
  int node;
  int segment;
  Code code;
  Point at;  ///< tile coordinates in this triangle, whole numbers where the code says so
};
using Piece = std::vector<PieceCorner>;

/// Along which lines triangles are cut. Bricks: the rows, and in each every other column, from an even one on in even
/// rows.
enum class Pattern { columns, grid, bricks };

inline constexpr int kReportedPieces = 256;
inline constexpr double kPieceWork = 500;  ///< operations for a piece

/// Nodes: the vertices, then those on edges, in their order; inside of triangles they are ~0, ~1 ... in the order in
/// which they are found. Segments: edge e has segments(e) and following, one more than nodes; inside of triangles they
/// are ~0, ~1 ... as well. Only integers are compared, so pieces of neighbouring triangles fit, whatever the UVs are.
class TriangleCut {
 public:
  struct Inside {
    int triangle;
    Code code;
  };

  /// @param report is called every kReportedPieces, and may throw
  TriangleCut(const mesh::Surface& surface, const TileCoordinates& coordinates, const EdgeNodes& edge_nodes,
              Pattern pattern, std::function<void()> report)
      : surface_(surface),
        coordinates_(coordinates),
        edge_nodes_(edge_nodes),
        pattern_(pattern),
        report_(std::move(report)) {}

  /// The pieces of triangle t, valid until the next is cut. One that touches a pole stays whole.
  const std::vector<Piece>& cut(int t);

  const std::vector<Inside>& nodes() const { return nodes_; }
  int segment_count() const { return segment_count_; }
  int segments(int edge) const { return edge_nodes_.offsets[edge] + edge; }
  bool has_pole(int t) const;
  /// The turn from the triangle that was cut to the first one at the edge of the segment; 0 for one inside.
  int turn(int segment) const;

  /// Whether the segment from one corner to the next lies on a line.
  bool is_on_line(const PieceCorner& from, const PieceCorner& to) const {
    return (from.code[0] == to.code[0] && is_line(from.code[0]) && has_column(from.code[0], row(from, to))) ||
           (pattern_ != Pattern::columns && from.code[1] == to.code[1] && is_line(from.code[1]));
  }
  /// The cell between lines that a column and a row of the grid are in.
  Code cell(const Code& low, const Code& high) const;

 private:
  static constexpr int kRow = std::numeric_limits<int>::min();  // a segment on a row, not yet cut by columns

  void count_piece();
  Piece outline(int t) const;
  void append_side(int t, int i, Piece& ring) const;
  void cut_along(int axis, Piece whole, std::vector<Piece>& pieces);
  Piece with_crossings(const Piece& row);
  PieceCorner crossing(std::int64_t column, std::int64_t row);
  static std::int64_t between(std::int64_t low, std::int64_t high) { return (low == high ? low : low | 1) >> 1; }
  static std::int64_t row(const PieceCorner& a, const PieceCorner& b) {
    return between(std::min(a.code[1], b.code[1]), std::max(a.code[1], b.code[1]));
  }
  bool has_column(std::int64_t code, std::int64_t row) const {
    return pattern_ != Pattern::bricks || ((code / 2 + row) & 1) == 0;
  }
  void name_rows();

  const mesh::Surface& surface_;
  const TileCoordinates& coordinates_;
  const EdgeNodes& edge_nodes_;
  Pattern pattern_;
  std::function<void()> report_;
  int made_ = 0;  // pieces
  int triangle_ = 0;
  std::vector<Piece> pieces_;
  std::vector<Inside> nodes_;
  int segment_count_ = 0;
  std::map<Code, int> crossings_, row_segments_;  // of this triangle
};

}  // namespace holomorph::tiles
