// Blood in a scene: vessels ride on tissue, what is cut bleeds from the right end, clips stop it on the right side.
#include <algorithm>
#include <cmath>
#include <cstdio>

#include <gtest/gtest.h>

#include <trocar/fluids/fluids.hpp>
#include <trocar/sim/recording/keyframe.hpp>
#include <trocar/sim/recording/recording.hpp>
#include <trocar/sim/stages/circulation.hpp>

#include "small_scene.hpp"

using namespace trocar;
using namespace trocar::sim;

namespace {

constexpr double kMlPerMinute = 1e-6 / 60;

/// What an opening's side has let out.
struct Lost {
  std::int64_t picolitres[2] = {0, 0};
};

/// A scene whose arteries can be fed from the other end, too, with what runs in it.
Model fed_from_both_ends() {
  scene::Description d = small::description();
  d.vessels[0].graph.ends.erase(d.vessels[0].graph.ends.begin());
  d.vessels[0].graph.sources.push_back({.node = small::kTubesEnd});
  return scene::compile(d);
}
const Model& two_sided() {
  static const Model made = fed_from_both_ends();
  return made;
}

/// The whole work of small::Hands with the clips that are asked for; what the tube's artery lost on either side, and in
/// the last second.
struct Operation {
  State end;
  Lost all, last;
  int clips = 0, opening = -1;
  Vec3d place[2], direction[2];
  std::uint32_t flags = 0;
};
Operation operate(const Model& m, double first_clip, double second_clip, double cut_at = 0.021) {
  Operation o;
  State s = initial_state(m);
  Work w = make_work(m);
  small::Hands hands(m);
  hands.first_clip = first_clip;
  hands.second_clip = second_clip;
  hands.cut_at = cut_at;
  while (!hands.done()) {
    o.flags |= step(m, hands.next(s), s, w).flags;
    for (int i = 0; i < w.bleed_count; ++i) {
      const Bleed& b = w.bleeds[size_t(i)];
      if (s.openings[size_t(b.opening)].vessel != small::kTubeArtery) continue;
      o.opening = b.opening;
      o.all.picolitres[b.side] += b.picolitres;
      if (s.tick > small::Hands::kTicks - 1000) o.last.picolitres[b.side] += b.picolitres;
      o.place[b.side] = b.place;
      o.direction[b.side] = b.direction;
    }
  }
  o.clips = int(std::count_if(s.vessel_clips.begin(), s.vessel_clips.begin() + s.vessel_clip_count,
                              [](const auto& c) { return c.vessel == small::kTubeArtery; }));
  o.end = std::move(s);
  return o;
}
double ml_per_minute(std::int64_t picolitres_in_a_second) {
  return double(picolitres_in_a_second) * 1e-15 / kMlPerMinute;
}

const Operation& without_clips() {
  static const Operation o = operate(small::model(), -1, -1);
  return o;
}

TEST(Circulation, AnArteryThatIsCutWithItsTubeBleedsFromTheEndTowardsTheHeart) {
  const Operation& o = without_clips();
  ASSERT_GE(o.opening, 0) << "the artery has been cut with the tube";
  const interactions::VesselOpening& opening = o.end.openings[size_t(o.opening)];
  EXPECT_EQ(opening.through, 1);
  EXPECT_EQ(opening.tool, small::kScissors);
  EXPECT_NEAR(0.001 + opening.s * 0.077, 0.020, 0.002) << "where the blades were: 21 mm of arc from x = -1 mm";
  EXPECT_GT(ml_per_minute(o.last.picolitres[0]), 20);
  EXPECT_EQ(o.last.picolitres[1], 0) << "an end artery: nothing feeds the far stump, it has run dry";
  EXPECT_GT(o.all.picolitres[1], 0) << "but for what its walls held";
  EXPECT_GT(o.direction[0].x, 0.7) << "out of the stump";
  EXPECT_LT(o.direction[1].x, -0.7);
  EXPECT_GT(length(o.place[1] - o.place[0]), 0.0005) << "the stumps have drawn apart with the tube";
  const std::int64_t others = o.end.flow.bled - o.all.picolitres[0] - o.all.picolitres[1];
  EXPECT_GT(o.all.picolitres[0], 0);
  EXPECT_GE(others, 0);
}

TEST(Circulation, AClipTowardsTheHeartStopsItExactly) {
  const Operation o = operate(small::model(), 0.016, -1);
  ASSERT_EQ(o.clips, 1);
  ASSERT_GE(o.opening, 0);
  EXPECT_EQ(o.last.picolitres[0], 0);
  EXPECT_EQ(o.last.picolitres[1], 0);
}

TEST(Circulation, AClipOnTheFarSideLeavesItBleedingAsWithout) {
  const Operation o = operate(small::model(), -1, 0.026);
  ASSERT_EQ(o.clips, 1);
  ASSERT_GE(o.opening, 0);
  EXPECT_NEAR(double(o.last.picolitres[0]) / double(without_clips().last.picolitres[0]), 1, 0.1);
}

TEST(Circulation, WhatIsFedFromBothEndsNeedsAClipOnBothSides) {
  const Operation none = operate(two_sided(), -1, -1), one = operate(two_sided(), 0.016, -1),
                  both = operate(two_sided(), 0.016, 0.026);
  EXPECT_GT(ml_per_minute(none.last.picolitres[0]), 20);
  EXPECT_GT(ml_per_minute(none.last.picolitres[1]), 20);
  EXPECT_EQ(one.last.picolitres[0], 0);
  EXPECT_GT(ml_per_minute(one.last.picolitres[1]), 20);
  EXPECT_EQ(both.last.picolitres[0], 0);
  EXPECT_EQ(both.last.picolitres[1], 0);
}

TEST(Circulation, EveryPicolitreThatBledIsADropFilmOrPool) {
  const State& s = without_clips().end;
  const fluids::Ledger& ledger = s.fluids.ledger;
  EXPECT_GT(s.flow.bled, 100 * fluids::kMicrolitre);
  EXPECT_EQ(ledger.in[size_t(fluids::Source::kBled)].total(), s.flow.bled);
  EXPECT_TRUE(audit(small::model().wet.model, s.fluids));
  EXPECT_GT(at(ledger, fluids::Place::kFilm).total(), 0) << "it has run down on tissue";
  EXPECT_GT(at(ledger, fluids::Place::kPool).total(), 0) << "and gathered";
}

TEST(Circulation, BleedsInPulses) {
  const Model& m = small::model();
  State s = without_clips().end;
  Work w = make_work(m);
  std::vector<double> speed;
  Input input = m.start;
  input.tools[small::kGrasper].handle = 1;  // go on holding what is held
  for (int tick = 0; tick < 2000; ++tick) {
    step(m, input, s, w);
    for (int i = 0; i < w.bleed_count; ++i)
      if (w.bleeds[size_t(i)].opening == without_clips().opening && w.bleeds[size_t(i)].side == 0)
        speed.push_back(w.bleeds[size_t(i)].speed);
  }
  const auto [low, high] = std::minmax_element(speed.begin(), speed.end());
  ASSERT_EQ(speed.size(), 2000u);
  EXPECT_GT(*low, 0.3 * *high) << "never zero in diastole";
  EXPECT_GT(*high, 1.2 * *low) << "but in spurts";
}

/// How much of the blood in drops flies, and how high above its artery, after a second of bleeding through a hole.
struct Jet {
  double flying = 0, highest = 0, slowest = 1e3;  ///< share; [m]; [m/s]
};
Jet jet_of_a_hole(double radius) {
  scene::Description d = small::description();
  d.vessels[0].graph.segments[small::kTubeArtery].radius = radius;
  const Model m = scene::compile(d);
  State s = initial_state(m);
  Work w = make_work(m);
  interactions::VesselOpening& hole = s.openings[0];
  hole.vessel = small::kTubeArtery;
  hole.s = 0.6;
  hole.area = 0.8 * 3.1416 * radius * radius;
  s.opening_count = 1;
  Jet jet;
  double sum = 0;
  for (int tick = 0; tick < 1000; ++tick) {
    step(m, m.start, s, w);
    if (tick < 100) continue;
    jet.slowest = std::min(jet.slowest, w.bleeds[0].speed);
    const fluids::DropletState& drops = s.fluids.droplets;
    for (size_t i = 0; i < size_t(drops.count); ++i) {
      const double volume = double(drops.volume[i].total());
      sum += volume;
      if (drops.body[i] < 0) jet.flying += volume;
      jet.highest = std::max(jet.highest, double(drops.z[i]));
    }
  }
  jet.flying /= sum;
  return jet;
}

TEST(Circulation, TheJetOfAHoleLeavesTheTissueThatCarriesItsArtery) {
  const Jet jet = jet_of_a_hole(0.00045);
  std::printf("    from %.2f m/s on: %.0f %% of what is in drops flies, up to %.0f mm\n", jet.slowest, 100 * jet.flying,
              1e3 * jet.highest);
  ASSERT_LT(jet.slowest, 1.5) << "slower than it takes to leave the tube within a tick";
  EXPECT_GT(jet.highest, jet.slowest * jet.slowest / 2 / 9.81);
  EXPECT_GT(jet.flying, 0.3) << "the rest has come down";
}

TEST(Circulation, TheClosingClipThrottlesForTenthsOfASecond) {
  interactions::VesselClip clip;
  clip.cover = 1;
  EXPECT_EQ(interactions::cover_at(clip, 0), 0);
  EXPECT_NEAR(interactions::cover_at(clip, 0.5 * interactions::kClipCloses), 0.5, 1e-12);
  EXPECT_EQ(interactions::cover_at(clip, interactions::kClipCloses), 1);
  EXPECT_GE(interactions::kClipCloses, 0.1);
}

TEST(Circulation, BladesInABarOpenTheArteryInIt) {
  const State& s = without_clips().end;
  const bool open = std::any_of(s.openings.begin(), s.openings.begin() + s.opening_count,
                                [](const auto& o) { return o.vessel == small::kBarArtery && o.through; });
  EXPECT_TRUE(open);
}

TEST(Circulation, WhoeverLosesBloodLosesPressure) {
  const Model& m = small::model();
  State s = initial_state(m);
  Work w = make_work(m);
  const auto mean_pressure = [&](State& state) {
    double sum = 0;
    for (int i = 0; i < 900; ++i) {
      step(m, m.start, state, w);
      sum += read_wall(m.vessels.flow, state.flow, small::kTubeArtery, 0.2).pressure / 900;
    }
    return sum;
  };
  const double before = mean_pressure(s);
  s.flow.bled = 2'000'000'000'000;  // two litres
  mean_pressure(s);
  EXPECT_LT(mean_pressure(s), 0.75 * before);
}

/// Circulation alone, without tissue that moves: thousands of cuts in no time.
struct Still {
  const Model& m;
  State s;
  Work w;
  StepReport report;
  explicit Still(const Model& model) : m(model), s(initial_state(model)), w(make_work(model)) {}
  StepContext context() { return {m, m.start, s, w, report}; }
  void cut(int vessel, double at) {
    StepContext c = context();
    pose_vessels(c);
    const auto& path = m.vessels.list[size_t(vessel)].path;
    const interactions::VesselSpot spot = vessel_spot(path, w.vessel_points[size_t(vessel)], {}, at);
    for (const BodyId carrier : {BodyId{}, BodyId::organ(small::kBar)})
      open_vessels(c, geometry::square_blade(spot.place, spot.along, 0.002), carrier, small::kScissors);
  }
  void clip(int vessel, double at, double cover = 1) {
    s.vessel_clips[size_t(s.vessel_clip_count++)] = {at, cover, s.tick, vessel, 0};
  }
  /// What the first opening's sides lose in so many ticks.
  Lost run(int ticks) {
    Lost lost;
    StepContext c = context();
    for (int i = 0; i < ticks; ++i, ++s.tick) {
      update_blood_flow(c);
      for (int k = 0; k < w.bleed_count; ++k)
        if (w.bleeds[size_t(k)].opening == 0)
          lost.picolitres[w.bleeds[size_t(k)].side] += w.bleeds[size_t(k)].picolitres;
    }
    return lost;
  }
};

TEST(Circulation, AnArteryCutAnywhereBleedsFromTheRightEndAndAClipOnTheRightSideStopsIt) {
  for (const int vessel : {small::kTubeArtery, small::kFoldArtery, small::kBarArtery})
    for (double at = 0.08; at < 0.93; at += 0.07) {
      SCOPED_TRACE(testing::Message() << "vessel " << vessel << " at " << at);
      Still open(small::model()), upstream(small::model()), downstream(small::model());
      for (Still* x : {&open, &upstream, &downstream}) {
        x->cut(vessel, at);
        ASSERT_EQ(x->s.opening_count, 1);
        ASSERT_EQ(x->s.openings[0].vessel, vessel);
        EXPECT_EQ(x->s.openings[0].through, 1);
        EXPECT_NEAR(x->s.openings[0].s, at, 1e-6);
      }
      upstream.clip(vessel, 0.6 * at);
      downstream.clip(vessel, at + 0.5 * (1 - at));
      for (Still* x : {&open, &upstream, &downstream}) x->run(700);
      const Lost a = open.run(300), b = upstream.run(300), c = downstream.run(300);
      EXPECT_GT(a.picolitres[0], 0);
      EXPECT_EQ(a.picolitres[1], 0);
      EXPECT_EQ(b.picolitres[0], 0);
      EXPECT_EQ(b.picolitres[1], 0);
      EXPECT_NEAR(double(c.picolitres[0]) / double(a.picolitres[0]), 1, 0.05);
      EXPECT_EQ(c.picolitres[1], 0);
    }
}

TEST(Circulation, ABladeThatReachesPartOfTheWidthMakesAHole) {
  Still t(small::model());
  StepContext c = t.context();
  pose_vessels(c);
  const auto& path = t.m.vessels.list[small::kTubeArtery].path;
  const interactions::VesselSpot spot = vessel_spot(path, t.w.vessel_points[small::kTubeArtery], {}, 0.5);
  const Vec3d beside = spot.place + 0.0019 * any_perpendicular(spot.along);
  open_vessels(c, geometry::square_blade(beside, spot.along, 0.0016), {}, small::kScissors);
  ASSERT_EQ(t.s.opening_count, 1);
  EXPECT_EQ(t.s.openings[0].through, 0);
  EXPECT_GT(t.s.openings[0].area, 0);
  EXPECT_LT(t.s.openings[0].area, 3.1416 * 0.0006 * 0.0006);
  const Lost lost = t.run(500);
  EXPECT_GT(lost.picolitres[0], 0);
  EXPECT_EQ(lost.picolitres[1], 0) << "a hole has one side";
}

TEST(Circulation, NoMoreOpeningsThanThereIsRoomForAndThatIsTold) {
  Still t(small::model());
  StepContext c = t.context();
  pose_vessels(c);
  const auto& path = t.m.vessels.list[small::kTubeArtery].path;
  t.s.opening_count = interactions::kMaxOpenings;
  for (auto& o : t.s.openings) o = {.s = 0.5, .area = 0, .tick = 0, .vessel = small::kBarArtery};
  const interactions::VesselSpot spot = vessel_spot(path, t.w.vessel_points[small::kTubeArtery], {}, 0.5);
  open_vessels(c, geometry::square_blade(spot.place, spot.along, 0.002), {}, small::kScissors);
  EXPECT_EQ(t.s.opening_count, interactions::kMaxOpenings);
  EXPECT_NE(t.report.flags & StepReport::kRecordsFull, 0u);
}

TEST(Circulation, VesselsGoWithWhatCarriesThem) {
  const Model& m = small::model();
  State s = initial_state(m);
  Work w = make_work(m);
  small::Hands hands(m);
  hands.first_clip = hands.second_clip = hands.cut_at = -1;
  while (s.tick < 1100) step(m, hands.next(s), s, w);  // the tube is lifted by 8 mm
  StepReport report;
  StepContext c{m, m.start, s, w, report};
  pose_vessels(c);
  double farthest = 0;
  for (const Vec3d& x : w.vessel_points[small::kTubeArtery]) {
    double nearest = 1;
    const auto& strand = s.strands[small::kTube].x;
    for (size_t i = 0; i + 1 < strand.size(); ++i) {
      const Vec3d a = strand[i], ab = strand[i + 1] - a;
      const double along = std::clamp(dot(x - a, ab) / dot(ab, ab), 0.0, 1.0);
      nearest = std::min(nearest, length(x - a - along * ab));
    }
    farthest = std::max(farthest, nearest);
  }
  EXPECT_LT(farthest, 0.0005) << "it was drawn on the tube's axis";
  const auto highest =
      std::max_element(w.vessel_points[small::kTubeArtery].begin(), w.vessel_points[small::kTubeArtery].end(),
                       [](Vec3d a, Vec3d b) { return a.z < b.z; });
  EXPECT_GT(highest->z, 0.005);
}

/// How far the fold's nodes go in two seconds of heartbeat.
double sway(double gain) {
  scene::Description d = small::description();
  d.vessels[0].pulse_gain = gain;
  const Model m = scene::compile(d);
  State s = initial_state(m);
  Work w = make_work(m);
  const tissue::NetworkModel& fold = m.membranes[0].sheet.network;
  double most = 0;
  for (int tick = 0; tick < 2000; ++tick) {
    step(m, m.start, s, w);
    for (int n = 0; n < fold.nodes; ++n)
      most = std::max(most, length(tissue::position(fold, s.membranes[0].network, n) - fold.rest[size_t(n)]));
  }
  return most;
}

TEST(Circulation, ThePulseMovesWhatCarriesItMoreWithAGain) {
  const double still = sway(0), physical = sway(1), shown = sway(5);
  EXPECT_LT(still, 5e-5);
  EXPECT_GT(physical, 1.5 * still);
  EXPECT_GT(shown, 2 * physical);
  EXPECT_LT(shown, 3e-3);
}

/// What a closed instrument that presses on the tube from above feels of the pulse: how much more in systole [N].
struct Felt {
  double amplitude = 0, mean = 0;
};
Felt palpated(double gain, double x) {
  scene::Description d = small::description();
  d.vessels[0].pulse_gain = gain;
  const Model m = scene::compile(d);
  small::Table t(m);
  t.close(small::kGrasper, 1);
  t.carry(small::kGrasper, {0.055, 0, 0.04}, {x, 0, 0.010}, 0.1);
  t.carry(small::kGrasper, {x, 0, 0.010}, {x, 0, -0.0005}, 0.02);
  t.steps(300);
  // Force and pressure go together: the part of the one that follows the other.
  std::vector<double> force, pressure;
  for (int i = 0; i < 833; ++i) {  // a beat of 72 a minute
    t.step();
    force.push_back(t.tool(small::kGrasper).contact_force[2]);
    pressure.push_back(read_wall(m.vessels.flow, t.state.flow, small::kTubeArtery, 0.7).pressure);
  }
  const auto mean = [](const std::vector<double>& v) {
    double sum = 0;
    for (const double a : v) sum += a / double(v.size());
    return sum;
  };
  const double f = mean(force), p = mean(pressure);
  double both = 0, own = 0, high = 0;
  for (size_t i = 0; i < force.size(); ++i) {
    both += (force[i] - f) * (pressure[i] - p);
    own += (pressure[i] - p) * (pressure[i] - p);
    high = std::max(high, pressure[i] - p);
  }
  return {both / own * high, f};
}

TEST(Circulation, APalpatingInstrumentFeelsThePulseAsForceInProportionToTheGain) {
  const Felt none = palpated(0, 0.050), physical = palpated(1, 0.050), enlarged = palpated(5, 0.050);
  std::printf("    pressed with %.2f N; pulse felt: %.1f, %.1f, %.1f mN with gains of 0, 1, 5\n", physical.mean,
              1e3 * none.amplitude, 1e3 * physical.amplitude, 1e3 * enlarged.amplitude);
  EXPECT_GT(physical.mean, 0.02) << "it presses on the tube";
  EXPECT_GT(physical.amplitude, 0.0003) << "the tube lies on what is soft, too";
  EXPECT_LT(physical.amplitude, 0.030) << "an artery of 1.2 mm: 40 mmHg on some square millimetres";
  EXPECT_LT(std::fabs(none.amplitude), 0.2 * physical.amplitude);
  EXPECT_NEAR(enlarged.amplitude / physical.amplitude, 5, 1);
}

TEST(Circulation, TheDrawnPlaceIsTheFirst) {
  const Model& m = small::model();
  State s = initial_state(m);
  Work w = make_work(m);
  StepReport report;
  StepContext c{m, m.start, s, w, report};
  pose_vessels(c);
  for (size_t v = 0; v < m.vessels.list.size(); ++v)
    for (size_t i = 0; i < w.vessel_points[v].size(); ++i)
      EXPECT_LT(length(w.vessel_points[v][i] - m.vessels.list[v].path.points[i].drawn), 1e-6) << v << " " << i;
}

TEST(Circulation, KeyframesShowOpeningsClipsAndPulse) {
  const Operation& o = without_clips();
  State shown = initial_state(small::model());
  ASSERT_TRUE(restore_display(small::model(), display_bytes(small::model(), o.end), shown));
  EXPECT_EQ(shown.opening_count, o.end.opening_count);
  EXPECT_EQ(shown.openings[0].s, o.end.openings[0].s);
  EXPECT_EQ(shown.flow.bled, o.end.flow.bled);
  EXPECT_EQ(shown.flow.p, o.end.flow.p);
}

}  // namespace
