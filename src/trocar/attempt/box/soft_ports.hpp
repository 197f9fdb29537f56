// Rubber ports of an instrument box, for a box of software: what its potentiometers measure of hands whose real
// instruments go through fulcra that give and wander.
//
//   inputs = measured_through(model, {.stiffness = 1000, .drift = 0.003}, std::move(inputs));
//
// A box measures the directions of shafts and how deep they are, and its reader takes every fulcrum as fixed. So
// where a port is displaced by s, the tip is taken for s beside where it is; and as the hand holds the handle, that is
// s d/l beside where the hand meant it, d deep and l out. The box cannot measure that.
#pragma once

#include <vector>

#include <trocar/sim/model/model.hpp>

namespace trocar::attempt {

struct SoftPorts {
  double stiffness = 0;  ///< of the rubber, across a shaft; 0: rigid [N/m]
  double drift = 0;      ///< how far ports wander at most [m]
  std::uint64_t seed = 1;

  bool moves() const { return stiffness > 0 || drift > 0; }
};

/// Where the port of a hand is beside its place: where it has wandered, and what its load over the rubber's stiffness
/// makes. No tissue loads an instrument in a box; the rubber does, which turns the shaft back (0.3 N m a radian from
/// square to the skin), and the instrument's weight (1.5 N at three quarters of its way to the hand), of which the port
/// bears its share. Both figures are our choice. @param seconds  since it began
Vec3d displaced(const SoftPorts& ports, int hand, const interactions::ToolModel& tool,
                const kinematics::FulcrumPose& pose, double seconds);

/// Hands as the box measures them. The endoscope is clamped: its port stays.
std::vector<sim::Input> measured_through(const sim::Model& model, const SoftPorts& ports,
                                         std::vector<sim::Input> inputs);

}  // namespace trocar::attempt
