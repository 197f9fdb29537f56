// Strands and organs of a State as what hangs on them sees them, for drawings that show how.
#pragma once

#include <vector>

#include <trocar/interactions/couplings/border.hpp>
#include <trocar/sim/model/state.hpp>

namespace trocar::view {

/// Valid as long as the State is and does not change.
class DrawnHolders {
 public:
  DrawnHolders(const sim::Model& model, const sim::State& state) : m_model(model), m_state(state) {
    for (int i = 0; i < model.organs(); ++i) {
      m_nodes.push_back(sim::nodes_of(model, state, i));
      m_skins.push_back(&model.skin(i));
    }
  }
  interactions::Holders all() const { return {m_model.strand_bodies, m_state.strands, m_nodes, m_skins}; }
  /// Where on its holder something is rooted [m].
  Vec3d foot(const interactions::BorderHold& hold) const { return held_place(hold, all()) - hold.offset; }

 private:
  const sim::Model& m_model;
  const sim::State& m_state;
  std::vector<tissue::NodeView> m_nodes;
  std::vector<const tissue::Skin*> m_skins;
};

}  // namespace trocar::view
