#include <algorithm>

#include <trocar/interactions/instrument/tool_contact.hpp>
#include <trocar/interactions/verbs/clip.hpp>
#include <trocar/interactions/verbs/vessel_tools.hpp>
#include <trocar/numerics/portable.hpp>

namespace trocar::interactions {

VesselWound wound_of(const geometry::BladePlane& plane, const VesselPiece& piece, double radius) noexcept {
  VesselWound wound;
  const double ha = plane.height(piece.a), hb = plane.height(piece.b);
  if (!plane.flat || (ha > 0) == (hb > 0)) return wound;
  const double w = ha / (ha - hb);
  const Vec3d at = piece.a + w * (piece.b - piece.a);
  const Vec3d width = normalised(cross(plane.n, piece.b - piece.a), any_perpendicular(plane.n));
  constexpr int kPoints = 9;  // across the vessel, in the blade's plane
  int covered = 0;
  for (int i = 0; i < kPoints; ++i) covered += plane.covers(at + (radius * (2.0 * i / (kPoints - 1) - 1)) * width);
  wound.s = piece.s_a + w * (piece.s_b - piece.s_a);
  wound.share = double(covered) / kPoints;
  return wound;
}

bool catch_vessel(const ToolModel& model, const ToolShape& shape, const VesselPiece& piece, double radius,
                  VesselCatch& found) noexcept {
  const BetweenJaws where = between_jaws(model, shape, piece.a, piece.b, radius);
  if (!where.inside || !where.crosses) return false;
  found.cover = leg_cover(from_bend(model, where.local.z), radius, model.clip_length);
  found.s = piece.s_a + where.w * (piece.s_b - piece.s_a);
  found.local = where.local;
  return found.cover > 0;
}

void put_on_vessel(const ToolModel& model, const ToolShape& shape, const VesselPath& path, const VesselSpot& spot,
                   int vessel, const VesselCatch& found, Clip& clip) noexcept {
  const StrandFrame frame = vessel_frame(path, spot);
  clip.vessel = vessel + 1;
  clip.s = found.s * path.length;
  clip.cover = found.cover;
  clip.theta = portable::acos(std::min(1.0, std::fabs(dot(shape.frame.normal(), frame.tangent))));
  clip.reach = from_bend(model, found.local.z);
  const auto store = [&frame](double(&out)[3], Vec3d v) {
    out[0] = dot(v, frame.tangent);
    out[1] = dot(v, frame.normal);
    out[2] = dot(v, frame.binormal);
  };
  store(clip.opening, shape.frame.opening());
  store(clip.axis, shape.frame.axis());
}

}  // namespace trocar::interactions
