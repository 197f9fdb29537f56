// What the step reports of hands, as its list of events says (sim/model/step_report.hpp), and that tissue tore.
#include <utility>

#include <trocar/sim/model/bodies.hpp>
#include <trocar/training/events/registry.hpp>
#include <trocar/training/facts/needs.hpp>
#include <trocar/training/observe/hands.hpp>
#include <trocar/training/observe/stitches.hpp>
#include <trocar/training/observe/watches.hpp>

namespace trocar::training {
namespace {

template <sim::Event::Kind kind>
class Reported final : public EventDetector {
 public:
  Reported(const sim::Model&, const Arguments&) {}
  void tick(const Snapshot& snapshot, const sim::StepReport& report, EventInstances& out) override {
    for (int i = 0; i < report.event_count; ++i) {
      const sim::Event& e = report.events[i];
      if (e.kind != kind || e.hand < 0) continue;  // no hand did it
      const Vec3d tip = tip_of(snapshot.model, snapshot.state, size_t(e.hand));
      out.add({e.hand, e.body, -1, name_of_body(snapshot.model, e.body), tip, tip});
    }
  }
};

/// Once a body for as long as it continues to tear.
class Torn final : public EventDetector {
 public:
  Torn(const sim::Model&, const Arguments&) {}
  void tick(const Snapshot& snapshot, const sim::StepReport& report, EventInstances& out) override {
    if (report.event_count == 0) return;
    Incidents incidents;
    m_watch.update(snapshot.model, snapshot.state, report, incidents);
    out.lost = out.lost || incidents.lost;
    for (int i = 0; i < incidents.count; ++i) {
      const Incident& m = incidents.list[size_t(i)];
      out.add({m.hand, kNoBody, -1, nullptr, m.where, m.where});
    }
  }

 private:
  TearWatch m_watch;
};

using sim::Event;

}  // namespace

const std::string* name_of_body(const sim::Model& model, BodyId body) {
  return body.exists() ? &sim::name_of(model, body) : nullptr;
}

namespace {

using Lacks = std::string_view (*)(const sim::Model&);
constexpr Lacks lacks_for(sim::EventWords::Needs needs) {
  switch (needs) {
    case sim::EventWords::grip:
      return needs_grip;
    case sim::EventWords::choice:
      return needs_choice;
    case sim::EventWords::current:
      return needs_current;
    case sim::EventWords::needle:
      return needs_syringe;
    case sim::EventWords::sling:
      return needs_sling;
    case sim::EventWords::thread:
      return needs_thread;
    case sim::EventWords::applier:
      return needs_applier;
    case sim::EventWords::nothing:
      break;
  }
  return anywhere;
}

template <std::size_t... i>
std::vector<EventKind> reported(std::index_sequence<i...>) {
  std::vector<EventKind> out;
  const auto add = [&out](const sim::EventWords& e, auto watch) {
    if (!e.meaning) return;
    const EventKind::Hold of_hold = e.kind == Event::slipped ? EventKind::Hold::before : EventKind::Hold::none;
    out.push_back({e.name, {}, {}, e.meaning, lacks_for(e.needs), watch, e.has_body, of_hold});
  };
  (add(sim::kEventWords[i], &make_detector<Reported<sim::kEventWords[i].kind>>), ...);
  return out;
}

}  // namespace

std::span<const EventKind> reported_events() {
  static const std::vector<EventKind> all = reported(std::make_index_sequence<std::size(sim::kEventWords)>());
  return all;
}

const EventKind kTorn{
    "torn",   {},
    {},       "Tissue tore under a hand's pull or pressure; reported once per body while the tear grows.",
    anywhere, &make_detector<Torn>,
    false,    EventKind::Hold::now};

}  // namespace trocar::training
