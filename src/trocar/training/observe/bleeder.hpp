// What has been done about the vessel that opens by itself: clips and seals on either side of its place.
#pragma once

#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

#include <trocar/sim/model/state.hpp>

namespace trocar::training {

/// Does this place of the vessel lie where its blood comes from? Arteries are written from the heart on.
inline bool on_hearts_side(const sim::Bleeder& bleeder, double s) { return s < bleeder.s; }

/// Does a clip that covers so much of it sit on that side of the place?
inline bool bleeder_clipped(const sim::Model& model, const sim::State& state, bool hearts_side, double cover) {
  const sim::Bleeder& b = model.vessels.bleeder;
  const auto clips = std::span(state.vessel_clips).first(size_t(state.vessel_clip_count));
  return std::any_of(clips.begin(), clips.end(), [&](const interactions::VesselClip& c) {
    return c.vessel == b.vessel && on_hearts_side(b, c.s) == hearts_side && c.cover >= cover;
  });
}

/// Has heat closed this vessel for good, no further along it than `s`?
inline bool vessel_sealed(const sim::State& state, std::int32_t vessel, double s = 1) {
  const auto seals = std::span(state.seals).first(size_t(state.seal_count));
  return std::any_of(seals.begin(), seals.end(), [&](const interactions::VesselSeal& seal) {
    return seal.vessel == vessel && seal.from <= s && holds(seal);
  });
}

/// Has heat closed it for good, at the place or on the heart's side of it?
inline bool bleeder_sealed(const sim::Model& model, const sim::State& state) {
  return vessel_sealed(state, model.vessels.bleeder.vessel, model.vessels.bleeder.s);
}

/// Where a vessel bleeds by itself: what carries it there; none: nothing does.
inline BodyId carrier_of_bleeder(const sim::Model& model) {
  const sim::Bleeder& b = model.vessels.bleeder;
  if (b.vessel < 0) return {};
  const auto& points = model.vessels.list[size_t(b.vessel)].path.points;
  const auto nearest = std::min_element(points.begin(), points.end(), [&](const auto& p, const auto& q) {
    return std::fabs(p.s - b.s) < std::fabs(q.s - b.s);
  });
  return nearest->rides.body;
}

/// These bodies, and what carries the vessel that bleeds by itself: that may always be treated.
inline std::vector<BodyId> with_carrier_of_bleeder(const sim::Model& model, std::vector<BodyId> bodies) {
  if (const BodyId carrier = carrier_of_bleeder(model); carrier.exists()) bodies.push_back(carrier);
  return bodies;
}

}  // namespace trocar::training
