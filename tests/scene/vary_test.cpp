// A varied scene is another patient and still a sound one: deterministic, everything attached, nothing beyond what was
// allowed, at rest as drawn.
#include <algorithm>
#include <cmath>
#include <map>

#include <gtest/gtest.h>

#include <trocar/scene/compile/compile.hpp>
#include <trocar/scene/description/vary.hpp>
#include <trocar/scene/files/reader.hpp>
#include <trocar/sim/stages/step.hpp>

namespace trocar::scene {
namespace {

const Description& drawn() {
  static const Description read = read_scene(TROCAR_SOURCE_DIR "/scenes/gynaecology/scene.json");
  return read;
}
Description varied(std::uint64_t seed) {
  Description d = drawn();
  vary(d, seed);
  return d;
}

template <class List>
const auto& named(const List& list, const std::string& name) {
  return *std::find_if(list.begin(), list.end(), [&name](const auto& item) { return item.name == name; });
}

/// Length of the polyline through the points: near enough to tell.
double way(const Strand& s) {
  double sum = 0;
  for (size_t i = 1; i < s.centreline.size(); ++i) sum += length(s.centreline[i] - s.centreline[i - 1]);
  return sum;
}

double least_distance(const std::vector<Vec3d>& points, Vec3d p) {
  double least = 1e9;
  for (const Vec3d& q : points) least = std::min(least, length(q - p));
  return least;
}

TEST(Vary, SeedZeroLeavesEverythingAsDrawn) { EXPECT_EQ(compile(varied(0)).hash, compile(drawn()).hash); }

TEST(Vary, TheSameSeedIsTheSamePatientAndAnotherIsNot) {
  const std::uint64_t hash = compile(varied(7)).hash;
  EXPECT_EQ(compile(varied(7)).hash, hash);
  EXPECT_NE(compile(varied(8)).hash, hash);
}

TEST(Vary, LengthsAndStiffnessStayWithinAFifthAndUseIt) {
  double shortest = 9, longest = 0, softest = 9, stiffest = 0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const Description d = varied(seed);
    for (const char* tube : {"tube_left", "tube_right"}) {
      const double ratio = way(named(d.strands, tube)) / way(named(drawn().strands, tube));
      shortest = std::min(shortest, ratio);
      longest = std::max(longest, ratio);
    }
    for (size_t i = 0; i < d.tissues.size(); ++i) {
      const double ratio = d.tissues[i].young / drawn().tissues[i].young;
      softest = std::min(softest, ratio);
      stiffest = std::max(stiffest, ratio);
    }
  }
  EXPECT_GE(softest, 0.8);
  EXPECT_LE(stiffest, 1.2);
  EXPECT_LT(softest, 0.85);
  EXPECT_GT(stiffest, 1.15);
  EXPECT_GT(shortest, 0.74) << "a fifth, and 3 mm of shift";
  EXPECT_LT(longest, 1.26);
  EXPECT_LT(shortest, 0.88);
  EXPECT_GT(longest, 1.12);
}

TEST(Vary, LandmarksAndThicknessGoAlongWithTheTube) {
  for (std::uint64_t seed : {3u, 12u}) {
    const Description d = varied(seed);
    for (const char* name : {"tube_left", "tube_right"}) {
      const Strand &now = named(d.strands, name), &before = named(drawn().strands, name);
      const double ratio = way(now) / way(before);
      for (size_t i = 0; i < now.landmarks.size(); ++i) {
        EXPECT_LE(now.landmarks[i].from, now.landmarks[i].to);
        EXPECT_NEAR(now.landmarks[i].to, ratio * before.landmarks[i].to, 0.006) << now.landmarks[i].name;
      }
      for (size_t i = 1; i < now.stations.size(); ++i) EXPECT_GT(now.stations[i].s, now.stations[i - 1].s);
    }
  }
}

TEST(Vary, WhatHungTogetherStillDoes) {
  // Roots do not leave the uterus, and no fold's base its organ.
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const Description d = varied(seed);
    for (size_t i = 0; i < d.strands.size(); ++i)
      if (d.strands[i].start.organ == "uterus") {
        EXPECT_LT(length(d.strands[i].centreline.front() - drawn().strands[i].centreline.front()), 0.002)
            << seed << " " << d.strands[i].name;
      }
    for (size_t i = 0; i < d.membranes.size(); ++i)
      for (size_t k = 0; k < d.membranes[i].base.size(); ++k)
        for (const std::string& on : d.membranes[i].base_on) {
          const auto strand =
              std::find_if(d.strands.begin(), d.strands.end(), [&](const Strand& s) { return s.name == on; });
          if (strand == d.strands.end()) continue;
          const Strand& before = named(drawn().strands, on);
          const double was = least_distance(before.centreline, drawn().membranes[i].base[k]);
          const double is = least_distance(strand->centreline, d.membranes[i].base[k]);
          if (was < 0.004) {
            EXPECT_LT(is, was + 0.002) << seed << " " << d.membranes[i].name;
          }
        }
  }
}

TEST(Vary, AVariedSceneRestsAsDrawn) {
  for (std::uint64_t seed : {10u, 18u}) {
    const sim::Model m = compile(varied(seed));
    sim::State s = sim::initial_state(m);
    sim::Work w = sim::make_work(m);
    for (int t = 0; t < 1000; ++t) ASSERT_EQ(step(m, m.start, s, w).flags, 0u) << seed << " tick " << t;
    for (size_t i = 0; i < m.strand_bodies.size(); ++i)
      for (size_t n = 0; n < s.strands[i].x.size(); ++n)
        ASSERT_LT(length(s.strands[i].x[n] - m.strand_bodies[i].model.rest[n]), 2e-4)
            << seed << " " << m.strands[i].name;
  }
}

const Description& digestive() {
  static const Description read = read_scene(TROCAR_SOURCE_DIR "/scenes/digestive/scene.json");
  return read;
}

TEST(Vary, ASceneThatDeclaresNothingIsTheSameForEverySeed) {
  Description d = drawn();
  d.variation.reset();
  const std::uint64_t hash = compile(d).hash;
  vary(d, 5);
  EXPECT_EQ(compile(d).hash, hash);
}

TEST(Vary, ARegionAroundASolidShiftsAndTurnsItAndNothingFarAway) {
  double most_shift = 0, most_turn = 0;
  for (std::uint64_t seed = 1; seed <= 12; ++seed) {
    Description d = digestive();
    VariationSetting::Region& region = d.variation->regions.at(0);
    region.near = 0.1, region.far = 0.2;
    vary(d, seed);
    const Solid &now = named(d.solids, "stomach"), &before = named(digestive().solids, "stomach");
    Vec3d shift;
    for (size_t i = 0; i < now.sections.size(); ++i)
      shift += (now.sections[i].centre - before.sections[i].centre) / double(now.sections.size());
    most_shift = std::max(most_shift, length(shift));
    EXPECT_LE(length(shift), 0.0061 * std::sqrt(3)) << seed;
    const Vec3d a = before.sections.back().centre - before.sections.front().centre;
    const Vec3d b = now.sections.back().centre - now.sections.front().centre;
    const double turn = std::fabs(std::atan2(a.x * b.y - a.y * b.x, a.x * b.x + a.y * b.y));
    most_turn = std::max(most_turn, turn);
    EXPECT_LE(turn, 1.5 * region.turn) << seed;
    for (size_t w = 0; w < d.walls.size(); ++w)
      for (size_t i = 0; i < d.walls[w].net.size(); ++i)
        if (length(digestive().walls[w].net[i] - before.sections[before.sections.size() / 2].centre) > 0.3) {
          EXPECT_EQ(d.walls[w].net[i], digestive().walls[w].net[i]);
        }
  }
  EXPECT_GT(most_shift, 0.003);
  EXPECT_GT(most_turn, 0.5 * digestive().variation->regions[0].turn);
}

TEST(Vary, GirthsMakeBodiesThickerOrThinnerWhereTheyAre) {
  double least = 9, most = 0;
  for (std::uint64_t seed = 1; seed <= 12; ++seed) {
    Description d = digestive();
    d.variation->regions.clear();
    vary(d, seed);
    const Solid &now = named(d.solids, "jejunum"), &before = named(digestive().solids, "jejunum");
    const double share = length(now.sections[0].across) / length(before.sections[0].across);
    least = std::min(least, share), most = std::max(most, share);
    for (size_t i = 0; i < now.sections.size(); ++i) {
      EXPECT_EQ(now.sections[i].centre, before.sections[i].centre);
      EXPECT_NEAR(length(now.sections[i].deep) / length(before.sections[i].deep), share, 1e-12);
    }
    EXPECT_EQ(named(d.solids, "stomach").sections[0].across, named(digestive().solids, "stomach").sections[0].across);
  }
  EXPECT_GE(least, 0.9);
  EXPECT_LE(most, 1.1);
  EXPECT_GT(most - least, 0.1);
}

TEST(Vary, APlaceOfBleedingIsChosenOnlyWhereThatIsDeclared) {
  const Description pelvis = read_scene(TROCAR_SOURCE_DIR "/scenes/bleeding_control/scene.json");
  std::vector<int> chosen(pelvis.bleeder->holes.size());
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    Description d = pelvis;
    vary(d, seed);
    ++chosen.at(size_t(d.bleeder->which));
    d = pelvis;
    d.variation->bleeder = false;
    vary(d, seed);
    EXPECT_EQ(d.bleeder->which, 0);
  }
  for (const int times : chosen) EXPECT_GT(times, 0);
}

TEST(Vary, OfFindingsTheSeedLeavesAsManyAsAreDeclaredAndNothingElseChanges) {
  const Description drawn_bowel = read_scene(TROCAR_SOURCE_DIR "/scenes/bowel/scene.json");
  const std::size_t all = drawn_bowel.variation->findings.size();
  std::map<std::string, int> found;
  const auto lesions = [&](const Description& d) {
    std::vector<std::string> names;
    for (const MarkSetting& m : d.marks)
      if (m.name.rfind("lesion_", 0) == 0) names.push_back(m.name);
    return names;
  };
  ASSERT_EQ(lesions(drawn_bowel).size(), all);
  for (std::uint64_t seed = 0; seed <= 40; ++seed) {
    Description d = drawn_bowel, without = drawn_bowel;
    vary(d, seed);
    for (const std::string& name : lesions(d)) ++found[name];
    EXPECT_EQ(lesions(d).size(), 2u) << seed;
    if (seed == 0) {
      EXPECT_EQ(lesions(d), (std::vector<std::string>{"lesion_nub", "lesion_stricture"}));
    }
    without.variation->findings.clear();
    vary(without, seed);
    EXPECT_EQ(named(d.solids, "jejunum").sections[3].centre, named(without.solids, "jejunum").sections[3].centre);
  }
  EXPECT_EQ(found.size(), all);
}

TEST(Vary, AStrictureIsNarrowWhereItIsFoundAndFadesOut) {
  const Description drawn_bowel = read_scene(TROCAR_SOURCE_DIR "/scenes/bowel/scene.json");
  Description d = drawn_bowel;
  vary(d, 0);
  const std::vector<Section>&now = named(d.solids, "jejunum").sections,
        &before = named(drawn_bowel.solids, "jejunum").sections;
  double narrowest = 1;
  std::size_t changed = 0;
  for (std::size_t i = 0; i < now.size(); ++i) {
    const double share = length(now[i].across) / length(before[i].across);
    EXPECT_NEAR(length(now[i].deep) / length(before[i].deep), share, 1e-12);
    EXPECT_EQ(now[i].centre, before[i].centre);
    narrowest = std::min(narrowest, share);
    changed += share < 1;
  }
  EXPECT_NEAR(narrowest, 0.7, 1e-9);
  EXPECT_GE(changed, 3u);
  EXPECT_LE(changed, 5u);  // none of the loops beside it
}

TEST(Vary, EveryShippedSceneThatVariesCompilesAsAnotherOne) {
  for (const char* name : {"cutting", "gallbladder", "digestive", "cholecystectomy", "bowel"}) {
    Description d = read_scene(std::string(TROCAR_SOURCE_DIR "/scenes/") + name + "/scene.json");
    const std::uint64_t as_drawn = compile(d).hash;
    vary(d, 2);
    EXPECT_NE(compile(d).hash, as_drawn) << name;
  }
}

}  // namespace
}  // namespace trocar::scene
