// One organ as two solvers have it (analysis.hpp): the surface that is drawn, coloured by how far each vertex is from
// where the other solver has it, and the other one's outline as wires. Wires are drawn over everything, those that face
// the eye, so that they show on whichever side of the surface they lie; from afar only the silhouette.
#pragma once

#include <trocar/sim/model/bodies.hpp>
#include <trocar/view/analysis/strain_surfaces.hpp>

namespace trocar::view {

class SolverOutline {
 public:
  explicit SolverOutline(const sim::Model& model) : m_model(&model) {}

  /// @param eye  from where it is looked at [m]
  void update(const sim::State& state, const OrganBeside& beside, const AnalysisOptions& options, Vec3f eye,
              render::Backend& backend);

  const FalseColourMesh& surface() const { return m_surface; }  ///< `value`: distances [m]
  const FalseColourMesh& wires() const { return m_wires; }

 private:
  void update_surface(const sim::State& state, const OrganBeside& beside, const AnalysisOptions& options,
                      render::Backend& backend);
  void update_wires(const OrganBeside& beside, Vec3f eye, render::Backend& backend);

  const sim::Model* m_model;
  FalseColourMesh m_surface, m_wires;
};

}  // namespace trocar::view
