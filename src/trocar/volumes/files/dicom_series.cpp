// DICOM files of a folder: told apart by series, put in order, decoded one after the other.
#include <algorithm>
#include <cmath>
#include <fstream>

#include <fmt/format.h>

#include <trocar/core/error.hpp>
#include <trocar/core/files.hpp>
#include <trocar/core/text.hpp>
#include <trocar/volumes/files/dicom.hpp>
#include <trocar/volumes/files/dicom_pixels.hpp>

namespace trocar::volumes {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMostFiles = 20'000;
constexpr int kDeepest = 6;

struct Found {
  std::vector<std::vector<DicomHeader>> series;
  int others = 0;          // files that are no DICOM images
  std::string not_usable;  // why the first of the DICOM files without usable pixels is none
};

constexpr std::size_t kBeginning = std::size_t(1) << 16;  // most headers are shorter
constexpr std::uint64_t kMostFileBytes = std::uint64_t(1) << 31;

/// False where this is no DICOM file.
bool read_header(const fs::path& path, DicomHeader& out) {
  std::string bytes(kBeginning, '\0');
  std::ifstream in(path, std::ios::binary);
  in.read(bytes.data(), std::streamsize(bytes.size()));
  bytes.resize(std::size_t(in.gcount()));
  if (!looks_like_dicom(bytes)) return false;
  const std::string name = path.generic_string();
  const bool marked = bytes.size() > 132 && bytes.compare(128, 4, "DICM") == 0;
  try {
    DicomDocument file = parse_dicom(bytes, name, true);
    if (file.ends_early) {
      bytes = core::read_file(path, kMostFileBytes);
      file = parse_dicom(bytes, name);
    }
    out = dicom_header(file, name);
  } catch (const core::BadInput&) {
    if (marked) throw;
    return false;  // some other file that begins as DICOM without its mark does
  }
  return true;
}

std::vector<char> read_pixels(const DicomHeader& header, const ReadOptions& options) {
  const std::string bytes = core::read_file(header.path, kMostFileBytes);
  const DicomDocument file = parse_dicom(bytes, header.path);
  const DicomHeader again = dicom_header(file, header.path);
  if (!same_stack(again, header) || again.frames != header.frames || again.element() != header.element())
    refuse(header.path, "expected the file as it was a moment ago, got another one");
  return dicom_pixels(file, header, options.most_voxels);
}

std::vector<fs::path> files_below(const fs::path& folder) {
  std::vector<fs::path> out;
  std::error_code error;
  fs::recursive_directory_iterator it(folder, fs::directory_options::skip_permission_denied, error), end;
  if (error) refuse(folder.generic_string(), "expected a folder that can be read, got " + error.message());
  for (; it != end; it.increment(error)) {
    if (error) break;
    if (it.depth() >= kDeepest) it.disable_recursion_pending();
    if (!it->is_regular_file(error)) continue;
    if (out.size() >= kMostFiles)
      refuse(folder.generic_string(), tr("expected at most {} files in the folder, got more", kMostFiles));
    out.push_back(it->path());
  }
  std::sort(out.begin(), out.end());
  return out;
}

Found find_series(const fs::path& folder, const Progress& progress) {
  Found out;
  const std::vector<fs::path> files = files_below(folder);
  for (std::size_t i = 0; i < files.size(); ++i) {
    tell(progress, double(i) / double(files.size()));
    DicomHeader header;
    if (!read_header(files[i], header)) {
      ++out.others;
      continue;
    }
    if (!header.fault.empty()) {
      if (out.not_usable.empty()) out.not_usable = header.path + ": " + header.fault;
      ++out.others;
      continue;
    }
    const auto same = std::find_if(out.series.begin(), out.series.end(),
                                   [&](const auto& s) { return same_stack(s[0], header) && header.frames == 1; });
    if (same == out.series.end())
      out.series.push_back({header});
    else
      same->push_back(header);
  }
  std::stable_sort(out.series.begin(), out.series.end(), [](const auto& a, const auto& b) {
    const std::size_t na = a.size() * std::size_t(a[0].frames), nb = b.size() * std::size_t(b[0].frames);
    return na != nb ? na > nb : a[0].uid < b[0].uid;
  });
  return out;
}

std::vector<SeriesFacts> facts_of(const Found& found) {
  std::vector<SeriesFacts> out;
  for (const auto& s : found.series) {
    const DicomHeader& first = s[0];
    out.push_back({first.uid,
                   first.description,
                   first.modality,
                   int(s.size()),
                   {first.columns, first.rows, int(s.size()) * first.frames}});
  }
  return out;
}

/// All frames of a series as slices, and what holds for all of them.
class Stack {
 public:
  Stack(const std::vector<DicomHeader>& series, const std::string& name, const ReadOptions& options, ReadReport& report)
      : m_series(series), m_name(name), m_options(options), m_report(report) {}

  /// Where the volume is; which frames it takes, in their order.
  void arrange(Raster& raster) {
    const DicomHeader& first = m_series[0];
    std::vector<SlicePlace> places;
    for (std::size_t f = 0; f < m_series.size(); ++f) {
      if (m_series[f].places.empty())
        refuse(m_series[f].path, m_series[f].frames > 1
                                     ? "expected a place for each frame (Plane Position Sequence), got none"
                                     : "expected Image Position (Patient), got none");
      places.insert(places.end(), m_series[f].places.begin(), m_series[f].places.end());
    }
    if (!(first.between_columns > 0 && first.between_rows > 0)) refuse(first.path, "expected Pixel Spacing, got none");
    const SliceStack stack = stack_slices(places, first.row, first.column, m_name, m_report.notes);
    const int frame = choose(stack.frames);
    for (int k = 0; k < stack.slices; ++k) m_wanted.push_back(stack.order[std::size_t(k * stack.frames + frame)]);
    const Mat3d step =
        Mat3d::from_columns(first.between_columns * first.row, first.between_rows * first.column, stack.step);
    if (const auto fault = size_fault({first.columns, first.rows, stack.slices}, m_options.most_voxels))
      refuse(m_name, *fault);
    if (const auto fault = place_fault(stack.origin, step)) refuse(m_name, *fault);
    raster.grid = grid_of({first.columns, first.rows, stack.slices}, stack.origin, step);
    if (first.tilt_deg != 0) m_report.notes.push_back(tr("the gantry was tilted by {:.3g} degrees", first.tilt_deg));
    if (first.photometric == "MONOCHROME1")
      m_report.notes.push_back("MONOCHROME1: small values are meant to be shown bright; the values are as in the file");
    if (first.modality == "CT") raster.unit = "HU";
    raster.rescale.resize(m_wanted.size());
  }

  /// Puts the frames of a file where they belong.
  void put(Raster& raster, std::size_t file, const std::vector<char>& pixels) {
    const DicomHeader& header = m_series[file];
    if (raster.owned.empty()) {
      raster.element = header.element();
      raster.owned.resize(raster.wanted());
    }
    if (header.element() != raster.element)
      refuse(header.path,
             tr("expected {} as in the other slices, got {}", name_of(raster.element), name_of(header.element())));
    const std::size_t bytes = pixels.size() / std::size_t(header.frames);
    for (int f = 0; f < header.frames; ++f) {
      const auto slice = std::find(m_wanted.begin(), m_wanted.end(), first_frame(file) + f) - m_wanted.begin();
      if (slice == std::ptrdiff_t(m_wanted.size())) continue;
      std::copy_n(pixels.begin() + std::ptrdiff_t(bytes) * f, bytes,
                  raster.owned.begin() + std::ptrdiff_t(bytes) * slice);
      raster.rescale[std::size_t(slice)] = header.rescale[std::size_t(f)];
    }
  }
  bool needs(std::size_t file) const {
    const int first = first_frame(file), end = first + m_series[file].frames;
    return std::any_of(m_wanted.begin(), m_wanted.end(), [&](int w) { return w >= first && w < end; });
  }

 private:
  const std::vector<DicomHeader>& m_series;
  const std::string& m_name;
  const ReadOptions& m_options;
  ReadReport& m_report;
  std::vector<int> m_wanted;  // of each slice the frame, counted through all files

  int first_frame(std::size_t file) const {
    // Files of several frames are series of their own (same_stack).
    return int(file) * m_series[0].frames;
  }
  int choose(int frames) {
    ReadReport& r = m_report;
    r.frames = frames;
    r.frame = m_options.frame;
    if (m_options.frame < 0 || m_options.frame >= frames)
      refuse(m_name,
             tr("expected one of {} images at each position (0 to {}), got {}", frames, frames - 1, m_options.frame));
    if (frames > 1)
      r.notes.push_back(tr("{} images at each position (time points): number {} is read", frames, r.frame));
    return r.frame;
  }
};

/// One slope and intercept for all says more than one a slice.
void share_rescale(Raster& raster) {
  const auto same = [&](const Rescale& r) {
    return r.slope == raster.rescale[0].slope && r.intercept == raster.rescale[0].intercept;
  };
  if (std::all_of(raster.rescale.begin(), raster.rescale.end(), same)) raster.rescale.resize(1);
}

std::size_t choose_series(const Found& found, const fs::path& file, const std::string& folder, int wanted) {
  const int count = int(found.series.size());
  if (wanted < 0 || wanted > count)
    refuse(folder, tr("expected one of {} series (1 to {}), got {}", count, count, wanted));
  if (wanted > 0) return std::size_t(wanted - 1);
  if (file.empty()) return 0;
  for (std::size_t s = 0; s < found.series.size(); ++s)
    for (const DicomHeader& h : found.series[s])
      if (fs::path(h.path).lexically_normal() == file.lexically_normal()) return s;
  refuse(file.generic_string(),
         found.not_usable.empty() ? "expected a DICOM image, got another file" : found.not_usable);
}

void tell_choice(const Found& found, std::size_t chosen, ReadReport& report) {
  report.series = facts_of(found);
  report.chosen_series = int(chosen) + 1;
  const auto named = [&](std::size_t s) {
    const SeriesFacts& f = report.series[s];
    return fmt::format("{} '{}' ({} x {} x {})", s + 1, f.description, f.size[0], f.size[1], f.size[2]);
  };
  if (found.series.size() > 1) {
    std::string others;
    for (std::size_t s = 0; s < found.series.size() && s < 20; ++s)
      if (s != chosen) others += (others.empty() ? "" : ", ") + named(s);
    report.notes.push_back(tr("series {} of {} is read; others: {}", named(chosen), found.series.size(), others));
  }
  if (found.others > 0) report.notes.push_back(tr("{} files that are no DICOM images were passed over", found.others));
}

}  // namespace

std::vector<SeriesFacts> dicom_series(const fs::path& folder, const ReadOptions& options) {
  return facts_of(find_series(folder, options.progress));
}

Raster read_dicom_series(const fs::path& folder, const fs::path& file, const ReadOptions& options, ReadReport& report) {
  report.format = "DICOM";
  const Found found = find_series(folder, part(options.progress, 0, 0.3));
  const std::string name = (file.empty() ? folder : file).generic_string();
  if (found.series.empty())
    refuse(name, found.not_usable.empty() ? "expected DICOM images, got none"
                                          : "expected DICOM images with grey values, got none: " + found.not_usable);
  const std::size_t chosen = choose_series(found, file, name, options.series);
  tell_choice(found, chosen, report);
  const std::vector<DicomHeader>& series = found.series[chosen];
  Raster raster;
  Stack stack(series, name, options, report);
  stack.arrange(raster);
  for (std::size_t f = 0; f < series.size(); ++f) {
    tell(options.progress, 0.3 + 0.4 * double(f) / double(series.size()));
    if (!stack.needs(f)) continue;
    stack.put(raster, f, read_pixels(series[f], options));
  }
  share_rescale(raster);
  return raster;
}

Raster read_dicom_bytes(const Source& source) {
  source.report.format = "DICOM";
  const DicomDocument file = parse_dicom(source.bytes, source.file);
  const std::vector<DicomHeader> series{dicom_header(file, source.file)};
  if (!series[0].fault.empty()) refuse(source.file, series[0].fault);
  Raster raster;
  Stack stack(series, source.file, source.options, source.report);
  stack.arrange(raster);
  stack.put(raster, 0, dicom_pixels(file, series[0], source.options.most_voxels));
  share_rescale(raster);
  return raster;
}

}  // namespace trocar::volumes
