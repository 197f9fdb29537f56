// The exercise reader.
#include <cmath>
#include <fstream>
#include <sstream>

#include <trocar/training/exercise/exercise.hpp>

#include "archive.hpp"
#include "targets.hpp"

namespace trocar::fuzz {

void exercise_file(Bytes bytes) {
  const scene::MemoryFiles files = unpacked(text_of(bytes));
  try {
    const training::Exercise e = training::read_exercise(kMainFile, &files);
    require(!e.name.empty() && !e.scene.empty(), "an exercise that reads well has a name and a scene");
    require(e.expert_time < e.longest_time && std::isfinite(e.pass_mark), "its thresholds are in order");
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
  return seeds;
}

}  // namespace trocar::fuzz
