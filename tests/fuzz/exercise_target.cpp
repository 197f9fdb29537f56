// The exercise reader.
#include <cmath>
#include <fstream>
#include <sstream>

#include <trocar/training/exercise/exercise.hpp>
#include <trocar/training/expert/demonstration.hpp>

#include "archive.hpp"
#include "targets.hpp"

namespace trocar::fuzz {

void exercise_file(Bytes bytes) {
  const scene::MemoryFiles files = unpacked(text_of(bytes));
  try {
    const training::Exercise e = training::read_exercise(kMainFile, &files);
    require(!e.name.empty() && !e.scene.empty(), "an exercise that reads well has a name and a scene");
    require(e.expert_time < e.longest_time && std::isfinite(e.pass_mark), "its thresholds are in order");
    std::vector<core::Fault> faults;
    training::check_demonstration(e, nullptr, faults);
    require(faults.size() <= scene::kMaxFaults + 1, "faults are bounded");
  } catch (const core::BadInput& bad) {
    require(!bad.faults().empty(), "a refusal has a reason");
    for (const core::Fault& f : bad.faults()) require(!f.message.empty() && !f.at.file.empty(), "a fault says where");
  }
}

/// The shipped exercises, each packed with the common rules that it includes.
std::vector<Seed> exercise_seeds() {
  const auto text_of = [](const std::string& file) {
    std::stringstream text;
    text << std::ifstream(TROCAR_SOURCE_DIR "/scenes/" + file, std::ios::binary).rdbuf();
    return text.str();
  };
  std::vector<Seed> seeds;
  for (const char* name : {"sterilisation", "bleeding-control"}) {
    scene::MemoryFiles files{{kMainFile, text_of("gynaecology/" + std::string(name) + ".json")}};
    for (const char* common : {"handling", "clips", "energy", "bleeding"})
      files["../common/" + std::string(common) + ".json"] = text_of("common/" + std::string(common) + ".json");
    seeds.push_back({name, bytes_of(packed(files))});
  }
  for (const char* condition :
       {R"({"any": [{"any": [{"fact": "attempt.time_s", "min": 1}], "for_each": "a"}], "for_each": "b"})",
        R"({"fact": "mark.in_view", "of": "$a.m"})"})
    seeds.push_back({condition[2] == 'a' ? "nested" : "names",
                     bytes_of(packed({{kMainFile, R"({"format": 3, "name": "n", "title": "t", "scene": "s.json",
      "score": {"quality": 60, "time": 25, "motion": 15, "source": "s"}, "hold_s": 0.2, "expert_s": 1, "longest_s": 9,
      "pass_mark": 50, "sets": {"a": [{"name": "x", "m": ["$b"]}, {"name": "y", "m": "z"}], "b": {"marks": "*i*o*"}},
      "demonstration": [{"for_each": "a", "goals": [{"goal": "{n}", "do": [{"skill": "hold", "for_s": 1}]}]}],
      "rehearsed": [{"seed": 1, "choices": [[1, 2], [3, 4]]}], "steps": [{"step": "a", "title": "{title}", "when": )" +
                                                      std::string(condition) + "}]}"}}))});
  return seeds;
}

}  // namespace trocar::fuzz
