#include <algorithm>

#include <trocar/attempt/box/soft_ports.hpp>
#include <trocar/core/random.hpp>

namespace trocar::attempt {
namespace {

constexpr double kTurnsBack = 0.3;      // [N m/rad] of rubber
constexpr double kWeight = 1.5;         // [N] of an instrument
constexpr double kMiddleOfMass = 0.75;  // of the way from port to hand

/// Of the instrument on its port, across the shaft, in a box whose skin is square to z and that stands upright [N].
Vec3d load_in_box(const kinematics::FulcrumPose& pose, double outside) {
  const Vec3d axis = kinematics::forward({}, pose).axis(), down{0, 0, -1};
  const double tilt = portable::acos(std::clamp(dot(axis, down), -1.0, 1.0));
  const Vec3d across = axis - dot(axis, down) * down;
  // the rubber wants the shaft upright: the hand pushes its end aside, the port bears as much the other way
  const Vec3d aside = length(across) > 1e-9 ? normalised(across) : Vec3d{};
  const Vec3d rubber = (-kTurnsBack * tilt / outside) * (aside - dot(aside, axis) * axis);
  const Vec3d weight = kWeight * (1 - kMiddleOfMass) * (down - dot(down, axis) * axis);
  return rubber + weight;
}

}  // namespace

Vec3d displaced(const SoftPorts& ports, int hand, const interactions::ToolModel& tool,
                const kinematics::FulcrumPose& pose, double seconds) {
  kinematics::PortModel wanders{0, ports.drift, core::Random(ports.seed + std::uint64_t(hand)).next(), {}};
  wanders.across[0] = {1, 0, 0};
  wanders.across[1] = {0, 1, 0};
  Vec3d at = kinematics::drift_of(wanders, seconds);
  if (ports.stiffness > 0) {
    const Vec3d give = load_in_box(pose, interactions::outside_of(tool, pose.depth)) / ports.stiffness;
    const double far = length(give);
    at += far > kinematics::kMostGive ? (kinematics::kMostGive / far) * give : give;
  }
  return at;
}

std::vector<sim::Input> measured_through(const sim::Model& model, const SoftPorts& ports,
                                         std::vector<sim::Input> inputs) {
  if (!ports.moves()) return inputs;
  for (std::size_t i = 0; i < inputs.size(); ++i)
    for (std::size_t h = 0; h < model.hands.size(); ++h) {
      sim::ToolInput& in = inputs[i].tools[h];
      const std::size_t held = in.instrument >= 0 && std::size_t(in.instrument) < model.hands[h].rack.size()
                                   ? std::size_t(in.instrument)
                                   : 0;
      const interactions::ToolModel& tool = model.hands[h].rack[held];
      const kinematics::FulcrumPose pose = pose_of(in);
      const Vec3d shift = displaced(ports, int(h), tool, pose, double(i) * core::kTick);
      const kinematics::FulcrumPose measured =
          kinematics::about_shifted(pose, shift, interactions::outside_of(tool, pose.depth));
      in = sim::tool_input(measured, in.handle, in.instrument);
    }
  return inputs;
}

}  // namespace trocar::attempt
