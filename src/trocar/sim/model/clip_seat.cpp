#include <algorithm>

#include <trocar/sim/model/clip_seat.hpp>
#include <trocar/sim/model/vessel_cuts.hpp>

namespace trocar::sim {
namespace {

using interactions::Clip;

Vec3d in_world(const double (&v)[3], const interactions::StrandFrame& f) noexcept {
  return v[0] * f.tangent + v[1] * f.normal + v[2] * f.binormal;
}

ClipLegs legs(const Clip& clip, Vec3d centre, Vec3d axis, Vec3d open) noexcept {
  const double length = clip.length > 0 ? clip.length : kClipLength;
  return {centre, axis, normalised(open - dot(open, axis) * axis, any_perpendicular(axis)), -clip.reach,
          length - clip.reach};
}

}  // namespace

ClipSeat seat_on_strand(const Clip& clip, const Model& model, const State& state) noexcept {
  const std::size_t strand = std::size_t(clip.strand);
  const interactions::StrandBody& body = model.strand_bodies[strand];
  const interactions::StrandPlace place = place_at(body, clip.s);
  return {point_at(body, state.strands[strand], place), frame_at(body, state.strands[strand], place),
          body.model.radius[std::size_t(place.element)]};
}

ClipSeat seat_on_vessel(const Clip& clip, const Model& model, const State& state,
                        std::span<const Vec3d> points) noexcept {
  const int vessel = clip.vessel - 1;
  const interactions::VesselPath& path = model.vessels.list[std::size_t(vessel)].path;
  std::array<double, interactions::kMaxOpenings> cuts;
  const double s = std::clamp(clip.s / path.length, 0.0, 1.0);
  const interactions::VesselSpot spot = vessel_spot(path, points, cuts_of(state, vessel, cuts), s);
  return {spot.place, vessel_frame(path, spot), vessel_radius(path, s)};
}

ClipLegs legs_on(const Clip& clip, const ClipSeat& seat) noexcept {
  return legs(clip, seat.centre, normalised(in_world(clip.axis, seat.frame), seat.frame.binormal),
              in_world(clip.opening, seat.frame));
}

ClipLegs legs_on_thread(const Clip& clip, const suture::ThreadClip& sits) noexcept {
  return legs(clip, sits.at, normalised(sits.axis_now), sits.open_now);
}

}  // namespace trocar::sim
