#include <algorithm>
#include <cmath>
#include <fstream>

#include <fmt/format.h>

#include <trocar/core/error.hpp>
#include <trocar/core/files.hpp>
#include <trocar/core/foreign/foreign_file.hpp>
#include <trocar/core/letters.hpp>
#include <trocar/core/printable.hpp>
#include <trocar/core/text.hpp>
#include <trocar/geometry/voxel_files/inflate.hpp>
#include <trocar/volumes/files/dicom.hpp>
#include <trocar/volumes/files/dicom_elements.hpp>

namespace trocar::volumes {
namespace {

namespace fs = std::filesystem;

constexpr std::uint64_t kMostBytes = std::uint64_t(4) << 30;
constexpr double kStraight = 0.05;  // [degrees]; a hundred slices of 1 mm are a tenth of a millimetre aside then

/// FreeSurfer's own format: version 1, four sizes and a type, the highest byte first.
bool looks_like_mgh(std::string_view bytes) {
  if (bytes.size() < 28 || bytes.substr(0, 4) != std::string_view("\0\0\0\1", 4)) return false;
  for (std::size_t at = 4; at < 24; at += 4)  // sizes below 65536
    if (bytes[at] != 0 || bytes[at + 1] != 0) return false;
  return bytes[20] == 0 && bytes[22] == 0 && bytes[23] >= 0 && bytes[23] <= 10;
}
bool holds_mgh(std::string_view bytes) {
  if (bytes.substr(0, 2) != "\x1f\x8b") return looks_like_mgh(bytes);
  try {
    const std::vector<char> start = geometry::inflated(bytes, geometry::Wrapping::gzip, 0, 28, "");
    return looks_like_mgh({start.data(), start.size()});
  } catch (const core::BadInput&) {
    return false;
  }
}

std::string described(std::string_view bytes) {
  const std::string_view start = bytes.substr(0, 16);
  if (holds_mgh(bytes)) return tr("a volume of FreeSurfer (.mgh, .mgz): convert it to .nii.gz with mri_convert");
  if (std::string foreign = core::foreign_file(bytes, core::Wanted::volume); !foreign.empty()) return foreign;
  const bool text = std::all_of(start.begin(), start.end(),
                                [](char c) { return (c >= ' ' && c < 127) || c == '\n' || c == '\r' || c == '\t'; });
  return text ? tr("a text that begins with {}", shown(start)) : shown(start);
}

/// Only DICOM has series.
void require_no_series(const Source& source) {
  if (source.options.series < 0 || source.options.series > 1)
    refuse(source.file, tr("this file has no series: expected no {} above 1, got {}", source.options.series_choice,
                           source.options.series));
}

using Reader = Raster (*)(const Source& source);
Reader reader_without_series(std::string_view bytes) {
  if (looks_like_nifti(bytes)) return read_nifti;
  if (looks_like_nrrd(bytes)) return read_nrrd_volume;
  if (looks_like_metaimage(bytes)) return read_metaimage;
  return nullptr;
}

bool is_known(std::string_view bytes) { return looks_like_dicom(bytes) || reader_without_series(bytes); }

Raster read_bytes(const Source& source) {
  if (source.bytes.empty()) refuse(source.file, "expected a volume, got an empty file");
  if (looks_like_dicom(source.bytes)) return read_dicom_bytes(source);
  if (const Reader read = reader_without_series(source.bytes)) {
    require_no_series(source);
    return read(source);
  }
  if (source.file.ends_with(".img"))
    refuse(source.file,
           "expected header and voxels in one file, got what seems to be the voxels of a pair (.hdr, .img): "
           "convert the pair to .nii");
  refuse(source.file, tr("expected DICOM, NIfTI, NRRD or MetaImage, got {}", described(source.bytes)));
}

/// What a file is read into: the bytes must live as long as the raster looks into them.
struct Opened {
  std::string bytes;
  Raster raster;
};

/// The header beside a file of voxels that names it; empty: there is none.
std::string header_beside(const fs::path& voxels) {
  constexpr std::size_t kMostHeader = 65536;
  const std::string name = voxels.filename().string();
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(voxels.has_parent_path() ? voxels.parent_path() : ".", error)) {
    const std::string extension = core::in_small_letters(entry.path().extension().string());
    if (extension != ".nhdr" && extension != ".mhd") continue;
    std::string text(kMostHeader, '\0');
    std::ifstream in(entry.path(), std::ios::binary);
    in.read(text.data(), std::streamsize(text.size()));
    text.resize(std::size_t(in.gcount()));
    if (text.find(name) != std::string::npos) return entry.path().filename().string();
  }
  return "";
}

Opened open(const fs::path& path, const ReadOptions& options, ReadReport& report) {
  Opened out;
  std::error_code error;
  if (fs::is_directory(path, error)) {
    out.raster = read_dicom_series(path, {}, options, report);
    return out;
  }
  if (begins_as_dicom(path)) {
    fs::path folder = path.parent_path();
    if (folder.empty()) folder = ".";
    out.raster = read_dicom_series(folder, path, options, report);
    return out;
  }
  out.bytes = core::read_file(path, kMostBytes);
  const FileBeside beside = [&](const std::string& name) {
    return core::read_file(path.parent_path() / fs::path(name), kMostBytes);
  };
  const Source source{out.bytes, path.generic_string(), options, report, beside};
  if (!is_known(source.bytes))
    if (const std::string header = header_beside(path); !header.empty())
      refuse(source.file, tr("expected a volume, got the voxels of {}: open {} instead", core::printable(header),
                             core::printable(header)));
  out.raster = read_bytes(source);
  return out;
}

template <class T>
T straight(T image, ReadReport& report, const ReadOptions& options, const std::string& file) {
  const double shear = shear_deg(image.grid);
  if (shear <= kStraight) return image;
  const Grid onto = straightened(image.grid);
  if (const auto fault = size_fault({onto.size[0], onto.size[1], onto.size[2]}, 2 * options.most_voxels))
    refuse(file, *fault);
  report.notes.push_back(tr("the grid is sheared by {:.3g} degrees: it was resampled onto a straight one", shear));
  if constexpr (std::is_same_v<T, Volume>)
    return resampled(image, onto, NAN, part(options.progress, 0.8, 1));
  else
    return resampled(image, onto, part(options.progress, 0.8, 1));
}

VolumeFile volume_of(const Raster& raster, const std::string& file, const ReadOptions& options, ReadReport report) {
  Volume volume = packed_volume(raster, file, report.notes, part(options.progress, 0.7, 0.8));
  VolumeFile out{straight(std::move(volume), report, options, file), {}};
  out.report = std::move(report);
  return out;
}
LabelFile labels_of(const Raster& raster, const std::string& file, const ReadOptions& options, ReadReport report) {
  Labels labels = packed_labels(raster, file, report.notes, part(options.progress, 0.7, 0.8));
  LabelFile out{straight(std::move(labels), report, options, file), {}};
  out.report = std::move(report);
  return out;
}

}  // namespace

int choose_frame(const Source& source, std::int64_t frames, const char* what) {
  if (frames < 1 || frames > 65536) refuse(source.file, tr("expected 1 to 65536 {}, got {}", what, frames));
  const int wanted = source.options.frame.value_or(0);
  source.report.frames = int(frames);
  source.report.frame = wanted;
  if (wanted < 0 || wanted >= frames)
    refuse(source.file, tr("expected one of {} {} (0 to {}), got {}", frames, what, frames - 1, wanted));
  if (frames > 1)
    source.report.notes.push_back(tr("{} {}: number {} is read; {} chooses another, from 0 to {}", frames, what, wanted,
                                     source.options.frame_choice, frames - 1));
  return wanted;
}

void tell_longer(const Source& source, std::size_t bytes) {
  source.report.notes.push_back(
      tr("the header says {} bytes of voxels, the file holds more: what follows was passed over", bytes));
}

VolumeFile read_volume(const fs::path& path, const ReadOptions& options) {
  ReadReport report;
  const Opened opened = open(path, options, report);
  return volume_of(opened.raster, path.generic_string(), options, std::move(report));
}
LabelFile read_labels(const fs::path& path, const ReadOptions& options) {
  ReadReport report;
  const Opened opened = open(path, options, report);
  return labels_of(opened.raster, path.generic_string(), options, std::move(report));
}
VolumeFile read_volume_bytes(std::string_view bytes, const std::string& file, const ReadOptions& options) {
  ReadReport report;
  const Raster raster = read_bytes({bytes, file, options, report, {}});
  return volume_of(raster, file, options, std::move(report));
}
LabelFile read_labels_bytes(std::string_view bytes, const std::string& file, const ReadOptions& options) {
  ReadReport report;
  const Raster raster = read_bytes({bytes, file, options, report, {}});
  return labels_of(raster, file, options, std::move(report));
}

bool begins_as_dicom(const fs::path& file) {
  char start[132] = {};
  std::ifstream in(file, std::ios::binary);
  in.read(start, sizeof start);
  return looks_like_dicom({start, std::size_t(in.gcount())});
}

std::vector<SeriesFacts> list_series(const fs::path& folder, const ReadOptions& options) {
  return dicom_series(folder, options);
}

}  // namespace trocar::volumes
