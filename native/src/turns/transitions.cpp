#include "turns/transitions.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include "base/errors.h"
#include "linear/dense.h"

namespace holomorph::turns {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double kTwoPi = 2 * std::numbers::pi;
constexpr double kExact = 1e-3;  // k-th turns by which a turn may miss a whole one: rounding

// What is carried across a side beside the transport: the harmonic part of the connection, so that the handles turn by
// whole k-th turns. @param rotation #sides; changed
void round_handles(const Net& net, Laplace& laplace, int k, std::vector<double>& rotation) {
  const std::vector<std::vector<int>> loops = dual_loops(net);
  if (loops.empty()) return;
  const auto count = static_cast<Eigen::Index>(loops.size());
  // Closed forms dual to the loops, made harmonic; their stars are co-closed: nothing turns around a vertex.
  MatrixXd crossing = MatrixXd::Zero(net.side_count(), count), flow = MatrixXd::Zero(net.vertex_count(), count);
  for (Eigen::Index l = 0; l < count; ++l) {
    for (const int side : loops[l]) {
      crossing(side, l) += 1;
      crossing(net.twin[side], l) -= 1;
    }
  }
  for (int side = 0; side < net.side_count(); ++side) flow.row(net.tail[side]) += net.weight[side] * crossing.row(side);
  const MatrixXd f = laplace.solve(flow);
  MatrixXd stars(net.side_count(), count);
  for (int side = 0; side < net.side_count(); ++side) {
    const double weight = net.twin[side] < 0 ? 0 : net.weight[side];
    stars.row(side) = weight * (crossing.row(side) + f.row(net.head[side]) - f.row(net.tail[side]));
  }
  MatrixXd M = MatrixXd::Zero(count, count), energy = MatrixXd::Zero(count, count);
  VectorXd wanted(count);
  for (Eigen::Index l = 0; l < count; ++l) {
    double turned = 0;
    for (const int side : loops[l]) {
      M.row(l) += stars.row(side);
      turned += rotation[side];
    }
    wanted[l] = turned / (kTwoPi / k);
  }
  for (int side = 0; side < net.side_count(); ++side)
    energy += stars.row(side).transpose() * stars.row(side) / net.weight[side];
  // The nearest whole numbers by the energy of the harmonic part.
  const MatrixXd inverse = linear::inverse(M), S = inverse.transpose() * energy * inverse;
  const linear::Cholesky<MatrixXd> factor(S);
  if (!factor.succeeded()) throw SolverError("the turning of the handles has no least energy");
  const lattice::ReducedBasis reduced = lattice::reduce(factor.upper());
  const VectorXd whole = lattice::nearest_plane(reduced, factor.upper() * wanted).cast<double>();
  const VectorXd part = inverse * ((whole - wanted) * (kTwoPi / k));
  for (int side = 0; side < net.side_count(); ++side) rotation[side] += stars.row(side).dot(part);
}

// A tree of triangles; those of one polygon are reached together, across its diagonals, as they share their corners.
// Gives frames along it. @return #sides
std::vector<char> spread_frames(const mesh::Surface& surface, const Net& net, const std::vector<double>& rotation,
                                std::vector<double>& angle) {
  std::vector<char> in_tree(net.side_count(), 0), seen(net.triangle_count(), 0);
  std::vector<int> queue;
  angle.assign(net.triangle_count(), 0.0);
  const auto cross = [&](int side) {
    const int back = net.twin[side];
    if (back < 0 || seen[back / 3]) return;
    seen[back / 3] = 1;
    angle[back / 3] = angle[side / 3] + rotation[side];
    in_tree[side] = in_tree[back] = 1;
    queue.push_back(back / 3);
  };
  const auto complete = [&](std::size_t from) {  // the polygons of the triangles from here on
    for (; from < queue.size(); ++from) {
      for (int side = 3 * queue[from]; side < 3 * queue[from] + 3; ++side) {
        if (surface.is_diagonal(net.edge[side])) cross(side);
      }
    }
  };
  queue.push_back(0);
  seen[0] = 1;
  complete(0);
  for (std::size_t i = 0; i < queue.size(); ++i) {
    for (int side = 3 * queue[i]; side < 3 * queue[i] + 3; ++side) {
      const std::size_t from = queue.size();
      cross(side);
      complete(from);
    }
  }
  return in_tree;
}

// Takes the ends of the cut away that lead to no cone and no boundary. @param is_cut #sides; changed
void prune(const Net& net, const std::vector<int>& missing, std::vector<char>& is_cut) {
  std::vector<int> degree(net.vertex_count(), 0);
  std::vector<std::vector<int>> at(net.vertex_count());
  for (int side = 0; side < net.side_count(); ++side) {
    if (!is_cut[side]) continue;
    ++degree[net.tail[side]];
    at[net.tail[side]].push_back(side);
  }
  const auto is_end = [&](int v) { return degree[v] == 1 && missing[v] == 0 && net.hole[v] < 0; };
  std::vector<int> ends;
  for (int v = 0; v < net.vertex_count(); ++v) {
    if (is_end(v)) ends.push_back(v);
  }
  while (!ends.empty()) {
    const int v = ends.back();
    ends.pop_back();
    if (!is_end(v)) continue;
    for (const int side : at[v]) {
      if (!is_cut[side]) continue;
      const int w = net.head[side];
      is_cut[side] = is_cut[net.twin[side]] = 0;
      --degree[v], --degree[w];
      if (is_end(w)) ends.push_back(w);
    }
  }
}

// Numbers the segments of the cut between nodes: cones, ends, branchings and boundary vertices.
void find_segments(const Net& net, const Frames& frames, const std::vector<int>& missing, TurnedSpace& space,
                   int& count) {
  std::vector<std::vector<int>> at(net.vertex_count());
  for (int side = 0; side < net.side_count(); ++side) {
    if (frames.turn[side] >= 0) at[net.tail[side]].push_back(side);
  }
  std::vector<char> is_node(net.vertex_count(), 0);
  for (int v = 0; v < net.vertex_count(); ++v)
    is_node[v] = !at[v].empty() && (at[v].size() != 2 || missing[v] != 0 || net.hole[v] >= 0);
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

bool vanishes(const Combination& combination) {
  return std::ranges::all_of(combination, [](const auto& entry) { return entry.second.isZero(); });
}

// Rows of A z = 0, two for each combination that is to vanish.
lattice::IntegerMatrix equations(const std::vector<Combination>& combinations, int segments) {
  lattice::IntegerMatrix A = lattice::IntegerMatrix::Zero(2 * std::ssize(combinations), 2 * segments);
  for (std::size_t i = 0; i < combinations.size(); ++i) {
    for (const auto& [segment, multiple] : combinations[i])
      A.block<2, 2>(2 * static_cast<Eigen::Index>(i), 2 * segment) += multiple.cast<std::int64_t>();
  }
  return A;
}

Eigen::Matrix2d inverse(const Turn& turn) {
  const double determinant = turn(0, 0) * turn(1, 1) - turn(0, 1) * turn(1, 0);
  Eigen::Matrix2d result;
  result << turn(1, 1), -turn(0, 1), -turn(1, 0), turn(0, 0);
  return result / determinant;
}

}  // namespace

TurnLattice::TurnLattice(int order) : k(order), second(k == 6 ? std::polar(1.0, kTwoPi / 6) : Complex(0, 1)) {
  Turn one = Turn::Identity();
  if (k == 2) one = -one;
  if (k == 4) one << 0, -1, 1, 0;
  if (k == 6) one << 0, -1, 1, 1;
  powers.push_back(Turn::Identity());
  for (int r = 1; r < k; ++r) powers.push_back(one * powers.back());
}

Frames make_frames(const mesh::Surface& surface, const Net& net, int k, const std::vector<int>& missing) {
  Laplace laplace(net);
  MatrixXd b = MatrixXd::Zero(net.vertex_count(), 1);
  for (int v = 0; v < net.vertex_count(); ++v) {
    if (net.first[v] < 0) continue;
    b(v, 0) = kTwoPi * missing[v] / k - net.defect[v] - (net.hole[v] == v ? kTwoPi : 0);
  }
  Frames result;
  result.scale = laplace.solve(b).col(0);
  std::vector<double> rotation(net.side_count(), 0.0);
  for (int side = 0; side < net.side_count(); ++side) {
    if (net.twin[side] < 0) continue;
    rotation[side] =
        net.transport[side] + net.weight[side] * (result.scale[net.head[side]] - result.scale[net.tail[side]]);
  }
  round_handles(net, laplace, k, rotation);
  const std::vector<char> in_tree = spread_frames(surface, net, rotation, result.angle);
  std::vector<char> is_cut(net.side_count(), 0);
  for (int side = 0; side < net.side_count(); ++side) is_cut[side] = net.twin[side] >= 0 && !in_tree[side];
  prune(net, missing, is_cut);
  result.turn.assign(net.side_count(), -1);
  for (int side = 0; side < net.side_count(); ++side) {
    if (!is_cut[side] || in_tree[side]) continue;
    const double turned = (result.angle[side / 3] + rotation[side] - result.angle[net.twin[side] / 3]) / (kTwoPi / k);
    const double whole = std::round(turned);
    if (!(std::abs(turned - whole) < kExact)) throw SolverError("the cones of a turned map do not fit its handles");
    result.turn[side] = ((static_cast<int>(whole) % k) + k) % k;
  }
  return result;
}

Eigen::Matrix<std::int64_t, 2, 1> TurnedSpace::translation(int side, int turn, const lattice::IntegerVector& z) const {
  const Eigen::Matrix<std::int64_t, 2, 1> own = translations.middleRows<2>(2 * segment[side]) * z;
  if (along_segment[side]) return own;
  return -(lattice.power(turn).cast<std::int64_t>() * own);  // the inverse of x' = R^-turn x + own
}

TurnedSpace make_space(const Net& net, const Frames& frames, int k, const std::vector<int>& missing) {
  TurnedSpace space{TurnLattice(k), std::vector<int>(net.side_count(), 0), {}, {}, {}, {}, {}};
  int segments = 0;
  find_segments(net, frames, missing, space, segments);
  const TurnLattice& lattice = space.lattice;
  space.is_fixed.assign(net.vertex_count(), 0);
  std::vector<Combination> offsets(net.side_count()), to_vanish;
  std::vector<Eigen::Matrix2d> fixed(net.vertex_count());  // at a cone (1 - R)^-1
  std::vector<Combination> around(net.vertex_count());
  Combination pinned;
  for (int v = 0; v < net.vertex_count(); ++v) {
    int side = net.first[v];
    if (side < 0) continue;
    int turn = 0;
    Combination offset;
    for (;;) {
      space.corner_turn[side] = turn;
      offsets[side] = offset;
      const int in = Net::before(side), onwards = net.twin[in];
      if (onwards < 0) break;
      if (frames.turn[in] >= 0) {
        const int r = frames.turn[in], segment = space.segment[in];
        apply(lattice.power(r), offset);
        add(offset, segment, space.along_segment[in] ? Turn(Turn::Identity()) : Turn(-lattice.power(r)));
        turn = (turn + r) % k;
      }
      if (onwards == net.first[v]) break;
      side = onwards;
    }
    if (net.hole[v] >= 0) continue;  // nothing closes around it
    if (turn == 0) {
      if (!vanishes(offset)) to_vanish.push_back(std::move(offset));
      continue;
    }
    space.is_fixed[v] = 1;
    fixed[v] = inverse(Turn::Identity() - lattice.power(turn));
    if (pinned.empty()) pinned = offset;
    around[v] = std::move(offset);
  }
  // Without a cone the whole map may be moved: one vertex stays.
  if (std::ranges::none_of(space.is_fixed, [](char fixed) { return fixed; })) space.is_fixed[net.tail[0]] = 1;
  // One cone lies at 0, at which moving the whole map by the lattice changes nothing.
  if (!pinned.empty()) to_vanish.push_back(pinned);
  space.translations = to_vanish.empty() ? lattice::IntegerMatrix::Identity(2 * segments, 2 * segments)
                                         : lattice::integer_kernel(equations(to_vanish, segments));
  const auto unknowns = space.translations.cols();
  std::vector<Eigen::Triplet<double>> entries;
  const MatrixXd N = space.translations.cast<double>();
  for (int side = 0; side < net.side_count(); ++side) {
    const int v = net.tail[side];
    if (net.first[v] < 0) continue;
    MatrixXd rows = MatrixXd::Zero(2, unknowns);
    for (const auto& [segment, multiple] : offsets[side])
      rows += multiple.cast<double>() * N.middleRows<2>(2 * segment);
    if (!around[v].empty()) {
      const Eigen::Matrix2d place = lattice.power(space.corner_turn[side]).cast<double>() * fixed[v];
      for (const auto& [segment, multiple] : around[v])
        rows += place * multiple.cast<double>() * N.middleRows<2>(2 * segment);
    } else if (offsets[side].empty()) {
      continue;
    }
    for (Eigen::Index j = 0; j < unknowns; ++j) {
      for (int i = 0; i < 2; ++i) {
        if (rows(i, j) != 0) entries.emplace_back(2 * side + i, j, rows(i, j));
      }
    }
  }
  space.offset.resize(2 * net.side_count(), unknowns);
  space.offset.setFromTriplets(entries.begin(), entries.end());
  return space;
}

}  // namespace holomorph::turns
