#include "tiling/cones/transitions.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/constants.h"
#include "base/errors.h"
#include "linear/dense.h"
#include "linear/reduction.h"

namespace holomorph::tiling {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

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
  const linear::ReducedBasis reduced = linear::reduce(factor.upper());
  const VectorXd whole = linear::nearest_plane(reduced, factor.upper() * wanted).cast<double>();
  const VectorXd part = inverse * ((whole - wanted) * (kTwoPi / k));
  for (int side = 0; side < net.side_count(); ++side) rotation[side] += stars.row(side).dot(part);
}

// A tree of triangles; those of one polygon are reached together, across its diagonals, as they share their corners.
// @return the sides that it crosses, in turn
std::vector<int> tree_of(const mesh::Surface& surface, const Net& net) {
  std::vector<char> seen(net.triangle_count(), 0);
  std::vector<int> queue, crossed;
  const auto cross = [&](int side) {
    const int back = net.twin[side];
    if (back < 0 || seen[back / 3]) return;
    seen[back / 3] = 1;
    crossed.push_back(side);
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
  return crossed;
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
  const auto is_end = [&](int v) { return degree[v] == 1 && missing[v] == 0 && !net.on_boundary[v]; };
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

}  // namespace

std::optional<LineValues::Value> LineValues::find(int part) {
  if (!parent_[part]) return std::nullopt;
  std::vector<int> path;
  int root = part;
  for (; root >= 0 && above(root).part != root; root = above(root).part) path.push_back(root);
  // From the root's child on, so that each is by the root when the next asks.
  for (std::size_t i = path.size(); i-- > 0;) {
    Value& own = above(path[i]);
    if (own.part < 0 || own.part == root) continue;
    const Value& next = above(own.part);
    add_to(own.offset, next.offset, own.factor);
    own.factor *= next.factor;
    own.part = next.part;
  }
  return parent_[part];
}

LineValues::Value LineValues::resolved(const Value& value) {
  if (value.part < 0) return value;
  if (!parent_[value.part]) parent_[value.part] = Value{value.part, 1, {}};
  const std::optional<Value> found = find(value.part);
  Value result = held(found);
  for (auto& [number, multiple] : result.offset) multiple *= value.factor;
  result.factor *= value.factor;
  add_to(result.offset, value.offset);
  return result;
}

void LineValues::equate(const Value& first, const Value& second) {
  Value a = resolved(first), b = resolved(second);
  if (a.part < 0) std::swap(a, b);
  Multiples less = b.offset;  // what a's part is to be, beside that of b
  add_to(less, a.offset, -1);
  if (a.part < 0 || (a.part == b.part && a.factor == b.factor)) {
    equations_.push_back({{}, std::move(less)});
  } else if (a.part == b.part && whole_) {
    for (auto& [number, multiple] : less) multiple = -multiple;
    equations_.push_back({{{a.part, 2.0 * a.factor}}, std::move(less)});
  } else {
    const double part = a.part == b.part ? 0.5 * a.factor : a.factor;  // the factors are 1 or -1
    for (auto& [number, multiple] : less) multiple *= part;
    parent_[a.part] = Value{a.part == b.part ? -1 : b.part, a.factor * b.factor, std::move(less)};
  }
}

void LineValues::vanish(const Multiples& parts, Multiples offset) {
  for (const auto& [part, multiple] : parts) {
    if (!parent_[part]) parent_[part] = Value{part, 1, {}};
  }
  equations_.push_back({parts, std::move(offset)});
}

std::vector<int> LineValues::roots() {
  std::vector<int> result;
  for (int p = 0; p < static_cast<int>(parent_.size()); ++p) {
    if (parent_[p] && above(p).part == p) result.push_back(p);
  }
  return result;
}

std::vector<LineValues::Equation> LineValues::equations() {
  std::vector<Equation> result;
  for (const Equation& equation : equations_) {
    Equation& resolved = result.emplace_back(Equation{{}, equation.offset});
    for (const auto& [part, multiple] : equation.roots) {
      const std::optional<Value> found = find(part);
      const Value& value = held(found);
      add_to(resolved.offset, value.offset, multiple);
      if (value.part >= 0) resolved.roots[value.part] += multiple * value.factor;
    }
  }
  return result;
}

VectorXd log_scale(const Net& net, Laplace& laplace, int k, const std::vector<int>& missing) {
  MatrixXd b = MatrixXd::Zero(net.vertex_count(), 1);
  for (int v = 0; v < net.vertex_count(); ++v) {
    if (net.first[v] >= 0) b(v, 0) = kTwoPi * missing[v] / k - net.defect[v];
  }
  return laplace.solve(b).col(0);
}

std::vector<int> cut_frames(const mesh::Surface& surface, const Net& net, int k, const std::vector<int>& missing,
                            std::vector<double>& angle, std::vector<int>& turned) {
  std::vector<int> shift(net.triangle_count(), 0);
  std::vector<char> is_cut(net.side_count(), 0);
  for (int side = 0; side < net.side_count(); ++side) is_cut[side] = net.twin[side] >= 0;
  for (const int side : tree_of(surface, net)) {
    is_cut[side] = is_cut[net.twin[side]] = 0;
    shift[net.twin[side] / 3] = shift[side / 3] + turned[side];
  }
  for (int t = 0; t < net.triangle_count(); ++t) angle[t] += kTwoPi / k * shift[t];
  prune(net, missing, is_cut);
  std::vector<int> turn(net.side_count(), -1);
  for (int side = 0; side < net.side_count(); ++side) {
    if (net.twin[side] < 0) continue;
    const int left = turned[side] + shift[side / 3] - shift[net.twin[side] / 3];
    if (is_cut[side]) turn[side] = ((left % k) + k) % k;
    if (!is_cut[side] && left % k != 0) throw SolverError("the cones of a turned map do not fit its directions");
  }
  return turn;
}

Frames make_frames(const mesh::Surface& surface, const Net& net, int k, const std::vector<int>& missing) {
  Laplace laplace(net);
  Frames result;
  result.scale = log_scale(net, laplace, k, missing);
  std::vector<double> rotation(net.side_count(), 0.0);
  for (int side = 0; side < net.side_count(); ++side) {
    if (net.twin[side] < 0) continue;
    rotation[side] =
        net.transport[side] + net.weight[side] * (result.scale[net.head[side]] - result.scale[net.tail[side]]);
  }
  round_handles(net, laplace, k, rotation);
  result.angle.assign(net.triangle_count(), 0.0);
  for (const int side : tree_of(surface, net))
    result.angle[net.twin[side] / 3] = result.angle[side / 3] + rotation[side];
  std::vector<int> turned(net.side_count(), 0);
  for (int side = 0; side < net.side_count(); ++side) {
    if (net.twin[side] < 0) continue;
    const double turns = (result.angle[side / 3] + rotation[side] - result.angle[net.twin[side] / 3]) / (kTwoPi / k);
    turned[side] = static_cast<int>(std::lround(turns));
    if (!(std::abs(turns - turned[side]) < kExact))
      throw SolverError("the cones of a turned map do not fit its handles");
  }
  result.turn = cut_frames(surface, net, k, missing, result.angle, turned);
  return result;
}

}  // namespace holomorph::tiling
