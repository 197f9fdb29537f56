#include "interpenetration.hpp"

#include <functional>
#include <sstream>

#include <gtest/gtest.h>

#include "../geometry/shapes.hpp"
#include "small_scene.hpp"

namespace trocar {
namespace {

constexpr double kMm = 1e-3;

BodySurface closed(const char* name, const geometry::TriMesh& mesh, Vec3d shift) {
  BodySurface s;
  s.name = name;
  s.triangles = mesh.triangles;
  for (const Vec3d& p : mesh.positions) s.points.push_back(p + shift);
  return s;
}
BodySurface box(const char* name, Vec3d low, Vec3d size) {
  return closed(name, geometry::box_mesh(kMm * size), kMm * low);
}
BodySurface sphere(const char* name, Vec3d middle, double radius, int levels = 4) {
  return closed(name, geometry::sphere_mesh(kMm * radius, levels), kMm * middle);
}

/// Of points place(u, v) in columns and rows; its upper side is that of u x v.
BodySurface grid(const char* name, int columns, int rows, const std::function<Vec3d(int, int)>& place) {
  BodySurface s;
  s.name = name;
  s.kind = BodySurface::sheet;
  for (int v = 0; v < rows; ++v)
    for (int u = 0; u < columns; ++u) s.points.push_back(kMm * place(u, v));
  for (int v = 0; v + 1 < rows; ++v)
    for (int u = 0; u + 1 < columns; ++u) {
      const int a = v * columns + u, b = a + 1, c = a + columns, d = c + 1;
      s.triangles.push_back({a, b, d});
      s.triangles.push_back({a, d, c});
    }
  return s;
}
/// At z = 0, 60 mm wide, faces up.
BodySurface flat(BodySurface::Kind kind, double half_thickness_mm) {
  BodySurface s = grid("sheet", 31, 31, [](int u, int v) { return Vec3d{2.0 * u - 30.1, 2.0 * v - 29.7, 0}; });
  s.kind = kind;
  s.half_thickness = kMm * half_thickness_mm;
  return s;
}

BodySurface tube(const char* name, const std::vector<Vec3d>& path, double radius) {
  BodySurface s;
  s.name = name;
  s.kind = BodySurface::tube;
  for (const Vec3d& p : path) s.points.push_back(kMm * p);
  for (int i = 0; i + 1 < int(path.size()); ++i) s.capsules.push_back({i, i + 1, kMm * radius});
  if (path.size() == 1) s.capsules.push_back({0, 0, kMm * radius});
  return s;
}

/// Of the pair [mm].
double depth_of(const BodySurface& a, const BodySurface& b) {
  return measure(std::vector<BodySurface>{a, b}).depth(0, 1) / kMm;
}
double own_depth_of(const BodySurface& a) { return measure(std::vector<BodySurface>{a}).depth(0, 0) / kMm; }

TEST(Interpenetration, BoxesAreAsDeepAsTheyOverlap) {
  const BodySurface a = box("a", {0, 0, 0}, {20, 20, 20});
  EXPECT_NEAR(depth_of(a, box("b", {17, 5, 5}, {10, 10, 10})), 3, 1e-6);
  EXPECT_NEAR(depth_of(a, box("b", {15, 5, 5}, {10, 10, 10})), 5, 1e-6);
  EXPECT_NEAR(depth_of(box("b", {17, 5, 5}, {10, 10, 10}), a), 3, 1e-6);
}

TEST(Interpenetration, SpheresAreAsDeepAsTheyOverlap) {
  const BodySurface a = sphere("a", {0, 0, 0}, 10);
  EXPECT_NEAR(depth_of(a, sphere("b", {17, 0, 0}, 10)), 3, 0.05);
  EXPECT_NEAR(depth_of(a, sphere("b", {19.5, 0, 0}, 10)), 0.5, 0.05);
}

TEST(Interpenetration, EdgesCountWhereNoVertexIsInside) {
  const BodySurface a = box("a", {-50, -5, 0}, {100, 10, 10});
  EXPECT_NEAR(depth_of(a, box("b", {-5, -50, 6}, {10, 100, 10})), 4, 1e-6);
}

TEST(Interpenetration, BodyInsideAnotherIsAsDeepAsItsDeepestVertex) {
  EXPECT_NEAR(depth_of(box("a", {0, 0, 0}, {20, 20, 20}), box("b", {9, 9, 9}, {2, 2, 2})), 9, 1e-6);
}

TEST(Interpenetration, BodiesJustApartHaveNoDepth) {
  const BodySurface a = box("a", {0, 0, 0}, {20, 20, 20});
  EXPECT_EQ(depth_of(a, box("b", {20.001, 5, 5}, {10, 10, 10})), 0);
  EXPECT_EQ(depth_of(a, box("b", {20, 5, 5}, {10, 10, 10})), 0) << "faces touch";
  EXPECT_EQ(depth_of(a, sphere("b", {30.001, 10, 10}, 10)), 0);
  EXPECT_EQ(depth_of(a, tube("b", {{-10, 10, 22.001}, {30, 10, 22.001}}, 2)), 0);
  EXPECT_EQ(depth_of(flat(BodySurface::sheet, 0.5), box("b", {-5, -5, 0.501}, {10, 10, 10})), 0);
  EXPECT_EQ(depth_of(flat(BodySurface::wall, 0), box("b", {-5, -5, 0.001}, {10, 10, 10})), 0);
  EXPECT_EQ(depth_of(tube("a", {{-10, 0, 0}, {10, 0, 0}}, 2), tube("b", {{0, -10, 4.501}, {0, 10, 4.501}}, 2.5)), 0);
}

TEST(Interpenetration, SkinWithHolesStillHasAnInside) {
  BodySurface a = sphere("a", {0, 0, 0}, 10);
  a.triangles.erase(a.triangles.begin(), a.triangles.begin() + 40);
  EXPECT_NEAR(depth_of(a, sphere("b", {-17, 0, 0}, 10)), 3, 0.1);
}

TEST(Interpenetration, BoxPushedThroughASheetReachesBeyondIt) {
  const BodySurface sheet = flat(BodySurface::sheet, 0.5);
  EXPECT_NEAR(depth_of(sheet, box("b", {-10, -10, -4}, {20, 20, 20})), 4.5, 1e-6);
  EXPECT_NEAR(depth_of(sheet, box("b", {-10, -10, -16}, {20, 20, 20})), 4.5, 1e-6) << "the smaller part counts";
  EXPECT_NEAR(depth_of(sheet, box("b", {-2, -2, -8}, {4, 4, 20})), 8.5, 1e-6) << "also where the box is thin";
}

TEST(Interpenetration, BorderOfASheetInABoxIsAsDeepAsItIsIn) {
  const BodySurface sheet = flat(BodySurface::sheet, 0.5);  // its border: x = 29.9
  EXPECT_NEAR(depth_of(sheet, box("b", {26.9, -20, -10}, {20, 40, 20})), 3.5, 1e-6);
}

TEST(Interpenetration, SheetTouchesWithinItsThickness) {
  EXPECT_NEAR(depth_of(flat(BodySurface::sheet, 0.5), box("b", {-5, -5, 0.3}, {10, 10, 10})), 0.2, 1e-6);
  EXPECT_NEAR(depth_of(flat(BodySurface::sheet, 0.5), box("b", {-5, -5, -10.3}, {10, 10, 10})), 0.2, 1e-6);
}

TEST(Interpenetration, SheetThroughASheetReachesBeyondIt) {
  BodySurface tip = grid("tip", 5, 12, [](int u, int v) { return Vec3d{1.3, 3.0 * u - 6.2, 3.0 * v - 7}; });
  EXPECT_NEAR(depth_of(flat(BodySurface::sheet, 0.5), tip), 7.5, 1e-6);
}

TEST(Interpenetration, SheetsThatSlitEachOtherAreAsDeepAsTheSlit) {
  // Along y = 0.3, from 4 mm within the other one's border on.
  const BodySurface other = grid("other", 36, 21, [](int u, int v) { return Vec3d{25.9 + u, 0.3, 2.0 * v - 20.7}; });
  EXPECT_NEAR(depth_of(flat(BodySurface::sheet, 0.5), other), 4.5, 0.6);
  EXPECT_GT(depth_of(flat(BodySurface::wall, 0), other), 3.4);
}

TEST(Interpenetration, PartBehindAWallCounts) {
  const BodySurface wall = flat(BodySurface::wall, 0);
  EXPECT_NEAR(depth_of(wall, box("b", {-10, -10, -4}, {20, 20, 20})), 4, 1e-6);
  EXPECT_NEAR(depth_of(wall, box("b", {-10, -10, -14}, {20, 20, 20})), 14, 1e-6);
  EXPECT_NEAR(depth_of(wall, tube("b", {{0, 0, -5}, {0, 0, 20}}, 2)), 7, 1e-6);
}

TEST(Interpenetration, TubeThroughASphereIsAsDeepAsItsDeepestSurface) {
  const BodySurface a = sphere("a", {0, 0, 0}, 20);
  EXPECT_NEAR(depth_of(a, tube("b", {{-30, 0, 15}, {30, 0, 15}}, 2)), 7, 0.1);
  EXPECT_NEAR(depth_of(a, tube("b", {{-30, 0, 21}, {30, 0, 21}}, 2)), 1, 0.1);
  EXPECT_NEAR(depth_of(tube("b", {{-30, 0, 15}, {30, 0, 15}}, 2), a), 7, 0.1);
}

TEST(Interpenetration, TubeThroughASheetReachesBeyondIt) {
  const BodySurface sheet = flat(BodySurface::sheet, 0.5);
  EXPECT_NEAR(depth_of(sheet, tube("b", {{0, 0, -6}, {0, 0, 10}, {0, 0, 40}}, 2)), 8.5, 1e-6);
  EXPECT_NEAR(depth_of(sheet, tube("b", {{-20, 0, 2}, {20, 0, 2}}, 2)), 0.5, 1e-6) << "it lies on the sheet";
}

TEST(Interpenetration, TubesOverlapByTheirRadii) {
  const BodySurface a = tube("a", {{-10, 0, 0}, {10, 0, 0}}, 2);
  EXPECT_NEAR(depth_of(a, tube("b", {{0, -10, 3}, {0, 10, 3}}, 2.5)), 1.5, 1e-6);
  EXPECT_NEAR(depth_of(a, tube("b", {{0, -10, 0}, {0, 10, 0}}, 2.5)), 2.5, 1e-6) << "at most the larger radius";
}

TEST(Interpenetration, TubeFoldedOntoItselfOverlaps) {
  std::vector<Vec3d> bent;
  for (int i = 0; i <= 20; ++i) bent.push_back({2.0 * i, 0, 0});
  EXPECT_EQ(own_depth_of(tube("a", bent, 2)), 0);
  for (int i = 0; i <= 20; ++i) bent.push_back({40 - 2.0 * i, 0, 3});
  EXPECT_NEAR(own_depth_of(tube("a", bent, 2)), 1, 1e-6);
}

/// A ring of square section, 24 mm wide at its beginning, that tapers to a tip of twice `tip` [mm], which goes as far
/// as `turn` [degrees].
BodySurface tapering_ring(double turn, double tip) {
  constexpr int kSections = 72, kEach = 4, kAround = 4 * kEach;
  BodySurface s;
  s.name = "ring";
  const auto add = [&s](double angle, double out, double up) {
    s.points.push_back(kMm * Vec3d{(60 + out) * std::cos(angle), (60 + out) * std::sin(angle), up});
  };
  const double whole = turn / 180 * std::numbers::pi;
  for (int k = 0; k <= kSections; ++k) {
    const double half = 12 + (tip - 12) * k / kSections;
    for (int i = 0; i < kAround; ++i) {
      const double along = half * (2.0 * (i % kEach) / kEach - 1);
      const Vec3d corner[4] = {{along, -half, 0}, {half, along, 0}, {-along, half, 0}, {-half, -along, 0}};
      add(whole * k / kSections, corner[i / kEach].x, corner[i / kEach].y);
    }
    for (int i = 0; i < kAround && k > 0; ++i) {
      const int a = kAround * (k - 1) + i, b = kAround * (k - 1) + (i + 1) % kAround;
      s.triangles.push_back({a, b, b + kAround});
      s.triangles.push_back({a, b + kAround, a + kAround});
    }
  }
  const int end = kAround * kSections, middle = int(s.points.size());
  add(0, 0, 0), add(whole, 0, 0);
  for (int i = 0; i < kAround; ++i) {
    s.triangles.push_back({(i + 1) % kAround, i, middle});
    s.triangles.push_back({end + i, end + (i + 1) % kAround, middle + 1});
  }
  geometry::TriMesh mesh{s.points, s.triangles};
  EXPECT_TRUE(geometry::check_edges(mesh).closed());
  if (geometry::volume(mesh) < 0)
    for (auto& t : s.triangles) std::swap(t[1], t[2]);
  return s;
}

TEST(Interpenetration, SkinFoldedIntoItselfIsAsDeepAsItsTipIsIn) {
  const double in = std::sin(3.0 / 180 * std::numbers::pi);
  EXPECT_EQ(own_depth_of(tapering_ring(355, 3)), 0);
  EXPECT_NEAR(own_depth_of(tapering_ring(363, 3)), 63 * in, 1e-3);
  EXPECT_NEAR(own_depth_of(tapering_ring(363, 0.5)), 60.5 * in, 1e-3) << "the tip is thinner than that";
}

/// A slab of 40 x 40 x 4 mm whose upper side is dented in its middle.
BodySurface dented_slab(double dent) {
  constexpr int kSide = 21;
  const auto at = [](int u, int v) { return Vec3d{2.0 * u - 20, 2.0 * v - 20, 0}; };
  BodySurface s = grid("slab", kSide, kSide, [&](int u, int v) {
    const Vec3d p = at(u, v);
    const double r = length(p) / 12;
    return p + Vec3d{0, 0, 4 - (r < 1 ? dent * (1 - r * r) : 0)};
  });
  s.kind = BodySurface::closed;
  const BodySurface lower = grid("lower", kSide, kSide, at);
  const int n = int(s.points.size());
  s.points.insert(s.points.end(), lower.points.begin(), lower.points.end());
  for (const auto& t : lower.triangles) s.triangles.push_back({t[0] + n, t[2] + n, t[1] + n});
  std::vector<int> rim;
  for (int u = 0; u + 1 < kSide; ++u) rim.push_back(u);
  for (int v = 0; v + 1 < kSide; ++v) rim.push_back(v * kSide + kSide - 1);
  for (int u = kSide - 1; u > 0; --u) rim.push_back((kSide - 1) * kSide + u);
  for (int v = kSide - 1; v > 0; --v) rim.push_back(v * kSide);
  for (size_t k = 0; k < rim.size(); ++k) {
    const int a = rim[k], b = rim[(k + 1) % rim.size()];
    s.triangles.push_back({a, a + n, b + n});
    s.triangles.push_back({a, b + n, b});
  }
  EXPECT_TRUE(geometry::check_edges({s.points, s.triangles}).closed());
  EXPECT_GT(geometry::volume({s.points, s.triangles}), 0);
  return s;
}

TEST(Interpenetration, SideOfASkinThroughTheOppositeSideIsAsDeepAsItReaches) {
  EXPECT_EQ(own_depth_of(dented_slab(3.9)), 0);
  EXPECT_NEAR(own_depth_of(dented_slab(6)), 2, 1e-6);
}

TEST(Interpenetration, SheetThroughItselfReachesBeyond) {
  // Along x, up, back, and down through itself.
  const std::vector<Vec3d> corners{{0, 0, 0}, {40, 0, 0}, {40, 0, 20}, {20, 0, 20}, {20, 0, -5}};
  std::vector<Vec3d> path{corners[0]};
  for (size_t k = 1; k < corners.size(); ++k)
    for (int i = 1; i <= 7; ++i) path.push_back(corners[k - 1] + i / 7.0 * (corners[k] - corners[k - 1]));
  const auto strip = [&path](int rows) {
    return grid("strip", 8, rows, [&path](int u, int v) { return path[size_t(v)] + Vec3d{0, 3.0 * u, 0}; });
  };
  EXPECT_EQ(own_depth_of(strip(27)), 0) << "its end is above the crossing";
  EXPECT_NEAR(own_depth_of(strip(29)), 5, 1e-6);
}

TEST(Interpenetration, ObjectInAClosedMembraneMeetsItsWallOnly) {
  const BodySurface pouch = sphere("pouch", {0, 0, 0}, 20);
  BodySurface stone = tube("stone", {{5, 0, 0}}, 3);
  EXPECT_GT(depth_of(pouch, stone), 10);
  stone.inside = 0;
  EXPECT_EQ(depth_of(pouch, stone), 0);
  BodySurface at_wall = tube("stone", {{18, 0, 0}}, 3);
  at_wall.inside = 0;
  EXPECT_NEAR(depth_of(pouch, at_wall), 1, 0.05);
}

TEST(Interpenetration, OverlapAtTheStartIsNotGrowth) {
  const BodySurface a = box("a", {0, 0, 0}, {20, 20, 20}), c = box("c", {40, 0, 0}, {20, 20, 20});
  const auto scene = [&](double b_at, double d_at) {
    return measure(
        std::vector<BodySurface>{a, box("b", {b_at, 5, 5}, {10, 10, 10}), c, box("d", {45, 5, d_at}, {10, 10, 10})});
  };
  const Interpenetration start = scene(18, 20), now = scene(16.5, 19.2);
  EXPECT_TRUE(deeper_than(start, start, 0).empty());
  EXPECT_TRUE(deeper_than(now, start, 2 * kMm).empty());
  const std::vector<Growth> grown = deeper_than(now, start, kMm);
  ASSERT_EQ(grown.size(), 1u);
  EXPECT_EQ(text_of(now, grown.front()).substr(0, 14), "a - b: 3.50 mm");
  EXPECT_NEAR(grown.front().before / kMm, 2, 1e-6);
  EXPECT_EQ(deeper_than(now, start, 0.5 * kMm).size(), 2u);
  EXPECT_NEAR(now.depth("d", "c") / kMm, 0.8, 1e-6);
}

TEST(Interpenetration, PrintListsPairsAboveTheLimit) {
  const Interpenetration found =
      measure(std::vector<BodySurface>{box("a", {0, 0, 0}, {20, 20, 20}), box("b", {17, 5, 5}, {10, 10, 10})});
  std::ostringstream all, none;
  print(all, found);
  print(none, found, 3.1 * kMm);
  EXPECT_EQ(all.str().substr(0, 14), "a - b: 3.00 mm");
  EXPECT_EQ(none.str(), "");
}

TEST(Interpenetration, NearlyClosedEnvironmentSurfaceIsClosedAndFacesOutwards) {
  // A shaft with a seam, which faces inwards and is open at its ends; a floor.
  const BodySurface shaft = grid("shaft", 13, 21, [](int u, int v) {
    const double angle = u % 12 * std::numbers::pi / 6;
    return Vec3d{2 * std::cos(angle), 2 * std::sin(angle), 40 - 2.0 * v};
  });
  const BodySurface floor = flat(BodySurface::sheet, 0);
  sim::Model m;
  for (const BodySurface* s : {&shaft, &floor}) {
    m.walls.emplace_back();
    for (const Vec3d& p : s->points) m.walls.back().skin.rest.push_back(vec_cast<float>(p));
    m.walls.back().skin.triangles = s->triangles;
  }
  const std::vector<BodySurface> all = surfaces_of(m, {});
  ASSERT_EQ(all.size(), 2u);
  EXPECT_EQ(all[0].kind, BodySurface::closed);
  EXPECT_EQ(all[0].points.size(), 12u * 21);
  EXPECT_GT(geometry::volume({all[0].points, all[0].triangles}), 0);
  EXPECT_NEAR(depth_of(all[0], box("b", {1, -5, 10}, {10, 10, 10})), 1, 0.01);
  EXPECT_EQ(all[1].kind, BodySurface::wall);
}

/// Of the small scene.
int number_of(const std::vector<BodySurface>& surfaces, const std::string& name) {
  for (size_t i = 0; i < surfaces.size(); ++i)
    if (surfaces[i].name == name) return int(i);
  ADD_FAILURE() << "no surface " << name;
  return 0;
}

TEST(Interpenetration, SkinsOfASceneAreClosedAndFaceOutwards) {
  const sim::Model& m = small::model();
  const std::vector<BodySurface> all = surfaces_of(m, sim::initial_state(m));
  for (const char* name : {"organ", "pad", "bar"}) {
    const BodySurface& s = all[size_t(number_of(all, name))];
    EXPECT_TRUE(geometry::check_edges({s.points, s.triangles}).closed()) << name;
    EXPECT_GT(geometry::volume({s.points, s.triangles}), 0) << name;
  }
}

TEST(Interpenetration, TrianglesThatACutHasPartedAreNotThere) {
  const sim::Model& m = small::model();
  sim::State s = sim::initial_state(m);
  const auto triangles = [&](const char* name) {
    const std::vector<BodySurface> all = surfaces_of(m, s);
    return all[size_t(number_of(all, name))].triangles.size();
  };
  const size_t organ = triangles("organ"), fold = triangles("fold");
  ASSERT_EQ(m.solids[0].name, "organ");
  s.parted[0][3] = 1;
  s.torn[0][2] = 1;
  EXPECT_EQ(triangles("organ"), organ - 1);
  EXPECT_EQ(triangles("fold"), fold - 1);
}

TEST(Interpenetration, SceneIsMeasuredAsItIsNow) {
  const sim::Model& m = small::model();
  sim::State s = sim::initial_state(m);
  const Interpenetration start = measure(m, s);
  EXPECT_EQ(start.depth("tube", "pad"), 0) << "0.5 mm apart";
  EXPECT_GT(start.depth("tube", "organ"), kMm) << "it grows out of it";
  for (const Overlap& o : start.overlaps) {
    if (text_of(start, o).starts_with("organ - tube")) {
      EXPECT_TRUE(o.attached);
    }
  }
  for (Vec3d& p : s.strands[small::kTube].x) p.z -= 2 * kMm;
  const Interpenetration now = measure(m, s);
  EXPECT_NEAR(now.depth("tube", "pad") / kMm, 1.5, 0.2);
  const std::vector<Growth> grown = deeper_than(now, start, kMm);
  EXPECT_TRUE(std::any_of(grown.begin(), grown.end(),
                          [&](const Growth& g) { return text_of(now, g).starts_with("pad - tube: "); }));
}

TEST(Interpenetration, TetrahedralBodyIsMeasuredWithItsCuts) {
  const sim::Model& m = small::model();
  sim::State s = sim::initial_state(m);
  const auto bar = [&] {
    const std::vector<BodySurface> all = surfaces_of(m, s);
    return all[size_t(number_of(all, "bar"))];
  };
  const BodySurface whole = bar();
  const double x = 0.02;
  const tissue::CuttableModel& body = m.cuttables[0].body;
  tissue::CuttableWork work = tissue::make_work(body);
  const geometry::Blade blade = geometry::square_blade({x, small::kBarY, 0}, {1, 0, 0}, 0.02);
  EXPECT_GT(tissue::cut(body, blade, s.cuttables[0], work).parted, 0);
  const BodySurface cut = bar();
  EXPECT_GT(cut.triangles.size(), whole.triangles.size());
  EXPECT_LT(own_depth_of(cut), 1e-3) << "lips lie on each other";
  // One end 1 mm into the other, along the bar; the lips are faces of cells and slant.
  tissue::make_current(body, s.cuttables[0], work);
  ASSERT_EQ(work.parts, 2);
  const Vec3d way{body.drawn.rest[0].x < x ? -kMm : kMm, 0, 0};
  for (int n = 0; n < s.cuttables[0].tets.nodes; ++n)
    if (work.part[size_t(n)] != work.part[0])
      tissue::set_position(body, s.cuttables[0], n, tissue::position(body, s.cuttables[0], n) + way);
  const double in = own_depth_of(bar());
  EXPECT_GT(in, 0.4);
  EXPECT_LT(in, 1.001);
}

}  // namespace
}  // namespace trocar
