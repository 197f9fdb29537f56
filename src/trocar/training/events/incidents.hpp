// Incidents of the watches, as event instances.
#pragma once

#include <trocar/training/events/event.hpp>
#include <trocar/training/observe/watches.hpp>

namespace trocar::training {

/// Those of one kind. @param number  that distinguishes them from others of the event
inline void pass(const Incidents& incidents, Incident::Kind kind, EventInstances& out, std::int32_t number = -1) {
  out.lost = out.lost || incidents.lost;
  for (int i = 0; i < incidents.count; ++i) {
    const Incident& one = incidents.list[size_t(i)];
    if (one.kind == kind) out.add({one.hand, kNoBody, number, nullptr, one.where, one.where, one.detail});
  }
}

}  // namespace trocar::training
