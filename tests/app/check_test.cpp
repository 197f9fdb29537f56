// `trocar check` of scenes that can be compiled and are not good: what it says, and that it ends in some seconds. And
// of exercises with a fault: its place, and what would be right.
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <regex>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <trocar/core/error.hpp>
#include <trocar/scene/files/reader.hpp>

#include "run_program.hpp"

namespace trocar::app {
namespace {

namespace fs = std::filesystem;

std::string text_of(const fs::path& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

/// A copy of the shipped scenes that a test may spoil.
class Check : public testing::Test {
 protected:
  void SetUp() override {
    m_folder = fs::temp_directory_path() / ("trocar_check_test_" + std::to_string(getpid()));
    fs::remove_all(m_folder);
    fs::create_directories(m_folder);
    setenv("TROCAR_DATA", (m_folder / "data").c_str(), 1);
    fs::copy(TROCAR_SOURCE_DIR "/scenes", m_folder / "scenes", fs::copy_options::recursive);
  }
  void TearDown() override { fs::remove_all(m_folder); }

  fs::path scenes(const std::string& name) const { return m_folder / "scenes" / name; }

  void replace(const std::string& file, const std::string& pattern, const std::string& by) const {
    const std::string text = text_of(scenes(file));
    const std::string changed = std::regex_replace(text, std::regex(pattern), by);
    EXPECT_NE(changed, text) << pattern;
    std::ofstream(scenes(file)) << changed;
  }
  /// A factor on every number of a key in a file.
  void scale(const std::string& file, const std::string& key, double factor) const {
    std::string text = text_of(scenes(file)), out;
    const std::regex pattern("\"" + key + "\": ([0-9.]+)");
    auto at = text.cbegin();
    for (std::sregex_iterator m(text.begin(), text.end(), pattern), end; m != end; ++m) {
      out.append(at, (*m)[1].first);
      out += std::to_string(factor * std::stod((*m)[1]));
      at = (*m)[1].second;
    }
    out.append(at, text.cend());
    EXPECT_NE(out, text) << key;
    std::ofstream(scenes(file)) << out;
  }
  Json checked(const std::string& scene, int exit) const {
    const Outcome o = trocar({"check", scenes(scene).string(), "--json"});
    EXPECT_EQ(o.exit, exit) << o.err;
    return o.json()["files"][0];
  }

 private:
  fs::path m_folder;
};

TEST_F(Check, ShippedScenesAreGood) {
  for (const char* scene :
       {"gynaecology/scene.json", "cutting/scene.json", "gallbladder/scene.json", "gallbladder_bed/scene.json",
        "gallbladder_bed_inflamed/scene.json", "gallbladder_bed_scarred/scene.json",
        "cholecystectomy_adherent/scene.json", "calot_inflamed/scene.json", "digestive/scene.json", "bowel/scene.json",
        "cholecystectomy/scene.json"}) {
    const Json r = checked(scene, core::kDone);
    EXPECT_EQ(r["verdict"], "good") << r["doubts"].dump() << r["sinks"].dump();
    EXPECT_GT(r["stood_s"].get<double>(), 0);
  }
}

TEST_F(Check, TellsWhatKindEveryShippedFileIsByItsFolder) {
  const std::pair<const char*, const char*> folders[] = {
      {"common", "rules"}, {"instruments", "instrument"}, {"looks", "look"}};
  for (const auto& [folder, kind] : folders)
    for (const fs::directory_entry& file : fs::directory_iterator(scenes(folder)))
      EXPECT_EQ(checked(std::string(folder) + "/" + file.path().filename().string(), core::kDone)["kind"], kind);
  for (const fs::directory_entry& file : fs::directory_iterator(scenes("organs"))) {
    if (file.path().extension() != ".json") continue;
    EXPECT_EQ(scene::kind_of_file(file.path()), scene::FileKind::organ) << file.path();
  }
}

TEST_F(Check, TellsWhatDevicesLead) {
  EXPECT_EQ(checked("inputs/two_pads.json", core::kDone)["leads"][0]["by"], "gamepad 2");
  EXPECT_EQ(checked("inputs/space_mouse.json", core::kDone)["kind"], "input map");
  EXPECT_EQ(checked("inputs/tracker.json", core::kDone)["leads"].size(), 3u);
}

TEST_F(Check, ATrackersNameThatTheProtocolCutsIsAWarning) {
  replace("inputs/tracker.json", "\"RightToReference\"", "\"RightGrasperTipToReference\"");
  const Json r = checked("inputs/tracker.json", core::kDone);
  EXPECT_EQ(r["verdict"], "to mend");
  ASSERT_EQ(r["warnings"].size(), 1u);
  EXPECT_NE(r["warnings"][0].get<std::string>().find("\"RightGrasperTipToRef\""), std::string::npos) << r["warnings"];
}

TEST_F(Check, AScanIsToldWithItsSizeAndPlace) {
  // Steps of 2, 3 and 4 mm to the left, the back and the head; the second of two time points holds fives.
  std::ofstream(scenes("scan.nrrd"), std::ios::binary)
      << "NRRD0004\ntype: uchar\ndimension: 4\nspace: left-posterior-superior\nsizes: 2 2 2 2\n"
         "space directions: (2,0,0) (0,3,0) (0,0,4) none\nspace origin: (10,20,30)\nkinds: space space space time\n"
         "encoding: raw\n\n"
      << "\1\1\1\1\1\1\1\1\5\5\5\5\5\5\5\5";
  const Json r = checked("scan.nrrd", core::kDone);
  EXPECT_EQ(r["kind"], "scan");
  EXPECT_EQ(r["spacing_mm"], Json({2.0, 3.0, 4.0}));
  EXPECT_EQ(r["box_lps_mm"], Json({{10.0, 20.0, 30.0}, {12.0, 23.0, 34.0}}));
  EXPECT_NE(r["notes"].dump().find("--frame chooses another"), std::string::npos) << r["notes"];
  const Outcome later = trocar({"check", scenes("scan.nrrd").string(), "--frame", "1"});
  EXPECT_NE(later.out.find("values 5 to 5"), std::string::npos) << later.out << later.err;
}

TEST_F(Check, AnOrganOfPouchesAloneIsAnOrgan) {
  EXPECT_EQ(checked("organs/gallbladder_free.json", core::kDone)["kind"], "organ");
}

TEST_F(Check, AFaultInRulesIsToldAsOfTheirOwnFile) {
  setenv("TROCAR_SCENES", scenes("").c_str(), 1);
  replace("common/stitch.json", "\"off_mark_mm\": \\{\"value\": 1", "\"off_mark_mm\": {\"value\": \"one\"");
  const Outcome o = trocar({"check", scenes("common/stitch.json").string()});
  unsetenv("TROCAR_SCENES");
  EXPECT_EQ(o.exit, core::kBadInput);
  EXPECT_NE(o.err.find("common/stitch.json:8:"), std::string::npos) << o.err;
  EXPECT_EQ(std::count(o.err.begin(), o.err.end(), '\n'), 1) << o.err;
}

TEST_F(Check, TissueTooHeavyForItsSpringsIsNotInEquilibrium) {
  scale("tissues.json", "density_kg_m3", 10);
  const Json r = checked("gynaecology/scene.json", core::kGoalNotReached);
  EXPECT_EQ(r["verdict"], "not in equilibrium");
  ASSERT_FALSE(r["sinks"].empty());
  const std::string told = r["sinks"][0];
  EXPECT_EQ(told.find("uterus is not in equilibrium: "), 0u) << told;
  EXPECT_NE(told.find("it sagged by "), std::string::npos) << told;
  EXPECT_NE(told.find("more anchors"), std::string::npos) << told;
  const Outcome o = trocar({"train", scenes("gynaecology/scene.json").string(), "--headless", "--input",
                            "motion:" TROCAR_SOURCE_DIR "/no such file"});
  EXPECT_NE(o.err.find("uterus is not in equilibrium"), std::string::npos) << "train warns, too: " << o.err;
}

TEST_F(Check, AHeavySceneIsLookedAtForAShorterTimeAndSaysSo) {
  for (const char* organ : {"uterus", "bladder", "rectosigmoid"})
    scale(std::string("organs/") + organ + ".json", "cell_mm", 0.5);
  replace("tissues.json", "\"young_Pa\": 30000,", "\"young_Pa\": 3e6,");
  const Outcome o = trocar({"check", scenes("gynaecology/scene.json").string()});
  EXPECT_NE(o.out.find(" s only, as the scene is heavy"), std::string::npos) << o.out;
  EXPECT_NE(o.out.find("Here and now it would run in slow motion: 0."), std::string::npos) << o.out;
  EXPECT_NE(o.err.find("scene.json: "), std::string::npos) << "what it is at: " << o.err;
  EXPECT_NE(o.err.find(" s so far)"), std::string::npos) << o.err;
}

TEST_F(Check, AnInstrumentThatBeginsInsideAnOrganIsToldWithItsPlace) {
  replace("gynaecology/scene.json", "\"tip_mm\": \\[26, -124, -75\\]", "\"tip_mm\": [-5, -165, -115]");
  const Json r = checked("gynaecology/scene.json", core::kDone);
  EXPECT_EQ(r["verdict"], "to mend");
  ASSERT_EQ(r["doubts"].size(), 1u) << r["doubts"].dump();
  const std::string told = r["doubts"][0];
  EXPECT_NE(told.find("gynaecology/scene.json:"), std::string::npos) << told;
  EXPECT_NE(told.find("expected the tip of 'grasper' outside of tissue, got one that begins "), std::string::npos)
      << told;
}

/// A block of 2 x 2 x 2 cubes of 10 mm, six tetrahedra each, as Gmsh 1 writes it.
std::string block_of_tets(const std::function<void(std::vector<std::array<int, 4>>&)>& spoil = {}) {
  std::vector<std::array<int, 4>> cells;
  const auto node = [](int i, int j, int k) { return 1 + i + 3 * j + 9 * k; };
  constexpr int order[6][3] = {{0, 1, 2}, {0, 2, 1}, {1, 0, 2}, {1, 2, 0}, {2, 0, 1}, {2, 1, 0}};
  for (int c = 0; c < 8; ++c)
    for (const auto& axes : order) {
      int at[3] = {c & 1, c >> 1 & 1, c >> 2};
      std::array<int, 4> cell{node(at[0], at[1], at[2])};
      for (size_t i = 0; i < 3; ++i) {
        ++at[axes[i]];
        cell[i + 1] = node(at[0], at[1], at[2]);
      }
      if ((axes[1] - axes[0] + 3) % 3 == 2) std::swap(cell[2], cell[3]);
      cells.push_back(cell);
    }
  if (spoil) spoil(cells);
  std::string text = "$NOD\n27\n";
  for (int n = 0; n < 27; ++n)
    text += std::to_string(n + 1) + " " + std::to_string(10 * (n % 3)) + " " + std::to_string(10 * (n / 3 % 3)) + " " +
            std::to_string(10 * (n / 9)) + "\n";
  text += "$ENDNOD\n$ELM\n" + std::to_string(cells.size()) + "\n";
  for (size_t c = 0; c < cells.size(); ++c) {
    text += std::to_string(c + 1) + " 4 1 1 4";
    for (const int corner : cells[c]) text += " " + std::to_string(corner);
    text += "\n";
  }
  return text + "$ENDELM\n";
}

/// The scene `cutting` with one organ from a mesh, hung up at its whole lower face.
Json of_mesh(const fs::path& scenes, const std::string& mesh) {
  std::ofstream(scenes / "cutting" / "block.msh") << mesh;
  std::ofstream(scenes / "cutting" / "block.json") << R"({
  "format": 1, "name": "block",
  "solids": [{"name": "liver", "tissue": "liver", "mesh": {"file": "block.msh", "place_mm": [-10, -10, -110]},
              "anchors": [{"centre_mm": [0, 0, -110], "radius_mm": 16}, {"centre_mm": [0, 0, -90], "radius_mm": 16}]}]
})";
  std::string text = text_of(scenes / "cutting" / "scene.json");
  const auto from = text.find("\"organs\": ["), to = text.find(']', from);
  text.replace(from, to - from, "\"organs\": [\"block.json\"");
  std::ofstream(scenes / "cutting" / "scene.json") << text;
  const Outcome o = trocar({"check", (scenes / "cutting" / "scene.json").string(), "--json"});
  EXPECT_EQ(o.exit, core::kDone) << o.err;
  return o.json()["files"][0];
}

TEST_F(Check, AScenesMeshIsLookedAtAsTheMeshAloneIs) {
  const Json good = of_mesh(scenes(""), block_of_tets());
  EXPECT_EQ(good["verdict"], "good") << good["doubts"].dump();
  const Json spoilt = of_mesh(scenes(""), block_of_tets([](auto& cells) {
                                std::swap(cells[5][0], cells[5][1]);
                                cells.push_back(cells[9]);
                              }));
  EXPECT_EQ(spoilt["verdict"], "to mend");
  const std::string told = spoilt["doubts"].dump();
  EXPECT_NE(told.find("block.json:3:"), std::string::npos) << told;
  EXPECT_NE(told.find("1 duplicate cell left out"), std::string::npos) << told;
  EXPECT_NE(told.find("1 inverted cell turned"), std::string::npos) << told;
}

TEST_F(Check, AScenesMeshInPiecesIsToMend) {
  const Json r = of_mesh(scenes(""), block_of_tets([](auto& cells) {
                           cells.erase(cells.begin() + 6, cells.begin() + 42);  // two cubes in opposite corners
                         }));
  EXPECT_EQ(r["verdict"], "to mend");
  EXPECT_NE(r["doubts"].dump().find("2 parts that share no face"), std::string::npos) << r["doubts"].dump();
}

/// Rules of an exercise in the box of vessels; an '@' marks where a fault is expected.
struct Faulty {
  const char *name, *rules, *saying;
};

constexpr const char* kHead =
    R"({"format": 3, "name": "faulty", "title": "Faulty", "scene": "../box_vessels/scene.json",
"score": {"quality": 60, "time": 25, "motion": 15, "source": "ours"},
"hold_s": 0.2, "expert_s": 10, "longest_s": 100, "pass_mark": 50,
)";

constexpr Faulty kFaulty[] = {
    {"the scene lacks a fact",
     R"("steps": [{"step": "a", "title": "A", "when": {"fact": @"blood.lost_mL", "max": 1}}])",
     "a scene with fluids for \"blood.lost_mL\", got none"},
    {"a wrong unit", R"("limits": {"long_s": {"value": 1, "source": "ours"}},
"steps": [{"step": "a", "title": "A", "when": {"fact": "hand.depth_mm", "hand": "left", "min": @"$long_s"}}])",
     "a limit in the unit \"mm\" (millimetres), got \"long_s\" (seconds)"},
    {"no price", R"("steps": [{"step": "a", "title": "A", "on": {"event": "clipped"}}],
"errors": [@{"code": "E", "name": "e", "meaning": "m", "source": "ours", "on": {"event": "grasped"}}])",
     "a penalty for E: points, or fails: true, got none"},
    {"nothing can make it true", R"("steps": [@{"step": "a", "title": "A"}])",
     "when or on for the step \"a\", got neither: nothing can make it true"},
    {"an event on no body", R"("steps": [{"step": "a", "title": "A", "on": @{"event": "clipped", "on": []}}])",
     "an event that can make the step \"a\" true, got one on no body"},
    {"a circle of after", R"("steps": [@{"step": "a", "title": "A", "after": "b", "on": {"event": "clipped"}},
{"step": "b", "title": "B", "after": "a", "on": {"event": "clipped"}}])",
     "got a cycle: \"a\" waits for \"b\", and \"b\" waits for \"a\""},
    {"a circle of when", R"("steps": [@{"step": "a", "title": "A", "when": {"step": "b"}},
{"step": "b", "title": "B", "when": {"step": "a"}}])",
     "got a cycle: \"a\" waits for \"b\", and \"b\" waits for \"a\""},
    {"an attribute out of bounds",
     R"("steps": [{"step": "a", "title": "A", "on": {"event": "clipped", "angle_deg": @{"min": 500}}}])",
     "a possible value of \"angle_deg\", 0 to 90 deg, got at least 500"},
    {"a count out of bounds",
     R"("steps": [{"step": "a", "title": "A", "on": {"event": "clipped", "tips_visible": @3}}])",
     "a possible value of \"tips_visible\", 0 to 2, got 3"},
};

/// Takes the '@' out. @return "line:column" of where it stood
std::string place_of_mark(std::string& text) {
  const std::size_t at = text.find('@');
  text.erase(at, 1);
  const auto line = 1 + std::count(text.begin(), text.begin() + std::ptrdiff_t(at), '\n');
  return fmt::format("{}:{}", line, at - text.rfind('\n', at));
}

TEST_F(Check, AnExercisesFaultIsToldWithItsPlaceAndWhatWouldBeRight) {
  for (const Faulty& faulty : kFaulty) {
    std::string text = std::string(kHead) + faulty.rules + "}\n";
    const std::string place = place_of_mark(text);
    std::ofstream(scenes("basics/faulty.json")) << text;
    const Outcome o = trocar({"check", scenes("basics/faulty.json").string()});
    EXPECT_EQ(o.exit, core::kBadInput) << faulty.name;
    EXPECT_NE(o.err.find("basics/faulty.json:" + place + ": expected "), std::string::npos)
        << faulty.name << ", " << place << "\n"
        << o.err;
    EXPECT_NE(o.err.find(faulty.saying), std::string::npos) << faulty.name << "\n" << o.err;
  }
}

TEST_F(Check, ASceneOutsideOfTheExercisesTreeIsNeitherOpenedNorQuoted) {
  const fs::path secret = fs::temp_directory_path() / ("trocar_secret_" + std::to_string(getpid()));
  std::ofstream(secret) << "hunter2";
  replace("basics/camera-0.json", "\"scene\": \"[^\"]*\"", "\"scene\": \"" + secret.string() + "\"");
  const Outcome o = trocar({"check", scenes("basics/camera-0.json").string()});
  fs::remove(secret);
  EXPECT_EQ(o.exit, core::kBadInput);
  EXPECT_NE(o.err.find("in a library of TROCAR_LIBRARY"), std::string::npos) << o.err;
  EXPECT_EQ(o.err.find("hunter2"), std::string::npos) << o.err;
}

}  // namespace
}  // namespace trocar::app
