// Where closed clips are: on a strand, on a vessel or on a thread, as these lie now.
//
//   ClipLegs legs = legs_on(clip, seat_on_strand(clip, model, state));
#pragma once

#include <trocar/sim/model/state.hpp>

namespace trocar::sim {

/// Half the clear space between the legs of a closed clip, and how wide and thick a leg is [m].
inline constexpr double kClipHalfGap = 0.00025, kClipLegWidth = 0.0011, kClipLegThickness = 0.00085;
/// Legs of clips whose applier does not say how long they are [m].
inline constexpr double kClipLength = 0.0085;

/// What a clip sits on, in its middle.
struct ClipSeat {
  Vec3d centre;
  interactions::StrandFrame frame;
  double radius = 0;  ///< [m]
};
ClipSeat seat_on_strand(const interactions::Clip& clip, const Model& model, const State& state) noexcept;
/// @param points  of the vessel's line, as it lies now
ClipSeat seat_on_vessel(const interactions::Clip& clip, const Model& model, const State& state,
                        std::span<const Vec3d> points) noexcept;

/// Two parallel legs.
struct ClipLegs {
  Vec3d centre;              ///< between them, of what they hold
  Vec3d axis, open;          ///< unit: along them from their bend on, and the way they close
  double low = 0, high = 0;  ///< from and to, along the axis from the centre [m]
};
ClipLegs legs_on(const interactions::Clip& clip, const ClipSeat& seat) noexcept;
/// @param sits  the clip on its thread
ClipLegs legs_on_thread(const interactions::Clip& clip, const suture::ThreadClip& sits) noexcept;

}  // namespace trocar::sim
