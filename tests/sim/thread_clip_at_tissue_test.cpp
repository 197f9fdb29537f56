// A clip on thread at a hole of real tissue: the box trainer's pad, the needle through both lips of its slit. The
// needle is led by the test, and so is the tail until the applier has closed on it, as a hand would hold it.
#include <gtest/gtest.h>

#include <trocar/interactions/objects/suture_clip.hpp>
#include <trocar/training/facts/registry.hpp>

#include "needle_driver.hpp"
#include "shipped.hpp"

namespace trocar {
namespace {

constexpr double kAbove = 0.004;   // [m] of thread from the hole to where the applier closes
constexpr double kBeside = 0.006;  // [m] of thread from there to where it is held
constexpr double kSpeed = 1;       // [m/s]
const Vec3d kEntry{0, 0.077, -0.070}, kExit{0, 0.063, -0.070};

const sim::Model& pad_with_applier() {
  static const sim::Model model = [] {
    scene::Description d = scene::read_scene(TROCAR_SOURCE_DIR "/scenes/box_suture/scene.json");
    d.placements[0].instrument = "clip_applier";
    return scene::compile(d);
  }();
  return model;
}

class Stitched : public NeedleDriver {
 public:
  Stitched() : NeedleDriver(pad_with_applier(), pad_with_applier().hand_index("right")) {}

  const sim::Model& m = pad_with_applier();
  int left = m.hand_index("left");
  Vec3d tail_goes;  ///< away from the pad
  bool tail_is_held = false;

  interactions::SutureState& own() { return state.objects.sutures.front(); }
  /// The entry's place on the thread [m].
  double entry() const {
    double most = 0;
    for (int i = 0; i < suture().hole_count; ++i)
      if (suture().holes[size_t(i)].slot >= 0) most = std::max(most, double(suture().holes[size_t(i)].arc));
    return most;
  }
  double most_at_a_hole() const {
    double most = 0;
    for (int i = 0; i < suture().hole_count; ++i) {
      const auto& f = suture().holes[size_t(i)].force;
      most = std::max(most, length(Vec3d{double(f[0]), double(f[1]), double(f[2])}));
    }
    return most;
  }
  const suture::ThreadClip* clip() const {
    return state.clip_count > 0 ? interactions::thread_clip(state.objects.sutures, state.clips[0], 0) : nullptr;
  }
  double fact(const char* name) const {
    const training::Fact* f = training::find_fact(name);
    EXPECT_TRUE(f) << name;
    const training::Value v = f->watch(m, {})->value({m, state});
    EXPECT_TRUE(v.known) << name;
    return v.number;
  }

  /// A tick in which the needle is where the test has it.
  void led(Vec3d x, Quatd q) {
    suture::NeedleState& n = own().needle;
    n.x = x, n.q = q, n.v = {}, n.w = {};
    hold_tail();
    step();
  }
  void stay() { led(suture().needle.x, suture().needle.q); }
  /// On along its arc until it is out, and so much thread after it.
  void draw_out(double thread) {
    Vec3d x;
    Quatd q;
    input.tools[m.hand_index("right")].handle = 0;
    for (int i = 0; i <= 600; ++i) {
      pose(kEntry, kExit, 2.5 + i / 600.0 * 2.8, x, q);
      led(x, q);
    }
    draw(thread);
  }
  /// The needle goes on away from the exit, at 20 mm/s.
  void draw(double way) {
    const Vec3d from = suture().needle.x;
    const Quatd q = suture().needle.q;
    const Vec3d out = normalised(Vec3d{0, -0.3, 1});
    const int ticks = int(way / (0.02 * sim::kTick));
    for (int i = 1; i <= ticks; ++i) led(from + (double(i) / ticks) * way * out, q);
  }
  void pause(double seconds) {
    for (int i = 0; i < int(seconds / sim::kTick); ++i) stay();
  }

  /// The applier's jaws go round the tail, which stands straight away from the pad and across them, and close.
  void clip_tail() {
    const Vec3d port = m.hands[size_t(left)].port, hole = hole_at();
    const Vec3d axis = normalised(hole - port);
    tail_goes = normalised(Vec3d{0, 0.5, 1} - dot(Vec3d{0, 0.5, 1}, axis) * axis);
    straighten_tail();
    const Vec3d tip = hole + kAbove * tail_goes + 0.003 * axis;
    const kinematics::FulcrumPose at = kinematics::inverse(port, tip, 0);
    const double roll = kinematics::roll_towards(at, tail_goes);
    const auto put = [&](double back, double handle) {
      input.tools[left] = sim::tool_input(kinematics::inverse(port, tip - back * axis, roll), float(handle));
    };
    for (int i = 0; i <= 400; ++i) put(0.03 * (1 - i / 400.0), 0), stay();
    for (int i = 0; i <= 200; ++i) put(0, i / 200.0), stay();
    tail_is_held = false;
    for (int i = 0; i <= 200; ++i) put(0, 1 - i / 200.0), stay();
    for (int i = 0; i <= 600; ++i) put(0.05 * i / 600.0, 0), stay();
  }

 private:
  std::vector<Vec3d> m_tail;
  int m_first = 0;

  /// Where the entry's hole is now.
  Vec3d hole_at() const { return suture::point_at(model().thread, suture().thread, entry()); }
  void straighten_tail() {
    const Vec3d from = hole_at();
    const double spacing = model().thread.spacing;
    suture::ThreadState& t = own().thread;
    for (int n = suture::place_at(model().thread, entry()).element + 2; n < model().thread.nodes; ++n)
      t.x[size_t(n)] = from + (n * spacing - entry()) * tail_goes, t.v[size_t(n)] = {};
    m_first = suture::place_at(model().thread, entry() + kAbove + kBeside).element;
    m_tail.assign(t.x.begin() + m_first, t.x.end());
    tail_is_held = true;
  }
  void hold_tail() {
    if (!tail_is_held) return;
    suture::ThreadState& t = own().thread;
    for (size_t i = 0; i < m_tail.size(); ++i) {
      const Vec3d to = (m_tail[i] - t.x[size_t(m_first) + i]) / sim::kTick;
      t.v[size_t(m_first) + i] = std::min(1.0, kSpeed / std::max(kSpeed, length(to))) * to;
    }
  }
};

/// 20 mm of thread drawn through both lips, once for all tests.
const Stitched& stitched() {
  static const Stitched done = [] {
    Stitched s;
    s.rest(0.2);
    s.drive(kEntry, kExit, 2.5, 3.2);
    s.draw_out(0.02);
    return s;
  }();
  return done;
}
const Stitched& clipped() {
  static const Stitched done = [] {
    Stitched s = stitched();
    s.clip_tail();
    return s;
  }();
  return done;
}

/// The needle drawn on by 10 mm: far enough for the clip to come to the pad.
const Stitched& drawn() {
  static const Stitched done = [] {
    Stitched s = clipped();
    s.draw(0.010);
    return s;
  }();
  return done;
}

TEST(ThreadClipAtTissue, AnApplierClosesOnTheTailBesideThePad) {
  const Stitched& s = clipped();
  ASSERT_TRUE(s.clip());
  EXPECT_EQ(s.clip()->count, 1);
  EXPECT_FALSE(s.state.clips[0].dropped());
  EXPECT_EQ(s.suture().broken, 0);
  EXPECT_NEAR(s.clip()->s[0] - s.entry(), kAbove, 0.0012);
  EXPECT_NEAR(s.fact("suture.clip_to_tissue_mm"), s.clip()->s[0] - s.entry(), 1e-7);
}

TEST(ThreadClipAtTissue, ThereTheThreadGoesNoFurtherIntoThePad) {
  const Stitched& s = drawn();
  ASSERT_TRUE(s.clip());
  EXPECT_EQ(s.clip()->s[0], clipped().clip()->s[0]) << "it has not slipped along the thread";
  EXPECT_NEAR(s.fact("suture.clip_to_tissue_mm"), suture::kClipHalfWidth, 1e-5);
  EXPECT_GT(s.most_at_a_hole(), 0.5) << "the pad bears what is drawn with";
  EXPECT_GT(s.suture().strain, s.most_at_a_hole()) << "less what the thread rubs";
}

TEST(ThreadClipAtTissue, WithoutItTheThreadGoesOn) {
  Stitched s = stitched();
  const double before = s.entry();
  s.draw(0.010);
  EXPECT_GT(s.entry() - before, 0.009);
  EXPECT_LT(s.most_at_a_hole(), 0.15);
}

TEST(ThreadClipAtTissue, ItHoldsAndHarmsNothingAtRest) {
  Stitched s = drawn();
  const double arc = s.entry();
  s.pause(0.3);
  EXPECT_NEAR(s.entry(), arc, 1e-5);
  EXPECT_EQ(s.fact("suture.harmed"), 0);
  EXPECT_EQ(s.suture().torn, 0);
  EXPECT_LT(length(s.clip()->at - suture::point_at(s.model().thread, s.suture().thread, arc)), 0.001);
}

}  // namespace
}  // namespace trocar
