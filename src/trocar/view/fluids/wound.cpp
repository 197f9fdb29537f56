#include <cmath>

#include <trocar/view/base/mesh_buffer.hpp>
#include <trocar/view/fluids/film_splats.hpp>
#include <trocar/view/fluids/wound.hpp>

namespace trocar::view {
namespace {

// Our choice, all of them: from the look of small arteries that bleed in endoscopic films.
constexpr float kPit = 0.45e-3f;          // [m] radius of the hole's dark middle
constexpr float kPitThick = 260e-6f;      // [m] of the blood in it
constexpr int kWelling = 7, kSmears = 5;  // patches of blood around it, thick and thin
constexpr float kWoundStep = 0.7e-3f;     // [m] between two links of the rivulet
constexpr int kWoundLinks = 22;
constexpr int kToCrest = 7, kStumpPatches = 4, kStumpSmears = 5;
constexpr float kSmearedThick = 2.2e-6f;  // [m] of blood beside a stump
constexpr float kWoundUnderside = 0.94f;  // cosine between surface and fall at which a rivulet ends as a hanging drop
constexpr std::uint32_t kWound = 977;     // for variety

render::Splat film(const Wound& wound, const FilmPlace& place, float radius, float thickness) {
  render::Splat s;
  s.kind = render::SplatKind::film;
  s.from = s.to = place.position;
  s.normal = place.normal;
  s.radius = radius;
  s.height = thickness;
  s.share = wound.share;
  s.dark = wound.dark;
  s.sheer = place.sheer;
  return s;
}

Vec3f along_surface(Vec3f v, Vec3f normal) { return v - dot(v, normal) * normal; }

FilmPlace moved(const FilmPlace& place, Vec3f by, const SurfaceNear& surface) {
  FilmPlace next = place;
  next.position += along_surface(by, place.normal);
  return surface ? surface(next) : next;
}

void list_rivulet(const Wound& wound, FilmPlace at, const SurfaceNear& surface, render::Liquid& liquid,
                  float share = 1) {
  const int links = int(share * float(surface ? kWoundLinks : kWoundLinks / 3));  // a plane leaves the tissue soon
  for (int n = 0; n < links; ++n) {
    const Vec3f fall = along_surface(wound.down, at.normal);
    const Vec3f across = cross(at.normal, normalised(fall, any_perpendicular(at.normal)));
    const float wind = 0.5f * std::sin(0.8f * float(n)) + 0.3f * own(kWound, n);
    const FilmPlace next = moved(at, kWoundStep * (normalised(fall, Vec3f{}) + wind * across), surface);
    const float wide = 0.52e-3f * (1 + 0.3f * own(kWound, 40 + n)), thick = share * (62 - 1.5f * float(n)) * 1e-6f;
    render::Splat s = film(wound, at, wide, thick * (0.75f + 0.3f * own(kWound, 80 + n)));
    s.to = next.position;
    liquid.splats.push_back(s);
    at = next;
    if (dot(at.normal, wound.down) < kWoundUnderside) continue;
    liquid.splats.push_back(film(wound, at, 0.9e-3f, 110e-6f));
    return;
  }
}

/// Just beyond the crest above a place, where there is one near: what spurts falls back there, too.
bool beyond_crest(const Wound& wound, FilmPlace& at, const SurfaceNear& surface) {
  const Vec3f first = along_surface(wound.down, at.normal);
  for (int n = 0; surface && n < kToCrest; ++n) {
    const Vec3f up = normalised(first - dot(first, at.normal) * at.normal, Vec3f{});
    at = moved(at, -kWoundStep * up, surface);
    if (dot(along_surface(wound.down, at.normal), first) < 0) return true;
  }
  return false;
}

}  // namespace

void list_wound(const Wound& wound, const FilmPlace& hole, const SurfaceNear& surface, render::Liquid& liquid) {
  const Vec3f one = any_perpendicular(hole.normal), other = cross(hole.normal, one);
  const Vec3f fall = along_surface(wound.down, hole.normal);
  const auto patch = [&](int n, float far, float lower, float radius, float thickness) {
    const Vec3f off = far * (own(kWound, 200 + n) * one + own(kWound, 300 + n) * other) +
                      lower * (0.5f + 0.5f * own(kWound, 400 + n)) * fall;
    render::Splat s = film(wound, moved(hole, off, surface), radius * (1 + 0.35f * own(kWound, 500 + n)), thickness);
    const Vec3f long_way = (0.6f * radius) * (own(kWound, 600 + n) * one + own(kWound, 700 + n) * other);
    s.from -= long_way, s.to += long_way;
    liquid.splats.push_back(s);
  };
  for (int n = 0; n < kWelling; ++n) patch(n, 0.8e-3f, 1.2e-3f, 0.60e-3f, 38e-6f);
  for (int n = 0; n < kSmears; ++n) patch(kWelling + n, 2.6e-3f, 1.0e-3f, 0.95e-3f, 9e-6f);
  render::Splat pit = film(wound, hole, kPit, kPitThick);
  pit.from -= (0.5f * kPit) * one, pit.to += (0.5f * kPit) * one;
  pit.dark = 0.35f;
  liquid.splats.push_back(pit);
  list_rivulet(wound, hole, surface, liquid);
  FilmPlace other_side = hole;
  if (beyond_crest(wound, other_side, surface)) list_rivulet(wound, other_side, surface, liquid);
}

void list_stump(const Wound& wound, const FilmPlace& end, float radius, render::Liquid& liquid) {
  const Vec3f one = any_perpendicular(end.normal), other = cross(end.normal, one);
  const auto around = [&](float angle, float behind) {
    const Vec3f out = std::cos(angle) * one + std::sin(angle) * other;
    return FilmPlace{end.position + radius * out - behind * end.normal, out};
  };
  for (int n = 0; n < kStumpPatches; ++n) {  // a crust on its edge, thicker below, where it oozes
    const float angle = 6.2832f * (float(n) + 0.4f * own(kWound, n)) / kStumpPatches;
    const FilmPlace place = around(angle, 0.1e-3f + 0.3e-3f * (1 + own(kWound, 100 + n)));
    const float low = 0.5f + 0.5f * dot(place.normal, wound.down);
    liquid.splats.push_back(film(wound, place, 0.3e-3f * (1 + 0.5f * own(kWound, 200 + n)), (12 + 26 * low) * 1e-6f));
    if (n % 3 == 1) list_rivulet(wound, place, {}, liquid, 0.2f + 0.3f * low);
  }
  for (int n = 0; n < kStumpSmears; ++n) {  // behind it a thin smear here and there
    const float far = 0.9e-3f + 2.0e-3f * float(varied(979, n));
    render::Splat s = film(wound, around(6.2832f * float(varied(978, n)), far), 0.5e-3f, kSmearedThick);
    s.from += (0.4e-3f + 0.3f * far) * end.normal;
    liquid.splats.push_back(s);
  }
  // It gathers at the lowest place of its edge.
  const Vec3f low = along_surface(wound.down, end.normal);
  const FilmPlace gathers{end.position + 0.98f * radius * low, normalised(0.4f * end.normal + low, end.normal)};
  liquid.splats.push_back(film(wound, gathers, 0.25f * radius, 60e-6f));
}

}  // namespace trocar::view
