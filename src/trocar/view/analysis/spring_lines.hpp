// Springs as lines coloured by their strain (analysis.hpp): of organs' lattices, of folds, of bodies that can be cut
// (the edges of their cells, against their lengths as drawn) and strands' elements.
#pragma once

#include <trocar/view/analysis/strain_surfaces.hpp>

namespace trocar::view {

class SpringLines {
 public:
  explicit SpringLines(const sim::Model& model);

  void update(const sim::State& state, const AnalysisOptions& options, render::Backend& backend);

  /// One each, in the Model's order; `value` is the strain, twice for each line.
  const std::vector<FalseColourMesh>& organs() const { return m_organs; }
  const std::vector<FalseColourMesh>& strands() const { return m_strands; }
  const std::vector<FalseColourMesh>& membranes() const { return m_membranes; }

 private:
  const sim::Model* m_model;
  std::vector<FalseColourMesh> m_organs, m_strands, m_membranes;
  std::vector<std::vector<std::array<std::int32_t, 2>>> m_edges;  ///< (cuttables) of their cells, each once ...
  std::vector<std::uint64_t> m_edges_of;                          ///< ... in this version
};

}  // namespace trocar::view
