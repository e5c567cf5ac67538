#include "tiling/pole_vertices.h"

#include <set>

namespace holomorph::tiling {

PoleVertices::PoleVertices(const Landscape& landscape, const AbelJacobi& abel_jacobi, const std::vector<char>& allowed)
    : landscape_(landscape), abel_jacobi_(abel_jacobi), allowed_(allowed) {}

bool PoleVertices::is_allowed(int vertex) const {
  return (allowed_.empty() || allowed_[vertex]) && landscape_.is_certain(vertex) &&
         mesh::has_proper_star(landscape_.surface(), landscape_.half_edges(), vertex);
}

std::vector<int> PoleVertices::corners_around(int vertex) const {
  return mesh::corners_around(landscape_.surface(), landscape_.half_edges(), vertex);
}

std::vector<int> PoleVertices::around(int vertex, std::size_t most) const {
  const auto& mesh = landscape_.half_edges();
  std::vector<int> queue{vertex};
  std::set<int> seen{vertex};
  for (std::size_t next = 0; next < queue.size() && queue.size() < most; ++next) {
    const mesh::HalfedgeHandle first = mesh.halfedge_handle(mesh::VertexHandle(queue[next]));
    mesh::HalfedgeHandle h = first;
    do {
      const int v = mesh::to_vertex(mesh, h);
      if (seen.insert(v).second) queue.push_back(v);
      h = mesh::next(mesh, mesh::opposite(h));
    } while (h != first);
  }
  std::erase_if(queue, [&](int v) { return !is_allowed(v); });
  return queue;
}

Eigen::VectorXd PoleVertices::part(int vertex, const Eigen::VectorXd& near) const {
  return nearest_representative(abel_jacobi_.at(vertex), near);
}

bool are_apart(const std::vector<int>& a, const std::vector<int>& b) {
  for (auto x = a.begin(), y = b.begin(); x != a.end() && y != b.end();) {
    if (*x == *y) return false;
    ++(*x < *y ? x : y);
  }
  return true;
}

}  // namespace holomorph::tiling
