#include <trocar/training/events/registry.hpp>

namespace trocar::training {
namespace {

constexpr const EventKind* kEvents[] = {
#define TROCAR_EVENT(name) &name,
#include <trocar/training/events/events.inl>
#undef TROCAR_EVENT
};

}  // namespace

std::span<const EventKind* const> event_kinds() {
  static const std::vector<const EventKind*> all = [] {
    std::vector<const EventKind*> list;
    for (const EventKind& event : reported_events()) list.push_back(&event);
    list.insert(list.end(), std::begin(kEvents), std::end(kEvents));
    return list;
  }();
  return all;
}

const EventKind* find_event(std::string_view name) {
  for (const EventKind* event : event_kinds())
    if (event->name == name) return event;
  return nullptr;
}

}  // namespace trocar::training
