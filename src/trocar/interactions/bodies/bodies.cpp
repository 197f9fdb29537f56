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
  return body.is(BodyKind::organ) ? organ_nodes(bodies, body.index()) : membrane_nodes(bodies, body.index());
}

const tissue::Skin& skin_of(const Bodies& bodies, std::size_t organ) noexcept {
  return bodies.work ? *bodies.work->organs[organ].skin : bodies.models.skin(int(organ));
}

NetworkLoads& loads_on(const Bodies& bodies, BodyId body) noexcept {
  return body.is(BodyKind::organ) ? bodies.work->organs[body.index()].loads
                                  : bodies.work->membranes[body.index()].loads;
}

}  // namespace trocar::interactions
