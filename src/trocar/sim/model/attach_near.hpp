// The body of a Model that is nearest to a place, in the drawn shape: for bodies that are attached there when a scene
// is compiled.
#pragma once

#include <string>
#include <vector>

#include <trocar/interactions/bodies/material_point.hpp>
#include <trocar/sim/model/bodies.hpp>

namespace trocar::sim {

/// Bodies of a Model that is not complete, as they are drawn.
class DrawnBodies {
 public:
  explicit DrawnBodies(const Model& model) : m_model(model), m_state(drawn_bodies(model)) {}
  interactions::Bodies all() const noexcept { return bodies_of(m_model, m_state); }
  const Model& model() const noexcept { return m_model; }

 private:
  const Model& m_model;
  State m_state;
};

struct Attached {
  interactions::MaterialPoint point;
  std::int32_t vertex = -1;  ///< of an organ's skin, nearest to it
};
/// The point at p of the rod, organ, membrane or fat of those named that is nearest to p and within reach of its
/// surface [m], of fat of a lobule's middle; else of space.
Attached attach_near(const DrawnBodies& bodies, const std::vector<std::string>& names, double reach, Vec3d p);

}  // namespace trocar::sim
