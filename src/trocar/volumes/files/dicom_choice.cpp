#include <algorithm>
#include <set>

#include <fmt/format.h>

#include <trocar/core/text.hpp>
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

std::size_t default_stack(const std::vector<DicomStack>& stacks, int file, const std::string& name,
                          const ReadOptions& options, const std::vector<SeriesFacts>& series) {
  std::vector<std::size_t> candidates;
  if (file < 0) candidates = parts_beside(stacks, 0);
  for (std::size_t s = 0; s < stacks.size() && file >= 0; ++s)
    if (holds(stacks[s], file)) candidates.push_back(s);
  if (candidates.size() == 1) return candidates[0];
  const bool acquisitions =
      std::any_of(candidates.begin(), candidates.end(), [&](std::size_t s) { return !stacks[s].part.empty(); });
  const bool by_number = acquisitions && stacks[candidates[0]].told_by == name_of(Mark::instance);
  const std::string list = described(series, candidates);
  if (by_number)
    throw SeriesChoice(name,
                       tr("expected acquisitions, echoes or times that distinguish {} images at each position, got "
                          "Instance Number alone: choose one with {}: {}",
                          candidates.size(), options.series_choice, list),
                       series);
  throw SeriesChoice(name,
                     acquisitions ? tr("expected one image at each position, got {} acquisitions of unlike extent: "
                                       "choose one with {}: {}",
                                       candidates.size(), options.series_choice, list)
                                  : tr("expected slices of one direction and size, got {}: choose one with "
                                       "{}: {}",
                                       candidates.size(), options.series_choice, list),
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

}  // namespace

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
