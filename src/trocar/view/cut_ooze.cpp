#include <algorithm>
#include <cmath>

#include <trocar/view/cut_ooze.hpp>
#include <trocar/view/mesh_buffer.hpp>

namespace trocar::view {
namespace {

// Our choice, by eye.
constexpr float kDark = 0.7f;        // venous, not yet clotted
constexpr double kRunning = 0.35;    // share of the lip's vertices from which a run starts
constexpr float kStep = 0.0011f;     // [m] between two links of a run
constexpr float kShortest = 0.004f;  // [m]
constexpr float kWide = 0.42e-3f;    // [m]
constexpr float kThick = 60e-6f;     // [m] at the lip; it thins out on its way, and swells where it stops
constexpr float kSheetWide = 0.6e-3f, kSheetThick = 45e-6f;  // [m] so much that its darkest is at the lip
constexpr float kBelowLip = 0.6e-3f;                         // [m] how far from the rim that begins
constexpr float kDropWide = 0.9e-3f, kDropThick = 110e-6f;   // [m] what hangs there until it falls
constexpr float kHangs = 0.0011f, kHanging = 0.55e-3f;       // [m] how far down, and its radius
constexpr float kApart = 0.006f, kHangsBelow = 0.3f;         // [m] and cosine between skin and fall
constexpr float kUnderside = 0.4f;                           // cosine between skin and fall at which blood drips
constexpr float kMostLeft = 0.0035f;                         // [m] beyond the skin's last vertex it ends
constexpr float kCut = 0.008f, kBrim = 0.0022f;              // [m] a cut's size; it spills this far above its lowest

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
  s.dark = kDark;
  return s;
}

/// What lies on the lip hardly reaches back into the cut, where its border would be a line across what is raw.
Place below_lip(const CutSkin& skin, std::uint32_t v, Vec3f down) {
  const Place lip{skin.position[v], skin.normal[v]};
  Place below{lip.position + kBelowLip * (down - dot(down, lip.normal) * lip.normal), lip.normal};
  return on_skin(skin, below) ? below : lip;
}

/// Drops that hang there until they fall, none beside another.
void hang(const CutSkin& skin, std::span<const Vec3f> drips, render::Liquid& liquid) {
  for (std::size_t i = 0; i < drips.size(); ++i) {
    const auto beside = [&](Vec3f other) { return length(other - drips[i]) < kApart; };
    if (std::any_of(drips.begin(), drips.begin() + std::ptrdiff_t(i), beside)) continue;
    Place at{drips[i], {}};
    if (!on_skin(skin, at) || dot(at.normal, liquid.down) < kHangsBelow) continue;
    render::Splat s;
    s.kind = render::SplatKind::flying;
    s.from = at.position, s.to = at.position + kHangs * liquid.down;
    s.radius = s.height = kHanging;
    s.normal = at.normal;
    s.dark = kDark;
    liquid.splats.push_back(s);
  }
}

void list_run(const CutSkin& skin, Place at, int own, render::Liquid& liquid, std::vector<Vec3f>& drips) {
  const auto u = [own](int which) { return float(varied(own, which)); };
  const float far = kShortest + (kOozeReach - kShortest) * u(1), wide = kWide * (0.7f + 1.3f * u(2) * u(2));
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

/// What wells over the lip there: a sheet that hides what is below it and runs out downwards.
void list_sheet(const CutSkin& skin, Place at, int own, render::Liquid& liquid) {
  const int links = 2 + int(4 * varied(own, 9));
  for (int n = 0; n < links; ++n) {
    const Vec3f fall = liquid.down - dot(liquid.down, at.normal) * at.normal;
    Place next{at.position + kStep * fall, at.normal};
    if (!on_skin(skin, next)) return;
    const float gone = float(n) / float(links);
    liquid.splats.push_back(film(at, next, kSheetWide * (1 - 0.5f * gone), kSheetThick * (1 - 0.75f * gone)));
    at = next;
  }
}

bool lower_lip(const CutSkin& skin, std::size_t i, Vec3f down) {
  const Vec3f n = skin.normal[skin.rim[i]], fall = down - dot(down, n) * n;
  return dot(skin.outwards[i], fall) > 0.4f * length(fall);
}

/// A cut is full of blood: at its lowest place it spills, whichever way the lip faces there.
bool lowest(const CutSkin& skin, std::size_t i, Vec3f down) {
  const Vec3f p = skin.position[skin.rim[i]];
  return std::all_of(skin.rim.begin(), skin.rim.end(), [&](std::uint32_t other) {
    const Vec3f off = skin.position[other] - p;
    return dot(off, off) > kCut * kCut || dot(off, down) < kBrim;
  });
}

}  // namespace

std::vector<Vec3f> list_ooze(const CutSkin& skin, render::Liquid& liquid) {
  std::vector<Vec3f> drips;
  for (std::size_t i = 0; i < skin.rim.size(); ++i) {
    const std::uint32_t v = skin.rim[i];
    const bool lower = lower_lip(skin, i, liquid.down);
    if (!lower && !lowest(skin, i, liquid.down)) continue;  // what comes from an upper lip runs into the cut
    const Place from = lower ? below_lip(skin, v, liquid.down) : Place{skin.position[v], skin.normal[v]};
    list_sheet(skin, from, int(v), liquid);
    if (varied(int(v), 5) < kRunning) list_run(skin, from, int(v), liquid, drips);
  }
  hang(skin, drips, liquid);
  return drips;
}

}  // namespace trocar::view
