#include <trocar/training/events/registry.hpp>

namespace trocar::training {
namespace {

constexpr const EventKind* kEvents[] = {
    &kGrasped,        &kReleased,        &kSlipped,    &kExchanged,     &kTorn,
    &kParted,         &kClipped,         &kClipLost,   &kCut,           &kOverpulled,
    &kOverpinched,    &kCollided,        &kMovedBlind, &kInsertedBlind, &kActivated,
    &kIdleActivation, &kEnergyOffTarget, &kHotTip,     &kHeatSpread,    &kLensTouched,
    &kMarkLost,       &kDropped,
};

}  // namespace

std::span<const EventKind* const> event_kinds() { return kEvents; }

const EventKind* find_event(std::string_view name) {
  for (const EventKind* event : kEvents)
    if (event->name == name) return event;
  return nullptr;
}

}  // namespace trocar::training
