// A clip applier closes on thread: the box trainer's suture, led between the legs of an applier in the left hand. And
// what becomes of thread between its shaft and another instrument.
#include <map>

#include <gtest/gtest.h>

#include <trocar/interactions/objects/suture_clip.hpp>
#include <trocar/sim/bodies/views.hpp>
#include <trocar/sim/recording/keyframe.hpp>
#include <trocar/sim/stages/step.hpp>

#include "../count_allocations.hpp"
#include "shipped.hpp"

namespace trocar {
namespace {

/// The pad with an applier in the left hand, whose jaws lie level and open up and down.
const sim::Model& with_applier() {
  static const sim::Model model = [] {
    scene::Description d = scene::read_scene(TROCAR_SOURCE_DIR "/scenes/box_suture/scene.json");
    d.placements[0].instrument = "clip_applier";
    d.placements[0].tip = {-0.005, 0.070, -0.045};
    return scene::compile(d);
  }();
  return model;
}

class Applier {
 public:
  Applier() : m(with_applier()), hand(m.hand_index("left")), state(sim::initial_state(m)), work(sim::make_work(m)) {
    input = m.start;
    const kinematics::FulcrumPose pose = sim::pose_of(input.tools[hand]);
    tip = kinematics::forward(port(), pose).tip;
    roll = kinematics::roll_towards(pose, {0, 1, 0});
    lead(0);
    rest(0.3);
  }
  Applier(const Applier& o)
      : m(o.m),
        hand(o.hand),
        state(o.state),
        work(sim::make_work(m)),
        input(o.input),
        tip(o.tip),
        roll(o.roll),
        flags(o.flags),
        events(o.events),
        m_held(o.m_held),
        m_loose(o.m_loose) {}

  const sim::Model& m;
  int hand;
  sim::State state;
  sim::Work work;
  sim::Input input;
  Vec3d tip;
  double roll = 0;
  std::uint32_t flags = 0;
  std::array<int, 64> events{};

  Vec3d port() const { return m.hands[size_t(hand)].port; }
  const interactions::ToolModel& tool() const { return m.tool(state, size_t(hand)); }
  interactions::ToolShape shape() const { return sim::shape_of(m, state, size_t(hand)); }
  const suture::ThreadModel& model() const { return m.objects.sutures.list[0].thread; }
  interactions::SutureState& suture() { return state.objects.sutures[0]; }
  suture::ThreadState& thread() { return suture().thread; }
  const suture::ThreadClip* clip(int number = 0) {
    return number < state.clip_count
               ? interactions::thread_clip(state.objects.sutures, state.clips[size_t(number)], number)
               : nullptr;
  }

  void lead(double handle) {
    input.tools[hand] = sim::tool_input(kinematics::inverse(port(), tip, roll), float(handle));
  }
  void step() {
    hold_thread();
    const sim::StepReport r = sim::step(m, input, state, work);
    flags |= r.flags;
    for (int i = 0; i < r.event_count; ++i) ++events[size_t(r.events[i].kind)];
  }
  void rest(double seconds) {
    for (int i = 0; i < int(seconds / sim::kTick); ++i) step();
  }
  void close() {
    for (int i = 0; i <= 200; ++i) lead(i / 200.0), step();
    rest(0.02);
    m_held.clear();
  }
  void open() {
    for (int i = 200; i >= 0; --i) lead(i / 200.0), step();
  }

  /// The thread is laid so that so many stretches of it cross between the legs, 3 mm apart, the first nearest to the
  /// tips. Until the legs have closed it is held where it lies, but for what is nearer to the tips than `loose`.
  void lay(int stretches, double above = 0, double loose = 0) {
    const interactions::ToolShape at = shape();
    const interactions::SutureModel& whole = m.objects.sutures.list[0];
    const Vec3d across = at.frame.normal(), out = at.frame.axis(), up = at.frame.opening();
    std::vector<Vec3d> path{suture::needle_point(whole.needle, suture().needle, whole.needle.length)};
    double side = dot(path[0] - at.frame.tip, across) > 0 ? 1 : -1;
    path.push_back(at.frame.tip + 0.02 * out + 0.02 * side * across);
    for (int i = 0; i < stretches; ++i, side = -side) {
      const Vec3d middle = at.frame.tip - (0.002 + 0.003 * i) * out + above * up;
      path.push_back(middle + 0.012 * side * across);
      path.push_back(middle - 0.012 * side * across);
    }
    path.push_back(path.back() + 0.05 * normalised(path.back() - path[path.size() - 2]));
    for (int i = 0; i < 4; ++i) path = rounded(path);
    thread() = suture::laid(model(), path);
    suture::take_hold(model(), thread(), interactions::kSwageSlot, 0);
    hold_as_it_lies();
    m_loose = loose;
    rest(0.02);
  }

  void hold_as_it_lies() { m_held = thread().x, m_loose = 0; }

 private:
  std::vector<Vec3d> m_held;
  double m_loose = 0;

  static std::vector<Vec3d> rounded(const std::vector<Vec3d>& path) {  // Chaikin
    std::vector<Vec3d> out{path.front()};
    for (size_t i = 0; i + 1 < path.size(); ++i) {
      out.push_back(0.75 * path[i] + 0.25 * path[i + 1]);
      out.push_back(0.25 * path[i] + 0.75 * path[i + 1]);
    }
    out.push_back(path.back());
    return out;
  }
  void hold_thread() {
    for (size_t n = 0; n < m_held.size(); ++n)
      if (length(m_held[n] - shape().frame.tip) >= m_loose) thread().x[n] = m_held[n], thread().v[n] = {};
  }
};

/// Closed on so many stretches; once for all tests that go on from there.
const Applier& closed(int stretches) {
  static std::map<int, Applier> done;
  const auto known = done.find(stretches);
  if (known != done.end()) return known->second;
  Applier a;
  a.lay(stretches);
  a.close();
  return done.emplace(stretches, a).first->second;
}

TEST(ThreadClip, AnApplierThatClosesOnAThreadLeavesItsClipThere) {
  Applier a = closed(1);
  ASSERT_EQ(a.state.clip_count, 1);
  const interactions::Clip& set = a.state.clips[0];
  EXPECT_FALSE(set.dropped());
  EXPECT_TRUE(set.on_thread());
  EXPECT_EQ(set.body(), BodyId(BodyKind::suture, 0));
  EXPECT_EQ(a.events[size_t(sim::Event::clipped)], 1);
  EXPECT_EQ(a.events[size_t(sim::Event::dropped_clip)], 0);
  ASSERT_TRUE(a.clip());
  EXPECT_EQ(a.clip()->count, 1);
  EXPECT_LT(length(a.clip()->at - a.shape().frame.tip), 0.006);
  EXPECT_LT(set.theta, 0.5);
}

TEST(ThreadClip, TwoStretchesBetweenItsLegsAreTiedAndStayTiedWhenItLetsGo) {
  Applier a = closed(2);
  ASSERT_TRUE(a.clip());
  ASSERT_EQ(a.clip()->count, 2);
  a.open();
  a.tip += 0.02 * normalised(a.port() - a.tip);
  for (int i = 0; i < 500; ++i) a.lead(0), a.step();
  ASSERT_TRUE(a.clip());
  const suture::ThreadClip& c = *a.clip();
  const Vec3d apart = point_at(a.model(), a.thread(), c.s[1]) - point_at(a.model(), a.thread(), c.s[0]);
  EXPECT_NEAR(length(apart), c.apart[0], 2e-4);
  EXPECT_GT(std::fabs(dot(normalised(apart), c.axis_now)), 0.8) << "it lies over both";
}

TEST(ThreadClip, ItGoesWithTheThreadThatTheNeedleDraws) {
  Applier a = closed(1);
  a.open();
  a.tip += 0.04 * normalised(a.port() - a.tip);
  a.lead(0);
  a.rest(0.5);
  ASSERT_TRUE(a.clip());
  const Vec3d before = a.clip()->at;
  const int right = a.m.hand_index("right");
  const kinematics::FulcrumPose pose = sim::pose_of(a.input.tools[right]);
  const Vec3d port = a.m.hands[size_t(right)].port, tip = kinematics::forward(port, pose).tip;
  for (int i = 1; i <= 1500; ++i) {
    const Vec3d to = tip + i / 1500.0 * Vec3d{0.01, 0.01, 0.03};
    a.input.tools[right] = sim::tool_input(kinematics::inverse(port, to, pose.roll), 1.0f);
    a.step();
  }
  ASSERT_TRUE(a.clip());
  EXPECT_GT(length(a.clip()->at - before), 0.01);
  EXPECT_LT(length(a.clip()->at - point_at(a.model(), a.thread(), a.clip()->s[0])), 1e-4);
  EXPECT_EQ(a.suture().broken, 0);
}

TEST(ThreadClip, WithNothingBetweenItsJawsAClipIsDroppedAsBefore) {
  Applier a;
  a.close();
  ASSERT_EQ(a.state.clip_count, 1);
  EXPECT_TRUE(a.state.clips[0].dropped());
  EXPECT_EQ(a.state.clips[0].vessel, 0);
  EXPECT_EQ(a.thread().clip_count, 0);
  EXPECT_EQ(a.events[size_t(sim::Event::dropped_clip)], 1);
}

TEST(ThreadClip, ClosedLegsWithoutThreadBetweenThemPushItAsideAndAreNotEntered) {
  Applier a;
  a.close();
  ASSERT_EQ(a.events[size_t(sim::Event::dropped_clip)], 1);
  a.lay(1, 0.004, 0.009);
  const Vec3d up = a.shape().frame.opening();
  double nearest = 1;
  for (int i = 0; i < 200; ++i) {
    a.tip += 2e-5 * up, a.lead(1), a.step();
    const interactions::ToolShape legs = a.shape();
    for (const Vec3d& x : a.thread().x)
      for (const int part : {interactions::kJawA, interactions::kJawB})
        nearest = std::min(nearest, length(x - collision::nearest_on_axis(legs.rod(part), x)) - legs.rod(part).radius);
  }
  EXPECT_LT(nearest, a.model().stuff.diameter) << "they never met";
  EXPECT_GT(nearest, 0.25 * a.model().stuff.diameter);
}

TEST(ThreadClip, LegsOfAnEmptyApplierSqueezeNoThreadThatLiesBetweenThem) {
  Applier a;
  a.state.tools[a.hand].clips_left = a.state.tools[a.hand].armed = 0;
  a.lay(6);
  a.close();
  a.rest(0.1);
  EXPECT_EQ(a.state.clip_count, 0);
  double most = 0;
  for (int k = 0; k < a.thread().touch_count; ++k) most = std::max(most, a.thread().touch[size_t(k)].press);
  EXPECT_LT(most, 2) << "[N] on an element";
}

TEST(ThreadClip, LegsAreSteelToWhatDoesNotLieBetweenThem) {
  Applier a = closed(2);
  a.step();
  const auto& gathered = a.work.objects.sutures.list[0].gathered;
  const double between = a.model().spacing * double(std::count(gathered.begin(), gathered.end(), 1));
  const double wide = 2 * a.shape().rod(interactions::kJawA).radius;  // of the legs
  EXPECT_GT(between, 2 * wide);
  EXPECT_LT(between, 3 * wide);
}

TEST(ThreadClip, ASecondOneFitsBesideTheFirst) {
  Applier a = closed(1);
  a.hold_as_it_lies();
  a.open();
  a.tip.y += 0.003;
  a.lead(0);
  a.rest(0.3);
  a.close();
  ASSERT_EQ(a.state.clip_count, 2);
  ASSERT_TRUE(a.clip(0));
  ASSERT_TRUE(a.clip(1));
  EXPECT_GT(std::fabs(a.clip(0)->s[0] - a.clip(1)->s[0]), 0.001);
}

TEST(ThreadClip, TheSameInputGivesTheSameBitsAndAllOfItIsInTheHash) {
  Applier a = closed(2), b = closed(2);
  for (Applier* each : {&a, &b}) each->open();
  EXPECT_EQ(sim::hash_of(a.state), sim::hash_of(b.state));
  a.thread().clips[0].s[1] += 1e-6;
  EXPECT_NE(sim::hash_of(a.state), sim::hash_of(b.state));
  EXPECT_EQ(sim::first_difference(b.state, a.state).substr(0, 40),
            std::string("objects.sutures[0].thread.clips[0].s[1]: ").substr(0, 40));
}

TEST(ThreadClip, AKeyframeShowsItWhereItSits) {
  Applier a = closed(2);
  ASSERT_TRUE(a.clip());
  sim::State shown = sim::initial_state(a.m);
  ASSERT_TRUE(sim::restore_display(a.m, sim::display_bytes(a.m, a.state), shown));
  const suture::ThreadClip* c = interactions::thread_clip(shown.objects.sutures, shown.clips[0], 0);
  ASSERT_TRUE(c);
  EXPECT_EQ(length(c->at - a.clip()->at), 0);
  EXPECT_EQ(c->count, 2);
}

TEST(ThreadClip, ATickThatSetsOneAllocatesNothing) {
  Applier a;
  a.lay(2);
  for (int i = 0; i <= 150; ++i) a.lead(i / 200.0), a.step();
  const long before = g_allocations;
  for (int i = 150; i <= 200; ++i) a.lead(i / 200.0), a.step();
  EXPECT_EQ(g_allocations, before);
  EXPECT_TRUE(a.clip());
}

TEST(ThreadClip, LetGoFallsWithANeedleAndComesToRest) {
  Applier a = closed(1);
  a.open();
  a.tip += 0.04 * normalised(a.port() - a.tip);
  a.lead(0);
  a.input.tools[a.m.hand_index("right")].handle = 0;
  a.rest(1.5);
  ASSERT_TRUE(a.clip());
  EXPECT_LT(a.clip()->at.z, -0.06);
  EXPECT_LT(a.suture().strain, 1);
  EXPECT_EQ(a.suture().broken, 0);
}

/// Thread that lies straight over the applier's shaft, and a jaw of the other hand's that comes down on it until so
/// much of the thread's diameter is left between both.
Applier crushed(double left) {
  Applier a;
  const size_t right = size_t(a.m.hand_index("right"));
  a.input.tools[right].handle = 0;  // the needle falls
  a.rest(0.3);
  const interactions::ToolShape applier = a.shape();
  const collision::Capsule& rod = applier.rod(interactions::kShaft);
  const Vec3d port = a.m.hands[right].port, axis = normalised(rod.b - rod.a), on = rod.a + 0.7 * (rod.b - rod.a);
  const Vec3d up = normalised(port - on - dot(port - on, axis) * axis), across = cross(axis, up);
  const double d = a.model().stuff.diameter;
  const Vec3d top = on + (rod.radius + 0.5 * d) * up;
  a.thread() = suture::laid(a.model(), std::vector<Vec3d>{top - 0.06 * across, top + 0.06 * across});
  const std::vector<Vec3d> held = a.thread().x;
  const double roll = sim::pose_of(a.input.tools[right]).roll;
  const auto step_with_thread_in_place = [&] {
    for (size_t n = 0; n < held.size(); ++n)
      if (length(held[n] - top) > 0.012) a.thread().x[n] = held[n], a.thread().v[n] = {};
    a.step();
  };
  const auto lead = [&](double above) {  // of the lower jaw's end over the shaft
    const interactions::ToolShape now = sim::shape_of(a.m, a.state, right);
    const auto bottom = [&](int part) {
      const collision::Capsule& jaw = now.rod(part);
      return (length(jaw.a - port) > length(jaw.b - port) ? jaw.a : jaw.b) - jaw.radius * up;
    };
    const Vec3d first = bottom(interactions::kJawA), second = bottom(interactions::kJawB);
    const Vec3d low = dot(first, up) < dot(second, up) ? first : second;
    const Vec3d to = on + (rod.radius + above) * up + (now.frame.tip - low);
    a.input.tools[right] = sim::tool_input(kinematics::inverse(port, to, roll), 1.0f);
    step_with_thread_in_place();
  };
  const Vec3d drawn_back = port + 0.04 * normalised(on - port);  // from there it comes down beside nothing else
  a.input.tools[right] = sim::tool_input(kinematics::inverse(port, drawn_back, roll), 1.0f);
  for (int i = 0; i < 300; ++i) step_with_thread_in_place();
  for (int i = 0; i < 400; ++i) lead(0.030 - 0.025 * i / 400.0);
  for (int i = 0; i < 300; ++i) lead(0.005 - (0.005 - left * d) * i / 300.0);
  for (int i = 0; i < 50; ++i) lead(left * d);
  return a;
}

TEST(ThreadCrush, SteelThatIsPushedOntoSteelPartsTheThreadBetween) {
  Applier a = crushed(0.2);
  EXPECT_EQ(a.suture().broken, 1);
  EXPECT_EQ(std::count(a.thread().alive.begin(), a.thread().alive.end(), 0), 1);
}

TEST(ThreadCrush, OneThatIsPinchedStaysWhole) {
  Applier a = crushed(0.9);
  EXPECT_GT(a.thread().touch_count, 1) << "nothing touches it";
  EXPECT_EQ(a.suture().broken, 0);
}

}  // namespace
}  // namespace trocar
