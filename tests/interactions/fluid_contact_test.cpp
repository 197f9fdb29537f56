// Drops on tissue: they land on what they meet first, from the side they come from, run down it, and leave film on it.
#include <cmath>

#include <gtest/gtest.h>

#include <trocar/core/random.hpp>
#include <trocar/fluids/fluids.hpp>
#include <trocar/geometry/surfaces/nearest.hpp>
#include <trocar/interactions/contact/nearest_skin.hpp>
#include <trocar/interactions/wetting/fluid_contact.hpp>

#include "../geometry/shapes.hpp"
#include "few_bodies.hpp"
#include "straight_tube.hpp"

using namespace trocar;
using namespace trocar::interactions;

namespace {

constexpr double kBall = 0.020, kHeight = 0.060, kTubeHeight = -0.030;  // [m]
constexpr Vec3d kDown{0, 0, -1};
enum : std::int32_t { ball = 0, sheet = 1, tube = 2 };

/// A skin that nothing carries.
struct Still {
  tissue::Skin skin;
  tissue::SkinPose pose;

  explicit Still(const geometry::TriMesh& mesh) {
    skin.triangles = mesh.triangles;
    skin.weights.resize(mesh.positions.size());
    const std::vector<Vec3d> normals = geometry::vertex_normals(mesh);
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
      skin.rest.push_back(vec_cast<float>(mesh.positions[i]));
      skin.rest_normal.push_back(vec_cast<float>(normals[i]));
    }
    tissue::index_skin(skin);
    pose = tissue::make_pose(skin);
    for (std::size_t i = 0; i < skin.rest.size(); ++i) {
      pose.position[i] = skin.rest[i];
      pose.block[i / tissue::kSkinBlock].add(skin.rest[i]);
      pose.patch[i / tissue::kSkinPatch].add(skin.rest[i]);
      pose.bounds.add(skin.rest[i]);
    }
  }
  Surface surface() const { return {&skin, &pose, {}}; }
};

/// 40 mm x 40 mm, level, looking up, beside the ball.
geometry::TriMesh level_sheet() {
  geometry::TriMesh mesh;
  constexpr int n = 16;
  for (int j = 0; j <= n; ++j)
    for (int i = 0; i <= n; ++i) mesh.positions.push_back({0.080 + 0.0025 * i, 0.0025 * (j - n / 2), kHeight});
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i) {
      const int a = j * (n + 1) + i, b = a + 1, c = a + n + 1, d = c + 1;
      mesh.triangles.push_back({a, b, d});
      mesh.triangles.push_back({a, d, c});
    }
  return mesh;
}

/// A ball, a fold beside it, a tube below it, a pool below all.
struct Scene {
  Still ball_skin{geometry::sphere_mesh(kBall, 4)}, sheet_skin{level_sheet()};
  test::StraightTube tube{0.0016, {-0.030, 0, kTubeHeight}};
  test::FewBodies few;
  std::vector<std::int32_t> first;
  fluids::FluidsModel m;
  fluids::FluidsState s;
  fluids::FluidsWork w;
  WetWork wet;
  fluids::FluidsInput input;
  std::vector<float> floor;

  /// @param crowd  as scenes are that allow for thousands of drops
  explicit Scene(bool crowd = false) {
    few.models.membranes.resize(1);
    few.models.strand_bodies.push_back(tube.body);
    few.states.strands.push_back(tube.state);
    few.work.surfaces.push_back(ball_skin.surface());
    few.work.membranes.emplace_back().sheet = {sheet_skin.surface(), {}, {}, 0.0005, 0};
    const tissue::Skin* skins[] = {&ball_skin.skin};
    const tissue::Skin* folds[] = {&sheet_skin.skin};
    first = film_places(skins, folds, {&tube.body, 1});
    fluids::FluidsDescription d;
    d.pool = {.origin = {-0.1, -0.1, -0.1}, .nx = 160, .ny = 160};
    d.droplets.capacity = 2048;
    d.droplets.film_cells = first.back();
    if (crowd) fluids::set_crowd_level_of_detail(d.droplets);
    m = fluids::build(d);
    s = fluids::initial_state(m);
    w = fluids::make_work(m);
    wet = make_wet_work({&tube.body, 1}, first);
    floor.assign(160 * 160, 0.0f);
    input.floor = floor;
  }
  WetGround bodies() { return {few.all(), first}; }
  void drop(Vec3d from, Vec3d speed, std::int64_t picolitres) {
    const fluids::Mix mix{.blood = picolitres};
    ASSERT_TRUE(fluids::add_drop(m.droplets, vec_cast<float>(from), vec_cast<float>(speed), mix, s.droplets));
    receive(s.ledger, fluids::Source::kBled, fluids::Place::kDroplets, mix);
  }
  void tick() {
    fluids::begin_tick(m, input, s, w);
    answer_drops(bodies(), kDown, s.droplets, w.droplets, wet);
    const fluids::FluidsReport r = fluids::finish_tick(m, input, s, w);
    ASSERT_EQ(r.report.flags & ~std::uint32_t(fluids::FluidReport::kCrowded), 0u);
    ASSERT_TRUE(fluids::audit(m, s));
  }
  Vec3d place(std::size_t i) const {
    return {double(s.droplets.x[i]), double(s.droplets.y[i]), double(s.droplets.z[i])};
  }
  std::int64_t film_on(std::int32_t body) const {
    std::int64_t sum = 0;
    for (int k = first[std::size_t(body)]; k < first[std::size_t(body) + 1]; ++k)
      sum += s.droplets.film[std::size_t(k)].total();
    return sum;
  }
};

TEST(SkinGrid, AndTheSearchByBoxesFindTheVertexThatLookingAtAllFinds) {
  core::Random random(5);
  constexpr double kReach = 0.006;
  for (const geometry::TriMesh& mesh : {geometry::sphere_mesh(kBall, 4), level_sheet()}) {
    const Still still(mesh);
    const Surface surface = still.surface();
    const SkinGrid grid = make_skin_grid(still.skin, kReach);
    int found = 0;
    for (int k = 0; k < 20'000; ++k) {
      const Vec3d on = surface.position(int(random.next() % std::size_t(still.skin.size())));
      const auto off = [&] { return random.uniform(-0.008, 0.008); };
      const Vec3d p = k % 10 ? on + Vec3d{off(), off(), off()} : on;
      const int all = nearest_vertex(surface, p);
      const int expected = geometry::distance2(surface.position(all), p) < kReach * kReach ? all : -1;
      ASSERT_EQ(nearest_vertex_near(surface, p, kReach), expected);
      ASSERT_EQ(grid.nearest(still.skin, p), expected);
      found += expected >= 0;
    }
    EXPECT_GT(found, 5'000);
    EXPECT_LT(found, 19'000) << "some are too far away";
    EXPECT_EQ(grid.nearest(still.skin, {1e30, 0, 0}), -1);
    EXPECT_EQ(grid.nearest(still.skin, {std::nan(""), 0, 0}), -1);
  }
}

/// Drops, and drops of a crowd.
class DropsOnTissue : public testing::TestWithParam<bool> {};
INSTANTIATE_TEST_SUITE_P(AloneAndInCrowds, DropsOnTissue, testing::Bool());

TEST_P(DropsOnTissue, RunDownABallToItsUndersideAndLeaveFilmBehind) {
  Scene scene(GetParam());
  scene.drop({0.006, 0.001, 0.030}, {0, 0, 0}, 8'000'000);
  double lowest = 1, off = 0;
  int on = 0;
  for (int t = 0; t < 3000 && scene.s.droplets.count > 0; ++t) {
    scene.tick();
    if (scene.s.droplets.count == 0 || scene.s.droplets.body[0] < 0) continue;
    ASSERT_EQ(scene.s.droplets.body[0], ball);
    ++on;
    lowest = std::min(lowest, scene.place(0).z);
    off = std::max(off, std::fabs(length(scene.place(0)) - kBall - 0.5 * double(scene.s.droplets.radius[0])));
  }
  EXPECT_GT(on, 300);
  EXPECT_LT(off, GetParam() ? 0.0006 : 0.0003) << "[m] beside where half a radius above the ball is";
  EXPECT_LT(lowest, -0.8 * kBall);
  EXPECT_GT(scene.film_on(ball), 500'000);
  EXPECT_EQ(scene.film_on(sheet), 0);
}

TEST_P(DropsOnTissue, StayOnTheSideOfAFoldThatTheyCameFromHoweverFast) {
  Scene scene(GetParam());
  core::Random random(3);
  const double fastest = GetParam() ? 2.4 : 5;  // [m/s] a crowd's drop is asked for before it has flown 10 mm
  constexpr int kShots = 1000;
  for (int k = 0; k < kShots; ++k) {
    const double side = k % 2 ? 1 : -1;
    const Vec3d aim{0.085 + 0.030 * random.uniform(0, 1), random.uniform(-0.015, 0.015), kHeight};
    const Vec3d from = aim + Vec3d{random.uniform(-0.004, 0.004), random.uniform(-0.004, 0.004), 0.010 * side};
    scene.drop(from, random.uniform(0.5, fastest) * normalised(aim - from), 100'000);
    const int last = scene.s.droplets.count - 1;
    for (int t = 0; t < 60 && scene.s.droplets.count > last && scene.s.droplets.body[std::size_t(last)] < 0; ++t)
      scene.tick();
    ASSERT_EQ(scene.s.droplets.count, 1) << "shot " << k;
    ASSERT_EQ(scene.s.droplets.body[0], sheet) << "shot " << k;
    EXPECT_GT(double(scene.s.droplets.ground[0].normal.z) * side, 0.9) << "shot " << k;
    EXPECT_EQ((scene.s.droplets.ground[0].film - scene.first[sheet]) % 2, side > 0 ? 0 : 1) << "shot " << k;
    const fluids::Mix rest = fluids::widened(scene.s.droplets.volume[0]);
    scene.s.droplets.volume[0] = {};
    fluids::detail::remove_empty(scene.s.droplets);
    move(scene.s.ledger, fluids::Place::kDroplets, fluids::Place::kSucked, rest);
  }
}

TEST_P(DropsOnTissue, CatchOnATubeAndHangBelowIt) {
  Scene scene(GetParam());
  scene.drop({0.010, 0.0005, kTubeHeight + 0.004}, {0, 0, 0}, 2'000'000);
  for (int t = 0; t < 1500; ++t) scene.tick();
  ASSERT_EQ(scene.s.droplets.count, 1);
  EXPECT_EQ(scene.s.droplets.body[0], tube);
  EXPECT_LT(scene.place(0).z, kTubeHeight - 0.001);
  EXPECT_GT(scene.film_on(tube), 0);
}

TEST_P(DropsOnTissue, LeaveWhatTheyAreBornInIfTheyAreFastEnough) {
  const Vec3d inside{0.010, 0.0002, kTubeHeight + 0.0004};
  for (const double speed : {0.05, 0.3, 1.0, 3.0}) {
    if (GetParam() && speed > 0.5) continue;  // when it is asked for it is at the wall above
    Scene scene(GetParam());
    scene.drop(inside, {0, 0, speed}, 1'000'000);
    const int ticks = GetParam() ? 8 : 1;  // until it has been asked for
    for (int t = 0; t < ticks; ++t) scene.tick();
    ASSERT_EQ(scene.s.droplets.count, 1);
    EXPECT_EQ(scene.s.droplets.body[0], speed > 0.1 ? -1 : tube) << speed;
    EXPECT_GT(double(scene.s.droplets.vz[0]), speed > 0.1 ? 0.9 * speed - ticks * 0.00981 : -1.0);
  }
  Scene scene(GetParam());
  scene.drop(inside, {0, 0, 0.4}, 1'000'000);
  double highest = -1;
  for (int t = 0; t < 200; ++t) {
    scene.tick();
    if (scene.s.droplets.count > 0) highest = std::max(highest, scene.place(0).z - inside.z);
  }
  EXPECT_NEAR(highest, 0.4 * 0.4 / 2 / 9.81, 0.002) << "as high as a throw goes";
  EXPECT_EQ(scene.s.droplets.body[0], tube) << "and back, where it lands";
}

TEST_P(DropsOnTissue, FallPastWhatTheyDoNotMeetIntoThePool) {
  Scene scene(GetParam());
  scene.drop({-0.060, 0.030, 0.030}, {0, 0, 0}, 2'000'000);
  for (int t = 0; t < 400; ++t) scene.tick();
  EXPECT_EQ(scene.s.droplets.count, 0);
  EXPECT_EQ(at(scene.s.ledger, fluids::Place::kPool).blood, 2'000'000);
}

TEST_P(DropsOnTissue, FilmThatRunsOverLetsDropsGoWhereItLies) {
  Scene scene(GetParam());
  const std::int32_t place = scene.first[sheet] + 2 * 40 + 1;
  const fluids::Mix mix{.blood = 3'000'000};
  scene.s.droplets.film[std::size_t(place)].blood = std::int32_t(mix.blood);
  receive(scene.s.ledger, fluids::Source::kBled, fluids::Place::kFilm, mix);
  for (int t = 0; t < 20 && scene.s.droplets.count == 0; ++t) scene.tick();
  ASSERT_EQ(scene.s.droplets.count, 1);
  const WetPlace at = wet_place(scene.bodies(), kDown, place);
  EXPECT_EQ(at.body, sheet);
  EXPECT_LT(at.normal.z, -0.99);
  EXPECT_LT(length(scene.place(0) - at.point), 0.001);
}

TEST(PlacesOfFilm, BelongToTheirBodiesAndToNothingBeyond) {
  Scene scene;
  for (std::int32_t body = 0; body < 3; ++body) {
    EXPECT_EQ(wet_place(scene.bodies(), kDown, scene.first[std::size_t(body)]).body, body);
    EXPECT_EQ(wet_place(scene.bodies(), kDown, scene.first[std::size_t(body) + 1] - 1).body, body);
  }
  EXPECT_EQ(wet_place(scene.bodies(), kDown, -1).body, -1);
  EXPECT_EQ(wet_place(scene.bodies(), kDown, scene.first.back()).body, -1);
}

}  // namespace
