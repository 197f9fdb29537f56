// What the hands and the scope did in an attempt, 50 times a second: the material of all motion and force metrics, of
// the report's plots and of the export. Taken from State at fixed ticks, so that a replay gives the same bytes.
//
//   TraceRecorder recorder(model);
//   ... after every tick: recorder.update(model, state, report);
//   const std::vector<std::uint8_t> bytes = to_bytes(recorder.trace());
//   const Trace again = trace_from_bytes(bytes, "attempt 7");        // throws core::BadInput; equal to the first
//
// All numbers are multiples of a small unit (0.1 um, 0.1 mN, ...: trace_channels.hpp), so that a Trace is the same
// before and after it was stored. At most four hours are kept; the rest is left out and `full` says so.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <trocar/numerics/quat.hpp>
#include <trocar/sim/stages/step.hpp>

namespace trocar::training {

inline constexpr int kTraceEvery = 20;                          ///< ticks between samples
inline constexpr double kTraceRate = 50;                        ///< [Hz]
inline constexpr std::size_t kMaxTraceSamples = 4 * 3600 * 50;  ///< four hours
inline constexpr std::size_t kMaxTraceHands = 8, kMaxTraceNames = 64, kMaxTraceMarks = 4096;

/// One hand at one moment.
struct TraceSample {
  Vec3d tip;                     ///< [m]
  Quatd orientation;             ///< turns (0, 0, -1) into the shaft's direction, (1, 0, 0) into the jaws' opening
  double handle = 0;             ///< 0 open .. 1 closed
  double pinch = 0;              ///< between the jaws [N]
  Vec3d pull, contact;           ///< of the held tissue on the jaws, of touched tissue on the instrument [N]
  std::int32_t instrument = -1;  ///< into Trace::instruments; -1: none

  bool operator==(const TraceSample&) const = default;
};

/// The endoscope at one moment.
struct TraceScope {
  static constexpr double kNoHorizon = 1000;
  Vec3d eye, forward;           ///< [m], unit vector
  double horizon = kNoHorizon;  ///< how far the picture is turned from upright [deg]; kNoHorizon: not known
  bool operator==(const TraceScope&) const = default;
};

struct TraceHand {
  std::string name;
  bool has_shaft = true;  ///< false: orientation is only the roll about the shaft, whose direction is not known
  std::vector<TraceSample> samples;
  bool has_forces = true;  ///< false: pinch, pull and contact were not measured
  bool operator==(const TraceHand&) const = default;
};

/// Something that a hand did, as sim::Event names it.
struct TraceMark {
  enum Kind : std::int32_t { grasped, released, slipped, clipped, dropped, cut, torn, kinds } kind = grasped;
  std::int32_t hand = 0;
  std::uint32_t sample = 0;  ///< the first that was taken then or later
  bool operator==(const TraceMark&) const = default;
};

struct Trace {
  double rate = kTraceRate;  ///< [Hz]
  double start = 0;          ///< time of the first sample [s]
  std::vector<std::string> instruments;
  std::vector<TraceHand> hands;   ///< all with the same number of samples
  std::vector<TraceScope> scope;  ///< as many, or none
  std::vector<TraceMark> marks;   ///< in order of time

  std::size_t size() const { return hands.empty() ? scope.size() : hands.front().samples.size(); }
  double time(std::size_t i) const { return start + double(i) / rate; }  ///< [s]
  bool operator==(const Trace&) const = default;
};

/// The nearest values that bytes and CSV hold; what is not finite becomes 0.
TraceSample rounded(const TraceSample& sample);
TraceScope rounded(const TraceScope& scope);

class TraceRecorder {
 public:
  explicit TraceRecorder(const sim::Model& model);

  /// After every tick. Takes a sample every kTraceEvery ticks; allocates, so it belongs after the step, not into it.
  void update(const sim::Model& model, const sim::State& state, const sim::StepReport& report);

  const Trace& trace() const { return m_trace; }
  bool marks_lost() const { return m_marks_lost; }  ///< there were more than kMaxTraceMarks
  bool full() const { return m_full; }  ///< four hours are over, or a tick was left out: nothing is added any more

 private:
  Trace m_trace;
  std::vector<std::vector<std::int32_t>> m_numbers;  ///< of each hand's rack in Trace::instruments
  std::uint64_t m_next = 0;                          ///< tick of the next sample
  bool m_full = false, m_marks_lost = false;
};

/// Version, names, columns of differences of integers, checksum: about 1.5 kB a second for three hands.
std::vector<std::uint8_t> to_bytes(const Trace& trace);
/// Memory is bounded by the bytes' number.  @throws core::BadInput, naming `name` and the byte
Trace trace_from_bytes(std::span<const std::uint8_t> bytes, const std::string& name);

/// Comment lines (#) with what is not a column, a line of column names with units, a line per sample.
std::string to_csv(const Trace& trace);
/// @throws core::BadInput, naming `name`, line and column
Trace trace_from_csv(std::string_view text, const std::string& name);

}  // namespace trocar::training
