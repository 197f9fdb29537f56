// Display keyframes: what drawing needs of a State, out and in again, whatever the bytes.
#include <cmath>
#include <cstring>

#include <gtest/gtest.h>

#include <trocar/core/random.hpp>
#include <trocar/fluids/shown_fluids.hpp>
#include <trocar/sim/model/bodies.hpp>
#include <trocar/sim/recording/keyframe.hpp>
#include <trocar/tissue/heat/heat_look.hpp>

#include "small_energy.hpp"

using namespace trocar;
using namespace trocar::sim;

namespace {

/// As it was written before fluids were in keyframes.
std::vector<std::uint8_t> without_fluids(const Model& m, const State& s) {
  std::vector<std::uint8_t> bytes = display_bytes(m, s), fluids;
  fluids::put_shown(m.wet.model, s.fluids, fluids);
  bytes.resize(bytes.size() - fluids.size());
  return bytes;
}

/// After two clips and the cut, while the jaws hold the tube.
const State& at_work() {
  static const State state = [] {
    const Model& m = small::model();
    State s = initial_state(m);
    Work w = make_work(m);
    small::Hands hands(m);
    while (s.tick < 4200) step(m, hands.next(s), s, w);
    return s;
  }();
  return state;
}

TEST(Display, RoundTripKeepsWhatIsDrawn) {
  const Model& m = small::model();
  const State& from = at_work();
  State to = initial_state(m);
  ASSERT_TRUE(restore_display(m, display_bytes(m, from), to));
  EXPECT_EQ(to.tick, from.tick);
  double worst = 0;
  for (size_t i = 0; i < m.solids.size(); ++i)
    for (int n = 0; n < m.solids[i].network.nodes; ++n)
      worst = std::max(worst, length(tissue::position(m.solids[i].network, to.solids[i], n) -
                                     tissue::position(m.solids[i].network, from.solids[i], n)));
  for (size_t i = 0; i < m.strands.size(); ++i)
    for (size_t n = 0; n < from.strands[i].x.size(); ++n)
      worst = std::max(worst, length(to.strands[i].x[n] - from.strands[i].x[n]));
  EXPECT_LT(worst, 1e-5) << "[m]: places are kept to 0.01 mm";
  EXPECT_EQ(std::memcmp(&to.tools, &from.tools, sizeof from.tools), 0);
  EXPECT_EQ(std::memcmp(&to.scope, &from.scope, sizeof from.scope), 0);
  ASSERT_EQ(to.clip_count, 2);
  ASSERT_EQ(to.cut_count, 1);
  EXPECT_EQ(std::memcmp(&to.cuts[0], &from.cuts[0], sizeof from.cuts[0]), 0);
  EXPECT_EQ(std::memcmp(&to.clips[0], &from.clips[0], sizeof from.clips[0]), 0);
}

TEST(Display, ScarsComeBackInShades) {
  const Model& m = small::energy();
  small::Table t(m);
  small::put_hook_down(t);
  t.input.pedals = kBlue;
  t.steps(1500);
  const std::vector<std::uint8_t> bytes = display_bytes(m, t.state);
  State shown = initial_state(m);
  ASSERT_TRUE(restore_display(m, bytes, shown));
  EXPECT_EQ(shown.electrodes[small::kHook].current.tip, t.state.electrodes[small::kHook].current.tip);
  const Vec3d top{small::kOnOrgan.x, small::kOnOrgan.y, 0.0118};
  int burnt = 0;
  for (double deep = 0; deep < 0.006; deep += 2e-4) {
    const auto look_at = [&](const State& s) {
      return tissue::look(tissue::reading(m.energy.heat, s.heat, BodyId::organ(0), top - Vec3d{0, 0, deep}));
    };
    const tissue::HeatLook was = look_at(t.state), now = look_at(shown);
    EXPECT_NEAR(was.pale, now.pale, 0.12f) << deep;
    EXPECT_NEAR(was.char_, now.char_, 0.3f) << deep;
    burnt += was.pale > 0.5f;
  }
  EXPECT_GT(burnt, 5);
  State other = initial_state(m);
  std::vector<std::uint8_t> spoiled(bytes.begin(), bytes.end() - 1);
  EXPECT_FALSE(restore_display(m, spoiled, other));
}

TEST(Display, CutElementsComeBackCut) {
  const Model& m = small::model();
  State from = at_work();
  tissue::cut_element(from.strands[small::kTube], 5);
  State to = initial_state(m);
  ASSERT_TRUE(restore_display(m, display_bytes(m, from), to));
  EXPECT_EQ(to.strands[small::kTube].alive, from.strands[small::kTube].alive);
}

TEST(Display, TheLensAndTheFluidsComeBack) {
  const Model& m = small::model();
  ASSERT_TRUE(m.wet.there);
  State from = at_work();
  from.fluids.smoke.fog = 0.37;
  from.fluids.smoke.wipe_left = 3.25;
  from.fluids.droplets.film[5] = {120'000, 30'000, 0};
  State to = initial_state(m);
  ASSERT_TRUE(restore_display(m, display_bytes(m, from), to));
  EXPECT_EQ(to.fluids.smoke.fog, 0.37);
  EXPECT_EQ(to.fluids.smoke.wipe_left, 3.25);
  EXPECT_EQ(to.fluids.droplets.film[5].blood, 120'000);
  EXPECT_EQ(to.fluids.droplets.film[5].saline, 30'000);
  for (const double fog : {-0.1, 1.1, std::nan("")}) {
    from.fluids.smoke.fog = fog;
    EXPECT_FALSE(restore_display(m, display_bytes(m, from), to)) << fog;
  }
}

TEST(Display, KeyframesWithoutFluidsAreDryAndHaveAClearLens) {
  const Model& m = small::model();
  State to = initial_state(m);
  to.fluids.smoke.fog = 0.4;
  to.fluids.droplets.film[5] = {120'000, 0, 0};
  ASSERT_TRUE(restore_display(m, without_fluids(m, at_work()), to));
  EXPECT_EQ(to.fluids.smoke.fog, 0);
  EXPECT_EQ(film_content(to.fluids.droplets).total(), 0);
}

TEST(Display, BytesOfTheWrongLengthAreRefusedAndChangeNothing) {
  const Model& m = small::model();
  std::vector<std::uint8_t> bytes = display_bytes(m, at_work());
  State s = initial_state(m);
  const std::uint64_t before = hash_of(s);
  for (size_t n = 0; n < bytes.size(); n += 1 + n / 50) {
    if (n == without_fluids(m, at_work()).size()) continue;  // see KeyframesWithoutFluidsAreDryAndHaveAClearLens
    const std::vector<std::uint8_t> torn(bytes.begin(), bytes.begin() + std::ptrdiff_t(n));
    EXPECT_FALSE(restore_display(m, torn, s)) << n << " of " << bytes.size();
  }
  bytes.push_back(0);
  EXPECT_FALSE(restore_display(m, bytes, s));
  EXPECT_EQ(hash_of(s), before);
}

/// Everything a reader indexes by or loops to is in range, everything drawn is finite.
void expect_drawable(const Model& m, const State& s) {
  for (size_t i = 0; i < m.solids.size(); ++i)
    for (int n = 0; n < m.solids[i].network.nodes; ++n)
      ASSERT_TRUE(std::isfinite(length(tissue::position(m.solids[i].network, s.solids[i], n))));
  for (const tissue::StrandState& strand : s.strands)
    for (Vec3d x : strand.x) ASSERT_TRUE(std::isfinite(length(x)));
  for (const interactions::ToolState& t : s.tools) {
    ASSERT_TRUE(t.holds >= 0 && t.holds <= interactions::kMaxHolds);
    for (double v : {t.yaw, t.pitch, t.roll, t.depth, t.aperture}) ASSERT_TRUE(std::isfinite(v));
    for (int h = 0; h < t.holds; ++h) {
      ASSERT_TRUE(has(m, t.hold[h].at.body));
      ASSERT_TRUE(is_valid(m, t.hold[h].at));
    }
  }
  ASSERT_TRUE(s.clip_count >= 0 && s.clip_count <= interactions::kMaxClips);
  ASSERT_TRUE(s.cut_count >= 0 && s.cut_count <= interactions::kMaxCuts);
  for (int i = 0; i < s.clip_count; ++i) {
    ASSERT_TRUE(s.clips[size_t(i)].strand >= -1 && s.clips[size_t(i)].strand < int(m.strands.size()));
    ASSERT_TRUE(std::isfinite(s.clips[size_t(i)].s));
  }
  for (int i = 0; i < s.cut_count; ++i) {
    ASSERT_TRUE(s.cuts[size_t(i)].strand >= -1 && s.cuts[size_t(i)].strand < int(m.strands.size()));
    ASSERT_TRUE(s.cuts[size_t(i)].solid == -1 || has(m, BodyId::organ(size_t(s.cuts[size_t(i)].solid))));
  }
}

TEST(Display, HostileBytesAreRefusedOrDrawable) {
  const Model& m = small::model();
  const std::vector<std::uint8_t> good = display_bytes(m, at_work());
  core::Random random(7);
  int refused = 0;
  for (int trial = 0; trial < 3000; ++trial) {
    std::vector<std::uint8_t> bytes = good;
    const int strikes = 1 + int(random.uniform(0, 4));
    for (int k = 0; k < strikes; ++k) {
      // Every second strike in the last part, where the counts and indices are.
      const size_t from = random.uniform() < 0.5 ? 0 : bytes.size() - sizeof(State::tools) - 400;
      const size_t at = from + size_t(random.uniform() * double(bytes.size() - from - 4));
      const std::uint32_t value = random.uniform() < 0.3 ? 0x7fc00000u : std::uint32_t(random.next());
      std::memcpy(bytes.data() + at, &value, sizeof value);
    }
    State s = initial_state(m);
    if (restore_display(m, bytes, s))
      ASSERT_NO_FATAL_FAILURE(expect_drawable(m, s)) << "trial " << trial;
    else
      ++refused;
  }
  EXPECT_GT(refused, 0);
  EXPECT_LT(refused, 3000);
}

TEST(Display, NoiseOfTheRightLengthIsRefused) {
  const Model& m = small::model();
  core::Random random(8);
  std::vector<std::uint8_t> bytes = display_bytes(m, initial_state(m));
  State s = initial_state(m);
  for (int trial = 0; trial < 100; ++trial) {
    for (std::uint8_t& b : bytes) b = std::uint8_t(random.next());
    EXPECT_FALSE(restore_display(m, bytes, s));
  }
}

}  // namespace
