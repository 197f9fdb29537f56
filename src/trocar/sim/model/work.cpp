#include <algorithm>
#include <numeric>

#include <trocar/core/poison.hpp>
#include <trocar/sim/model/work.hpp>

namespace trocar::sim {
namespace {

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
  for (const interactions::OrganWork& o : w.organs) skins.push_back(double(o.pose.position.size()));
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
  static_cast<interactions::BodyWork&>(w) =
      interactions::make_work(model, model.walls.size(), model.energy.there ? size_t(kMaxScarred) : 0);
  w.pool = pool;
  for (const SolidModel& s : model.solids) {
    w.parts.resize(std::max(w.parts.size(), size_t(s.network.nodes)));
    w.beyond.resize(std::max(w.beyond.size(), size_t(s.network.rows)));
  }
  for (const CuttableOrgan& c : model.cuttables) w.beyond.resize(std::max(w.beyond.size(), size_t(c.body.rows)));
  for (const MembraneBody& m : model.membranes) {
    w.parts.resize(std::max(w.parts.size(), size_t(m.sheet.nodes())));
    w.beyond.resize(std::max(w.beyond.size(), size_t(m.sheet.network.rows)));
  }
  for (const PeristalsisModel& p : model.motion.peristalsis) {
    const size_t organ = size_t(p.solid), nodes = size_t(model.solids[organ].network.nodes);
    w.wave_force.resize(std::max(w.wave_force.size(), nodes));
    interactions::NetworkLoads& loads = w.organs[organ].loads;
    loads.reserve(loads.gathered.capacity() + p.wave.nodes.size());
  }
  w.touches.resize(model.hands.size());
  interactions::make_object_work(model, int(model.hands.size()), w);
  if (model.vessels.there()) {
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
  w.sheet_gaps.resize(model.hands.size() * model.membranes.size());
  order_bodies(model, w);
  return w;
}

void poison(Work& w) noexcept { core::poison_fields(w); }

}  // namespace trocar::sim
