// The keys "peristalsis" and "breathing" of scene files.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <trocar/scene/compile/compile.hpp>
#include <trocar/scene/files/reader.hpp>
#include <trocar/scene/files/writer.hpp>

#include "files.hpp"

namespace trocar::scene {
namespace {

/// A scene with a straight piece of bowel, 80 mm long; what is moved stands in line 10.
std::string scene_with(const std::string& motion) {
  return "{\n\"format\": 1, \"name\": \"small\",\n\"tissues\": [{\"name\": \"soft\", \"density_kg_m3\": 1050, "
         "\"young_Pa\": 5000, \"source\": \"ours\"}],\n\"organs\": [{\"solids\": [\n"
         "{\"name\": \"bowel\", \"tissue\": \"soft\", \"cell_mm\": 6, \"sections\": [\n"
         "{\"centre_mm\": [0, 0, -100], \"across_mm\": [0, 10, 0], \"deep_mm\": [0, 0, 10]}, {\"centre_mm\": [40, 0, "
         "-100], \"across_mm\": [0, 10, 0], \"deep_mm\": [0, 0, 10]},\n"
         "{\"centre_mm\": [80, 0, -100], \"across_mm\": [0, 10, 0], \"deep_mm\": [0, 0, 10]}], \"anchors\": "
         "[{\"centre_mm\": [40, 0, -110], \"radius_mm\": 12}]},\n"
         "{\"name\": \"slice\", \"tissue\": \"soft\", \"cell_mm\": 6, \"cuttable\": true, \"sections\": "
         "[{\"centre_mm\": "
         "[0, 50, -100], \"across_mm\": [0, 10, 0], \"deep_mm\": [0, 0, 10]}, {\"centre_mm\": [40, 50, -100], "
         "\"across_mm\": [0, 10, 0], \"deep_mm\": [0, 0, 10]}], \"anchors\": [{\"centre_mm\": [20, 50, -110], "
         "\"radius_mm\": 12}]}\n"
         "]}],\n" +
         motion +
         "\n\"instruments\": [{\"name\": \"stick\", \"kind\": \"probe\"}],\n\"ports\": [{\"name\": \"navel\", "
         "\"position_mm\": [0, 0, 0], \"diameter_mm\": 10}],\n\"tools\": [],\n\"scope\": {\"port\": \"navel\", "
         "\"tip_mm\": [0, 0, -40]}\n}\n";
}

constexpr int kLine = 10;  ///< of what moves

/// The faults' messages. An '@' in `motion` marks where the first one is expected: "away from @" stands before it where
/// it is not there.
std::vector<std::string> faults_of(std::string motion) {
  const std::size_t at = motion.find('@');
  if (at != motion.npos) motion.erase(at, 1);
  const Folder folder;
  std::vector<std::string> messages;
  try {
    read_scene(folder.write("scene.json", scene_with(motion)));
  } catch (const core::BadInput& bad) {
    for (const core::Fault& f : bad.faults()) {
      const bool marked = !messages.empty() || (f.at.line == kLine && f.at.column == int(at) + 1);
      messages.push_back(marked ? f.message
                                : fmt::format("away from @, at {}:{}: {}", f.at.line, f.at.column, f.message));
    }
  }
  return messages;
}
std::vector<std::string> one(const std::string& fault) { return {fault}; }

std::string waves(const std::string& more, const std::string& solid = "\"bowel\"",
                  const std::string& stations = "{\"s_mm\": 0, \"pressure_kPa\": 2, \"speed_mm_s\": 15}") {
  return fmt::format("\"peristalsis\": [{{\"solid\": {}, \"stations\": [{}], {}}}],", solid, stations, more);
}

TEST(MotionFile, AGoodOneReadsInMetresPascalsAndSeconds) {
  const Folder folder;
  const Description d = read_scene(folder.write(
      "scene.json", scene_with(waves("\"per_minute\": 11, \"width_mm\": 8, \"first_s\": 3, \"cycle_s\": 30, "
                                     "\"active_share\": 0.2") +
                               "\"breathing\": {\"per_minute\": 14, \"amplitude_mm\": 9, \"carries\": [{\"body\": "
                               "\"bowel\", \"share\": 0.5}]},")));
  ASSERT_EQ(d.peristalsis.size(), 1u);
  const WaveSetting& w = d.peristalsis[0];
  EXPECT_EQ(w.solid, "bowel");
  ASSERT_EQ(w.stations.size(), 1u);
  EXPECT_EQ(w.stations[0].pressure, 2000);
  EXPECT_EQ(w.stations[0].speed, 0.015);
  EXPECT_EQ(w.per_minute, 11);
  EXPECT_EQ(w.width, 0.008);
  EXPECT_EQ(w.first, 3);
  EXPECT_EQ(w.cycle, 30);
  EXPECT_EQ(w.active_share, 0.2);
  ASSERT_TRUE(d.breathing);
  EXPECT_EQ(d.breathing->per_minute, 14);
  EXPECT_EQ(d.breathing->amplitude, 0.009);
  EXPECT_EQ(d.breathing->direction, (Vec3d{0, -1, 0}));
  ASSERT_EQ(d.breathing->carries.size(), 1u);
  EXPECT_EQ(d.breathing->carries[0].share, 0.5);
}

TEST(MotionFile, FaultsOfWavesAreToldWithTheirPlaces) {
  const std::string bowel = "\"bowel\"";
  const auto station = [](const std::string& s) {
    return "{\"s_mm\": " + s + ", \"pressure_kPa\": 2, \"speed_mm_s\": 15}";
  };
  EXPECT_EQ(faults_of(waves("\"per_minute\": 3")), std::vector<std::string>{});
  EXPECT_EQ(faults_of(waves("\"per_minute\": 3", "@\"bowl\"")),
            one("expected a known solid, got \"bowl\" (did you mean \"bowel\"?); known: bowel, slice"));
  EXPECT_EQ(faults_of(waves("\"per_minute\": 3", "@\"slice\"")),
            one("expected a solid that is not cuttable, got \"slice\""));
  EXPECT_EQ(faults_of(waves("\"per_minute\": @0")), one("expected a number in [0.1, 60] for \"per_minute\", got 0"));
  EXPECT_EQ(faults_of(waves("\"per_minute\": 60, \"width_mm\": @10")),
            one("expected at most half of the wavelength, 15 mm (15 mm/s at 60 per minute), got 10"));
  EXPECT_EQ(faults_of(waves("\"per_minute\": 3, \"active_share\": @1.5")),
            one("expected a number in [0, 1] for \"active_share\", got 1.5"));
  EXPECT_EQ(faults_of(waves("\"per_minute\": 3", bowel, station("9") + ", " + station("@9"))),
            one("expected more than the station before, 9 mm, got 9"));
  EXPECT_EQ(faults_of(waves("\"per_minute\": 3", bowel, station("@200"))),
            one("expected an arc length on the centre line (at most 80.0 mm), got 200"));
  EXPECT_EQ(faults_of(waves("\"per_minute\": 3, \"centreline_mm\": [[0, 0, 0], @[0, 0, 0]]")),
            one("expected a point at least 0.01 mm from the one before, got the same place"));
}

TEST(MotionFile, FaultsOfBreathingAreToldWithTheirPlaces) {
  const auto breathing = [](const std::string& keys) {
    return faults_of("\"breathing\": {\"per_minute\": 13, \"amplitude_mm\": 10, " + keys + "},");
  };
  EXPECT_EQ(breathing("\"carries\": [{\"body\": \"bowel\"}]"), std::vector<std::string>{});
  EXPECT_EQ(breathing("\"carries\": [{\"body\": @\"bowels\"}]"),
            one("expected a known solid, strand, membrane or pouch, got \"bowels\" (did you mean \"bowel\"?); known: "
                "bowel, slice"));
  EXPECT_EQ(breathing("\"carries\": [{\"body\": \"bowel\"}, {\"body\": @\"bowel\"}]"),
            one("expected every body once, got \"bowel\" again"));
  EXPECT_EQ(breathing("\"carries\": [{\"body\": \"bowel\"}], \"direction\": @[0, 0, 0]"),
            one("expected a direction, got none"));
  EXPECT_EQ(breathing("\"carries\": @[]").size(), 1u);
}

TEST(MotionFile, ALineThatMissesItsOrganIsAFaultOfTheCompiler) {
  const Folder folder;
  const Description d = read_scene(
      folder.write("scene.json", scene_with(waves("\"per_minute\": 3, \"centreline_mm\": [[0, 0, 0], [80, 0, 0]]"))));
  try {
    compile(d);
    FAIL() << "it compiled";
  } catch (const core::BadInput& bad) {
    ASSERT_EQ(bad.faults().size(), 1u);
    EXPECT_EQ(bad.faults()[0].at.line, kLine);
    EXPECT_NE(bad.faults()[0].message.find("expected waves along 'bowel'"), std::string::npos);
  }
}

TEST(MotionFile, AWrittenSceneMovesAsItsSourceDoes) {
  const Folder folder;
  const Description d = read_scene(TROCAR_SOURCE_DIR "/scenes/digestive/scene.json");
  const Description again = read_scene(folder.write("scene.json", write_scene(d)));
  EXPECT_EQ(write_scene(again), write_scene(d));
  ASSERT_EQ(again.peristalsis.size(), d.peristalsis.size());
  for (std::size_t i = 0; i < d.peristalsis.size(); ++i) {
    const WaveSetting &a = d.peristalsis[i], &b = again.peristalsis[i];
    EXPECT_EQ(a.solid, b.solid);
    EXPECT_EQ(a.width, b.width);
    EXPECT_EQ(a.per_minute, b.per_minute);
    EXPECT_EQ(a.active_share, b.active_share);
    ASSERT_EQ(a.stations.size(), b.stations.size());
    for (std::size_t k = 0; k < a.stations.size(); ++k) {
      EXPECT_EQ(a.stations[k].s, b.stations[k].s);
      EXPECT_EQ(a.stations[k].pressure, b.stations[k].pressure);
      EXPECT_EQ(a.stations[k].speed, b.stations[k].speed);
    }
  }
  ASSERT_TRUE(again.breathing);
  EXPECT_EQ(again.breathing->amplitude, d.breathing->amplitude);
  EXPECT_EQ(again.breathing->direction, d.breathing->direction);
  EXPECT_EQ(again.breathing->carries.size(), d.breathing->carries.size());
}

}  // namespace
}  // namespace trocar::scene
