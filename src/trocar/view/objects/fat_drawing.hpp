// Fat as it is drawn: one surface around its lobules, threads of septa between those that have been drawn apart, and
// sheer films in the gaps between them (fat_veils.hpp).
// What is left of it on a duct is small, and hangs by threads.
#pragma once

#include <vector>

#include <trocar/sim/model/state.hpp>
#include <trocar/view/base/listing.hpp>
#include <trocar/view/objects/fat_surface.hpp>
#include <trocar/view/objects/fat_veils.hpp>

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
    OwnedMesh veils;
    MeshBuffer veil_buffer;
    bool veiled = false;  ///< is there any film?
    /// A lymph node in it.
    struct Nodule {
      const Look* look;
      OwnedMesh mesh;
      MeshBuffer buffer;
      bool any = false;
    };
    std::vector<Nodule> nodules;
    std::vector<Vec3f> shown;         ///< where lobules were when it was drawn last
    std::vector<std::int32_t> marks;  ///< what they had been through
    bool any = false;                 ///< is there anything to see?
  };
  static bool moved(const Drawn& drawn, const tissue::FatState& state);
  void draw(Drawn& drawn, const sim::State& state, const tissue::FatState& fat);
  void add_lobules(Drawn& drawn, const tissue::FatState& state);
  void draw_nodules(Drawn& drawn);
  void add_veils(Drawn& drawn, const sim::State& state, const tissue::FatState& fat) const;
  void add_roots(const Drawn& drawn, const sim::State& state, const tissue::FatState& fat);

  const sim::Model* m_model;
  const Look* m_areolar;
  FatSurface m_surface;
  MeshBuffer m_buffer;
  std::vector<DrawnLobule> m_lobules;
  std::vector<std::int32_t> m_numbers;  ///< (m_lobules) which they are
  std::vector<float> m_held;            ///< (lobules) how many septa hold it
  std::vector<Drawn> m_bodies;
};

}  // namespace trocar::view
