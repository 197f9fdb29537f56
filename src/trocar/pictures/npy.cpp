#include <fstream>
#include <stdexcept>
#include <string>

#include <fmt/format.h>

#include <trocar/core/error.hpp>
#include <trocar/core/text.hpp>
#include <trocar/pictures/npy.hpp>

namespace trocar::pictures {
namespace {

static_assert(__BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__, "the files are little-endian");

/// The format's dictionary, filled up so that the values begin at a multiple of 64 bytes.
std::string head(const char* type, const std::vector<std::size_t>& shape) {
  std::string axes;
  for (const std::size_t n : shape) axes += fmt::format("{},", n);
  std::string text = fmt::format("{{'descr': '{}', 'fortran_order': False, 'shape': ({}), }}", type, axes);
  constexpr std::size_t kPrefix = 10, kAlign = 64;
  text.append(kAlign - 1 - (kPrefix + text.size()) % kAlign, ' ');
  text += '\n';
  std::string out = "\x93NUMPY";
  out += {'\x01', '\x00', char(text.size() & 255), char(text.size() >> 8)};
  return out + text;
}

template <class T>
void write(const std::filesystem::path& path, const char* type, const std::vector<std::size_t>& shape,
           std::span<const T> values) {
  std::size_t n = 1;
  for (const std::size_t axis : shape) n *= axis;
  if (n != values.size()) throw std::invalid_argument("write_npy: as many values as the shape has places");
  std::ofstream out(path, std::ios::binary);
  const std::string begin = head(type, shape);
  out.write(begin.data(), std::streamsize(begin.size()));
  out.write(reinterpret_cast<const char*>(values.data()), std::streamsize(values.size_bytes()));
  if (!out.flush()) throw core::EnvironmentLacks(tr("cannot write {}: is the disk full?", path.string()));
}

}  // namespace

void write_npy(const std::filesystem::path& path, const std::vector<std::size_t>& shape,
               std::span<const float> values) {
  write(path, "<f4", shape, values);
}

void write_npy(const std::filesystem::path& path, const std::vector<std::size_t>& shape,
               std::span<const std::uint16_t> values) {
  write(path, "<u2", shape, values);
}

}  // namespace trocar::pictures
