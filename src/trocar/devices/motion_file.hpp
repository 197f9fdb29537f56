// Two-handed instrument motion from a file: tip positions, roll and handle of the left and the right instrument over
// time, many trials in one CSV file; read, judged, and resampled smoothly to the simulation's ticks.
//
//   const MotionTrial trial = read_motion_trial("iras_A_cartesian.csv#A01/P01");  // throws core::BadInput
//   const MotionBounds bounds = bounds_of(trial, Hand::left);                     // to place it in a scene
//   const MotionCurve curve(trial);
//   for (std::uint64_t tick = 0; tick < curve.ticks(); ++tick) use(curve.at_tick(tick));
//
// The first line names the columns, in any order; further columns are allowed and not read:
//   operator, trial          text; the rows of a trial stand together, and "OPERATOR/TRIAL" names it
//   t_ms                     time [ms], rising within a trial
//   xL yL zL, xR yR zR       tip of the left and the right instrument [mm]
//   rollL, rollR             turn about the shaft [rad]
//   handleL, handleR         the handle, in the device's unit
//   subtask                  optional whole number: the phase that an observer named
// This is the layout of the extract of the IRAS training system's trajectories [Yang 2017, ICSIP, pp. 266-271] that
// this reader was made for. Its publisher states no units and no handedness. What its 90 trials show: 1 row a second
// without a gap; x -68..28, y -79..57, z -12..111, which are millimetres of a surgeon's working volume from a home
// position near 0; roll -0.1..3.7, radians; handle -0.05..2.07, at 0 while the robot is at home, near 0.9 while the
// left hand holds, with short excursions upwards. We take the handle as an opening angle: larger = more open.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <iosfwd>
#include <string>
#include <vector>

#include <trocar/core/error.hpp>
#include <trocar/core/tick.hpp>

namespace trocar::devices {

enum class Hand { left = 0, right = 1 };

/// One instrument at one moment.
struct HandMotion {
  std::array<double, 3> tip{};  ///< [m], in the file's frame
  double roll = 0;              ///< [rad]
  double handle = 0;            ///< in the file's unit; closure() makes it 0 open .. 1 closed
};

struct MotionSample {
  double time = 0;  ///< since the trial's first row [s]
  std::array<HandMotion, 2> hands;
  int subtask = 0;
  const HandMotion& hand(Hand which) const { return hands[std::size_t(which)]; }
};

struct MotionTrial {
  std::string name;                   ///< "OPERATOR/TRIAL"
  std::vector<MotionSample> samples;  ///< at least two
};

/// Where one hand goes in a trial.
struct MotionBounds {
  std::array<double, 3> low{}, high{}, centroid{};  ///< of the tip [m]; the centroid is the mean over time
  double roll_low = 0, roll_high = 0;               ///< [rad]
  double handle_low = 0, handle_high = 0;           ///< in the file's unit
  double path_length = 0;                           ///< of the polyline through the rows [m]
};

inline constexpr int kMaxMotionFaults = 50;             ///< told of one file; then reading stops
inline constexpr double kMaxMotionDuration = 4 * 3600;  ///< of a trial [s]

/// All trials of a file, in its order.  @throws core::BadInput with every fault located, up to kMaxMotionFaults
std::vector<MotionTrial> read_motion_file(const std::filesystem::path& path);
/// The same from a stream; faults call it `name`.
std::vector<MotionTrial> read_motion(std::istream& in, const std::string& name);

/// One trial. `argument` is FILE#OPERATOR/TRIAL, or FILE for the first; a '#' that belongs to the file's name is
/// understood when such a file exists.  @throws core::BadInput, for an unknown trial with the names that are there
MotionTrial read_motion_trial(const std::string& argument);

MotionBounds bounds_of(const MotionTrial& trial, Hand hand);

/// The handle as 0 open .. 1 closed, from the range that this hand uses in the trial; 0 if it never moves.
double closure(double handle, const MotionBounds& bounds);

/// A trial as a smooth curve. Between rows every quantity is a cubic in time (Hermite), through every row, with
/// continuous velocity. At a row the velocity points along the bisector of the directions before and after; its size is
///   2 a b / (a + b) * cos^4(turn / 2)        a, b: speeds before and after; turn: the angle between the directions
/// so that a straight run flows through, a reversal stops, and nothing overshoots: the curve is at most 0.5 % longer
/// than the polyline on every trial named above (0.3 % in the median), where monotone cubics per coordinate (PCHIP)
/// reach 1.04 % and Catmull-Rom 4.5 %; rounding the corners instead shortens the path by 1.2 % at 0.2 s.  Our choice.
/// For roll and handle this is the monotone cubic of [Fritsch Butland 84] with equal weights.
/// Only + - * / and sqrt: the same bits everywhere.
class MotionCurve {
 public:
  explicit MotionCurve(const MotionTrial& trial);  ///< copies what it needs; at least two samples

  double duration() const { return m_knots.back().sample.time; }  ///< [s]
  std::uint64_t ticks() const;                                    ///< of 1 ms, the last row included

  MotionSample at(double time) const;  ///< [s] since the first row, clamped to the trial
  MotionSample at_tick(std::uint64_t tick) const { return at(double(tick) * core::kTick); }

 private:
  struct Knot {
    MotionSample sample;
    std::array<HandMotion, 2> velocity;  ///< of each quantity, per second
  };
  std::vector<Knot> m_knots;
};

}  // namespace trocar::devices
