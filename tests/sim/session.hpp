// One piece of work in the small scene, recorded once, for tests of the laws of the step
// (docs/developers/architecture.md): what a tick may depend on. Approach, grasp, lift, two clips, a cut through the
// tube, one through the bar.
//
//   State s = initial_state(small::model());
//   Work w = make_work(small::model(), &pool);
//   EXPECT_EQ(laws::first_difference(s, w), 0u);                     // all of it
//   EXPECT_EQ(laws::first_difference_where_it_happens(w), 0u);       // a third of it, with every event
#pragma once

#include <algorithm>
#include <string>
#include <vector>

#include "small_scene.hpp"

namespace trocar::laws {

using namespace sim;

/// The work of small::Hands, recorded once: the inputs, and the hash after each hundredth tick.
struct Session {
  std::vector<Input> inputs;
  std::vector<std::uint64_t> hash;  ///< hash[i] after 100 (i + 1) ticks
  std::vector<State> states;        ///< the same
  std::vector<std::uint64_t> grasped, clipped, cut;
  std::uint32_t flags = 0;
  int torn = 0;  ///< triangles of the fold that the scissors parted
};

inline constexpr std::uint64_t kMark = 100;

inline const Session& session() {
  static const Session recorded = [] {
    Session r;
    const Model& m = small::model();
    State s = initial_state(m);
    Work w = make_work(m);
    small::Hands hands(m);
    while (!hands.done()) {
      r.inputs.push_back(hands.next(s));
      const StepReport report = step(m, r.inputs.back(), s, w);
      r.flags |= report.flags;
      for (int e = 0; e < report.event_count; ++e) {
        if (report.events[e].kind == Event::grasped) r.grasped.push_back(s.tick);
        if (report.events[e].kind == Event::clipped) r.clipped.push_back(s.tick);
        if (report.events[e].kind == Event::cut) r.cut.push_back(s.tick);
      }
      if (s.tick % kMark == 0) r.hash.push_back(hash_of(s)), r.states.push_back(s);
    }
    for (std::uint8_t t : s.torn[0]) r.torn += t;
    return r;
  }();
  return recorded;
}

/// Of this thread's last first_difference(): the field that differs, its value in the session and here.
inline thread_local std::string differing_field;

/// Steps on through the session's inputs, at most to tick `until`; `before` runs before every tick. Returns the first
/// mark that differs, in ticks, or 0.
template <class Before>
std::uint64_t first_difference(State& s, Work& w, Before&& before, std::uint64_t until = ~std::uint64_t{}) {
  const Session& r = session();
  const Model& m = small::model();
  differing_field.clear();
  while (s.tick < std::min(until, std::uint64_t(r.inputs.size()))) {
    before(s, w);
    step(m, r.inputs[s.tick], s, w);
    if (s.tick % kMark != 0 || hash_of(s) == r.hash[s.tick / kMark - 1]) continue;
    differing_field = sim::first_difference(r.states[s.tick / kMark - 1], s);
    return s.tick;
  }
  return 0;
}
inline std::uint64_t first_difference(State& s, Work& w) {
  return first_difference(s, w, [](State&, Work&) {});
}

/// Where something happens: the beginning, and 0.3 s around each grasp, clip and cut. Each begins at a mark, from whose
/// State it can be stepped by itself.
struct Stretch {
  std::uint64_t from = 0, until = 0;  ///< ticks; `until` is a mark
};
inline std::vector<Stretch> stretches() {
  std::vector<Stretch> all{{0, 3 * kMark}};
  for (const std::vector<std::uint64_t>* events : {&session().grasped, &session().clipped, &session().cut})
    for (const std::uint64_t at : *events) {
      const std::uint64_t mark = (at - 1) / kMark * kMark;
      all.push_back({mark - kMark, std::min(mark + 2 * kMark, kMark * session().hash.size())});
    }
  return all;
}
/// As first_difference() over the whole, but over these stretches only, one after the other in the same scratch.
template <class Before>
std::uint64_t first_difference_where_it_happens(Work& w, Before&& before) {
  for (const Stretch& stretch : stretches()) {
    State s = stretch.from == 0 ? initial_state(small::model()) : session().states[stretch.from / kMark - 1];
    if (const std::uint64_t at = first_difference(s, w, before, stretch.until)) return at;
  }
  return 0;
}
inline std::uint64_t first_difference_where_it_happens(Work& w) {
  return first_difference_where_it_happens(w, [](State&, Work&) {});
}

}  // namespace trocar::laws
