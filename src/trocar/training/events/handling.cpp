// What hands do wrong, whatever an exercise is about: they pull or pinch too hard, strike each other, move or push in
// where the camera does not look.
#include <trocar/training/events/registry.hpp>
#include <trocar/training/observe/hands.hpp>
#include <trocar/training/observe/watches.hpp>

namespace trocar::training {
namespace {

void pass(const Mishaps& mishaps, Mishap::Kind kind, Happenings& out) {
  for (int i = 0; i < mishaps.count; ++i) {
    const Mishap& m = mishaps.list[size_t(i)];
    if (m.kind == kind) out.add({m.hand, kNoBody, -1, nullptr, m.where, m.where, m.detail});
  }
}

class Overpulled final : public Noticer {
 public:
  Overpulled(const sim::Model&, const Arguments& a) {
    m_tissues.delicate = a[0].bodies;
    m_limits.pull_limit = a[1].number();
    m_limits.pull_limit_other = a[2].number();
    m_limits.pull_excursion = a[3].number();
  }
  void tick(const Look& look, const sim::StepReport&, Happenings& out) override {
    Mishaps mishaps;
    m_watch.update(m_limits, m_tissues, look.model, look.state, mishaps);
    pass(mishaps, Mishap::overpulled, out);
  }

 private:
  Handling m_limits;
  Tissues m_tissues;
  PullWatch m_watch;
};

class Overpinched final : public Noticer {
 public:
  Overpinched(const sim::Model&, const Arguments& a) {
    m_tissues.bowel = a[0].bodies;
    m_limits.pinch_limit = a[1].number();
    m_limits.pinch_impulse = a[2].number();
  }
  void tick(const Look& look, const sim::StepReport&, Happenings& out) override {
    Mishaps mishaps;
    m_watch.update(m_limits, m_tissues, look.model, look.state, mishaps);
    pass(mishaps, Mishap::overpinched, out);
  }

 private:
  Handling m_limits;
  Tissues m_tissues;
  PinchWatch m_watch;
};

class Collided final : public Noticer {
 public:
  Collided(const sim::Model&, const Arguments& a) { m_limits.collision_speed = a[0].number(); }
  void tick(const Look& look, const sim::StepReport&, Happenings& out) override {
    constexpr int kEvery = 4;  // ticks between looks at instruments against each other: 250 Hz
    if (look.state.tick % kEvery != 0) return;
    Mishaps mishaps;
    m_watch.update(m_limits, look.model, look.state, kEvery * sim::kTick, mishaps);
    pass(mishaps, Mishap::collided, out);
  }

 private:
  Handling m_limits;
  CollisionWatch m_watch;
};

template <bool inserting>
class Blind final : public Noticer {
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
  void tick(const Look&, const sim::StepReport& report, Happenings&) override {
    for (int i = 0; i < report.event_count; ++i)
      if (report.events[i].kind == sim::Event::exchanged) m_watch.exchanged(report.events[i].tool);
  }
  void sample(const Look& look, double dt, Happenings& out) override {
    std::array<Vec3d, sim::kMaxTools> now{};
    for (size_t h = 0; h < hands(look.model); ++h) now[h] = tip_of(look.model, look.state, h);
    Mishaps mishaps;
    m_watch.update(m_limits, look.model, look.state, m_before, now, dt, mishaps);
    pass(mishaps, inserting ? Mishap::inserted_blind : Mishap::moved_blind, out);
    m_before = now;
  }

 private:
  Handling m_limits;
  SightWatch m_watch;
  std::array<Vec3d, sim::kMaxTools> m_before{};
};

}  // namespace

const EventKind kOverpulled{"overpulled",
                            {{"delicate", ArgumentKind::bodies, "bodies that bear less", false},
                             {"delicate_N", ArgumentKind::number, "a harder pull on them is too hard", true, 0, 100},
                             {"other_N", ArgumentKind::number, "a harder pull on any other body is", true, 0, 100},
                             {"lasting_s", ArgumentKind::number, "from when on it counts", true, 0.001, 10}},
                            {},
                            "A hand pulls harder than tissue bears; once until it pulls less.",
                            anywhere,
                            &noticing<Overpulled>,
                            false,
                            EventKind::Hold::now};
const EventKind kOverpinched{"overpinched",
                             {{"bowel", ArgumentKind::bodies, "bodies that bear little pinch"},
                              {"force_N", ArgumentKind::number, "a harder pinch is too hard", true, 0, 200},
                              {"impulse_N_s", ArgumentKind::number, "pinch times time, at most"}},
                             {},
                             "A hand pinches one of these bodies too hard or for too long; once a hold.",
                             anywhere,
                             &noticing<Overpinched>,
                             false,
                             EventKind::Hold::now};
const EventKind kCollided{"collided", {{"speed_mm_s", ArgumentKind::number, "faster than this", true, 0, 1000}},
                          {},         "Two instruments strike each other; once a meeting.",
                          anywhere,   &noticing<Collided>,
                          false,      EventKind::Hold::now};
const EventKind kMovedBlind{"moved_blind",
                            {{"depth_mm", ArgumentKind::number, "only deeper than this", true, 0, 290},
                             {"lasting_s", ArgumentKind::number, "for longer than this", true, 0, 60},
                             {"speed_mm_s", ArgumentKind::number, "faster than this", true, 0, 1000}},
                            {},
                            "An instrument moves where the camera does not look; once until it is seen.",
                            anywhere,
                            &noticing<Blind<false>>};
const EventKind kInsertedBlind{"inserted_blind",
                               {{"depth_mm", ArgumentKind::number, "so deep", true, 0, 290}},
                               {},
                               "A new instrument goes in with neither its tip nor its shaft in view.",
                               anywhere,
                               &noticing<Blind<true>>};

}  // namespace trocar::training
