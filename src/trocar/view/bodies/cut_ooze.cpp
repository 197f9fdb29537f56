#include <algorithm>
#include <cmath>

#include <trocar/view/base/drawn_blood.hpp>
#include <trocar/view/base/mesh_buffer.hpp>
#include <trocar/view/base/relief.hpp>
#include <trocar/view/bodies/cut_ooze.hpp>

namespace trocar::view {
namespace {

// Our choice, by eye.
constexpr double kRunning = 0.35;      // share of the lip's vertices from which a run starts
constexpr float kOozeStep = 0.0011f;   // [m] between two links of a run
constexpr float kShortest = 0.004f;    // [m]
constexpr float kOozeWide = 0.42e-3f;  // [m]
constexpr float kOozeThick = 20e-6f;   // [m] at the lip; it thins out on its way, and swells where it stops
constexpr float kSheetWide = 0.0019f;  // [m] half of what a place of the lip wets below it
constexpr double kSheetLong = 0.0075, kSheetWave = 0.005;  // [m] how far, unequally, from one place to the next
constexpr float kBelowLip = 0.6e-3f;                       // [m] how far from the rim a run begins
constexpr float kOozeUnderside = 0.4f;                     // cosine between skin and fall at which blood drips
constexpr float kMostLeft = 0.0018f;                       // [m] beyond the skin's last vertex it ends
constexpr float kCutSize = 0.008f, kBrim = 0.0022f;        // [m] a cut's size; it spills this far above its lowest

struct SkinPlace {
  Vec3f position, normal;
};

/// Laid on the skin: on the plane of the vertex next to it. False where it has come to its end.
bool on_skin(const CutSkin& skin, SkinPlace& place) {
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

render::Splat film(const SkinPlace& from, const SkinPlace& to, float radius, float thick) {
  render::Splat s;
  s.kind = render::SplatKind::film;
  s.from = from.position, s.to = to.position;
  s.normal = normalised(from.normal + to.normal, from.normal);
  s.radius = radius;
  s.height = thick;
  s.dark = kDrawnDark;
  return s;
}

/// What lies on the lip hardly reaches back into the cut, where its border would be a line across what is raw.
SkinPlace below_lip(const CutSkin& skin, std::uint32_t v, Vec3f down) {
  const SkinPlace lip{skin.position[v], skin.normal[v]};
  SkinPlace below{lip.position + kBelowLip * (down - dot(down, lip.normal) * lip.normal), lip.normal};
  return on_skin(skin, below) ? below : lip;
}

bool at_rim(const CutSkin& skin, Vec3f p) {
  return std::any_of(skin.rim.begin(), skin.rim.end(),
                     [&](std::uint32_t r) { return length(skin.position[r] - p) < kBelowLip; });
}

/// A run that comes to a cut again is lost in it.
void list_run(const CutSkin& skin, SkinPlace at, int own, render::Liquid& liquid, std::vector<Vec3f>& drips) {
  const auto u = [own](int which) { return float(varied(own, which)); };
  const float far = kShortest + (kOozeReach - kShortest) * u(1), wide = kOozeWide * (0.7f + 1.3f * u(2) * u(2));
  const int links = int(far / kOozeStep);
  const std::size_t before = liquid.splats.size();
  for (int n = 0; n < links; ++n) {
    const Vec3f fall = liquid.down - dot(liquid.down, at.normal) * at.normal;
    const Vec3f across = cross(at.normal, fall);
    const float wind = 0.45f * std::sin(0.55f * float(n) + 6 * u(3)) + 0.3f * (u(20 + n) - 0.5f);
    SkinPlace next{at.position + kOozeStep * (normalised(fall, Vec3f{}) + wind * across), at.normal};
    if (!on_skin(skin, next) || dot(next.normal, liquid.down) > kOozeUnderside) {
      drips.push_back(at.position);
      return;
    }
    if (n > 0 && at_rim(skin, next.position)) {
      liquid.splats.resize(before);
      return;
    }
    const float gone = float(n) / float(links), stops = n + 2 >= links ? 1.9f : 1.0f;
    liquid.splats.push_back(
        film(at, next, wide * (1.15f - 0.45f * gone) * std::sqrt(stops), kOozeThick * (1 - 0.7f * gone) * stops));
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
    return dot(off, off) > kCutSize * kCutSize || dot(off, down) < kBrim;
  });
}

bool spills(const CutSkin& skin, std::size_t i, Vec3f down) {
  return lower_lip(skin, i, down) || lowest(skin, i, down);  // what comes from an upper lip runs into the cut
}

}  // namespace

std::vector<Vec3f> list_ooze(const CutSkin& skin, render::Liquid& liquid) {
  std::vector<Vec3f> drips;
  for (std::size_t i = 0; i < skin.rim.size(); ++i) {
    const std::uint32_t v = skin.rim[i];
    if (!spills(skin, i, liquid.down) || varied(int(v), 5) >= kRunning) continue;
    list_run(skin, below_lip(skin, v, liquid.down), int(v), liquid, drips);
  }
  return drips;
}

std::vector<float> sheet_below(const CutSkin& skin, std::span<const Vec3f> rest, Vec3f down) {
  std::vector<float> sheet(skin.around.size(), 0);
  for (std::size_t i = 0; i < skin.rim.size(); ++i) {
    if (!spills(skin, i, down)) continue;
    const std::uint32_t lip = skin.rim[i];
    const Vec3f across = normalised(cross(down, skin.normal[lip]), Vec3f{});
    const double reach = kSheetLong * (0.55 + 0.45 * waves(vec_cast<double>(rest[lip]), kSheetWave));
    for (std::size_t k = 0; k < skin.around.size(); ++k) {
      const Vec3f off = skin.position[skin.around[k]] - skin.position[lip];
      const double along = double(dot(off, down)), aside = std::abs(double(dot(off, across)));
      if (along < -0.5e-3 || along > reach || dot(off, off) > float(4 * kSheetLong * kSheetLong)) continue;
      const double wide = kSheetWide * (1 - 0.5 * along / reach);
      sheet[k] = std::max(sheet[k], float(smooth(reach, 0.4 * reach, along) * smooth(wide, 0.3 * wide, aside)));
    }
  }
  return sheet;
}

}  // namespace trocar::view
