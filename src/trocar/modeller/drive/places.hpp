// Where a scene's bodies are: for what is pointed at, framed and taken.
#pragma once

#include <optional>
#include <vector>

#include <trocar/sim/model/state.hpp>

namespace trocar::modeller {

struct BodyPlace {
  BodyId body;
  Vec3d at;  ///< [m]
};
/// Places all over the skins of organs and folds, and along strands.
std::vector<BodyPlace> places_of(const sim::Model& model, const sim::State& state);

/// The nearest one; none where there are no bodies.
std::optional<BodyPlace> nearest(const std::vector<BodyPlace>& places, Vec3d point);

/// The one that a ray meets first, within `reach` of it [m].
std::optional<BodyPlace> met_by(const std::vector<BodyPlace>& places, Vec3d from, Vec3d direction, double reach);

}  // namespace trocar::modeller
