// All events that exercises can be written with. A new one is a line in events.inl, and its file.
#pragma once

#include <span>

#include <trocar/training/events/event.hpp>

namespace trocar::training {

/// Those that the step reports and no file of events/ refines: grasped, released, ...
std::span<const EventKind> reported_events();

#define TROCAR_EVENT(name) extern const EventKind name;
#include <trocar/training/events/events.inl>
#undef TROCAR_EVENT

std::span<const EventKind* const> event_kinds();
/// Null: there is none of that name.
const EventKind* find_event(std::string_view name);

}  // namespace trocar::training
