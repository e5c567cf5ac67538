#include "progressive/refinement.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>
#include <string>
#include <utility>

#include "base/errors.h"
#include "mesh/make_surface.h"

namespace holomorph::progressive {

using Faces = std::vector<Triple>;

namespace {

int triangles_of(const Split& split) { return (split.v_l >= 0) + (split.v_r >= 0); }

void require(bool valid, const std::string& what) {
  if (!valid) throw InvalidMesh("the progressive mesh is damaged: " + what);
}

void check_permutation(const std::vector<int>& index, const char* what) {
  std::vector<char> found(index.size(), 0);
  for (const int i : index) {
    require(i >= 0 && static_cast<std::size_t>(i) < index.size() && !found[i],
            std::string(what) + " are not a permutation");
    found[i] = 1;
  }
}

// Returns the polygon of each triangle of the original. Triangles are numbered polygon by polygon, and a polygon of n
// corners has n - 2.
std::vector<int> polygons_of_triangles(const ProgressiveMesh& mesh) {
  const auto& offsets = mesh.face_offsets;
  require(offsets.front() == 0, "the first polygon does not begin at corner 0");
  std::vector<int> polygon;
  for (std::size_t f = 0; f + 1 < offsets.size(); ++f) {
    const std::int64_t size = std::int64_t{offsets[f + 1]} - offsets[f];
    require(size >= 3 && size - 2 <= static_cast<std::int64_t>(mesh.triangle_index.size() - polygon.size()),
            "polygon " + std::to_string(f) + " does not fit its triangles");
    polygon.insert(polygon.end(), static_cast<std::size_t>(size - 2), static_cast<int>(f));
  }
  require(polygon.size() == mesh.triangle_index.size(), "there are more triangles than the polygons have");
  return polygon;
}

// Each corner of a polygon occurs, always at the same vertex, in triangles of its own polygon only.
void check_corners(const ProgressiveMesh& mesh, const std::vector<Triple>& triangles) {
  std::vector<int> polygon;
  if (!mesh.face_offsets.empty()) polygon = polygons_of_triangles(mesh);
  const int corner_count = polygon.empty() ? 3 * mesh.triangle_count() : mesh.face_offsets.back();
  const std::vector<Triple> corners = original_corners(mesh);
  std::vector<int> vertex(static_cast<std::size_t>(corner_count), -1);
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    const int original = mesh.triangle_index[t];
    const int first = polygon.empty() ? 3 * original : mesh.face_offsets[polygon[original]];
    const int last = polygon.empty() ? first + 3 : mesh.face_offsets[polygon[original] + 1];
    for (int i = 0; i < 3; ++i) {
      const int c = corners[t][i];
      require(c >= first && c < last, "a triangle has a corner from another polygon");
      require(vertex[c] < 0 || vertex[c] == triangles[t][i], "corner " + std::to_string(c) + " has two vertices");
      vertex[c] = triangles[t][i];
    }
  }
  for (const int v : vertex) require(v >= 0, "a polygon corner is in no triangle");
}

std::size_t triangles_after(const ProgressiveMesh& mesh, int splits) {
  return mesh.base.triangles.size() + 2 * static_cast<std::size_t>(splits);
}

}  // namespace

mesh::Polygons triangle_polygons(std::vector<std::array<double, 3>> vertices, const std::vector<Triple>& triangles) {
  mesh::Polygons polygons{std::move(vertices), {}, {}};
  polygons.corner_vertices.reserve(3 * triangles.size());
  polygons.face_offsets.reserve(triangles.size() + 1);
  for (const Triple& t : triangles) {
    polygons.face_offsets.push_back(static_cast<int>(polygons.corner_vertices.size()));
    for (const int v : t) polygons.corner_vertices.push_back(v);
  }
  polygons.face_offsets.push_back(static_cast<int>(polygons.corner_vertices.size()));
  return polygons;
}

std::int64_t triangle_count(const ProgressiveMesh& mesh, int splits) {
  auto triangles = static_cast<std::int64_t>(mesh.base.triangles.size());
  for (int k = 0; k < splits; ++k) triangles += triangles_of(mesh.splits[k]);
  return triangles;
}

int split_count(const ProgressiveMesh& mesh, std::int64_t triangle_count) {
  auto triangles = static_cast<std::int64_t>(mesh.base.triangles.size());
  int splits = 0;
  for (const Split& split : mesh.splits) {
    triangles += triangles_of(split);
    if (triangles > triangle_count) break;
    ++splits;
  }
  return splits;
}

std::vector<Triple> original_corners(const ProgressiveMesh& mesh) {
  if (!mesh.triangle_corners.empty()) return mesh.triangle_corners;
  std::vector<Triple> corners;
  corners.reserve(mesh.triangle_index.size());
  for (const int t : mesh.triangle_index) corners.push_back({3 * t, 3 * t + 1, 3 * t + 2});
  return corners;
}

std::vector<int> vertex_map(const ProgressiveMesh& mesh, int splits) {
  std::vector<int> map(static_cast<std::size_t>(mesh.vertex_count()));
  std::iota(map.begin(), map.end(), 0);
  // v_s is older than v_t, so that its image is known.
  for (int k = splits; k < static_cast<int>(mesh.splits.size()); ++k)
    map[mesh.base_vertex_count() + k] = map[mesh.splits[k].v_s];
  return map;
}

void set_base(ProgressiveMesh& mesh, const std::vector<Triple>& triangles, std::size_t vertex_count) {
  require(vertex_count + mesh.splits.size() <= mesh.positions.size(), "there are more splits than vertices");
  mesh::Polygons polygons{
      {mesh.positions.begin(), mesh.positions.begin() + static_cast<std::ptrdiff_t>(vertex_count)}, {}, {0}};
  for (const Triple& t : triangles) {
    polygons.corner_vertices.insert(polygons.corner_vertices.end(), t.begin(), t.end());
    polygons.face_offsets.push_back(static_cast<int>(polygons.corner_vertices.size()));
  }
  Execution execution;
  try {
    mesh.base = make_surface(std::move(polygons), execution);
  } catch (const Error& error) {
    require(false, std::string("its base: ") + error.what());
  }
  require(mesh.base.repairs.isolated_vertices.empty(), "its base has isolated vertices");
  require(mesh.base.repairs.reversed_faces.empty(), "the triangles of its base are not oriented alike");
}

void check(const ProgressiveMesh& mesh) {
  // Sides of triangles are numbered 4 t + i (edge_collapse.h).
  constexpr std::size_t kMost = std::numeric_limits<int>::max() / 4;
  for (const std::size_t count : {mesh.positions.size(), mesh.triangle_index.size(), mesh.face_offsets.size()})
    require(count <= kMost, "it has too many elements for 32 bits");
  require(mesh.vertex_index.size() == mesh.positions.size(), "there are not as many vertex indices as positions");
  require(mesh.triangle_corners.empty() || mesh.triangle_corners.size() == mesh.triangle_index.size(),
          "there are not as many triangle corners as triangles");
  for (const auto& p : mesh.positions)
    require(std::isfinite(p[0]) && std::isfinite(p[1]) && std::isfinite(p[2]), "a position is not finite");
  check_permutation(mesh.vertex_index, "the vertex indices");
  check_permutation(mesh.triangle_index, "the triangle indices");
  // Counts come first: all that follows indexes by them.
  std::size_t count = mesh.base.triangles.size();
  for (const Split& split : mesh.splits) count += (split.v_l >= 0) + (split.v_r >= 0);
  require(count == mesh.triangle_index.size(), "the splits do not make as many triangles as there are");
  Refinement refinement(mesh, static_cast<int>(mesh.splits.size()));
  // Each split checks itself, and a valid mesh stays valid. So all levels are valid.
  while (refinement.splits_made() < static_cast<int>(mesh.splits.size())) refinement.split();
  check_corners(mesh, refinement.triangles());
  if (mesh.face_offsets.empty()) return;
  Execution execution;
  try {
    (void)make_surface(restored(mesh), execution);
  } catch (const Error& error) {
    require(false, std::string("its polygons: ") + error.what());
  }
}

Refinement::Refinement(const ProgressiveMesh& mesh, int splits)
    : mesh_(mesh),
      table_(mesh.base.triangles, mesh.base.triangle_edges, mesh.base.edges.size(), triangles_after(mesh, splits)) {
  leaving_ = leaving_sides(table_, mesh.base.vertex_count);
  leaving_.reserve(leaving_.size() + static_cast<std::size_t>(splits));
}

void Refinement::find_star(int v) {
  star_sides_.clear();
  star_vertices_.clear();
  const int start = leaving_[v];
  int side = start;
  do {
    star_sides_.push_back(side);
    star_vertices_.push_back(table_.to(side));
    if (table_.turn_left(side) < 0) star_vertices_.push_back(table_.apex(side));  // the last neighbour at a boundary
    side = table_.turn_left(side);
  } while (side >= 0 && side != start);
}

void Refinement::require(bool valid, const char* what) const {
  if (!valid) throw InvalidMesh("vertex split " + std::to_string(made_) + " " + what);
}

void Refinement::check_vertices(const Split& split, int t) const {
  require(split.slot_l < 3 && split.slot_r < 3, "names a corner beyond the third");
  require(split.v_l < t && split.v_r < t && split.v_l != split.v_r,
          "has the same vertex on both sides, or one that does not exist yet");
}

Refinement::Sector Refinement::sector_of(const Split& split, int t) const {
  const int n = static_cast<int>(star_sides_.size()), count = static_cast<int>(star_vertices_.size());
  const bool closed = count == n;
  const auto place = [&](int v) {
    return static_cast<int>(std::find(star_vertices_.begin(), star_vertices_.end(), v) - star_vertices_.begin());
  };
  const int from = split.v_r < 0 ? 0 : place(split.v_r), to = split.v_l < 0 ? n : place(split.v_l);
  check_vertices(split, t);
  require(from < count && (to < count || split.v_l < 0), "names a vertex that is not a neighbour of v_s");
  // v_l or v_r is missing if the new edge lies on the boundary. Then the sector reaches the end of an open star.
  const bool open_end = split.v_l < 0 || split.v_r < 0;
  require(closed ? !open_end : from < to || (open_end && from == to), "crosses the boundary");
  // A closed star is a ring, and the sector may run across its start.
  return {from, closed && to < from ? to + n : to, closed};
}

// The sides from v_s to neighbour i of the star, and back; -1 beyond the boundary.
int Refinement::leaving(int i, bool closed) const {
  const int n = static_cast<int>(star_sides_.size());
  return closed || i < n ? star_sides_[i % n] : -1;
}
int Refinement::arriving(int i, bool closed) const {
  const int n = static_cast<int>(star_sides_.size());
  return closed || i > 0 ? CornerTable::previous(star_sides_[(i + n - 1) % n]) : -1;
}

void Refinement::move(const Sector& sector, const Split& split, int t) {
  const int n = static_cast<int>(star_sides_.size());
  moved_.clear();
  for (int i = sector.from; i < sector.to; ++i) {
    table_[star_sides_[i % n]].vertex = t;
    if (i > sector.from || split.v_r < 0) moved_.push_back(star_vertices_[i % n]);
  }
  if (split.v_l < 0 && sector.to > sector.from) moved_.push_back(star_vertices_[n]);
}

// Adds the triangle a b c, corner `slot` of which is a, between the sides c -> b and a -> c; returns its side a -> b.
int Refinement::add(int a, int b, int c, int slot, int c_to_b, int a_to_c) {
  // Corner `slot` is to be a, so the corners are rotated. Side k of the triangle then begins at its corner k.
  const int v[3] = {a, b, c};
  const int side = table_.add(v[(3 - slot) % 3], v[(4 - slot) % 3], v[(5 - slot) % 3]) + slot;
  table_.link(CornerTable::next(side), c_to_b);
  table_.link(CornerTable::previous(side), a_to_c);
  return side;
}

// A boundary vertex begins with the side that has no opposite, any other with any side.
void Refinement::set_first_sides(const Sector& sector, const Split& split, int left, int right) {
  int& at_s = leaving_[split.v_s];
  int at_t = right;
  if (left >= 0) {
    const int l_to_s = CornerTable::previous(left);
    at_t = CornerTable::next(left);
    if (table_.opposite(l_to_s) < 0) leaving_[split.v_l] = l_to_s;
  }
  if (right >= 0) {
    const int r_to_t = CornerTable::previous(right);
    if (table_.opposite(r_to_t) < 0) leaving_[split.v_r] = r_to_t;
  }
  if (right < 0) {
    if (sector.to > sector.from) at_t = at_s;
    at_s = left;
  } else if (sector.closed) {
    at_s = left;
  } else if (sector.from == 0) {
    at_s = CornerTable::next(right);
  }
  leaving_.push_back(at_t);
}

void Refinement::split() {
  const Split& split = mesh_.splits[made_];
  const auto& [s, l, r, slot_l, slot_r] = split;
  const int t = mesh_.base.vertex_count + made_;
  require(s >= 0 && s < t && l >= -1 && r >= -1, "names a vertex that does not exist yet");
  find_star(s);
  const Sector sector = sector_of(split, t);
  const auto& [from, to, closed] = sector;
  // The sides that v_s keeps, and those that move to v_t.
  const int s_to_l = l < 0 ? -1 : leaving(to, closed), l_to_t = l < 0 ? -1 : arriving(to, closed);
  const int t_to_r = r < 0 ? -1 : leaving(from, closed), r_to_s = r < 0 ? -1 : arriving(from, closed);
  move(sector, split, t);
  const int left = l < 0 ? -1 : add(s, t, l, slot_l, l_to_t, s_to_l);
  const int right = r < 0 ? -1 : add(t, s, r, slot_r, r_to_s, t_to_r);
  table_.link(left, right);
  set_first_sides(sector, split, left, right);
  last_ = {from, to, left, right};
  ++made_;
}

std::vector<Triple> Refinement::triangles() const {
  std::vector<Triple> triangles(static_cast<std::size_t>(table_.triangle_count()));
  for (int t = 0; t < table_.triangle_count(); ++t) {
    triangles[t] = {table_.from(4 * t), table_.from(4 * t + 1), table_.from(4 * t + 2)};
  }
  return triangles;
}

mesh::Polygons level(const ProgressiveMesh& mesh, int splits) {
  Refinement refinement(mesh, splits);
  while (refinement.splits_made() < splits) refinement.split();
  return triangle_polygons({mesh.positions.begin(), mesh.positions.begin() + mesh.base_vertex_count() + splits},
                           refinement.triangles());
}

mesh::Polygons restored(const ProgressiveMesh& mesh) {
  Refinement refinement(mesh, static_cast<int>(mesh.splits.size()));
  while (refinement.splits_made() < static_cast<int>(mesh.splits.size())) refinement.split();
  const Faces triangles = refinement.triangles(), corners = original_corners(mesh);
  mesh::Polygons polygons;
  polygons.vertices.resize(mesh.positions.size());
  for (std::size_t v = 0; v < mesh.positions.size(); ++v) polygons.vertices[mesh.vertex_index[v]] = mesh.positions[v];
  polygons.face_offsets.assign(mesh.face_offsets.begin(), mesh.face_offsets.end());
  // No offsets were stored: all polygons are triangles.
  for (int t = 0; mesh.face_offsets.empty() && t <= mesh.triangle_count(); ++t) polygons.face_offsets.push_back(3 * t);
  polygons.corner_vertices.resize(static_cast<std::size_t>(polygons.face_offsets.back()));
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    for (int i = 0; i < 3; ++i) polygons.corner_vertices[corners[t][i]] = mesh.vertex_index[triangles[t][i]];
  }
  return polygons;
}

}  // namespace holomorph::progressive
