#include <algorithm>
#include <cmath>

#include <trocar/view/fluid_drawing.hpp>
#include <trocar/view/mesh_buffer.hpp>
#include <trocar/view/relief.hpp>
#include <trocar/view/wound.hpp>

namespace trocar::view {
namespace {

using render::Liquid;
using render::Splat;
using render::SplatKind;

// Our choice, all of them: from the look of spurts and rivulets in endoscopic films.
constexpr float kCellsScatter = 1.6e3f;  // [1/m] red cells, forward scattering left out: blood is no red glass
constexpr float kBloodOrange = 7e3f;  // [1/m] mean of whole blood at 585 to 600 nm, tabulated [Prahl 1999], as Optics
constexpr float kShutter = 0.005f;    // [s] a camera's: what flies is a streak
constexpr float kWhole = 0.010f;      // [m] from its hole: so far a jet of blood is whole
constexpr float kSpray = 0.024f;      // [m] ... and from here on spray
constexpr float kWag = 0.075f;        // how far a jet's drops stray aside, a share of their way
constexpr int kShards = 5;            // what a drop of spray is drawn as
constexpr float kFreshJet = 0.006f;   // [m] blood that has come less far shows where its hole is
constexpr float kThinStreak = 0.08e-3f, kWideStreak = 0.19e-3f;  // [m] half of what a shard's streak is wide
constexpr float kDensestStreak = 28e-6f;                         // [m]
constexpr float kShreds = 0.12f, kShred = 110e-6f;               // from so broken on links are shreds; [m] how thick
constexpr float kStreakDense = 0.35f;     // its amount, of what it would be at rest: a shutter smears light, not blood
constexpr float kBleedsAsFilm = 0.3f;     // share of blood from which a drop on tissue is film at once
constexpr float kLongestLink = 9.0f;      // in radii: a jet's drops hang together up to here
constexpr float kThinnestLink = 0.30f;    // in radii: ... and until the thread between them is so thin
constexpr float kCapSpread = 2.0f;        // radius of a cap over that of its ball
constexpr float kLongestTail = 4.0f;      // of a running drop, in radii
constexpr float kTailSpeed = 0.05f;       // [m/s] at which the tail is half of it
constexpr float kRunThickness = 20e-6f;   // [m] of what a running drop leaves; where there is less it covers less
constexpr float kWidestRun = 0.0032f;     // [m] ... and how wide: what lies beyond is drawn out downhill
constexpr float kThinnestRun = 0.0008f;   // [m] ... and how narrow
constexpr float kOverlap = 1.5f;          // a rivulet's length within a place over the place's edge: no gaps
constexpr float kWander = 0.0009f;        // [m]
constexpr float kThinnestFilm = 0.4e-6f;  // [m] not drawn below
constexpr float kWetDepth = 60e-6f;       // [m] at which a cell of the pool counts as wet
constexpr int kMargin = 6;                // cells around the wet ones
constexpr float kOverhang = 0.004f;       // [m] a floor so far above the level is an organ with room below it
// What runs down a wall is no pool: where the floor is steeper than this and what is on it shallow it is drawn as film.
constexpr float kLevelFloor = 0.35f, kSteepFloor = 0.8f;         // rise over run
constexpr float kShallow = 0.0015f, kDeep = 0.0045f;             // [m]
constexpr float kThickestRun = 48e-6f, kThickestStain = 22e-6f;  // [m] of what is drawn so, and of a tide's mark
constexpr float kTide = 0.0045f;                                 // [m] how far it reaches

Vec3f to_float(const fluids::Rgb& c) { return {float(c.r), float(c.g), float(c.b)}; }

template <class Volume>
std::array<float, 3> shares_of(const Volume& v) {
  const double all = double(std::max<std::int64_t>(v.total(), 1));
  return {float(double(v.blood) / all), float(double(v.saline) / all), float(double(v.bile) / all)};
}

/// How much darker than fresh arterial blood, 0 to 1: what comes from veins, and what clots; next to none of it does
/// not show. Venous blood half-way to a clot, as its colour is (our choice).
float darkness(float now, fluids::Blood blood, const std::array<float, 3>& share) {
  constexpr float kVenous = 0.6f;
  if (share[0] <= 0.02f) return 0;
  const float brightness = float(fluids::clot_brightness(double(now - blood.born)));
  const float clot = (1 - brightness) / 0.6f;
  return 1 - (1 - clot) * (1 - kVenous * blood.venous);
}

Vec3f at(const fluids::DropletState& d, std::int32_t i) {
  const auto k = std::size_t(i);
  return {d.x[k], d.y[k], d.z[k]};
}
Vec3f speed(const fluids::DropletState& d, std::int32_t i) {
  const auto k = std::size_t(i);
  return {d.vx[k], d.vy[k], d.vz[k]};
}

bool finite(Vec3f v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

/// How broken up a jet is after so long a way, 0 to 1.
float broken_up(float way) { return float(smooth(double(kWhole), double(kSpray), double(way))); }

/// Of a stain whose blobs add up to `volume` [m^3]: a splat's film is its height times (1 - r^2)^2, r in reaches
/// (splat.frag), which makes pi/3 of a round end's area and 16/15 of a reach of the rest's.
float film_height(float volume, float radius, float tail) {
  const float reach = render::kSplatReach * radius;
  return volume / (1.0472f * reach * reach + 1.0667f * reach * tail);
}

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

/// -1 .. 1, a drop's own.
float own(std::uint32_t id, int which) { return 2 * float(varied(int(id & 0xffffff), which)) - 1; }

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

/// Rivulets do not run straight: how far aside of the steepest way one is at `p` [m].
float wander(Vec3f p, Vec3f down) {
  const float along = dot(p, down), phase = 260 * (p.x + p.y + p.z);
  return kWander * (std::sin(520 * along + phase) + 0.5f * std::sin(1270 * along - 1.7f * phase));
}

/// `volume` [m^3] of film as a rivulet left it: downhill through the place, as wide as there is enough for; round
/// where it is level. @param own 0..1, for variety
Splat stain(const FilmPlace& place, float volume, float own, Vec3f down) {
  const Vec3f fall = down - dot(down, place.normal) * place.normal;
  const float steep = length(fall), covered = std::min(place.area, volume / kRunThickness);
  const Vec3f along = steep > 1e-3f ? (1 / steep) * fall : Vec3f{0, 0, 0}, across = cross(place.normal, along);
  const float round = std::sqrt(covered), through = std::max(kOverlap * std::sqrt(place.area), round);
  const float far = round + std::min(2 * steep, 1.0f) * (through - round);
  const float width = std::clamp(covered / far * (0.7f + 0.6f * own), kThinnestRun, kWidestRun);
  const Vec3f half = (0.5f * std::max(far - width, 0.0f)) * along;
  Splat s;
  s.kind = SplatKind::film;
  s.from = place.position - half, s.to = place.position + half;
  s.from += (steep * wander(s.from, down)) * across, s.to += (steep * wander(s.to, down)) * across;
  s.normal = place.normal;
  s.radius = 0.7f * width;
  s.height = film_height(volume, s.radius, length(s.to - s.from));
  return s;
}

/// What runs down gathers in rivulets: how thick it is at a place, 1 in the mean or so.
float rivulets(const FilmPlace& place, Vec3f down) {
  const Vec3d p = vec_cast<double>(place.position), fall = vec_cast<double>(down);
  const Vec3d across = normalised(cross(vec_cast<double>(place.normal), fall), {1, 0, 0});
  const double a = dot(p, across) + 0.0015 * waves(p, 0.02), b = dot(p, fall);
  return float(std::clamp(0.85 + 1.1 * waves({a, 0.12 * b, 0}, 0.009), 0.04, 2.0));
}

float smooth_step(float x) { return float(smooth(0.0, 1.0, double(x))); }

/// Three by three, 1 2 1, in place.
void smooth_once(std::vector<float>& field, std::vector<float>& scratch, int width, int height) {
  scratch.resize(field.size());
  const auto line = [](const std::vector<float>& in, std::vector<float>& out, std::size_t first, std::size_t step,
                       int n) {
    for (int k = 0; k < n; ++k) {
      const std::size_t c = first + step * std::size_t(k);
      const float low = in[k > 0 ? c - step : c], high = in[k + 1 < n ? c + step : c];
      out[c] = 0.25f * low + 0.5f * in[c] + 0.25f * high;
    }
  };
  for (int j = 0; j < height; ++j) line(field, scratch, std::size_t(j) * width, 1, width);
  for (int i = 0; i < width; ++i) line(scratch, field, std::size_t(i), std::size_t(width), height);
}

}  // namespace

render::LiquidLook liquid_look(const fluids::Optics& o) {
  render::LiquidLook look;
  look.kinds[0] = {to_float(o.arterial), kCellsScatter, to_float(o.deep_blood), 20, kBloodOrange};
  look.kinds[1] = {to_float(o.saline), 0, {0, 0, 0}, 0, 0};
  look.kinds[2] = {to_float(o.bile), 0, to_float(o.deep_bile), 1, 0};
  return look;
}

FluidDrawing::FluidDrawing(const fluids::FluidsModel& model, const fluids::Optics& optics)
    : m_model(&model), m_look(liquid_look(optics)) {}

void FluidDrawing::list(const FluidSight& sight, render::Frame& frame) {
  Liquid& liquid = frame.liquid;
  liquid.look = m_look;
  liquid.down = normalised(vec_cast<float>(m_model->droplets.gravity), Vec3f{0, 0, -1});
  m_eye = frame.camera.position;
  list_pool(sight, liquid);
  list_runs(sight, liquid);
  list_films(sight, liquid);
  list_lying(sight.state.droplets, sight.sheer_bodies, liquid);
  list_flying(sight, liquid);
}

/// The drop that left the same opening just before or after it and still hangs together with it, or the end.
std::size_t FluidDrawing::next_in_strand(const fluids::DropletState& d, std::size_t n) const {
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
bool FluidDrawing::link(const fluids::DropletState& d, std::int32_t i, std::int32_t j, Liquid& liquid) const {
  const float r = d.radius[std::size_t(i)], other = d.radius[std::size_t(j)], size = std::max(r, other);
  const float now = now_of(m_model->droplets, d), way = come(m_model->droplets, d, i), broken = broken_up(way);
  const std::uint32_t id = d.id[std::size_t(i)];
  if (float(varied(int(id & 0xffffff), 21)) < broken) return false;
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
  if (broken > kShreds) {  // what is left of it there has no ends like a rod's
    const Vec3f longer = 0.35f * (s.to - s.from);
    s.kind = SplatKind::streak;
    s.from -= longer, s.to += longer;
    s.height = kShred;
  }
  s.share = shares_of(d.volume[std::size_t(i)]);
  s.dark = darkness(now, d.blood[std::size_t(i)], s.share);
  liquid.splats.push_back(s);
  return thin > 0.5f * size || way > 0;
}

/// Drops that left an opening one after the other hang together as a strand until it has run too thin.
void FluidDrawing::list_flying(const FluidSight& sight, Liquid& liquid) {
  const fluids::DropletState& d = sight.state.droplets;
  m_flying.clear();
  for (std::int32_t i = 0; i < d.count; ++i) {
    const auto k = std::size_t(i);
    if (d.body[k] >= 0 || !(d.radius[k] > 0) || !finite(at(d, i)) || !finite(speed(d, i))) continue;
    m_flying.push_back({d.id[k], i, false});
  }
  std::sort(m_flying.begin(), m_flying.end(), [](const Flying& a, const Flying& b) { return a.id < b.id; });
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
  list_holes(sight, liquid);
}

/// A drop that is on its own: whole near its hole, shards of it farther off.
void FluidDrawing::list_spray(const fluids::DropletState& d, const Flying& drop, Liquid& liquid) const {
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
    // Shards tumble: what the shutter smears of them is short, each at its own angle.
    const Vec3f smeared = (1 - apart * (0.55f + 0.35f * std::fabs(u(3)))) * (slower * v + 2.0f * strays);
    Splat s = streak(place + to_side + ahead, smeared, size, share);
    s.dark = dark;
    liquid.splats.push_back(s);
  }
}

/// A hole is where the youngest blood of a jet comes from.
void FluidDrawing::list_holes(const FluidSight& sight, Liquid& liquid) const {
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
    const FilmPlace facing{hole, normalised(m_eye - hole, Vec3f{0, 0, 1})};
    Wound wound;
    wound.down = liquid.down;
    wound.share = shares_of(d.volume[k]);
    wound.dark = darkness(now, d.blood[k], wound.share);
    list_wound(wound, sight.surface ? sight.surface(facing) : facing, sight.surface, liquid);
  }
}

/// A cap of the drop's volume, wider than it is high, drawn out behind it as it runs.
void FluidDrawing::list_lying(const fluids::DropletState& d, std::span<const std::uint8_t> sheer, Liquid& liquid) {
  for (std::int32_t i = 0; i < d.count; ++i) {
    const auto k = std::size_t(i);
    if (d.body[k] < 0 || !(d.radius[k] > 0) || !finite(at(d, i)) || !finite(speed(d, i))) continue;
    const Vec3f normal = normalised(d.ground[k].normal, Vec3f{0, 0, 1});
    Vec3f v = speed(d, i) - d.ground[k].velocity;
    v -= dot(v, normal) * normal;
    const float fast = length(v), r = d.radius[k];
    const std::array<float, 3> share = shares_of(d.volume[k]);
    const bool sheer_below = std::size_t(d.body[k]) < sheer.size() && sheer[std::size_t(d.body[k])] != 0;
    if (share[0] > kBleedsAsFilm) {
      list_splash(d, i, sheer_below, liquid);
      continue;
    }
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
    s.sheer = sheer_below;
    liquid.splats.push_back(s);
  }
}

/// Blood that lies on tissue is a film at once: most of it where the drop is now, the rest in a tail that thins out up
/// the way it came.
void FluidDrawing::list_splash(const fluids::DropletState& d, std::int32_t i, bool sheer, Liquid& liquid) const {
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
    s.share = shares_of(d.volume[k]);
    s.dark = darkness(now_of(m_model->droplets, d), d.blood[k], s.share);
    s.sheer = sheer;
    liquid.splats.push_back(s);
  }
}

void FluidDrawing::list_films(const FluidSight& sight, Liquid& liquid) {
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

/// Rise of the floor over a cell's width, along both axes.
std::array<float, 2> FluidDrawing::floor_rise(std::span<const float> floor, int i, int j) const {
  const fluids::PoolModel& m = m_model->pool;
  const int west = std::max(i - 1, 0), east = std::min(i + 1, m.nx - 1);
  const int south = std::max(j - 1, 0), north = std::min(j + 1, m.ny - 1);
  const float cell = float(m.cell);
  return {(floor_at(m, floor, east, j) - floor_at(m, floor, west, j)) / (cell * float(east - west)),
          (floor_at(m, floor, i, north) - floor_at(m, floor, i, south)) / (cell * float(north - south))};
}

/// Which share of a cell's fluid runs down a wall, 0 to 1.
float FluidDrawing::runs_down(const fluids::PoolState& pool, std::span<const float> floor, int i, int j) const {
  const float depth = depth_at(m_model->pool, pool, i, j);
  if (!(depth > 0)) return 0;
  const auto [u, v] = floor_rise(floor, i, j);
  const double steep = smooth(double(kLevelFloor), double(kSteepFloor), double(std::hypot(u, v)));
  return float(steep * smooth(double(kDeep), double(kShallow), double(depth)));
}

/// Two by two of the pool's cells, as a place of film on the floor.
FilmPlace FluidDrawing::block_of(std::span<const float> floor, int i, int j) const {
  const fluids::PoolModel& m = m_model->pool;
  const auto at = [&](int a, int b) {
    return double(floor_at(m, floor, std::min(i + a, m.nx - 1), std::min(j + b, m.ny - 1)));
  };
  const auto [u, v] = floor_rise(floor, i, j);
  FilmPlace place;
  place.position =
      vec_cast<float>(world(m, (i + 1) * m.cell, (j + 1) * m.cell, 0.25 * (at(0, 0) + at(1, 0) + at(0, 1) + at(1, 1))));
  place.normal = vec_cast<float>(normalised(m.up - double(u) * m.u - double(v) * m.v, m.up));
  place.area = 4 * float(m.cell * m.cell) * std::sqrt(1 + u * u + v * v);
  return place;
}

/// What runs down walls into the pool, and the stain that it leaves beyond its border where it has been.
void FluidDrawing::list_runs(const FluidSight& sight, Liquid& liquid) const {
  const fluids::PoolModel& m = m_model->pool;
  const Vec3f down = normalised(vec_cast<float>(m_model->droplets.gravity), Vec3f{0, 0, -1});
  const float now = now_of(m_model->droplets, sight.state.droplets);
  for (int j = m_window.j0 & 1; j + 1 < m_window.height; j += 2)
    for (int i = m_window.i0 & 1; i + 1 < m_window.width; i += 2) {
      const std::size_t k = std::size_t(j) * m_window.width + i;
      const int ci = m_window.i0 + i, cj = m_window.j0 + j;
      const float runs = runs_down(sight.state.pool, sight.floor, ci, cj) * depth_at(m, sight.state.pool, ci, cj);
      if ((m_known[k] <= 0 && !(runs > 0)) || m_depth[k] > kShallow) continue;  // far off, or below the pool
      const FilmPlace place = block_of(sight.floor, ci, cj);
      int wet_i = ci, wet_j = cj;
      float thickness = std::min(0.3f * runs, kThickestRun) * rivulets(place, down);
      if (!(thickness > 2e-6f)) thickness = tide_mark(i, j, place, wet_i, wet_j);
      if (!(thickness > 1.5e-6f)) continue;
      Splat s = stain(place, thickness * place.area, float(varied(ci + 977 * cj, 5)), down);
      const Vec3f middle = 0.5f * (s.from + s.to), half = 0.2f * (s.to - s.from);  // blocks overlap enough
      const Vec3f shift = float(m.cell) * Vec3f{own(std::uint32_t(ci), cj), own(std::uint32_t(cj), ci + 7), 0.0f};
      const Vec3f aside = 0.7f * (shift - dot(shift, s.normal) * s.normal);
      s.from = middle - half + aside, s.to = middle + half + aside;
      s.radius = 1.25f * float(m.cell);
      s.height = thickness;
      s.share = shares_of(mix_at(m, sight.state.pool, wet_i, wet_j));
      s.dark = darkness(now, sight.state.pool.shed, s.share);
      liquid.splats.push_back(s);
    }
}

/// How thick the stain beside the pool is on a block of cells that is not wet [m], and which wet cell is nearest.
float FluidDrawing::tide_mark(int i, int j, const FilmPlace& place, int& wet_i, int& wet_j) const {
  const int reach = std::max(1, int(std::lround(double(kTide) / m_model->pool.cell)));
  const float tide = near_pool(i, j, reach, wet_i, wet_j);
  const float uneven = 0.5f + 0.6f * float(waves(vec_cast<double>(place.position), 0.008));
  return kThickestStain * tide * smooth_step(uneven + 0.8f * tide - 0.45f);
}

/// How near the pool is to a dry cell of the window, 1 beside it, 0 at `reach` cells; and which cell of it.
float FluidDrawing::near_pool(int i, int j, int reach, int& wet_i, int& wet_j) const {
  const int w = m_window.width, h = m_window.height;
  float nearest = float(reach) + 0.5f;
  for (int b = std::max(j - reach, 0); b <= std::min(j + reach, h - 1); ++b)
    for (int a = std::max(i - reach, 0); a <= std::min(i + reach, w - 1); ++a) {
      const float far = std::hypot(float(a - i), float(b - j));
      if (m_depth[std::size_t(b) * w + a] < 0.0008f || far >= nearest) continue;
      nearest = far;
      wet_i = m_window.i0 + a, wet_j = m_window.j0 + b;
    }
  return std::max(0.0f, 1 - nearest / (float(reach) + 0.5f));
}

/// Depth, cover and level of the cells that are wet and of those around them, smoothed; the level goes on beyond the
/// border as if the pool did, so that the border lies where the surface meets what is drawn.
void FluidDrawing::smooth_pool(const fluids::PoolState& pool, std::span<const float> floor) {
  const fluids::PoolModel& m = m_model->pool;
  int i0 = m.nx, i1 = -1, j0 = m.ny, j1 = -1;
  for (int j = 0; j < m.ny; ++j)
    for (int i = 0; i < m.nx; ++i)
      if (depth_at(m, pool, i, j) > 0.3f * kWetDepth) {
        i0 = std::min(i0, i), i1 = std::max(i1, i);
        j0 = std::min(j0, j), j1 = std::max(j1, j);
      }
  if (i1 < 0) {
    m_window = {};
    return;
  }
  i0 = std::max(i0 - kMargin, 0), j0 = std::max(j0 - kMargin, 0);
  i1 = std::min(i1 + kMargin, m.nx - 1), j1 = std::min(j1 + kMargin, m.ny - 1);
  m_window = {i0, j0, i1 - i0 + 1, j1 - j0 + 1};
  const int w = m_window.width, h = m_window.height;
  for (std::vector<float>* field : {&m_depth, &m_cover, &m_level, &m_known}) field->assign(m_window.size(), 0);
  for (int j = 0; j < h; ++j)
    for (int i = 0; i < w; ++i) {
      const auto k = std::size_t(j) * w + i;
      m_depth[k] = depth_at(m, pool, i0 + i, j0 + j) * (1 - runs_down(pool, floor, i0 + i, j0 + j));
      m_cover[k] = std::min(m_depth[k] / kWetDepth, 1.0f);
      m_known[k] = m_cover[k] >= 1 ? 1.0f : 0.0f;
      m_level[k] = (floor_at(m, floor, i0 + i, j0 + j) + m_depth[k]) * m_known[k];
    }
  for (int ring = 0; ring < kMargin + 1; ++ring) {
    std::vector<float>& next = m_scratch;
    next.assign(m_known.begin(), m_known.end());
    for (int j = 0; j < h; ++j)
      for (int i = 0; i < w; ++i) {
        const auto k = std::size_t(j) * w + i;
        if (m_known[k] > 0) continue;
        float sum = 0, weight = 0;
        for (int b = std::max(j - 1, 0); b <= std::min(j + 1, h - 1); ++b)
          for (int a = std::max(i - 1, 0); a <= std::min(i + 1, w - 1); ++a) {
            const auto q = std::size_t(b) * w + a;
            if (m_known[q] > 0) sum += m_level[q], weight += 1;
          }
        if (weight > 0) m_level[k] = sum / weight, next[k] = 1;
      }
    m_known.swap(next);
  }
  // Under what overhangs the pool goes on; what stands before it hides that.
  for (std::size_t k = 0; k < m_window.size(); ++k)
    if (m_known[k] > 0 && floor_at(m, floor, i0 + int(k) % w, j0 + int(k) / w) > m_level[k] + kOverhang)
      m_cover[k] = 1, m_depth[k] = std::max(m_depth[k], kShallow);
  for (std::size_t k = 0; k < m_window.size(); ++k)
    if (m_known[k] <= 0) m_level[k] = floor_at(m, floor, i0 + int(k) % w, j0 + int(k) / w);
  smooth_once(m_cover, m_scratch, w, h);
  smooth_once(m_cover, m_scratch, w, h);
  smooth_once(m_depth, m_scratch, w, h);
  smooth_once(m_level, m_scratch, w, h);
}

void FluidDrawing::list_pool(const FluidSight& sight, Liquid& liquid) {
  const fluids::PoolModel& m = m_model->pool;
  const fluids::PoolState& pool = sight.state.pool;
  smooth_pool(pool, sight.floor);
  const int w = m_window.width, h = m_window.height;
  if (w < 2 || h < 2) return;
  const float now = now_of(m_model->droplets, sight.state.droplets);
  constexpr std::uint32_t kNone = ~0u;
  m_corner.assign(m_window.size(), kNone);
  const auto cell = [&](int i, int j) { return std::size_t(j) * w + i; };
  const auto corner = [&](int i, int j) {
    std::uint32_t& at_corner = m_corner[cell(i, j)];
    if (at_corner != kNone) return at_corner;
    at_corner = std::uint32_t(liquid.sheet.size());
    const int west = std::max(i - 1, 0), east = std::min(i + 1, w - 1);
    const int south = std::max(j - 1, 0), north = std::min(j + 1, h - 1);
    const double du = double(m_level[cell(east, j)] - m_level[cell(west, j)]) / (m.cell * (east - west));
    const double dv = double(m_level[cell(i, north)] - m_level[cell(i, south)]) / (m.cell * (north - south));
    const int ci = m_window.i0 + i, cj = m_window.j0 + j;
    fluids::Mix mix;
    for (int b = std::max(cj - 1, 0); b <= std::min(cj + 1, m.ny - 1); ++b)
      for (int a = std::max(ci - 1, 0); a <= std::min(ci + 1, m.nx - 1); ++a) mix += mix_at(m, pool, a, b);
    const std::array<float, 3> share = shares_of(mix);
    const auto k = cell(i, j);
    render::SheetVertex v;
    v.position = vec_cast<float>(world(m, (ci + 0.5) * m.cell, (cj + 0.5) * m.cell, double(m_level[k])));
    v.normal = vec_cast<float>(normalised(m.up - du * m.u - dv * m.v, m.up));
    v.depth = m_depth[k];
    v.cover = m_cover[k];
    v.share_b = share[1];
    v.share_c = share[2];
    v.dark = darkness(now, pool.shed, share);
    // Where it is stirred it froths.
    const auto face = std::size_t(m.at(ci, cj));
    const float u = pool.u[face], s = pool.v[face];
    v.froth = float(smooth(0.05, 0.15, double(std::sqrt(u * u + s * s)))) * (1 - 0.6f * share[0]);
    liquid.sheet.push_back(v);
    return at_corner;
  };
  for (int j = 0; j + 1 < h; ++j)
    for (int i = 0; i + 1 < w; ++i) {
      const float most = std::max(std::max(m_cover[cell(i, j)], m_cover[cell(i + 1, j)]),
                                  std::max(m_cover[cell(i, j + 1)], m_cover[cell(i + 1, j + 1)]));
      if (most < 0.32f) continue;
      const std::uint32_t a = corner(i, j), b = corner(i + 1, j), c = corner(i + 1, j + 1), d = corner(i, j + 1);
      liquid.triangles.insert(liquid.triangles.end(), {a, b, c, a, c, d});
    }
}

}  // namespace trocar::view
