// Files of vessels as the modeller writes them: a tree that one node feeds.
#pragma once

#include <string>
#include <vector>

#include <trocar/modeller/operations/operation.hpp>

namespace trocar::modeller {

struct VesselText {
  std::string name;
  bool veins = false;
  std::vector<scene::JsonValue> vessels, ends;
  double flow_mL_min = 60;  ///< of the whole tree, at rest
};
/// What leads to the node "root" takes a sixth of an artery's pressure there (ours), so that an opened trunk does not
/// bleed as an aorta would.
std::string written_vessels(const VesselText& tree);

/// Where blood ends that takes up so much.
scene::JsonValue vessel_end(const std::string& node, double flow_mL_min);

/// A new file of vessels, named by the document's root. @param file  relative to the root
void put_vessel_file(Draft& draft, const std::string& file, std::string text);

}  // namespace trocar::modeller
