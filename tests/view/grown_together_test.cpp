// That the drawn anatomy hangs together: collars where strands grow out of organs and walls, ridges of peritoneum over
// ligaments, adhesions, and folds that reach a wall. None of it may show an end or an edge.
#include <algorithm>
#include <cmath>
#include <map>

#include <gtest/gtest.h>

#include <trocar/geometry/surfaces/nearest.hpp>
#include <trocar/render/backend/backend.hpp>
#include <trocar/scene/compile/compile.hpp>
#include <trocar/scene/files/reader.hpp>
#include <trocar/view/anatomy/adhesions.hpp>
#include <trocar/view/anatomy/bowel_loops.hpp>
#include <trocar/view/anatomy/joint.hpp>
#include <trocar/view/anatomy/ridge.hpp>
#include <trocar/view/bodies/cavity.hpp>
#include <trocar/view/bodies/sheet_crescent.hpp>
#include <trocar/view/bodies/sheet_drawing.hpp>
#include <trocar/view/bodies/vessel_drawing.hpp>
#include <trocar/view/scene/scene_view.hpp>

#include "pelvis.hpp"

namespace trocar::view {
namespace {

const WallSurface& walls() {
  static const WallSurface surface(pelvis());
  return surface;
}

/// The nearest place on an organ's drawn skin, and the skin's normal there.
struct OnSkin {
  double away = 1;
  Vec3d normal;
};
OnSkin on_skin(Vec3f p, const OrganDrawing& organ, const tissue::Skin& skin) {
  OnSkin best;
  for (const auto& t : skin.triangles) {
    const auto corner = [&](std::size_t k) { return vec_cast<double>(organ.positions()[std::size_t(t[k])]); };
    const auto at = geometry::closest_on_triangle(vec_cast<double>(p), corner(0), corner(1), corner(2));
    if (at.distance2 >= best.away * best.away) continue;
    best.away = std::sqrt(at.distance2);
    const auto normal = [&](std::size_t k) { return vec_cast<double>(organ.normals()[std::size_t(t[k])]); };
    best.normal = normalised(at.weights.x * normal(0) + at.weights.y * normal(1) + at.weights.z * normal(2));
  }
  return best;
}

/// A strand of the pelvis and the joint at its start.
struct Grown {
  TubeDrawing tube;
  std::size_t organ;
  Joint joint;
};
Grown grown(int strand, const std::vector<OrganDrawing>& organs, render::Backend& backend) {
  TubeDrawing tube(pelvis(), strand, {}, &walls());
  tube.create(std::vector<Paint>(tube.drawn().positions.size()), backend);
  const auto organ = std::size_t(pelvis().strands[std::size_t(strand)].start.organ());
  Joint joint(tube, true, organs[organ], pelvis().solids[organ].fine, backend);
  return {std::move(tube), organ, std::move(joint)};
}

TEST(Joint, MeetsItsOrganWithoutAStepOrAnEdge) {
  const auto backend = render::make_null_backend();
  const std::vector<OrganDrawing> organs = drawn_organs(*backend);
  int joints = 0;
  for (int i = 0; i < int(pelvis().strands.size()); ++i) {
    if (pelvis().strands[std::size_t(i)].start.kind != sim::StrandEndModel::hosted) continue;
    const Grown g = grown(i, organs, *backend);
    const tissue::Skin& skin = pelvis().solids[g.organ].fine;
    const std::size_t sides = std::size_t(g.joint.sides()), rows = g.joint.buffer().positions.size() / sides;
    for (std::size_t k = 0; k < sides; ++k) {
      const std::size_t border = (rows - 2) * sides + k;  // the last row is tucked below the skin
      const OnSkin at = on_skin(g.joint.buffer().positions[border], organs[g.organ], skin);
      EXPECT_LT(at.away, 0.0003);
      EXPECT_GT(dot(at.normal, vec_cast<double>(g.joint.buffer().normals[border])), 0.97);
      const OnSkin tucked = on_skin(g.joint.buffer().positions[border + sides], organs[g.organ], skin);
      EXPECT_LT(tucked.away, 0.0012);
    }
    ++joints;
  }
  EXPECT_GE(joints, 10);
}

TEST(Joint, BeginsInsideItsStrandAndMovesWithIt) {
  const auto backend = render::make_null_backend();
  const std::vector<OrganDrawing> organs = drawn_organs(*backend);
  const int strand = pelvis().strand_index("tube_left");
  Grown g = grown(strand, organs, *backend);
  sim::State state = sim::initial_state(pelvis());
  for (const bool moved : {false, true}) {
    if (moved)
      for (std::size_t i = 2; i < 8; ++i) state.strands[std::size_t(strand)].x[i].z += 0.004;
    g.tube.update(state);
    g.joint.update(g.tube, &organs[g.organ]);
    const TubeNeck& neck = g.tube.neck(true);
    ASSERT_TRUE(neck.there);
    for (int k = 0; k < g.joint.sides(); ++k) {
      const double out = length(vec_cast<double>(g.joint.buffer().positions[std::size_t(k)]) - neck.centre);
      EXPECT_LT(out, length(vec_cast<double>(neck.ring[std::size_t(k)]) - neck.centre));
    }
  }
}

TEST(Joint, OfAStrandThatIsCutOffShortIsALowMound) {
  const auto backend = render::make_null_backend();
  const std::vector<OrganDrawing> organs = drawn_organs(*backend);
  const int strand = pelvis().strand_index("tube_left");
  Grown g = grown(strand, organs, *backend);
  sim::State state = sim::initial_state(pelvis());
  state.cut_count = 1;
  state.cuts[0].strand = strand;
  state.cuts[0].s = 0.002;
  state.cuts[0].fraction = 1;
  tissue::cut_element(state.strands[std::size_t(strand)], 0);
  g.tube.update(state);
  g.joint.update(g.tube, &organs[g.organ]);
  EXPECT_FALSE(g.tube.neck(true).there);
  for (const Vec3f& p : g.joint.buffer().positions)
    EXPECT_LT(on_skin(p, organs[g.organ], pelvis().solids[g.organ].fine).away, 0.003);
}

TEST(Joint, ARootDeepInItsOrganIsDrawableAllTheSame) {
  // Shipped scenes have their roots within 1.5 mm of the skin; who shapes an organ may not.
  // not know.
  scene::Description d = scene::read_scene(TROCAR_SOURCE_DIR "/scenes/gynaecology/scene.json");
  for (scene::Strand& s : d.strands)
    if (s.name == "ovarian_ligament_left")
      s.centreline.front() += 0.0025 * normalised(s.centreline.front() - s.centreline[1]);
  const sim::Model m = scene::compile(d);
  const auto backend = render::make_null_backend();
  EXPECT_NO_THROW(SceneView(m, *backend)) << "the backend refuses what is not finite";
}

TEST(Ridge, RunsFromItsLigamentToTheWallAndEndsBelowThat) {
  const auto backend = render::make_null_backend();
  int ridges = 0;
  for (int i = 0; i < int(pelvis().strands.size()); ++i) {
    if (pelvis().strands[std::size_t(i)].end.kind != sim::StrandEndModel::fixed) continue;
    const TubeDrawing tube(pelvis(), i, {}, &walls());
    if (Ridge::meets_head_on(pelvis(), tube, i, walls())) continue;
    const Ridge ridge(pelvis(), tube, i, walls(), *backend);
    const tissue::StrandState rest = tissue::rest_state(pelvis().strand_bodies[std::size_t(i)].model);
    double to_ligament = 1, to_wall = 1;
    for (const Vec3f& f : ridge.buffer().positions) {
      const Vec3d p = vec_cast<double>(f);
      for (const Vec3d& x : rest.x) to_ligament = std::min(to_ligament, length(p - x));
      const WallSurface::Place wall = walls().nearest(p);
      to_wall = std::min(to_wall, dot(p - wall.point, wall.normal));
    }
    EXPECT_LT(to_ligament, 0.004);
    EXPECT_LT(to_wall, -0.0005) << "its border is tucked under the wall";
    ++ridges;
  }
  EXPECT_EQ(ridges, 4);
}

TEST(Ridge, OfALigamentThatCarriesNothingCoversItAndIsLostInTheWall) {
  const auto backend = render::make_null_backend();
  int covered = 0;
  for (int i = 0; i < int(pelvis().strands.size()); ++i) {
    if (pelvis().strands[std::size_t(i)].name.find("uterosacral") == std::string::npos) continue;
    const TubeDrawing tube(pelvis(), i, {}, &walls());
    const Ridge ridge(pelvis(), tube, i, walls(), *backend);
    const interactions::StrandBody& body = pelvis().strand_bodies[std::size_t(i)];
    for (const Vec3f& f : ridge.buffer().positions) {  // none of it lies within the ligament, from its middle on
      const Vec3d p = vec_cast<double>(f);
      for (int n = body.nodes() / 2; n + 1 < body.nodes(); ++n) {
        const Vec3d x = body.model.rest[std::size_t(n)];
        if (dot(x - walls().nearest(x).point, walls().nearest(x).normal) < 0.002) continue;
        EXPECT_GT(length(p - x), 0.9 * pelvis().strands[std::size_t(i)].outer[std::size_t(n)]);
      }
    }
    double highest = -1;  // its last section
    for (const std::size_t flank : {1u, 2u})
      for (std::size_t r = 1; r <= 12; ++r) {
        const Vec3d p = vec_cast<double>(ridge.buffer().positions[flank * ridge.buffer().size() / 2 - r]);
        highest = std::max(highest, dot(p - walls().nearest(p).point, walls().nearest(p).normal));
      }
    EXPECT_LT(highest, 0.0003) << "no end of it stands out of the wall";
    ++covered;
  }
  EXPECT_EQ(covered, 2);
}

TEST(SheetCrescent, LeavesItsStrandAndItsWallAlongThemAndHasAThinBorder) {
  const auto backend = render::make_null_backend();
  int crescents = 0;
  for (int i = 0; i < int(pelvis().drawn_folds.size()); ++i) {
    const sim::DrawnFold& sheet = pelvis().drawn_folds[std::size_t(i)];
    if (sheet.name.find("front") == std::string::npos) continue;
    const SheetDrawing drawn(pelvis(), i, *backend, {}, &walls());
    const interactions::StrandBody& tube = pelvis().strand_bodies[std::size_t(sheet.strand)];
    const Vec3d tip = point_at(tube, sim::initial_state(pelvis()).strands[std::size_t(sheet.strand)],
                               place_at(tube, sheet.to + SheetCrescent::kAlong));
    double to_tip = 1;
    int at_wall = 0;
    for (std::size_t v = 0; v < drawn.buffer().positions.size(); ++v) {
      const Vec3d p = vec_cast<double>(drawn.buffer().positions[v]);
      to_tip = std::min(to_tip, length(p - tip));
      const WallSurface::Place wall = walls().nearest(p);
      if (length(p - wall.point) < 0.009 && drawn.buffer().paint[v].openness < 20) ++at_wall;
    }
    EXPECT_LT(to_tip, 0.004) << "it narrows along the tube";
    EXPECT_GT(at_wall, 6) << "and is lost where it meets the wall";
    ++crescents;
  }
  EXPECT_EQ(crescents, 2);
  for (int r = 0; r < 9; ++r) {
    const int border = SheetCrescent::paint(SheetCrescent::kSteps, r / 10.0, false).openness;
    EXPECT_GT(border, 100) << "it does not run out into a mist";
    EXPECT_LT(border, SheetCrescent::paint(1, r / 10.0, false).openness - 50) << "and is sheerer than what it ends";
  }
  EXPECT_LT(SheetCrescent::paint(SheetCrescent::kSteps, 1, false).openness, 10) << "but in the wall";
}

TEST(SheetCrescent, OfTheBroadLigamentGoesOnAlongTheInfundibulopelvicOneAndFollowsIt) {
  const auto backend = render::make_null_backend();
  int hung = 0;
  for (int i = 0; i < int(pelvis().drawn_folds.size()); ++i) {
    const std::string& name = pelvis().drawn_folds[std::size_t(i)].name;
    if (name.find("front") == std::string::npos) continue;
    const int ligament = pelvis().strand_index("infundibulopelvic_ligament" + name.substr(name.rfind('_')));
    ASSERT_GE(ligament, 0);
    const interactions::StrandBody& body = pelvis().strand_bodies[std::size_t(ligament)];
    SheetDrawing sheet(pelvis(), i, *backend, {}, &walls());
    sim::State state = sim::initial_state(pelvis());
    for (const double moved : {0.0, 0.005}) {
      for (Vec3d& x : state.strands[std::size_t(ligament)].x) x.z += moved;
      sheet.update(state);
      for (const double share : {0.5, 0.7, 0.9}) {
        const Vec3d on = point_at(body, state.strands[std::size_t(ligament)], place_at(body, share * body.length()));
        double least = 1;
        for (const Vec3f& p : sheet.buffer().positions) least = std::min(least, length(vec_cast<double>(p) - on));
        EXPECT_LT(least, 0.003) << "no window between them";
      }
    }
    ++hung;
  }
  EXPECT_EQ(hung, 2);
}

TEST(Ridge, ARoundLigamentMeetsTheWallHeadOnAndNeedsNone) {
  for (int i = 0; i < int(pelvis().strands.size()); ++i) {
    if (pelvis().strands[std::size_t(i)].end.kind != sim::StrandEndModel::fixed) continue;
    const TubeDrawing tube(pelvis(), i, {}, &walls());
    const bool round = pelvis().strands[std::size_t(i)].name.find("round") != std::string::npos;
    EXPECT_EQ(Ridge::meets_head_on(pelvis(), tube, i, walls()), round);
  }
}

TEST(Adhesions, TaperBetweenTwoFeetThatLieInWhatTheyHangOn) {
  const auto backend = render::make_null_backend();
  const std::vector<OrganDrawing> organs = drawn_organs(*backend);
  const Adhesions adhesions(organs, pelvis(), walls(), {}, *backend);
  constexpr std::size_t kRow = Adhesions::kAcross, kVeil = kRow * Adhesions::kAlong;
  const std::vector<Vec3f>& p = adhesions.buffer().positions;
  ASSERT_GE(p.size(), 3 * kVeil);
  for (std::size_t v = 0; v + kVeil <= p.size(); v += kVeil) {
    const auto width = [&](int row) {
      const std::size_t at = v + std::size_t(row) * kRow;
      return length(p[at] - p[at + kRow - 1]);
    };
    EXPECT_LT(width(Adhesions::kAlong / 2), 0.35f * (width(0) + width(Adhesions::kAlong - 1)));
    for (std::size_t j = 0; j < kRow; ++j) {
      const Vec3d foot = vec_cast<double>(p[v + kVeil - kRow + j]);
      const WallSurface::Place wall = walls().nearest(foot);
      EXPECT_LT(dot(foot - wall.point, wall.normal), 0.0002) << "below the wall";
      double to_organ = 1;
      for (std::size_t o = 0; o < organs.size(); ++o)
        to_organ = std::min(to_organ, on_skin(p[v + j], organs[o], pelvis().solids[o].fine).away);
      EXPECT_LT(to_organ, 0.0025);
    }
  }
}

TEST(Adhesions, AreWebsWithoutAnOutlineOrAnEnd) {
  const auto backend = render::make_null_backend();
  const std::vector<OrganDrawing> organs = drawn_organs(*backend);
  const Adhesions adhesions(organs, pelvis(), walls(), {}, *backend);
  constexpr std::size_t kRow = Adhesions::kAcross, kVeil = kRow * Adhesions::kAlong;
  const std::vector<Paint>& paint = adhesions.buffer().paint;
  int sheer = 0, dense = 0;
  for (std::size_t v = 0; v < paint.size(); ++v) {
    const std::size_t i = v % kVeil / kRow, j = v % kRow;
    if (i == 0 || i + 1 == Adhesions::kAlong) {
      EXPECT_LT(paint[v].openness, 6) << "a foot";  // surface.frag: nothing below 2 %
    } else if (j > 1 && j + 2 < kRow && i > Adhesions::kAlong / 3 && i < 2 * Adhesions::kAlong / 3) {
      sheer += paint[v].openness < 50;
      dense += paint[v].openness > 85;
    }
  }
  EXPECT_GT(sheer, dense) << "more of it is gaps than strands";
  EXPECT_GT(dense, sheer / 20);
}

TEST(Adhesions, HangBetweenAnOrganAndTheWallAndFollowTheOrgan) {
  const auto backend = render::make_null_backend();
  std::vector<OrganDrawing> organs = drawn_organs(*backend);
  Adhesions adhesions(organs, pelvis(), walls(), {}, *backend);
  ASSERT_GT(adhesions.mesh().id, 0u);
  const std::vector<Vec3f> before = adhesions.buffer().positions;
  int at_wall = 0;
  for (const Vec3f& p : before)
    at_wall += length(vec_cast<double>(p) - walls().nearest(vec_cast<double>(p)).point) < 0.003;
  EXPECT_GT(at_wall, 6);
  sim::State state = sim::initial_state(pelvis());
  for (tissue::NetworkState& solid : state.solids)
    for (tissue::NodeState& n : solid.nodes) n.z += 0.004f;
  for (std::size_t i = 0; i < organs.size(); ++i) organs[i].update(state.solids[i]);
  adhesions.update(organs);
  float least = 1, most = 0;
  for (std::size_t i = 0; i < before.size(); ++i) {
    const float by = length(adhesions.buffer().positions[i] - before[i]);
    least = std::min(least, by);
    most = std::max(most, by);
  }
  EXPECT_LT(least, 1e-5f);            // at the wall
  EXPECT_NEAR(most, 0.004f, 0.001f);  // at the organ
}

TEST(Adhesions, NoneComesNearATubeOrItsFimbriae) {
  const auto backend = render::make_null_backend();
  const std::vector<OrganDrawing> organs = drawn_organs(*backend);
  const BowelLoops loops = bowel_loops(pelvis(), walls());
  const Adhesions::Still still[] = {{&loops.small, 4}};
  const Adhesions adhesions(organs, pelvis(), walls(), still, *backend);
  int tubes = 0;
  for (std::size_t i = 0; i < pelvis().strands.size(); ++i) {
    if (!pelvis().strands[i].fimbriated) continue;
    ++tubes;
    for (const Vec3d& tube : pelvis().strand_bodies[i].model.rest)
      for (const Vec3f& p : adhesions.buffer().positions)
        ASSERT_GT(length(vec_cast<double>(p) - tube), 0.99 * double(Adhesions::kFromTubes));
  }
  EXPECT_EQ(tubes, 2);
}

TEST(Adhesions, AlsoHangOnBowelThatDoesNotMoveAndStayThere) {
  const auto backend = render::make_null_backend();
  std::vector<OrganDrawing> organs = drawn_organs(*backend);
  const BowelLoops loops = bowel_loops(pelvis(), walls());
  const Adhesions::Still still[] = {{&loops.small, 4}};
  const Adhesions fewer(organs, pelvis(), walls(), {}, *backend);
  Adhesions adhesions(organs, pelvis(), walls(), still, *backend);
  const std::size_t first = fewer.buffer().positions.size();
  const std::vector<Vec3f> before = adhesions.buffer().positions;
  ASSERT_GT(before.size(), first);
  for (std::size_t v = first; v < before.size(); v += Adhesions::kAcross * Adhesions::kAlong) {
    float to_gut = 1;
    for (const Vec3f& p : loops.small.positions) to_gut = std::min(to_gut, length(p - before[v]));
    EXPECT_LT(to_gut, 0.006f);
  }
  sim::State state = sim::initial_state(pelvis());
  for (tissue::NetworkState& solid : state.solids)
    for (tissue::NodeState& n : solid.nodes) n.z += 0.004f;
  for (std::size_t i = 0; i < organs.size(); ++i) organs[i].update(state.solids[i]);
  adhesions.update(organs);
  for (std::size_t i = first; i < before.size(); ++i)
    ASSERT_LT(length(adhesions.buffer().positions[i] - before[i]), 1e-6f);
}

TEST(SheetDrawing, ABaseInTheAirGoesOnToTheWall) {
  const auto backend = render::make_null_backend();
  int hanging = 0;
  for (int i = 0; i < int(pelvis().drawn_folds.size()); ++i) {
    const auto& base = pelvis().drawn_folds[std::size_t(i)].base;
    if (std::any_of(base.begin(), base.end(), [](const auto& b) { return !b.in_space(); })) continue;
    const SheetDrawing sheet(pelvis(), i, *backend, {}, &walls());
    int below = 0;
    for (const Vec3f& f : sheet.buffer().positions) {
      const WallSurface::Place wall = walls().nearest(vec_cast<double>(f));
      below += length(wall.point - vec_cast<double>(f)) < 0.004;
    }
    EXPECT_GT(below, 10) << pelvis().drawn_folds[std::size_t(i)].name;
    ++hanging;
  }
  EXPECT_GE(hanging, 2);
}

TEST(Cavity, BendsByNoMoreThanAQuarterOfARightAngleFromTriangleToTriangle) {
  const MeshBuffer m = cavity_around(pelvis());
  std::map<std::pair<std::uint32_t, std::uint32_t>, Vec3f> across;
  double creased = 0, all = 0;
  for (std::size_t t = 0; t < m.indices.size(); t += 3) {
    const auto at = [&](std::size_t k) { return m.positions[m.indices[t + k % 3]]; };
    const Vec3f normal = normalised(cross(at(1) - at(0), at(2) - at(0)));
    for (std::size_t k = 0; k < 3; ++k) {
      const double edge = double(length(at(k + 1) - at(k)));
      const auto [other, anew] = across.try_emplace(std::minmax(m.indices[t + k], m.indices[t + (k + 1) % 3]), normal);
      if (anew) continue;
      all += edge;
      if (dot(other->second, normal) < 0.92f) creased += edge;
    }
  }
  EXPECT_GT(all, 10.0);
  EXPECT_LT(creased, 0.002 * all);
}

TEST(VesselDrawing, WhatLiesInFoldsAndWhatDoesNotIsAllThereIs) {
  const sim::Model model = scene::compile(scene::read_scene(TROCAR_SOURCE_DIR "/scenes/bleeding/scene.json"));
  const auto backend = render::make_null_backend();
  using Lie = VesselDrawing::Lie;
  for (const bool veins : {false, true}) {
    const VesselDrawing all(model, veins, *backend), fold(model, veins, *backend, {}, Lie::in_a_fold),
        rest(model, veins, *backend, {}, Lie::elsewhere);
    EXPECT_EQ(all.buffer().size(), fold.buffer().size() + rest.buffer().size());
    EXPECT_GT(fold.buffer().size(), 100u);
  }
}

}  // namespace
}  // namespace trocar::view
