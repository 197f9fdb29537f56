#include "commands/checks/check_scan.hpp"

#include <algorithm>
#include <string>

#include <fmt/format.h>

#include <trocar/core/letters.hpp>
#include <trocar/core/printable.hpp>
#include <trocar/core/text.hpp>

namespace trocar::app {

namespace fs = std::filesystem;

namespace {

Json in_three(Vec3d v) { return {v.x + 0, v.y + 0, v.z + 0}; }  // + 0: no "-0"

Json as_json(const volumes::SeriesFacts& s) {
  return {{"name", s.description}, {"modality", s.modality}, {"files", s.files},
          {"size", s.size},        {"detail", s.detail},     {"frames", s.frames}};
}

}  // namespace

bool is_scan_file(const fs::path& path) {
  std::error_code error;
  if (fs::is_directory(path, error)) return true;
  const std::string name = core::in_small_letters(path.filename().string());
  static constexpr const char* kScans[] = {".nii", ".nii.gz", ".nrrd", ".nhdr", ".mha", ".mhd", ".dcm", ".hdr", ".img"};
  return std::any_of(std::begin(kScans), std::end(kScans), [&](const char* end) { return name.ends_with(end); }) ||
         volumes::begins_as_dicom(path);
}

Json describe_scan(const fs::path& path, volumes::ReadOptions options) {
  options.series_choice = "--series";
  options.frame_choice = "--frame";
  const volumes::VolumeFile scan = volumes::read_volume(path, options);
  const volumes::Grid& grid = scan.volume.grid;
  const volumes::ReadReport& report = scan.report;
  const volumes::Statistics values = volumes::statistics(scan.volume);
  const geometry::Bounds box = volumes::patient_box(grid);
  Json out{{"file", path.string()},
           {"kind", "scan"},
           {"format", report.format},
           {"size", grid.size},
           {"spacing_mm", in_three(grid.spacing)},
           {"box_lps_mm", {in_three(box.low), in_three(box.high)}},
           {"least", values.least},
           {"greatest", values.greatest},
           {"unit", scan.volume.unit},
           {"frame", report.frame},
           {"frames", report.frames},
           {"series", Json::array()},
           {"chosen_series", report.chosen_series},
           {"notes", report.notes}};
  for (const volumes::SeriesFacts& s : report.series) out["series"].push_back(as_json(s));
  return out;
}

void print_scan(const Json& m) {
  const auto at = [](const Json& three, int i) { return three[std::size_t(i)].get<double>(); };
  const Json &size = m["size"], &spacing = m["spacing_mm"], &low = m["box_lps_mm"][0], &high = m["box_lps_mm"][1];
  const std::string unit = m["unit"];
  fmt::print("{}", tr("  {}, {} x {} x {} voxels of {:.4g} x {:.4g} x {:.4g} mm, values {:g} to {:g}{}\n",
                      m["format"].get<std::string>(), size[0].get<int>(), size[1].get<int>(), size[2].get<int>(),
                      at(spacing, 0), at(spacing, 1), at(spacing, 2), m["least"].get<double>(),
                      m["greatest"].get<double>(), unit.empty() ? "" : " " + core::printable(unit)));
  fmt::print("{}", tr("  from {:.4g} to {:.4g} mm to the left, {:.4g} to {:.4g} to the back, {:.4g} to {:.4g} to the "
                      "head\n",
                      at(low, 0), at(high, 0), at(low, 1), at(high, 1), at(low, 2), at(high, 2)));
  for (const Json& note : m["notes"]) fmt::print("  {}\n", note.get<std::string>());
}

}  // namespace trocar::app
