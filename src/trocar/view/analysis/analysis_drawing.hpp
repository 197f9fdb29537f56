// All that the analysis view draws of its own (analysis.hpp): made when it is first asked for.
#pragma once

#include <functional>
#include <optional>

#include <trocar/view/analysis/force_arrows.hpp>
#include <trocar/view/analysis/solver_outline.hpp>
#include <trocar/view/analysis/spring_lines.hpp>
#include <trocar/view/bodies/vessel_drawing.hpp>

namespace trocar::view {

/// A body of the Model, as the numbers of parts are asked for.
enum class Measured { organ, strand, membrane, arteries, veins, tools };

class AnalysisDrawing {
 public:
  AnalysisDrawing(const sim::Model& model, render::Backend& backend) : m_model(&model), m_backend(&backend) {}

  /// Moves what is chosen to `state` and lists it. @param part_of  the number of a body's part in the frame's items
  /// @param beside  of the organ with two solvers; null: there is none
  void list(const sim::State& state, const AnalysisOptions& options, const OrganBeside* beside,
            const std::function<std::uint16_t(Measured, std::size_t)>& part_of, render::Frame& frame);

 private:
  void list_solvers(const sim::State& state, const AnalysisOptions& options, const OrganBeside& beside,
                    std::uint16_t part, render::Frame& frame);
  void list_vessels(const sim::State& state, const AnalysisOptions& options,
                    const std::function<std::uint16_t(Measured, std::size_t)>& part_of, render::Frame& frame);

  const sim::Model* m_model;
  render::Backend* m_backend;
  std::optional<StrainSurfaces> m_surfaces;
  std::optional<SpringLines> m_springs;
  ForceArrows m_arrows;
  std::optional<SolverOutline> m_solvers;
  std::vector<VesselDrawing> m_vessels;  ///< arteries, then veins
  std::vector<FalseColourMesh> m_vessel_colours;
  std::vector<bool> m_are_veins;
};

}  // namespace trocar::view
