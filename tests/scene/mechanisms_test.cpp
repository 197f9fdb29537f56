// The shipped mechanisms: they close, move as they are told to, and open as their instruments do.
#include <algorithm>
#include <cmath>
#include <filesystem>

#include <gtest/gtest.h>

#include <trocar/core/random.hpp>
#include <trocar/kinematics/inverse/inverse.hpp>
#include <trocar/kinematics/loops/mobility.hpp>
#include <trocar/scene/files/reader.hpp>
#include <trocar/scene/mechanisms/mechanism_file.hpp>

namespace trocar::scene {
namespace {

using namespace kinematics;

constexpr double kDegrees = 180 / portable::pi;

std::filesystem::path file_of_mechanism(const std::string& name) {
  return std::filesystem::path(TROCAR_SOURCE_DIR "/scenes/mechanisms") / (name + ".json");
}
Mechanism mechanism(const std::string& name) { return build(read_mechanism(file_of_mechanism(name))); }

std::vector<std::string> shipped() {
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(TROCAR_SOURCE_DIR "/scenes/mechanisms"))
    names.push_back(entry.path().stem().string());
  std::sort(names.begin(), names.end());
  return names;
}

class ShippedMechanism : public testing::TestWithParam<std::string> {};
INSTANTIATE_TEST_SUITE_P(All, ShippedMechanism, testing::ValuesIn(shipped()), [](const auto& p) { return p.param; });

TEST_P(ShippedMechanism, ClosesWhereItBeginsAndAlongTheWholeWayOfItsDrives) {
  const Mechanism m = mechanism(GetParam());
  EXPECT_EQ(m.name, GetParam()) << "called as its file";
  LoopWork work(m);
  hold_drives(m, work);
  std::vector<double> u = m.start_u();
  const LoopReport first = close(m, u, work);
  ASSERT_TRUE(first.closed()) << words(m, first);
  EXPECT_LT(first.metres, 1e-12);
  EXPECT_EQ(first.limit, -1) << words(m, first);
  if (m.drives.empty()) return;
  const Branch branch = branch_at(m, u, work);
  for (const double handle : {0.0, 0.5, 1.0, 0.0}) {
    std::vector<Target> targets;
    for (const Drive& d : m.drives) targets.push_back({d.independent, d.value(handle)});
    const MoveReport moved = move(m, u, targets, branch, work);
    ASSERT_TRUE(moved.arrived()) << handle << ": " << words(m, moved);
    EXPECT_LT(moved.last.metres, 1e-12);
    EXPECT_EQ(moved.last.limit, -1) << words(m, moved.last);
  }
}

struct Freedoms {
  const char* name;
  int mobility;
  bool over_constrained;
};
TEST(ShippedMechanisms, HaveTheFreedomsThatTheyAreMadeFor) {
  const Freedoms all[] = {
      {"four_bar", 1, true},        {"slider_crank", 1, true}, {"bricard", 1, true},  {"double_parallelogram", 1, true},
      {"grasper", 1, true},         {"claw_grasper", 1, true}, {"maryland", 1, true}, {"scissors", 1, true},
      {"curved_scissors", 1, true}, {"clip_applier", 1, true}, {"bipolar", 1, true},  {"needle_holder", 1, true},
      {"redundant_arm", 7, false}};
  for (const Freedoms& f : all) {
    const Mechanism m = mechanism(f.name);
    std::vector<double> u = m.start_u();
    const Mobility found = mobility(m, u);
    EXPECT_EQ(found.mobility, f.mobility) << f.name << ": " << words(found);
    EXPECT_EQ(found.over_constrained(), f.over_constrained) << f.name << ": " << words(found);
    EXPECT_GT(found.poses, 4) << f.name;
  }
}

TEST(ShippedMechanisms, ADoubleParallelogramKeepsItsRemoteCentreInPlace) {
  const Mechanism m = mechanism("double_parallelogram");
  LoopWork work(m);
  hold_drives(m, work);
  std::vector<double> u = m.start_u();
  ASSERT_TRUE(close(m, u, work).closed());
  const Branch branch = branch_at(m, u, work);
  const Frame first = place(m.frames[std::size_t(m.frame("tip"))], work.pose);
  for (int k = 0; k <= 20; ++k) {
    ASSERT_TRUE(move(m, u, {{0, (30 + 6 * k) / kDegrees}}, branch, work).arrived());
    EXPECT_LT(length(place(m.frames[std::size_t(m.frame("remote_centre"))], work.pose).p), 1e-12);
  }
  EXPECT_GT(length(place(m.frames[std::size_t(m.frame("tip"))], work.pose).p - first.p), 0.1)
      << "and the shaft does turn";
}

/// Angle between the jaws, or what it is called: of the upper and the lower one's turn, at a handle.
double opening(const Mechanism& m, double handle) {
  LoopWork work(m);
  hold_drives(m, work);
  std::vector<double> u = m.start_u();
  EXPECT_TRUE(close(m, u, work).closed());
  const Branch branch = branch_at(m, u, work);
  EXPECT_TRUE(move(m, u, {{m.drives[0].independent, m.drives[0].value(handle)}}, branch, work).arrived());
  double sum = 0;
  for (const char* name : {"jaw_upper", "jaw_lower"})
    if (const int q = m.coordinate(name); q >= 0) sum += work.pose.q[std::size_t(q)];
  return sum * kDegrees;
}

TEST(ShippedMechanisms, JawsOpenAsFarAsTheirInstrumentsAndMoveOneWay) {
  struct Jaws {
    const char *name, *instrument;
    double opening;
  };
  const Jaws all[] = {{"grasper", "grasper", 60},    {"claw_grasper", nullptr, 60},    {"maryland", "maryland", 50},
                      {"scissors", "scissors", 45},  {"curved_scissors", nullptr, 45}, {"bipolar", "bipolar", 50},
                      {"needle_holder", nullptr, 35}};
  const std::vector<InstrumentEntry> instruments = list_instruments(TROCAR_SOURCE_DIR "/scenes/instruments");
  for (const Jaws& j : all) {
    const Mechanism m = mechanism(j.name);
    EXPECT_NEAR(opening(m, 0), j.opening, 0.01) << j.name;
    EXPECT_NEAR(opening(m, 1), 0, 0.01) << j.name;
    double last = 1e9;
    for (int k = 0; k <= 10; ++k) {
      const double now = opening(m, 0.1 * k);
      EXPECT_LT(now, last) << j.name << ": closing the handle closes the jaws";
      last = now;
    }
    if (!j.instrument) continue;
    std::vector<core::Fault> faults;
    const JsonDocument file =
        load_json(TROCAR_SOURCE_DIR "/scenes/instruments/" + std::string(j.instrument) + ".json", faults);
    const JsonMember* said = file.root.find("opening_deg");  // those that name a mechanism take it from there
    if (said) {
      EXPECT_EQ(said->value.number, j.opening) << j.instrument;
    }
    EXPECT_TRUE(said || file.root.find("mechanism")) << j.instrument;
  }
}

TEST(ShippedMechanisms, TheClipAppliersJawsStayParallelAndCloseFromSixMillimetres) {
  const Mechanism m = mechanism("clip_applier");
  LoopWork work(m);
  hold_drives(m, work);
  std::vector<double> u = m.start_u();
  ASSERT_TRUE(close(m, u, work).closed());
  const Branch branch = branch_at(m, u, work);
  for (const double handle : {0.0, 0.3, 0.6, 1.0}) {
    ASSERT_TRUE(move(m, u, {{m.drives[0].independent, m.drives[0].value(handle)}}, branch, work).arrived());
    const Frame upper = place(m.frames[std::size_t(m.frame("tip_upper"))], work.pose);
    const Frame lower = place(m.frames[std::size_t(m.frame("tip_lower"))], work.pose);
    EXPECT_LT(length(turn_between(upper.r, lower.r)), 1e-9);
    const double gap = upper.p.x - lower.p.x;
    if (handle == 0 || handle == 1) {
      EXPECT_NEAR(gap, handle == 0 ? 6e-3 : 0, 1e-6);
    }
  }
}

TEST(ShippedMechanisms, ShaftsOfArmsGoThroughTheirRemoteCentre) {
  for (const char* name : {"dvrk_arm", "flexible_instrument", "redundant_arm"}) {
    const Mechanism m = mechanism(name);
    const auto frame = [&](const char* of) -> const BodyFrame& { return m.frames[std::size_t(m.frame(of))]; };
    LoopWork work(m);
    core::Random random(32);
    std::vector<double> u = m.start_u();
    for (int k = 0; k < 50; ++k) {
      for (std::size_t i = 0; i < u.size(); ++i) u[i] += random.uniform(-0.1, 0.1) * m.scale(int(i));
      ASSERT_TRUE(close(m, u, work).closed()) << name;
      const Frame shaft = place(frame("shaft"), work.pose);
      const Vec3d away = place(frame("remote_centre"), work.pose).p - shaft.p;
      EXPECT_LT(length(cross(away, shaft.r.column(2))), 1e-12) << name;
    }
  }
}

/// Poses of an arm within its limits, loops closed.
bool random_pose(const Mechanism& m, core::Random& random, std::vector<double>& u, LoopWork& work) {
  for (std::size_t i = 0; i < u.size(); ++i) {
    const auto q = std::size_t(m.independent[i]);
    const bool limited = std::isfinite(m.low[q]) && std::isfinite(m.high[q]);
    u[i] = limited ? random.uniform(m.low[q], m.high[q]) : random.uniform(-portable::pi, portable::pi);
  }
  const LoopReport report = close(m, u, work);
  return report.closed() && report.limit < 0;
}

TEST(ShippedMechanisms, ArmsReachEveryPoseThatTheyCanStandIn) {
  for (const char* name : {"dvrk_arm", "flexible_instrument", "redundant_arm"}) {
    const Mechanism m = mechanism(name);
    const BodyFrame& tip = m.frames[std::size_t(m.frame("tip"))];
    LoopWork poses(m);
    InverseWork work(m, 6);
    core::Random random(31);
    Pose pose(m);
    std::vector<double> u(std::size_t(m.u_count()));
    for (int k = 0, tries = 0; k < 300; ++tries) {
      ASSERT_LT(tries, 100'000) << name;
      if (!random_pose(m, random, u, poses)) continue;
      ++k;
      const Frame wanted = place(tip, poses.pose);
      const Closure goal = reach(tip, wanted);
      std::vector<double> v = m.start_u();
      const InverseReport report = inverse(m, {&goal, 1}, v, work);
      ASSERT_TRUE(report.reached()) << name << " " << k << ": " << words(m, report);
      forward(m, v, pose);
      const Frame now = place(tip, pose);
      EXPECT_LT(length(now.p - wanted.p), 1e-9);
      EXPECT_LT(length(turn_between(now.r, wanted.r)), 1e-9);
      EXPECT_LT(beyond_limits(m, pose.q), 0);
    }
  }
}

}  // namespace
}  // namespace trocar::scene
