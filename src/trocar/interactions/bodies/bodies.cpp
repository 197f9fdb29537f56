#include <trocar/interactions/bodies/bodies.hpp>

namespace trocar::interactions {
namespace {

constexpr std::size_t kOrganLoads = 8192, kStrandLoads = 2048, kMembraneLoads = 8192;
constexpr std::size_t kCellSprings = 10;  // six edges and four across faces

OrganWork make_organ(const tissue::Skin& skin, std::size_t anchors, std::size_t scars) {
  OrganWork w;
  w.skin = &skin;
  w.pose = tissue::make_pose(skin);
  w.loads.reserve(kOrganLoads + anchors);
  w.scars.reserve(scars);
  return w;
}

std::size_t rows_of(const BodyModels& models, std::size_t organ) {
  const std::size_t lattices = models.solids.size();
  return std::size_t(organ < lattices ? models.solids[organ].network.rows
                                      : models.cuttables[organ - lattices].body.rows);
}

}  // namespace

BodyWork make_work(const BodyModels& models, std::size_t walls, std::size_t scars) {
  BodyWork w;
  for (const SolidModel& s : models.solids) {
    w.organs.push_back(make_organ(s.skin, s.anchors.size(), scars));
    w.solids.push_back(tissue::make_work(s.network));
  }
  w.cuttables.reserve(models.cuttables.size());  // organs point at their skins
  for (const CuttableOrgan& c : models.cuttables) {
    w.cuttables.push_back({tissue::make_work(c.body), tissue::make_skin(c.body)});
    w.organs.push_back(make_organ(w.cuttables.back().skin.skin, c.body.anchors.size(), kCellSprings * scars));
  }
  for (const StaticOrgan& o : models.statics) {
    const OrganWork& organ = w.organs[std::size_t(o.organ)];
    w.statics.push_back({tissue::make_work(o.solver, int(organ.loads.gathered.capacity())), {}});
    w.statics.back().before.resize(rows_of(models, std::size_t(o.organ)));
  }
  for (const StrandBody& b : models.strand_bodies) {
    StrandBodyWork& strand = w.strands.emplace_back();
    strand.body = tissue::make_work(b.model);
    strand.loads.reserve(kStrandLoads);
  }
  for (const MembraneBody& m : models.membranes) {
    MembraneBodyWork& membrane = w.membranes.emplace_back();
    membrane.pose = tissue::make_pose(m.skin);
    membrane.loads.reserve(kMembraneLoads);
    membrane.scars.reserve(scars);
    membrane.body = tissue::make_work(m.sheet, kMembraneLoads);
    membrane.pulls.resize(m.holds.size());
    membrane.targets.resize(m.holds.size());
  }
  w.surfaces.resize(w.organs.size() + walls);
  return w;
}

tissue::NodeView organ_nodes(const Bodies& bodies, std::size_t organ) noexcept {
  const std::size_t lattices = bodies.models.solids.size();
  if (organ < lattices) return view_of(bodies.models.solids[organ].network, bodies.states.solids[organ]);
  return view_of(bodies.models.cuttables[organ - lattices].body, bodies.states.cuttables[organ - lattices]);
}

tissue::NodeView membrane_nodes(const Bodies& bodies, std::size_t membrane) noexcept {
  return view_of(bodies.models.membranes[membrane].sheet.network, bodies.states.membranes[membrane].network);
}

tissue::NodeView nodes_of(const Bodies& bodies, BodyId body) noexcept {
  if (body.is(BodyKind::fat))
    return view_of(bodies.models.fat[body.index()].fat.network, bodies.states.fat[body.index()].network);
  return body.is(BodyKind::organ) ? organ_nodes(bodies, body.index()) : membrane_nodes(bodies, body.index());
}

std::size_t node_count(const Bodies& bodies, BodyId body) noexcept {
  if (is_tetrahedral(bodies, body)) return std::size_t(tets_of(bodies, body).nodes);
  return nodes_of(bodies, body).row_of_node.size();
}

std::span<const Vec3d> drawn_nodes(const BodyModels& models, BodyId body) noexcept {
  const std::size_t i = body.index(), lattices = models.solids.size();
  if (body.is(BodyKind::membrane)) return models.membranes[i].sheet.network.rest;
  if (body.is(BodyKind::fat)) return models.fat[i].fat.network.rest;
  if (i < lattices) return models.solids[i].network.rest;
  const tissue::CuttableModel& tets = models.cuttables[i - lattices].body;
  return {tets.drawn.rest.data(), std::size_t(tets.own_nodes)};
}

bool takes_loads(const Bodies& bodies, BodyId body, std::int32_t node) noexcept {
  if (!body.is(BodyKind::organ)) return true;
  for (const StaticOrgan& organ : bodies.models.statics)
    if (organ.organ == std::int32_t(body.index()))
      return std::size_t(node) < organ.solver.slot.size() && organ.solver.slot[std::size_t(node)] >= 0;
  return true;
}

bool is_tetrahedral(const Bodies& bodies, BodyId body) noexcept {
  return body.is(BodyKind::organ) && body.index() >= bodies.models.solids.size();
}

const geometry::CuttableTets& tets_of(const Bodies& bodies, BodyId body) noexcept {
  return bodies.states.cuttables[body.index() - bodies.models.solids.size()].tets;
}

const geometry::Tet* cell_of(const Bodies& bodies, BodyId body, std::int32_t cell) noexcept {
  return is_tetrahedral(bodies, body) && cell >= 0 ? &tets_of(bodies, body).cells[std::size_t(cell)] : nullptr;
}

const tissue::Skin& skin_of(const Bodies& bodies, std::size_t organ) noexcept {
  return bodies.work ? *bodies.work->organs[organ].skin : bodies.models.skin(int(organ));
}

NetworkLoads& loads_on(const Bodies& bodies, BodyId body) noexcept {
  if (body.is(BodyKind::fat)) return bodies.work->fat[body.index()].loads;
  return body.is(BodyKind::organ) ? bodies.work->organs[body.index()].loads
                                  : bodies.work->membranes[body.index()].loads;
}

}  // namespace trocar::interactions
