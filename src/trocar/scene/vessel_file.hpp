// Files of vessels: arteries or veins as a graph whose segments run along paths through the body, what feeds them and
// what their ends give way to. All faults in one pass, those of the graph as a whole included: figures that cannot be,
// cycles where a tree is asked for, parts that nothing feeds, paths that do not meet where they shall.
//
//   const VesselTree tree = read_vessels("scenes/vessels/pelvis.json");
//   const vessels::FlowModel flow = vessels::build(tree.graph);  // vessels/flow.hpp
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <trocar/scene/json.hpp>
#include <trocar/scene/shape.hpp>
#include <trocar/vessels/graph.hpp>

namespace trocar::scene {

/// A vessel: the graph's segment of the same number, and where it runs.
struct Vessel {
  std::string name;
  std::vector<Vec3d> path;            ///< of its middle, from its first node to its second; two points or more [m]
  std::vector<std::string> rides_on;  ///< solids and strands that it goes with where they are near
  double reach = 0.004;               ///< how near that is [m]
  core::Location at;
};

struct VesselTree {
  std::string name;
  vessels::VesselGraph graph;
  std::vector<Vessel> vessels;     ///< (segments)
  std::vector<std::string> nodes;  ///< names, in the graph's order
};

/// Throws core::BadInput with every fault. With `memory` the file is looked up there.
VesselTree read_vessels(const std::filesystem::path& path, const MemoryFiles* memory = nullptr);

/// The same, faults appended; with any, what is returned is not sound.
VesselTree read_vessels(const std::filesystem::path& path, std::vector<core::Fault>& faults, const MemoryFiles* memory);

const Shape& vessels_shape();

}  // namespace trocar::scene
