#include "mesh/cut_records.h"

#include <algorithm>

namespace holomorph::mesh {
namespace {

template <class T>
void make_ascending(std::vector<T>& values) {
  std::sort(values.begin(), values.end());
  values.erase(std::unique(values.begin(), values.end()), values.end());
}

// Names cuts by elements of the mesh as given.
class Recorder {
 public:
  explicit Recorder(const PolygonPart& part) : part_(part) {}

  std::vector<Cut> cuts(const CornerLabels& labels, const SideJoins& joins, const std::vector<int>& corner_vertices) {
    std::vector<Cut> found(6);
    found[0] = {CutReason::kManyFaces, {}, edges(joins.many), {}};
    found[1] = {CutReason::kTwice, {}, {}, faces(labels.twice)};
    found[2] = {CutReason::kOpposite, {}, {}, faces(labels.opposite)};
    found[3] = {CutReason::kOneSided, {}, edges(joins.sided), {}};
    found[4] = {CutReason::kRepeated, {}, {}, faces(labels.repeated)};
    found[5] = {CutReason::kTouching, touching(corner_vertices), {}, {}};
    std::erase_if(found, [](const Cut& c) { return c.vertices.empty() && c.edges.empty() && c.faces.empty(); });
    return found;
  }

 private:
  int vertex(int corner) const { return part_.vertex_index[part_.polygons.corner_vertices[corner]]; }

  std::vector<Pair> edges(const std::vector<std::vector<int>>& by_edge) {
    const std::vector<int>& offsets = part_.polygons.face_offsets;
    std::vector<Pair> result;
    for (const auto& sides : by_edge) {
      for (const int s : sides) {
        const int face = static_cast<int>(std::upper_bound(offsets.begin(), offsets.end(), s) - offsets.begin()) - 1;
        const int a = vertex(s), b = vertex(s + 1 == offsets[face + 1] ? offsets[face] : s + 1);
        result.push_back({std::min(a, b), std::max(a, b)});
        named_.insert(named_.end(), {a, b});
      }
    }
    make_ascending(result);
    return result;
  }

  std::vector<int> faces(const std::vector<int>& own) {
    const Polygons& mesh = part_.polygons;
    std::vector<int> result;
    for (const int f : own) {
      result.push_back(part_.face_index[f]);
      for (int c = mesh.face_offsets[f]; c < mesh.face_offsets[f + 1]; ++c) named_.push_back(vertex(c));
    }
    return result;
  }

  // Vertices that are several, without those of what is named already.
  std::vector<int> touching(const std::vector<int>& corner_vertices) {
    std::vector<Pair> places(corner_vertices.size());
    for (int c = 0; c < static_cast<int>(places.size()); ++c) places[c] = {vertex(c), corner_vertices[c]};
    make_ascending(places);
    make_ascending(named_);
    std::vector<int> result;
    for (std::size_t i = 1; i < places.size(); ++i) {
      const int v = places[i][0];
      if (places[i - 1][0] == v && !std::binary_search(named_.begin(), named_.end(), v)) result.push_back(v);
    }
    make_ascending(result);
    return result;
  }

  const PolygonPart& part_;
  std::vector<int> named_;  // vertices of cuts so far
};

}  // namespace

std::vector<Cut> cuts(const PolygonPart& part, const CornerLabels& labels, const SideJoins& joins,
                      const std::vector<int>& corner_vertices) {
  return Recorder(part).cuts(labels, joins, corner_vertices);
}

}  // namespace holomorph::mesh
