// Several DICOM files together: which of their images are stacks, which are copies, which are points in time.
#include <algorithm>

#include <fmt/format.h>

#include <trocar/volumes/files/dicom_stacks.hpp>
#include <trocar/volumes/files/slice_stack.hpp>

#include "../volumes/dicom_bytes.hpp"
#include "targets.hpp"

namespace trocar::fuzz {
namespace {

using namespace volumes;

constexpr std::string_view kBetween = "|next file|";
constexpr std::size_t kMostFiles = 24, kMostImages = 100'000;  // as a folder may have

std::vector<std::string> split(const std::string& bytes) {
  std::vector<std::string> out;
  for (std::size_t at = 0; at <= bytes.size() && out.size() < kMostFiles;) {
    const std::size_t end = std::min(bytes.find(kBetween, at), bytes.size());
    out.push_back(bytes.substr(at, end - at));
    at = end + kBetween.size();
  }
  return out;
}

std::vector<DicomHeader> headers_of(const std::vector<std::string>& files) {
  std::vector<DicomHeader> out;
  std::size_t images = 0;
  for (const std::string& bytes : files) {
    if (!looks_like_dicom(bytes) || images > kMostImages) continue;
    try {
      DicomHeader header = dicom_header(parse_dicom(bytes, "memory"), fmt::format("{}.dcm", out.size()));
      require(header.fault.empty() != header.frames.empty(), "a file has frames or a fault");
      images += header.frames.size();
      if (header.fault.empty()) out.push_back(std::move(header));
    } catch (const core::BadInput&) {
    }
  }
  return out;
}

/// Nothing comes twice, and no group has two images at one position.
void check(const DicomStack& stack, const std::vector<DicomHeader>& files) {
  const auto frame = [&](int i) -> const DicomFrame& {
    const ImageAt at = stack.images[std::size_t(i)];
    return files[std::size_t(at.file)].frames[std::size_t(at.frame)];
  };
  std::vector<int> seen;
  for (const ImageGroup& group : stack.groups) {
    require(!group.images.empty() && group.images.size() == stack.groups[0].images.size(), "time points are alike");
    require(stack.groups.size() == 1 || !group.name.empty(), "a time point has a name");
    seen.insert(seen.end(), group.images.begin(), group.images.end());
    if (!stack.fault.empty()) continue;
    std::vector<SlicePlace> places;
    for (const int i : group.images) places.push_back({frame(i).position, 0});
    for (const auto& level : levels_of(places, normalised(cross(frame(0).row, frame(0).column))))
      require(level.size() == 1, "a time point has one image at a position");
  }
  std::sort(seen.begin(), seen.end());
  require(seen.size() == stack.images.size(), "every image is in a group");
  for (std::size_t i = 0; i < seen.size(); ++i) require(seen[i] == int(i), "no image is in two groups");
  require(!facts_of(stack, files).detail.empty(), "a stack is described");
}

}  // namespace

void dicom_folder(Bytes bytes) {
  const std::vector<DicomHeader> files = headers_of(split(text_of(bytes)));
  const PixelsDigest digest = [&](ImageAt image) {
    const DicomHeader& file = files[std::size_t(image.file)];
    return file.allocated == 8 ? std::string() : fmt::format("{}", file.rows);  // as if those of 8 bits were damaged
  };
  std::size_t images = 0, frames = 0;
  for (const DicomHeader& file : files) frames += file.frames.size();
  try {
    for (const DicomStack& stack : dicom_stacks(files, digest, "memory")) {
      check(stack, files);
      images += stack.images.size();
    }
    require(images <= frames, "no image is in two stacks");
  } catch (const core::BadInput& bad) {
    require(!bad.faults().empty(), "a fault says what was expected");
  }
}

std::vector<Seed> dicom_folder_seeds() {
  const auto folder = [](int files, const std::function<void(int, DicomFile&)>& set) {
    std::string out;
    for (int i = 0; i < files; ++i) {
      DicomFile file;
      file.instance = i;
      file.object = fmt::format("1.2.{}", i);
      file.position = fmt::format("0\\0\\{}", 2 * (i % 3));
      set(i, file);
      out += (i > 0 ? std::string(kBetween) : "") + file.bytes();
    }
    return bytes_of(out);
  };
  return {{"one series", folder(3, [](int, DicomFile&) {})},
          {"phases", folder(6,
                            [](int i, DicomFile& f) {
                              f.more = {{0x00200012, "IS", std::to_string(i / 3)}};
                            })},
          {"unlike", folder(5,
                            [](int i, DicomFile& f) {
                              f.more = {{0x00200012, "IS", std::to_string(i / 3)}};
                            })},
          {"copies", folder(6, [](int, DicomFile& f) { f.instance = 1, f.object = "1.2"; })},
          {"times", folder(6,
                           [](int i, DicomFile& f) {
                             f.more = {{0x00181060, "DS", std::to_string(31 * i)}};
                           })},
          {"frames", folder(1,
                            [](int, DicomFile& f) {
                              f.frames = 6, f.frame_time = [](int k) { return k % 2; };
                              f.frame_position = [](int k) { return fmt::format("0\\0\\{}", k / 2); };
                            })},
          {"directions", folder(1, [](int, DicomFile& f) {
             f.frames = 4;
             f.frame_orientation = [](int k) { return k < 2 ? "1\\0\\0\\0\\1\\0" : "0\\1\\0\\0\\0\\-1"; };
           })}};
}

}  // namespace trocar::fuzz
