#include "progressive/edge_collapse.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/page_allocator.h"

namespace holomorph::progressive {
namespace {

// Cosine of the largest rotation of a normal, 75 degrees.
constexpr float kLeastCosine = 0.2588F;
// Weight of area times squared length against area times squared distance from a plane.
constexpr float kLengthWeight = 1e-5F;
// Weight of the planes that stand on boundary edges, against the area of a square on the edge.
constexpr float kBoundaryWeight = 10.0F;

using Vector = std::array<double, 3>;

Vector minus(const Vertex& a, const Vertex& b) {
  return {double{a.position[0]} - b.position[0], double{a.position[1]} - b.position[1],
          double{a.position[2]} - b.position[2]};
}

Vector cross(const Vector& a, const Vector& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

double norm(const Vector& a) { return std::sqrt(a[0] * a[0] + a[1] * a[1] + a[2] * a[2]); }

// Adds weight * (n.d / |n|)^2; the plane contains v, so b and c remain 0.
void add_plane(Vertex& v, const Vector& n, double weight) {
  const double length = norm(n), scale = length > 0 ? weight / (length * length) : 0;
  int k = 0;
  for (int i = 0; i < 3; ++i) {
    for (int j = i; j < 3; ++j) v.A[k++] += static_cast<float>(n[i] * n[j] * scale);
  }
}

// Moves and scales positions into the cube [-1, 1]^3.
void set_positions(const std::vector<std::array<double, 3>>& positions, Array<Vertex>& vertices) {
  Vector low = positions.front(), high = low;
  for (const auto& p : positions) {
    for (int i = 0; i < 3; ++i) low[i] = std::min(low[i], p[i]), high[i] = std::max(high[i], p[i]);
  }
  double half = 0;
  // Halves are taken first, so that no difference overflows. A mesh of one point keeps the scale 1.
  for (int i = 0; i < 3; ++i) half = std::max(half, high[i] / 2 - low[i] / 2);
  const double scale = std::isfinite(1 / half) ? 1 / half : 1.0;
  for (std::size_t v = 0; v < positions.size(); ++v) {
    for (int i = 0; i < 3; ++i)
      vertices[v].position[i] = static_cast<float>((positions[v][i] - (low[i] / 2 + high[i] / 2)) * scale);
  }
}

}  // namespace

CornerTable::CornerTable(std::span<const Triple> triangles, std::span<const Triple> edges, std::size_t edge_count,
                         std::size_t triangle_capacity) {
  sides_.reserve(4 * triangle_capacity);
  std::vector<int> first_side(edge_count, -1);
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    const int first = add(triangles[t][0], triangles[t][1], triangles[t][2]);
    for (int i = 0; i < 3; ++i) {
      int& other = first_side[static_cast<std::size_t>(edges[t][i])];
      // The second side at an edge is linked with the first. An edge with one side stays on the boundary.
      if (other < 0) {
        other = first + i;
      } else {
        link(first + i, other);
      }
    }
  }
}

int CornerTable::add(int a, int b, int c) {
  const int first = static_cast<int>(sides_.size());
  for (const int v : {a, b, c, -1}) sides_.push_back({v, -1});
  return first;
}

std::vector<int> leaving_sides(const CornerTable& table, int vertex_count) {
  std::vector<int> leaving(static_cast<std::size_t>(vertex_count), -1);
  for (int t = 0; t < table.triangle_count(); ++t) {
    for (int side = 4 * t; side < 4 * t + 3; ++side) {
      int& at = leaving[static_cast<std::size_t>(table.from(side))];
      // At the boundary the side without an opposite is kept: a walk to the left from it reaches all triangles.
      if (at < 0 || table.opposite(side) < 0) at = side;
    }
  }
  return leaving;
}

EdgeCollapse::EdgeCollapse(const mesh::Surface& surface)
    : table_(surface.triangles, surface.triangle_edges, surface.edges.size(), surface.triangles.size()),
      vertices_(static_cast<std::size_t>(surface.vertex_count)) {
  const std::vector<int> leaving = leaving_sides(table_, surface.vertex_count);
  for (std::size_t v = 0; v < vertices_.size(); ++v) {
    const int side = leaving[v];
    std::uint32_t flags = 0;
    if (side < 0) flags = Vertex::kRemoved;
    if (side >= 0 && table_.opposite(side) < 0) flags = Vertex::kBoundary;
    vertices_[v] = {{}, 0, {}, {}, side, Vertex::kNowhere, flags};
  }
  set_positions(surface.polygons.vertices, vertices_);
  grow();
}

void EdgeCollapse::grow() {
  const std::size_t size = std::max<std::size_t>(64, 2 * sides_.size());
  sides_.resize(size);
  for (auto* values : {&x_, &y_, &z_}) values->resize(size);
  neighbours_.resize(size);
}

void EdgeCollapse::compute_quadrics() {
  for (int t = 0; t < table_.triangle_count(); ++t) {
    Vertex* const v[3] = {&vertex(table_.from(4 * t)), &vertex(table_.from(4 * t + 1)),
                          &vertex(table_.from(4 * t + 2))};
    const Vector normal = cross(minus(*v[1], *v[0]), minus(*v[2], *v[0]));
    const double area = norm(normal) / 2;
    for (Vertex* corner : v) add_plane(*corner, normal, area);
    for (int i = 0; i < 3; ++i) {
      // On a boundary edge stands a plane at right angles to the triangle: it keeps the boundary in its place.
      if (table_.opposite(4 * t + i) >= 0) continue;
      const Vector along = minus(*v[(i + 1) % 3], *v[i]);
      const double length = norm(along);
      for (Vertex* end : {v[i], v[(i + 1) % 3]})
        add_plane(*end, cross(along, normal), kBoundaryWeight * length * length);
    }
  }
}

void EdgeCollapse::gather(int v) {
  const Vertex& centre = vertex(v);
  v_ = v;
  signature_ = 0;
  const int start = centre.side;
  int side = start, n = 0;
  const auto take = [&](int u) {
    const Vertex& other = vertex(u);
    neighbours_[n] = u;
    x_[n] = other.position[0] - centre.position[0];
    y_[n] = other.position[1] - centre.position[1];
    z_[n] = other.position[2] - centre.position[2];
    // A set of residues, by which is_neighbour() answers most questions without a search.
    signature_ |= std::uint64_t{1} << (u & 63);
  };
  // Counter-clockwise around v. An open star has one neighbour more than triangles: the apex of the last one.
  while (true) {
    if (n + 2 > static_cast<int>(sides_.size())) grow();
    sides_[n] = side;
    take(table_.to(side));
    ++n;
    const int left = table_.turn_left(side);
    if (left == start) break;
    if (left < 0) {
      take(table_.apex(side));
      break;
    }
    side = left;
  }
  triangle_count_ = n;
  closed_ = (centre.flags & Vertex::kBoundary) == 0;
  neighbour_count_ = closed_ ? n : n + 1;
}

float EdgeCollapse::quadric_error(int i) const {
  const Vertex& v = vertices_[static_cast<std::size_t>(v_)];
  const float x = x_[i], y = y_[i], z = z_[i];
  // Q_v at u. Q_u at u is its constant c, since each quadric is taken about its own vertex.
  const float at_u = x * (v.A[0] * x + 2 * (v.A[1] * y + v.A[2] * z + v.b[0])) +
                     y * (v.A[3] * y + 2 * (v.A[4] * z + v.b[1])) + z * (v.A[5] * z + 2 * v.b[2]) + v.c;
  const float area = v.A[0] + v.A[3] + v.A[5];  // the trace, because the normals have length 1
  return std::max(0.0F, at_u + vertices_[static_cast<std::size_t>(neighbours_[i])].c) +
         kLengthWeight * area * squared_length(i);
}

bool EdgeCollapse::is_neighbour(int w) const {
  if ((signature_ >> (w & 63) & 1) == 0) return false;
  const int* const end = neighbours_.data() + neighbour_count_;
  return std::find(neighbours_.data(), end, w) != end;
}

bool EdgeCollapse::keeps_topology(int i) {
  const int u = neighbours_[i];
  const bool u_boundary = boundary(u), edge_on_boundary = !closed_ && (i == 0 || i == neighbour_count_ - 1);
  // An inner edge between two boundary vertices: its collapse would pinch the surface.
  if (!closed_ && u_boundary && !edge_on_boundary) return false;
  int common = 0, valence = 0;
  table_.each_neighbour(vertex(u).side, [&](int w) {
    common += is_neighbour(w) ? 1 : 0;
    ++valence;
  });
  // The link condition: the apexes of the triangles at the edge are the only common neighbours.
  if (common != (edge_on_boundary ? 1 : 2)) return false;
  // Not both of valence 3, as in a tetrahedron. The boundary counts as one vertex.
  return valence + (u_boundary ? 1 : 0) > 3 || neighbour_count_ + (closed_ ? 0 : 1) > 3;
}

bool EdgeCollapse::keeps_normals(int i) const {
  const float x = x_[i], y = y_[i], z = z_[i];
  for (int k = 0; k < triangle_count_; ++k) {
    const int m = k + 1 == neighbour_count_ ? 0 : k + 1;
    // The triangles at the edge vanish.
    if (k == i || m == i) continue;
    const float ax = x_[k], ay = y_[k], az = z_[k], bx = x_[m], by = y_[m], bz = z_[m];
    const float nx = ay * bz - az * by, ny = az * bx - ax * bz, nz = ax * by - ay * bx;
    const float px = ax - x, py = ay - y, pz = az - z, qx = bx - x, qy = by - y, qz = bz - z;
    const float mx = py * qz - pz * qy, my = pz * qx - px * qz, mz = px * qy - py * qx;
    const float before = nx * nx + ny * ny + nz * nz, after = mx * mx + my * my + mz * mz,
                dot = nx * mx + ny * my + nz * mz;
    // A degenerate triangle has no normal to be kept.
    if (before > 0 && (dot <= 0 || dot * dot < kLeastCosine * kLeastCosine * before * after)) return false;
  }
  return true;
}

void EdgeCollapse::add_quadrics(int i) {
  Vertex& u = vertex(neighbours_[i]);
  const Vertex& v = vertex(v_);
  const float x = x_[i], y = y_[i], z = z_[i];
  // The quadric of v about u: half its gradient there, its value there, and the same A.
  const float gx = v.A[0] * x + v.A[1] * y + v.A[2] * z + v.b[0];
  const float gy = v.A[1] * x + v.A[3] * y + v.A[4] * z + v.b[1];
  const float gz = v.A[2] * x + v.A[4] * y + v.A[5] * z + v.b[2];
  u.c += std::max(0.0F, v.c + x * (gx + v.b[0]) + y * (gy + v.b[1]) + z * (gz + v.b[2]));
  u.b[0] += gx;
  u.b[1] += gy;
  u.b[2] += gz;
  for (int k = 0; k < 6; ++k) u.A[k] += v.A[k];
}

void EdgeCollapse::keep_side(int v, int side) {
  if (side < 0) return;
  vertex(v).side = boundary(v) ? table_.first_side(side) : side;
}

// Links the two sides across from those of the triangle other than `side`, whose ends are one vertex now.
EdgeCollapse::Gap EdgeCollapse::remove_triangle(int side) {
  if (side < 0) return {};
  const int a = table_.opposite(CornerTable::next(side)), b = table_.opposite(CornerTable::previous(side));
  table_.link(a, b);
  return {table_.apex(side), a >= 0 ? a : CornerTable::next(b), b >= 0 ? b : CornerTable::next(a), b >= 0};
}

void EdgeCollapse::collapse(int i) {
  const int u = neighbours_[i];
  // The sides v_t -> v_s and v_s -> v_t, in the triangles to the right and to the left of v_s -> v_t.
  int right = -1, left = -1;
  if (i < triangle_count_) right = sides_[i];
  if (closed_ || i > 0) left = CornerTable::previous(sides_[(i + triangle_count_ - 1) % triangle_count_]);
  Collapse record{u, v_, -1, -1, left, right};
  // All triangles of v, which is v_t, belong to u = v_s from now on.
  for (int k = 0; k < triangle_count_; ++k) table_[sides_[k]].vertex = u;
  const Gap r = remove_triangle(right), l = remove_triangle(left);
  record.v_r = r.apex;
  record.v_l = l.apex;
  keep_side(u, r.from_base < 0 || l.has_opposite ? l.from_base : r.from_base);
  keep_side(l.apex, l.from_apex);
  keep_side(r.apex, r.from_apex);
  vertex(v_).flags |= Vertex::kRemoved;
  collapses_.push_back(record);
}

void EdgeCollapse::prefetch_stars(const int* v, int count) const {
  constexpr int kSteps = 7;  // around most vertices
  int sides[64];
  count = std::min(count, 64);
  for (int i = 0; i < count; ++i) prefetch(&vertices_[static_cast<std::size_t>(v[i])]);
  for (int i = 0; i < count; ++i) {
    sides[i] = vertices_[static_cast<std::size_t>(v[i])].side;
    prefetch(&table_[sides[i]]);
  }
  for (int step = 0; step < kSteps; ++step) {
    for (int i = 0; i < count; ++i) {
      if (sides[i] < 0) continue;
      prefetch(&vertices_[static_cast<std::size_t>(table_.to(sides[i]))]);
      sides[i] = table_.turn_left(sides[i]);
      if (sides[i] >= 0) prefetch(&table_[sides[i]]);
    }
  }
}

}  // namespace holomorph::progressive
