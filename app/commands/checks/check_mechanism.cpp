#include "commands/checks/check_mechanism.hpp"

#include <trocar/kinematics/loops/mobility.hpp>
#include <trocar/scene/mechanisms/mechanism_file.hpp>

namespace trocar::app {

bool is_mechanism_file(const std::filesystem::path& path) {
  if (path.extension() == ".urdf") return true;
  std::vector<core::Fault> ignored;
  return path.extension() == ".json" && scene::load_json(path, ignored).root.find("links") != nullptr;
}

Json describe_mechanism(const std::filesystem::path& path) {
  const kinematics::Mechanism m = kinematics::build(scene::read_mechanism(path));
  std::vector<double> u = m.start_u();
  const kinematics::Mobility freedoms = kinematics::mobility(m, u);
  Json out{{"file", path.string()},         {"kind", "mechanism"},
           {"links", m.links.size() - 1},   {"coordinates", m.q_count()},
           {"free", m.u_count()},           {"conditions", m.rows},
           {"mobility", freedoms.mobility}, {"mobility_words", words(freedoms)}};
  if (freedoms.poses == 0) out["verdict"] = "its loops do not close where it begins";
  return out;
}

}  // namespace trocar::app
