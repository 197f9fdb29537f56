#include <stdexcept>

#include <trocar/geometry/nurbs/weights.hpp>
#include <trocar/scene/compile/body_surface.hpp>
#include <trocar/scene/compile/compile_control.hpp>
#include <trocar/scene/compile/compile_parts.hpp>
#include <trocar/scene/compile/compile_tets.hpp>
#include <trocar/tissue/tets/control_cage.hpp>

namespace trocar::scene {
namespace {

namespace nurbs = geometry::nurbs;

/// Rows of W by nodes: eight of them in a vertex' weights, what is more behind them. Values of 0 are left out.
void carry(const std::vector<nurbs::Share>& row, const tissue::NetworkModel& network, std::size_t vertex,
           tissue::Skin& skin) {
  tissue::SkinWeights first = tissue::SkinWeights::at(row[0].index, network.row_of_node[size_t(row[0].index)]);
  first.weight[0] = 0;
  tissue::SkinWeights second = first;
  std::size_t k = 0;
  for (const nurbs::Share& share : row) {
    if (!(share.value > 0)) continue;
    if (k >= size_t(kMostCarriers)) throw std::invalid_argument("at most 16 control points that move a place expected");
    tissue::SkinWeights& w = k < 8 ? first : second;
    w.node[k % 8] = share.index;
    w.row[k % 8] = network.row_of_node[size_t(share.index)];
    w.weight[k % 8] = float(share.value);
    ++k;
  }
  skin.weights[vertex] = first;
  skin.more[vertex] = second;
}

tissue::Skin carried_skin(const EvenSurface& even, const nurbs::Surface& surface, const nurbs::Nodes& nodes,
                          const tissue::NetworkModel& network) {
  tissue::Skin skin = bare_skin(even.mesh);
  skin.more.resize(skin.weights.size());
  for (size_t i = 0; i < even.parameters.size(); ++i)
    carry(nurbs::node_weights_at(surface, nodes, even.parameters[i][0], even.parameters[i][1]), network, i, skin);
  return skin;
}

}  // namespace

void compile_control(const Solid& solid, const Tissue& tissue, Vec3d gravity, sim::Model& model,
                     std::vector<core::Fault>& faults, CompileReport* report) {
  if (!solid.shape.nurbs) throw std::invalid_argument("masses at control points, of a shape that is no NURBS");
  const nurbs::Surface surface = surface_of(*solid.shape.nurbs);
  const BodySurface shape = surface_of_body(solid);
  const EvenSurface skin = skin_surface(shape, solid.skin_edge), fine = skin_surface(shape, solid.fine_edge);
  const tissue::ControlCage cage = tissue::control_cage(surface);
  const double volume = nurbs::volume(surface);
  tissue::TetNetwork net =
      tissue::cage_network(cage, tet_material(tissue), volume, geometry::centre_of_volume(fine.mesh));
  std::optional<sim::SolidModel> out = hung(solid, tissue, gravity, std::move(net.network), volume, faults, report);
  if (!out) return;
  out->skin = carried_skin(skin, surface, cage.nodes, out->network);
  out->fine = carried_skin(fine, surface, cage.nodes, out->network);
  model.solids.push_back(std::move(*out));
}

}  // namespace trocar::scene
