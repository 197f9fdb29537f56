#include <algorithm>
#include <cmath>
#include <set>

#include <fmt/format.h>

#include <trocar/core/text.hpp>
#include <trocar/numerics/portable.hpp>
#include <trocar/volumes/files/dicom_choice.hpp>

namespace trocar::volumes {
namespace {

std::string described(const std::vector<SeriesFacts>& series, std::size_t s) {
  const SeriesFacts& f = series[s];
  return tr("{} '{}' ({} x {} x {}, {})", s + 1, f.description, f.size[0], f.size[1], f.size[2], f.detail);
}
std::string described(const std::vector<SeriesFacts>& series, const std::vector<std::size_t>& which) {
  constexpr std::size_t kMostNamed = 20;
  std::string out;
  for (std::size_t i = 0; i < which.size() && i < kMostNamed; ++i)
    out += (i > 0 ? ", " : "") + described(series, which[i]);
  return which.size() > kMostNamed ? out + ", ..." : out;
}

/// Stacks that are parts of the same series or file as this one: none of them is the whole.
std::vector<std::size_t> parts_beside(const std::vector<DicomStack>& stacks, std::size_t of) {
  std::set<int> files;
  for (const ImageAt& image : stacks[of].images) files.insert(image.file);
  std::vector<std::size_t> out;
  for (std::size_t s = 0; s < stacks.size(); ++s) {
    const bool one_file = std::any_of(stacks[s].images.begin(), stacks[s].images.end(),
                                      [&](const ImageAt& i) { return files.count(i.file) > 0; });
    if (stacks[s].series == stacks[of].series || one_file) out.push_back(s);
  }
  return out;
}

/// Parts of one series without being parted from each other: of other patients, or about as large, such as three planes
/// of a localizer.
void add_equals(const std::vector<DicomStack>& stacks, const std::vector<SeriesFacts>& series,
                std::vector<std::size_t>& candidates) {
  for (std::size_t s = 1; s < stacks.size(); ++s) {
    const bool same_series = !series[0].uid.empty() && series[s].uid == series[0].uid;
    const bool equal = 2 * stacks[s].slices() >= stacks[0].slices() || stacks[s].origin != stacks[0].origin;
    if (same_series && equal && std::find(candidates.begin(), candidates.end(), s) == candidates.end())
      candidates.push_back(s);
  }
}

std::string choice_among(const std::vector<DicomStack>& stacks, const std::vector<std::size_t>& candidates,
                         const std::string& key, const std::string& list) {
  const std::size_t count = candidates.size();
  const auto any = [&](auto&& holds) {
    return std::any_of(candidates.begin(), candidates.end(), [&](std::size_t s) { return holds(stacks[s]); });
  };
  const DicomStack& first = stacks[candidates[0]];
  if (any([&](const DicomStack& s) { return s.origin != first.origin; }))
    return tr(
        "expected slices of one patient, study and frame of reference in a series, got {} volumes: choose one with "
        "{}: {}",
        count, key, list);
  if (any([](const DicomStack& s) { return s.between; }))
    return tr("expected slices of one acquisition, got {} whose slices lie between each other: choose one with {}: {}",
              count, key, list);
  if (!any([](const DicomStack& s) { return !s.part.empty(); }))
    return tr("expected slices of one direction and size, got {}: choose one with {}: {}", count, key, list);
  if (first.told_by == name_of(Mark::instance))
    return tr(
        "expected acquisitions, echoes or times that distinguish {} images at each position, got Instance Number "
        "alone: choose one with {}: {}",
        count, key, list);
  return tr("expected one image at each position, got {} acquisitions of unlike extent: choose one with {}: {}", count,
            key, list);
}

std::size_t default_stack(const std::vector<DicomStack>& stacks, int file, const std::string& name,
                          const ReadOptions& options, const std::vector<SeriesFacts>& series) {
  std::vector<std::size_t> candidates;
  if (file < 0) {
    candidates = parts_beside(stacks, 0);
    add_equals(stacks, series, candidates);
  }
  for (std::size_t s = 0; s < stacks.size() && file >= 0; ++s)
    if (holds(stacks[s], file)) candidates.push_back(s);
  if (candidates.size() == 1) return candidates[0];
  throw SeriesChoice(name, choice_among(stacks, candidates, options.series_choice, described(series, candidates)),
                     series);
}

/// A damaged file of the series is a slice that is missing, if it is no copy of one that is there.
void require_whole(const DicomFolder& folder, const DicomStack& stack, const std::string& name) {
  if (!stack.fault.empty()) refuse(name, stack.fault);
  const auto file_of = [&](const ImageAt& image) -> const DicomHeader& {
    return folder.files[std::size_t(image.file)];
  };
  const std::string& uid = file_of(stack.images[0]).uid;
  for (const LeftOut& left : folder.left_out) {
    if (!left.broken || uid.empty() || left.series_uid != uid) continue;
    const bool is_there = std::any_of(stack.images.begin(), stack.images.end(),
                                      [&](const ImageAt& i) { return file_of(i).instance == left.instance; });
    if (left.instance.empty() || !is_there) refuse(left.path, left.why);
  }
}

/// How a slice differs from those of a stack; empty: not.
std::string difference(const DicomHeader& header, const DicomFrame& frame, const DicomHeader& other,
                       const DicomFrame& in_other) {
  if (header.rows != other.rows || header.columns != other.columns)
    return tr("expected {} x {} pixels as in the other slices, got {} x {}", other.columns, other.rows, header.columns,
              header.rows);
  if (std::fabs(frame.between_rows - in_other.between_rows) >= 1e-4 ||
      std::fabs(frame.between_columns - in_other.between_columns) >= 1e-4)
    return tr("expected the Pixel Spacing {} x {} mm as in the other slices, got {} x {}", in_other.between_rows,
              in_other.between_columns, frame.between_rows, frame.between_columns);
  const Vec3d normal = cross(frame.row, frame.column), other_normal = cross(in_other.row, in_other.column);
  const double turned = std::max(
      {length(frame.row - in_other.row), length(frame.column - in_other.column), length(normal - other_normal)});
  if (turned >= 1e-3)
    return tr("expected the Image Orientation (Patient) of the other slices, got one turned by {:.2g} degrees",
              2 * std::asin(std::min(1.0, turned / 2)) * 180 / portable::pi);
  if (!same_origin(header, other))
    return tr("expected the patient, study and frame of reference of the other slices, got others");
  return tr("expected the SOP Class of the other slices, got another kind of object");
}

}  // namespace

std::vector<core::Fault> faults_of_set_aside(const std::vector<DicomStack>& stacks, const DicomStack& chosen,
                                             const std::vector<DicomHeader>& files) {
  constexpr std::size_t kMostNamed = 10;
  const auto header = [&](const ImageAt& i) -> const DicomHeader& { return files[std::size_t(i.file)]; };
  const auto frame = [&](const ImageAt& i) -> const DicomFrame& { return header(i).frames[std::size_t(i.frame)]; };
  const ImageAt& first = chosen.images[0];
  const Vec3d normal = cross(frame(first).row, frame(first).column);
  double low = dot(frame(first).position, normal), high = low;
  for (const ImageAt& i : chosen.images) {
    low = std::min(low, dot(frame(i).position, normal));
    high = std::max(high, dot(frame(i).position, normal));
  }
  std::vector<core::Fault> out;
  for (const DicomStack& stack : stacks) {
    if (&stack == &chosen || stack.between || header(first).uid.empty() ||
        header(first).uid != header(stack.images[0]).uid)
      continue;
    for (const ImageAt& i : stack.images) {
      const double along = dot(frame(i).position, normal);
      const bool among =
          along > low && along < high && std::fabs(dot(cross(frame(i).row, frame(i).column), normal)) > 0.9;
      if (among && out.size() < kMostNamed)
        out.push_back({{header(i).path, 0, 0},
                       tr("{}: it was set aside, export the series again",
                          difference(header(i), frame(i), header(first), frame(first)))});
    }
  }
  return out;
}

std::size_t choose_stack(const DicomFolder& folder, const std::vector<DicomStack>& stacks, int file,
                         const std::string& name, const ReadOptions& options, ReadReport& report) {
  for (const DicomStack& stack : stacks) report.series.push_back(facts_of(stack, folder.files));
  const int count = int(stacks.size()), series = options.series;
  if (series < 0 || series > count)
    refuse(name, tr("expected one of {} series (1 to {}), got {}", count, count, series));
  const std::size_t chosen =
      series > 0 ? std::size_t(series - 1) : default_stack(stacks, file, name, options, report.series);
  report.chosen_series = int(chosen) + 1;
  require_whole(folder, stacks[chosen], name);
  if (count == 1) return chosen;
  std::vector<std::size_t> others;
  for (std::size_t s = 0; s < stacks.size(); ++s)
    if (s != chosen) others.push_back(s);
  report.notes.push_back(tr("series {} of {} is read; others, to be chosen with {}: {}",
                            described(report.series, chosen), count, options.series_choice,
                            described(report.series, others)));
  return chosen;
}

int choose_group(const DicomStack& stack, int file, const std::string& name, const ReadOptions& options,
                 ReadReport& report) {
  const int count = int(stack.groups.size());
  report.frames = count;
  for (const ImageGroup& group : stack.groups) report.frame_names.push_back(group.name);
  int own = 0;  // the first with an image of the file that was named
  for (int g = count - 1; g >= 0 && file >= 0; --g)
    for (const int i : stack.groups[std::size_t(g)].images)
      if (stack.images[std::size_t(i)].file == file) own = g;
  const int wanted = options.frame.value_or(own);
  report.frame = wanted;
  if (wanted < 0 || wanted >= count)
    refuse(name, tr("expected one of {} images at each position (0 to {}), got {}", count, count - 1, wanted));
  if (count == 1) return 0;
  std::vector<std::string> others;
  for (int g = 0; g < count; ++g)
    if (g != wanted) others.push_back(fmt::format("{} ({})", g, stack.groups[std::size_t(g)].name));
  report.notes.push_back(
      tr("{} time points or phases, told apart by {}: number {} is read ({}); others, to be chosen "
         "with {}: {}",
         count, stack.told_by, wanted, report.frame_names[std::size_t(wanted)], options.frame_choice, few_of(others)));
  return wanted;
}

}  // namespace trocar::volumes
