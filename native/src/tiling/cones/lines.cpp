#include "tiling/cones/lines.h"

#include <algorithm>
#include <cmath>

#include "base/constants.h"
#include "base/errors.h"
#include "mesh/union_find.h"
#include "solver/direct/sparse_cholesky.h"
#include "tiling/cones/scale_form.h"

namespace holomorph::tiling {
namespace {

constexpr double kLong = 0.5;         // roots of the area: chains that are shorter are details
constexpr double kMostTurned = 3;     // full turns of a boundary loop, to and fro: others are jagged
constexpr double kPullOfField = 0.1;  // with which the field is pulled level
// By which a cone's price is multiplied: pairs of cones also turn the field away from lines, which the cost does not
// say.
constexpr double kPrice = 12;
constexpr double kRegularFrame = 1e-9;  // weight of a frame anywhere

// Each vertex's patch between the lines, and on lines and on the boundary beside them -1 - v.
std::vector<int> patches(const Net& net) {
  std::vector<int> patch(net.vertex_count(), 0);
  for (int side = 0; side < net.side_count(); ++side) {
    if (!net.is_line[side]) continue;
    for (const int v : {net.tail[side], net.head[side]}) patch[v] = -1 - v;
  }
  for (int v = 0; v < net.vertex_count(); ++v) {
    if (net.on_boundary[v] && net.hole[v] < 0) patch[v] = -1 - v;
  }
  mesh::UnionFind chains(net.vertex_count());
  for (int side = 0; side < net.side_count(); ++side) {
    if (patch[net.tail[side]] == 0 && patch[net.head[side]] == 0) chains.join(net.tail[side], net.head[side]);
  }
  for (int v = 0; v < net.vertex_count(); ++v) {
    if (patch[v] == 0) patch[v] = chains.lowest(v);
  }
  return patch;
}

// Moves cones within patches: on the way k-th turns are added across edges. @param turned #sides; changed
void move_cones(const Net& net, const std::vector<int>& patch, const std::vector<int>& from, const std::vector<int>& to,
                std::vector<int>& turned) {
  std::vector<int> needed(net.vertex_count(), 0), before(net.vertex_count(), -1), via(net.vertex_count(), -1), order;
  std::vector<std::vector<int>> around(net.vertex_count());  // sides that leave a vertex, or enter along the boundary
  for (int v = 0; v < net.vertex_count(); ++v) needed[v] = to[v] - from[v];
  for (int side = 0; side < net.side_count(); ++side) {
    if (patch[net.tail[side]] < 0 || patch[net.tail[side]] != patch[net.head[side]]) continue;
    around[net.tail[side]].push_back(side);
    if (net.twin[side] < 0) around[net.head[side]].push_back(side);
  }
  std::vector<char> seen(net.vertex_count(), 0);
  for (int v = 0; v < net.vertex_count(); ++v) {
    if (patch[v] < 0 || seen[v]) continue;
    seen[v] = 1;
    order.push_back(v);
    for (std::size_t i = order.size() - 1; i < order.size(); ++i) {
      for (const int side : around[order[i]]) {
        const int w = net.head[side] == order[i] ? net.tail[side] : net.head[side];
        if (seen[w]) continue;
        seen[w] = 1;
        before[w] = order[i];
        via[w] = net.twin[side] < 0 ? -1 : side;  // along the boundary nothing is turned
        order.push_back(w);
      }
    }
  }
  for (std::size_t i = order.size(); i-- > 0;) {
    const int v = order[i], n = needed[v];
    if (n == 0) continue;
    if (before[v] < 0) throw SolverError("the cones of a turned map have left their patch");
    needed[before[v]] += n;
    if (via[v] < 0) continue;
    turned[via[v]] += n;
    turned[net.twin[via[v]]] -= n;
  }
}

// The angles that minimise sum of weight (angle_g - angle_f - rotation + (2 pi / k) turned)^2 and stay at the lines,
// where the rotation is that of the metric with log scale u. @param angle #T, of the field; changed
void straighten(const Net& net, const Eigen::VectorXd& u, int k, const std::vector<int>& turned,
                std::vector<double>& angle) {
  const int count = net.triangle_count();
  std::vector<char> is_held(count, 0);
  for (int side = 0; side < net.side_count(); ++side) {
    if (net.is_line[side] && net.area[side / 3] > 0) is_held[side / 3] = 1;
  }
  std::vector<Eigen::Triplet<double>> entries;
  Eigen::MatrixXd b = Eigen::MatrixXd::Zero(count, 1);
  for (int t = 0; t < count; ++t) {
    const double weight = is_held[t] ? kHeld : kRegularFrame;
    entries.emplace_back(t, t, weight);
    b(t, 0) = weight * angle[t];
  }
  for (int side = 0; side < net.side_count(); ++side) {
    if (net.twin[side] < side) continue;
    const int f = side / 3, g = net.twin[side] / 3;
    if (f == g) continue;
    const double w = dual_weight(net, side);
    const double rotation = net.transport[side] + net.weight[side] * (u[net.head[side]] - u[net.tail[side]]);
    const double difference = rotation - kTwoPi / k * turned[side];
    entries.emplace_back(f, f, w);
    entries.emplace_back(g, g, w);
    entries.emplace_back(std::max(f, g), std::min(f, g), -w);
    b(f, 0) -= w * difference;
    b(g, 0) += w * difference;
  }
  Eigen::SparseMatrix<double> lower(count, count);
  lower.setFromTriplets(entries.begin(), entries.end());
  solver::SparseCholesky factor;
  factor.compute(lower, {});
  const Eigen::MatrixXd x = factor.solve(b);
  for (int t = 0; t < count; ++t) {
    if (!is_held[t]) angle[t] = x(t, 0);
  }
}

}  // namespace

std::vector<int> long_lines(const mesh::Surface& surface, const std::vector<int>& hard) {
  const Net net(surface);
  std::vector<char> is_line(surface.edges.size(), 0);
  for (const int e : hard) is_line[e] = 1;
  std::vector<double> turning(net.vertex_count(), 0.0);  // of a boundary loop, at its lowest vertex
  for (int v = 0; v < net.vertex_count(); ++v) {
    if (net.hole[v] >= 0) turning[net.hole[v]] += std::abs(net.defect[v] - (net.hole[v] == v ? kTwoPi : 0));
  }
  for (int side = 0; side < net.side_count(); ++side) {
    if (net.twin[side] < 0) is_line[net.edge[side]] = turning[net.hole[net.tail[side]]] <= kMostTurned * kTwoPi;
  }
  mesh::UnionFind chains(net.vertex_count());
  std::vector<double> length(net.vertex_count(), 0.0);
  for (std::size_t e = 0; e < surface.edges.size(); ++e) {
    if (is_line[e]) chains.join(surface.edges[e][0], surface.edges[e][1]);
  }
  for (std::size_t e = 0; e < surface.edges.size(); ++e) {
    if (is_line[e]) length[chains.lowest(surface.edges[e][0])] += surface.edge_lengths[e];
  }
  std::vector<int> edges;
  for (std::size_t e = 0; e < surface.edges.size(); ++e) {
    if (is_line[e] && length[chains.lowest(surface.edges[e][0])] > kLong * std::sqrt(net.whole_area))
      edges.push_back(static_cast<int>(e));
  }
  return edges;
}

Frames lined_frames(const mesh::Surface& surface, const Net& net, const ConeOptions& options, std::vector<int>& missing,
                    Execution& execution) {
  execution.stage("cones", 0, 0.8);
  execution.report(0);
  const int k = options.k;
  const Along along = options.along.value_or(Along{{0, 0, 1}});
  const std::vector<Complex> field =
      level_field(net, surface.polygons.vertices, k, along, options.along ? kPullOfField : 0.0);
  const std::vector<int> found = cones_of_field(net, field, k);
  Frames frames;
  frames.angle.resize(net.triangle_count());
  for (int t = 0; t < net.triangle_count(); ++t) frames.angle[t] = std::arg(field[t]) / k;
  std::vector<int> turned(net.side_count(), 0);
  for (int side = 0; side < net.side_count(); ++side) {
    const int back = net.twin[side];
    if (back < side) continue;
    const double turns = (frames.angle[side / 3] + net.transport[side] - frames.angle[back / 3]) / (kTwoPi / k);
    turned[side] = static_cast<int>(std::lround(turns));
    turned[back] = -turned[side];
  }
  const std::vector<int> patch = patches(net);
  ConeOptions dear = options;
  dear.price *= kPrice;
  missing = cones_in_patches(surface, net, patch, found, dear, execution).missing;
  move_cones(net, patch, found, missing, turned);
  Laplace laplace(net);
  frames.scale = log_scale(net, laplace, k, missing);
  straighten(net, frames.scale, k, turned, frames.angle);
  frames.turn = cut_frames(surface, net, k, missing, frames.angle, turned);
  return frames;
}

}  // namespace holomorph::tiling
