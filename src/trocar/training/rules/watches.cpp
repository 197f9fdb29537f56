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

void FactWatches::tick(const Moment& moment, const sim::StepReport& report) {
  const bool written = moment.state.clip_count != m_clips || moment.state.cut_count != m_cuts;
  if (report.event_count == 0 && !written) return;
  m_clips = moment.state.clip_count;
  m_cuts = moment.state.cut_count;
  for (Watched& w : m_watched) w.observer->happened(moment);
}

void FactWatches::sample(const Moment& moment, double dt) {
  for (Watched& w : m_watched) w.observer->sample(moment, dt);
}

int EventWatches::watch(const EventKind& event, const Arguments& arguments, const sim::Model& model) {
  if (const int i = known(m_watched, &event, arguments); i >= 0) return i;
  m_watched.push_back({&event, arguments, event.watch(model, arguments)});
  return int(m_watched.size()) - 1;
}

}  // namespace trocar::training
