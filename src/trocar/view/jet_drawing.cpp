#include <algorithm>
#include <cmath>

#include <trocar/view/film_splats.hpp>
#include <trocar/view/jet_drawing.hpp>
#include <trocar/view/mesh_buffer.hpp>

namespace trocar::view {
namespace {

using render::Liquid;
using render::Splat;
using render::SplatKind;

// Our choice, all of them: from the look of spurts in endoscopic films.
constexpr float kShutter = 0.006f;   // [s] a camera's: what flies is a streak
constexpr float kWhole = 0.010f;     // [m] from its hole: so far a jet of blood is whole
constexpr float kSpray = 0.040f;     // [m] ... and from here on spray
constexpr float kWag = 0.075f;       // how far a jet's drops stray aside, a share of their way
constexpr int kShards = 3;           // what a drop of spray is drawn as
constexpr float kFreshJet = 0.006f;  // [m] blood that has come less far shows where its hole is
constexpr float kThinStreak = 0.06e-3f, kWideStreak = 0.13e-3f;  // [m] half of what a shard's streak is wide
constexpr float kDensestStreak = 22e-6f;                         // [m]
constexpr float kThread = 240e-6f, kShred = 70e-6f;  // [m] how thick a jet's blood looks near its hole, and torn up
constexpr float kThinner = 0.75f;                    // of a link's radius: what the shutter smears has soft sides
constexpr float kStreakDense = 0.35f;   // its amount, of what it would be at rest: a shutter smears light, not blood
constexpr float kLongestLink = 9.0f;    // in radii: a jet's drops hang together up to here
constexpr float kThinnestLink = 0.30f;  // in radii: ... and until the thread between them is so thin

/// How broken up a jet is after so long a way, 0 to 1.
float broken_up(float way) { return float(smooth(double(kWhole), double(kSpray), double(way))); }

/// A drop in flight, smeared over the time the shutter is open.
Splat streak(Vec3f p, Vec3f v, float radius, const std::array<float, 3>& share) {
  Splat s;
  s.kind = SplatKind::streak;
  const Vec3f way = 0.5f * kShutter * v;
  s.from = p - way, s.to = p + way;
  s.radius = std::clamp(0.4f * radius, kThinStreak, kWideStreak);
  s.height = std::min(kStreakDense * film_height(4.18879f * radius * radius * radius, s.radius, 2 * length(way)),
                      kDensestStreak);
  s.share = share;
  return s;
}

/// How far a jet's blood has come since it left its vessel [m]; 0 of other fluids, which do not know it and hang
/// together better.
float come(const fluids::DropletModel& m, const fluids::DropletState& d, std::int32_t i) {
  const auto k = std::size_t(i);
  const fluids::SmallMix& mix = d.volume[k];
  if (!(2 * std::int64_t(mix.blood) > mix.total())) return 0;
  const float age = std::max(now_of(m, d) - d.blood[k].born, 0.0f);
  // What goes up stops at the top of its way: what counts is how fast it was, too.
  const Vec3f first = speed(d, i) - age * vec_cast<float>(m.gravity);
  return 0.5f * age * (length(speed(d, i)) + length(first));
}

/// Aside of the way of what flies: a jet wags as its hole does, and the drops of one stray the more the farther they
/// are.
Vec3f aside(Vec3f v, std::uint32_t id, float way) {
  const Vec3f along = normalised(v, Vec3f{0, 0, 1});
  const Vec3f one = normalised(cross(along, std::fabs(along.x) < 0.7f ? Vec3f{1, 0, 0} : Vec3f{0, 1, 0}));
  const Vec3f other = cross(along, one);
  const float slow = float(id % 4096), far = kWag * way * std::min(way / 0.02f, 1.0f);
  const float x = 0.45f * std::sin(0.31f * slow) + 0.25f * std::sin(0.83f * slow + 1) + 0.3f * own(id, 11);
  const float y = 0.45f * std::sin(0.27f * slow + 2) + 0.25f * std::sin(0.71f * slow) + 0.3f * own(id, 12);
  return (far * x) * one + (far * y) * other;
}

/// Where a flying drop is drawn.
Vec3f drawn_at(const fluids::DropletModel& m, const fluids::DropletState& d, std::int32_t i) {
  return at(d, i) + aside(speed(d, i), d.id[std::size_t(i)], come(m, d, i));
}

}  // namespace

void JetDrawing::gather(const fluids::DropletState& d) {
  m_flying.clear();
  for (std::int32_t i = 0; i < d.count; ++i) {
    const auto k = std::size_t(i);
    if (d.body[k] >= 0 || !(d.radius[k] > 0) || !finite(at(d, i)) || !finite(speed(d, i))) continue;
    m_flying.push_back({d.id[k], i, false});
  }
  std::sort(m_flying.begin(), m_flying.end(), [](const Flying& a, const Flying& b) { return a.id < b.id; });
}

/// The drop that left the same opening just before or after it and still hangs together with it, or the end.
std::size_t JetDrawing::next_in_strand(const fluids::DropletState& d, std::size_t n) const {
  const std::int32_t i = m_flying[n].at;
  const float r = d.radius[std::size_t(i)];
  for (std::size_t m = n + 1; m < std::min(n + 9, m_flying.size()); ++m) {
    const std::int32_t j = m_flying[m].at;
    const float other = d.radius[std::size_t(j)], size = std::max(r, other);
    const Vec3f way = at(d, j) - at(d, i), difference = speed(d, j) - speed(d, i);
    const float far = length(way), fast = length(speed(d, i));
    if (far > kLongestLink * size || far < 0.2f * size || std::min(r, other) < 0.35f * size) continue;
    if (length(difference) > 0.25f * fast + 0.1f) continue;
    if (std::fabs(dot(way, speed(d, i))) < 0.75f * far * fast) continue;  // side by side
    return m;
  }
  return m_flying.size();
}

/// A strand between two drops, of their volume; drops keep what the strand is too thin for.
bool JetDrawing::link(const fluids::DropletState& d, std::int32_t i, std::int32_t j, Liquid& liquid) const {
  const float r = d.radius[std::size_t(i)], other = d.radius[std::size_t(j)], size = std::max(r, other);
  const float now = now_of(m_model->droplets, d), way = come(m_model->droplets, d, i), broken = broken_up(way);
  const std::uint32_t id = d.id[std::size_t(i)];
  if (float(varied(int(id & 0xffffff), 21)) < 1.6f * broken - 0.6f) return false;
  const float far = length(at(d, j) - at(d, i));
  float thin = std::min(std::sqrt(2.0f / 3 * (r * r * r + other * other * other) / far), 0.95f * size);
  if (thin < kThinnestLink * size) return false;
  // It swells and narrows on its way before it breaks [Rayleigh 1878], and each beat of the heart sends a thicker part.
  const float swell = 0.5f * std::sin(0.9f * float(id % 4096)) + 0.5f * std::sin(0.37f * float(id % 4096) + 1);
  thin *= 0.85f - std::min(way / kWhole, 1.0f) * (0.22f - 0.16f * own(id, 22) - 0.28f * swell);
  Splat s;
  s.from = drawn_at(m_model->droplets, d, i), s.to = drawn_at(m_model->droplets, d, j);
  s.radius = thin;
  s.height = thin;
  if (way > 0) {  // of blood that flies the shutter leaves a ribbon, without a rod's ends
    const Vec3f longer = (0.35f + 0.5f * broken) * (s.to - s.from);
    s.kind = SplatKind::streak;
    s.from -= std::min(1.0f, way / length(longer)) * longer, s.to += longer;
    s.radius *= kThinner * (1 - 0.6f * broken);
    s.height = kThread + std::min(0.25f * way / kWhole + 2 * broken, 1.0f) * (kShred * (1 - 0.7f * broken) - kThread);
  }
  s.share = shares_of(d.volume[std::size_t(i)]);
  s.dark = darkness(now, d.blood[std::size_t(i)], s.share);
  liquid.splats.push_back(s);
  return thin > 0.5f * size || way > 0;
}

/// Drops that left an opening one after the other hang together as a strand until it has run too thin.
void JetDrawing::list(const FluidSight& sight, Vec3f eye, Liquid& liquid) {
  const fluids::DropletState& d = sight.state.droplets;
  gather(d);
  for (std::size_t n = 0; n < m_flying.size(); ++n) {
    const std::size_t m = next_in_strand(d, n);
    if (m == m_flying.size() || !link(d, m_flying[n].at, m_flying[m].at, liquid)) continue;
    m_flying[n].in_strand = m_flying[m].in_strand = true;
  }
  for (const Flying& drop : m_flying) {
    const float way = come(m_model->droplets, d, drop.at);
    if (drop.in_strand && broken_up(way) < 0.2f) continue;
    list_spray(d, drop, liquid);
  }
  list_holes(sight, eye, liquid);
}

/// A drop that is on its own: whole near its hole, shards of it farther off.
void JetDrawing::list_spray(const fluids::DropletState& d, const Flying& drop, Liquid& liquid) const {
  const auto k = std::size_t(drop.at);
  const float now = now_of(m_model->droplets, d), way = come(m_model->droplets, d, drop.at), r = d.radius[k];
  const Vec3f v = speed(d, drop.at), place = drawn_at(m_model->droplets, d, drop.at);
  const std::array<float, 3> share = shares_of(d.volume[k]);
  const float dark = darkness(now, d.blood[k], share), apart = broken_up(way);
  const int shards = apart > 0 ? kShards : 1;
  for (int n = drop.in_strand ? 1 : 0; n < shards; ++n) {
    const auto u = [&](int which) { return own(d.id[k], 31 + 4 * n + which); };
    // The first keeps half of it, the others are small and all over the place.
    const float size = shards == 1 ? r : r * (n == 0 ? 0.8f - 0.4f * apart : 0.14f + 0.28f * std::fabs(u(0)));
    const float off = n == 0 ? 0.0f : apart * (0.002f + 0.05f * way);
    const Vec3f to_side = aside(v, d.id[k] * 7u + std::uint32_t(n), 1.0f) * (off / kWag);
    const Vec3f ahead = (apart * 9 * r * u(1) * (n == 0 ? 0.0f : 1.0f)) * normalised(v, Vec3f{0, 0, 1});
    // No two fly alike: some are overtaken, some stray.
    const float slower = 1 - apart * (n == 0 ? 0.35f : 0.75f) * std::fabs(u(2));
    const Vec3f strays = aside(v, d.id[k] * 13u + std::uint32_t(n), 1.0f) * (0.25f * apart * length(v) / kWag);
    // Shards tumble: what the shutter smears of some is shorter, each at its own angle.
    const Vec3f smeared = (1 - apart * 0.6f * std::fabs(u(3))) * (slower * v + 2.0f * strays);
    Splat s = streak(place + to_side + ahead, smeared, size, share);
    s.dark = dark;
    liquid.splats.push_back(s);
  }
}

/// A hole is where the youngest blood of a jet comes from.
void JetDrawing::list_holes(const FluidSight& sight, Vec3f eye, Liquid& liquid) const {
  const fluids::DropletState& d = sight.state.droplets;
  const float now = now_of(m_model->droplets, d);
  std::vector<Vec3f> known;
  for (const Flying& drop : m_flying) {
    const auto k = std::size_t(drop.at);
    const float way = come(m_model->droplets, d, drop.at);
    if (!drop.in_strand || way > kFreshJet || !(way > 0)) continue;
    const Vec3f hole = at(d, drop.at) - way * normalised(speed(d, drop.at), Vec3f{0, 0, 1});
    const auto near = [hole](Vec3f other) { return length(other - hole) < 0.004f; };
    if (std::any_of(known.begin(), known.end(), near)) continue;
    known.push_back(hole);
    const FilmPlace facing{hole, normalised(eye - hole, Vec3f{0, 0, 1})};
    Wound wound;
    wound.down = liquid.down;
    wound.share = shares_of(d.volume[k]);
    wound.dark = darkness(now, d.blood[k], wound.share);
    list_wound(wound, sight.surface ? sight.surface(facing) : facing, sight.surface, liquid);
  }
}

}  // namespace trocar::view
