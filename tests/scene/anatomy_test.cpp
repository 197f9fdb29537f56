// The gynaecology scene as compiled: sizes, places, nothing through anything, everything in view.
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <trocar/scene/compile/compile.hpp>
#include <trocar/scene/files/reader.hpp>
#include <trocar/sim/stages/step.hpp>

namespace trocar::scene {
namespace {

struct Scene {
  Description description;
  sim::Model model;
  CompileReport report;
};
const Scene& gynaecology() {
  static const Scene scene = [] {
    Scene s;
    s.description = read_scene(TROCAR_SOURCE_DIR "/scenes/gynaecology/scene.json");
    s.model = compile(s.description, &s.report);
    return s;
  }();
  return scene;
}

// ---- shapes as clouds of points with normals, or as chains of balls -------------------------------------------------

struct Cloud {
  std::string name;
  std::vector<Vec3d> points, normals;
};
Cloud cloud_of(const std::string& name, const tissue::Skin& skin) {
  Cloud c{name, {}, {}};
  for (std::size_t i = 0; i < skin.rest.size(); ++i) {
    c.points.push_back(vec_cast<double>(skin.rest[i]));
    c.normals.push_back(vec_cast<double>(skin.rest_normal[i]));
  }
  return c;
}
std::vector<Cloud> organs() {
  std::vector<Cloud> all;
  for (const sim::SolidModel& s : gynaecology().model.solids) all.push_back(cloud_of(s.name, s.fine));
  return all;
}
std::vector<Cloud> walls() {
  std::vector<Cloud> all;
  for (const sim::WallModel& w : gynaecology().model.walls) all.push_back(cloud_of(w.name, w.skin));
  return all;
}

/// Height of p over the surface: over the tangent plane of the nearest point (negative: behind it).
double height(const Cloud& surface, Vec3d p) {
  std::size_t nearest = 0;
  double least = 1e30;
  for (std::size_t i = 0; i < surface.points.size(); ++i) {
    const Vec3d d = p - surface.points[i];
    const double square = dot(d, d);
    if (square < least) {
      least = square;
      nearest = i;
    }
  }
  const double over = dot(p - surface.points[nearest], surface.normals[nearest]);
  return over < 0 ? over : std::sqrt(least);
}

struct Ball {
  Vec3d centre;
  double radius;
  double from_start, to_end;  ///< along the strand [m]
};
std::vector<Ball> balls_of(std::size_t strand) {
  const interactions::StrandBody& body = gynaecology().model.strand_bodies[strand];
  const sim::StrandAnatomy& model = gynaecology().model.strands[strand];
  std::vector<Ball> balls;
  for (std::size_t i = 0; i + 1 < body.model.rest.size(); ++i)
    for (const double w : {0.0, 0.25, 0.5, 0.75}) {
      const double s = body.arc[i] + w * (body.arc[i + 1] - body.arc[i]);
      balls.push_back({(1 - w) * body.model.rest[i] + w * body.model.rest[i + 1],
                       (1 - w) * model.outer[i] + w * model.outer[i + 1], s, body.length() - s});
    }
  return balls;
}

constexpr double kGap = 0.0003;   // [m] what lies side by side keeps at least this
constexpr double kRoot = 0.0075;  // [m] around a root a cord may touch what carries it

TEST(Anatomy, OrgansDoNotTouchEachOtherOrTheWall) {
  const std::vector<Cloud> all = organs();
  for (std::size_t i = 0; i < all.size(); ++i) {
    double least = 1;
    for (const Cloud& wall : walls())
      for (const Vec3d p : all[i].points) least = std::min(least, height(wall, p));
    EXPECT_GT(least, kGap) << all[i].name << " and the wall";
    for (std::size_t j = 0; j < all.size(); ++j) {
      if (i == j) continue;
      least = 1;
      for (const Vec3d p : all[i].points) least = std::min(least, height(all[j], p));
      EXPECT_GT(least, kGap) << all[i].name << " and " << all[j].name;
    }
  }
}

TEST(Anatomy, CordsPassOrgansAndWallsExceptAtTheirRoots) {
  const sim::Model& m = gynaecology().model;
  const std::vector<Cloud> solids = organs(), bowl = walls();
  for (std::size_t k = 0; k < m.strands.size(); ++k) {
    const sim::StrandAnatomy& strand = m.strands[k];
    for (const Ball& ball : balls_of(k)) {
      for (std::size_t j = 0; j < solids.size(); ++j) {
        const bool start_here = strand.start.organ() == std::int32_t(j) && ball.from_start < kRoot;
        const bool end_here = strand.end.organ() == std::int32_t(j) && ball.to_end < kRoot;
        if (start_here || end_here) continue;
        EXPECT_GT(height(solids[j], ball.centre) - ball.radius, kGap)
            << strand.name << " at " << ball.from_start * 1000 << " mm and " << solids[j].name;
      }
      if (strand.end.kind == sim::StrandEndModel::fixed && ball.to_end < 2 * kRoot) continue;
      for (const Cloud& wall : bowl)
        EXPECT_GT(height(wall, ball.centre) - ball.radius, kGap)
            << strand.name << " at " << ball.from_start * 1000 << " mm and " << wall.name;
    }
  }
}

TEST(Anatomy, CordsDoNotCrossEachOther) {
  const sim::Model& m = gynaecology().model;
  for (std::size_t a = 0; a < m.strands.size(); ++a)
    for (std::size_t b = a + 1; b < m.strands.size(); ++b) {
      double least = 1;
      for (const Ball& p : balls_of(a))
        for (const Ball& q : balls_of(b)) least = std::min(least, length(p.centre - q.centre) - p.radius - q.radius);
      EXPECT_GT(least, kGap) << m.strands[a].name << " and " << m.strands[b].name;
    }
}

TEST(Anatomy, RootsSitOnTheSkinsThatCarryThem) {
  const sim::Model& m = gynaecology().model;
  const std::vector<Cloud> solids = organs();
  for (std::size_t k = 0; k < m.strands.size(); ++k) {
    const auto check = [&](const sim::StrandEndModel& end, Vec3d at) {
      if (end.kind != sim::StrandEndModel::hosted) return;
      const double h = height(solids[std::size_t(end.organ())], at);
      EXPECT_LT(h, 0.0007) << m.strands[k].name;
      EXPECT_GT(h, -0.0015) << m.strands[k].name;
    };
    check(m.strands[k].start, m.strand_bodies[k].model.rest.front());
    check(m.strands[k].end, m.strand_bodies[k].model.rest.back());
  }
}

// ---- figures --------------------------------------------------------------------------------------------------------

const BodyReport& report_of(const std::string& name) {
  const auto& bodies = gynaecology().report.bodies;
  return *std::find_if(bodies.begin(), bodies.end(), [&](const BodyReport& b) { return b.name == name; });
}

/// Size along a direction [mm].
double extent(const Cloud& cloud, Vec3d direction) {
  double low = 1e9, high = -1e9;
  for (const Vec3d p : cloud.points) {
    low = std::min(low, dot(p, direction));
    high = std::max(high, dot(p, direction));
  }
  return 1000 * (high - low);
}
const Strand& strand(const std::string& name) {
  const auto& all = gynaecology().description.strands;
  return *std::find_if(all.begin(), all.end(), [&](const Strand& s) { return s.name == name; });
}
double radius_mm(const Strand& s, double at_mm) {
  const StrandStation* last = &s.stations.front();
  for (const StrandStation& next : s.stations) {
    if (next.s * 1000 >= at_mm && next.s > last->s)
      return 1000 * (last->radius + (at_mm / 1000 - last->s) / (next.s - last->s) * (next.radius - last->radius));
    last = &next;
  }
  return 1000 * last->radius;
}

TEST(Anatomy, TheUterusIsThatOfAnAdult) {
  const Cloud uterus = organs()[0];
  ASSERT_EQ(uterus.name, "uterus");
  EXPECT_NEAR(extent(uterus, {1, 0, 0}), 50, 2);
  EXPECT_NEAR(extent(uterus, normalised(Vec3d{0, 0.52, 0.85})), 74, 4);  // along its axis
  EXPECT_NEAR(report_of("uterus").volume * 1e6, 52, 8);
}

/// No one's two sides are alike: the left ovary is the larger one, the right tube the shorter one.
struct SideFigures {
  const char *ovary, *tube;
  double ovary_mL, ovary_mm, tube_mm;
};
constexpr SideFigures kSides[] = {{"ovary_left", "tube_left", 5.4, 31, 105},
                                  {"ovary_right", "tube_right", 3.9, 27.5, 94}};

TEST(Anatomy, TheOvariesHaveTheirSizes) {
  for (const SideFigures& side : kSides) {
    EXPECT_NEAR(report_of(side.ovary).volume * 1e6, side.ovary_mL, 0.3) << side.ovary;
    for (const Cloud& c : organs())
      if (c.name == side.ovary) {
        double longest = 0;
        for (const Vec3d p : c.points)
          for (const Vec3d q : c.points) longest = std::max(longest, length(p - q));
        EXPECT_NEAR(longest * 1000, side.ovary_mm, 1) << side.ovary;
      }
  }
}

TEST(Anatomy, TheTubesHaveIsthmusAmpullaAndInfundibulum) {
  const sim::Model& m = gynaecology().model;
  for (const SideFigures& side : kSides) {
    const char* name = side.tube;
    EXPECT_NEAR(m.strand_bodies[std::size_t(m.strand_index(name))].length() * 1000, side.tube_mm, 1) << name;
    const Strand& tube = strand(name);
    EXPECT_NEAR(2 * radius_mm(tube, 15), 3.1, 0.2);
    EXPECT_NEAR(2 * radius_mm(tube, 0.84 * side.tube_mm), 8, 0.2);
    ASSERT_EQ(tube.landmarks.size(), 4u);
    EXPECT_EQ(tube.landmarks[0].name, "isthmus");
    EXPECT_EQ(tube.landmarks[0].to, 0.025);
    EXPECT_EQ(tube.landmarks[3].name, "fimbria");
    EXPECT_TRUE(tube.fimbriated);
    EXPECT_TRUE(tube.cuttable);
  }
}

TEST(Anatomy, TheSidesAreNotEachOthersMirrorImage) {
  const auto middle = [](const char* name) {
    const std::vector<Cloud> all = organs();
    const Cloud& c = *std::find_if(all.begin(), all.end(), [&](const Cloud& o) { return o.name == name; });
    Vec3d sum;
    for (const Vec3d p : c.points) sum += p;
    return (1000.0 / double(c.points.size())) * sum;
  };
  const Vec3d left = middle("ovary_left"), right = middle("ovary_right");
  EXPECT_GT(length(left - Vec3d{-right.x, right.y, right.z}), 5);
  EXPECT_LT(middle("uterus").x, -3) << "it leans to the patient's right";
}

TEST(Anatomy, LeftIsAtPositiveXAndRightAtNegative) {
  for (const Strand& s : gynaecology().description.strands)
    for (const Vec3d p : s.centreline) {
      const bool left = s.name.size() > 5 && s.name.compare(s.name.size() - 5, 5, "_left") == 0;
      EXPECT_GT(left ? p.x : -p.x, 0) << s.name;
    }
}

TEST(Anatomy, TheWholeSceneHasSixToSevenAndAHalfThousandFreeNodes) {
  EXPECT_GE(gynaecology().model.free_nodes(), 6000);
  EXPECT_LE(gynaecology().model.free_nodes(), 7500);
}

/// Where the place goes that is pulled by `newton` towards the ports for two seconds, everything else taking part.
double lifted_mm(const char* name, double s, double newton) {
  const sim::Model& m = gynaecology().model;
  const std::size_t tube = std::size_t(m.strand_index(name));
  const interactions::StrandBody& body = m.strand_bodies[tube];
  const interactions::StrandPlace place = interactions::place_at(body, s);
  sim::State state = sim::initial_state(m);
  sim::Work work = sim::make_work(m);
  const Vec3d before = interactions::point_at(body, state.strands[tube], place);
  for (int tick = 0; tick < 2000; ++tick) {
    sim::StepReport report;
    sim::StepContext context{m, m.start, state, work, report};
    for (const sim::Stage& stage : sim::stages()) {
      if (std::string(stage.name) == "advance strands") {
        tissue::StrandLoad pull;
        pull.element = place.element;
        pull.w = place.w;
        pull.f0 = newton * normalised(Vec3d{0, 0.5, 0.85});
        work.strands[tube].loads.add(pull, {});
      }
      stage.run(context);
    }
  }
  return 1000 * length(interactions::point_at(body, state.strands[tube], place) - before);
}

TEST(Anatomy, OneNewtonLiftsTheAmpullaByTwentyToThirtyMillimetres) {
  for (const char* name : {"tube_left", "tube_right"})
    for (const double s : {0.045, 0.060}) {
      const double once = lifted_mm(name, s, 1);
      EXPECT_GT(once, 20) << name << " at " << s;
      EXPECT_LT(once, 30) << name << " at " << s;
    }
  // Then it stiffens: three times the force does not lift it twice as far.
  EXPECT_LT(lifted_mm("tube_left", 0.045, 3), 2 * lifted_mm("tube_left", 0.045, 1));
}

TEST(Anatomy, AMesosalpinxHangsFromEachTube) {
  const sim::Model& m = gynaecology().model;
  for (const char* side : {"left", "right"}) {
    const int i = m.membrane_index(std::string("mesosalpinx_") + side);
    ASSERT_GE(i, 0);
    const sim::MembraneBody& fold = m.membranes[std::size_t(i)];
    EXPECT_EQ(fold.strand, m.strand_index(std::string("tube_") + side));
    int on_rods = 0, on_organs = 0;
    for (const interactions::Attachment& hold : fold.holds) {
      on_rods += hold.point.body.is(BodyKind::strand);
      on_organs += hold.point.body.is(BodyKind::organ);
    }
    EXPECT_GT(on_rods, fold.sheet.columns);  // tube and ovarian ligament
    EXPECT_GT(on_organs, 2);                 // the ovary
    double width = 0;
    for (int c = 0; c < fold.sheet.columns; ++c)
      width = std::max(width, double(fold.depth[std::size_t((fold.sheet.rows - 1) * fold.sheet.columns + c)]));
    EXPECT_GT(width, 0.010);
    EXPECT_LT(width, 0.025);
    EXPECT_GT(fold.sheet.thickness, 0.0003);
    EXPECT_LT(fold.sheet.thickness, 0.001);
  }
}

// ---- view -----------------------------------------------------------------------------------------------------------

bool in_view(Vec3d p) {
  const Description& d = gynaecology().description;
  const Vec3d eye = d.scope_placement.tip, along = normalised(eye);  // a straight scope through the origin
  const Vec3d to = p - eye;
  return dot(normalised(to), along) > std::cos(d.scope.field_of_view / 2);
}

TEST(Anatomy, TheScopeStandsBeforeTheFundus) {
  const Description& d = gynaecology().description;
  const double away = 1000 * length(d.scope_placement.tip - Vec3d{0, -0.150, -0.095});
  EXPECT_GT(away, 70);
  EXPECT_LT(away, 100);
  EXPECT_EQ(d.scope.angle, 0);
}

TEST(Anatomy, UterusTubesAndOvariesAreInTheConeOfView) {
  for (const Cloud& c : organs()) {
    if (c.name.find("ovary") == std::string::npos && c.name != "uterus") continue;
    const auto seen = std::count_if(c.points.begin(), c.points.end(), in_view);
    EXPECT_GT(double(seen), 0.99 * double(c.points.size())) << c.name;
  }
  const sim::Model& m = gynaecology().model;
  for (const char* name : {"tube_left", "tube_right"})
    for (const Ball& ball : balls_of(std::size_t(m.strand_index(name))))
      EXPECT_TRUE(in_view(ball.centre)) << name << " at " << ball.from_start * 1000 << " mm";
}

TEST(Anatomy, ToolsAreParkedInViewAndClearOfTheOrgans) {
  for (const Placement& tool : gynaecology().description.placements) {
    EXPECT_TRUE(in_view(tool.tip)) << tool.instrument;
    double least = 1;
    for (const Cloud& c : organs()) least = std::min(least, height(c, tool.tip));
    EXPECT_GT(least, 0.020) << tool.instrument;
    EXPECT_LT(least, 0.045) << tool.instrument;
  }
}

}  // namespace
}  // namespace trocar::scene
