// Which tracked tool leads what: a file (JSON with comments, docs/guides/trackers.md).
//
//   {"format": 1, "server": "127.0.0.1:18944", "x_points": "left", "y_points": "head",
//    "tools": [{"role": "right", "transform": "RightToReference", "tip_mm": [0, 0, -310],
//               "grip": {"sensor": "Grips", "index": 1, "open": 0, "closed": 1}}]}
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <trocar/core/error.hpp>
#include <trocar/numerics/vec3.hpp>
#include <trocar/scene/json/shape.hpp>

namespace trocar::attempt {

struct TrackerPlan {
  struct Grip {
    std::string sensor;
    int index = 0;
    double open = 0, closed = 1;  ///< the sensor's values
  };
  struct Tool {
    std::string role;       ///< camera, left, right, or a trocar's name (attempt/team/duty.hpp)
    std::string transform;  ///< its name at the tracker
    Vec3d tip;              ///< of the instrument, in the tool's own frame [m]
    std::optional<Grip> grip;
    core::Location at = {};  ///< of the name in the file
  };
  std::string file, address;
  int port = 0;
  Mat3d axes = Mat3d::identity();  ///< columns: where the tracker's x, y, z point in the scene
  double scale = 1;                ///< of ways
  /// Where the tracker's origin lies in the scene [m]; nothing: a tool's tip is where the scene places it when it is
  /// first seen, and goes from there.
  std::optional<Vec3d> origin;
  std::vector<Tool> tools;
};

/// What may go wrong with it: names that the protocol cuts, and names that are cut to the same.
std::vector<core::Fault> warnings_of(const TrackerPlan& plan);

/// @throws core::BadInput with all faults
TrackerPlan read_tracker_plan(const std::filesystem::path& file);
TrackerPlan read_tracker_plan_text(const std::string& text, const std::string& name);
/// Its shape, for the published schema.
const scene::Shape& tracker_plan_shape();

}  // namespace trocar::attempt
