#include "structure/pole_choice.h"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <string>

#include "base/errors.h"
#include "mesh/components.h"
#include "mesh/stars.h"
#include "mesh/surface_walk.h"

namespace holomorph::structure {
namespace {

// The sum of the residues may differ from 0 by rounding, relative to the sum of their sizes.
constexpr double kSumTolerance = 1e-12;
// Steps of the search for two far vertices. A pair whose distance still grows after these is far enough apart.
constexpr int kMostSteps = 8;

std::string text(std::complex<double> z) {
  std::ostringstream out;
  out << z.real();
  if (z.imag() != 0) out << (z.imag() > 0 ? " + " : " - ") << std::abs(z.imag()) << "i";
  return out.str();
}

// The vertex with a free star at the largest distance; -1 if there is none.
int farthest(const mesh::Surface& surface, const mesh::HalfEdges& half_edges, const std::vector<double>& distance,
             const std::vector<char>& taken) {
  std::vector<int> order;
  for (int v = 0; v < static_cast<int>(distance.size()); ++v) {
    if (std::isfinite(distance[v])) order.push_back(v);
  }
  // The first few of a sorted order are enough: a heap gives them one by one.
  const auto nearer = [&](int a, int b) { return distance[a] != distance[b] ? distance[a] < distance[b] : a > b; };
  std::make_heap(order.begin(), order.end(), nearer);
  for (; !order.empty(); order.pop_back()) {
    std::pop_heap(order.begin(), order.end(), nearer);
    if (mesh::has_free_star(surface, half_edges, order.back(), taken)) return order.back();
  }
  return -1;
}

std::string label(const Poles& poles, int vertex) {
  return std::to_string(poles.labels.empty() ? vertex : poles.labels[vertex]);
}

void check_vertices(const Poles& poles, int vertex_count, bool closed) {
  const auto& vertices = poles.vertices;
  std::vector<char> met(vertex_count, 0);
  for (const int v : vertices) {
    if (v < 0 || v >= vertex_count)
      throw TopologyError("pole " + std::to_string(v) + " is not a vertex: there are " + std::to_string(vertex_count));
    if (std::exchange(met[v], 1)) throw TopologyError("pole " + label(poles, v) + " is given twice");
  }
  if (closed && vertices.size() == 1) {
    throw TopologyError("pole " + label(poles, vertices[0]) +
                        " is the only one: a closed surface needs at least two, as the residues sum to 0");
  }
}

void check_residues(const Poles& poles, bool closed) {
  const auto& residues = poles.residues;
  if (residues.size() != poles.vertices.size()) {
    throw TopologyError("there are " + std::to_string(residues.size()) + " residues for " +
                        std::to_string(poles.vertices.size()) + " poles");
  }
  std::complex<double> sum = 0;
  double size = 0;
  for (std::size_t i = 0; i < residues.size(); ++i) {
    if (!(std::abs(residues[i]) > 0) || !std::isfinite(std::abs(residues[i])))
      throw TopologyError("residue " + std::to_string(i) + " is " + text(residues[i]) +
                          "; finite numbers other than 0 are needed");
    sum += residues[i];
    size += std::abs(residues[i]);
  }
  if (closed && std::abs(sum) > kSumTolerance * size)
    throw TopologyError("the residues sum to " + text(sum) + "; on a closed surface they must sum to 0");
}

}  // namespace

std::vector<int> far_apart(const mesh::Surface& surface, const mesh::HalfEdges& half_edges) {
  const std::vector<char> nothing(surface.vertex_count, 0);
  const auto distances = [&](int v) { return mesh::graph_distances(half_edges, surface.edge_lengths, {v}); };
  // Any vertex does as a start, as in the double sweep for the diameter of a graph.
  int p = farthest(surface, half_edges, distances(0), nothing);
  std::vector<int> best;
  double apart = 0;
  // Repeated farthest points. The distance grows strictly, so that no pair recurs.
  for (int step = 0; p >= 0 && step < kMostSteps; ++step) {
    const std::vector<double> distance = distances(p);
    std::vector<char> taken = nothing;
    mesh::mark_star(surface, half_edges, p, taken);
    const int q = farthest(surface, half_edges, distance, taken);
    if (q < 0 || !(distance[q] > apart)) break;
    apart = distance[q];
    best = {std::min(p, q), std::max(p, q)};
    p = q;
  }
  if (best.empty())
    throw TopologyError(
        "the mesh is too coarse for two poles: the faces around any two vertices meet; subdivide the mesh");
  return best;
}

int deepest_vertex(const mesh::Surface& surface, const mesh::HalfEdges& half_edges) {
  const std::vector<int> boundary = mesh::boundary_vertices(mesh::boundary_loops(surface, half_edges));
  const std::vector<double> distance = mesh::graph_distances(half_edges, surface.edge_lengths, boundary);
  const int deepest = farthest(surface, half_edges, distance, std::vector<char>(surface.vertex_count, 0));
  if (deepest < 0)
    throw TopologyError("every vertex is next to the boundary: there is no room for a pole; subdivide the mesh");
  return deepest;
}

std::vector<std::complex<double>> default_residues(const mesh::Surface& surface, const mesh::HalfEdges& half_edges,
                                                   const std::vector<int>& vertices, bool closed,
                                                   Execution& execution) {
  std::vector<std::complex<double>> residues(vertices.size(), 1.0);
  if (!closed || vertices.empty()) return residues;
  // The residues must sum to 0. So the pole that is farthest from the others, by the sum of distances, takes what
  // balances the ones; of two poles it is the second.
  std::size_t last = vertices.size() - 1;
  if (vertices.size() > 2) {
    std::vector<double> sum(vertices.size(), 0.0);
    for (std::size_t from = 0; from < vertices.size(); ++from) {
      execution.report(static_cast<double>(from) / static_cast<double>(vertices.size()));
      const std::vector<double> distance = mesh::graph_distances(half_edges, surface.edge_lengths, {vertices[from]});
      for (std::size_t i = 0; i < vertices.size(); ++i) sum[i] += distance[vertices[i]];
    }
    last = static_cast<std::size_t>(std::max_element(sum.begin(), sum.end()) - sum.begin());
  }
  residues[last] = -static_cast<double>(vertices.size() - 1);
  return residues;
}

void check_poles(const Poles& poles, int vertex_count, bool closed) {
  check_vertices(poles, vertex_count, closed);
  if (!poles.residues.empty()) check_residues(poles, closed);
}

}  // namespace holomorph::structure
