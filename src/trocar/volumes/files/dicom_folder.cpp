#include <algorithm>
#include <fstream>

#include <fmt/format.h>

#include <trocar/core/error.hpp>
#include <trocar/core/files.hpp>
#include <trocar/core/foreign/foreign_file.hpp>
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

std::vector<fs::path> files_below(const fs::path& folder) {
  std::vector<fs::path> out;
  std::error_code error;
  fs::recursive_directory_iterator it(folder, fs::directory_options::skip_permission_denied, error), end;
  if (error) refuse(folder.generic_string(), tr("expected a folder that can be read, got {}", error.message()));
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

std::string beginning_of(const fs::path& path) {
  std::string bytes(kBeginning, '\0');
  std::ifstream in(path, std::ios::binary);
  in.read(bytes.data(), std::streamsize(bytes.size()));
  bytes.resize(std::size_t(in.gcount()));
  return bytes;
}

/// Its header, or why there is none: nothing said where this is no DICOM file.
DicomHeader header_of(const fs::path& path, const std::string& beginning) {
  const std::string name = path.generic_string();
  DicomHeader out;
  out.path = name;
  const bool marked = beginning.size() >= 132 && beginning.compare(128, 4, "DICM") == 0;
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

}  // namespace

void open_dicom(const fs::path& path, OpenedDicom& out) {
  out.bytes = core::read_file(path, kMostFileBytes);
  out.file = parse_dicom(out.bytes, path.generic_string());
}

DicomFolder read_dicom_folder(const fs::path& folder, const Progress& progress) {
  DicomFolder out;
  const std::vector<fs::path> files = files_below(folder);
  std::size_t images = 0;
  for (std::size_t i = 0; i < files.size(); ++i) {
    tell(progress, double(i) / double(files.size()));
    const std::string beginning = beginning_of(files[i]);
    if (!looks_like_dicom(beginning)) {
      out.left_out.push_back({files[i].generic_string(), kind_of(beginning), "", "", false, false, false});
      continue;
    }
    DicomHeader header = header_of(files[i], beginning);
    if (!header.fault.empty()) {
      out.left_out.push_back(
          {header.path, header.fault, header.uid, header.instance, header.broken, true,
           is_dicom_directory(header.sop_class) || geometry::lowered(files[i].filename().string()) == "dicomdir"});
      continue;
    }
    images += header.frames.size();
    if (images > kMostImages)
      refuse(folder.generic_string(), tr("expected at most {} images in the folder, got more", kMostImages));
    out.files.push_back(std::move(header));
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
