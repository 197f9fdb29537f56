#include <cmath>
#include <cstring>

#include <fmt/format.h>

#include <trocar/core/files.hpp>
#include <trocar/core/letters.hpp>
#include <trocar/core/printable.hpp>
#include <trocar/core/text.hpp>
#include <trocar/geometry/voxel_files/inflate.hpp>
#include <trocar/volumes/files/raster.hpp>
#include <trocar/volumes/files/volume_writer.hpp>

namespace trocar::volumes {

using geometry::gzipped;

namespace {

namespace fs = std::filesystem;

template <class T>
void put(std::string& out, T value) {  // the machines that this runs on are little-endian, as the files
  char own[sizeof(T)];
  std::memcpy(own, &value, sizeof(T));
  out.append(own, sizeof(T));
}
template <class T>
std::string bytes_of(const std::vector<T>& values) {
  return {reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T)};
}

std::string vector_text(Vec3d v) { return fmt::format("({},{},{})", v.x, v.y, v.z); }

std::string nrrd_header(const Grid& grid, const char* type, bool packed) {
  const Mat3d step = grid.step();
  return fmt::format(
      "NRRD0004\ntype: {}\ndimension: 3\nspace: left-posterior-superior\nsizes: {} {} {}\n"
      "space directions: {} {} {}\nkinds: domain domain domain\nendian: little\nencoding: {}\nspace origin: {}\n",
      type, grid.size[0], grid.size[1], grid.size[2], vector_text(step.column(0)), vector_text(step.column(1)),
      vector_text(step.column(2)), packed ? "gzip" : "raw", vector_text(grid.origin));
}
std::string with_data(std::string header, const std::string& data, bool packed) {
  header += '\n';
  return header + (packed ? gzipped(data) : data);
}

/// A name within a line of a header.
std::string one_line(const std::string& name) {
  std::string out = core::printable(name);
  for (char& c : out)
    if (c == '\n' || c == '\r') c = ' ';
  return out;
}

/// Header of NIfTI-1 and the four bytes behind it that say "no extension".
std::string nifti_header(const Grid& grid, std::int16_t datatype, std::int16_t bits, double slope, double intercept,
                         std::int16_t intent) {
  const Mat3d step = grid.step();
  const Vec3d sign{-1, -1, 1};  // R A S of L P S
  std::string h;
  put(h, std::int32_t(348));
  h.resize(40, '\0');
  for (const int d : {3, grid.size[0], grid.size[1], grid.size[2], 1, 1, 1, 1}) put(h, std::int16_t(d));
  h.resize(68, '\0');
  put(h, intent);
  put(h, datatype);
  put(h, bits);
  put(h, std::int16_t(0));
  for (const double p : {1.0, grid.spacing.x, grid.spacing.y, grid.spacing.z, 1.0, 1.0, 1.0, 1.0}) put(h, float(p));
  put(h, 352.0f);
  put(h, float(slope));
  put(h, float(intercept));
  h.resize(123, '\0');
  h += char(2);  // millimetres
  h.resize(254, '\0');
  put(h, std::int16_t(1));  // sform: the scanner's frame
  h.resize(280, '\0');
  for (int r = 0; r < 3; ++r) {
    for (int c = 0; c < 3; ++c) put(h, float(sign[r] * step.m[r][c]));
    put(h, float(sign[r] * grid.origin[r]));
  }
  h.resize(344, '\0');
  h.append("n+1\0", 4);
  h.append(4, '\0');
  return h;
}

void require_small(const Grid& grid) {
  for (const int size : grid.size)
    if (size > 32767) refuse("NIfTI", tr("expected at most 32767 voxels along an axis, got {}", size));
}

void put_in_place(const fs::path& path, const std::string& bytes) {
  if (const std::string said = core::write_file(path, bytes.data(), bytes.size()); !said.empty())
    refuse(path.generic_string(), tr("expected a file that can be written, got \"{}\"", said));
}

template <class Image>
void write_by_name(const fs::path& path, const Image& image) {
  const std::string name = core::in_small_letters(path.filename().string());
  const auto ends = [&](std::string_view end) {
    return name.size() > end.size() && name.substr(name.size() - end.size()) == end;
  };
  if (ends(".nii.gz")) return put_in_place(path, gzipped(to_nifti(image)));
  if (ends(".nii")) return put_in_place(path, to_nifti(image));
  if (ends(".nrrd")) return put_in_place(path, to_nrrd(image));
  refuse(path.generic_string(), "expected a name that ends with .nii, .nii.gz or .nrrd, got another");
}

bool whole_numbers(const Volume& v) { return v.scale == 1 && v.offset == std::floor(v.offset); }

}  // namespace

std::string to_nrrd(const Volume& volume, bool packed) {
  if (volume.scale == 1 && volume.offset == 0)
    return with_data(nrrd_header(volume.grid, "int16", packed), bytes_of(volume.stored), packed);
  if (whole_numbers(volume) && volume.offset == 32768) {
    std::vector<std::uint16_t> values(volume.stored.size());
    for (std::size_t i = 0; i < values.size(); ++i) values[i] = std::uint16_t(volume.stored[i] + 32768);
    return with_data(nrrd_header(volume.grid, "uint16", packed), bytes_of(values), packed);
  }
  std::vector<float> values(volume.stored.size());
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = float(volume.value_of(volume.stored[i]));
  return with_data(nrrd_header(volume.grid, "float", packed), bytes_of(values), packed);
}

std::string to_nrrd(const Labels& labels, bool packed) {
  std::string header = nrrd_header(labels.grid, "uint16", packed);
  for (std::size_t s = 0; s < labels.segments.size(); ++s) {
    const Segment& segment = labels.segments[s];
    header += fmt::format(
        "Segment{0}_ID:=Segment_{1}\nSegment{0}_Name:={2}\nSegment{0}_LabelValue:={1}\nSegment{0}_Layer:=0\n"
        "Segment{0}_Color:={3} {4} {5}\n",
        s, segment.label, one_line(segment.name), segment.colour[0], segment.colour[1], segment.colour[2]);
  }
  return with_data(std::move(header), bytes_of(labels.at), packed);
}

std::string to_nifti(const Volume& volume) {
  require_small(volume.grid);
  return nifti_header(volume.grid, 4, 16, volume.scale, volume.offset, 0) + bytes_of(volume.stored);
}
std::string to_nifti(const Labels& labels) {
  require_small(labels.grid);
  return nifti_header(labels.grid, 512, 16, 1, 0, 1002) + bytes_of(labels.at);
}

void write_volume(const fs::path& path, const Volume& volume) { write_by_name(path, volume); }
void write_labels(const fs::path& path, const Labels& labels) { write_by_name(path, labels); }

}  // namespace trocar::volumes
