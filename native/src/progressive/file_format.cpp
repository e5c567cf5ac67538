#include "progressive/file_format.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <type_traits>

#include "base/errors.h"
#include "progressive/checks.h"

namespace holomorph::progressive {
namespace {

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
