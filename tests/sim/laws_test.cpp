// The laws of the step (docs/developers/architecture.md): what a tick may depend on, and what it may not do. All on one
// piece of work in the small scene: approach, grasp, lift, two clips, a cut through the tube, one through the bar.
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <limits>
#include <thread>

#include <gtest/gtest.h>
#include <unistd.h>

#include <trocar/core/random.hpp>
#include <trocar/sim/recording/recording.hpp>

#include "session.hpp"
#include "small_energy.hpp"

// Every way to the heap is counted while `counting` is set: the C library's entries are replaced, operator new calls
// them. A sanitizer has replaced them itself.
namespace {
thread_local bool counting = false;
thread_local long allocations = 0;
}  // namespace
#if defined(__GLIBC__) && !defined(TROCAR_SANITIZED)
#define TROCAR_COUNTS_ALLOCATIONS 1
extern "C" {
void* __libc_malloc(std::size_t);
void* __libc_calloc(std::size_t, std::size_t);
void* __libc_realloc(void*, std::size_t);
void* __libc_memalign(std::size_t, std::size_t);
void* malloc(std::size_t n) noexcept {
  allocations += counting;
  return __libc_malloc(n);
}
void* calloc(std::size_t n, std::size_t size) noexcept {
  allocations += counting;
  return __libc_calloc(n, size);
}
void* realloc(void* p, std::size_t n) noexcept {
  allocations += counting;
  return __libc_realloc(p, n);
}
void* aligned_alloc(std::size_t alignment, std::size_t n) noexcept {
  allocations += counting;
  return __libc_memalign(alignment, n);
}
int posix_memalign(void** p, std::size_t alignment, std::size_t n) noexcept {
  allocations += counting;
  *p = __libc_memalign(alignment, n);
  return *p ? 0 : 12;
}
}
#endif

using namespace trocar;
using namespace trocar::sim;
using namespace trocar::laws;

namespace {

static_assert(noexcept(step(std::declval<const Model&>(), std::declval<const Input&>(), std::declval<State&>(),
                            std::declval<Work&>())));

TEST(Step, TheSessionOfTheseTestsGraspsClipsTwiceAndCutsTwice) {
  EXPECT_EQ(session().grasped.size(), 1u);
  EXPECT_EQ(session().clipped.size(), 2u);
  EXPECT_EQ(session().cut.size(), 2u) << "the tube and the bar";
  EXPECT_GT(session().torn, 0) << "the fold is cut with the tube, so that these laws are tested on that, too";
  EXPECT_EQ(session().flags & ~std::uint32_t(tissue::StepReport::kInverted), 0u);
}

TEST(Step, WhatNoLongerFitsTheBuffersIsNeitherCutNorClippedAndIsReported) {
  const Model& m = small::model();
  State s = initial_state(m);
  Work w = make_work(m);
  s.clip_count = interactions::kMaxClips;
  s.cut_count = interactions::kMaxCuts;
  std::uint32_t flags = 0;
  for (const Input& input : session().inputs) {
    const StepReport report = step(m, input, s, w);
    flags |= report.flags;
    for (int i = 0; i < report.event_count; ++i) {
      EXPECT_NE(report.events[i].kind, Event::clipped);
      EXPECT_NE(report.events[i].kind, Event::cut);
    }
  }
  EXPECT_NE(flags & StepReport::kRecordsFull, 0u);
  for (const tissue::StrandState& strand : s.strands)
    EXPECT_EQ(std::count(strand.alive.begin(), strand.alive.end(), 0), 0);
  for (const auto& torn : s.torn) EXPECT_EQ(std::count(torn.begin(), torn.end(), 1), 0);
  for (const auto& parted : s.parted) EXPECT_EQ(std::count(parted.begin(), parted.end(), 1), 0);
}

TEST(Step, TheSameInputsGiveTheSameState) {
  State s = initial_state(small::model());
  Work w = make_work(small::model());
  EXPECT_EQ(first_difference(s, w), 0u) << differing_field;
  EXPECT_EQ(hash_of(s), session().hash.back());
}

TEST(Step, AnotherInputGivesAnotherState) {
  // So that the tests of this file can fail.
  State s = initial_state(small::model());
  Work w = make_work(small::model());
  const std::uint64_t at = session().grasped[0] + 250;
  const std::uint64_t mark = (at / kMark + 1) * kMark;
  const std::uint64_t found = first_difference(s, w, [at](State& state, Work&) {
    if (state.tick == at) state.tools[small::kGrasper].hold[0].local[2] += 1e-6f;
  });
  EXPECT_EQ(found, mark);
  EXPECT_FALSE(differing_field.empty());
}

// Of the whole piece of work these three are told by the soak (laws_soak.cpp).

TEST(Step, PoisonedWorkChangesNoBit) {
  Work w = make_work(small::model());
  EXPECT_EQ(first_difference_where_it_happens(w, [](State&, Work& work) { poison(work); }), 0u) << differing_field;
}

TEST(Step, ThePoolsSizeChangesNoBit) {
  for (int threads : {1, 2, 3, 5}) {
    core::ThreadPool pool(threads);
    Work w = make_work(small::model(), &pool);
    EXPECT_EQ(first_difference_where_it_happens(w), 0u) << threads << " threads, " << differing_field;
  }
}

TEST(Step, TheSimdWidthChangesNoBit) {
  const std::string usual = tissue::simd_name();
  int tried = 0;
  for (const char* name : {"generic", "sse2", "avx2", "avx512"}) {
    if (!tissue::set_simd(name)) continue;
    ++tried;
    Work w = make_work(small::model());
    EXPECT_EQ(first_difference_where_it_happens(w), 0u) << name << ", " << differing_field;
  }
  tissue::set_simd(usual);
  EXPECT_GE(tried, 1);
}

TEST(Step, EveryEventIsWhereThoseLawsLook) {
  const auto looks_at = [](std::uint64_t tick) {
    const std::vector<Stretch> all = stretches();
    return std::any_of(all.begin(), all.end(),
                       [&](Stretch s) { return s.from + 100 <= tick && tick + 100 <= s.until; });
  };
  int events = 0;
  for (const std::vector<std::uint64_t>* list : {&session().grasped, &session().clipped, &session().cut})
    for (const std::uint64_t tick : *list) {
      EXPECT_TRUE(looks_at(tick)) << tick;
      ++events;
    }
  EXPECT_EQ(events, 5);
}

TEST(Step, AnotherInputWhereItHappensGivesAnotherState) {
  // So that the three can fail: in the last stretch, around the last cut.
  const Stretch last = stretches().back();
  Work w = make_work(small::model());
  const std::uint64_t found = first_difference_where_it_happens(w, [&](State& state, Work&) {
    if (state.tick == last.from + 50) state.strands[small::kTube].x[3].z += 1e-9;
  });
  EXPECT_EQ(found, last.from + kMark);
}

TEST(State, SavedAtAnyTickAndGoneOnWithInAnotherWorkIsTheSame) {
  // Saved before the approach, at first contact, closing, held, between the clips, and around both cuts.
  const Session& r = session();
  const Model& m = small::model();
  const std::vector<std::uint64_t> saves{
      1,        250,  r.grasped[0] - 1, r.grasped[0], 1000, r.clipped[0] - 1, 2500, r.cut[0] - 1,
      r.cut[0], 4300, r.cut[1] - 1,     r.cut[1],     5200};
  Work w = make_work(m);
  for (const std::uint64_t at : saves) {
    State from = at < kMark ? initial_state(m) : r.states[at / kMark - 1];
    while (from.tick < at) step(m, r.inputs[from.tick], from, w);
    Work fresh = make_work(m);
    EXPECT_EQ(first_difference(
                  from, fresh, [](State&, Work&) {}, at + 600),
              0u)
        << "saved at tick " << at << ", " << differing_field;
  }
}

TEST(State, RestoredIntoAStateOfOtherContentIsTheSame) {
  const Session& r = session();
  const Model& m = small::model();
  State s = r.states[r.states.size() - 2];
  Work w = make_work(m);
  EXPECT_EQ(first_difference(s, w), 0u) << differing_field;
  s = r.states[2000 / kMark - 1];  // the State at the end of the work, and the scratch, go back
  EXPECT_EQ(hash_of(s), r.hash[2000 / kMark - 1]);
  EXPECT_EQ(first_difference(
                s, w, [](State&, Work&) {}, r.cut[0] + kMark),
            0u)
      << differing_field;
}

TEST(Model, ServesTwoThreadsAtOnce) {
  const Model& m = small::model();
  session();
  std::uint64_t difference[2] = {1, 1};
  const auto work = [&](int i) {
    Work w = make_work(m);
    difference[i] = first_difference_where_it_happens(w);
  };
  std::thread a(work, 0), b(work, 1);
  a.join();
  b.join();
  for (int i : {0, 1}) EXPECT_EQ(difference[i], 0u);
}

TEST(Step, AllocatesNothing) {
#ifndef TROCAR_COUNTS_ALLOCATIONS
  GTEST_SKIP() << "this build's heap is somebody else's (sanitizer, or not glibc)";
#endif
  const Session& r = session();
  const Model& m = small::model();
  State s = initial_state(m);
  Work w = make_work(m);
  counting = true;
  allocations = 0;
  for (const Input& input : r.inputs) step(m, input, s, w);  // the first tick counts too
  const std::uint64_t hash = hash_of(s);
  counting = false;
  EXPECT_EQ(allocations, 0);
  EXPECT_EQ(hash, r.hash.back());
  counting = true;  // the counter counts
  std::vector<double> some(1000, 1.0);
  counting = false;
  EXPECT_EQ(allocations, 1) << some[0];
}

TEST(Step, AllocatesNothingWhileCurrentHeatsTissueAndPartsIt) {
#ifndef TROCAR_COUNTS_ALLOCATIONS
  GTEST_SKIP() << "this build's heap is somebody else's (sanitizer, or not glibc)";
#endif
  small::Table t(small::energy());
  small::put_hook_down(t);
  t.input.pedals = kYellow;
  StepReport report;
  int parted = 0;
  counting = true;
  allocations = 0;
  for (int i = 0; i < 500; ++i) {
    t.point(small::kHook, small::kOnOrgan + Vec3d{4e-6 * i, 0, -1e-6 * i});
    report = step(t.model, t.input, t.state, t.work);
    for (int e = 0; e < report.event_count; ++e) parted += report.events[e].kind == Event::parted;
  }
  counting = false;
  EXPECT_EQ(allocations, 0);
  EXPECT_GT(parted, 0);
}

TEST(Step, StagesRunOneByOneMakeTheSameTick) {
  const Session& r = session();
  const Model& m = small::model();
  State s = initial_state(m);
  Work w = make_work(m);
  for (const Input& input : r.inputs) {
    StepReport report;
    StepContext context{m, input, s, w, report};
    for (const Stage& stage : stages()) stage.run(context);
  }
  EXPECT_EQ(hash_of(s), r.hash.back());
}

// Replay: the recording's file between the hands and the step.

class Replay : public testing::Test {
 protected:
  ~Replay() override { std::filesystem::remove(m_path); }
  Recording recorded() {
    const Session& r = session();
    RecordingHeader header;
    header.model_hash = small::model().hash;
    {
      RecordingWriter writer(m_path, header);
      for (size_t t = 0; t < r.inputs.size(); ++t) {
        writer.tick(t, r.inputs[t]);
        if ((t + 1) % kMark == 0) writer.hash(t + 1, r.hash[(t + 1) / kMark - 1]);
      }
      writer.finish("{}");
    }
    return read_recording(m_path);
  }
  /// Whether each mark is met when the recording's inputs are stepped again.
  static std::vector<bool> marks_met(const Recording& recording) {
    State s = initial_state(small::model());
    Work w = make_work(small::model());
    std::vector<bool> met;
    for (const Input& input : recording.inputs) {
      step(small::model(), input, s, w);
      for (const HashMark& mark : recording.hashes)
        if (mark.tick == s.tick) met.push_back(hash_of(s) == mark.hash);
    }
    return met;
  }
  std::filesystem::path m_path =
      std::filesystem::path(testing::TempDir()) / ("trocar_replay_" + std::to_string(::getpid()) + ".trocar");
};

TEST_F(Replay, ReadBackAndSteppedAgainMeetsEveryMark) {
  const Recording recording = recorded();
  ASSERT_TRUE(recording.complete) << recording.damage;
  EXPECT_EQ(recording.header.model_hash, small::model().hash);
  ASSERT_EQ(recording.inputs.size(), session().inputs.size());
  const std::vector<bool> met = marks_met(recording);
  ASSERT_EQ(met.size(), session().hash.size());
  EXPECT_EQ(std::count(met.begin(), met.end(), false), 0);
}

TEST_F(Replay, OneBitOfOneInputShowsFromItsTickOn) {
  Recording recording = recorded();
  const std::uint64_t at = session().grasped[0] + 300;  // while it lifts: the jaws hold the tube
  std::uint32_t bits = 0;
  float& depth = recording.inputs[at].tools[small::kGrasper].depth;
  std::memcpy(&bits, &depth, sizeof bits);
  bits ^= 1u;  // the last bit
  std::memcpy(&depth, &bits, sizeof bits);
  const std::vector<bool> met = marks_met(recording);
  for (size_t i = 0; i < met.size(); ++i) EXPECT_EQ(met[i], kMark * (i + 1) <= at) << "mark " << kMark * (i + 1);
}

// Input that hands cannot make.

TEST(Step, InputThatIsNotFiniteLeavesThoseHandsWhereTheyWere) {
  const Model& m = small::model();
  for (float bad : {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity(),
                    -std::numeric_limits<float>::infinity()})
    for (int field = 0; field < 5; ++field) {
      State s = initial_state(m);
      Work w = make_work(m);
      Input in = m.start;
      in.tools[1].depth += 0.01f;
      step(m, in, s, w);
      const State before = s;
      float* fields[] = {&in.tools[0].yaw, &in.tools[0].pitch, &in.tools[0].roll, &in.tools[0].depth,
                         &in.tools[0].handle};
      *fields[field] = bad;
      const StepReport report = step(m, in, s, w);
      EXPECT_TRUE(report.flags & StepReport::kBadInput);
      EXPECT_TRUE(report.fine());
      EXPECT_EQ(s.tools[0].yaw, before.tools[0].yaw);
      EXPECT_EQ(s.tools[0].pitch, before.tools[0].pitch);
      EXPECT_EQ(s.tools[0].roll, before.tools[0].roll);
      EXPECT_EQ(s.tools[0].depth, before.tools[0].depth);
      EXPECT_EQ(s.tools[0].handle, before.tools[0].handle);
      EXPECT_GT(s.tools[1].depth, before.tools[1].depth) << "the other hand goes on";
    }
}

TEST(Step, AScopeInputThatIsNotFiniteLeavesTheScopeWhereItWas) {
  const Model& m = small::model();
  for (int field = 0; field < 5; ++field) {
    State s = initial_state(m);
    Work w = make_work(m);
    Input in = m.start;
    float* fields[] = {&in.scope.yaw, &in.scope.pitch, &in.scope.roll, &in.scope.depth, &in.scope.post};
    *fields[field] = std::numeric_limits<float>::quiet_NaN();
    const StepReport report = step(m, in, s, w);
    EXPECT_TRUE(report.flags & StepReport::kBadInput);
    EXPECT_EQ(std::memcmp(&s.scope, &m.start.scope, sizeof s.scope), 0);
  }
}

/// Furthest that any node of a tissue is from the origin [m]; infinite where one is not finite.
double extent(const Model& m, const State& s) {
  double far = 0;
  const auto take = [&far](Vec3d p) {
    const double d = length(p);
    far = std::isfinite(d) ? std::max(far, d) : std::numeric_limits<double>::infinity();
  };
  for (size_t i = 0; i < m.solids.size(); ++i)
    for (int n = 0; n < m.solids[i].network.nodes; ++n) take(tissue::position(m.solids[i].network, s.solids[i], n));
  for (const tissue::StrandState& strand : s.strands)
    for (Vec3d x : strand.x) take(x);
  return far;
}

double kinetic_energy(const Model& m, const State& s) {
  double sum = 0;
  for (size_t i = 0; i < m.solids.size(); ++i) sum += tissue::energy(m.solids[i].network, s.solids[i]).kinetic;
  for (size_t i = 0; i < m.strand_bodies.size(); ++i)
    sum += tissue::energy(m.strand_bodies[i].model, s.strands[i]).kinetic;
  return sum;
}

/// Hands that jump anywhere every few milliseconds, handles included, sometimes to absurd numbers.
Input wild(core::Random& random, const Input& last) {
  Input in = last;
  if (random.uniform() > 0.2) return in;
  for (ToolInput& t : in.tools) {
    t.yaw = float(random.uniform(-1.6, 1.6));
    t.pitch = float(random.uniform(-1.6, 1.6));
    t.roll = float(random.uniform(-7, 7));
    t.depth = float(random.uniform(-0.1, 0.4));
    if (random.uniform() < 0.1) t.handle = float(random.uniform(-1, 2));
    if (random.uniform() < 0.01) t.depth = 3e38f;
    if (random.uniform() < 0.01) t.yaw = -3e38f;
  }
  in.scope = {in.tools[0].pitch, in.tools[1].yaw, in.tools[0].roll, in.tools[2].depth, in.tools[1].roll};
  return in;
}

/// Hands that stay at the tissue and tear at it: jumps of centimetres, opening and closing.
Input tearing(core::Random& random, const Input& last, const Input& home) {
  Input in = last;
  if (random.uniform() > 0.05) return in;
  for (size_t i = 0; i < size_t(kMaxTools); ++i) {
    ToolInput& t = in.tools[i];
    t.yaw = home.tools[i].yaw + float(random.uniform(-0.4, 0.4));
    t.pitch = home.tools[i].pitch + float(random.uniform(-0.4, 0.4));
    t.roll = home.tools[i].roll + float(random.uniform(-1, 1));
    t.depth = float(random.uniform(0.08, 0.13));
    if (random.uniform() < 0.3) t.handle = random.uniform() < 0.5 ? 0.0f : 1.0f;
  }
  return in;
}

class Abuse : public testing::TestWithParam<int> {};

TEST_P(Abuse, WildHandsLeaveTheTissueFiniteAndNear) {
  const Model& m = small::model();
  State s = initial_state(m);
  Work w = make_work(m);
  core::Random random{std::uint64_t(GetParam())};
  Input in = m.start;
  double worst = 0, energy = 0;
  int grasps = 0;
  for (int t = 0; t < 6000; ++t) {
    in = t % 2000 < 1000 ? wild(random, in) : tearing(random, in, m.start);
    const StepReport report = step(m, in, s, w);
    ASSERT_TRUE(report.fine()) << "tick " << t << " body " << report.first_bad_body.code();
    for (int e = 0; e < report.event_count; ++e) grasps += report.events[e].kind == Event::grasped;
    if (t % 10 != 0) continue;
    worst = std::max(worst, extent(m, s));
    energy = std::max(energy, kinetic_energy(m, s));
    ASSERT_LT(worst, 0.5) << "tick " << t;
  }
  RecordProperty("grasps", grasps);
  RecordProperty("furthest_mm", int(worst * 1e3));
  RecordProperty("kinetic_uJ", int(energy * 1e6));
  EXPECT_LT(energy, 1.0) << "[J]";
  EXPECT_GT(grasps, 0) << "the hands never got hold of anything";
}
INSTANTIATE_TEST_SUITE_P(Seeds, Abuse, testing::Range(1, 5));

}  // namespace
