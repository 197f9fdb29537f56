// An injection needle in a scene: it pierces, fills, leaks, and what it has given is all accounted for; drugged tissue
// bleeds less.
#include <cmath>

#include <gtest/gtest.h>

#include <trocar/fluids/fluids.hpp>
#include <trocar/sim/recording/keyframe.hpp>
#include <trocar/sim/stages/injecting.hpp>

#include "small_scene.hpp"

using namespace trocar;
using namespace trocar::sim;

namespace {

constexpr int kNeedle = 1;                   // its hand
constexpr int kOrgan = 0;                    // what it goes into
constexpr double kX = -0.022, kTop = 0.012;  // [m] it goes in there, from above
constexpr double kLength = 0.020;            // [m]
constexpr double kPuncture = 0.5;            // [N] of the tissue, for a suture's needle
constexpr int kSmall = 3, kWide = 4;         // arteries in the organ

scene::Description with_needle() {
  scene::Description d = small::description();
  scene::Instrument i = small::instrument("needle", interactions::ToolKind::injection_needle);
  i.jaw_length = 0.004;
  i.jaw_width = 0.005;
  i.jaw_thickness = 0.0018;
  i.opening = 0;
  i.needle.units = 0.2;
  d.instruments.push_back(i);
  d.ports[kNeedle].position = {kX, 0, small::kHeight};
  d.placements[kNeedle] = {"needle", "b", {kX, 0, 0.05}, 0, {}};
  // Two end arteries below the organ's skin, one of them wider than a millimetre.
  scene::VesselTree& tree = d.vessels.front();
  const int first = tree.graph.nodes;
  tree.graph.nodes += 4;
  for (const char* node : {"small_heart", "wide_heart", "small_end", "wide_end"}) tree.nodes.emplace_back(node);
  small::add_artery(tree, "small", first, first + 2,
                    {{-0.032, 0.006, 0.009}, {kX, 0.006, 0.009}, {-0.012, 0.006, 0.009}}, {"organ"}, 0.0002);
  small::add_artery(tree, "wide", first + 1, first + 3, {{-0.032, 0, 0.006}, {kX, 0, 0.006}, {-0.012, 0, 0.006}},
                    {"organ"}, 0.0009);
  for (int k = 0; k < 2; ++k) {
    tree.graph.ends.push_back(
        vessels::matched_end(tree.graph, 3 + k, 88 * vessels::kPascalPerMmHg, (k ? 10e-6 : 1e-6) / 60, 1));
    tree.graph.sources.push_back({.node = first + k});
  }
  return d;
}
const Model& needle_model() {
  static const Model made = scene::compile(with_needle());
  return made;
}

/// A needle that goes straight down.
struct Ward : small::Table {
  explicit Ward(const Model& m = needle_model()) : Table(m) {}

  void lower(double point, double speed = 0.02) {
    carry(kNeedle, {kX, 0, at}, {kX, 0, point + kLength}, speed);
    at = point + kLength;
  }
  /// Until the skin gives way.
  void pierce() {
    lower(kTop + 0.001, 0.2);
    for (int i = 0; i < 4000 && !needle().in(); ++i) {
      at -= 5e-6;
      point(kNeedle, {kX, 0, at});
      step();
    }
  }
  void press(int ticks) {
    input.pedals = irrigates(kNeedle);
    for (int i = 0; i < ticks; ++i) {
      step();
      ASSERT_TRUE(balanced(state.injection)) << i;
    }
    input.pedals = 0;
  }
  const NeedleHand& needle() const { return state.injection.hands[kNeedle]; }
  const InjectionAccount& account() const { return state.injection.account; }
  const tissue::InfusionState& organ() const { return state.injection.organs[kOrgan]; }

  double at = 0.05;
};

/// The drug in all of the organ, long enough for its full effect.
void drug(State& s) {
  tissue::InfusionState& organ = s.injection.organs[kOrgan];
  std::fill(organ.dose.begin(), organ.dose.end(), 1.0f);
  std::fill(organ.since.begin(), organ.since.end(), 1u);
  s.tick = 100'000;
}

/// What an artery bleeds, cut through near its end, over half a second after another half [m^3/s].
double bleeds_per_second(bool drugged, int vessel) {
  small::Table t(needle_model());
  if (drugged) drug(t.state);
  interactions::VesselOpening& o = t.state.openings[size_t(t.state.opening_count++)];
  const vessels::FlowSegment& segment = t.model.vessels.flow.segments[size_t(vessel)];
  o.s = 0.98;
  o.vessel = vessel;
  o.through = 1;
  o.area = 3.14159265358979 * segment.radius * segment.radius;
  o.tick = t.state.tick;
  t.steps(500);
  const std::int64_t before = t.state.flow.bled;
  t.steps(500);
  return double(t.state.flow.bled - before) * 1e-15 / 0.5;
}

}  // namespace

TEST(Injection, SkinGivesWayAtItsPunctureForceAndNotBefore) {
  Ward w;
  double most = 0;
  w.lower(kTop + 0.001, 0.2);
  for (int i = 0; i < 4000 && !w.needle().in(); ++i) {
    w.at -= 5e-6;
    w.point(kNeedle, {kX, 0, w.at});
    w.step();
    most = std::max(most, w.needle().press);
  }
  ASSERT_TRUE(w.needle().in());
  EXPECT_NEAR(most, interactions::kGroundBevel * kPuncture, 0.02);
  EXPECT_EQ(w.count(Event::pierced), 1);
  w.steps(300);
  EXPECT_GT(w.needle().depth, 0.0);
  EXPECT_LT(w.needle().depth, 0.008);
  EXPECT_EQ(w.flags, 0u);
}

TEST(Injection, WhatHasFlowedInIsInTheTissueOrHasLeakedToThePicolitre) {  // [injection account]
  Ward w;
  w.pierce();
  ASSERT_TRUE(w.needle().in());
  w.press(3000);
  EXPECT_NEAR(double(w.account().injected) * 1e-15, 10e-6 / 60 * 2.85, 1e-8);
  EXPECT_EQ(w.account().injected, in_tissue(w.state.injection) + w.account().absorbed + w.account().leaked);
  EXPECT_EQ(w.account().spilled, 0);
  w.lower(0.04);
  EXPECT_FALSE(w.needle().in());
  for (int i = 0; i < 3000; ++i) {
    w.step();
    ASSERT_TRUE(balanced(w.state.injection));
  }
  EXPECT_GT(w.account().leaked, 0);
  EXPECT_GT(w.account().absorbed, 0);
  EXPECT_EQ(w.account().injected, in_tissue(w.state.injection) + w.account().absorbed + w.account().leaked);
  // What has leaked is in the fluids' account, and clear.
  EXPECT_EQ(w.state.fluids.ledger.in[size_t(fluids::Source::kIrrigated)].saline, w.account().leaked);
  EXPECT_TRUE(audit(w.model.wet.model, w.state.fluids));
  EXPECT_EQ(w.flags, 0u);
}

TEST(Injection, WhatLeaksOutOfAllTracksAtOnceReachesTheFluidsAccountToThePicolitre) {  // [injection account]
  Ward w;
  w.pierce();
  w.press(3000);
  w.lower(0.04);
  InjectionState& s = w.state.injection;
  ASSERT_GE(s.track_count, 1);
  for (; s.track_count < kMaxTracks; ++s.track_count) s.tracks[size_t(s.track_count)] = s.tracks[0];
  const std::int64_t before = w.account().leaked;
  for (int i = 0; i < 100; ++i) {
    w.step();
    ASSERT_EQ(w.state.fluids.ledger.in[size_t(fluids::Source::kIrrigated)].saline, w.account().leaked) << i;
  }
  int leaking = 0;
  for (const NeedleTrack& track : s.tracks) leaking += track.leaked > 0;
  EXPECT_EQ(leaking, kMaxTracks);
  EXPECT_GT(w.account().leaked, before);
  EXPECT_TRUE(balanced(s));
  EXPECT_TRUE(audit(w.model.wet.model, w.state.fluids));
}

TEST(Injection, IntoTheOpenItIsSpilled) {
  Ward w;
  w.press(1000);
  EXPECT_GT(w.account().injected, 0);
  EXPECT_EQ(w.account().injected, w.account().spilled);
  EXPECT_EQ(w.state.fluids.ledger.in[size_t(fluids::Source::kIrrigated)].saline, w.account().spilled);
}

TEST(Injection, WhereItLiesTheOrganSwellsByWhatItHolds) {  // [injected volume]
  Ward w;
  w.pierce();
  w.press(3000);
  w.steps(1500);
  EXPECT_GT(double(w.organ().total) * 1e-15, 0.4e-6);
  const tissue::InfusionModel& model = w.model.injection.organs[kOrgan].infusion;
  double held = 0, more = 0;
  for (size_t r = 0; r < model.room.size(); ++r) {
    // Farther out the surface nearby opens tissue by more than lies there, and fluid does not pull.
    if (double(w.organ().volume[r]) * 1e-15 < 0.1 * double(model.room[r])) continue;
    held += double(w.organ().volume[r]) * 1e-15;
    more += double(w.work.infusion[kOrgan].now[r]) - double(model.room[r]);
  }
  EXPECT_NEAR(more / held, 1, 0.05);
}

/// A syringe of 100 mL that a hand empties as fast as it can, into flesh that can tear.
const Model& flooded_model() {
  static const Model made = [] {
    scene::Description d = with_needle();
    for (scene::Tissue& t : d.tissues)
      if (t.name == "flesh") t.failure_strain = 0.65;
    for (scene::Instrument& i : d.instruments)
      if (i.name == "needle") i.needle.holds = 100e-6, i.needle.flow = 600e-6;  // [m^3], [m^3/min]
    return scene::compile(d);
  }();
  return made;
}

TEST(Injection, AHundredMillilitresAtOnceComeBackAlongTheNeedleAndNothingIsLostOrNotFinite) {  // [back flow]
  Ward w(flooded_model());
  w.pierce();
  ASSERT_TRUE(w.needle().in());
  double highest = 0;
  w.input.pedals = irrigates(kNeedle);
  for (int i = 0; i < 60'000 && w.needle().left > 0; ++i) {
    w.step();
    highest = std::max(highest, w.needle().tip_pressure);
    ASSERT_TRUE(balanced(w.state.injection)) << i;
    ASSERT_EQ(w.flags & (tissue::StepReport::kNonFinite | tissue::StepReport::kIndefinite), 0u) << i;
  }
  EXPECT_EQ(w.needle().left, 0);
  double room = 0;
  for (const float v : w.model.injection.organs[kOrgan].infusion.room) room += double(v);
  const double held = double(w.organ().total) * 1e-15, leaked = double(w.account().leaked) * 1e-15;
  std::printf("%.1f mL in %.1f mL of flesh, %.1f mL leaked, %d tears, %.0f kPa, %.1f s\n", 1e6 * held, 1e6 * room,
              1e6 * leaked, w.count(Event::torn), highest / 1e3, double(w.state.tick) * kTick);
  EXPECT_LE(held, 1.001 * tissue::kFullest * room);
  EXPECT_GT(leaked, 0.5 * 100e-6);
  EXPECT_GT(highest, 3 * 5.0 / 6 * 20e3) << "it takes more than to open a cavity";
  for (const Event& e : w.events) {
    if (e.kind != Event::torn) continue;
    EXPECT_EQ(e.hand, kNeedle) << "whose needle it is";
  }
}

TEST(Injection, TheHandFeelsPressureTimesAreaOnItsPlunger) {  // [plunger]
  Ward w;
  w.pierce();
  w.press(1000);
  const interactions::NeedleModel& needle = w.model.tool(w.state, kNeedle).needle;
  const double pressure = w.needle().tip_pressure + needle.resistance(interactions::kInjected) * w.needle().flow;
  EXPECT_NEAR(w.needle().plunger, pressure * needle.area(), 1e-9);
  EXPECT_EQ(w.tool(kNeedle).pinch, w.needle().plunger);
  // flesh of 20 kPa opens at 16.7
  EXPECT_NEAR(w.needle().tip_pressure, 5.0 / 6 * 20e3, 1);
}

TEST(Injection, DrawnInAVesselBloodComesAndWhatIsInjectedThereIsWashedAway) {
  Ward w;
  w.pierce();
  for (int i = 0; i < 6000 && w.needle().vessel < 0; ++i) {
    w.at -= 3e-6;
    w.point(kNeedle, {kX, 0, w.at});
    w.input.pedals = sucks(kNeedle);
    w.step();
  }
  ASSERT_EQ(w.needle().vessel, kWide);
  w.steps(300);
  EXPECT_GT(w.needle().blood, 0);
  w.press(500);
  EXPECT_GT(w.account().vessel, 0);
  EXPECT_EQ(w.organ().total, 0);
  EXPECT_EQ(w.count(Event::injected), 1);
}

TEST(Injection, AVesselOfLessThanAMillimetreBleedsAFifthWhereTissueIsBlanchedAWiderOneAsItDid) {
  EXPECT_NEAR(bleeds_per_second(true, kSmall) / bleeds_per_second(false, kSmall), 0.2, 0.02);
  EXPECT_NEAR(bleeds_per_second(true, kWide) / bleeds_per_second(false, kWide), 1, 1e-9);
}

TEST(Injection, ANeedleThatIsDrawnInPiercesNothing) {
  Ward w;
  w.close(kNeedle, 1);
  w.steps(300);
  w.lower(kTop - 0.003, 0.02);
  EXPECT_EQ(w.count(Event::pierced), 0);
  EXPECT_EQ(w.needle().press, 0);
}

TEST(Injection, SavedAtAnyTickItGoesOnWithTheSameBitsAndScratchFullOfNaNChangesNone) {
  Ward w;
  w.pierce();
  w.press(400);
  State saved = w.state;
  Work fresh = make_work(w.model);
  w.input.pedals = irrigates(kNeedle);
  for (int i = 0; i < 200; ++i) {
    w.step();
    poison(fresh);
    step(w.model, w.input, saved, fresh);
    ASSERT_EQ(hash_of(saved), hash_of(w.state)) << i << ": " << first_difference(saved, w.state);
  }
}

TEST(Injection, AKeyframeShowsWhatIsBlanched) {
  Ward w;
  w.pierce();
  w.press(2000);
  w.state.tick += 95'000;
  const std::vector<std::uint8_t> bytes = display_bytes(w.model, w.state);
  State shown = initial_state(w.model);
  ASSERT_TRUE(restore_display(w.model, bytes, shown));
  const tissue::Skin& skin = w.model.solids[kOrgan].fine;
  double most = 0;
  for (int v = 0; v < skin.size(); ++v) {
    const double pale = blanched_at(w.state, kOrgan, skin, v);
    ASSERT_EQ(blanched_at(shown, kOrgan, skin, v), pale);
    most = std::max(most, pale);
  }
  EXPECT_GT(most, 0.5);
  // What names no place of the skin is refused.
  State bad = w.state;
  bad.injection.hands[kNeedle].entry.node[0] = 1'000'000;
  EXPECT_FALSE(restore_display(w.model, display_bytes(w.model, bad), shown));
}

TEST(Injection, ASceneWithoutANeedleHasNothingOfIt) {
  const Model& m = small::model();
  EXPECT_FALSE(m.injection.there());
  EXPECT_FALSE(initial_state(m).injection.there());
}
