#include <cmath>

#include <trocar/view/cut_ooze.hpp>
#include <trocar/view/mesh_buffer.hpp>

namespace trocar::view {
namespace {

// Our choice, by eye.
constexpr double kRunning = 0.6;     // share of the rim's vertices from which a run starts
constexpr float kStep = 0.0011f;     // [m] between two links of a run
constexpr float kShortest = 0.004f;  // [m]
constexpr float kWide = 0.42e-3f;    // [m]
constexpr float kThick = 50e-6f;     // [m] at the rim; it thins out on its way, and swells where it stops
constexpr float kSheetWide = 1.0e-3f, kSheetThick = 6e-6f;  // [m]
constexpr float kDropWide = 0.9e-3f, kDropThick = 150e-6f;  // [m] what hangs there until it falls
constexpr float kUnderside = 0.4f;                          // cosine between skin and fall at which blood drips
constexpr float kMostLeft = 0.0035f;                        // [m] beyond the skin's last vertex it ends

struct Place {
  Vec3f position, normal;
};

/// Laid on the skin: on the plane of the vertex next to it. False where it has come to its end.
bool on_skin(const CutSkin& skin, Place& place) {
  float nearest = kMostLeft * kMostLeft;
  const Vec3f p = place.position;
  bool found = false;
  for (const std::uint32_t v : skin.around) {
    const Vec3f off = p - skin.position[v];
    if (dot(off, off) >= nearest) continue;
    nearest = dot(off, off), found = true;
    place.normal = skin.normal[v];
    place.position = p - dot(off, place.normal) * place.normal;
  }
  return found;
}

render::Splat film(const Place& from, const Place& to, float radius, float thick) {
  render::Splat s;
  s.kind = render::SplatKind::film;
  s.from = from.position, s.to = to.position;
  s.normal = normalised(from.normal + to.normal, from.normal);
  s.radius = radius;
  s.height = thick;
  s.dark = 1;  // from liver's veins and capillaries
  return s;
}

void list_run(const CutSkin& skin, Place at, int own, render::Liquid& liquid, std::vector<Vec3f>& drips) {
  const auto u = [own](int which) { return float(varied(own, which)); };
  const float far = kShortest + (kOozeReach - kShortest) * u(1), wide = kWide * (0.7f + 0.8f * u(2));
  const int links = int(far / kStep);
  for (int n = 0; n < links; ++n) {
    const Vec3f fall = liquid.down - dot(liquid.down, at.normal) * at.normal;
    const Vec3f across = cross(at.normal, fall);
    const float wind = 0.45f * std::sin(0.55f * float(n) + 6 * u(3)) + 0.3f * (u(20 + n) - 0.5f);
    Place next{at.position + kStep * (normalised(fall, Vec3f{}) + wind * across), at.normal};
    if (!on_skin(skin, next) || dot(next.normal, liquid.down) > kUnderside) {
      drips.push_back(at.position);
      liquid.splats.push_back(film(at, at, kDropWide, kDropThick));
      return;
    }
    const float gone = float(n) / float(links), stops = n + 2 >= links ? 1.9f : 1.0f;
    liquid.splats.push_back(
        film(at, next, wide * (1.15f - 0.45f * gone) * std::sqrt(stops), kThick * (1 - 0.7f * gone) * stops));
    at = next;
  }
}

/// What wells over the lip there: a thin sheet.
void list_sheet(const CutSkin& skin, std::uint32_t v, render::Liquid& liquid) {
  Place at{skin.position[v], skin.normal[v]};
  const int links = 2 + int(3 * varied(int(v), 9));
  for (int n = 0; n < links; ++n) {
    const Vec3f fall = liquid.down - dot(liquid.down, at.normal) * at.normal;
    Place next{at.position + kStep * fall, at.normal};
    if (!on_skin(skin, next)) return;
    const float gone = float(n) / 5;
    liquid.splats.push_back(film(at, next, kSheetWide * (1 - 0.6f * gone), kSheetThick * (1 - 0.7f * gone)));
    at = next;
  }
}

}  // namespace

std::vector<Vec3f> list_ooze(const CutSkin& skin, render::Liquid& liquid) {
  std::vector<Vec3f> drips;
  for (std::size_t i = 0; i < skin.rim.size(); ++i) {
    const std::uint32_t v = skin.rim[i];
    const Vec3f fall = liquid.down - dot(liquid.down, skin.normal[v]) * skin.normal[v];
    const bool lower = dot(skin.outwards[i], fall) > 0.15f * length(fall);
    if (!lower) continue;  // what comes from an upper lip runs into the cut
    list_sheet(skin, v, liquid);
    if (varied(int(v), 5) < kRunning) list_run(skin, {skin.position[v], skin.normal[v]}, int(v), liquid, drips);
  }
  return drips;
}

}  // namespace trocar::view
