// Vessels in scenes: what they ride on, what two files make together, what is not sound and where that is told; and the
// arteries of the shipped pelvis, which feed each other's stumps.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include <gtest/gtest.h>

#include <trocar/scene/compile/compile_vessels.hpp>
#include <trocar/scene/description/vary.hpp>
#include <trocar/scene/files/reader.hpp>
#include <trocar/scene/files/writer.hpp>
#include <trocar/sim/model/bodies.hpp>
#include <trocar/sim/stages/circulation.hpp>

#include "../sim/small_scene.hpp"
#include "files.hpp"

namespace trocar::scene {
namespace {

const Description& described() {
  static const Description d = read_scene(TROCAR_SOURCE_DIR "/scenes/bleeding/scene.json");
  return d;
}
const sim::Model& pelvis() {
  static const sim::Model model = compile(described());
  return model;
}

const interactions::VesselPath& path_of(const char* name) {
  return pelvis().vessels.list[size_t(pelvis().vessel_index(name))].path;
}
/// Do most points of this vessel ride on that body?
bool rides_on(const char* vessel, BodyId body) {
  const auto& points = path_of(vessel).points;
  const auto there = std::count_if(points.begin(), points.end(), [&](const auto& p) { return p.rides.body == body; });
  return 2 * there > std::ptrdiff_t(points.size());
}

TEST(SceneVessels, TheArteriesOfThePelvisRideOnWhatTheySupply) {
  EXPECT_EQ(pelvis().vessels.list.size(), 46u);
  EXPECT_TRUE(rides_on("uterine_upper_left", sim::body_of(pelvis(), "uterus")));
  EXPECT_TRUE(rides_on("tubal_left", sim::body_of(pelvis(), "mesosalpinx_left")) ||
              rides_on("tubal_left", sim::body_of(pelvis(), "tube_left")));
  EXPECT_TRUE(rides_on("common_iliac_left", BodyId{})) << "behind the peritoneum";
  EXPECT_TRUE(rides_on("uterine_upper_vein_left", sim::body_of(pelvis(), "uterus")));
  for (const sim::Vessel& v : pelvis().vessels.list) {
    const double mmhg = v.mean_pressure / vessels::kPascalPerMmHg;
    EXPECT_GT(mmhg, v.vein ? 12 : 60) << v.name;
    EXPECT_LT(mmhg, v.vein ? 18 : 100) << v.name;
  }
}

TEST(SceneVessels, VesselsThatMeetRideOnTheSameBodyThere) {
  const auto& list = pelvis().vessels.list;
  const auto& segments = pelvis().vessels.flow.segments;
  for (size_t a = 0; a < list.size(); ++a)
    for (size_t b = 0; b < list.size(); ++b)
      for (const bool end_a : {false, true})
        for (const bool end_b : {false, true}) {
          if ((end_a ? segments[a].to : segments[a].from) != (end_b ? segments[b].to : segments[b].from)) continue;
          const auto& x = end_a ? list[a].path.points.back() : list[a].path.points.front();
          const auto& y = end_b ? list[b].path.points.back() : list[b].path.points.front();
          EXPECT_EQ(x.rides.body, y.rides.body) << list[a].name << " and " << list[b].name;
        }
}

/// The blood alone: tissue stays as drawn.
struct Blood {
  sim::State s = sim::initial_state(pelvis());
  sim::Work w = sim::make_work(pelvis());
  sim::StepReport report;

  void cut(const char* vessel, double at, double reach = 0.0012) {
    sim::StepContext c{pelvis(), pelvis().start, s, w, report};
    pose_vessels(c);
    const int v = pelvis().vessel_index(vessel);
    const interactions::VesselSpot spot = vessel_spot(path_of(vessel), w.vessel_points[size_t(v)], {}, at);
    open_vessels(c, geometry::square_blade(spot.place, spot.along, reach), {}, 1);
    ASSERT_EQ(s.opening_count, 1);
    ASSERT_EQ(s.openings[0].vessel, v);
    ASSERT_EQ(s.openings[0].through, 1);
  }
  void clip(const char* vessel, double at) {
    s.vessel_clips[size_t(s.vessel_clip_count++)] = {at, 1, s.tick, pelvis().vessel_index(vessel), 0};
  }
  /// mL/min of both stumps in the second after one in which clips close and walls run dry.
  std::array<double, 2> run() {
    std::array<std::int64_t, 2> out{};
    for (int i = 0; i < 2000; ++i, ++s.tick) {
      sim::StepContext c{pelvis(), pelvis().start, s, w, report};
      update_blood_flow(c);
      for (int k = 0; i >= 1000 && k < w.bleed_count; ++k)
        out[size_t(w.bleeds[size_t(k)].side)] += w.bleeds[size_t(k)].picolitres;
    }
    return {double(out[0]) * 60e-9, double(out[1]) * 60e-9};
  }
  /// mL/min of both together, the least and the most of ten tenths of a second.
  std::array<double, 2> least_and_most() {
    run();
    std::array<double, 10> lost{};
    for (size_t i = 0; i < 1000; ++i, ++s.tick) {
      sim::StepContext c{pelvis(), pelvis().start, s, w, report};
      update_blood_flow(c);
      for (int k = 0; k < w.bleed_count; ++k) lost[i / 100] += 600e-9 * double(w.bleeds[size_t(k)].picolitres);
    }
    const auto [low, high] = std::minmax_element(lost.begin(), lost.end());
    return {*low, *high};
  }
};

TEST(SceneVessels, ACutVeinOozesWhereTheArteryBesideItSpurts) {
  Blood vein, artery;
  vein.cut("tubal_vein_left", 0.5);
  artery.cut("tubal_left", 0.5);
  const auto oozes = vein.least_and_most(), spurts = artery.least_and_most();
  std::printf("    vein %.1f to %.1f mL/min, artery %.1f to %.1f\n", oozes[0], oozes[1], spurts[0], spurts[1]);
  EXPECT_GT(oozes[0], 1) << "[mL/min]";
  EXPECT_LT(oozes[1], 1.2 * oozes[0]) << "no pulse";
  EXPECT_GT(spurts[1], 1.3 * spurts[0]) << "pulse";
}

TEST(SceneVessels, WhatAVeinShedsIsKnownAsItsOwn) {
  for (const auto& [vessel, expected] : {std::pair("tubal_vein_left", 1.0f), std::pair("tubal_left", 0.0f)}) {
    Blood b;
    b.cut(vessel, 0.5);
    for (int i = 0; i < 400; ++i) step(pelvis(), pelvis().start, b.s, b.w);
    const fluids::DropletState& d = b.s.fluids.droplets;
    ASSERT_GT(d.count, 0) << vessel;
    for (size_t i = 0; i < size_t(d.count); ++i) EXPECT_EQ(d.blood[i].venous, expected) << vessel;
  }
}

TEST(SceneVessels, AVeinBleedsMoreWhenTheAbdomensPressureIsSuckedAwayAnArteryHardly) {
  constexpr double kMmHg = vessels::kPascalPerMmHg;
  const auto mean = [](const char* vessel, double pressure) {
    Blood b;
    b.cut(vessel, 0.5);
    b.s.fluids.gas.pressure = pressure * kMmHg;
    const auto flow = b.least_and_most();
    return 0.5 * (flow[0] + flow[1]);
  };
  const double vein = mean("tubal_vein_left", 12), sucked = mean("tubal_vein_left", 2);
  const double artery = mean("tubal_left", 12), artery_sucked = mean("tubal_left", 2);
  std::printf("    vein %.1f, with 2 mmHg in the abdomen %.1f mL/min; artery %.1f, %.1f\n", vein, sucked, artery,
              artery_sucked);
  EXPECT_GT(sucked, 1.3 * vein);
  EXPECT_GT(artery_sucked, artery);
  EXPECT_LT(artery_sucked, 1.25 * artery);
}

TEST(SceneVessels, UterineAndOvarianArteryFeedEachOthersStumpsSoBothSidesNeedAClip) {
  Blood open, uterine_side, ovarian_side, both;
  for (Blood* b : {&open, &uterine_side, &ovarian_side, &both}) b->cut("tubal_left", 0.5);
  for (Blood* b : {&uterine_side, &both}) b->clip("tubal_left", 0.3);
  for (Blood* b : {&ovarian_side, &both}) b->clip("tubal_left", 0.7);
  const auto none = open.run(), near = uterine_side.run(), far = ovarian_side.run(), all = both.run();
  EXPECT_GT(none[0], 3) << "mL/min from the uterine artery";
  EXPECT_GT(none[1], 1) << "and back from the ovarian one";
  EXPECT_EQ(near[0], 0);
  EXPECT_GT(near[1], 1);
  EXPECT_GT(far[0], 3);
  EXPECT_EQ(far[1], 0);
  EXPECT_EQ(all[0], 0);
  EXPECT_EQ(all[1], 0);
}

TEST(SceneVessels, AClipFarUpstreamIsNotEnoughWhereArteriesMeet) {
  Blood b;
  b.cut("tubal_left", 0.5);
  b.clip("uterine_left", 0.5);
  const auto flow = b.run();
  EXPECT_GT(flow[0], 0.5) << "the ovarian artery feeds the cornu through its ramus";
}

std::string fault_of(const Description& d) {
  try {
    compile(d);
  } catch (const core::BadInput& bad) {
    return bad.what();
  }
  return "";
}

TEST(SceneVessels, AVesselFarFromWhatItRidesOnIsALocatedFault) {
  Description d = small::description();
  for (Vec3d& p : d.vessels[0].vessels[0].path) p.z += 0.05;
  d.vessels[0].vessels[0].rides_at = {{"vessels.json", 7, 9}};
  const std::string fault = fault_of(d);
  EXPECT_NE(fault.find("vessels.json:7:9: expected some of 'tube_artery' within 4 mm"), fault.npos) << fault;
}

TEST(SceneVessels, LinesOfCountlessPointsAreALocatedFault) {
  Description d = small::description();
  d.vessels[0].vessels[1].path = {{0, 0, 0}, {200, 0, 0}};
  d.vessels[0].vessels[1].at = {"vessels.json", 12, 5};
  const std::string fault = fault_of(d);
  EXPECT_NE(fault.find("vessels.json:12:5: expected vessels of at most 50000 points"), fault.npos) << fault;
}

TEST(SceneVessels, ArteriesAndVeinsOfTwoFilesAreOneGraphOfTwoParts) {
  Description d = small::description();
  VesselTree veins = small::arteries();
  for (Vessel& v : veins.vessels) v.name += "_vein";
  for (vessels::VesselSegment& s : veins.graph.segments) {
    s.vein = true;
    s.reference_pressure = 8 * vessels::kPascalPerMmHg;
  }
  for (vessels::VesselSource& source : veins.graph.sources) {
    source.kind = vessels::VesselSource::Kind::steady;
    source.venous = true;
    source.pressure = 10 * vessels::kPascalPerMmHg;
  }
  d.vessels.push_back(veins);
  const sim::Model m = compile(d);
  ASSERT_EQ(m.vessels.list.size(), 6u);
  EXPECT_EQ(m.vessels.flow.nodes, 12);
  EXPECT_FALSE(m.vessels.list[2].vein);
  EXPECT_TRUE(m.vessels.list[3].vein);
  EXPECT_EQ(m.vessel_index("bar_artery_vein"), 5);
  EXPECT_LT(m.vessels.list[3].mean_pressure, 12 * vessels::kPascalPerMmHg);
  EXPECT_GT(m.vessels.list[0].mean_pressure, 70 * vessels::kPascalPerMmHg);
}

/// The bleeding scene with its vessels from memory: all files are read from the disk into it.
MemoryFiles files_of_bleeding() {
  MemoryFiles files;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(TROCAR_SOURCE_DIR "/scenes"))
    if (entry.path().extension() == ".json") {
      std::ifstream in(entry.path(), std::ios::binary);
      files[std::filesystem::path("s") / std::filesystem::relative(entry.path(), TROCAR_SOURCE_DIR "/scenes")] =
          std::string(std::istreambuf_iterator<char>(in), {});
    }
  return files;
}
std::string faults_with(MemoryFiles files) {
  try {
    read_scene("s/bleeding/scene.json", &files);
  } catch (const core::BadInput& bad) {
    return bad.what();
  }
  return "";
}
void put_in(std::string& text, const std::string& before, const std::string& after) {
  const size_t at = text.find(before);
  ASSERT_NE(at, text.npos);
  text.replace(at, before.size(), after);
}

TEST(SceneVessels, AnUnknownCarrierASecondHeartAndANameTwiceAreToldWithTheirPlaces) {
  MemoryFiles files = files_of_bleeding();
  EXPECT_EQ(faults_with(files), "");
  put_in(files["s/vessels/pelvis.json"], "[\"uterus\"]", "[\"utreus\"]");
  put_in(files["s/bleeding/scene.json"], "pelvis_veins.json\"]", "pelvis_veins.json\", \"more.json\"]");
  files["s/bleeding/more.json"] =
      "{\"format\": 1, \"name\": \"more\", \"sources\": [{\"node\": \"a\"}],\n"
      "\"heart\": {\"rate_per_min\": 100},\n\"vessels\": [\n"
      "{\"name\": \"uterine_left\", \"from\": \"a\", \"to\": \"b\", \"path_mm\": [[0, 0, 0], [0, 0, 9]], "
      "\"radius_mm\": 1, \"wave_speed_m_s\": 8}]}";
  const std::string faults = faults_with(files);
  EXPECT_NE(faults.find("did you mean \"uterus\"?"), faults.npos) << faults;
  EXPECT_NE(faults.find("s/vessels/pelvis.json:20:"), faults.npos) << faults;
  EXPECT_NE(faults.find("s/bleeding/more.json:2:10: expected heart and blood of a patient in the scene's first file"),
            faults.npos)
      << faults;
  EXPECT_NE(faults.find("s/bleeding/more.json:4:1: expected every vessel name once, got \"uterine_left\" again"),
            faults.npos)
      << faults;
}

TEST(SceneVessels, AScenesVesselsAreWrittenAndReadBack) {
  const Folder folder;
  const Description back = read_scene(folder.write("w.json", write_scene(described())));
  ASSERT_EQ(back.vessels.size(), 2u);
  ASSERT_TRUE(back.fluids.has_value());
  EXPECT_EQ(back.fluids->pool_middle, described().fluids->pool_middle);
  EXPECT_EQ(back.fluids->pool_size, described().fluids->pool_size);
  EXPECT_EQ(back.fluids->pool_on, described().fluids->pool_on);
  EXPECT_EQ(back.fluids->drops, described().fluids->drops);
  for (size_t tree = 0; tree < 2; ++tree) {
    const VesselTree &drawn = described().vessels[tree], &read = back.vessels[tree];
    EXPECT_EQ(read.pulse_gain, drawn.pulse_gain);
    for (size_t i = 0; i < drawn.vessels.size(); ++i) {
      const Vessel &a = drawn.vessels[i], &b = read.vessels[i];
      EXPECT_EQ(a.name, b.name);
      EXPECT_EQ(a.rides_on, b.rides_on);
      ASSERT_EQ(a.path.size(), b.path.size());
      for (size_t k = 0; k < a.path.size(); ++k) EXPECT_EQ(a.path[k], b.path[k]);
      EXPECT_EQ(drawn.graph.segments[i].length, read.graph.segments[i].length);
      EXPECT_EQ(drawn.graph.segments[i].vein, read.graph.segments[i].vein);
    }
  }
}

TEST(SceneVessels, ThePoolHasAFloorOfWallsAndBowelAndFilmHasPlacesOnEveryBody) {
  const sim::WetModel& wet = pelvis().wet;
  ASSERT_TRUE(wet.there);
  const fluids::PoolModel& pool = wet.model.pool;
  ASSERT_EQ(wet.floor.size(), size_t(pool.nx) * size_t(pool.ny));
  for (const float h : wet.floor) ASSERT_LT(std::fabs(h), 0.5f);
  const float middle = wet.floor[size_t(pool.ny / 2) * size_t(pool.nx) + size_t(pool.nx / 2)];
  EXPECT_GT(wet.floor.front(), middle) << "the rim is higher than the pouch";
  EXPECT_GT(wet.floor.back(), middle);
  const size_t bodies = size_t(pelvis().surfaces()) + pelvis().membranes.size() + pelvis().strands.size();
  ASSERT_EQ(wet.film.size(), bodies + 1);
  for (size_t i = 0; i < bodies; ++i) EXPECT_LT(wet.film[i], wet.film[i + 1]);
  EXPECT_EQ(wet.model.droplets.film_cells, wet.film.back());
}

TEST(SceneVessels, OtherAnatomiesBendTheirVesselsToo) {
  for (const std::uint64_t seed : {3, 11}) {
    Description d = described();
    vary(d, seed);
    const sim::Model m = compile(d);
    EXPECT_EQ(m.vessels.list.size(), 46u);
    const size_t v = size_t(m.vessel_index("tubal_left"));
    EXPECT_NE(m.vessels.list[v].path.length, path_of("tubal_left").length);
  }
}

}  // namespace
}  // namespace trocar::scene
