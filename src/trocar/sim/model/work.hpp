// Scratch of the step: reserved once, filled again in every tick. Overwriting it with NaN between ticks changes
// nothing.
#pragma once

#include <memory>
#include <vector>

#include <trocar/core/fields.hpp>
#include <trocar/interactions/bodies/work.hpp>
#include <trocar/interactions/instrument/wall_stop.hpp>
#include <trocar/interactions/verbs/grasp.hpp>
#include <trocar/interactions/wetting/fluid_contact.hpp>
#include <trocar/sim/model/state.hpp>

namespace trocar::sim {

/// Blood that leaves a vessel in this tick. A vessel that is cut through has two of these.
struct Bleed {
  Vec3d place;                  ///< of the opening's middle, at the end of the tick [m]
  Vec3d direction{0, 0, 1};     ///< out of the opening, unit
  double area = 0;              ///< that is open [m^2]
  double speed = 0;             ///< mean of the tick [m/s]
  std::int64_t picolitres = 0;  ///< to be booked as they are
  std::int32_t opening = -1;    ///< slot in State::openings
  std::int32_t side = 0;        ///< 0: the stump towards the vessel's beginning
  bool vein = false;            ///< dark blood
  bool fed = false;             ///< an open path connects it with a source
};

/// Fluid of needles that comes into the open in this tick.
struct NeedleOutlet {
  Vec3d place;               ///< [m]
  Vec3d direction{0, 0, 1};  ///< unit
  double area = 0;           ///< [m^2]
  std::int64_t picolitres = 0;
  std::int32_t film = -1;  ///< >= 0: it runs out over the skin there
};
/// All that can be at once: every track, some organs that have torn, and of every hand what it leaves as it is drawn
/// out, spills or leaks, and finds no room.
inline constexpr std::int32_t kMaxNeedleOutlets = kMaxTracks + 4 + 3 * kMaxTools;

struct Work : interactions::BodyWork {
  core::ThreadPool* pool = nullptr;  ///< may be null; never changes a bit of the result
  std::array<interactions::ToolShape, kMaxTools> shapes;
  std::array<interactions::ToolShape, kMaxTools> shapes_before;  ///< where they were when the tick began
  std::vector<interactions::TouchBook> touches;                  ///< (hands) this tick's
  std::array<interactions::WallStop, kMaxTools> wall_stops;      ///< (hands)
  std::vector<std::int32_t> parts;   ///< (nodes of the largest organ) what hangs together, for cuts
  std::vector<std::uint8_t> beyond;  ///< (rows of the largest organ or membrane) springs stretched too far
  std::vector<double> sheet_gaps;    ///< (hands x membranes) apart by at least this much [m]
  interactions::ObjectWork objects;
  std::vector<Vec3d> wave_force;                  ///< (nodes of the largest organ with waves) [N]
  std::vector<std::vector<Vec3d>> vessel_points;  ///< (vessels)(points of the path) [m]
  std::vector<std::uint8_t> vessel_posed;         ///< (vessels) 0: its points are not known in this tick
  vessels::FlowWork flow;
  std::vector<vessels::Opening> open;
  std::vector<vessels::Occlusion> closed;
  std::vector<vessels::OpeningFlow> flows;
  std::vector<vessels::WallReading> walls;  ///< (vessels) in their middles
  std::vector<std::uint8_t> busy;           ///< (vessels) scratch of that
  std::vector<std::int32_t> impact_at;      ///< (places of film) the impact that sums up all there
  std::vector<Bleed> bleeds;                ///< (2 kMaxOpenings) for the receiver of the blood, after the flow's stage
  int bleed_count = 0;
  tissue::HeatWork heat;
  std::array<tissue::HeatSource, 2 * kMaxTools> heat_sources;
  fluids::Boiled steam;  ///< what boiled off in this tick, for the fluids
  bool current_flows = false;
  fluids::FluidsWork fluids;
  interactions::WetWork wet;
  std::vector<tissue::InfusionWork> infusion;  ///< (organs) empty in scenes without needles
  std::array<NeedleOutlet, kMaxNeedleOutlets> needle_outlets;
  std::int32_t needle_outlet_count = 0;
  std::vector<fluids::Outlet> wounds;  ///< (2 kMaxOpenings) sides of openings
  std::array<fluids::Capsule, kMaxTools * interactions::kToolParts> wet_tools;
  std::array<fluids::SuctionIrrigator, kMaxTools> valves;      ///< (hands) closed where there is none
  std::vector<int> organ_order, strand_order, membrane_order;  ///< by how much there is to do, for the threads
  std::vector<int> skin_order;                                 ///< (organs + membranes) the same

  template <class S, class V>
  static void fields(S& s, V&& v) {
    v("pool", s.pool, core::kMadeOnce), v("organs", s.organs), v("solids", s.solids), v("cuttables", s.cuttables),
        v("strands", s.strands), v("membranes", s.membranes), v("fat", s.fat), v("surfaces", s.surfaces),
        v("shapes", s.shapes), v("shapes_before", s.shapes_before), v("touches", s.touches),
        v("wall_stops", s.wall_stops), v("statics", s.statics), v("parts", s.parts), v("beyond", s.beyond),
        v("sheet_gaps", s.sheet_gaps), v("objects", s.objects), v("wave_force", s.wave_force),
        v("vessel_points", s.vessel_points), v("vessel_posed", s.vessel_posed), v("flow", s.flow), v("open", s.open),
        v("closed", s.closed), v("flows", s.flows), v("walls", s.walls), v("busy", s.busy), v("impact_at", s.impact_at),
        v("bleeds", s.bleeds), v("bleed_count", s.bleed_count), v("heat", s.heat), v("heat_sources", s.heat_sources),
        v("steam", s.steam), v("current_flows", s.current_flows), v("fluids", s.fluids), v("wet", s.wet),
        v("infusion", s.infusion), v("needle_outlets", s.needle_outlets),
        v("needle_outlet_count", s.needle_outlet_count), v("wounds", s.wounds), v("wet_tools", s.wet_tools),
        v("valves", s.valves), v("organ_order", s.organ_order, core::kMadeOnce),
        v("strand_order", s.strand_order, core::kMadeOnce), v("membrane_order", s.membrane_order, core::kMadeOnce),
        v("skin_order", s.skin_order, core::kMadeOnce);
  }
};

Work make_work(const Model& model, core::ThreadPool* pool = nullptr);

/// Overwrites every number in the scratch with NaN or nonsense (tests of the law).
void poison(Work& work) noexcept;

}  // namespace trocar::sim
