// Needles and threads as they are drawn: a wire with a point and a swage, and a tube along the thread's nodes.
#pragma once

#include <vector>

#include <trocar/sim/model/state.hpp>
#include <trocar/view/base/listing.hpp>

namespace trocar::view {

class SutureDrawing {
 public:
  SutureDrawing(const sim::Model& model, render::Backend& backend);

  void update(const sim::State& state);
  void list(std::size_t first, const Listing& to);
  std::size_t count() const { return m_sutures.size(); }

 private:
  struct Drawn {
    const interactions::SutureModel* model;
    const Look *steel, *thread;
    OwnedMesh needle, tube;
    render::Mat4 transform;
  };
  void draw_tube(const interactions::SutureModel& m, const suture::ThreadState& s);

  std::vector<Drawn> m_sutures;
  MeshBuffer m_tube;  ///< scratch
};

}  // namespace trocar::view
