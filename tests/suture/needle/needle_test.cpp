// A needle by itself: its shape, and what it does on planes, in jaws and in tissue that does not move.
#include <cmath>

#include <gtest/gtest.h>

#include <trocar/suture/needle/needle_step.hpp>

namespace trocar::suture {
namespace {

constexpr double kTick = 0.001;
constexpr double kJaws = 30000;  // [N/m] a place
const Vec3d kDown{0, 0, -9.81};

NeedleModel half_circle() { return make_needle(*needle_kind("half_26")); }

/// Beads that are near the plane z = 0, which is tilted by what gravity is.
void lie(const NeedleModel& m, const NeedleState& s, double friction, NeedleWork& w) {
  for (int b = 0; b < m.beads; ++b) {
    NeedleContact c;
    c.bead = b;
    c.normal = {0, 0, 1};
    c.gap = needle_point(m, s, m.bead(b)).z - 0.5 * m.wire;
    c.stiffness = 300;
    c.friction = friction;
    if (c.gap < 0.001) add(w.contacts, c, w);
  }
}

NeedleState lying_on_plane(const NeedleModel& m, Vec3d gravity, double friction, double seconds) {
  NeedleState s;
  s.x = {0, 0, 0.002};
  s.q = quat_from_axis_angle(Vec3d{1, 0, 0}, 0.3);
  NeedleWork w = make_needle_work();
  for (int i = 0; i < int(seconds / kTick); ++i) {
    clear(w);
    lie(m, s, friction, w);
    EXPECT_TRUE(advance(m, gravity, kTick, s, w));
  }
  return s;
}

TEST(Needle, OfAHalfCircleOf26MmHasARadiusOf8_28AndAChordOf16_6Mm) {
  const NeedleModel m = half_circle();
  EXPECT_NEAR(m.radius, 0.00828, 1e-5);
  EXPECT_NEAR(length(m.place(0) - m.place(m.length)), 0.01655, 1e-5);
  EXPECT_NEAR(m.mass, 68e-6, 1e-6);
}

TEST(Needle, ArcLengthOfThePointNearestToOneOfItsOwnIsItsOwn) {
  for (const NeedleKind& kind : needle_kinds()) {
    const NeedleModel m = make_needle(kind);
    for (double s = 0; s <= m.length; s += m.length / 7) {
      EXPECT_NEAR(m.nearest(m.place(s)), s, 1e-9) << kind.name;
      EXPECT_NEAR(dot(m.along(s), normalised(m.place(s - 1e-6) - m.place(s + 1e-6))), 1, 1e-6) << kind.name;
    }
  }
}

TEST(Needle, FallsAsAStoneDoes) {
  const NeedleModel m = half_circle();
  NeedleState s;
  NeedleWork w = make_needle_work();
  for (int i = 0; i < 100; ++i) clear(w), advance(m, kDown, kTick, s, w);
  EXPECT_NEAR(s.x.z, -0.5 * 9.81 * 0.01, 0.005 * 0.049 + 0.0005);
  EXPECT_NEAR(length(s.w), 0, 1e-12);
}

TEST(Needle, LiesFlatOnAPlaneAndComesToRest) {
  const NeedleModel m = half_circle();
  const NeedleState s = lying_on_plane(m, kDown, 0.3, 2);
  EXPECT_LT(length(s.v), 1e-6);
  EXPECT_GT(std::fabs(rotate(s.q, Vec3d{0, 0, 1}).z), 0.9999);
  EXPECT_NEAR(s.x.z, 0.5 * m.wire, 1e-5);
}

TEST(Needle, StaysOnASlopeBelowTheAngleOfFrictionAndSlidesOffASteeperOne) {
  const NeedleModel m = half_circle();
  const auto slope = [](double tangent) {
    const double c = 1 / std::sqrt(1 + tangent * tangent);
    return Vec3d{9.81 * tangent * c, 0, -9.81 * c};
  };
  const NeedleState gentle = lying_on_plane(m, slope(0.25), 0.3, 2), steep = lying_on_plane(m, slope(0.35), 0.3, 2);
  EXPECT_LT(length(gentle.v), 1e-6);
  // g (sin - mu cos) for most of two seconds
  EXPECT_NEAR(steep.v.x, 2 * 9.81 * 0.05 / std::sqrt(1 + 0.35 * 0.35), 0.1);
}

/// In tissue along its arc from the tip on, held by jaws a third from the swage; the jaws turn about the bend's middle.
struct Bite {
  NeedleModel m = half_circle();
  NeedleState s;
  NeedleWork w = make_needle_work();
  std::vector<NeedlePin> pins;

  explicit Bite(int count, double across = 200, double drag = 0.05) {
    for (int i = 0; i < count; ++i) {
      NeedlePin p;
      p.point = needle_point(m, s, 0.001 * (i + 0.5));
      p.across = across;
      p.drag = drag;
      pins.push_back(p);
    }
  }
  void step(double turned, Vec3d shifted = {}) {
    clear(w);
    const Quatd turn = quat_from_axis_angle(Vec3d{0, 0, 1}, turned);
    for (int i = -2; i <= 2; ++i) {
      const Vec3d own = m.place(0.018 + 0.0005 * i);
      for (const double side : {-1.0, 1.0}) {
        NeedleHold hold;
        hold.own = own + Vec3d{0, 0, side * 0.5 * m.wire};
        hold.target = m.centre + rotate(turn, hold.own - m.centre) + shifted;
        hold.stiffness = kJaws;
        hold.damping = 0.5;
        add(w.holds, hold, w);
      }
    }
    for (const NeedlePin& p : pins) add(w.pins, p, w);
    ASSERT_TRUE(advance(m, {0, 0, 0}, kTick, s, w));
    for (std::size_t i = 0; i < pins.size(); ++i) pins[i].stuck = w.pins[i].stuck;
  }
  Vec3d on_needle() const {
    Vec3d sum;
    for (const NeedlePin& p : w.pins) sum += p.force;
    return sum;
  }
};

TEST(Needle, DrivenAlongItsArcWithoutDragDoesNotDriftBesideItsPath) {
  Bite bite(8, 200, 0);
  for (int i = 0; i < 800; ++i) bite.step(0.001 * i);  // 0.8 rad: 6.6 mm of the arc
  for (const NeedlePin& p : bite.w.pins)
    EXPECT_LT(length(needle_point(bite.m, bite.s, bite.m.nearest(own_of(bite.s, p.point))) - p.point), 1e-6);
}

TEST(Needle, DrivenAlongItsArcFeelsTheDragOfEachMillimetreInTissue) {
  Bite bite(8);
  for (int i = 0; i < 800; ++i) bite.step(0.001 * i);
  double along = 0;
  for (const NeedlePin& p : bite.w.pins) {
    EXPECT_LT(length(needle_point(bite.m, bite.s, p.arc) - p.point), 5e-5);
    along += dot(p.force, needle_direction(bite.m, bite.s, p.arc));
  }
  EXPECT_NEAR(along, -8 * 0.05, 0.002);
  EXPECT_NEAR(bite.w.pins[0].arc, 0.0005 + 0.8 * bite.m.radius, 2e-4);
}

TEST(Needle, PushedAcrossItsArcIsHeldWithTheAreaItSweepsBesideItsPath) {  // [Jackson & Çavuşoğlu 2012]
  const double across = 20;                                               // [N/m] a pin, 1 mm of wire each
  Bite bite(20, across, 0);
  for (int i = 0; i < 500; ++i) bite.step(0, {0, 0, 0.0005});
  double area = 0, force = 0;
  for (const NeedlePin& p : bite.w.pins) {
    area += 0.001 * (needle_point(bite.m, bite.s, p.arc) - p.point).z;
    force += p.force.z;
  }
  EXPECT_GT(area, 1e-6);
  EXPECT_NEAR(force, -across / 0.001 * area, 1e-3);
}

TEST(Needle, AtRestInJawsAndTissueIsHeldByForcesThatAddUpToNothing) {
  Bite bite(6);
  for (int i = 0; i < 600; ++i) bite.step(0.1, {0.0003, 0, 0.0002});
  Vec3d held;
  for (const NeedleHold& h : bite.w.holds) held += h.force;
  EXPECT_GT(length(held), 0.05);
  EXPECT_LT(length(held + bite.on_needle()), 1e-6);
}

TEST(Needle, TipPressesWithWhatHoldsItBackUntilThatGivesWay) {
  const NeedleModel m = half_circle();
  NeedleState s;
  NeedleWork w = make_needle_work();
  double most = 0;
  const Vec3d into = rotate(s.q, m.along(0));
  const double start = dot(needle_point(m, s, 0), into);
  for (int i = 0; i < 1000; ++i) {
    clear(w);
    for (int k = -2; k <= 2; ++k)
      for (const double side : {-1.0, 1.0}) {
        NeedleHold hold;
        hold.own = m.place(0.008 + 0.0005 * k) + Vec3d{0, 0, side * 0.0003};
        hold.target = hold.own + 2e-6 * i * into;
        hold.stiffness = kJaws, hold.damping = 0.5;
        add(w.holds, hold, w);
      }
    w.tip.there = true;
    w.tip.dir = -into;
    w.tip.gap = dot(needle_point(m, s, 0), into) - start;
    w.tip.stiffness = 1000;
    advance(m, {0, 0, 0}, kTick, s, w);
    most = std::max(most, -dot(w.tip.force, into));
  }
  EXPECT_GT(most, 1.0);
  EXPECT_LT(most, 2.0);
}

/// Jaws that hold two places of the wire with 3 N together, drawn against a tip that yields nowhere.
TEST(Needle, InJawsItIsHeldWithNoMoreThanTheyBearHoweverFarTheyGo) {  // [needle in jaws]
  const NeedleModel m = half_circle();
  constexpr double kBears = 3;
  for (const double speed : {0.01, 0.5}) {
    NeedleState s;
    NeedleWork w = make_needle_work();
    const Vec3d into = rotate(s.q, m.along(0)), start = needle_point(m, s, 0);
    double most = 0;
    bool slipped = false;
    for (int i = 0; i < 100; ++i) {
      clear(w);
      for (const double side : {-1.0, 1.0}) {
        NeedleHold hold;
        hold.own = m.place(0.0) + Vec3d{0, 0, side * 0.0003};
        hold.target = hold.own + (speed * kTick * i) * into;
        hold.stiffness = kJaws, hold.damping = 0.5;
        hold.bears = kBears;
        add(w.holds, hold, w);
      }
      w.tip.there = true;
      w.tip.dir = -into;
      w.tip.gap = dot(needle_point(m, s, 0) - start, into);
      w.tip.stiffness = 1e6;
      ASSERT_TRUE(advance(m, {0, 0, 0}, kTick, s, w));
      Vec3d pull;
      for (const NeedleHold& h : w.holds) pull += h.force, slipped = slipped || h.slips;
      most = std::max(most, length(pull));
    }
    EXPECT_TRUE(slipped) << speed;
    EXPECT_NEAR(most, kBears, 0.01 * kBears) << speed;
  }
}

TEST(Needle, PulledByAStiffThreadAtItsSwageStaysCalm) {
  const NeedleModel m = half_circle();
  NeedleState s;
  NeedleWork w = make_needle_work();
  const Vec3d fixed = needle_point(m, s, m.length) + Vec3d{0.015, 0, 0.012};
  Vec3d force;
  for (int i = 0; i < 3000; ++i) {
    clear(w);
    w.tail = {force, 2000};
    advance(m, kDown, kTick, s, w);
    const Vec3d off = fixed - needle_point(m, s, m.length);
    force = 2000.0 * std::max(0.0, length(off) - 0.02) * normalised(off);
  }
  // it hangs from its swage and swings, and no faster than its fall makes it
  EXPECT_LT(length(s.v), 0.9);
  EXPECT_LT(length(fixed - needle_point(m, s, m.length)), 0.0201);
}

}  // namespace
}  // namespace trocar::suture
