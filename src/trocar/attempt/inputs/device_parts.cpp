#include <trocar/attempt/hand_names.hpp>
#include <trocar/attempt/inputs/device_parts.hpp>
#include <trocar/core/error.hpp>

namespace trocar::attempt {
namespace {

devices::HandSample sample_of(const InputMap::Part& part, std::span<const devices::DeviceReading> readings, float dt) {
  devices::HandSample sample;
  sample.dt = dt;
  if (const devices::DeviceReading* reading = find(part, readings)) sample.gamepad = pad_of(part, *reading);
  return sample;
}

/// There is no rack to look at: the next instrument of the hand's.
void take_next(HandPilot& pilot, const sim::Model& model, const sim::State& state) {
  const int hand = pilot.hands().led;
  if (hand == devices::kScope) return;
  const auto count = int(model.hands[std::size_t(hand)].rack.size());
  pilot.take((state.tools[std::size_t(hand)].instrument + 1) % std::max(1, count));
}

}  // namespace

DeviceParts::DeviceParts(const InputMap& map, const sim::Model& model) : m_input(model.start) {
  for (const InputMap::Part& part : map.parts) {
    Player player{part, duty_of(part.role, model, map.file), std::make_unique<HandPilot>(model)};
    for (const Player& other : m_players)
      if (other.duty.overlaps(player.duty))
        throw core::BadInput(
            {{{map.file, 0, 0},
              "expected devices with different targets, got " + other.part.role + " and " + part.role}});
    m_players.push_back(std::move(player));
  }
}

const sim::Input& DeviceParts::lead(const sim::Input& operators, std::span<const devices::DeviceReading> readings,
                                    float dt, const sim::State& state) {
  m_input = operators;
  for (Player& player : m_players) {
    // Whatever it chose: it leads its own.
    const int led = player.pilot->hands().led;
    const bool own = led == devices::kScope ? player.duty.scope : (player.duty.hands >> led & 1) != 0;
    if (!own) player.pilot->choose(first_of(player.duty));
    const sim::Input& theirs = player.pilot->lead(sample_of(player.part, readings, dt), state);
    if (player.pilot->asks_for_rack()) take_next(*player.pilot, player.pilot->model(), state);
    copy(player.duty, theirs, m_input);
  }
  return m_input;
}

void DeviceParts::take_up(std::span<const devices::DeviceReading> readings) {
  for (Player& player : m_players) player.pilot->take_up(sample_of(player.part, readings, 0));
}

std::string DeviceParts::missing(std::span<const devices::DeviceReading> readings) const {
  for (const Player& player : m_players)
    if (!find(player.part, readings))
      return player.part.device + " is not connected; it controls the " + player.part.role;
  return {};
}

bool DeviceParts::claims(const devices::DeviceReading& reading,
                         std::span<const devices::DeviceReading> readings) const {
  for (const Player& player : m_players)
    if (find(player.part, readings) == &reading) return true;
  return false;
}

std::vector<std::string> DeviceParts::in_words() const {
  std::vector<std::string> lines;
  for (const Player& player : m_players) lines.push_back(player.part.role + ": " + player.part.device);
  return lines;
}

}  // namespace trocar::attempt
