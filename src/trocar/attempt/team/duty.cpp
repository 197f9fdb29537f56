#include <trocar/attempt/hand_names.hpp>
#include <trocar/attempt/team/duty.hpp>
#include <trocar/core/error.hpp>
#include <trocar/devices/mouse_keyboard.hpp>

namespace trocar::attempt {
namespace {

/// Bits of Input::pedals that belong to a hand's handle.
constexpr std::uint32_t valves_of(int hand) { return sim::irrigates(hand) | sim::sucks(hand); }

std::uint32_t pedal_bits(const Duty& duty) {
  std::uint32_t of_hands = 0, mine = 0;
  for (int h = 0; h < sim::kMaxTools; ++h) {
    of_hands |= valves_of(h);
    if (duty.hands >> h & 1) mine |= valves_of(h);
  }
  if (duty.scope) mine |= sim::kWipe;
  if (duty.pedals) mine |= ~(of_hands | std::uint32_t(sim::kWipe));
  return mine;
}

}  // namespace

bool Duty::overlaps(const Duty& other) const {
  return (hands & other.hands) != 0 || (scope && other.scope) || (pedals && other.pedals);
}

Duty duty_of(std::string_view role, const sim::Model& model, const std::string& where) {
  const auto count = int(model.hands.size());
  std::string names;
  if (role == "camera") return {.scope = true};
  if (role == "assistant" && count > 2) return {.hands = ((1u << count) - 1u) & ~3u};
  if ((role == "left" || role == "right") && count >= 2)
    return {.hands = 1u << sides_of(model)[role == "left" ? 0 : 1]};
  for (int h = 0; h < count; ++h) {
    if (model.hands[std::size_t(h)].name == role) return {.hands = 1u << h};
    names += ", " + model.hands[std::size_t(h)].name;
  }
  throw core::BadInput({{{where, 0, 0},
                         std::string("expected camera, ") + (count > 2 ? "assistant, " : "") +
                             (count >= 2 ? "left, right" : "a trocar") + names + "; got " + std::string(role)}});
}

int first_of(const Duty& duty) {
  for (int h = 0; h < sim::kMaxTools; ++h)
    if (duty.hands >> h & 1) return h;
  return devices::kScope;
}

void copy(const Duty& duty, const sim::Input& from, sim::Input& to) {
  for (int h = 0; h < sim::kMaxTools; ++h)
    if (duty.hands >> h & 1) to.tools[h] = from.tools[h], to.wrists[h] = from.wrists[h];
  if (duty.scope) to.scope = from.scope;
  const std::uint32_t bits = pedal_bits(duty);
  to.pedals = (to.pedals & ~bits) | (from.pedals & bits);
}

}  // namespace trocar::attempt
