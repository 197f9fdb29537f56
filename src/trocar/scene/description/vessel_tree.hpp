// Arteries or veins of one file, as a graph whose segments run along paths through the body.
#pragma once

#include <string>
#include <vector>

#include <trocar/core/error.hpp>
#include <trocar/numerics/vec3.hpp>
#include <trocar/scene/json/json.hpp>
#include <trocar/vessels/graph.hpp>

namespace trocar::scene {

/// A vessel: the graph's segment of the same number, and where it runs.
struct Vessel {
  std::string name;
  std::vector<Vec3d> path;               ///< of its middle, from its first node to its second; two points or more [m]
  std::vector<std::string> rides_on;     ///< solids, strands, membranes, pouches that it goes with where they are near
  std::vector<core::Location> rides_at;  ///< (rides_on)
  double reach = 0.004;                  ///< how near that is [m]
  core::Location at;
};

struct VesselTree {
  std::string name;
  double pulse_gain = 1;  ///< of what the pulse does to its surroundings and of what is shown; 1 = physical
  vessels::VesselGraph graph;
  std::vector<Vessel> vessels;     ///< (segments)
  std::vector<std::string> nodes;  ///< names, in the graph's order
  bool says_heart = false;         ///< it has figures of the heart or of the blood
  core::Location at, heart_at;
  JsonValue text;  ///< as it was read
};

}  // namespace trocar::scene
