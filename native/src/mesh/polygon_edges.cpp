#include "mesh/polygon_edges.h"

#include <algorithm>
#include <numeric>
#include <string>
#include <tuple>
#include <utility>

#include "base/errors.h"
#include "base/page_allocator.h"
#include "base/workers.h"

namespace holomorph::mesh {
namespace {

using std::to_string;

struct PolygonSide {
  int lower, higher;    // its two vertices
  int directed_corner;  // 2 x its corner, + 1 where it runs from the higher vertex to the lower one
  unsigned vertex_sum;  // sum over its polygon: equal where two polygons have the same vertices

  int corner() const { return directed_corner >> 1; }
  bool runs_down() const { return (directed_corner & 1) != 0; }
};

// Calls each(side) for the sides of the polygons begin .. end-1.
template <class Each>
void each_side(const Polygons& mesh, int begin, int end, const Each& each) {
  for (int f = begin; f < end; ++f) {
    const int first = mesh.face_offsets[f], last = mesh.face_offsets[f + 1];
    unsigned sum = 0;
    for (int c = first; c < last; ++c) sum += static_cast<unsigned>(mesh.corner_vertices[c]);
    for (int c = first; c < last; ++c) {
      const int a = mesh.corner_vertices[c], b = mesh.corner_vertices[c + 1 == last ? first : c + 1];
      each(PolygonSide{std::min(a, b), std::max(a, b), 2 * c + (a > b ? 1 : 0), sum});
    }
  }
}

// Sides by blocks of lower vertices, in each block in the order of the corners.
class Blocks {
 public:
  Blocks(const Polygons& mesh, Workers& workers)
      : sides_(mesh.corner_vertices.size()),
        vertex_count_(static_cast<int>(mesh.vertices.size())),
        size_(std::max(kChunk, (vertex_count_ + kMost - 1) / kMost)) {
    const int faces = static_cast<int>(mesh.face_offsets.size()) - 1, batch = 4 * kChunk;
    const int batches = (faces + batch - 1) / batch;
    // Place in each block for the next side of each batch of polygons.
    std::vector<std::vector<int>> place(batches, std::vector<int>(count(), 0));
    const auto sides_of = [&](int i, const auto& each) {
      each_side(mesh, i * batch, std::min((i + 1) * batch, faces), each);
    };
    workers.run(batches,
                [&](int, int i) { sides_of(i, [&](const PolygonSide& side) { ++place[i][side.lower / size_]; }); });
    int sum = 0;
    for (int block = 0; block < count(); ++block) {
      start_.push_back(sum);
      for (int i = 0; i < batches; ++i) sum += std::exchange(place[i][block], sum);
    }
    start_.push_back(sum);
    workers.run(batches, [&](int, int i) {
      sides_of(i, [&](const PolygonSide& side) { sides_[place[i][side.lower / size_]++] = side; });
    });
  }

  int count() const { return (vertex_count_ + size_ - 1) / size_; }
  const PolygonSide* begin(int block) const { return sides_.data() + start_[block]; }
  const PolygonSide* end(int block) const { return sides_.data() + start_[block + 1]; }

  // Sorts a block by (lower, higher, corner): by counting, and then the few sides of each lower vertex.
  void sort(int block) {
    const int first_vertex = block * size_, vertices = std::min(size_, vertex_count_ - first_vertex);
    const std::vector<PolygonSide> given(begin(block), end(block));
    std::vector<int> end_of(vertices + 1, 0);
    for (const PolygonSide& side : given) ++end_of[side.lower - first_vertex + 1];
    std::partial_sum(end_of.begin(), end_of.end(), end_of.begin());
    PolygonSide *const sides = sides_.data() + start_[block], *first = sides;
    for (const PolygonSide& side : given) sides[end_of[side.lower - first_vertex]++] = side;
    for (int v = 0; v < vertices; ++v) {
      std::sort(first, sides + end_of[v], [](const PolygonSide& a, const PolygonSide& b) {
        return a.higher != b.higher ? a.higher < b.higher : a.directed_corner < b.directed_corner;
      });
      first = sides + end_of[v];
    }
  }

 private:
  static constexpr int kMost = 256;

  Array<PolygonSide> sides_;
  std::vector<int> start_;  // start of each block, and the end
  int vertex_count_, size_;
};

// Calls each(begin, end) for the sides of each edge of a sorted block, until it answers false.
template <class Each>
void each_edge(const Blocks& blocks, int block, const Each& each) {
  const PolygonSide* const last = blocks.end(block);
  for (const PolygonSide *side = blocks.begin(block), *end = side; side != last; side = end) {
    while (end != last && end->lower == side->lower && end->higher == side->higher) ++end;
    if (!each(side, end)) return;
  }
}

std::vector<int> sorted_vertices(const Polygons& mesh, int face) {
  std::vector<int> v(mesh.corner_vertices.begin() + mesh.face_offsets[face],
                     mesh.corner_vertices.begin() + mesh.face_offsets[face + 1]);
  std::sort(v.begin(), v.end());
  return v;
}

int polygon_of(const Polygons& mesh, const PolygonSide& side) {
  const auto& offsets = mesh.face_offsets;
  return static_cast<int>(std::upper_bound(offsets.begin(), offsets.end(), side.corner()) - offsets.begin()) - 1;
}

// Two polygons with the same vertices among those at an edge, the lower first; or {-1, -1}.
Pair duplicates(const Polygons& mesh, const PolygonSide* begin, const PolygonSide* end) {
  for (const PolygonSide* a = begin; a != end; ++a) {
    for (const PolygonSide* b = a + 1; b != end; ++b) {
      if (a->vertex_sum != b->vertex_sum) continue;
      const int f = polygon_of(mesh, *a), g = polygon_of(mesh, *b);
      if (f != g && sorted_vertices(mesh, f) == sorted_vertices(mesh, g)) return {std::min(f, g), std::max(f, g)};
    }
  }
  return {-1, -1};
}

[[noreturn]] void refuse(const Polygons& mesh, const MeshLabels& label, const PolygonSide* begin,
                         const PolygonSide* end) {
  const auto [f, g] = duplicates(mesh, begin, end);
  if (f >= 0) throw InvalidMesh("faces " + label.face(f) + " and " + label.face(g) + " have the same vertices");
  throw InvalidMesh("the edge between vertices " + label.vertex(begin->lower) + " and " + label.vertex(begin->higher) +
                    " has " + to_string(end - begin) + " faces; a surface has at most 2");
}

// Sorts all blocks. @return the number of the first edge of each block, and of all edges
std::vector<int> first_edges(const Polygons& mesh, Blocks& blocks, const MeshLabels& label, Workers& workers) {
  struct Bad {
    const PolygonSide *begin = nullptr, *end = nullptr;
  };
  std::vector<int> first(blocks.count() + 1, 0);
  std::vector<Bad> bad(blocks.count());
  run_throwing(workers, blocks.count(), [&](int block) {
    blocks.sort(block);
    int edges = 0;
    each_edge(blocks, block, [&](const PolygonSide* begin, const PolygonSide* end) {
      // Triangles with the same vertices share all their edges, so that edges of two sides show them.
      if (end - begin > 2 || (end - begin == 2 && duplicates(mesh, begin, end)[0] >= 0)) bad[block] = {begin, end};
      ++edges;
      return !bad[block].begin;
    });
    first[block + 1] = edges;
  });
  for (int block = 0; block < blocks.count(); ++block) {
    if (bad[block].begin) refuse(mesh, label, bad[block].begin, bad[block].end);
    first[block + 1] += first[block];
  }
  return first;
}

}  // namespace

std::vector<int> corner_faces(const Polygons& mesh) {
  std::vector<int> face_of(mesh.corner_vertices.size());
  for (std::size_t f = 0; f + 1 < mesh.face_offsets.size(); ++f) {
    std::fill(face_of.begin() + mesh.face_offsets[f], face_of.begin() + mesh.face_offsets[f + 1], static_cast<int>(f));
  }
  return face_of;
}

PolygonEdges polygon_edges(const Polygons& mesh, const MeshLabels& label, Workers& workers) {
  Blocks blocks(mesh, workers);
  const std::vector<int> first = first_edges(mesh, blocks, label, workers);
  PolygonEdges result;
  result.side_edge.resize(mesh.corner_vertices.size());
  result.edges.resize(first.back());
  result.edge_sides.resize(first.back());
  std::vector<char> oriented(blocks.count(), 1);
  workers.run(blocks.count(), [&](int, int block) {
    int edge = first[block];
    each_edge(blocks, block, [&](const PolygonSide* begin, const PolygonSide* end) {
      const bool two = end - begin == 2;
      result.edges[edge] = {begin->lower, begin->higher};
      result.edge_sides[edge] = {begin->corner(), two ? begin[1].corner() : -1};
      // Consistently oriented polygons run along a common edge in opposite directions.
      if (two && begin[0].runs_down() == begin[1].runs_down()) oriented[block] = 0;
      for (const PolygonSide* side = begin; side != end; ++side) result.side_edge[side->corner()] = edge;
      ++edge;
      return true;
    });
  });
  result.oriented = std::find(oriented.begin(), oriented.end(), 0) == oriented.end();
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
    // The lower root stays, so that a loop is known by its lowest vertex.
    const int a = find(edges.edges[e][0]), b = find(edges.edges[e][1]);
    loop[std::max(a, b)] = std::min(a, b);
  }
  for (int v = 0; v < vertex_count; ++v) {
    if (loop[v] >= 0) loop[v] = find(v);
  }
  return loop;
}

std::vector<int> next_corners(const Polygons& mesh) {
  const std::vector<int>& offsets = mesh.face_offsets;
  std::vector<int> next(mesh.corner_vertices.size());
  for (std::size_t f = 0; f + 1 < offsets.size(); ++f) {
    for (int c = offsets[f]; c < offsets[f + 1]; ++c) next[c] = c + 1 == offsets[f + 1] ? offsets[f] : c + 1;
  }
  return next;
}

void for_edges(const Polygons& mesh, const std::vector<int>& label,
               const std::function<void(const LabelledSide*, const LabelledSide*)>& each) {
  const std::vector<int> next = next_corners(mesh);
  std::vector<LabelledSide> sides(label.size());
  for (int c = 0; c < static_cast<int>(label.size()); ++c) {
    sides[c] = {std::min(label[c], label[next[c]]), std::max(label[c], label[next[c]]), c};
  }
  std::sort(sides.begin(), sides.end(), [](const LabelledSide& a, const LabelledSide& b) {
    return std::tie(a.lower, a.higher, a.corner) < std::tie(b.lower, b.higher, b.corner);
  });
  const LabelledSide *const last = sides.data() + sides.size(), *end = sides.data();
  for (const LabelledSide* begin = end; begin != last; begin = end) {
    while (end != last && end->lower == begin->lower && end->higher == begin->higher) ++end;
    each(begin, end);
  }
}

std::vector<std::vector<int>> crowded_edges(const Polygons& mesh, const std::vector<int>& label) {
  std::vector<std::vector<int>> crowded;
  for_edges(mesh, label, [&](const LabelledSide* begin, const LabelledSide* end) {
    if (end - begin <= kMostFacesAtEdge) return;
    for (crowded.emplace_back(); begin != end; ++begin) crowded.back().push_back(begin->corner);
  });
  return crowded;
}

}  // namespace holomorph::mesh
