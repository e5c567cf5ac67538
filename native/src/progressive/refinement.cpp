#include "progressive/refinement.h"

#include <algorithm>
#include <string>

#include "base/errors.h"

namespace holomorph::progressive {

using Faces = std::vector<Triple>;

namespace {

std::size_t triangles_after(const ProgressiveMesh& mesh, int splits) {
  return mesh.base.triangles.size() + 2 * static_cast<std::size_t>(splits);
}

}  // namespace

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
