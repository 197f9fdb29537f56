// Scratch of the step: reserved once, filled anew in every tick. Overwriting it with NaN between ticks changes nothing.
#pragma once

#include <memory>
#include <vector>

#include <trocar/interactions/grasp.hpp>
#include <trocar/interactions/loads.hpp>
#include <trocar/interactions/wall_stop.hpp>
#include <trocar/sim/state.hpp>

namespace trocar::sim {

struct Work {
  core::ThreadPool* pool = nullptr;             ///< may be null; never changes a bit of the result
  std::vector<tissue::SkinPose> poses;          ///< (organs)
  std::vector<interactions::Surface> surfaces;  ///< (organs + walls)
  std::array<interactions::ToolShape, kMaxTools> shapes;
  std::array<interactions::ToolShape, kMaxTools> shapes_before;  ///< where they were when the tick began
  std::vector<interactions::TouchBook> touches;              ///< (hands) this tick's
  std::array<interactions::WallStop, kMaxTools> wall_stops;  ///< (hands)
  std::vector<interactions::NetworkLoads> organ_loads;       ///< (organs)
  std::vector<interactions::StrandLoads> strand_loads;
  std::vector<tissue::NetworkWork> solid_work;
  std::vector<tissue::CuttableWork> cuttable_work;
  std::vector<tissue::StrandWork> strand_work;
  std::vector<std::array<tissue::StrandEnd, 2>> ends;  ///< (strands)
  std::vector<std::array<tissue::StrandReaction, 2>> end_reactions;
  std::vector<std::int32_t> parts;   ///< (nodes of the largest organ) what hangs together, for cuts
  std::vector<std::uint8_t> beyond;  ///< (rows of the largest organ or membrane) springs stretched too far
  std::vector<tissue::StepReport> organ_reports, strand_reports, membrane_reports;
  std::vector<tissue::SkinPose> sheet_poses;    ///< (membranes)
  std::vector<interactions::SheetView> sheets;  ///< (membranes)
  std::vector<double> sheet_gaps;               ///< (hands x membranes) apart by at least this much [m]
  std::vector<interactions::NetworkLoads> membrane_loads;
  std::vector<tissue::MembraneWork> membrane_work;
  std::vector<std::vector<tissue::BorderPull>> pulls;  ///< (membranes)(held nodes)
  std::vector<std::vector<Vec3d>> targets;             ///< (membranes)(held nodes)
  std::vector<tissue::NodeView> nodes;                 ///< (organs) of the State; anew in every tick
  std::vector<tissue::CuttableSkin> cuttable_skins;
  std::vector<const tissue::Skin*> skins;                      ///< (organs) of the Model, or the above
  std::vector<int> organ_order, strand_order, membrane_order;  ///< by how much there is to do, for the threads
  std::vector<int> skin_order;                                 ///< (organs + membranes) the same
};

Work make_work(const Model& model, core::ThreadPool* pool = nullptr);

/// Overwrites every number in the scratch with NaN or nonsense (tests of the law).
void poison(Work& work) noexcept;

}  // namespace trocar::sim
