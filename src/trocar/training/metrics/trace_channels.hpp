// The numbers of a trace sample one by one: name in CSV, the whole number of steps that stands for each in files, and
// how well the value before foretells the next. Used by trace.cpp, trace_bytes.cpp and trace_csv.cpp.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <type_traits>

#include <trocar/training/metrics/trace.hpp>

namespace trocar::training {

/// One number of a Sample.
template <class Sample>
struct TraceChannel {
  const char* name;
  double scale;       ///< steps in one unit: 1e7 = steps of 0.1 um
  int decimals;       ///< of a step
  int order;          ///< stored are differences of this order: 2 for what moves smoothly, 1 for what jumps
  std::int64_t most;  ///< steps, either way
  double (*get)(const Sample&);
  void (*set)(Sample&, double);
};

inline constexpr std::int64_t kMaxTraceSteps = std::int64_t(1) << 46;

/// The nearest whole number of steps; 0 for what is not finite.
inline std::int64_t steps_of(double value, double scale) {
  const double steps = std::floor(value * scale + 0.5);
  if (!(steps > -double(kMaxTraceSteps)))
    return steps < 0 ? -kMaxTraceSteps : 0;  // the comparison is false for NaN, too
  return steps < double(kMaxTraceSteps) ? std::int64_t(steps) : kMaxTraceSteps;
}
/// Division, so that the value is the double nearest to the decimal number that CSV shows.
inline double value_of(std::int64_t steps, double scale) { return double(steps) / scale; }

/// How a kind of number is kept: places and directions; forces and the handle; whole numbers.
struct TraceSteps {
  double scale;
  int decimals, order;
  std::int64_t most = kMaxTraceSteps;
};
inline constexpr TraceSteps kPlaceSteps{1e7, 7, 2}, kLoadSteps{1e4, 4, 1},
    kNumberSteps{1, 0, 1, std::int64_t(kMaxTraceNames)};

/// A channel whose number `Access`, a lambda without captures, finds in a sample.
template <class Sample, class Access>
TraceChannel<Sample> channel(const char* name, TraceSteps steps, Access) {
  return {name,
          steps.scale,
          steps.decimals,
          steps.order,
          steps.most,
          [](const Sample& s) { return double(Access{}(s)); },
          [](Sample& s, double value) {
            auto& number = Access{}(s);
            number = std::decay_t<decltype(number)>(value);
          }};
}

// clang-format off
inline const std::array<TraceChannel<TraceSample>, 16> kHandChannels = {
    channel<TraceSample>("x_m", kPlaceSteps, [](auto& s) -> auto& { return s.tip.x; }),
    channel<TraceSample>("y_m", kPlaceSteps, [](auto& s) -> auto& { return s.tip.y; }),
    channel<TraceSample>("z_m", kPlaceSteps, [](auto& s) -> auto& { return s.tip.z; }),
    channel<TraceSample>("qw", kPlaceSteps, [](auto& s) -> auto& { return s.orientation.w; }),
    channel<TraceSample>("qx", kPlaceSteps, [](auto& s) -> auto& { return s.orientation.x; }),
    channel<TraceSample>("qy", kPlaceSteps, [](auto& s) -> auto& { return s.orientation.y; }),
    channel<TraceSample>("qz", kPlaceSteps, [](auto& s) -> auto& { return s.orientation.z; }),
    channel<TraceSample>("handle", kLoadSteps, [](auto& s) -> auto& { return s.handle; }),
    channel<TraceSample>("pinch_N", kLoadSteps, [](auto& s) -> auto& { return s.pinch; }),
    channel<TraceSample>("pull_x_N", kLoadSteps, [](auto& s) -> auto& { return s.pull.x; }),
    channel<TraceSample>("pull_y_N", kLoadSteps, [](auto& s) -> auto& { return s.pull.y; }),
    channel<TraceSample>("pull_z_N", kLoadSteps, [](auto& s) -> auto& { return s.pull.z; }),
    channel<TraceSample>("contact_x_N", kLoadSteps, [](auto& s) -> auto& { return s.contact.x; }),
    channel<TraceSample>("contact_y_N", kLoadSteps, [](auto& s) -> auto& { return s.contact.y; }),
    channel<TraceSample>("contact_z_N", kLoadSteps, [](auto& s) -> auto& { return s.contact.z; }),
    channel<TraceSample>("instrument", kNumberSteps, [](auto& s) -> auto& { return s.instrument; }),
};

inline const std::array<TraceChannel<TraceScope>, 7> kScopeChannels = {
    channel<TraceScope>("eye_x_m", kPlaceSteps, [](auto& s) -> auto& { return s.eye.x; }),
    channel<TraceScope>("eye_y_m", kPlaceSteps, [](auto& s) -> auto& { return s.eye.y; }),
    channel<TraceScope>("eye_z_m", kPlaceSteps, [](auto& s) -> auto& { return s.eye.z; }),
    channel<TraceScope>("forward_x", kPlaceSteps, [](auto& s) -> auto& { return s.forward.x; }),
    channel<TraceScope>("forward_y", kPlaceSteps, [](auto& s) -> auto& { return s.forward.y; }),
    channel<TraceScope>("forward_z", kPlaceSteps, [](auto& s) -> auto& { return s.forward.z; }),
    channel<TraceScope>("horizon_deg", kLoadSteps, [](auto& s) -> auto& { return s.horizon; }),
};
/// What files of the first format have of them.
inline constexpr std::size_t kFirstScopeChannels = 6;
// clang-format on

inline constexpr const char* kMarkNames[TraceMark::kinds] = {"grasped", "released", "slipped", "clipped",
                                                             "dropped", "cut",      "torn"};

}  // namespace trocar::training
