// Bodies' surfaces coloured by strain (analysis.hpp): organs by the skin that is drawn, folds and walls by their own
// nodes, strands as plain tubes with one colour an element.
#pragma once

#include <trocar/sim/model/bodies.hpp>
#include <trocar/view/analysis/analysis.hpp>
#include <trocar/view/base/mesh_buffer.hpp>

namespace trocar::view {

/// Makes, moves or makes again a mesh, as its triangles (or lines) ask for.
class FalseColourMesh {
 public:
  MeshBuffer buffer;
  std::vector<float> value;  ///< (vertices) what is coloured

  void show(render::Backend& backend, bool new_triangles, render::Primitive primitive = render::Primitive::triangles);
  bool there() const { return m_there; }
  render::MeshHandle handle() const { return m_mesh.handle(); }

 private:
  OwnedMesh m_mesh;
  bool m_made = false, m_there = false;
};

class StrainSurfaces {
 public:
  explicit StrainSurfaces(const sim::Model& model);

  void update(const sim::State& state, const AnalysisOptions& options, render::Backend& backend);

  /// One each, in the Model's order.
  const std::vector<FalseColourMesh>& organs() const { return m_organs; }
  const std::vector<FalseColourMesh>& strands() const { return m_strands; }
  const std::vector<FalseColourMesh>& membranes() const { return m_membranes; }

 private:
  void update_organ(sim::SolidRef solid, const sim::State& state, const AnalysisOptions& o, render::Backend& backend);
  void update_organ(sim::CuttableRef organ, const sim::State& state, const AnalysisOptions& o,
                    render::Backend& backend);
  void update_membrane(std::size_t i, const sim::State& state, const AnalysisOptions& o, render::Backend& backend);
  void update_strand(std::size_t i, const sim::State& state, const AnalysisOptions& o, render::Backend& backend);

  const sim::Model* m_model;
  std::vector<FalseColourMesh> m_organs, m_strands, m_membranes;
  std::vector<std::vector<std::uint8_t>> m_left_out;  ///< (organs, then membranes)(triangles) as drawn last
  std::vector<tissue::CuttableSkin> m_skins;          ///< (cuttables)
};

}  // namespace trocar::view
