#include <algorithm>
#include <cmath>

#include <trocar/view/base/mesh_buffer.hpp>
#include <trocar/view/fluids/film_drawing.hpp>
#include <trocar/view/fluids/film_splats.hpp>

namespace trocar::view {
namespace {

using render::Liquid;
using render::Splat;
using render::SplatKind;

// Our choice, all of them.
constexpr float kBleedsAsFilm = 0.3f;  // share of blood from which a drop on tissue is film at once
constexpr float kCapSpread = 2.0f;     // radius of a cap over that of its ball
constexpr float kLongestTail = 4.0f;   // of a running drop, in radii
constexpr float kTailSpeed = 0.05f;    // [m/s] at which the tail is half of it
constexpr float kThickestSplash = 70e-6f, kMostSpread = 1.8f;  // [m]
constexpr float kThinnestFilm = 0.4e-6f;                       // [m] not drawn below

}  // namespace

void FilmDrawing::list(const FluidSight& sight, Liquid& liquid) const {
  list_films(sight, liquid);
  list_lying(sight.state.droplets, sight.sheer_bodies, liquid);
}

void FilmDrawing::list_lying(const fluids::DropletState& d, std::span<const std::uint8_t> sheer, Liquid& liquid) const {
  for (std::int32_t i = 0; i < d.count; ++i) {
    const auto k = std::size_t(i);
    if (d.body[k] < 0 || !(d.radius[k] > 0) || !finite(at(d, i)) || !finite(speed(d, i))) continue;
    const bool sheer_below = std::size_t(d.body[k]) < sheer.size() && sheer[std::size_t(d.body[k])] != 0;
    if (shares_of(d.volume[k])[0] > kBleedsAsFilm)
      list_splash(d, i, sheer_below, liquid);
    else
      list_cap(d, i, sheer_below, liquid);
  }
}

/// A cap of the drop's volume, wider than it is high, drawn out behind it as it runs.
void FilmDrawing::list_cap(const fluids::DropletState& d, std::int32_t i, bool sheer, Liquid& liquid) const {
  const auto k = std::size_t(i);
  const Vec3f normal = normalised(d.ground[k].normal, Vec3f{0, 0, 1});
  Vec3f v = speed(d, i) - d.ground[k].velocity;
  v -= dot(v, normal) * normal;
  const float fast = length(v), r = d.radius[k];
  const std::array<float, 3> share = shares_of(d.volume[k]);
  // No two drops are alike: some lie flat, some stand.
  const float own = 0.8f + 0.4f * float(varied(int(d.id[k] & 0xffff), 3));
  const float spread = kCapSpread * own;
  const float tail = kLongestTail * r * fast / (fast + kTailSpeed);
  Splat s;
  s.kind = SplatKind::lying;
  s.to = at(d, i) - (dot(normal, at(d, i)) - d.ground[k].offset) * normal;
  s.from = fast > 1e-5f ? s.to - (tail / fast) * v : s.to;
  s.normal = normal;
  // Volume of a cap: pi/2 h a^2 for a flat one; with a tail as wide as itself: and 4/3 a h of its length.
  const float ball = 4.18879f * r * r * r;
  s.radius = spread * r * (1 - 0.25f * tail / (tail + 2 * r));
  s.height = ball / (1.5708f * s.radius * s.radius + 1.3333f * s.radius * tail);
  s.share = share;
  s.dark = darkness(now_of(m_model->droplets, d), d.blood[k], s.share);
  s.sheer = sheer;
  liquid.splats.push_back(s);
}

/// Blood that lies on tissue is a film at once: most of it where the drop is now, the rest in a tail that thins out up
/// the way it came.
void FilmDrawing::list_splash(const fluids::DropletState& d, std::int32_t i, bool sheer, Liquid& liquid) const {
  const auto k = std::size_t(i);
  const Vec3f normal = normalised(d.ground[k].normal, Vec3f{0, 0, 1});
  const Vec3f here = at(d, i) - (dot(normal, at(d, i)) - d.ground[k].offset) * normal;
  const Vec3f fall = liquid.down - dot(liquid.down, normal) * normal;
  const float steep = length(fall), r = d.radius[k], volume = 4.18879f * r * r * r;
  const Vec3f along = steep > 1e-3f ? (1 / steep) * fall : Vec3f{}, across = cross(normal, along);
  const auto u = [&](int which) { return own(d.id[k], 50 + which); };
  struct Piece {
    float part, wide, up, length;  ///< of the volume; in radii
  };
  const float drawn = steep * (1 + 0.5f * u(0));
  const std::array<Piece, 3> pieces{{{0.62f, 1.25f + 0.3f * u(1), 0, 0.6f + 1.6f * drawn},
                                     {0.25f, 0.75f + 0.2f * u(2), 2.2f * drawn, 3.0f * drawn},
                                     {0.13f, 0.50f + 0.15f * u(3), 5.0f * drawn, 4.0f * drawn}}};
  for (int n = 0; n < 3; ++n) {
    const Piece& p = pieces[std::size_t(n)];
    // Where it is level it is no streak, but a few patches that run into one another.
    const Vec3f level = (1 - steep) * 1.3f * r *
                        (u(10 + n) * any_perpendicular(normal) + u(20 + n) * cross(normal, any_perpendicular(normal)));
    const Vec3f middle = here - (p.up * r) * along + (0.35f * r * float(n) * u(4 + n)) * across + level;
    Splat s;
    s.kind = SplatKind::film;
    s.normal = normal;
    s.from = middle - (0.5f * p.length * r) * along, s.to = middle + (0.5f * p.length * r) * along;
    s.radius = p.wide * r;
    s.height = film_height(p.part * volume, s.radius, p.length * r);
    // It spreads until it is thin.
    const float spread = std::clamp(std::sqrt(s.height / kThickestSplash), 1.0f, kMostSpread);
    s.radius *= spread;
    s.height = film_height(p.part * volume, s.radius, p.length * r);
    s.share = shares_of(d.volume[k]);
    s.dark = darkness(now_of(m_model->droplets, d), d.blood[k], s.share);
    s.sheer = sheer;
    liquid.splats.push_back(s);
  }
}

void FilmDrawing::list_films(const FluidSight& sight, Liquid& liquid) const {
  const std::vector<fluids::SmallMix>& film = sight.state.droplets.film;
  const Vec3f down = normalised(vec_cast<float>(m_model->droplets.gravity), Vec3f{0, 0, -1});
  const float now = now_of(m_model->droplets, sight.state.droplets);
  const std::size_t n = std::min(film.size(), sight.places.size());
  for (std::size_t k = 0; k < n; ++k) {
    const FilmPlace& place = sight.places[k];
    const float thickness = 1e-15f * float(film[k].total()) / place.area;
    if (!(thickness > kThinnestFilm) || !finite(place.position) || !finite(place.normal)) continue;
    Splat s = stain(place, thickness * place.area, float(varied(int(k & 0x7fffffff), 7)), down);
    s.share = shares_of(film[k]);
    s.dark = darkness(now, sight.state.droplets.film_blood[k], s.share);
    s.sheer = place.sheer;
    liquid.splats.push_back(s);
  }
}

}  // namespace trocar::view
