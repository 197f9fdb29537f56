// A fold that is a body: its nodes give the shape, a smooth surface goes through them. Where scissors parted it, it
// gapes.
#pragma once

#include <trocar/sim/model/state.hpp>
#include <trocar/view/base/heat_marks.hpp>
#include <trocar/view/base/level_of_detail.hpp>
#include <trocar/view/base/looks.hpp>

namespace trocar::view {

class MembraneDrawing {
 public:
  MembraneDrawing(const sim::Model& model, int membrane, render::Backend& backend, const Detail& detail = {});

  void update(const sim::State& state);
  render::MeshHandle mesh() const { return m_mesh.handle(); }
  const MeshBuffer& buffer() const { return m_buffer; }
  bool burnt() const { return m_marks.any(); }

 private:
  void lay_pattern();
  void connect(const std::vector<std::uint8_t>& torn);
  void place(const tissue::MembraneState& state);
  void fray();
  std::vector<Vec3d> flat_places()
      const;  ///< of the drawn vertices: between the body's nodes as drawn, without ripples

  const sim::MembraneBody* m_membrane;
  const Look* m_look;
  int m_index, m_columns, m_rows;        ///< of the drawn grid
  std::vector<std::uint8_t> m_torn;      ///< as drawn last
  std::vector<std::uint8_t> m_edge;      ///< (drawn vertices) 1: of a tear
  std::vector<Vec3d> m_node, m_between;  ///< (columns x rows of the body), (drawn columns x rows of the body)
  std::vector<double> m_rest_width;      ///< (columns of the body) from border to border, as drawn at rest
  HeatMarks m_marks;
  MeshBuffer m_buffer;
  OwnedMesh m_mesh;
};

}  // namespace trocar::view
