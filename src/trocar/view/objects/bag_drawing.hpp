// A retrieval bag as it is drawn: its cloth as a smooth surface through the nodes, and the band that holds its mouth
// open. What lies in the sleeve is not drawn.
#pragma once

#include <vector>

#include <trocar/sim/model/state.hpp>
#include <trocar/view/base/listing.hpp>

namespace trocar::view {

class BagDrawing {
 public:
  BagDrawing(const sim::Model& model, render::Backend& backend);

  void update(const sim::State& state);
  void list(std::size_t first, const Listing& to);
  std::size_t count() const { return m_bags.size(); }

 private:
  struct Drawn {
    const interactions::BagModel* model;
    const Look *cloth, *band;
    OwnedMesh cloth_mesh, band_mesh;
    bool there = false;
  };
  void draw_cloth(const interactions::BagModel& m, const interactions::BagState& s);
  void draw_band(const interactions::BagModel& m, const interactions::BagState& s);

  MeshBuffer m_cloth, m_band;
  std::vector<Drawn> m_bags;
};

}  // namespace trocar::view
