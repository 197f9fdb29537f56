// A scene with one body, as files; what compiling says of it, and whether it hangs still.
#pragma once

#include <filesystem>

#include <trocar/scene/compile/compile.hpp>
#include <trocar/scene/files/reader.hpp>

#include "files.hpp"

namespace trocar::scene {

/// A scene of one organ, and files beside it.
struct OneBodyScene {
  Folder folder;

  std::filesystem::path scene(const std::string& bodies) {
    folder.write("organ.json", R"({"format": 1, )" + bodies + "}");
    return folder.write("scene.json", R"({"format": 1, "name": "one", "organs": ["organ.json"],
  "tissues": [{"name": "liver", "density_kg_m3": 1060, "young_Pa": 5400, "source": "ours"}],
  "instruments": [{"name": "grasper", "kind": "grasper"}],
  "ports": [{"name": "a", "position_mm": [0, 0, 200], "diameter_mm": 10}, {"name": "b", "position_mm": [50, 0, 200]}],
  "tools": [{"instrument": "grasper", "port": "b", "tip_mm": [50, 0, 150]}],
  "scope": {"port": "a", "tip_mm": [0, 0, 150]}})");
  }
  std::filesystem::path solid(const std::string& keys) {
    return scene(R"("solids": [{"name": "body", "tissue": "liver", )" + keys +
                 R"(, "anchors": [{"centre_mm": [0, 0, 0], "radius_mm": 60, "stiffness_N_m": 200}]}])");
  }
  std::filesystem::path pouch(const std::string& keys) {
    return scene(R"("pouches": [{"name": "body", "tissue": "liver", "thickness_mm": 2, )" + keys +
                 R"(, "held": [{"centre_mm": [0, 0, 0], "radius_mm": 20}]}])");
  }
  std::vector<std::string> faults(const std::filesystem::path& file) {
    std::vector<std::string> told;
    for (const core::Fault& f : check_file(file)) told.push_back(f.message);
    return told;
  }
};

inline const BodyReport& body_of(const CompileReport& report) {
  for (const BodyReport& b : report.bodies)
    if (b.name == "body") return b;
  throw std::logic_error("no body");
}

/// Made at rest as drawn: how far the skin goes in a third of a second.
/// @param of  only of this organ, below 0: of all
inline double drift(const sim::Model& model, int of = -1) {
  sim::State state = sim::initial_state(model);
  sim::Work work = sim::make_work(model);
  for (int i = 0; i < 300; ++i) sim::step(model, model.start, state, work);
  double most = 0;
  for (int organ = 0; organ < model.organs(); ++organ) {
    if (of >= 0 && organ != of) continue;
    const tissue::Skin& skin = model.skin(organ);
    for (int v = 0; v < skin.size(); ++v)
      if (skin.at_surface(v))
        most = std::max(most, length(vec_cast<double>(work.organs[std::size_t(organ)].pose.position[std::size_t(v)]) -
                                     vec_cast<double>(skin.rest[std::size_t(v)])));
  }
  return most;
}

}  // namespace trocar::scene
