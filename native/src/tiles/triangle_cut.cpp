#include "tiles/triangle_cut.h"

#include <algorithm>
#include <cassert>

namespace holomorph::tiles {
namespace {

double middle(std::int64_t code) { return static_cast<double>(code) / 2; }

}  // namespace

bool TriangleCut::has_pole(int t) const {
  const auto& [a, b, c] = surface_.triangles[t];
  return coordinates_.is_pole[a] || coordinates_.is_pole[b] || coordinates_.is_pole[c];
}

void TriangleCut::count_piece() {
  if (++made_ % kReportedPieces == 0) report_();
}

const std::vector<Piece>& TriangleCut::cut(int t) {
  count_piece();
  triangle_ = t;
  crossings_.clear();
  row_segments_.clear();
  pieces_.clear();
  Piece whole = outline(t);
  if (has_pole(t)) {
    pieces_.push_back(std::move(whole));
  } else if (pattern_ == Pattern::columns) {
    cut_along(0, std::move(whole), pieces_);
  } else {
    std::vector<Piece> rows;
    cut_along(1, std::move(whole), rows);
    for (const Piece& row : rows) cut_along(0, with_crossings(row), pieces_);
    name_rows();
  }
  return pieces_;
}

Piece TriangleCut::outline(int t) const {
  Piece ring;
  const double unit = coordinates_.unit;
  for (int i = 0; i < 3; ++i) {
    const Point& p = coordinates_.points[t][i];
    ring.push_back({surface_.triangles[t][i], 0, code_of(p, unit), {p[0] / unit, p[1] / unit}});
    append_side(t, i, ring);
  }
  return ring;
}

int TriangleCut::turn(int segment) const {
  for (int i = 0; i < 3; ++i) {
    const int e = surface_.triangle_edges[triangle_][i];
    const bool is_on_edge = segments(e) <= segment && segment < segments(e + 1);
    if (is_on_edge && edge_nodes_.sides[e] != 3 * triangle_ + i) return coordinates_.turns.across(3 * triangle_ + i);
  }
  return 0;
}

// Appends the nodes of side i, and names its segments from the last corner on. An edge lists its nodes along the side
// of its first triangle; seen from the other one they are reversed, and moved by the transition.
void TriangleCut::append_side(int t, int i, Piece& ring) const {
  const int e = surface_.triangle_edges[t][i], begin = edge_nodes_.offsets[e], end = edge_nodes_.offsets[e + 1];
  const int first = edge_nodes_.sides[e] / 3, side = edge_nodes_.sides[e] % 3, count = end - begin;
  const bool along = first == t && side == i;
  ring.back().segment = segments(e) + (along ? 0 : count);
  if (count == 0) return;
  const double unit = coordinates_.unit;
  const Point &a = coordinates_.points[first][side], &b = coordinates_.points[first][(side + 1) % 3];
  const auto [turn, translation] = transition(coordinates_, along ? 0 : coordinates_.turns.across(3 * first + side), b,
                                              coordinates_.points[t][along ? (i + 1) % 3 : i]);
  const Eigen::Matrix2d& power = coordinates_.group.power(turn);
  for (int j = 0; j < count; ++j) {
    const int k = along ? j : count - 1 - j;
    const Code& here = edge_nodes_.codes[begin + k];
    PieceCorner corner{surface_.vertex_count + begin + k, segments(e) + (along ? k + 1 : k), {}, {}};
    Eigen::Vector2d place;
    for (int x = 0; x < 2; ++x) place[x] = (a[x] + edge_nodes_.weights[begin + k] * (b[x] - a[x])) / unit;
    place = power * place;
    for (int x = 0; x < 2; ++x) {
      // Codes are 2 x where x is whole, and lie halfway between others: they turn as x does.
      const double code = power(x, 0) * static_cast<double>(here[0]) + power(x, 1) * static_cast<double>(here[1]);
      corner.code[x] = static_cast<std::int64_t>(code) + 2 * translation[x];
      // On a line the coordinate is exact, not that of the rounded place on the edge.
      corner.at[x] = is_line(corner.code[x]) ? middle(corner.code[x]) : place[x] + static_cast<double>(translation[x]);
    }
    ring.push_back(corner);
  }
}

// Every crossing of a line is a corner. Along the outline of a convex piece, also of one without area, codes ascend and
// descend once: between two lines there is one part of either side.
void TriangleCut::cut_along(int axis, Piece whole, std::vector<Piece>& pieces) {
  Code low = whole[0].code, high = low;
  for (const PieceCorner& corner : whole) {
    for (int x = 0; x < 2; ++x) {
      low[x] = std::min(low[x], corner.code[x]);
      high[x] = std::max(high[x], corner.code[x]);
    }
  }
  const std::int64_t row = between(low[1], high[1]);
  std::size_t up = 0, down = 0;  // the corners of the last cut: where codes ascend, and where they descend
  const auto code = [&](std::size_t i) { return whole[i % whole.size()].code[axis]; };
  // Lines have even codes. Those strictly between the lowest and the highest corner cut the piece.
  for (std::int64_t line = low[axis] + 2 - (low[axis] & 1); line < high[axis]; line += 2) {
    if (axis == 0 && !has_column(line, row)) continue;
    count_piece();
    Piece below;
    if (down == 0) {
      while (code(up) != line || code(up + 1) <= line) ++up;
      std::ranges::rotate(whole, whole.begin() + static_cast<std::ptrdiff_t>(up));
      up = 0;
      for (down = 1; code(down) > line;) ++down;
      below.assign(whole.begin() + static_cast<std::ptrdiff_t>(down), whole.end());
      below.push_back(whole[0]);
    } else {
      const std::size_t last_up = up, last_down = down;
      while (code(up + 1) <= line) ++up;
      while (code(down - 1) <= line) --down;
      const auto at = [&](std::size_t i) { return whole.begin() + static_cast<std::ptrdiff_t>(i); };
      below.assign(at(down), at(last_down + 1));
      below.insert(below.end(), at(last_up), at(up + 1));
    }
    assert(code(up) == line && code(down) == line);
    const int segment = axis == 1 ? kRow : ~segment_count_++;
    below.back().segment = whole[down].segment = segment;
    pieces.push_back(std::move(below));
  }
  if (down != 0) {
    whole.erase(whole.begin() + static_cast<std::ptrdiff_t>(down) + 1, whole.end());
    whole.erase(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(up));
  }
  pieces.push_back(std::move(whole));
}

// Adds a corner wherever a column crosses the rows below and above, also for columns of the pieces on the other side.
Piece TriangleCut::with_crossings(const Piece& row) {
  Piece ring;
  for (std::size_t i = 0; i < row.size(); ++i) {
    ring.push_back(row[i]);
    if (row[i].segment != kRow) continue;
    const std::int64_t from = row[i].code[0], to = row[(i + 1) % row.size()].code[0], step = to > from ? 2 : -2;
    // The next line after a corner on one is a step away. After a corner between two it is half a step away.
    const std::int64_t first = is_line(from) ? from + step : from + step / 2;
    for (std::int64_t line = first; (to - line) * step > 0; line += step)
      ring.push_back(crossing(line, row[i].code[1]));
  }
  return ring;
}

Code TriangleCut::cell(const Code& low, const Code& high) const {
  const std::int64_t column = between(low[0], high[0]), row = between(low[1], high[1]);
  return {has_column(2 * column, row) ? column : column - 1, row};
}

// The node where a column crosses a row inside the triangle, the same for all pieces there.
PieceCorner TriangleCut::crossing(std::int64_t column, std::int64_t row) {
  assert(is_line(row));
  const Code code{column, row};
  const auto [found, is_new] = crossings_.try_emplace(code, ~static_cast<int>(nodes_.size()));
  if (is_new) nodes_.push_back({triangle_, code});
  return {found->second, kRow, code, {middle(column), middle(row)}};
}

// Names the segments on rows. A row has the same corners on both sides, so its segments are known by their middles.
void TriangleCut::name_rows() {
  for (Piece& piece : pieces_) {
    for (std::size_t i = 0; i < piece.size(); ++i) {
      if (piece[i].segment != kRow) continue;
      const std::int64_t from = piece[i].code[0], to = piece[(i + 1) % piece.size()].code[0];
      const std::int64_t column = from == to ? from : std::min(from, to) | 1;
      const auto [found, is_new] = row_segments_.try_emplace({column, piece[i].code[1]}, ~segment_count_);
      if (is_new) ++segment_count_;
      piece[i].segment = found->second;
    }
  }
}

}  // namespace holomorph::tiles
