#include <algorithm>

#include <trocar/core/field_hash.hpp>
#include <trocar/interactions/bodies/strand_body.hpp>

namespace trocar::interactions {
namespace {

Vec3d element_direction(const tissue::StrandState& state, int e) noexcept {
  return normalised(state.x[size_t(e) + 1] - state.x[size_t(e)]);
}

/// Direction in which the stump at the lower (side 0) or upper (side 1) node of a cut element continues.
Vec3d stump_direction(const StrandBody& body, const tissue::StrandState& state, int e, int side) noexcept {
  if (side == 0 && e > 0 && state.alive[size_t(e) - 1]) return element_direction(state, e - 1);
  if (side == 1 && e + 2 < body.nodes() && state.alive[size_t(e) + 1]) return element_direction(state, e + 1);
  return element_direction(state, e);
}

/// Transports `normal` from direction a to direction b by the smallest rotation.
Vec3d transported(Vec3d normal, Vec3d a, Vec3d b) noexcept {
  const Vec3d axis = cross(a, b);
  const double c = dot(a, b);
  if (c < -0.999) return normal;
  const Vec3d rotated = normal * c + cross(axis, normal) + axis * (dot(axis, normal) / (1.0 + c));
  return normalised(rotated - dot(rotated, b) * b, any_perpendicular(b));
}

}  // namespace

StrandPlace place_at(const StrandBody& body, double s) noexcept {
  const int last = body.nodes() - 2;
  int e = int(std::upper_bound(body.arc.begin(), body.arc.end(), s) - body.arc.begin()) - 1;
  e = std::clamp(e, 0, last);
  const double from = body.arc[size_t(e)], to = body.arc[size_t(e) + 1];
  return {e, std::clamp((s - from) / (to - from), 0.0, 1.0)};
}

double arc_at(const StrandBody& body, StrandPlace place) noexcept {
  const double from = body.arc[size_t(place.element)], to = body.arc[size_t(place.element) + 1];
  return from + place.w * (to - from);
}

Vec3d point_at(const StrandBody& body, const tissue::StrandState& state, StrandPlace place) noexcept {
  const size_t e = size_t(place.element);
  const Vec3d a = state.x[e], b = state.x[e + 1];
  if (state.alive[e]) return a + place.w * (b - a);
  const double drawn = body.arc[e + 1] - body.arc[e];
  if (place.w <= 0.5) return a + (place.w * drawn) * stump_direction(body, state, place.element, 0);
  return b - ((1.0 - place.w) * drawn) * stump_direction(body, state, place.element, 1);
}

Vec3d tangent_at(const StrandBody& body, const tissue::StrandState& state, StrandPlace place) noexcept {
  if (!state.alive[size_t(place.element)]) return stump_direction(body, state, place.element, place.w <= 0.5 ? 0 : 1);
  return element_direction(state, place.element);
}

void frames_of(const StrandBody& body, const tissue::StrandState& state, StrandFrame* frames) noexcept {
  // The first normal hangs on the drawn shape so that it does not depend on the present one.
  const Vec3d drawn = normalised(body.model.rest[1] - body.model.rest[0]);
  Vec3d t = element_direction(state, 0);
  Vec3d n = transported(any_perpendicular(drawn), drawn, t);
  for (int e = 0; e + 1 < body.nodes(); ++e) {
    const Vec3d next = element_direction(state, e);
    n = transported(n, t, next);
    t = next;
    frames[e] = {t, n, cross(t, n)};
  }
}

StrandFrame frame_at(const StrandBody& body, const tissue::StrandState& state, StrandPlace place) noexcept {
  const Vec3d drawn = normalised(body.model.rest[1] - body.model.rest[0]);
  Vec3d t = element_direction(state, 0);
  Vec3d n = transported(any_perpendicular(drawn), drawn, t);
  for (int e = 1; e <= place.element; ++e) {
    const Vec3d next = element_direction(state, e);
    n = transported(n, t, next);
    t = next;
  }
  return {t, n, cross(t, n)};
}

void add_to_hash(core::Hasher& hasher, const StrandBody& body) noexcept { core::add_fields(hasher, body); }

}  // namespace trocar::interactions
