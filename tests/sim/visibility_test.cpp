// What the endoscope sees: rays against organs, strands and instruments.
#include <cmath>

#include <gtest/gtest.h>

#include <trocar/core/random.hpp>
#include <trocar/geometry/surfaces/nearest.hpp>
#include <trocar/sim/stages/visibility.hpp>

#include "small_scene.hpp"

using namespace trocar;
using namespace trocar::sim;

namespace {

/// The small scene as placed, all samples looked at.
struct Placed {
  const Model& model = small::model();
  State state = initial_state(model);
  Work work = make_work(model);
  Placed() { look_at_all(model.start); }
  void look_at_all(const Input& input) {
    for (size_t i = 0; i <= model.samples.size() / size_t(kLooksPerTick) + 1; ++i) step(model, input, state, work);
  }
  bool free_sight(Vec3d eye, Vec3d point, int skip_tool = -1, int skip_strand = -1) const {
    return unoccluded(model, state, work, eye, point, 0.0005, skip_tool, skip_strand);
  }
};

TEST(Sight, AnOrganHidesWhatLiesBehindIt) {
  const Placed p;
  const Vec3d eye{0.05, 0.005, 0.05};
  EXPECT_TRUE(p.free_sight(eye, {0.05, 0.005, 0.004})) << "above the pad";
  EXPECT_FALSE(p.free_sight(eye, {0.05, 0.005, -0.010})) << "inside it";
  EXPECT_FALSE(p.free_sight(eye, {0.05, 0.005, -0.017})) << "below it";
}

TEST(Sight, AStrandHidesWhatLiesBehindItAndNothingBesideIt) {
  const Placed p;
  EXPECT_FALSE(p.free_sight({0.030, 0, 0.03}, {0.030, 0, -0.01}));
  EXPECT_TRUE(p.free_sight({0.030, 0, 0.03}, {0.030, 0, -0.01}, -1, small::kTube)) << "it does not hide itself";
  EXPECT_TRUE(p.free_sight({0.030, 0.0021, 0.03}, {0.030, 0.0021, -0.01})) << "0.5 mm beside it";
  EXPECT_TRUE(p.free_sight({0.030, 0, 0.03}, {0.030, 0, 0.0025})) << "in front of it";
}

TEST(Sight, AnInstrumentHidesWhatLiesBehindIt) {
  const Placed p;
  const Vec3d shaft = 0.5 * (p.work.shapes[0].part[interactions::kShaft].a + p.work.shapes[0].pivot);
  const Vec3d eye = shaft + Vec3d{0, 0.03, 0}, point = shaft - Vec3d{0, 0.015, 0};
  EXPECT_FALSE(p.free_sight(eye, point));
  EXPECT_TRUE(p.free_sight(eye, point, small::kGrasper));
}

TEST(Sight, AgreesWithATestOfEveryTriangle) {
  // The step looks into few blocks of the skin; here every triangle is intersected.
  const Placed p;
  core::Random random(3);
  const auto crosses = [](Vec3d from, Vec3d to, Vec3d a, Vec3d b, Vec3d c) {
    const Vec3d n = cross(b - a, c - a);
    const double d0 = dot(from - a, n), d1 = dot(to - a, n);
    if ((d0 > 0) == (d1 > 0)) return false;
    const Vec3d x = from + d0 / (d0 - d1) * (to - from);
    return dot(cross(b - a, x - a), n) >= 0 && dot(cross(c - b, x - b), n) >= 0 && dot(cross(a - c, x - c), n) >= 0;
  };
  int hidden = 0, different = 0;
  for (int trial = 0; trial < 4000; ++trial) {
    const Vec3d from{random.uniform(-0.06, 0.09), random.uniform(-0.04, 0.04), random.uniform(-0.03, 0.04)};
    const Vec3d to{random.uniform(-0.06, 0.09), random.uniform(-0.04, 0.04), random.uniform(-0.03, 0.04)};
    const double margin = 0.0005;
    const Vec3d end = from + (1 - margin / length(to - from)) * (to - from);
    bool hit = false;
    for (size_t s = 0; s < p.model.solids.size(); ++s)
      for (const auto& t : p.model.solids[s].skin.triangles) {
        const interactions::Surface& surface = p.work.surfaces[s];
        hit = hit || crosses(from, end, surface.position(t[0]), surface.position(t[1]), surface.position(t[2]));
      }
    for (const sim::WallModel& wall : p.model.walls)
      for (const auto& t : wall.skin.triangles) {
        const auto at = [&](size_t k) { return vec_cast<double>(wall.pose.position[size_t(t[k])]); };
        const bool from_outside = dot(from - at(0), cross(at(1) - at(0), at(2) - at(0))) > 0;
        hit = hit || (from_outside && crosses(from, end, at(0), at(1), at(2)));
      }
    const auto near_axis = [&](Vec3d a, Vec3d b, double radius) {
      return geometry::closest_segments(from, end, a, b).distance2 < radius * radius;
    };
    for (size_t s = 0; s < p.model.strand_bodies.size(); ++s)
      for (size_t e = 0; e + 1 < p.state.strands[s].x.size(); ++e)
        hit = hit ||
              near_axis(p.state.strands[s].x[e], p.state.strands[s].x[e + 1], p.model.strand_bodies[s].model.radius[e]);
    for (size_t t = 0; t < p.model.hands.size(); ++t)
      for (const interactions::Capsule& c : p.work.shapes[t].part) hit = hit || near_axis(c.a, c.b, c.radius);
    hidden += hit;
    different += hit == p.free_sight(from, to);
  }
  EXPECT_EQ(different, 0) << "of 4000";
  EXPECT_GT(hidden, 500);
  EXPECT_LT(hidden, 3500);
}

TEST(Visibility, TheTubeAndTheNearJawReachingForItAreSeen) {
  Placed p;
  small::Hands hands(p.model);
  for (int t = 0; t < 320; ++t) step(p.model, hands.next(p.state), p.state, p.work);
  for (const char* name : {"a.jaw_a", "tube.isthmus"})
    EXPECT_TRUE(visible(p.model, p.state, p.model.target_index(name))) << name;
  EXPECT_FALSE(visible(p.model, p.state, p.model.target_index("c.jaw_a"))) << "still above the lens";
  EXPECT_FALSE(visible(p.model, p.state, p.model.target_index("no such thing")));
}

TEST(Visibility, NothingIsSeenOutsideTheCone) {
  Placed p;
  Input away = p.model.start;
  away.scope.pitch = 1.3f;  // the lens looks along +y, past everything
  for (int t = 0; t < 1000; ++t) step(p.model, away, p.state, p.work);
  for (std::uint8_t seen : p.state.seen) EXPECT_EQ(seen, 0);
}

TEST(Visibility, TheConesEdgeIsWhereTheFieldOfViewEnds) {
  // A jaw tip just inside 97 % of the half angle is seen, just outside it is not.
  Placed p;
  const kinematics::ScopeFrame scope = scope_of(p.model, p.state);
  const double half = 0.5 * 0.97 * p.model.scope.field_of_view;
  const int target = p.model.target_index("a.jaw_a");
  const size_t sample = size_t(p.model.targets[size_t(target)].first);
  for (double off : {-0.01, 0.01}) {
    const double angle = half + off;
    const Vec3d tip = scope.eye + 0.02 * (std::cos(angle) * scope.forward + std::sin(angle) * scope.right);
    p.work.shapes[small::kGrasper].part[interactions::kJawA].b = tip;
    p.state.seen.assign(p.state.seen.size(), 0);
    for (size_t i = 0; i <= p.model.samples.size(); ++i) {
      update_visibility(p.model, p.state, p.work);
      ++p.state.tick;
    }
    EXPECT_EQ(bool(p.state.seen[sample]), off < 0) << angle;
  }
}

TEST(Visibility, TheFarSideOfAnOrganIsNotSeen) {
  const Placed p;
  const kinematics::ScopeFrame scope = scope_of(p.model, p.state);
  int near_side = 0;
  for (size_t i = 0; i < p.model.samples.size(); ++i) {
    const VisibilitySample& sample = p.model.samples[i];
    const VisibilityTarget& target = p.model.targets[size_t(sample.target)];
    if (target.kind != VisibilityTarget::organ) continue;
    const interactions::Surface& surface = p.work.surfaces[size_t(target.index)];
    const double facing = dot(surface.normal(sample.where), scope.eye - surface.position(sample.where));
    if (facing < 0) {
      EXPECT_FALSE(p.state.seen[i]);
    }
    near_side += p.state.seen[i];
  }
  EXPECT_GT(near_side, 0);
}

TEST(Visibility, AnOpenVesselInAFoldIsSeenWhereTheFoldIs) {
  scene::Description d = small::description();
  d.bleeder = scene::BleederSetting{};
  d.bleeder->holes.push_back({"fold_artery", 0.5, 0.3e-3, {}});
  const Model model = scene::compile(d);
  const int target = model.target_index("bleeder");
  ASSERT_GE(target, 0);
  EXPECT_EQ(model.targets[size_t(target)].kind, VisibilityTarget::fold);
  State state = initial_state(model);
  Work work = make_work(model);
  Input away = model.start;
  away.scope.pitch = 1.3f;
  for (const bool looks : {true, false}) {
    for (size_t i = 0; i <= model.samples.size() + 1; ++i) step(model, looks ? model.start : away, state, work);
    if (!looks)
      for (int i = 0; i < 1000; ++i) step(model, away, state, work);
    EXPECT_EQ(visible(model, state, target), looks);
  }
}

TEST(Visibility, EverySampleIsLookedAtInTurn) {
  Placed p;
  std::vector<std::uint8_t> marker(p.state.seen.size(), 7);
  p.state.seen = marker;
  const size_t round = (p.model.samples.size() + size_t(kLooksPerTick) - 1) / size_t(kLooksPerTick);
  for (size_t i = 0; i < round; ++i) step(p.model, p.model.start, p.state, p.work);
  for (std::uint8_t seen : p.state.seen) EXPECT_LE(seen, 1);
}

}  // namespace
