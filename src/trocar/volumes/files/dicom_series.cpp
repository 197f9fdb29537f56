// DICOM images as a volume: the stack is chosen, put in order, and decoded one file after the other.
#include <algorithm>
#include <cstring>
#include <map>

#include <fmt/format.h>

#include <trocar/core/error.hpp>
#include <trocar/core/text.hpp>
#include <trocar/volumes/files/dicom.hpp>
#include <trocar/volumes/files/dicom_choice.hpp>
#include <trocar/volumes/files/dicom_digests.hpp>
#include <trocar/volumes/files/dicom_pixels.hpp>
#include <trocar/volumes/files/slice_stack.hpp>

namespace trocar::volumes {
namespace {

namespace fs = std::filesystem;

/// The chosen images as a volume.
class VolumeOfImages {
 public:
  VolumeOfImages(const std::vector<DicomHeader>& files, const std::string& name, const ReadOptions& options,
                 ReadReport& report)
      : m_files(files), m_name(name), m_options(options), m_report(report) {}

  Raster read(const DicomStack& stack, int group, LastPixels& pixels) {
    for (const int i : stack.groups[std::size_t(group)].images) m_images.push_back(stack.images[std::size_t(i)]);
    Raster raster;
    arrange(raster);
    std::vector<std::size_t> by_file(m_images.size());
    for (std::size_t s = 0; s < by_file.size(); ++s) by_file[s] = s;
    std::stable_sort(by_file.begin(), by_file.end(),
                     [&](std::size_t a, std::size_t b) { return m_images[a].file < m_images[b].file; });
    int told_on = -1;
    for (std::size_t n = 0; n < by_file.size(); ++n) {
      tell(m_options.progress, 0.3 + 0.4 * double(n) / double(by_file.size()));
      const int file = m_images[by_file[n]].file;
      put(raster, by_file[n], pixels.of(file));
      if (file != told_on) remember(file, pixels.notes());
      told_on = file;
    }
    for (const auto& [text, names] : m_corrected)
      m_report.notes.push_back(names.size() == 1 ? text : tr("{} ({} files)", text, names.size()));
    share_rescale(raster);
    return raster;
  }

 private:
  const std::vector<DicomHeader>& m_files;
  const std::string& m_name;
  const ReadOptions& m_options;
  ReadReport& m_report;
  std::vector<ImageAt> m_images;  // of each slice, lowest first
  std::map<std::string, std::vector<std::string>> m_corrected;

  const DicomHeader& header(std::size_t slice) const { return m_files[std::size_t(m_images[slice].file)]; }
  const DicomFrame& frame(std::size_t slice) const { return header(slice).frames[std::size_t(m_images[slice].frame)]; }

  void arrange(Raster& raster) {
    std::vector<SlicePlace> places;
    for (std::size_t i = 0; i < m_images.size(); ++i) places.push_back({frame(i).position, frame(i).thickness});
    const DicomHeader& first = header(0);
    const DicomFrame at = frame(0);
    const SliceStack stack = stack_slices(places, at.row, at.column, m_name, m_report.notes);
    std::vector<ImageAt> ordered;
    for (const int i : stack.order) ordered.push_back(m_images[std::size_t(i)]);
    m_images = std::move(ordered);
    const Mat3d step = Mat3d::from_columns(at.between_columns * at.row, at.between_rows * at.column, stack.step);
    if (const auto fault = size_fault({first.columns, first.rows, stack.slices}, m_options.most_voxels))
      refuse(m_name, *fault);
    if (const auto fault = place_fault(stack.origin, step)) refuse(m_name, *fault);
    raster.grid = grid_of({first.columns, first.rows, stack.slices}, stack.origin, step);
    if (first.tilt_deg != 0) m_report.notes.push_back(tr("the gantry was tilted by {:.3g} degrees", first.tilt_deg));
    if (first.photometric == "MONOCHROME1")
      m_report.notes.push_back("MONOCHROME1: small values are meant to be shown bright; the values are as in the file");
    require_one_rescale();
    if (first.modality == "CT") raster.unit = unit_of(at);
    raster.element = common_element();
    raster.rescale.resize(m_images.size());
  }

  /// Slope and intercept are there in all slices or in none, and mean the same.
  void require_one_rescale() const {
    std::vector<std::size_t> with, without;
    for (std::size_t i = 0; i < m_images.size(); ++i) {
      (frame(i).rescaled ? with : without).push_back(i);
      if (frame(i).rescale_type != frame(0).rescale_type)
        refuse(header(i).path,
               tr("expected the Rescale Type {} as in the other slices, got {}: export the series again",
                  shown(frame(0).rescale_type), shown(frame(i).rescale_type)));
    }
    if (with.empty() || without.empty()) return;
    const bool is_missing = with.size() >= without.size();
    refuse(header(is_missing ? without[0] : with[0]).path,
           is_missing
               ? tr("expected Rescale Slope and Rescale Intercept as in {} other slices, got a slice without them: "
                    "export the series again",
                    with.size())
               : tr("expected no Rescale Slope and Rescale Intercept, as in {} other slices, got a slice with "
                    "them: export the series again",
                    without.size()));
  }

  /// Of CT.
  std::string unit_of(const DicomFrame& at) {
    if (!at.rescaled) {
      m_report.notes.emplace_back(
          tr("Rescale Slope or Rescale Intercept is missing or 0: the values are no Hounsfield units"));
      return "";
    }
    if (at.rescale_type.empty() || at.rescale_type == "HU") return "HU";
    m_report.notes.push_back(tr("Rescale Type is {}: the values are no Hounsfield units", shown(at.rescale_type)));
    return at.rescale_type;
  }

  /// A type that holds the numbers of all slices, which may be signed in some of them only.
  Element common_element() const {
    Element out = header(0).element();
    for (std::size_t i = 1; i < m_images.size(); ++i) {
      const Element other = header(i).element();
      if (other == out) continue;
      const bool small = std::max(out, other) <= Element::uint16 || out == Element::int32;
      out = small && other != Element::uint32 ? Element::int32 : Element::real64;
      if (out == Element::real64) break;
    }
    return out;
  }

  void put(Raster& raster, std::size_t slice, const std::vector<char>& pixels) {
    const DicomHeader& from = header(slice);
    if (raster.owned.empty()) raster.owned.resize(raster.wanted());
    const std::size_t width = width_of(from.element()), count = frame_pixels(from);
    const char* frame_of_file = pixels.data() + count * width * std::size_t(m_images[slice].frame);
    char* to = raster.owned.data() + count * width_of(raster.element) * slice;
    if (from.element() == raster.element)
      std::copy_n(frame_of_file, count * width, to);
    else
      geometry::with_type(raster.element, [&](auto wide) {
        geometry::with_type(from.element(), [&](auto narrow) {
          for (std::size_t i = 0; i < count; ++i) {
            const auto value =
                static_cast<decltype(wide)>(geometry::number_at<decltype(narrow)>(frame_of_file + i * width, false));
            std::memcpy(to + i * sizeof value, &value, sizeof value);
          }
        });
      });
    raster.rescale[slice] = frame(slice).rescale;
  }

  void remember(int file, const std::vector<std::string>& on_pixels) {
    const DicomHeader& from = m_files[std::size_t(file)];
    for (const auto* notes : {&from.corrected, &on_pixels})
      for (const std::string& note : *notes) {
        std::vector<std::string>& names = m_corrected[note];
        if (names.empty() || names.back() != from.path) names.push_back(from.path);
      }
  }

  /// One slope and intercept for all says more than one a slice.
  static void share_rescale(Raster& raster) {
    const auto same = [&](const Rescale& r) { return r == raster.rescale[0]; };
    if (std::all_of(raster.rescale.begin(), raster.rescale.end(), same)) raster.rescale.resize(1);
  }
};

void tell_copies(const DicomStack& stack, const std::vector<DicomHeader>& files, ReadReport& report) {
  std::vector<std::string> names;
  for (const auto& [copy, original] : stack.copies)
    names.push_back(tr("{} (as {})", files[std::size_t(copy)].path, files[std::size_t(original)].path));
  if (!names.empty())
    report.notes.push_back(tr("images that are there twice are read once; left out: {}", few_of(names)));
}

std::vector<DicomStack> stacks_of(const DicomFolder& folder, LastPixels& pixels, const std::string& name) {
  PixelDigests digests(folder.files, pixels);
  return dicom_stacks(
      folder.files, [&](ImageAt image) { return digests.of(image); }, name);
}

/// @param file  of the folder's files: it was named; -1: none was
Raster read_stacks(const DicomFolder& folder, int file, const std::string& name, const ReadOptions& options,
                   ReadReport& report, const PixelsOf& pixels_of) {
  LastPixels pixels(pixels_of);
  const std::vector<DicomStack> stacks = stacks_of(folder, pixels, name);
  const DicomStack& stack = stacks[choose_stack(folder, stacks, file, name, options, report)];
  const int group = choose_group(stack, file, name, options, report);
  tell_copies(stack, folder.files, report);
  try {
    return VolumeOfImages(folder.files, name, options, report).read(stack, group, pixels);
  } catch (const core::BadInput& bad) {
    std::vector<core::Fault> faults = faults_of_set_aside(stacks, stack, folder.files);
    if (faults.empty()) throw;
    faults.insert(faults.end(), bad.faults().begin(), bad.faults().end());
    throw core::BadInput(faults);
  }
}

std::vector<char> pixels_of_file(const DicomHeader& header, const ReadOptions& options,
                                 std::vector<std::string>& notes) {
  OpenedDicom opened;
  open_dicom(header.path, opened);
  const DicomHeader again = dicom_header(opened.file, header.path);
  if (again.broken) refuse(header.path, again.fault);
  if (again.frames.size() != header.frames.size() || again.element() != header.element() ||
      !same_stack(again, again.frames[0], header, header.frames[0]))
    refuse(header.path, "expected the file as it was a moment ago, got another one");
  notes = opened.file.corrected;
  return dicom_pixels(opened.file, header, options.most_voxels, notes);
}

/// The number of a file among those with slices; refused with the reason where it has none. -1: it stands for its
/// folder.
int number_of(const DicomFolder& folder, const fs::path& file) {
  const std::string path = file.generic_string();
  std::error_code error;
  for (std::size_t f = 0; f < folder.files.size(); ++f)
    if (folder.files[f].path == path || fs::equivalent(folder.files[f].path, file, error)) return int(f);
  for (const LeftOut& left : folder.left_out)
    if (left.path == path || fs::equivalent(left.path, file, error)) {
      if (left.is_directory) return -1;
      refuse(path, left.why);
    }
  refuse(path, "expected the file as it was a moment ago, got none");
}

[[noreturn]] void refuse_empty(const DicomFolder& folder, const std::string& name) {
  std::string why;
  for (const std::string& note : notes_on(folder.left_out)) why += (why.empty() ? ": " : "; ") + note;
  refuse(name, tr("expected DICOM images, got none{}", why));
}

/// What is missing may be in files that are damaged.
[[noreturn]] void refuse_with_damaged(const core::BadInput& bad, const DicomFolder& folder) {
  constexpr std::size_t kMostTold = 20;
  std::vector<core::Fault> faults = bad.faults();
  for (const LeftOut& left : folder.left_out)
    if (left.broken && left.path != faults[0].at.file && faults.size() < kMostTold)
      faults.push_back({{left.path, 0, 0}, left.why});
  throw core::BadInput(faults);
}

}  // namespace

std::vector<SeriesFacts> dicom_series(const fs::path& path, const ReadOptions& options) {
  const DicomFolder folder = read_dicom_folder(path, options.progress);
  LastPixels pixels([&](int file, std::vector<std::string>& notes) {
    return pixels_of_file(folder.files[std::size_t(file)], options, notes);
  });
  std::vector<SeriesFacts> out;
  for (const DicomStack& stack : stacks_of(folder, pixels, path.generic_string()))
    out.push_back(facts_of(stack, folder.files));
  return out;
}

Raster read_dicom_series(const fs::path& path, const fs::path& file, const ReadOptions& options, ReadReport& report) {
  report.format = "DICOM";
  const DicomFolder folder = read_dicom_folder(path, part(options.progress, 0, 0.3));
  const int number = file.empty() ? -1 : number_of(folder, file);
  const std::string name = (number < 0 ? path : file).generic_string();
  if (folder.files.empty()) refuse_empty(folder, name);
  Raster raster;
  try {
    raster = read_stacks(folder, number, name, options, report, [&](int f, std::vector<std::string>& notes) {
      return pixels_of_file(folder.files[std::size_t(f)], options, notes);
    });
  } catch (const SeriesChoice&) {
    throw;
  } catch (const core::BadInput& bad) {
    refuse_with_damaged(bad, folder);
  }
  // Where a file was named, only what may belong to its series matters.
  std::vector<LeftOut> told = folder.left_out;
  if (number >= 0)
    told.erase(std::remove_if(told.begin(), told.end(), [](const LeftOut& l) { return !l.dicom; }), told.end());
  for (std::string& note : notes_on(told)) report.notes.push_back(std::move(note));
  return raster;
}

Raster read_dicom_bytes(const Source& source) {
  source.report.format = "DICOM";
  const DicomDocument file = parse_dicom(source.bytes, source.file);
  DicomFolder folder;
  folder.files.push_back(dicom_header(file, source.file));
  const DicomHeader& header = folder.files[0];
  if (!header.fault.empty()) refuse(source.file, header.fault);
  return read_stacks(folder, 0, source.file, source.options, source.report, [&](int, std::vector<std::string>& notes) {
    return dicom_pixels(file, header, source.options.most_voxels, notes);
  });
}

}  // namespace trocar::volumes
