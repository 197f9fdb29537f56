// The player's timeline without its drawing: which stretch of the recording is visible, where a tick lies on it, the
// marks, and what steps and speeds there are.
//
//   Timeline line(recording_ticks);
//   line.zoom(0.5, now);                       // half as much, around now
//   const double x = line.place(tick);         // 0 left .. 1 right
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace trocar::attempt {

struct TimelineMark {
  enum class Kind { event, step, error, damage } kind = Kind::event;
  std::uint64_t tick = 0;
  std::string text;
};

inline constexpr std::uint64_t kFrameTicks = 40;  ///< a step by one picture: 1/25 s
inline constexpr double kPlayerSpeeds[] = {0.1, 0.25, 0.5, 1, 2, 4, 8};

/// The next speed of kPlayerSpeeds above (or below) `speed`; the last one stays.
double next_speed(double speed, bool faster);

class Timeline {
 public:
  explicit Timeline(std::uint64_t last) : m_last(last), m_to(double(last)) {}

  std::uint64_t last() const { return m_last; }  ///< tick of the end
  double from() const { return m_from; }         ///< visible stretch [ticks]
  double to() const { return m_to; }

  /// 0 at the left end of what is visible, 1 at the right; beyond for what is not.
  double place(double tick) const { return m_to > m_from ? (tick - m_from) / (m_to - m_from) : 0; }
  /// The tick at a place, never outside the recording.
  std::uint64_t tick_at(double place) const;

  /// Shows `factor` times as much; what is at `around` stays where it is. At least kFrameTicks, at most all.
  void zoom(double factor, double around);
  void pan(double share);    ///< of the visible stretch; positive continues in time
  void follow(double tick);  ///< pans where `tick` has left the visible stretch
  void show_all();
  bool shows_all() const { return m_from <= 0 && m_to >= double(m_last); }

  /// A distance between labelled lines that leaves room for `labels` of them [s]: 0.01, 0.02, 0.05, 0.1 ...
  double grid(int labels) const;

 private:
  void keep_inside(double width);
  std::uint64_t m_last = 0;
  double m_from = 0, m_to = 0;
};

/// The marks in order of time; marks of the same tick keep their order.
void sort_marks(std::vector<TimelineMark>& marks);
/// The first mark after `tick`, or the last one before it; null where there is none. `marks` sorted.
const TimelineMark* next_mark(const std::vector<TimelineMark>& marks, std::uint64_t tick);
const TimelineMark* previous_mark(const std::vector<TimelineMark>& marks, std::uint64_t tick);
/// The same among the marks of one kind.
const TimelineMark* next_mark(const std::vector<TimelineMark>& marks, std::uint64_t tick, TimelineMark::Kind kind);
const TimelineMark* previous_mark(const std::vector<TimelineMark>& marks, std::uint64_t tick, TimelineMark::Kind kind);

/// "1:02.345"
std::string clock_text(std::uint64_t tick);

}  // namespace trocar::attempt
