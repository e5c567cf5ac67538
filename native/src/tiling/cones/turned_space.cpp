#include "tiling/cones/turned_space.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <utility>

#include "base/constants.h"
#include "base/errors.h"
#include "tiling/cones/transitions.h"

namespace holomorph::tiling {
namespace {

// Numbers the segments of the cut between nodes: cones, ends, branchings and boundary vertices.
void find_segments(const Net& net, const Frames& frames, const std::vector<int>& missing, TurnedSpace& space,
                   int& count) {
  std::vector<std::vector<int>> at(net.vertex_count());
  for (int side = 0; side < net.side_count(); ++side) {
    if (frames.turn[side] >= 0) at[net.tail[side]].push_back(side);
  }
  std::vector<char> is_node(net.vertex_count(), 0);
  for (int v = 0; v < net.vertex_count(); ++v)
    is_node[v] = !at[v].empty() && (at[v].size() != 2 || missing[v] != 0 || net.on_boundary[v]);
  space.segment.assign(net.side_count(), -1);
  space.along_segment.assign(net.side_count(), 0);
  count = 0;
  const auto trace = [&](int start) {
    for (int side = start; space.segment[side] < 0;) {
      space.segment[side] = space.segment[net.twin[side]] = count;
      space.along_segment[side] = 1;
      const int v = net.head[side];
      if (is_node[v]) break;
      for (const int onwards : at[v]) {
        if (space.segment[onwards] < 0) {
          side = onwards;
          break;
        }
      }
    }
    ++count;
  };
  for (int v = 0; v < net.vertex_count(); ++v) {
    if (!is_node[v]) continue;
    for (const int side : at[v]) {
      if (space.segment[side] < 0) trace(side);
    }
  }
  for (int side = 0; side < net.side_count(); ++side) {  // closed curves without a node
    if (frames.turn[side] < 0 || space.segment[side] >= 0) continue;
    is_node[net.tail[side]] = 1;
    trace(side);
  }
}

// The sum of multiples of the translations of segments.
using Combination = std::map<int, Turn>;

void apply(const Turn& turn, Combination& combination) {
  for (auto& [segment, multiple] : combination) multiple = turn * multiple;
}

void add(Combination& combination, int segment, const Turn& multiple) {
  const auto [place, is_new] = combination.try_emplace(segment, multiple);
  if (!is_new) place->second += multiple;
}

Eigen::Matrix2d inverse_of(const Turn& turn) {
  const double determinant = turn(0, 0) * turn(1, 1) - turn(0, 1) * turn(1, 0);
  Eigen::Matrix2d result;
  result << turn(1, 1), -turn(0, 1), -turn(1, 0), turn(0, 0);
  return result / determinant;
}

// One row of a combination, multiplied from the left.
Multiples row_of(const Eigen::RowVector2d& left, const Combination& combination) {
  Multiples result;
  for (const auto& [segment, multiple] : combination) {
    const Eigen::RowVector2d row = left * multiple.cast<double>();
    for (const int i : {0, 1}) {
      if (row[i] != 0) result[2 * segment + i] += row[i];
    }
  }
  return result;
}

const Eigen::RowVector2d kRows[] = {{1, 0}, {0, 1}};

// What the corners around vertices are turned and moved by, and what closes around them.
struct Corners {
  Corners(const Net& net, const Frames& frames, TurnedSpace& space);

  std::vector<Combination> offset;   // #sides
  std::vector<Combination> closing;  // #V, by what a vertex is moved on the way around it
  std::vector<int> turn;             // #V, by what it is turned then; 0 on the boundary
  // Where a cone is, a centre of the turns by itself, seen from a corner that is turned.
  Multiples at_cone(const Turn& turned, int part, int v, const TurnLattice& lattice) const {
    return row_of(kRows[part] * turned.cast<double>() * inverse_of(Turn::Identity() - lattice.power(turn[v])),
                  closing[v]);
  }
};

Corners::Corners(const Net& net, const Frames& frames, TurnedSpace& space)
    : offset(net.side_count()), closing(net.vertex_count()), turn(net.vertex_count(), 0) {
  const TurnLattice& lattice = space.lattice;
  for (int v = 0; v < net.vertex_count(); ++v) {
    int side = net.first[v], turned = 0;
    if (side < 0) continue;
    Combination moved;
    for (;;) {
      space.corner_turn[side] = turned;
      offset[side] = moved;
      const int in = Net::before(side), onwards = net.twin[in];
      if (onwards < 0) break;
      if (frames.turn[in] >= 0) {
        const int r = frames.turn[in], segment = space.segment[in];
        apply(lattice.power(r), moved);
        add(moved, segment, space.along_segment[in] ? Turn(Turn::Identity()) : Turn(-lattice.power(r)));
        turned = (turned + r) % lattice.k;
      }
      if (onwards == net.first[v]) break;
      side = onwards;
    }
    if (net.on_boundary[v]) continue;  // nothing closes around it
    turn[v] = turned;
    closing[v] = std::move(moved);
  }
}

// Fills in a TurnedSpace.
class Maker {
 public:
  Maker(const Net& net, const Frames& frames, int k, const std::vector<int>& missing, bool whole_lines)
      : net_(net),
        frames_(frames),
        whole_lines_(whole_lines),
        space_{TurnLattice(k), std::vector<int>(net.side_count(), 0), {}, {}, {}, {}, {}},
        on_line_(net.vertex_count(), 0),
        whole_part_(2 * static_cast<std::size_t>(net.vertex_count())),
        values_(net.vertex_count(), whole_lines) {
    find_segments(net, frames, missing, space_, segments_);
    corners_.emplace(net, frames, space_);
  }

  TurnedSpace made() {
    find_lines();
    find_whole_numbers();
    find_unknowns();
    find_offsets();
    return std::move(space_);
  }

 private:
  const Corners& corners() const { return held(corners_); }
  bool is_cone(int v) const { return corners().turn[v] != 0; }
  // A cone on a whole line is at whole numbers: they are unknowns, and (1 - R) x = what moves it.
  bool is_whole_cone(int v) const { return whole_lines_ && is_cone(v) && on_line_[v]; }
  const Turn& turned(int side) const { return space_.lattice.power(space_.corner_turn[side]); }

  // A part of x at the corner that a side leaves, beside y.
  Multiples moved(int side, int part) const {
    Multiples result = row_of(kRows[part], corners().offset[side]);
    const int v = net_.tail[side];
    if (is_cone(v) && !is_whole_cone(v)) add_to(result, corners().at_cone(turned(side), part, v, space_.lattice));
    return result;
  }

  // The same with y.
  LineValues::Value value_at(int side, int part) const {
    const int v = net_.tail[side];
    if (is_cone(v) && !is_whole_cone(v)) return {-1, 1, moved(side, part)};
    const int other = turned(side)(part, 0) != 0 ? 0 : 1;
    return {2 * v + other, turned(side)(part, other), moved(side, part)};
  }

  // One part of x is the same at both ends of a line's side.
  void find_lines() {
    for (int side = 0; side < net_.side_count(); ++side) {
      if (!net_.is_line[side]) continue;
      has_lines_ = true;
      on_line_[net_.tail[side]] = on_line_[net_.head[side]] = 1;
    }
    for (int side = 0; side < net_.side_count(); ++side) {
      const int back = net_.twin[side];
      if (!net_.is_line[side] || (back >= 0 && back < side) || !(net_.area[side / 3] > 0)) continue;
      const double angle = std::arg(net_.along[side]) - frames_.angle[side / 3];
      const int part = std::lround(angle / (kTwoPi / 4)) % 2 == 0 ? 1 : 0;  // along u the value of v is one
      values_.equate(value_at(side, part), value_at(Net::next(side), part));
    }
    for (int v = 0; v < net_.vertex_count(); ++v) {
      if (!is_whole_cone(v)) continue;
      const Turn left = Turn::Identity() - space_.lattice.power(corners().turn[v]);
      for (const int part : {0, 1}) {
        values_.vanish({{2 * v, left(part, 0)}, {2 * v + 1, left(part, 1)}},
                       row_of(-kRows[part], corners().closing[v]));
      }
    }
    roots_ = values_.roots();
    for (std::size_t i = 0; i < roots_.size(); ++i) number_of_[roots_[i]] = static_cast<int>(i);
  }

  // What is to be 0: around vertices that are no cones, and where lines close.
  std::vector<Multiples> equations() {
    std::vector<Multiples> rows;
    bool is_pinned = has_lines_ && whole_lines_;
    for (int v = 0; v < net_.vertex_count(); ++v) {
      if (corners().closing[v].empty() || is_whole_cone(v)) continue;
      // One cone lies at 0, at which moving the whole map by the lattice changes nothing.
      if (is_cone(v) && is_pinned) continue;
      is_pinned = is_pinned || is_cone(v);
      for (const Eigen::RowVector2d& row : kRows) rows.push_back(row_of(row, corners().closing[v]));
    }
    for (const LineValues::Equation& equation : values_.equations()) {
      Multiples& row = rows.emplace_back(equation.offset);
      for (const auto& [root, multiple] : equation.roots) row[2 * segments_ + number_of_.at(root)] += multiple;
      for (auto& [column, multiple] : row) multiple *= 2;  // there may be halves
    }
    std::erase_if(rows, [](Multiples& row) {
      std::erase_if(row, [](const auto& entry) { return entry.second == 0; });
      return row.empty();
    });
    return rows;
  }

  // Two a segment, and one a whole line.
  void find_whole_numbers() {
    const auto count = 2 * segments_ + (whole_lines_ ? std::ssize(roots_) : 0);
    const std::vector<Multiples> rows = equations();
    numbers_ = linear::IntegerMatrix::Identity(count, count);
    if (!rows.empty()) {
      linear::IntegerMatrix A = linear::IntegerMatrix::Zero(std::ssize(rows), count);
      for (std::size_t i = 0; i < rows.size(); ++i) {
        for (const auto& [column, multiple] : rows[i]) A(static_cast<Eigen::Index>(i), column) = std::llround(multiple);
      }
      numbers_ = linear::integer_kernel(A);
    }
    space_.translations = numbers_.topRows(2 * segments_);
  }

  // Without a cone the whole map may be moved: a part of each kind stays, that of a line first.
  std::array<int, 2> staying() const {
    if (!std::ranges::all_of(corners().turn, [](int turn) { return turn == 0; })) return {-1, -1};
    const int v = roots_.empty() ? net_.tail[0] : roots_[0] / 2;
    std::array<int, 2> result{2 * v, 2 * v + 1};
    for (auto root = roots_.rbegin(); root != roots_.rend(); ++root) result[*root % 2] = *root;
    return result;
  }

  // The parts of y that are unknowns, and what others have of whole numbers.
  void find_unknowns() {
    uv::Unknowns& unknowns = space_.unknowns;
    unknowns.number.assign(whole_part_.size(), -1);
    unknowns.sign.assign(whole_part_.size(), 1);
    std::map<int, int> of_line;
    const std::array<int, 2> stays = staying();
    for (int p = 0; p < static_cast<int>(whole_part_.size()); ++p) {
      if (net_.first[p / 2] < 0) continue;
      const std::optional<LineValues::Value> value = values_.find(p);
      const int root = value ? value->part : p;
      const bool moves = root >= 0 && std::ranges::find(stays, root) == stays.end();
      if (!value) {
        if (moves && !is_cone(p / 2)) unknowns.number[p] = unknowns.count++;
        continue;
      }
      whole_part_[p] = value->offset;
      if (root >= 0 && whole_lines_) {
        whole_part_[p][2 * segments_ + number_of_.at(root)] += value->factor;
      } else if (moves) {
        const auto [number, is_new] = of_line.try_emplace(root, unknowns.count);
        unknowns.count += is_new;
        unknowns.number[p] = number->second;
        unknowns.sign[p] = static_cast<signed char>(value->factor);
      }
    }
  }

  void find_offsets() {
    std::vector<Eigen::Triplet<double>> entries;
    const Eigen::MatrixXd N = numbers_.cast<double>();
    for (int side = 0; side < net_.side_count(); ++side) {
      const int v = net_.tail[side];
      if (net_.first[v] < 0) continue;
      for (const int part : {0, 1}) {
        Multiples row = moved(side, part);
        for (const int other : {0, 1}) add_to(row, whole_part_[2 * v + other], turned(side)(part, other));
        if (row.empty()) continue;
        Eigen::RowVectorXd sum = Eigen::RowVectorXd::Zero(N.cols());
        for (const auto& [column, multiple] : row) sum += multiple * N.row(column);
        for (Eigen::Index j = 0; j < sum.size(); ++j) {
          if (sum[j] != 0) entries.emplace_back(2 * side + part, j, sum[j]);
        }
      }
    }
    space_.offset.resize(2 * net_.side_count(), N.cols());
    space_.offset.setFromTriplets(entries.begin(), entries.end());
  }

  const Net& net_;
  const Frames& frames_;
  const bool whole_lines_;
  TurnedSpace space_;
  int segments_ = 0;
  std::optional<Corners> corners_;
  bool has_lines_ = false;
  std::vector<char> on_line_;          // #V
  std::vector<Multiples> whole_part_;  // of y, 2 #V
  LineValues values_;
  std::vector<int> roots_;         // of lines
  std::map<int, int> number_of_;   // of a line, by its root
  linear::IntegerMatrix numbers_;  // N, and those of whole lines
};

}  // namespace

TurnLattice::TurnLattice(int order) : k(order), second(k == 6 ? std::polar(1.0, kTwoPi / 6) : Complex(0, 1)) {
  Turn one = Turn::Identity();
  if (k == 2) one = -one;
  if (k == 4) one << 0, -1, 1, 0;
  if (k == 6) one << 0, -1, 1, 1;
  powers.push_back(Turn::Identity());
  for (int r = 1; r < k; ++r) powers.push_back(one * powers.back());
}

Eigen::Matrix<std::int64_t, 2, 1> TurnedSpace::translation(int side, int turn, const linear::IntegerVector& z) const {
  const Eigen::Matrix<std::int64_t, 2, 1> own = translations.middleRows<2>(2 * segment[side]) * z;
  if (along_segment[side]) return own;
  return -(lattice.power(turn).cast<std::int64_t>() * own);  // the inverse of x' = R^-turn x + own
}

TurnedSpace make_space(const Net& net, const Frames& frames, int k, const std::vector<int>& missing, bool whole_lines) {
  return Maker(net, frames, k, missing, whole_lines).made();
}

}  // namespace holomorph::tiling
