// Rigid objects as they are drawn: a tube along their beads or a pebble's skin, moved as a whole.
#pragma once

#include <vector>

#include <trocar/sim/model/state.hpp>
#include <trocar/view/base/listing.hpp>

namespace trocar::view {

class RigidDrawing {
 public:
  RigidDrawing(const sim::Model& model, render::Backend& backend);

  void update(const sim::State& state);
  void list(std::size_t first, const Listing& to);
  std::size_t count() const { return m_bodies.size(); }

 private:
  struct Drawn {
    RigidMesh mesh;
    Detail detail;
    const Look* look;
    render::Mat4 transform;
  };
  std::vector<Drawn> m_bodies;
};

}  // namespace trocar::view
