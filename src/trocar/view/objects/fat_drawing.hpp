// Fat as it is drawn: one surface around its lobules, and threads of septa between those that have been drawn apart.
#pragma once

#include <vector>

#include <trocar/sim/model/state.hpp>
#include <trocar/view/base/listing.hpp>
#include <trocar/view/objects/fat_surface.hpp>

namespace trocar::view {

class FatDrawing {
 public:
  FatDrawing(const sim::Model& model, render::Backend& backend);

  void update(const sim::State& state);
  void list(std::size_t first, const Listing& to);
  std::size_t count() const { return m_bodies.size(); }

 private:
  struct Drawn {
    const interactions::FatBody* body;
    const Look* look;
    OwnedMesh mesh;
    std::vector<Vec3f> shown;         ///< where lobules were when it was drawn last
    std::vector<std::int32_t> marks;  ///< what they had been through
    bool any = false;                 ///< is there anything to see?
  };
  static bool moved(const Drawn& drawn, const tissue::FatState& state);
  void draw(Drawn& drawn, const tissue::FatState& state);

  FatSurface m_surface;
  MeshBuffer m_buffer;
  std::vector<DrawnLobule> m_lobules;
  std::vector<Drawn> m_bodies;
};

}  // namespace trocar::view
