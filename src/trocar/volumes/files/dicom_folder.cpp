#include <algorithm>
#include <fstream>
#include <optional>
#include <system_error>

#include <fmt/format.h>

#include <trocar/core/error.hpp>
#include <trocar/core/files.hpp>
#include <trocar/core/foreign/foreign_file.hpp>
#include <trocar/core/letters.hpp>
#include <trocar/core/printable.hpp>
#include <trocar/core/text.hpp>
#include <trocar/volumes/files/dicom_folder.hpp>
#include <trocar/volumes/files/dicom_kinds.hpp>
#include <trocar/volumes/files/readers.hpp>

namespace trocar::volumes {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMostFiles = 20'000, kMostImages = 100'000, kFew = 5;
constexpr int kDeepest = 6;
constexpr std::size_t kBeginning = std::size_t(1) << 16;  // most headers are shorter
constexpr std::uint64_t kMostFileBytes = std::uint64_t(1) << 31;

std::string no_file(const std::string& got) { return tr("expected a file that can be read, got {}", got); }

LeftOut unreadable(const fs::path& path, const std::string& why) {
  return {path.generic_string(), why, "", "", true, true, false};
}

/// The files of a folder and of the folders below it. What cannot be read is left out, as slices may be missing by it.
class FilesBelow {
 public:
  explicit FilesBelow(const fs::path& folder) : m_folder(folder) {
    visit(folder, 0);
    std::sort(files.begin(), files.end());
    std::sort(left_out.begin(), left_out.end(), [](const LeftOut& a, const LeftOut& b) { return a.path < b.path; });
  }

  std::vector<fs::path> files;
  std::vector<LeftOut> left_out;

 private:
  const fs::path& m_folder;

  void visit(const fs::path& folder, int depth) {
    std::error_code error;
    fs::directory_iterator it(folder, error), end;
    for (; !error && it != end; it.increment(error)) take(*it, depth);
    if (!error) return;  // an iterator that fails becomes the end
    const std::string why = tr("expected a folder that can be read, got {}", error.message());
    if (depth == 0) refuse(folder.generic_string(), why);
    left_out.push_back(unreadable(folder, why));
  }

  void take(const fs::directory_entry& entry, int depth) {
    std::error_code error;
    if (!entry.is_symlink(error) && entry.is_directory(error)) return below(entry.path(), depth);
    const bool is_file = entry.is_regular_file(error);
    if (error) return left_out.push_back(unreadable(entry.path(), no_file(error.message())));
    if (!is_file) return;
    if (files.size() >= kMostFiles)
      refuse(m_folder.generic_string(), tr("expected at most {} files in the folder, got more", kMostFiles));
    files.push_back(entry.path());
  }

  void below(const fs::path& folder, int depth) {
    if (depth < kDeepest) return visit(folder, depth + 1);
    left_out.push_back({folder.generic_string(), tr("a folder more than {} levels down: open it itself", kDeepest), "",
                        "", true, false, false});
  }
};

/// Empty where it cannot be read.
std::optional<std::string> beginning_of(const fs::path& path) {
  std::string bytes(kBeginning, '\0');
  std::ifstream in(path, std::ios::binary);
  if (!in) return {};
  in.read(bytes.data(), std::streamsize(bytes.size()));
  if (in.bad()) return {};
  bytes.resize(std::size_t(in.gcount()));
  return bytes;
}

/// Its header, or why there is none: nothing said where this is no DICOM file.
DicomHeader header_of(const fs::path& path, const std::string& beginning) {
  const std::string name = path.generic_string();
  DicomHeader out;
  out.path = name;
  const bool marked = has_dicom_mark(beginning);
  try {
    const DicomDocument start = parse_dicom(beginning, name, true);
    if (!start.ends_early) {
      out = dicom_header(start, name);
    } else {
      OpenedDicom whole;
      open_dicom(path, whole);
      out = dicom_header(whole.file, name);
    }
  } catch (const core::BadInput& bad) {
    out.fault = bad.faults().front().message;
    out.broken = true;
  }
  // Some other file may begin as DICOM without its mark does.
  if (!marked && !out.fault.empty() && out.uid.empty()) out.fault = tr("no DICOM file"), out.broken = false;
  return out;
}

std::string kind_of(const std::string& beginning) {
  if (looks_like_nifti(beginning) || looks_like_nrrd(beginning) || looks_like_metaimage(beginning))
    return tr("another volume: open the file itself");
  if (beginning.empty()) return tr("an empty file");
  const std::string known = core::foreign_file(beginning, core::Wanted::volume);
  return known.empty() ? tr("no DICOM file") : known;
}

/// A file with slices, or one that is left out.
/// @returns its images
std::size_t add_file(const fs::path& path, DicomFolder& out) {
  const std::string name = path.generic_string();
  const std::optional<std::string> beginning = beginning_of(path);
  if (!beginning) {
    out.left_out.push_back(unreadable(path, no_file(tr("one that cannot be opened or read"))));
    return 0;
  }
  if (!looks_like_dicom(*beginning)) {
    out.left_out.push_back({name, kind_of(*beginning), "", "", false, false, false});
    return 0;
  }
  DicomHeader header = header_of(path, *beginning);
  const std::size_t images = header.frames.size();
  if (header.fault.empty()) {
    out.files.push_back(std::move(header));
    return images;
  }
  const bool is_list =
      is_dicom_directory(header.sop_class) || core::in_small_letters(path.filename().string()) == "dicomdir";
  out.left_out.push_back({name, header.fault, header.uid, header.instance, header.broken, true, is_list});
  return 0;
}

}  // namespace

void open_dicom(const fs::path& path, OpenedDicom& out) {
  out.bytes = core::read_file(path, kMostFileBytes);
  out.file = parse_dicom(out.bytes, path.generic_string());
}

DicomFolder read_dicom_folder(const fs::path& folder, const Progress& progress) {
  DicomFolder out;
  FilesBelow below(folder);
  out.left_out = std::move(below.left_out);
  std::size_t images = 0;
  for (std::size_t i = 0; i < below.files.size(); ++i) {
    tell(progress, double(i) / double(below.files.size()));
    images += add_file(below.files[i], out);
    if (images > kMostImages)
      refuse(folder.generic_string(), tr("expected at most {} images in the folder, got more", kMostImages));
  }
  return out;
}

std::string few_of(const std::vector<std::string>& names) {
  std::string out;
  for (std::size_t i = 0; i < names.size() && i < kFew; ++i) out += (i > 0 ? ", " : "") + core::printable(names[i]);
  return names.size() > kFew ? tr("{} and {} more", out, names.size() - kFew) : out;
}

std::vector<std::string> notes_on(const std::vector<LeftOut>& left_out) {
  std::vector<std::pair<std::string, std::vector<std::string>>> reasons;
  for (const LeftOut& file : left_out) {
    const auto same = std::find_if(reasons.begin(), reasons.end(), [&](const auto& r) { return r.first == file.why; });
    const std::string name = fs::path(file.path).filename().generic_string();
    if (same != reasons.end())
      same->second.push_back(name);
    else
      reasons.push_back({file.why, {name}});
  }
  std::vector<std::string> out;
  for (const auto& [why, names] : reasons) out.push_back(tr("left out: {} ({})", few_of(names), why));
  return out;
}

}  // namespace trocar::volumes
