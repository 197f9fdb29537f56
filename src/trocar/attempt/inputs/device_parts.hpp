// Several devices at one attempt: each controls a part, as if that were all; the operator controls the rest.
//
//   DeviceParts parts(read_input_map(file), model);
//   put(parts.lead(pilot.lead(sample, state), readings, dt, state));
//   if (!parts.missing().empty()) hold(parts.missing());
#pragma once

#include <memory>

#include <trocar/attempt/hand_pilot.hpp>
#include <trocar/attempt/inputs/input_map.hpp>
#include <trocar/attempt/team/duty.hpp>

namespace trocar::attempt {

class DeviceParts {
 public:
  /// @throws core::BadInput for a role that the scene has not, or two that lead the same
  DeviceParts(const InputMap& map, const sim::Model& model);

  /// Everybody's commands: what no part leads is as in `operators`.
  const sim::Input& lead(const sim::Input& operators, std::span<const devices::DeviceReading> readings, float dt,
                         const sim::State& state);
  /// After a pause: what is held down now does not act.
  void take_up(std::span<const devices::DeviceReading> readings);
  /// The first device that is not there, in words; empty: all are.
  std::string missing(std::span<const devices::DeviceReading> readings) const;
  /// Does that device have a part? Then it does not lead the operator's hands as well.
  bool claims(const devices::DeviceReading& reading, std::span<const devices::DeviceReading> readings) const;
  /// A line each, for people: "camera: gamepad 2".
  std::vector<std::string> in_words() const;

 private:
  struct Player {
    InputMap::Part part;
    Duty duty;
    std::unique_ptr<HandPilot> pilot;
  };
  std::vector<Player> m_players;
  sim::Input m_input;
};

}  // namespace trocar::attempt
