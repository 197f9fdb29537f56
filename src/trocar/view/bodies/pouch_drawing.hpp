// A closed wall that is a body (a gallbladder): every triangle of it as nine small ones that curve towards the tangent
// planes at its corners [Boubekeur & Alexa 2008], with fat where it is held. Where it was cut or torn, it gapes.
#pragma once

#include <trocar/sim/model/state.hpp>
#include <trocar/view/base/heat_marks.hpp>
#include <trocar/view/base/level_of_detail.hpp>
#include <trocar/view/base/looks.hpp>
#include <trocar/view/base/peeled.hpp>

namespace trocar::view {

class PouchDrawing {
 public:
  PouchDrawing(const sim::Model& model, int membrane, render::Backend& backend, const Detail& detail = {});

  void update(const sim::State& state);
  render::MeshHandle mesh() const { return m_mesh.handle(); }
  const MeshBuffer& buffer() const { return m_buffer; }
  bool burnt() const { return m_marks.any(); }

 private:
  /// Where a drawn vertex lies: between nodes, and how much of each.
  struct Place {
    std::array<std::uint32_t, 3> node{};
    std::array<float, 3> share{};
  };

  void divide();
  void connect(const std::vector<std::uint8_t>& torn);
  void place(const tissue::MembraneState& state);
  void paint();
  void stain();
  std::vector<Vec3d> flat_places() const;

  const sim::MembraneBody* m_membrane;
  const Look* m_look;
  int m_index;
  std::vector<std::uint8_t> m_torn;    ///< as drawn last
  std::vector<Place> m_places;         ///< (drawn vertices)
  std::vector<std::uint32_t> m_small;  ///< corners of all small triangles, nine after each other for one of the wall
  std::vector<std::uint32_t> m_whole;  ///< corners of the wall's triangles
  std::vector<Vec3f> m_node, m_node_normal;
  std::vector<float> m_height;  ///< (drawn vertices) relief [m]
  HeatMarks m_marks;
  Peeled m_peeled;
  MeshBuffer m_buffer;
  OwnedMesh m_mesh;
};

}  // namespace trocar::view
