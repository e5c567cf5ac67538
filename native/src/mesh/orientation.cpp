#include "mesh/orientation.h"

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

}  // namespace holomorph::mesh
