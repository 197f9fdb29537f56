#include <algorithm>
#include <cmath>
#include <iterator>

#include <fmt/format.h>

#include <trocar/attempt/timeline.hpp>
#include <trocar/core/tick.hpp>

namespace trocar::attempt {

double next_speed(double speed, bool faster) {
  constexpr double kSame = 1e-9;
  if (faster) {
    for (const double s : kPlayerSpeeds)
      if (s > speed + kSame) return s;
    return *std::prev(std::end(kPlayerSpeeds));
  }
  for (auto s = std::rbegin(kPlayerSpeeds); s != std::rend(kPlayerSpeeds); ++s)
    if (*s < speed - kSame) return *s;
  return *std::begin(kPlayerSpeeds);
}

std::uint64_t Timeline::tick_at(double place) const {
  const double tick = m_from + place * (m_to - m_from);
  if (!(tick > 0)) return 0;
  return tick < double(m_last) ? std::uint64_t(tick + 0.5) : m_last;
}

void Timeline::zoom(double factor, double around) {
  const double all = double(m_last), width = m_to - m_from;
  const double wanted = std::clamp(width * factor, std::min(double(kFrameTicks), all), all);
  const double share = width > 0 ? std::clamp((around - m_from) / width, 0.0, 1.0) : 0.5;
  m_from += share * (width - wanted);
  keep_inside(wanted);
}

void Timeline::pan(double share) {
  const double width = m_to - m_from;
  m_from += share * width;
  keep_inside(width);
}

void Timeline::follow(double tick) {
  if (tick >= m_from && tick <= m_to) return;
  const double width = m_to - m_from;
  m_from = tick - 0.1 * width;
  keep_inside(width);
}

void Timeline::show_all() {
  m_from = 0;
  m_to = double(m_last);
}

void Timeline::keep_inside(double width) {
  m_from = std::clamp(m_from, 0.0, std::max(0.0, double(m_last) - width));
  m_to = m_from + width;
}

double Timeline::grid(int labels) const {
  const double least = (m_to - m_from) * core::kTick / std::max(1, labels);
  for (double decade = 0.01; decade < 1e5; decade *= 10)
    for (const double step : {1.0, 2.0, 5.0})
      if (decade * step >= least) return decade * step;
  return 1e5;
}

void sort_marks(std::vector<TimelineMark>& marks) {
  std::stable_sort(marks.begin(), marks.end(),
                   [](const TimelineMark& a, const TimelineMark& b) { return a.tick < b.tick; });
}

const TimelineMark* next_mark(const std::vector<TimelineMark>& marks, std::uint64_t tick) {
  const auto after = std::upper_bound(marks.begin(), marks.end(), tick,
                                      [](std::uint64_t t, const TimelineMark& m) { return t < m.tick; });
  return after == marks.end() ? nullptr : &*after;
}

const TimelineMark* previous_mark(const std::vector<TimelineMark>& marks, std::uint64_t tick) {
  const auto here = std::lower_bound(marks.begin(), marks.end(), tick,
                                     [](const TimelineMark& m, std::uint64_t t) { return m.tick < t; });
  return here == marks.begin() ? nullptr : &*std::prev(here);
}

const TimelineMark* next_mark(const std::vector<TimelineMark>& marks, std::uint64_t tick, TimelineMark::Kind kind) {
  for (const TimelineMark& m : marks)
    if (m.tick > tick && m.kind == kind) return &m;
  return nullptr;
}

const TimelineMark* previous_mark(const std::vector<TimelineMark>& marks, std::uint64_t tick, TimelineMark::Kind kind) {
  for (auto m = marks.rbegin(); m != marks.rend(); ++m)
    if (m->tick < tick && m->kind == kind) return &*m;
  return nullptr;
}

std::string clock_text(std::uint64_t tick) {
  return fmt::format("{}:{:02}.{:03}", tick / 60'000, tick / 1000 % 60, tick % 1000);
}

}  // namespace trocar::attempt
