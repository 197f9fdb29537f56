// Arrows of the forces that instruments exert (analysis.hpp), as long as they are strong. What pulls begins at the
// tissue, what presses ends there.
#pragma once

#include <trocar/view/analysis/strain_surfaces.hpp>

namespace trocar::view {

struct ForceArrow {
  ForceKind kind = ForceKind::grip;
  Vec3d at;     ///< [m] where it acts
  Vec3d force;  ///< [N] on tissue or wall
  int hand = 0;
};

inline constexpr double kLeastForce = 0.02;    ///< [N] weaker ones are left out
inline constexpr double kLongestArrow = 0.12;  ///< [m] stronger ones are cut short

/// What the State knows: one grip a hand, every point that is pressed, and what its trocar does to the wall.
std::vector<ForceArrow> forces_of(const sim::Model& model, const sim::State& state);

/// From tail to tip [m].
std::array<Vec3d, 2> ends_of(const ForceArrow& arrow, double metres_per_newton);

class ForceArrows {
 public:
  void update(const std::vector<ForceArrow>& arrows, const AnalysisOptions& options, render::Backend& backend);
  const FalseColourMesh& mesh() const { return m_mesh; }

 private:
  FalseColourMesh m_mesh;
};

}  // namespace trocar::view
