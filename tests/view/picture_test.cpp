// What is drawn around and between the bodies: peritoneum beyond the walls, the bladder's drape, trocar sleeves, dents,
// and the patterns of folds and bowel.
#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include <gtest/gtest.h>

#include <trocar/geometry/surfaces/nearest.hpp>
#include <trocar/render/backend/backend.hpp>
#include <trocar/render/meshes/mesh_arrays.hpp>
#include <trocar/scene/compile/compile.hpp>
#include <trocar/scene/files/reader.hpp>
#include <trocar/view/anatomy/drape.hpp>
#include <trocar/view/anatomy/liver_dome.hpp>
#include <trocar/view/base/fold_pattern.hpp>
#include <trocar/view/base/looks.hpp>
#include <trocar/view/bodies/cavity.hpp>
#include <trocar/view/bodies/cut_ooze.hpp>
#include <trocar/view/bodies/cut_shape.hpp>
#include <trocar/view/bodies/cuttable_drawing.hpp>
#include <trocar/view/fluids/drip_stains.hpp>
#include <trocar/view/instruments/instrument_shapes.hpp>
#include <trocar/view/instruments/shapes.hpp>
#include <trocar/view/scene/scene_view.hpp>

#include "pelvis.hpp"

namespace trocar::view {
namespace {

int solid_with_look(const std::string& name) {
  for (std::size_t i = 0; i < pelvis().solids.size(); ++i)
    if (pelvis().solids[i].look == name) return int(i);
  return -1;
}

float to_nearest(Vec3f p, std::span<const Vec3f> points) {
  float nearest = 1;
  for (const Vec3f& q : points) nearest = std::min(nearest, length(p - q));
  return nearest;
}

/// The cutting scene's liver with a cut of 24 mm by 24 mm into the middle of its left end, as it lies at rest.
struct CutLiver {
  sim::Model model = scene::compile(scene::read_scene(TROCAR_SOURCE_DIR "/scenes/cutting/scene.json"));
  const sim::CuttableOrgan& organ = model.cuttables.front();
  tissue::CuttableState state = tissue::rest_state(organ.body);
  Vec3d middle;
  bool cut() {
    for (const Vec3f& p : organ.skin.skin.rest)
      if (double(p.x) > middle.x) middle = vec_cast<double>(p);
    geometry::Blade blade;
    const Vec3d u{0.012, 0, 0}, v{0, 0, 0.012};
    blade.corners = 4;
    blade.corner = {middle - u - v, middle + u - v, middle + u + v, middle - u + v};
    tissue::CuttableWork work = tissue::make_work(organ.body);
    return tissue::cut(organ.body, blade, state, work).parted > 0;
  }
  tissue::FaceSkin skin() const {
    return tissue::face_skin(state.tets, organ.body.drawn.across, organ.body.row_of_node, tissue::kDrawnParts);
  }
  tissue::SkinPose pose(const tissue::FaceSkin& of) const {
    tissue::SkinPose pose = tissue::make_pose(of.skin);
    tissue::pose_skin(view_of(organ.body, state), of.skin, pose);
    return pose;
  }
};

TEST(CuttableDrawing, ACutGapesAtItsMouthAndNothingMovesFarFromIt) {
  CutLiver liver;
  const auto backend = render::make_null_backend();
  CuttableDrawing drawing(liver.organ, Relief{}, *backend);
  ASSERT_TRUE(liver.cut());
  drawing.update(liver.state);
  const tissue::FaceSkin skin = liver.skin();
  const tissue::SkinPose pose = liver.pose(skin);
  ASSERT_EQ(pose.position.size(), drawing.positions().size());
  float most = 0, far = 0;
  for (std::size_t i = 0; i < pose.position.size(); ++i) {
    const float moved = length(drawing.positions()[i] - pose.position[i]);
    most = std::max(most, moved);
    if (length(vec_cast<double>(pose.position[i]) - liver.middle) > 0.06) far = std::max(far, moved);
  }
  std::printf("    the sides draw back by %.1f mm\n", 1e3 * double(most));
  EXPECT_GT(most, 0.0008f);
  EXPECT_LT(most, 0.005f);
  EXPECT_LT(far, 1e-6f);
  EXPECT_TRUE(drawing.cut());
}

/// How far each place along rims is from the middle between its neighbours, in the mean [m].
float raggedness(const tissue::FaceSkin& skin, std::span<const Vec3f> positions) {
  std::map<std::pair<int, int>, int> sides;  // edges of vertices: 1 of the body's own surface, 2 laid bare, 3 both
  const auto rest = [&](int v) { return skin.skin.rest[std::size_t(v)]; };
  std::map<std::array<int, 3>, int> place;
  const auto at = [&](int v) {
    const Vec3f p = 1e5f * rest(v);
    return place.insert({{int(std::lround(p.x)), int(std::lround(p.y)), int(std::lround(p.z))}, v}).first->second;
  };
  for (const std::array<int, 3>& t : skin.skin.triangles)
    for (std::size_t k = 0; k < 3; ++k) {
      const int a = at(t[k]), b = at(t[(k + 1) % 3]);
      sides[{std::min(a, b), std::max(a, b)}] |= skin.bare[std::size_t(t[0])] ? 2 : 1;
    }
  std::map<int, std::vector<int>> beside;
  for (const auto& [edge, kinds] : sides)
    if (kinds == 3) beside[edge.first].push_back(edge.second), beside[edge.second].push_back(edge.first);
  float sum = 0;
  int count = 0;
  for (const auto& [v, others] : beside) {
    if (others.size() != 2) continue;
    const Vec3f middle = 0.5f * (positions[std::size_t(others[0])] + positions[std::size_t(others[1])]);
    sum += length(positions[std::size_t(v)] - middle), ++count;
  }
  EXPECT_GT(count, 10);
  return sum / float(std::max(count, 1));
}

/// A cut's skin as it lies, and as it is drawn.
struct SmoothedCut {
  CutLiver liver;
  bool there = liver.cut();
  tissue::FaceSkin skin = liver.skin();
  tissue::SkinPose pose = liver.pose(skin);
  std::vector<Vec3f> smooth = pose.position;
  CutShape shape;
  SmoothedCut() {
    shape.find(skin);
    shape.smooth(smooth);
  }
};

TEST(CuttableDrawing, ARimIsNoStairOfCells) {
  const SmoothedCut cut;
  ASSERT_TRUE(cut.there);
  EXPECT_LT(raggedness(cut.skin, cut.smooth), 0.6f * raggedness(cut.skin, cut.pose.position));
}

TEST(CuttableDrawing, ASlitKeepsItsLength) {
  const SmoothedCut cut;
  ASSERT_TRUE(cut.there);
  const auto length_of = [&](std::span<const Vec3f> positions) {
    float longest = 0;
    for (std::size_t a = 0; a < positions.size(); ++a)
      for (std::size_t b = 0; b < a; ++b)
        if (cut.shape.from_rim(a) <= 0 && cut.shape.from_rim(b) <= 0)
          longest = std::max(longest, length(positions[a] - positions[b]));
    return longest;
  };
  EXPECT_GT(length_of(cut.smooth), 0.95f * length_of(cut.pose.position));
}

TEST(CuttableDrawing, SkinAndFleshMeetAlongARim) {
  CutLiver liver;
  ASSERT_TRUE(liver.cut());
  const tissue::FaceSkin skin = liver.skin();
  const auto backend = render::make_null_backend();
  CuttableDrawing drawing(liver.organ, Relief{}, *backend);
  drawing.update(liver.state);
  CutShape shape;
  shape.find(skin);
  int pairs = 0;
  for (std::size_t a = 0; a < skin.bare.size(); ++a) {
    if (skin.bare[a] || shape.from_rim(a) > 0) continue;
    float nearest = 1;
    for (std::size_t b = 0; b < skin.bare.size(); ++b)
      if (skin.bare[b]) nearest = std::min(nearest, length(drawing.positions()[a] - drawing.positions()[b]));
    EXPECT_LT(nearest, 1e-6f);
    ++pairs;
  }
  EXPECT_GT(pairs, 10);
}

/// An upright wall with a level slit in its middle.
struct SlitWall {
  Vec3f down{0, 0, -1};
  std::vector<Vec3f> position, normal, outwards;
  std::vector<std::uint32_t> rim, around;
  SlitWall() {
    for (int i = -20; i <= 20; ++i)
      for (int j = -20; j <= 20; ++j) {
        if (std::abs(j) < 2) continue;
        around.push_back(std::uint32_t(position.size()));
        if (std::abs(j) == 2 && std::abs(i) < 5)
          rim.push_back(around.back()), outwards.push_back({0, 0, 0.5f * float(j)});
        position.push_back({0.001f * float(i), 0, 0.001f * float(j)});
        normal.push_back({0, -1, 0});
      }
  }
  CutSkin skin() const { return {position, normal, rim, outwards, around}; }
};

TEST(CutOoze, BloodRunsOverLowerLipsOnly) {
  const SlitWall wall;
  render::Liquid liquid;
  liquid.down = wall.down;
  list_ooze(wall.skin(), liquid);
  ASSERT_GT(liquid.splats.size(), 5u);
  for (const render::Splat& s : liquid.splats) {
    EXPECT_LT(s.from.z, -0.002f) << "below the slit";
    EXPECT_LT(s.to.z, s.from.z) << "it runs down";
  }
}

TEST(CutOoze, ASheetHangsBelowALowerLip) {
  const SlitWall wall;
  const std::vector<float> sheet = sheet_below(wall.skin(), wall.position, wall.down);
  float below = 0;
  for (std::size_t k = 0; k < sheet.size(); ++k) {
    const Vec3f p = wall.position[wall.around[k]];
    if (p.z > 0 || p.z < -0.012f || std::fabs(p.x) > 0.007f)
      EXPECT_EQ(sheet[k], 0) << "at " << p.x << ' ' << p.z;
    else
      below = std::max(below, sheet[k]);
  }
  EXPECT_GT(below, 0.9f);
}

TEST(DripStains, LieBelowWhatDripsOnTheFirstGroundThere) {
  MeshBuffer table;  // 10 cm wide, its top 5 cm below the origin
  for (const Vec3f corner : {Vec3f{-1, -1, -1}, Vec3f{1, -1, -1}, Vec3f{1, 1, -1}, Vec3f{-1, 1, -1}})
    table.add(0.05f * corner);
  table.quad(0, 1, 2, 3);
  MeshBuffer floor = table;
  for (Vec3f& p : floor.positions) p.z -= 0.02f;
  DripStains stains;
  stains.add_ground(floor);
  stains.add_ground(table);
  render::Liquid liquid;
  stains.list(std::array{Vec3f{0.01f, 0.02f, 0}}, liquid);
  ASSERT_GT(liquid.splats.size(), 3u);
  for (const render::Splat& s : liquid.splats) {
    EXPECT_NEAR(s.from.z, -0.05f, 1e-6f);
    EXPECT_NEAR(s.normal.z, 1, 1e-6f);
    EXPECT_LT(length(s.from - Vec3f{0.01f, 0.02f, -0.05f}), 0.01f);
  }
  liquid.splats.clear();
  stains.list(std::array{Vec3f{0.2f, 0, 0}, Vec3f{0, 0, 0.2f}}, liquid);
  EXPECT_TRUE(liquid.splats.empty()) << "beside it, and too high to be seen to fall there";
}

TEST(DripStains, RunDownASlope) {
  MeshBuffer slope;  // falls towards +x
  for (const Vec3f corner : {Vec3f{-1, -1, 0.5f}, Vec3f{1, -1, -0.5f}, Vec3f{1, 1, -0.5f}, Vec3f{-1, 1, 0.5f}})
    slope.add(0.05f * corner);
  slope.quad(0, 1, 2, 3);
  DripStains stains;
  stains.add_ground(slope);
  render::Liquid liquid;
  stains.list(std::array{Vec3f{0, 0, 0.05f}}, liquid);
  float lowest = 0, highest = 0;
  for (const render::Splat& s : liquid.splats) lowest = std::max(lowest, s.to.x), highest = std::min(highest, s.from.x);
  EXPECT_GT(lowest, 0.009f);
  EXPECT_GT(highest, -0.007f) << "only specks lie above";
  const std::size_t one = liquid.splats.size();
  stains.list(std::array{Vec3f{0, 0, 0.05f}, Vec3f{0.001f, 0, 0.05f}}, liquid);
  EXPECT_LT(liquid.splats.size(), 3 * one) << "drops that land in one place make one stain";
}

TEST(Cavity, GoesOnFromEveryPointOfAWallsBorderAndLeavesNoGap) {
  const MeshBuffer cavity = cavity_around(pelvis());
  const auto wholly = [&](Vec3d p) {  // how far from its surface
    double least = 1;
    for (std::size_t t = 0; t < cavity.indices.size(); t += 3) {
      const auto at = [&](std::size_t k) { return vec_cast<double>(cavity.positions[cavity.indices[t + k]]); };
      if (length(at(0) - p) < 0.03)
        least = std::min(least, geometry::closest_on_triangle(p, at(0), at(1), at(2)).distance2);
    }
    return std::sqrt(least);
  };
  for (const sim::WallModel& wall : pelvis().walls)
    for (const std::vector<int>& loop : border_loops(wall.skin)) {
      ASSERT_GT(loop.size(), 10u);
      for (std::size_t i = 0; i < loop.size(); i += 7)
        EXPECT_LT(wholly(vec_cast<double>(wall.skin.rest[std::size_t(loop[i])])), 0.0015);
    }
}

TEST(Cavity, OrgansLieInIt) {
  const MeshBuffer cavity = cavity_around(pelvis());
  for (const sim::SolidModel& organ : pelvis().solids) {
    int outside = 0;
    for (std::size_t v = 0; v < organ.fine.rest.size(); v += 40) {
      const Vec3f p = organ.fine.rest[v];
      const auto nearest = std::min_element(cavity.positions.begin(), cavity.positions.end(),
                                            [&](Vec3f a, Vec3f b) { return dot(a - p, a - p) < dot(b - p, b - p); });
      if (length(*nearest - p) < 0.012f)  // others are nearer to a wall of the scene
        outside += dot(p - *nearest, cavity.normals[std::size_t(nearest - cavity.positions.begin())]) < -0.001f;
    }
    EXPECT_EQ(outside, 0) << organ.name;
  }
}

TEST(LiverDome, LeavesTheSimulatedEdgeWithoutAStep) {
  const sim::Model model = scene::compile(scene::read_scene(TROCAR_SOURCE_DIR "/scenes/cutting/scene.json"));
  const tissue::Skin& body = model.skin(0);
  const MeshBuffer dome = LiverShape(body.rest, flat_indices(body)).dome(WallSurface(model));
  ASSERT_GT(dome.indices.size(), 3000u);
  std::vector<std::uint8_t> used(dome.size(), 0);
  for (const std::uint32_t v : dome.indices) used[v] = 1;
  tissue::Box box;
  for (int v = 0; v < body.size(); ++v)
    if (body.at_surface(v)) box.add(body.rest[std::size_t(v)]);
  int close = 0, beyond = 0;
  for (std::uint32_t i = 0; i < dome.size(); ++i) {
    if (!used[i]) continue;
    close += to_nearest(dome.positions[i], body.rest) < 0.003f;
    beyond += dome.positions[i].x < box.low.x - 0.015f || dome.positions[i].x > box.high.x + 0.015f;
  }
  EXPECT_GT(close, 100);   // it begins on the body ...
  EXPECT_GT(beyond, 150);  // ... and goes on to both sides
}

TEST(LiverDome, RoundLigamentComesOverTheMarginAndRunsToTheWall) {
  const sim::Model model = scene::compile(scene::read_scene(TROCAR_SOURCE_DIR "/scenes/cutting/scene.json"));
  const tissue::Skin& body = model.skin(0);
  const WallSurface walls(model);
  const MeshBuffer falciform = LiverShape(body.rest, flat_indices(body)).falciform(walls);
  float margin = 1, wall = 1;  // how near it comes to the one and to the other
  Vec3f low = body.rest.front();
  for (int v = 0; v < body.size(); ++v)
    if (body.at_surface(v) && std::fabs(body.rest[std::size_t(v)].x - falciform.positions[0].x) < 0.004f &&
        body.rest[std::size_t(v)].y < low.y)
      low = body.rest[std::size_t(v)];
  for (const Vec3f& p : falciform.positions) {
    const WallSurface::Place place = walls.nearest(vec_cast<double>(p));
    margin = std::min(margin, length(p - low));
    wall = std::min(wall, float(length(vec_cast<double>(p) - place.point)));
  }
  EXPECT_LT(margin, 0.004f);
  EXPECT_LT(wall, 0.002f);
}

TEST(LiverDome, FollowsItsBodyAndHoldsStillFarFromIt) {
  const sim::Model model = scene::compile(scene::read_scene(TROCAR_SOURCE_DIR "/scenes/cutting/scene.json"));
  auto backend = render::make_null_backend();
  const WallSurface walls(model);
  LiverDome dome(model, 0, LiverShape(model.skin(0).rest, flat_indices(model.skin(0))), walls, *backend);
  sim::State state = sim::initial_state(model);
  const std::vector<Vec3f> before = dome.buffer().positions;
  dome.update(state);
  for (tissue::NodeState& n : state.cuttables[0].nodes) n.z += 0.005f;
  dome.update(state);
  float most = 0, least = 1;
  for (std::size_t i = 0; i < before.size(); ++i) {
    const float way = length(dome.buffer().positions[i] - before[i]);
    most = std::max(most, way);
    least = std::min(least, way);
  }
  EXPECT_NEAR(most, 0.005f, 0.0008f);
  EXPECT_LT(least, 1e-6f);
}

TEST(Drape, EndsBelowWhatIsAroundAndFollowsItsOrgan) {
  auto backend = render::make_null_backend();
  const int bladder = solid_with_look("bladder");
  ASSERT_GE(bladder, 0);
  ASSERT_TRUE(look(pelvis(), "bladder").has(Look::Generator::drape));
  std::vector<OrganDrawing> organs = drawn_organs(*backend);
  Drape drape(pelvis(), bladder, organs, *backend);
  const std::vector<Vec3f> before = drape.buffer().positions;
  std::size_t under_wall = 0, on_organ = 0;
  for (const Vec3f& p : before) {
    on_organ += to_nearest(p, organs[std::size_t(bladder)].positions()) < 0.003f;
    for (const sim::WallModel& w : pelvis().walls) under_wall += to_nearest(p, w.skin.rest) < 0.008f;
  }
  EXPECT_GT(on_organ, 100u);
  EXPECT_GT(under_wall, 30u);
  sim::State state = sim::initial_state(pelvis());
  for (tissue::NodeState& n : state.solids[std::size_t(bladder)].nodes) n.z += 0.005f;
  for (std::size_t i = 0; i < organs.size(); ++i) organs[i].update(state.solids[i]);
  drape.update(organs);
  float most = 0, least = 1;
  for (std::size_t i = 0; i < before.size(); ++i) {
    const float by = length(drape.buffer().positions[i] - before[i]);
    most = std::max(most, by);
    least = std::min(least, by);
  }
  EXPECT_NEAR(most, 0.005f, 0.0015f);  // over the organ
  EXPECT_LT(least, 1e-5f);             // at the wall
}

TEST(OrganDrawing, GivesWayToAnInstrumentAndComesBack) {
  auto backend = render::make_null_backend();
  const int uterus = solid_with_look("uterus");
  ASSERT_GE(uterus, 0);
  const sim::SolidModel& solid = pelvis().solids[std::size_t(uterus)];
  OrganDrawing organ(solid, {}, std::vector<Paint>(solid.fine.rest.size()), *backend);
  const tissue::NetworkState state = tissue::rest_state(solid.network);
  organ.update(state);
  const std::vector<Vec3f> before(organ.positions().begin(), organ.positions().end());
  std::size_t top = 0;
  for (std::size_t i = 0; i < before.size(); ++i)
    if (before[i].z > before[top].z) top = i;
  const Vec3d at = vec_cast<double>(before[top]);
  const collision::Capsule rod{at + Vec3d{-0.05, 0, 0.0012}, at + Vec3d{0.05, 0, 0.0012}, 0.0025};
  organ.update(state, {}, {&rod, 1});
  for (const Vec3f& p : organ.positions()) {
    const Vec3d q = vec_cast<double>(p);
    ASSERT_GT(length(q - nearest_on_axis(rod, q)), rod.radius - 1e-4);
  }
  EXPECT_GT(length(organ.positions()[top] - before[top]), 0.001f);
  organ.update(state);
  for (std::size_t i = 0; i < before.size(); ++i) ASSERT_LT(length(organ.positions()[i] - before[i]), 1e-6f);
}

TEST(SceneView, EveryInstrumentOfEveryRackIsDrawn) {
  auto backend = render::make_null_backend();
  SceneView view(pelvis(), *backend);
  sim::State state = sim::initial_state(pelvis());
  for (std::size_t h = 0; h < pelvis().hands.size(); ++h)
    for (std::size_t i = 0; i < pelvis().hands[h].rack.size(); ++i) {
      state.tools[h].instrument = int(i);
      const render::Frame frame = view.frame(state, {});
      EXPECT_NO_THROW(render::draw_frame(*backend, frame, render::Target::off_screen(64, 48)));
      const auto metal = std::count_if(frame.items.begin(), frame.items.end(), [](const render::DrawItem& item) {
        return item.material.shading == render::Shading::metal;
      });
      EXPECT_GE(metal, std::ptrdiff_t(2 * pelvis().hands.size())) << pelvis().hands[h].rack[i].name;
      EXPECT_FALSE(instrument_parts(pelvis().hands[h].rack[i]).empty());
    }
}

TEST(SceneView, InstrumentsShadeFromWhereTheyAre) {
  auto backend = render::make_null_backend();
  SceneView view(pelvis(), *backend);
  const sim::State state = sim::initial_state(pelvis());
  const render::Frame frame = view.frame(state, {});
  ASSERT_EQ(frame.rods.size(), 3 * pelvis().hands.size());
  ASSERT_LE(frame.rods.size(), std::size_t(render::kMaxRods));
  for (std::size_t h = 0; h < pelvis().hands.size(); ++h) {
    const interactions::ToolState& tool = state.tools[h];
    const interactions::ToolShape shape = shape_of(pelvis().tool(state, h), tool.pose(), tool.aperture);
    for (std::size_t k = 0; k < 3; ++k)
      EXPECT_LT(length(vec_cast<double>(frame.rods[3 * h + k].to) - shape.part[k].b), 1e-6);
  }
}

TEST(InstrumentShapes, ASleeveLetsEveryInstrumentOfItsHandThrough) {
  for (const sim::HandModel& hand : pelvis().hands) {
    double widest = 0;
    for (const interactions::ToolModel& tool : hand.rack) widest = std::max(widest, tool.shaft_radius);
    for (const InstrumentPart& part : sleeve_parts(widest, 0.03)) {
      EXPECT_NE(look(pelvis(), part.look).name, "neutral");
      float reach = -1;
      for (const Vec3f& p : part.mesh.positions) {
        reach = std::max(reach, p.z);
        const float far = std::hypot(p.x, p.y);
        EXPECT_TRUE(far < 1e-6f || far > float(widest) - 1e-6f) << far;
      }
      EXPECT_NEAR(reach, 0.03f, 0.001f);
    }
  }
}

TEST(Shapes, APlateWithAWindowIsOneClosedSurfaceWithBrokenEdges) {
  const auto circle = [](double radius) {
    return [radius](double u) { return Vec3d{0, radius * std::cos(6.283185 * u), radius * std::sin(6.283185 * u)}; };
  };
  const auto flat = [](double at) { return [at](double, double) { return at; }; };
  const MeshBuffer b =
      plate(circle(2), circle(1), flat(0), flat(1), 32, 4, [](bool, double, double) { return Paint{}; });
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;
  for (std::size_t i = 0; i < b.indices.size(); ++i) ++edges[{b.indices[i], b.indices[i % 3 == 2 ? i - 2 : i + 1]}];
  for (const auto& [edge, count] : edges) {
    EXPECT_EQ(count, 1);
    EXPECT_EQ(edges.count({edge.second, edge.first}), 1u);  // each edge has a triangle on both sides
  }
  std::vector<Vec3f> normals;
  render::vertex_normals(b.positions, b.indices, normals);
  int slanting = 0;
  for (const Vec3f n : normals) slanting += std::fabs(n.x) > 0.2f && std::fabs(n.x) < 0.9f;
  EXPECT_GE(slanting, 4 * 32);
}

TEST(FoldPattern, IsFatAlongTheRootAndSheerBetween) {
  const render::Material& m = look(pelvis(), "mesosalpinx").material;
  EXPECT_TRUE(m.arcade);
  EXPECT_FLOAT_EQ(m.vessel_tile, float(kFoldTile));
  int root = 0, middle = 0, border = 0;
  for (double s = 0; s < 0.08; s += 0.002) {
    root += fold_paint(s, 1).tint;
    middle += fold_paint(s, 0.4).tint;
    border += fold_paint(s, 0).tint;
    EXPECT_FLOAT_EQ(fold_rest(s, 0.5).x, float(s));
  }
  EXPECT_EQ(middle, 0);
  EXPECT_GT(root, border);
  EXPECT_GT(border, 0);
  EXPECT_FLOAT_EQ(2 * fold_rest(0, 1).y, float(kFoldTile));  // the picture's whole height
}

TEST(Relief, ABowelHasThreeBandsWithBulgesBetween) {
  tissue::Skin skin;  // a straight pipe
  constexpr int kAround = 120, kAlong = 80;
  for (int j = 0; j < kAlong; ++j)
    for (int i = 0; i < kAround; ++i) {
      const double a = 2 * std::numbers::pi * i / kAround;
      skin.rest.push_back(vec_cast<float>(Vec3d{0.0012 * j, 0.012 * std::cos(a), 0.012 * std::sin(a)}));
      skin.rest_normal.push_back(vec_cast<float>(Vec3d{0, std::cos(a), std::sin(a)}));
    }
  std::vector<Paint> paint(skin.rest.size());
  const Relief relief{.haustra = 0.002, .haustra_size = 0.02};
  const std::vector<float> height = heights(relief, skin, paint);
  for (int j = 5; j < kAlong - 5; ++j) {
    int bands = 0;
    for (int i = 0; i < kAround; ++i) {
      const auto tint = [&](int k) { return int(paint[std::size_t(j * kAround + k % kAround)].tint); };
      bands += tint(i) < 100 && tint(i + 1) >= 100;
    }
    EXPECT_EQ(bands, 3) << j;
  }
  const auto [low, high] = std::minmax_element(height.begin(), height.end());
  EXPECT_GT(*high - *low, 0.0015f);
  EXPECT_LE(*high, 1e-6f);
}

}  // namespace
}  // namespace trocar::view
