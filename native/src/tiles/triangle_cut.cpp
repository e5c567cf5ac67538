#include "tiles/triangle_cut.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "base/workers.h"

namespace holomorph::tiles {
namespace {

constexpr double kBytesOfNode = 150;  // a node, here and where it lies

// The lines of one coordinate that a side crosses, one after the other.
class Crossings {
 public:
  Crossings(double from, double to, double unit) : from_(from), length_(std::abs(to - from)), unit_(unit) {
    step_ = to > from ? 1 : -1;
    const double first = from / unit, last = to / unit;
    // Lines strictly between the ends: one through an end is not a crossing.
    next_ = step_ > 0 ? std::floor(first) + 1 : std::ceil(first) - 1;
    left_ = step_ > 0 ? std::ceil(last) - next_ : next_ - std::floor(last);
    const auto whole = static_cast<std::int64_t>(std::floor(first));
    code_ = first == std::floor(first) ? 2 * whole : 2 * whole + 1;
    if (length_ > 0 && is_line(code_)) code_ += step_;  // behind the start
  }

  bool done() const { return !(left_ > 0); }
  double count() const { return std::max(left_, 0.0); }
  double length() const { return length_; }
  /// From the start to the next line.
  double distance() const { return std::abs(next_ * unit_ - from_); }
  /// Between lines.
  std::int64_t code() const { return code_; }
  /// The code on the next line, behind which it then is.
  std::int64_t cross() {
    const std::int64_t line = 2 * static_cast<std::int64_t>(next_);
    code_ = line + step_;
    next_ += step_;
    --left_;
    return line;
  }

 private:
  double from_, length_, unit_, next_ = 0, left_ = 0;
  std::int64_t code_ = 0;
  int step_ = 1;
};

// Appends the nodes between a and b.
void cross(const Point& a, const Point& b, double unit, std::vector<Code>& codes, std::vector<double>& weights) {
  Crossings x(a[0], b[0], unit), y(a[1], b[1], unit);
  while (!x.done() || !y.done()) {
    // Compares distance / length of both without a division, and so exactly: less than 0 where the line of x comes
    // first.
    const double order = x.done() ? 1 : y.done() ? -1 : determinant(x.distance(), x.length(), y.distance(), y.length());
    weights.push_back(order <= 0 ? x.distance() / x.length() : y.distance() / y.length());
    Code code{x.code(), y.code()};
    if (order <= 0) code[0] = x.cross();
    if (order >= 0) code[1] = y.cross();
    codes.push_back(code);
  }
}

std::vector<int> first_sides(const mesh::Surface& surface) {
  std::vector<int> sides(surface.edges.size());
  for (int t = static_cast<int>(surface.triangles.size()) - 1; t >= 0; --t) {
    for (int i = 0; i < 3; ++i) sides[surface.triangle_edges[t][i]] = 3 * t + i;
  }
  return sides;
}

double place_of(std::int64_t code) { return static_cast<double>(code) / 2; }

}  // namespace

Code code_of(const Point& point, double unit) {
  Code code;
  for (int i = 0; i < 2; ++i) {
    const double whole = std::floor(point[i] / unit);
    code[i] = 2 * static_cast<std::int64_t>(whole) + (whole * unit == point[i] ? 0 : 1);
  }
  return code;
}

EdgeNodes edge_nodes(const mesh::Surface& surface, const TileCoordinates& coordinates, Execution& execution) {
  const int count = static_cast<int>(surface.edges.size()), chunks = chunk_count(count);
  const double unit = coordinates.unit;
  EdgeNodes result{first_sides(surface), std::vector<int>(count + 1, 0), {}, {}};
  const auto ends = [&](int e) {
    const int t = result.sides[e] / 3, i = result.sides[e] % 3;
    return std::pair{coordinates.points[t][i], coordinates.points[t][(i + 1) % 3]};
  };
  const auto is_crossed = [&](int e) {
    const auto& [a, b] = surface.edges[e];
    return !coordinates.is_pole[a] && !coordinates.is_pole[b];
  };
  // Counted before memory is taken.
  const double most = sum_over_rows(execution.workers(), count, 0.0, [&](int e, double& sum) {
    const auto [a, b] = ends(e);
    if (is_crossed(e)) sum += Crossings(a[0], b[0], unit).count() + Crossings(a[1], b[1], unit).count();
  });
  refuse_too_many(surface, most, kBytesOfNode, "places where edges cross lines of tiles");
  std::vector<EdgeNodes> parts(chunks);
  run_throwing(execution.workers(), chunks, [&](int chunk) {
    auto& part = parts[chunk];
    for (int e = chunk * kChunk, end = std::min(e + kChunk, count); e < end; ++e) {
      const std::size_t before = part.codes.size();
      const auto [a, b] = ends(e);
      if (is_crossed(e)) cross(a, b, unit, part.codes, part.weights);
      result.offsets[e + 1] = static_cast<int>(part.codes.size() - before);
    }
  });
  for (int e = 0; e < count; ++e) result.offsets[e + 1] += result.offsets[e];
  result.codes.reserve(result.offsets.back());
  result.weights.reserve(result.offsets.back());
  for (const EdgeNodes& part : parts) {
    result.codes.insert(result.codes.end(), part.codes.begin(), part.codes.end());
    result.weights.insert(result.weights.end(), part.weights.begin(), part.weights.end());
  }
  return result;
}

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
      corner.at[x] =
          is_line(corner.code[x]) ? place_of(corner.code[x]) : place[x] + static_cast<double>(translation[x]);
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
  return {found->second, kRow, code, {place_of(column), place_of(row)}};
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
