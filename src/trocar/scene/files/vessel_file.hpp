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

#include <trocar/scene/description/vessel_tree.hpp>
#include <trocar/scene/json/shape.hpp>

namespace trocar::scene {

/// Throws core::BadInput with every fault. With `memory` the file is looked up there.
VesselTree read_vessels(const std::filesystem::path& path, const MemoryFiles* memory = nullptr);

/// The same, faults appended; with any, what is returned is not sound.
VesselTree read_vessels(const std::filesystem::path& path, std::vector<core::Fault>& faults, const MemoryFiles* memory);
/// The same of a file that is open already.
VesselTree read_vessels(const JsonObject& file, std::vector<core::Fault>& faults);

/// As it was read, but for the places of its paths, which may have been moved.
JsonValue written_vessels(const VesselTree& tree);

const Shape& vessels_shape();

}  // namespace trocar::scene
