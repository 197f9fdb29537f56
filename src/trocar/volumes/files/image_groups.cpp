#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include <fmt/format.h>

#include <trocar/core/text.hpp>
#include <trocar/volumes/files/image_groups.hpp>

namespace trocar::volumes {
namespace {

using Parts = std::vector<std::vector<int>>;

/// Values that advance with time, or in the order in which images were taken. Where they differ from slice to slice,
/// their order at each position still counts.
constexpr Mark kOrders[] = {Mark::trigger_time,     Mark::cardiac_phase, Mark::reference_time,
                            Mark::acquisition_time, Mark::content_time,  Mark::temporal_position,
                            Mark::acquisition,      Mark::echo_time,     Mark::instance};

class Grouping {
 public:
  Grouping(const std::vector<std::vector<int>>& levels, std::span<const Marks> marks)
      : m_marks(marks), m_level(marks.size()), m_levels(levels.size()) {
    Parts all(1);
    for (std::size_t l = 0; l < levels.size(); ++l)
      for (const int i : levels[l]) {
        m_level[std::size_t(i)] = l;
        all[0].push_back(i);
      }
    m_parts = std::move(all);
  }

  ImageGroups run() {
    ImageGroups out;
    out.alike = balanced(m_parts);
    out.alike ? by_equal_parts() : by_few_parts();
    if (!single(m_parts)) return out;
    order_by_time();
    for (const Mark mark : m_used) {
      if (!out.told_by.empty()) out.told_by += ", ";
      out.told_by += name_of(mark);
    }
    for (std::vector<int>& images : m_parts) out.groups.push_back({name(images[0]), std::move(images)});
    return out;
  }

 private:
  std::span<const Marks> m_marks;
  std::vector<std::size_t> m_level;  // of each image
  std::size_t m_levels;
  Parts m_parts;
  std::vector<Mark> m_used;

  const std::string& value(int image, Mark mark) const { return m_marks[std::size_t(image)][mark]; }

  std::vector<std::size_t> counts(const std::vector<int>& part) const {
    std::vector<std::size_t> out(m_levels);
    for (const int i : part) ++out[m_level[std::size_t(i)]];
    return out;
  }
  /// Has each part equally many images at all positions, and some?
  bool balanced(const Parts& parts) const {
    if (parts.size() * m_levels > m_marks.size()) return false;  // and no time is spent on very many
    return std::all_of(parts.begin(), parts.end(), [&](const auto& part) {
      const auto n = counts(part);
      return std::all_of(n.begin(), n.end(), [&](std::size_t c) { return c == n[0]; });
    });
  }
  /// Has each part one image at most at each position?
  bool single(const Parts& parts) const {
    return std::all_of(parts.begin(), parts.end(), [&](const auto& part) {
      std::vector<std::size_t> at;
      for (const int i : part) at.push_back(m_level[std::size_t(i)]);
      std::sort(at.begin(), at.end());
      return std::adjacent_find(at.begin(), at.end()) == at.end();
    });
  }

  /// Every part by the values of a mark.
  Parts split(const Parts& parts, Mark mark) const {
    Parts out;
    for (const std::vector<int>& part : parts) {
      std::map<std::string, std::vector<int>, decltype(&mark_less)> by_value(&mark_less);
      for (const int i : part) by_value[value(i, mark)].push_back(i);
      for (auto& [text, images] : by_value) out.push_back(std::move(images));
    }
    return out;
  }

  /// Time points: marks that part the images at every position alike, then the order of those that advance.
  void by_equal_parts() {
    for (std::size_t m = 0; m < kMarks && !single(m_parts); ++m) {
      Parts next = split(m_parts, Mark(m));
      if (Mark(m) == Mark::instance || next.size() == m_parts.size() || !balanced(next)) continue;
      m_parts = std::move(next);
      m_used.push_back(Mark(m));
    }
    for (const Mark mark : kOrders)
      if (!single(m_parts) && orders(mark)) {
        m_parts = ranked(mark);
        m_used.push_back(mark);
      }
  }

  /// At each position of each part all values are there and differ.
  bool orders(Mark mark) const {
    return std::all_of(m_parts.begin(), m_parts.end(), [&](const auto& part) {
      for (const std::vector<int>& here : by_level(part)) {
        std::vector<std::string> values;
        for (const int i : here) values.push_back(value(i, mark));
        std::sort(values.begin(), values.end());
        if (values[0].empty() || std::adjacent_find(values.begin(), values.end()) != values.end()) return false;
      }
      return true;
    });
  }
  Parts by_level(const std::vector<int>& part) const {
    Parts out(m_levels);
    for (const int i : part) out[m_level[std::size_t(i)]].push_back(i);
    return out;
  }
  Parts ranked(Mark mark) const {
    Parts out;
    for (const std::vector<int>& part : m_parts) {
      Parts levels = by_level(part), ranks(levels[0].size());
      for (std::vector<int>& here : levels) {
        std::stable_sort(here.begin(), here.end(),
                         [&](int a, int b) { return mark_less(value(a, mark), value(b, mark)); });
        for (std::size_t r = 0; r < here.size(); ++r) ranks[r].push_back(here[r]);
      }
      out.insert(out.end(), ranks.begin(), ranks.end());
    }
    return out;
  }

  /// Acquisitions of unlike extent: the mark that parts them into fewest, else several marks. Parts of one image each,
  /// or so many that nobody chooses among them, are none.
  void by_few_parts() {
    constexpr std::size_t kMostParts = 100;
    const auto few = [&](const Parts& parts) {
      return 2 * parts.size() <= m_marks.size() && parts.size() <= kMostParts;
    };
    const auto useful = [&](const Parts& parts) { return few(parts) && single(parts); };
    Parts best, all = m_parts;
    for (std::size_t m = 0; m < kMarks; ++m) {
      if (Mark(m) == Mark::instance) continue;
      Parts next = split(m_parts, Mark(m));
      if (!useful(next) || (!best.empty() && next.size() >= best.size())) continue;
      best = std::move(next);
      m_used = {Mark(m)};
    }
    if (!best.empty()) return void(m_parts = std::move(best));
    for (std::size_t m = 0; m < kMarks && !single(all); ++m) {
      Parts next = split(all, Mark(m));
      if (Mark(m) == Mark::instance || next.size() == all.size() || !few(next)) continue;
      all = std::move(next);
      m_used.push_back(Mark(m));
    }
    if (useful(all)) m_parts = std::move(all);
  }

  /// Parts that no mark of their own orders in time: by when their first image was taken.
  void order_by_time() {
    for (const Mark mark : {Mark::temporal_position, Mark::trigger_time, Mark::cardiac_phase, Mark::reference_time})
      if (std::find(m_used.begin(), m_used.end(), mark) != m_used.end()) return;
    for (const Mark mark : {Mark::acquisition_time, Mark::content_time}) {
      std::vector<std::pair<std::string, std::vector<int>>> timed;
      for (const std::vector<int>& part : m_parts) {
        std::string first = value(part[0], mark);
        for (const int i : part) first = std::min(first, value(i, mark));
        timed.emplace_back(first, part);
      }
      if (std::any_of(timed.begin(), timed.end(), [](const auto& t) { return t.first.empty(); })) continue;
      std::stable_sort(timed.begin(), timed.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
      for (std::size_t p = 0; p < timed.size(); ++p) m_parts[p] = std::move(timed[p].second);
      return;
    }
  }

  std::string name(int image) const {
    std::string out;
    for (const Mark mark : m_used) {
      const std::string& said = value(image, mark);
      out += fmt::format("{}{} {}", out.empty() ? "" : ", ", name_of(mark), said.empty() ? tr("not said") : said);
    }
    return out;
  }
};

/// Positions of a part: are they evenly apart?
bool is_even(std::vector<double> along) {
  constexpr double kUneven = 0.1;  // of the distance, as where slices are put in order
  std::sort(along.begin(), along.end());
  const double apart = (along.back() - along.front()) / double(along.size() - 1);
  for (std::size_t i = 1; i < along.size(); ++i)
    if (std::fabs(along[i] - along[i - 1] - apart) > kUneven * apart + 0.01) return false;
  return true;
}

/// Two images at least in each part, evenly apart, over half of the whole extent.
bool lie_between_each_other(const Parts& parts, std::span<const double> along) {
  double least = INFINITY, greatest = -INFINITY, low = -INFINITY, high = INFINITY;
  for (const std::vector<int>& part : parts) {
    std::vector<double> own;
    for (const int i : part) own.push_back(along[std::size_t(i)]);
    if (own.size() < 2 || !is_even(own)) return false;
    const auto [first, last] = std::minmax_element(own.begin(), own.end());
    least = std::min(least, *first), greatest = std::max(greatest, *last);
    low = std::max(low, *first), high = std::min(high, *last);
  }
  return high - low >= 0.5 * (greatest - least);
}

}  // namespace

ImageGroups interleaved(std::span<const double> along, std::span<const Marks> marks) {
  for (const Mark mark : {Mark::image_type, Mark::acquisition}) {
    std::map<std::string, std::vector<int>, decltype(&mark_less)> by_value(&mark_less);
    for (std::size_t i = 0; i < marks.size(); ++i) by_value[marks[i][mark]].push_back(int(i));
    if (by_value.size() < 2) continue;
    Parts parts;
    std::set<std::string> times;
    for (auto& [value, images] : by_value) {
      times.insert(marks[std::size_t(images[0])][Mark::acquisition_time]);
      parts.push_back(std::move(images));
    }
    // Numbers that are given to parts of one acquisition do not count. Times may have been taken out.
    const bool one_time = mark == Mark::acquisition && times.size() == 1 && !times.begin()->empty();
    if (one_time || !lie_between_each_other(parts, along)) continue;
    ImageGroups out;
    out.alike = false;
    out.told_by = name_of(mark);
    for (std::vector<int>& images : parts) {
      const std::string& value = marks[std::size_t(images[0])][mark];
      out.groups.push_back(
          {fmt::format("{} {}", name_of(mark), value.empty() ? tr("not said") : value), std::move(images)});
    }
    return out;
  }
  return {};
}

ImageGroups grouped(const std::vector<std::vector<int>>& levels, std::span<const Marks> marks) {
  return Grouping(levels, marks).run();
}

}  // namespace trocar::volumes
