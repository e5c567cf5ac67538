#include "progressive/file_format.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <string>
#include <type_traits>

#include "base/errors.h"
#include "mesh/make_surface.h"
#include "progressive/refinement.h"

namespace holomorph::progressive {
namespace {

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
  require(mesh.corner_data.size() % static_cast<std::size_t>(corner_count) == 0,
          "the corner data do not fit the corners");
}

// A transfer as text changes the line end, and so is noticed, as with PNG.
constexpr std::string_view kMagic{"HoloPM\r\n", 8};
constexpr std::uint32_t kVersion = 1, kCorners = 1, kPolygons = 2;

// Reverses the bytes of each number on a big-endian machine.
template <class T>
void to_little_endian(char* bytes, std::size_t count) {
  if constexpr (std::endian::native == std::endian::big && sizeof(T) > 1) {
    for (std::size_t i = 0; i < count; ++i) std::reverse(bytes + i * sizeof(T), bytes + (i + 1) * sizeof(T));
  }
}

class Writer {
 public:
  template <class T>
  void numbers(const T* values, std::size_t count) {
    if (count == 0) return;
    const std::size_t start = bytes_.size();
    bytes_.resize(start + count * sizeof(T));
    std::memcpy(bytes_.data() + start, values, count * sizeof(T));
    to_little_endian<T>(bytes_.data() + start, count);
  }
  template <class T>
  void number(T value) {
    numbers(&value, 1);
  }
  template <class T, std::size_t N, class Allocator>
  void rows(const std::vector<std::array<T, N>, Allocator>& rows) {
    if (!rows.empty()) numbers(rows.front().data(), rows.size() * N);
  }
  std::vector<char> take() { return std::move(bytes_); }

 private:
  std::vector<char> bytes_;
};

class Reader {
 public:
  explicit Reader(std::string_view bytes) : bytes_(bytes) {}

  // Asks whether the bytes are there before it takes memory for them.
  template <class T>
  std::vector<T> numbers(std::uint64_t count) {
    if (count > bytes_.size() / sizeof(T)) throw InvalidMesh("the file of the progressive mesh ends too early");
    std::vector<T> values(static_cast<std::size_t>(count));
    if (count > 0) std::memcpy(values.data(), bytes_.data(), values.size() * sizeof(T));
    to_little_endian<T>(reinterpret_cast<char*>(values.data()), values.size());
    bytes_.remove_prefix(values.size() * sizeof(T));
    return values;
  }
  template <class T>
  T number() {
    return numbers<T>(1)[0];
  }
  template <class T, std::size_t N>
  std::vector<std::array<T, N>> rows(std::uint64_t count) {
    if (count > bytes_.size() / (sizeof(T) * N)) throw InvalidMesh("the file of the progressive mesh ends too early");
    const std::vector<T> flat = numbers<T>(N * count);
    std::vector<std::array<T, N>> rows(static_cast<std::size_t>(count));
    if (count > 0) std::memcpy(rows.data(), flat.data(), flat.size() * sizeof(T));
    return rows;
  }
  bool at_end() const { return bytes_.empty(); }

 private:
  std::string_view bytes_;
};

struct Counts {
  std::uint64_t base_triangles, base_vertices, splits, vertices, triangles, polygons, corner_type, corner_data;
};
static_assert(sizeof(Counts) == 8 * sizeof(std::uint64_t) && std::is_trivially_copyable_v<Counts>);

std::vector<Split> read_splits(Reader& reader, std::uint64_t count) {
  const auto s = reader.numbers<std::int32_t>(count), l = reader.numbers<std::int32_t>(count),
             r = reader.numbers<std::int32_t>(count);
  const auto slots = reader.numbers<std::uint8_t>(count);
  std::vector<Split> splits(s.size());
  for (std::size_t k = 0; k < s.size(); ++k) {
    // One byte holds both slots: that of the left triangle in the two lowest bits.
    splits[k] = {s[k], l[k], r[k], static_cast<std::uint8_t>(slots[k] & 3), static_cast<std::uint8_t>(slots[k] >> 2)};
  }
  return splits;
}

Counts read_header(Reader& reader, std::uint32_t& parts) {
  const auto magic = reader.numbers<char>(kMagic.size());
  if (!std::equal(magic.begin(), magic.end(), kMagic.begin()))
    throw InvalidMesh("the file is not a progressive mesh: it does not begin with HoloPM");
  const auto version = reader.number<std::uint32_t>();
  if (version != kVersion) {
    throw InvalidMesh("the file of the progressive mesh has version " + std::to_string(version) + "; version " +
                      std::to_string(kVersion) + " can be read");
  }
  parts = reader.number<std::uint32_t>();
  if (parts > (kCorners | kPolygons)) throw InvalidMesh("the file of the progressive mesh has unknown parts");
  const auto n = reader.numbers<std::uint64_t>(8);
  for (std::size_t i = 0; i < 6; ++i) {
    // Sides of triangles are numbered 4 t + i (corner_table.h).
    if (n[i] > std::numeric_limits<int>::max() / 4)
      throw InvalidMesh("the file of the progressive mesh has too many elements for 32 bits");
  }
  return {n[0], n[1], n[2], n[3], n[4], n[5], n[6], n[7]};
}

}  // namespace

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

std::vector<char> to_bytes(const ProgressiveMesh& mesh) {
  Writer writer;
  writer.numbers(kMagic.data(), kMagic.size());
  writer.number(kVersion);
  writer.number((mesh.triangle_corners.empty() ? 0 : kCorners) | (mesh.face_offsets.empty() ? 0 : kPolygons));
  const std::size_t polygons = mesh.face_offsets.empty() ? mesh.triangle_index.size() : mesh.face_offsets.size() - 1;
  for (const std::size_t count : {mesh.base.triangles.size(), static_cast<std::size_t>(mesh.base.vertex_count),
                                  mesh.splits.size(), mesh.positions.size(), mesh.triangle_index.size(), polygons,
                                  mesh.corner_type.size(), mesh.corner_data.size()}) {
    writer.number(static_cast<std::uint64_t>(count));
  }
  writer.rows(mesh.base.triangles);
  for (const auto member : {&Split::v_s, &Split::v_l, &Split::v_r}) {
    std::vector<std::int32_t> column;
    column.reserve(mesh.splits.size());
    for (const Split& split : mesh.splits) column.push_back(split.*member);
    writer.numbers(column.data(), column.size());
  }
  for (const Split& split : mesh.splits) writer.number(static_cast<std::uint8_t>(split.slot_l + 4 * split.slot_r));
  writer.rows(mesh.positions);
  writer.numbers(mesh.vertex_index.data(), mesh.vertex_index.size());
  writer.numbers(mesh.triangle_index.data(), mesh.triangle_index.size());
  writer.rows(mesh.triangle_corners);
  writer.numbers(mesh.face_offsets.data(), mesh.face_offsets.size());
  writer.numbers(mesh.corner_type.data(), mesh.corner_type.size());
  writer.numbers(mesh.corner_data.data(), mesh.corner_data.size());
  return writer.take();
}

ProgressiveMesh from_bytes(std::string_view bytes) {
  Reader reader(bytes);
  std::uint32_t parts = 0;
  const Counts n = read_header(reader, parts);
  const auto base_triangles = reader.rows<int, 3>(n.base_triangles);
  ProgressiveMesh mesh;
  mesh.splits = read_splits(reader, n.splits);
  mesh.positions = reader.rows<double, 3>(n.vertices);
  mesh.vertex_index = reader.numbers<int>(n.vertices);
  mesh.triangle_index = reader.numbers<int>(n.triangles);
  if (parts & kCorners) mesh.triangle_corners = reader.rows<int, 3>(n.triangles);
  if (parts & kPolygons) mesh.face_offsets = reader.numbers<int>(n.polygons + 1);
  const auto type = reader.numbers<char>(n.corner_type);
  mesh.corner_type.assign(type.begin(), type.end());
  mesh.corner_data = reader.numbers<char>(n.corner_data);
  if (!reader.at_end()) throw InvalidMesh("the file of the progressive mesh continues past its end");
  if (!(parts & kPolygons) && n.polygons != n.triangles)
    throw InvalidMesh("the file of the progressive mesh miscounts its polygons");
  set_base(mesh, base_triangles, static_cast<std::size_t>(n.base_vertices));
  check(mesh);
  return mesh;
}

}  // namespace holomorph::progressive
