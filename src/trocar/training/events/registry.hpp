// All events that exercises can be written with, one line each.
#pragma once

#include <span>

#include <trocar/training/events/event.hpp>

namespace trocar::training {

/// Those that the step reports and nobody looks at more closely: grasped, released, ...
std::span<const EventKind> reported_events();

extern const EventKind kTorn, kClipped, kClipLost, kCut;
extern const EventKind kOverpulled, kOverpinched, kCollided, kMovedBlind, kInsertedBlind;
extern const EventKind kActivated, kIdleActivation, kEnergyOffTarget, kHotTip, kHeatSpread;
extern const EventKind kLensTouched, kMarkLost, kDropped;

std::span<const EventKind* const> event_kinds();
/// Null: there is none of that name.
const EventKind* find_event(std::string_view name);

}  // namespace trocar::training
