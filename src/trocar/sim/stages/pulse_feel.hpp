// How an instrument feels a vessel's pulse through tissue: what the step pushes with (circulation.hpp), and what those
// who only look (facts, skills, the trace on the screen) make of a State.
//
//   PulseReader reader(model);
//   reader.area(state, hand, vessel) * gain * pressure above the mean      // [N], as the step does
#pragma once

#include <trocar/sim/model/bodies.hpp>

namespace trocar::sim {

/// Tissue between a vessel's wall and an instrument that still feels it [m]. Our choice.
inline constexpr double kFelt = 0.003;

/// What of a vessel's wall, at a point of its line, reaches an instrument: all of it where they meet, nothing from
/// kFelt on.
struct PulseTouch {
  double share = 0;
  Vec3d towards;  ///< unit, from the vessel to the instrument; zero where nothing does
};
PulseTouch pulse_touch(const interactions::ToolShape& shape, Vec3d at, double radius) noexcept;

/// Does the hand's instrument press on tissue? One that does not feels no pulse.
bool presses(const State& state, size_t hand) noexcept;

/// The part of a vessel's line that a point stands for [m].
double stands_for(const interactions::VesselPath& path, size_t point) noexcept;

class PulseReader {
 public:
  explicit PulseReader(const Model& model);

  /// Of that vessel's wall, through which the hand's instrument feels it [m^2]; 0 while it does not press.
  double area(const State& state, int hand, int vessel);
  /// The force with which all vessels' pulse pushes it just now [N].
  double force(const State& state, int hand);
  /// What a beat changes in that force, of one vessel [N].
  double beat(const State& state, int hand, int vessel);

 private:
  const Model& m_model;
  std::vector<Vec3d> m_line;
};

}  // namespace trocar::sim
