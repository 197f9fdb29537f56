#include <algorithm>
#include <cstring>
#include <limits>
#include <numeric>

#include <trocar/sim/model/work.hpp>

namespace trocar::sim {
namespace {

constexpr size_t kOrganLoads = 8192, kStrandLoads = 2048, kMembraneLoads = 8192;
constexpr size_t kScarLoads = 40;  // of a scarred cell: six edges and four springs across faces, two loads an end

template <class T>
void scribble(std::vector<T>& values) noexcept {
  if (!values.empty()) std::memset(static_cast<void*>(values.data()), 0xff, values.size() * sizeof(T));
}

void scribble(tissue::SkinPose& p) noexcept {
  scribble(p.position);
  scribble(p.block);
  scribble(p.patch);
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

void scribble(tissue::VolumeWork& v) noexcept {
  for (auto* values : {&v.drawn, &v.volume, &v.answer, &v.inverse_mass, &v.pressure}) scribble(*values);
  scribble(v.force);
}

void scribble(geometry::CutWork& c) noexcept {
  scribble(c.height);
  scribble(c.at_blade);
  scribble(c.nearest);
  scribble(c.towards);
  scribble(c.target_rest);
  scribble(c.target_now);
  scribble(c.side);
  scribble(c.begin);
  scribble(c.around);
  scribble(c.fan);
  scribble(c.seen);
  scribble(c.touched);
}

/// Vertices' weights and drawn places are the Model's; which triangles there are follows from the State.
void scribble(tissue::CuttableSkin& s) noexcept {
  s.made_for = ~0ull;
  scribble(s.inner);
  scribble(s.skin.triangles);
  scribble(s.skin.face_first);
  scribble(s.skin.face);
  scribble(s.skin.neighbour_first);
  scribble(s.skin.neighbour);
}

void scribble(tissue::CuttableWork& c) noexcept {
  c.made_for = ~0ull;
  c.slices = c.parts = -1;
  scribble(c.other);
  scribble(c.packs);
  scribble(c.row_packs);
  scribble(c.slice_begin);
  scribble(c.mass);
  scribble(c.changed);
  scribble(c.bearable);
  scribble(c.fixed);
  scribble(c.begin);
  scribble(c.around);
  scribble(c.node_of_row);
  scribble(c.now);
  scribble(c.guarded);
  scribble(c.guarded_packs);
  scribble(c.part);
  scribble(c.open_tets);
  scribble(c.folded);
  scribble(c.below);
  scribble(c.cut);
  scribble(c.volume);
  scribble(c.loaded);
}

void scribble(tissue::NetworkWork& n) noexcept {
  scribble(n.other);
  for (tissue::ForceWork& f : n.forces) {
    scribble(f.forces);
    scribble(f.sums);
  }
  scribble(n.open_tets);
  scribble(n.folded);
  scribble(n.below);
  scribble(n.loaded);
  scribble(n.volume);
}

void scribble(vessels::FlowWork& f) noexcept {
  for (auto* values : {&f.capacity, &f.extra, &f.ahead, &f.diagonal, &f.x, &f.values, &f.flow0, &f.flow_a, &f.flow_b})
    scribble(*values);
  scribble(f.sites);
  scribble(f.chains);
  scribble(f.points);
  scribble(f.part);
  scribble(f.part_fed);
  scribble(f.blocked);
  f.site_count = f.chain_count = -1;
}

/// 0 .. n-1, the costliest first: what begins last should be short, or all threads wait for one.
std::vector<int> by_cost(const std::vector<double>& cost) {
  std::vector<int> order(cost.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return cost[size_t(a)] > cost[size_t(b)]; });
  return order;
}

void order_bodies(const Model& model, Work& w) {
  std::vector<double> organs, strands, membranes, skins;
  for (const SolidModel& s : model.solids) organs.push_back(double(s.network.springs) * s.network.substeps);
  for (const CuttableOrgan& c : model.cuttables) organs.push_back(16.0 * c.body.packs * c.body.substeps);
  for (const interactions::StrandBody& b : model.strand_bodies) strands.push_back(b.nodes());
  for (const tissue::SkinPose& p : w.poses) skins.push_back(double(p.position.size()));
  for (const MembraneBody& m : model.membranes) {
    membranes.push_back(double(m.sheet.network.springs) * m.sheet.network.substeps * m.sheet.bend_steps);
    skins.push_back(double(m.skin.weights.size()));
  }
  w.organ_order = by_cost(organs);
  w.strand_order = by_cost(strands);
  w.membrane_order = by_cost(membranes);
  w.skin_order = by_cost(skins);
}

}  // namespace

Work make_work(const Model& model, core::ThreadPool* pool) {
  Work w;
  w.pool = pool;
  for (const SolidModel& s : model.solids) {
    w.poses.push_back(tissue::make_pose(s.skin));
    w.solid_work.push_back(tissue::make_work(s.network));
    w.organ_loads.emplace_back().reserve(kOrganLoads + s.anchors.size());
    w.parts.resize(std::max(w.parts.size(), size_t(s.network.nodes)));
    w.skins.push_back(&s.skin);
    w.beyond.resize(std::max(w.beyond.size(), size_t(s.network.rows)));
  }
  w.cuttable_skins.reserve(model.cuttables.size());
  for (const CuttableOrgan& c : model.cuttables) {
    w.cuttable_skins.push_back(tissue::make_skin(c.body));
    w.skins.push_back(&w.cuttable_skins.back().skin);
    w.poses.push_back(tissue::make_pose(*w.skins.back()));
    w.cuttable_work.push_back(tissue::make_work(c.body));
    const size_t scars = model.energy.there ? kScarLoads * size_t(kMaxScarred) : 0;
    w.organ_loads.emplace_back().reserve(kOrganLoads + c.body.anchors.size() + scars);
    w.beyond.resize(std::max(w.beyond.size(), size_t(c.body.rows)));
  }
  w.nodes.resize(size_t(model.organs()));
  for (const interactions::StrandBody& b : model.strand_bodies) {
    w.strand_work.push_back(tissue::make_work(b.model));
    w.strand_loads.emplace_back().reserve(kStrandLoads);
  }
  for (const PeristalsisModel& p : model.motion.peristalsis) {
    const size_t organ = size_t(p.solid), nodes = size_t(model.solids[organ].network.nodes);
    w.wave_force.resize(std::max(w.wave_force.size(), nodes));
    w.organ_loads[organ].reserve(w.organ_loads[organ].gathered.capacity() + p.wave.nodes.size());
  }
  w.touches.resize(model.hands.size());
  w.surfaces.resize(size_t(model.surfaces()));
  w.ends.resize(model.strands.size());
  w.end_reactions.resize(model.strands.size());
  w.organ_reports.resize(size_t(model.organs()));
  w.strand_reports.resize(model.strands.size());
  for (const MembraneBody& m : model.membranes) {
    w.sheet_poses.push_back(tissue::make_pose(m.skin));
    w.membrane_loads.emplace_back().reserve(kMembraneLoads);
    w.membrane_work.push_back(tissue::make_work(m.sheet, kMembraneLoads));
    w.pulls.emplace_back(m.holds.size());
    w.targets.emplace_back(m.holds.size());
    w.parts.resize(std::max(w.parts.size(), size_t(m.sheet.nodes())));
    w.beyond.resize(std::max(w.beyond.size(), size_t(m.sheet.network.rows)));
  }
  if (model.vessels.there()) {
    w.hosts = make_host_views(model);
    for (const Vessel& v : model.vessels.list) w.vessel_points.emplace_back(v.path.points.size());
    w.vessel_posed.resize(w.vessel_points.size());
    w.flow = vessels::make_work(model.vessels.flow);
    w.open.resize(interactions::kMaxOpenings);
    w.closed.resize(size_t(model.vessels.flow.settings.max_clips));
    w.flows.resize(interactions::kMaxOpenings);
    w.walls.resize(model.vessels.list.size());
    w.busy.resize(model.vessels.list.size());
    w.bleeds.resize(2 * interactions::kMaxOpenings);
  }
  if (model.energy.there) w.heat = tissue::make_work(model.energy.heat);
  if (model.wet.there) {
    w.fluids = fluids::make_work(model.wet.model);
    w.wet = interactions::make_wet_work(model.strand_bodies, model.wet.film);
    w.impact_at.resize(size_t(model.wet.film.back()));
    w.wounds.resize(2 * interactions::kMaxOpenings);
  }
  w.sheets.resize(model.membranes.size());
  w.sheet_gaps.resize(model.hands.size() * model.membranes.size());
  w.membrane_reports.resize(model.membranes.size());
  order_bodies(model, w);
  return w;
}

void poison(Work& w) noexcept {
  // All bits set is NaN for every float and -1 for every index.
  for (tissue::SkinPose& p : w.poses) scribble(p);
  for (tissue::SkinPose& p : w.sheet_poses) scribble(p);
  for (interactions::Surface& s : w.surfaces) s = {};
  std::memset(static_cast<void*>(&w.shapes), 0xff, sizeof w.shapes);
  std::memset(static_cast<void*>(&w.shapes_before), 0xff, sizeof w.shapes_before);
  std::memset(static_cast<void*>(&w.wall_stops), 0xff, sizeof w.wall_stops);
  for (interactions::SheetView& s : w.sheets) s = {};
  scribble(w.sheet_gaps);
  for (interactions::NetworkLoads& l : w.organ_loads) scribble(l);
  for (interactions::NetworkLoads& l : w.membrane_loads) scribble(l);
  for (interactions::StrandLoads& l : w.strand_loads) {
    scribble(l.list);
    scribble(l.tag);
    scribble(l.reaction);
    l.overflowed = true;
  }
  for (tissue::NetworkWork& n : w.solid_work) scribble(n);
  for (tissue::CuttableWork& c : w.cuttable_work) scribble(c);
  for (tissue::CuttableSkin& s : w.cuttable_skins) scribble(s);
  for (tissue::NodeView& n : w.nodes) n = {};
  for (tissue::MembraneWork& m : w.membrane_work) {
    scribble(m.network);
    scribble(m.force);
    scribble(m.place);
    scribble(m.gradient);
    scribble(m.weight);
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
    scribble(s.direction);
    scribble(s.bend_now);
  }
  for (tissue::NodeView& n : w.hosts.organs) n = {};
  for (tissue::NodeView& n : w.hosts.membranes) n = {};
  for (auto& corners : w.hosts.corners) scribble(corners);
  for (auto& points : w.vessel_points) scribble(points);
  scribble(w.vessel_posed);
  scribble(w.flow);
  scribble(w.open);
  scribble(w.closed);
  scribble(w.flows);
  scribble(w.walls);
  scribble(w.busy);
  scribble(w.impact_at);
  scribble(w.bleeds);
  w.bleed_count = -1;
  scribble(w.heat.u);
  scribble(w.heat.conduction);
  scribble(w.heat.boiled);
  scribble(w.heat.touched);
  scribble(w.heat.weight);
  std::memset(static_cast<void*>(&w.heat_sources), 0xff, sizeof w.heat_sources);
  std::memset(static_cast<void*>(&w.steam), 0xff, sizeof w.steam);
  fluids::poison(w.fluids);
  interactions::poison(w.wet);
  scribble(w.wounds);
  std::memset(static_cast<void*>(&w.wet_tools), 0xff, sizeof w.wet_tools);
  std::memset(static_cast<void*>(&w.valves), 0xff, sizeof w.valves);
  scribble(w.wave_force);
  scribble(w.touches);
  scribble(w.parts);
  scribble(w.beyond);
  scribble(w.ends);
  scribble(w.end_reactions);
  scribble(w.organ_reports);
  scribble(w.strand_reports);
  scribble(w.membrane_reports);
}

}  // namespace trocar::sim
