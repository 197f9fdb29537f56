#include <algorithm>
#include <cstring>
#include <limits>

#include <trocar/sim/work.hpp>

namespace trocar::sim {
namespace {

constexpr size_t kSolidLoads = 8192, kStrandLoads = 2048, kMembraneLoads = 4096;

template <class T>
void scribble(std::vector<T>& values) noexcept {
  if (!values.empty()) std::memset(static_cast<void*>(values.data()), 0xff, values.size() * sizeof(T));
}

void scribble(tissue::SkinPose& p) noexcept {
  scribble(p.position);
  scribble(p.block);
  p.bounds.low = p.bounds.high = {std::numeric_limits<float>::quiet_NaN(), 0, 0};
}

void scribble(interactions::NetworkLoads& l) noexcept {
  scribble(l.gathered);
  scribble(l.sorted);
  scribble(l.tag);
  scribble(l.order);
  scribble(l.owner);
  scribble(l.reaction);
  l.overflowed = true;
}

void scribble(tissue::NetworkWork& n) noexcept {
  scribble(n.other);
  scribble(n.open_tets);
  scribble(n.below);
}

}  // namespace

Work make_work(const Model& model, core::ThreadPool* pool) {
  Work w;
  w.pool = pool;
  for (const SolidModel& s : model.solids) {
    w.poses.push_back(tissue::make_pose(s.skin));
    w.solid_work.push_back(tissue::make_work(s.network));
    w.solid_loads.emplace_back().reserve(kSolidLoads + s.anchors.size());
    w.parts.resize(std::max(w.parts.size(), size_t(s.network.nodes)));
  }
  for (const interactions::StrandBody& b : model.bodies) {
    w.strand_work.push_back(tissue::make_work(b.model));
    w.strand_loads.emplace_back().reserve(kStrandLoads);
  }
  w.surfaces.resize(size_t(model.surfaces()));
  w.ends.resize(model.strands.size());
  w.end_reactions.resize(model.strands.size());
  w.solid_reports.resize(model.solids.size());
  w.strand_reports.resize(model.strands.size());
  for (const MembraneModel& m : model.membranes) {
    w.sheet_poses.push_back(tissue::make_pose(m.skin));
    w.membrane_loads.emplace_back().reserve(kMembraneLoads);
    w.membrane_work.push_back(tissue::make_work(m.sheet, kMembraneLoads));
    w.pulls.emplace_back(m.holds.size());
    w.targets.emplace_back(m.holds.size());
    w.parts.resize(std::max(w.parts.size(), size_t(m.sheet.nodes())));
  }
  w.sheets.resize(model.membranes.size());
  w.membrane_reports.resize(model.membranes.size());
  for (const SolidModel& s : model.solids) {
    w.networks.push_back(&s.network);
    w.skins.push_back(&s.skin);
  }
  return w;
}

void poison(Work& w) noexcept {
  // All bits set is NaN for every float and -1 for every index.
  for (tissue::SkinPose& p : w.poses) scribble(p);
  for (tissue::SkinPose& p : w.sheet_poses) scribble(p);
  for (interactions::Surface& s : w.surfaces) s = {};
  std::memset(static_cast<void*>(&w.shapes), 0xff, sizeof w.shapes);
  for (interactions::SheetView& s : w.sheets) s = {};
  for (interactions::NetworkLoads& l : w.solid_loads) scribble(l);
  for (interactions::NetworkLoads& l : w.membrane_loads) scribble(l);
  for (interactions::StrandLoads& l : w.strand_loads) {
    scribble(l.list);
    scribble(l.tag);
    scribble(l.reaction);
    l.overflowed = true;
  }
  for (tissue::NetworkWork& n : w.solid_work) scribble(n);
  for (tissue::MembraneWork& m : w.membrane_work) {
    scribble(m.network);
    scribble(m.force);
    scribble(m.reaction);
  }
  for (auto& pulls : w.pulls) scribble(pulls);
  for (auto& targets : w.targets) scribble(targets);
  for (tissue::StrandWork& s : w.strand_work) {
    scribble(s.matrix);
    scribble(s.rhs);
    scribble(s.columns);
    scribble(s.force);
    scribble(s.saved);
    scribble(s.bend_now);
  }
  scribble(w.parts);
  scribble(w.ends);
  scribble(w.end_reactions);
  scribble(w.solid_reports);
  scribble(w.strand_reports);
  scribble(w.membrane_reports);
}

}  // namespace trocar::sim
