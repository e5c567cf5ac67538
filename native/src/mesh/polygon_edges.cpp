#include "mesh/polygon_edges.h"

#include <algorithm>
#include <string>

#include "base/errors.h"

namespace holomorph::mesh {
namespace {

using std::to_string;

struct Side {
  int higher;  // the higher of its two vertices
  int corner;
};

// All sides, grouped by their lower vertex (counting sort) and sorted by (higher vertex, corner) in each group.
void sort_sides(const Polygons& mesh, const std::vector<int>& face_of, std::vector<Side>& sides,
                std::vector<int>& first) {
  const int corner_count = static_cast<int>(mesh.corner_vertices.size());
  const auto ends = [&](int corner) {
    const auto a = static_cast<int>(mesh.corner_vertices[corner]);
    const auto b = static_cast<int>(mesh.corner_vertices[next_corner(mesh, face_of[corner], corner)]);
    return Pair{std::min(a, b), std::max(a, b)};
  };
  first.assign(mesh.vertices.size() + 1, 0);
  for (int c = 0; c < corner_count; ++c) ++first[ends(c)[0] + 1];
  for (std::size_t v = 0; v + 1 < first.size(); ++v) first[v + 1] += first[v];
  sides.resize(corner_count);
  std::vector<int> next(first.begin(), first.end() - 1);
  for (int c = 0; c < corner_count; ++c) {
    const auto [lower, higher] = ends(c);
    sides[next[lower]++] = {higher, c};
  }
  for (std::size_t v = 0; v + 1 < first.size(); ++v) {
    std::sort(sides.begin() + first[v], sides.begin() + first[v + 1], [](const Side& a, const Side& b) {
      return a.higher != b.higher ? a.higher < b.higher : a.corner < b.corner;
    });
  }
}

std::vector<std::int64_t> sorted_vertices(const Polygons& mesh, int face) {
  std::vector<std::int64_t> v(mesh.corner_vertices.begin() + mesh.face_offsets[face],
                              mesh.corner_vertices.begin() + mesh.face_offsets[face + 1]);
  std::sort(v.begin(), v.end());
  return v;
}

// Duplicate faces share every edge, so it is enough to compare the faces at each edge.
void check_duplicates(const Polygons& mesh, const std::vector<int>& face_of, const Side* begin, const Side* end) {
  for (const Side* a = begin; a != end; ++a) {
    for (const Side* b = a + 1; b != end; ++b) {
      const int f = face_of[a->corner], g = face_of[b->corner];
      const auto size = [&](int face) { return mesh.face_offsets[face + 1] - mesh.face_offsets[face]; };
      if (f == g || size(f) != size(g)) continue;
      if (size(f) == 3) {  // the usual case without a sort: the third corners
        const auto sum = [&](int face) {
          const auto* v = &mesh.corner_vertices[mesh.face_offsets[face]];
          return v[0] + v[1] + v[2];
        };
        if (sum(f) != sum(g)) continue;
      }
      if (sorted_vertices(mesh, f) == sorted_vertices(mesh, g)) {
        throw InvalidMesh("faces " + to_string(std::min(f, g)) + " and " + to_string(std::max(f, g)) +
                          " have the same vertices");
      }
    }
  }
}

}  // namespace

std::vector<int> corner_faces(const Polygons& mesh) {
  std::vector<int> face_of(mesh.corner_vertices.size());
  for (std::size_t f = 0; f + 1 < mesh.face_offsets.size(); ++f) {
    std::fill(face_of.begin() + mesh.face_offsets[f], face_of.begin() + mesh.face_offsets[f + 1], static_cast<int>(f));
  }
  return face_of;
}

PolygonEdges polygon_edges(const Polygons& mesh) {
  const std::vector<int> face_of = corner_faces(mesh);
  std::vector<Side> sides;
  std::vector<int> first;
  sort_sides(mesh, face_of, sides, first);

  PolygonEdges result;
  result.side_edge.resize(sides.size());
  for (std::size_t v = 0; v + 1 < first.size(); ++v) {
    for (int i = first[v], j; i < first[v + 1]; i = j) {
      for (j = i + 1; j < first[v + 1] && sides[j].higher == sides[i].higher;) ++j;
      const int edge = static_cast<int>(result.edges.size());
      if (j - i > 1) check_duplicates(mesh, face_of, &sides[i], &sides[i] + (j - i));
      if (j - i > 2) {
        throw InvalidMesh("edge " + to_string(edge) + " (vertices " + to_string(v) + ", " + to_string(sides[i].higher) +
                          ") has " + to_string(j - i) + " faces; a surface has at most 2");
      }
      for (int k = i; k < j; ++k) result.side_edge[sides[k].corner] = edge;
      result.edges.push_back({static_cast<int>(v), sides[i].higher});
      result.edge_sides.push_back({sides[i].corner, j - i == 2 ? sides[i + 1].corner : -1});
    }
  }
  return result;
}

std::vector<int> boundary_loop_of_vertex(const PolygonEdges& edges, int vertex_count) {
  std::vector<int> loop(vertex_count, -1);
  const auto find = [&loop](int v) {
    while (loop[v] != v) v = loop[v] = loop[loop[v]];
    return v;
  };
  for (std::size_t e = 0; e < edges.edges.size(); ++e) {
    if (edges.edge_sides[e][1] >= 0) continue;
    for (const int v : edges.edges[e]) {
      if (loop[v] < 0) loop[v] = v;
    }
    const int a = find(edges.edges[e][0]), b = find(edges.edges[e][1]);
    loop[std::max(a, b)] = std::min(a, b);
  }
  for (int v = 0; v < vertex_count; ++v) {
    if (loop[v] >= 0) loop[v] = find(v);
  }
  return loop;
}

}  // namespace holomorph::mesh
