#include <trocar/training/rules/watches.hpp>

namespace trocar::training {
namespace {

const Fact* kind_of(const FactWatches::Watched& w) { return w.fact; }
const EventKind* kind_of(const EventWatches::Watched& w) { return w.event; }

template <class List, class Kind>
int known(const List& list, const Kind* kind, const Arguments& arguments) {
  for (size_t i = 0; i < list.size(); ++i)
    if (kind_of(list[i]) == kind && list[i].arguments == arguments) return int(i);
  return -1;
}

}  // namespace

int FactWatches::watch(const Fact& fact, const Arguments& arguments, const sim::Model& model) {
  if (const int i = known(m_watched, &fact, arguments); i >= 0) return i;
  m_watched.push_back({&fact, arguments, fact.watch(model, arguments)});
  return int(m_watched.size()) - 1;
}

void FactWatches::tick(const Snapshot& snapshot, const sim::StepReport& report) {
  const bool written = snapshot.state.clip_count != m_clips || snapshot.state.cut_count != m_cuts;
  if (report.event_count == 0 && !written) return;
  m_clips = snapshot.state.clip_count;
  m_cuts = snapshot.state.cut_count;
  for (Watched& w : m_watched) w.observer->happened(snapshot);
}

void FactWatches::sample(const Snapshot& snapshot, double dt) {
  for (Watched& w : m_watched) w.observer->sample(snapshot, dt);
}

int EventWatches::watch(const EventKind& event, const Arguments& arguments, const sim::Model& model) {
  if (const int i = known(m_watched, &event, arguments); i >= 0) return i;
  m_watched.push_back({&event, arguments, event.watch(model, arguments)});
  return int(m_watched.size()) - 1;
}

}  // namespace trocar::training
