#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include <fmt/format.h>

#include <trocar/core/text.hpp>
#include <trocar/volumes/files/dicom_stacks.hpp>
#include <trocar/volumes/files/slice_stack.hpp>

namespace trocar::volumes {
namespace {

constexpr std::size_t kMostStacks = 2000;

class Stacks {
 public:
  Stacks(const std::vector<DicomHeader>& files, const PixelsDigest& pixels, const std::string& name)
      : m_files(files), m_pixels(pixels), m_name(name) {}

  std::vector<DicomStack> run() {
    collect();
    std::vector<DicomStack> out;
    for (DicomStack& stack : m_stacks) part(std::move(stack), out);
    std::stable_sort(out.begin(), out.end(), [&](const DicomStack& a, const DicomStack& b) {
      const std::size_t na = a.slices(), nb = b.slices();
      return na != nb ? na > nb : file_of(a, 0).uid < file_of(b, 0).uid;
    });
    return out;
  }

 private:
  const std::vector<DicomHeader>& m_files;
  const PixelsDigest& m_pixels;
  const std::string& m_name;
  std::vector<DicomStack> m_stacks;

  const DicomHeader& file_of(const DicomStack& stack, int image) const {
    return m_files[std::size_t(stack.images[std::size_t(image)].file)];
  }
  const DicomFrame& frame_of(const DicomStack& stack, int image) const {
    return file_of(stack, image).frames[std::size_t(stack.images[std::size_t(image)].frame)];
  }

  void collect() {
    std::map<std::string, std::vector<std::size_t>> of_series;
    for (std::size_t f = 0; f < m_files.size(); ++f) {
      std::vector<std::size_t>& candidates = of_series[m_files[f].uid];
      for (std::size_t k = 0; k < m_files[f].frames.size(); ++k) {
        const auto found = std::find_if(candidates.begin(), candidates.end(), [&](std::size_t s) {
          return same_stack(file_of(m_stacks[s], 0), frame_of(m_stacks[s], 0), m_files[f], m_files[f].frames[k]);
        });
        std::size_t s = found == candidates.end() ? m_stacks.size() : *found;
        if (found == candidates.end()) {
          if (s >= kMostStacks) refuse(m_name, tr("expected at most {} series or directions, got more", kMostStacks));
          candidates.push_back(s);
          m_stacks.emplace_back();
          m_stacks.back().series = int(s);
        }
        m_stacks[s].images.push_back({int(f), int(k)});
      }
    }
    for (const auto& [uid, candidates] : of_series) name_origins(candidates);
  }

  /// Which patient, study or frame of reference a stack is of, where its series has several.
  void name_origins(const std::vector<std::size_t>& stacks) {
    struct Origin {
      const char* name;
      std::string DicomHeader::*value;
    };
    const Origin origins[] = {{"Patient ID", &DicomHeader::patient},
                              {"Study Instance UID", &DicomHeader::study},
                              {"Frame of Reference UID", &DicomHeader::frame_of_reference}};
    for (const Origin& origin : origins) {
      const auto value = [&](std::size_t s) -> const std::string& { return file_of(m_stacks[s], 0).*origin.value; };
      const bool several =
          std::any_of(stacks.begin(), stacks.end(), [&](std::size_t s) { return value(s) != value(stacks[0]); });
      if (!several) continue;
      for (const std::size_t s : stacks)
        m_stacks[s].origin = fmt::format("{} {}", origin.name, value(s).empty() ? tr("not said") : value(s));
      return;
    }
  }

  std::vector<std::vector<int>> levels(const DicomStack& stack) const {
    std::vector<SlicePlace> places;
    for (std::size_t i = 0; i < stack.images.size(); ++i) places.push_back({frame_of(stack, int(i)).position, 0});
    const DicomFrame& first = frame_of(stack, 0);
    return levels_of(places, normalised(cross(first.row, first.column)));
  }
  static bool crowded(const std::vector<std::vector<int>>& levels) {
    return std::any_of(levels.begin(), levels.end(), [](const auto& l) { return l.size() > 1; });
  }

  /// One volume, one with time points, or several volumes that only partly have the same positions.
  void part(DicomStack stack, std::vector<DicomStack>& out) {
    auto at = levels(stack);
    if (crowded(at) && drop_copies(stack, at)) at = levels(stack);
    std::vector<int> all;
    for (const std::vector<int>& level : at) all.insert(all.end(), level.begin(), level.end());
    stack.groups = {{"", std::move(all)}};
    std::vector<Marks> marks;
    for (std::size_t i = 0; i < stack.images.size(); ++i) marks.push_back(frame_of(stack, int(i)).marks);
    if (!crowded(at)) return part_interleaved(std::move(stack), marks, out);
    ImageGroups told = grouped(at, marks);
    const bool by_number = told.told_by == name_of(Mark::instance);  // which may be of anything
    if ((told.groups.empty() || by_number) && drop_renamed(stack, at)) return part(std::move(stack), out);
    if (told.groups.empty()) {
      stack.fault = not_told_apart(stack, at);
      return out.push_back(std::move(stack));
    }
    stack.told_by = told.told_by;
    if (told.alike && !by_number) {
      stack.groups = std::move(told.groups);
      return out.push_back(std::move(stack));
    }
    for (ImageGroup& group : told.groups) out.push_back(parted(stack, group));
  }

  /// Acquisitions whose slices lie between each other.
  void part_interleaved(DicomStack stack, const std::vector<Marks>& marks, std::vector<DicomStack>& out) const {
    const DicomFrame& first = frame_of(stack, 0);
    const Vec3d normal = normalised(cross(first.row, first.column));
    std::vector<double> along;
    for (std::size_t i = 0; i < stack.images.size(); ++i)
      along.push_back(dot(frame_of(stack, int(i)).position, normal));
    const ImageGroups told = interleaved(along, marks);
    if (told.groups.empty()) return out.push_back(std::move(stack));
    stack.told_by = told.told_by;
    stack.between = true;
    for (const ImageGroup& group : told.groups) out.push_back(parted(stack, group));
  }

  static DicomStack parted(const DicomStack& whole, const ImageGroup& group) {
    DicomStack out;
    out.part = group.name;
    out.told_by = whole.told_by;
    out.origin = whole.origin;
    out.between = whole.between;
    out.series = whole.series;
    out.copies = whole.copies;
    out.groups.emplace_back();
    for (const int i : group.images) {
      out.groups[0].images.push_back(int(out.images.size()));
      out.images.push_back(whole.images[std::size_t(i)]);
    }
    return out;
  }

  std::string not_told_apart(const DicomStack& stack, const std::vector<std::vector<int>>& at) const {
    const auto two = std::find_if(at.begin(), at.end(), [](const auto& l) { return l.size() > 1; });
    const DicomFrame& first = frame_of(stack, 0);
    return tr(
        "expected one image at each position, or acquisitions, echoes or times that distinguish several, got {} "
        "at {:.2f} mm that nothing distinguishes ({} and {})",
        two->size(), dot(frame_of(stack, (*two)[0]).position, cross(first.row, first.column)),
        file_of(stack, (*two)[0]).path, file_of(stack, (*two)[1]).path);
  }

  /// The same object with the same pixels at the same position: a copy. True where there was one.
  bool drop_copies(DicomStack& stack, const std::vector<std::vector<int>>& at) {
    std::set<int> dropped;
    for (const std::vector<int>& level : at) {
      std::map<std::string, std::vector<int>> alike;
      for (const int i : level) alike[identity(stack, i)].push_back(i);
      for (const auto& [text, images] : alike) drop_copies_of(stack, images, dropped);
    }
    return take_out(stack, dropped);
  }
  static bool take_out(DicomStack& stack, const std::set<int>& dropped) {
    if (dropped.empty()) return false;
    std::vector<ImageAt> kept;
    for (std::size_t i = 0; i < stack.images.size(); ++i)
      if (!dropped.count(int(i))) kept.push_back(stack.images[i]);
    stack.images = std::move(kept);
    return true;
  }
  /// Copies that were given identifiers of their own: at every position all images have the same pixels.
  bool drop_renamed(DicomStack& stack, const std::vector<std::vector<int>>& at) {
    for (const std::vector<int>& level : at) {
      const std::string first = level.size() > 1 ? m_pixels(stack.images[std::size_t(level[0])]) : "";
      for (std::size_t i = 1; i < level.size(); ++i)
        if (first.empty() || m_pixels(stack.images[std::size_t(level[i])]) != first) return false;
    }
    std::set<int> dropped;
    for (const std::vector<int>& level : at)
      for (std::size_t i = 1; i < level.size(); ++i) drop(stack, level[i], level[0], dropped);
    return take_out(stack, dropped);
  }
  void drop_copies_of(DicomStack& stack, const std::vector<int>& images, std::set<int>& dropped) {
    if (images.size() < 2) return;
    std::map<std::string, int> first;  // with these pixels
    std::vector<int> damaged;
    for (const int i : images) {
      const std::string pixels = m_pixels(stack.images[std::size_t(i)]);
      if (pixels.empty()) {
        damaged.push_back(i);
      } else if (const auto [kept, is_new] = first.emplace(pixels, i); !is_new) {
        drop(stack, i, kept->second, dropped);
      }
    }
    if (first.size() == 1)
      for (const int i : damaged) drop(stack, i, first.begin()->second, dropped);
  }
  static void drop(DicomStack& stack, int copy, int original, std::set<int>& dropped) {
    const std::pair<int, int> files{stack.images[std::size_t(copy)].file, stack.images[std::size_t(original)].file};
    if (files.first == files.second) return;
    dropped.insert(copy);
    if (stack.copies.empty() || stack.copies.back() != files) stack.copies.push_back(files);
  }
  /// All that a copy has in common with its original, besides its pixels.
  std::string identity(const DicomStack& stack, int image) const {
    std::string out = file_of(stack, image).instance;
    for (const std::string& value : frame_of(stack, image).marks.values) out += "\n" + value;
    return out;
  }
};

const char* plane_of(const DicomFrame& frame) {
  const Vec3d n = cross(frame.row, frame.column);
  const double x = std::fabs(n.x), y = std::fabs(n.y), z = std::fabs(n.z);
  return z >= x && z >= y ? tr("axial") : y >= x ? tr("coronal") : tr("sagittal");
}

}  // namespace

std::vector<DicomStack> dicom_stacks(const std::vector<DicomHeader>& files, const PixelsDigest& pixels,
                                     const std::string& name) {
  return Stacks(files, pixels, name).run();
}

bool holds(const DicomStack& stack, int file) {
  return std::any_of(stack.images.begin(), stack.images.end(), [&](const ImageAt& i) { return i.file == file; }) ||
         std::any_of(stack.copies.begin(), stack.copies.end(), [&](const auto& c) { return c.first == file; });
}

SeriesFacts facts_of(const DicomStack& stack, const std::vector<DicomHeader>& files) {
  const DicomHeader& first = files[std::size_t(stack.images[0].file)];
  std::set<int> of;
  for (const ImageAt& image : stack.images) of.insert(image.file);
  return {first.uid,
          first.description,
          first.modality,
          int(of.size()),
          {first.columns, first.rows, int(stack.slices())},
          std::string(plane_of(first.frames[std::size_t(stack.images[0].frame)])) +
              (stack.origin.empty() ? "" : ", " + stack.origin) + (stack.part.empty() ? "" : ", " + stack.part),
          int(stack.groups.size())};
}

}  // namespace trocar::volumes
