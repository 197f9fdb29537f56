// An instrument moves, or goes in, where the camera does not look.
#include <trocar/training/events/incidents.hpp>
#include <trocar/training/events/registry.hpp>
#include <trocar/training/observe/hands.hpp>

namespace trocar::training {
namespace {

template <bool inserting>
class Blind final : public EventDetector {
 public:
  Blind(const sim::Model& model, const Arguments& a) : m_watch(model) {
    m_limits.insertion_depth = a[0].number();
    if (!inserting) {
      m_limits.blind_time = a[1].number();
      m_limits.blind_speed = a[2].number();
    }
    const sim::State start = sim::initial_state(model);
    for (size_t h = 0; h < hands(model); ++h) m_before[h] = tip_of(model, start, h);
  }
  void tick(const Snapshot&, const sim::StepReport& report, EventInstances&) override {
    for (int i = 0; i < report.event_count; ++i)
      if (report.events[i].kind == sim::Event::exchanged) m_watch.exchanged(report.events[i].hand);
  }
  void sample(const Snapshot& snapshot, double dt, EventInstances& out) override {
    std::array<Vec3d, sim::kMaxTools> now{};
    for (size_t h = 0; h < hands(snapshot.model); ++h) now[h] = tip_of(snapshot.model, snapshot.state, h);
    Incidents incidents;
    m_watch.update(m_limits, snapshot.model, snapshot.state, m_before, now, dt, incidents);
    pass(incidents, inserting ? Incident::inserted_blind : Incident::moved_blind, out);
    m_before = now;
  }

 private:
  Handling m_limits;
  SightWatch m_watch;
  std::array<Vec3d, sim::kMaxTools> m_before{};
};

}  // namespace

const EventKind kMovedBlind{"moved_blind",
                            {{"depth_mm", ArgumentKind::number, "only deeper than this", true, 0, 290},
                             {"lasting_s", ArgumentKind::number, "for longer than this", true, 0, 60},
                             {"speed_mm_s", ArgumentKind::number, "faster than this", true, 0, 1000}},
                            {},
                            "An instrument moves out of the camera's view; reported once until it is seen again.",
                            anywhere,
                            &make_detector<Blind<false>>};
const EventKind kInsertedBlind{"inserted_blind",
                               {{"depth_mm", ArgumentKind::number, "so deep", true, 0, 290}},
                               {},
                               "A new instrument is inserted with neither its tip nor its shaft in view.",
                               anywhere,
                               &make_detector<Blind<true>>};

}  // namespace trocar::training
