#include "commands/checks/check_vessels.hpp"

#include <algorithm>
#include <chrono>
#include <stdexcept>
#include <vector>

#include <fmt/format.h>

#include <trocar/core/error.hpp>
#include <trocar/core/text.hpp>
#include <trocar/scene/files/vessel_file.hpp>
#include <trocar/vessels/flow.hpp>

namespace trocar::app {

namespace {

constexpr double kSettle = 10;    // [s] of heartbeat before anything is measured
constexpr int kMeasured = 5'000;  // [ticks]: some beats and a breath

/// Of one vessel's middle.
struct Measured {
  double flow = 0, low = 1e300, high = -1e300;  ///< mean [m^3/s]; pressure [Pa]
};

vessels::FlowModel built(const scene::VesselTree& tree, const std::filesystem::path& path) {
  try {
    return vessels::build(tree.graph);
  } catch (const std::exception& unsound) {  // too many cells or anastomoses
    throw core::BadInput({{{path.generic_string(), 0, 0}, unsound.what()}});
  }
}

}  // namespace

Json describe_vessels(const std::filesystem::path& path) {
  const scene::VesselTree tree = scene::read_vessels(path);
  const vessels::FlowModel model = built(tree, path);
  vessels::FlowState state = vessels::settled_state(model, kSettle);
  vessels::FlowWork work = vessels::make_work(model);
  std::vector<Measured> measured(tree.vessels.size());
  double seconds = 0;
  for (int tick = 0; tick < kMeasured; ++tick) {
    const auto start = std::chrono::steady_clock::now();
    vessels::advance(model, {}, {}, state, work);
    seconds += std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    for (std::size_t i = 0; i < measured.size(); ++i) {
      const vessels::WallReading at = vessels::read_wall(model, state, int(i), 0.5);
      measured[i].flow += at.flow / kMeasured;
      measured[i].low = std::min(measured[i].low, at.pressure);
      measured[i].high = std::max(measured[i].high, at.pressure);
    }
  }
  Json out{{"file", path.string()},
           {"kind", "vessels"},
           {"nodes", tree.graph.nodes},
           {"cells", model.cells.size()},
           {"tick_us", 1e6 * seconds / kMeasured},
           {"pulse_gain", tree.pulse_gain},
           {"vessels", Json::array()}};
  for (std::size_t i = 0; i < measured.size(); ++i) {
    const vessels::VesselSegment& s = tree.graph.segments[i];
    out["vessels"].push_back({{"name", tree.vessels[i].name},
                              {"from", tree.nodes[std::size_t(s.from)]},
                              {"to", tree.nodes[std::size_t(s.to)]},
                              {"length_mm", 1e3 * s.length},
                              {"radius_mm", 1e3 * s.radius},
                              {"wave_speed_m_s", vessels::wave_speed(s, tree.graph.blood)},
                              {"flow_mL_min", 60e6 * measured[i].flow},
                              {"low_mmHg", measured[i].low / vessels::kPascalPerMmHg},
                              {"high_mmHg", measured[i].high / vessels::kPascalPerMmHg}});
  }
  return out;
}

void print_vessels(const Json& r) {
  fmt::print("  {:24} {:20} {:20} {:>9} {:>9} {:>8} {:>12} {:>12}\n", "vessel", "from", "to", "length mm", "radius mm",
             "c m/s", "flow mL/min", "mmHg");
  for (const Json& v : r["vessels"])
    fmt::print("  {:24} {:20} {:20} {:>9.1f} {:>9.2f} {:>8.2f} {:>12.1f} {:>5.0f} to {:.0f}\n",
               v["name"].get<std::string>(), v["from"].get<std::string>(), v["to"].get<std::string>(),
               v["length_mm"].get<double>(), v["radius_mm"].get<double>(), v["wave_speed_m_s"].get<double>(),
               v["flow_mL_min"].get<double>(), v["low_mmHg"].get<double>(), v["high_mmHg"].get<double>());
  fmt::print("{}", tr("  what the pulse moves and pushes is shown and felt {:g} times as large as it is\n",
                      r["pulse_gain"].get<double>()));
  fmt::print("{}", tr("  {} nodes, {} cells; a tick takes {:.1f} us here\n", r["nodes"].get<int>(),
                      r["cells"].get<std::size_t>(), r["tick_us"].get<double>()));
}

}  // namespace trocar::app
