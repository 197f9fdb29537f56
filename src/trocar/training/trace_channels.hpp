// The numbers of a trace sample one by one: name in CSV, the whole number of steps that stands for each in files, and
// how well the value before foretells the next. Used by trace.cpp, trace_bytes.cpp and trace_csv.cpp.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>

#include <trocar/training/trace.hpp>

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

inline constexpr std::int64_t kMaxSteps = std::int64_t(1) << 46;

/// The nearest whole number of steps; 0 for what is not finite.
inline std::int64_t steps_of(double value, double scale) {
  const double steps = std::floor(value * scale + 0.5);
  if (!(steps > -double(kMaxSteps))) return steps < 0 ? -kMaxSteps : 0;  // the comparison is false for NaN, too
  return steps < double(kMaxSteps) ? std::int64_t(steps) : kMaxSteps;
}
/// Division, so that the value is the double nearest to the decimal number that CSV shows.
inline double value_of(std::int64_t steps, double scale) { return double(steps) / scale; }

// The accessors are lambdas without captures: plain function pointers.
#define TROCAR_CHANNEL(type, name, scale, decimals, order, most, member)                \
  TraceChannel<type> {                                                                  \
    name, scale, decimals, order, most, [](const type& s) { return double(s.member); }, \
        [](type& s, double value) { s.member = decltype(s.member)(value); }             \
  }

inline const std::array<TraceChannel<TraceSample>, 16> kHandChannels = {
    TROCAR_CHANNEL(TraceSample, "x_m", 1e7, 7, 2, kMaxSteps, tip.x),
    TROCAR_CHANNEL(TraceSample, "y_m", 1e7, 7, 2, kMaxSteps, tip.y),
    TROCAR_CHANNEL(TraceSample, "z_m", 1e7, 7, 2, kMaxSteps, tip.z),
    TROCAR_CHANNEL(TraceSample, "qw", 1e7, 7, 2, kMaxSteps, orientation.w),
    TROCAR_CHANNEL(TraceSample, "qx", 1e7, 7, 2, kMaxSteps, orientation.x),
    TROCAR_CHANNEL(TraceSample, "qy", 1e7, 7, 2, kMaxSteps, orientation.y),
    TROCAR_CHANNEL(TraceSample, "qz", 1e7, 7, 2, kMaxSteps, orientation.z),
    TROCAR_CHANNEL(TraceSample, "handle", 1e4, 4, 1, kMaxSteps, handle),
    TROCAR_CHANNEL(TraceSample, "pinch_N", 1e4, 4, 1, kMaxSteps, pinch),
    TROCAR_CHANNEL(TraceSample, "pull_x_N", 1e4, 4, 1, kMaxSteps, pull.x),
    TROCAR_CHANNEL(TraceSample, "pull_y_N", 1e4, 4, 1, kMaxSteps, pull.y),
    TROCAR_CHANNEL(TraceSample, "pull_z_N", 1e4, 4, 1, kMaxSteps, pull.z),
    TROCAR_CHANNEL(TraceSample, "contact_x_N", 1e4, 4, 1, kMaxSteps, contact.x),
    TROCAR_CHANNEL(TraceSample, "contact_y_N", 1e4, 4, 1, kMaxSteps, contact.y),
    TROCAR_CHANNEL(TraceSample, "contact_z_N", 1e4, 4, 1, kMaxSteps, contact.z),
    TROCAR_CHANNEL(TraceSample, "instrument", 1, 0, 1, std::int64_t(kMaxTraceNames), instrument),
};

inline const std::array<TraceChannel<TraceScope>, 6> kScopeChannels = {
    TROCAR_CHANNEL(TraceScope, "eye_x_m", 1e7, 7, 2, kMaxSteps, eye.x),
    TROCAR_CHANNEL(TraceScope, "eye_y_m", 1e7, 7, 2, kMaxSteps, eye.y),
    TROCAR_CHANNEL(TraceScope, "eye_z_m", 1e7, 7, 2, kMaxSteps, eye.z),
    TROCAR_CHANNEL(TraceScope, "forward_x", 1e7, 7, 2, kMaxSteps, forward.x),
    TROCAR_CHANNEL(TraceScope, "forward_y", 1e7, 7, 2, kMaxSteps, forward.y),
    TROCAR_CHANNEL(TraceScope, "forward_z", 1e7, 7, 2, kMaxSteps, forward.z),
};

#undef TROCAR_CHANNEL

inline constexpr const char* kMarkNames[TraceMark::kinds] = {"grasped", "released", "slipped",
                                                             "clipped", "dropped",  "cut"};

}  // namespace trocar::training
