// SPDX-License-Identifier: GPL-3.0-or-later
// cholmod_forms MESH [RUNS]: what the library is compared with from arrays to forms, as short as it can be: on a closed
// surface of triangles the 2g harmonic forms on its edges, their energies and wedge products, of which Omega is a few
// products of small matrices. Tree and cotree, CHOLMOD with OpenBLAS (as many threads as OPENBLAS_NUM_THREADS says),
// the surface's own triangles. A line of JSON for each run: seconds by the clock, of the user and of the system.
// Nothing is checked.
#include <Eigen/CholmodSupport>
#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cstdio>
#include <numeric>
#include <vector>

#include "linear_system.h"
#include "mesh/io/read.h"
#include "process_memory.h"

namespace {

using holomorph::benchmarks::now;
using holomorph::benchmarks::spent;
using Matrix = Eigen::SparseMatrix<double>;
using Points = std::vector<std::array<double, 3>>;
using Triangles = std::vector<std::array<int, 3>>;

struct Edges {
  std::vector<std::array<int, 2>> ends, faces;     // lower end first; on its left side, on the other
  std::vector<std::array<int, 3>> of_face, signs;  // side i runs from corner i to the next
};

Edges edges_of(const Triangles& triangles, int vertices) {
  std::vector<std::pair<std::int64_t, int>> sides;
  sides.reserve(3 * triangles.size());
  for (int s = 0; s < static_cast<int>(3 * triangles.size()); ++s) {
    const int a = triangles[s / 3][s % 3], b = triangles[s / 3][(s + 1) % 3];
    sides.emplace_back(static_cast<std::int64_t>(std::min(a, b)) * vertices + std::max(a, b), s);
  }
  std::sort(sides.begin(), sides.end());
  Edges edges;
  edges.of_face.resize(triangles.size());
  edges.signs.resize(triangles.size());
  for (std::size_t k = 0; k < sides.size(); k += 2) {
    const auto e = static_cast<int>(edges.ends.size());
    const auto low = static_cast<int>(sides[k].first / vertices);
    edges.ends.push_back({low, static_cast<int>(sides[k].first % vertices)});
    edges.faces.emplace_back();
    for (const int s : {sides[k].second, sides[k + 1].second}) {
      const bool is_along = triangles[s / 3][s % 3] == low;
      edges.of_face[s / 3][s % 3] = e;
      edges.signs[s / 3][s % 3] = is_along ? 1 : -1;
      edges.faces.back()[is_along ? 0 : 1] = s / 3;
    }
  }
  return edges;
}

// Marks the edges of a spanning tree of the graph, breadth first, over those that are not marked; parents by nodes.
std::vector<int> spanning_tree(int nodes, const std::vector<std::array<int, 2>>& ends, std::vector<char>& is_marked) {
  std::vector<int> start(nodes + 1), around(2 * ends.size()), parent(nodes, -1), queue{0};
  for (const auto& [a, b] : ends) ++start[a], ++start[b];
  std::partial_sum(start.begin(), start.end(), start.begin());
  for (int e = 0; e < static_cast<int>(ends.size()); ++e) around[--start[ends[e][0]]] = around[--start[ends[e][1]]] = e;
  std::vector<char> is_reached(nodes);
  is_reached[0] = 1;
  for (std::size_t i = 0; i < queue.size(); ++i) {
    for (int k = start[queue[i]]; k < start[queue[i] + 1]; ++k) {
      const int e = around[k], other = ends[e][0] + ends[e][1] - queue[i];
      if (is_marked[e] || is_reached[other]) continue;
      is_reached[other] = is_marked[e] = 1;
      parent[other] = e;
      queue.push_back(other);
    }
  }
  return parent;
}

// #E x 2g: how often the dual loop that each leftover edge closes crosses an edge.
Eigen::MatrixXd classes_of(const Edges& edges, int vertices, int faces) {
  std::vector<char> is_marked(edges.ends.size());
  const auto parent = spanning_tree(faces, edges.faces, is_marked);
  spanning_tree(vertices, edges.ends, is_marked);
  const auto count = std::count(is_marked.begin(), is_marked.end(), 0);
  Eigen::MatrixXd classes = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(edges.ends.size()), count);
  for (int e = 0, j = 0; e < static_cast<int>(edges.ends.size()); ++e) {
    if (is_marked[e]) continue;
    classes(e, j) = 1;
    for (const int side : {0, 1}) {
      for (int f = edges.faces[e][side]; parent[f] >= 0;) {
        const int p = parent[f];
        const bool is_left = edges.faces[p][0] == f;
        classes(p, j) += (side == 0) == is_left ? -1 : 1;
        f = edges.faces[p][is_left ? 1 : 0];
      }
    }
    ++j;
  }
  return classes;
}

Eigen::VectorXd weights_of(const Points& points, const Triangles& triangles, const Edges& edges) {
  Eigen::VectorXd weights = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(edges.ends.size()));
  const auto at = [&](int v) { return Eigen::Map<const Eigen::Vector3d>(points[v].data()); };
  for (std::size_t f = 0; f < triangles.size(); ++f) {
    for (int i = 0; i < 3; ++i) {
      const Eigen::Vector3d corner = at(triangles[f][(i + 2) % 3]);
      const Eigen::Vector3d u = at(triangles[f][i]) - corner, v = at(triangles[f][(i + 1) % 3]) - corner;
      weights[edges.of_face[f][i]] += u.dot(v) / (2 * u.cross(v).norm());
    }
  }
  return weights;
}

double run(const Points& points, const Triangles& triangles) {
  const auto n = static_cast<int>(points.size());
  const Edges edges = edges_of(triangles, n);
  Eigen::MatrixXd forms = classes_of(edges, n, static_cast<int>(triangles.size()));
  const Eigen::VectorXd weights = weights_of(points, triangles, edges);
  std::vector<Eigen::Triplet<double>> entries;
  entries.reserve(3 * edges.ends.size());
  Eigen::MatrixXd B = Eigen::MatrixXd::Zero(n, forms.cols());
  for (std::size_t e = 0; e < edges.ends.size(); ++e) {
    const auto [a, b] = edges.ends[e];
    if (a > 0) entries.emplace_back(b - 1, a - 1, -weights[e]), entries.emplace_back(a - 1, a - 1, weights[e]);
    entries.emplace_back(b - 1, b - 1, weights[e]);
    B.row(a) += weights[e] * forms.row(e);
    B.row(b) -= weights[e] * forms.row(e);
  }
  Matrix L(n - 1, n - 1);  // vertex 0 is pinned
  L.setFromTriplets(entries.begin(), entries.end());
  Eigen::CholmodSupernodalLLT<Matrix, Eigen::Lower> factor;
  factor.cholmod().nmethods = 1;
  factor.cholmod().method[0].ordering = CHOLMOD_AMD;
  factor.cholmod().postorder = 1;
  factor.compute(L);
  Eigen::MatrixXd functions = Eigen::MatrixXd::Zero(n, forms.cols());
  functions.bottomRows(n - 1) = factor.solve(B.bottomRows(n - 1));
  for (std::size_t e = 0; e < edges.ends.size(); ++e)
    forms.row(e) += functions.row(edges.ends[e][1]) - functions.row(edges.ends[e][0]);
  const Eigen::MatrixXd energies = forms.transpose() * weights.asDiagonal() * forms;
  Eigen::MatrixXd wedge = Eigen::MatrixXd::Zero(forms.cols(), forms.cols());
  for (std::size_t f = 0; f < triangles.size(); ++f) {
    const Eigen::VectorXd x = edges.signs[f][0] * forms.row(edges.of_face[f][0]);
    const Eigen::VectorXd y = edges.signs[f][1] * forms.row(edges.of_face[f][1]);
    wedge += (x * y.transpose() - y * x.transpose()) / 2;
  }
  const Eigen::MatrixXd star = wedge.inverse() * energies;
  return (star * star).trace();  // -2g where it is exact
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2) return 2;
  const auto polygons = holomorph::mesh::read(argv[1]);
  const Points points(polygons.vertices.begin(), polygons.vertices.end());
  Triangles triangles(polygons.corner_vertices.size() / 3);
  for (std::size_t c = 0; c < polygons.corner_vertices.size(); ++c)
    triangles[c / 3][c % 3] = polygons.corner_vertices[c];
  for (int i = 0; i < (argc > 2 ? std::atoi(argv[2]) : 1); ++i) {
    const double start = now();
    const auto before = spent();
    const double star = run(points, triangles);
    const auto after = spent();
    std::printf("{\"clock\": %.6f, \"user\": %.6f, \"system\": %.6f, \"star\": %.6f}\n", now() - start,
                after.first - before.first, after.second - before.second, star);
    std::fflush(stdout);
    holomorph::benchmarks::keep_memory();
  }
}
