// What needles and threads lie on and press against, found before bodies advance: skins of organs, folds, walls of
// pouches, tubes, walls of the scene, instruments. And what tissue bears of what they did to it in the last tick.
#pragma once

#include <trocar/interactions/objects/suture.hpp>

namespace trocar::interactions {

/// Of a body the place of its surface that is nearest to a point.
struct NearSkin {
  MaterialPoint at;       ///< the vertex of its skin that is nearest to that; of a strand on its middle line
  Vec3d point, normal;    ///< [m]; out of the body, of a fold towards the point
  double distance = 1e9;  ///< of the point from the surface, negative inside [m]

  bool there() const noexcept { return at.body.exists(); }
};
/// Looks at all of the body.
NearSkin nearest_skin(const Bodies& bodies, BodyId body, Vec3d p, double reach) noexcept;

/// @param tick  that the step makes: what is near is looked for again by turns
/// @param cavity  whose walls nothing leaves
void rest_on_tissue(const SutureModels& models, const Bodies& bodies, const tissue::Box& cavity, std::uint64_t tick,
                    double dt, Suture::States& states, SutureWorks& work) noexcept;

}  // namespace trocar::interactions
