#include <algorithm>
#include <numeric>

#include <trocar/core/poison.hpp>
#include <trocar/sim/model/work.hpp>

namespace trocar::sim {
namespace {

constexpr size_t kOrganLoads = 8192, kStrandLoads = 2048, kMembraneLoads = 8192;
constexpr size_t kCellSprings = 10;  // six edges and four across faces

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

size_t rows_of_organ(const Model& model, size_t organ) {
  const size_t lattices = model.solids.size();
  return size_t(organ < lattices ? model.solids[organ].network.rows : model.cuttables[organ - lattices].body.rows);
}

}  // namespace

Work make_work(const Model& model, core::ThreadPool* pool) {
  Work w;
  w.pool = pool;
  const size_t scars = model.energy.there ? size_t(kMaxScarred) : 0;
  for (const SolidModel& s : model.solids) {
    w.poses.push_back(tissue::make_pose(s.skin));
    w.solid_work.push_back(tissue::make_work(s.network));
    w.organ_loads.emplace_back().reserve(kOrganLoads + s.anchors.size());
    w.organ_scars.emplace_back().reserve(scars);
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
    w.organ_loads.emplace_back().reserve(kOrganLoads + c.body.anchors.size());
    w.organ_scars.emplace_back().reserve(kCellSprings * scars);
    w.beyond.resize(std::max(w.beyond.size(), size_t(c.body.rows)));
  }
  for (const StaticOrgan& o : model.statics) {
    const interactions::NetworkLoads& loads = w.organ_loads[size_t(o.organ)];
    w.static_work.push_back({tissue::make_work(o.solver, int(loads.gathered.capacity())), {}});
    w.static_work.back().before.resize(rows_of_organ(model, size_t(o.organ)));
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
    w.membrane_scars.emplace_back().reserve(scars);
    w.membrane_models.push_back(&m.sheet);
    w.membrane_work.push_back(tissue::make_work(m.sheet, kMembraneLoads));
    w.pulls.emplace_back(m.holds.size());
    w.targets.emplace_back(m.holds.size());
    w.parts.resize(std::max(w.parts.size(), size_t(m.sheet.nodes())));
    w.beyond.resize(std::max(w.beyond.size(), size_t(m.sheet.network.rows)));
  }
  w.objects = interactions::make_work(model.objects, int(model.hands.size()));
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
  for (const PiercedOrgan& o : model.injection.organs) w.infusion.push_back(tissue::make_work(o.infusion));
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
  w.leaks.resize(2 * model.membranes.size());
  order_bodies(model, w);
  return w;
}

void poison(Work& w) noexcept { core::poison_fields(w); }

}  // namespace trocar::sim
