#include "mesh/io/read.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <fstream>
#include <string>
#include <string_view>
#include <system_error>

#include "base/errors.h"
#include "mesh/io/read_obj.h"
#include "mesh/io/read_off.h"
#include "mesh/io/read_ply.h"
#include "mesh/io/read_stl.h"

namespace holomorph::mesh {

namespace {

struct Format {
  std::string_view extension;
  GivenPolygons (*read)(const FileText&);
};

constexpr std::array<Format, 4> formats{
    {{".obj", read_obj}, {".off", read_off}, {".ply", read_ply}, {".stl", read_stl}}};

std::string utf8(const std::filesystem::path& path) {
  const auto text = path.u8string();
  return {text.begin(), text.end()};
}

/// Whether bytes >= 0x80 come as a lead byte and as many continuation bytes as it announces.
bool is_utf8(std::string_view text) {
  std::size_t expected = 0;
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    const bool continuation = byte >= 0x80 && byte < 0xC0;
    if (continuation != (expected > 0) || byte == 0xC0 || byte == 0xC1 || byte > 0xF4) return false;
    expected = continuation ? expected - 1 : byte < 0xC0 ? 0 : byte < 0xE0 ? 1 : byte < 0xF0 ? 2 : 3;
  }
  return expected == 0;
}

/// The path as a message can say it. File systems take any bytes as a name, messages are UTF-8.
std::string printable(const std::filesystem::path& path) {
  auto name = utf8(path);
  if (!is_utf8(name))
    std::replace_if(
        name.begin(), name.end(), [](char c) { return c < ' ' || c > '~'; }, '?');
  return name;
}

const Format& format_of(const std::filesystem::path& path) {
  auto extension = utf8(path.extension());
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  for (const auto& format : formats)
    if (format.extension == extension) return format;
  throw InvalidMesh(printable(path) + ": the file name must end in .obj, .off, .ply or .stl");
}

FileText load(const std::filesystem::path& path) {
  FileText file{printable(path), {}};
  std::error_code error;
  const auto status = std::filesystem::status(path, error);
  if (!std::filesystem::exists(status)) file.fail("there is no such file");
  if (std::filesystem::is_directory(status)) file.fail("this is a directory, not a mesh file");
  if (!std::filesystem::is_regular_file(status)) file.fail("this is a pipe or a device, not a mesh file");
  const auto size = std::filesystem::file_size(path, error);
  std::ifstream stream(path, std::ios::binary);
  if (error || !stream) file.fail("the file cannot be opened for reading");
  file.bytes.resize(size);
  if (size > 0 && !stream.read(file.bytes.data(), static_cast<std::streamsize>(size)))
    file.fail("the file cannot be read to its end");
  return file;
}

}  // namespace

GivenPolygons read(const std::filesystem::path& path) {
  const auto& format = format_of(path);
  return format.read(load(path));
}

}  // namespace holomorph::mesh
