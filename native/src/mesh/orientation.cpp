#include "mesh/orientation.h"

#include <algorithm>
#include <numeric>

namespace holomorph::mesh {
namespace {

// The meetings of each face: entries first[f] .. first[f+1]-1 of `meeting`.
struct FaceMeetings {
  std::vector<int> first, meeting;

  FaceMeetings(int face_count, const std::vector<EdgeMeeting>& meetings)
      : first(face_count + 1, 0), meeting(2 * meetings.size()) {
    for (const auto& m : meetings) ++first[m.face + 1], ++first[m.other_face + 1];
    for (int f = 0; f < face_count; ++f) first[f + 1] += first[f];
    std::vector<int> next(first.begin(), first.end() - 1);
    for (int i = 0; i < static_cast<int>(meetings.size()); ++i) {
      meeting[next[meetings[i].face]++] = i;
      meeting[next[meetings[i].other_face]++] = i;
    }
  }
};

// #V: the lowest vertex that each is connected with.
std::vector<int> lowest_connected(int vertex_count, const Array<Pair>& edges) {
  std::vector<int> lower(vertex_count);  // a vertex connected with each, not above it
  std::iota(lower.begin(), lower.end(), 0);
  // First a lower neighbour of each, and what that leads to: mostly the answer.
  for (const auto& [a, b] : edges) lower[b] = a;
  for (int v = 0; v < vertex_count; ++v) lower[v] = lower[lower[v]];
  const auto lowest = [&lower](int v) {
    while (lower[v] != v) v = lower[v] = lower[lower[v]];
    return v;
  };
  for (const auto& [a, b] : edges) {
    const int i = lowest(a), j = lowest(b);
    lower[std::max(i, j)] = std::min(i, j);
  }
  for (int v = 0; v < vertex_count; ++v) lower[v] = lower[lower[v]];
  return lower;
}

}  // namespace

Orientation orient(int face_count, const std::vector<EdgeMeeting>& meetings) {
  const FaceMeetings around(face_count, meetings);
  Orientation result;
  result.reversed.assign(face_count, 0);
  result.face_component.assign(face_count, -1);
  std::vector<int> flood;
  for (int start = 0; start < face_count; ++start) {
    if (result.face_component[start] >= 0) continue;
    const int component = result.component_count++;
    flood.assign(1, start);
    result.face_component[start] = component;
    int reversed_count = 0;
    for (std::size_t head = 0; head < flood.size(); ++head) {
      const int f = flood[head];
      for (int i = around.first[f]; i < around.first[f + 1]; ++i) {
        const EdgeMeeting& m = meetings[around.meeting[i]];
        const int g = m.face == f ? m.other_face : m.face;
        const char wanted = result.reversed[f] ^ static_cast<char>(m.same_direction);
        if (result.face_component[g] < 0) {
          result.face_component[g] = component;
          result.reversed[g] = wanted;
          reversed_count += wanted;
          flood.push_back(g);
        } else if (result.reversed[g] != wanted) {
          // Two ways to this face orient it differently: there is a Moebius band.
          result.conflict = m.edge;
          return result;
        }
      }
    }
    if (2 * static_cast<std::size_t>(reversed_count) > flood.size()) {
      for (const int f : flood) result.reversed[f] ^= 1;
    }
  }
  return result;
}

Orientation oriented_as_given(const Polygons& mesh, const Array<Pair>& edges) {
  const int vertex_count = static_cast<int>(mesh.vertices.size());
  const int face_count = static_cast<int>(mesh.face_offsets.size()) - 1;
  const std::vector<int> root = lowest_connected(vertex_count, edges);
  Orientation result;
  result.reversed.assign(face_count, 0);
  result.face_component.resize(face_count);
  std::vector<int> number(vertex_count, -1);  // component of each root
  for (int f = 0; f < face_count; ++f) {
    int& component = number[root[mesh.corner_vertices[mesh.face_offsets[f]]]];
    if (component < 0) component = result.component_count++;
    result.face_component[f] = component;
  }
  return result;
}

}  // namespace holomorph::mesh
