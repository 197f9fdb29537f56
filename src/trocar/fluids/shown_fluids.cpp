#include <algorithm>
#include <cmath>
#include <cstring>

#include <trocar/fluids/shown_fluids.hpp>

namespace trocar::fluids {
namespace {

constexpr std::int64_t kUnit = 1000;       // [pL] a nanolitre: less than a micrometre on a cell
constexpr double kStep = 5e-5;             // [m] of a drop's place
constexpr float kSpeed = 0.02f;            // [m/s] of a drop's speed, at most 127 of them
constexpr double kFarthestShown = 10;      // [m] from the pool's corner
constexpr std::uint64_t kHighest = 1000;   // steps of a drop above its surface
constexpr std::size_t kLongestRun = 256;   // of smoke
constexpr std::int64_t kMost = 1'000'000;  // units in a cell, a drop, a place: below 2^30 pL
constexpr float kShades = 8, kLeastWeight = 0.99f, kMostWeight = 1.01f;

/// Whole numbers in as few bytes as each takes, seven bits a byte.
class Writer {
 public:
  explicit Writer(std::vector<std::uint8_t>& out) : m_out(out) {}
  void number(std::uint64_t bits) {
    for (; bits >= 128; bits >>= 7) m_out.push_back(std::uint8_t(bits | 128u));
    m_out.push_back(std::uint8_t(bits));
  }
  void either_sign(std::int64_t q) { number(std::uint64_t(q < 0 ? -2 * q - 1 : 2 * q)); }
  void byte(int value) { m_out.push_back(std::uint8_t(value)); }
  template <class T>
  void raw(const T& value) {
    const auto* bytes = reinterpret_cast<const std::uint8_t*>(&value);
    m_out.insert(m_out.end(), bytes, bytes + sizeof value);
  }

 private:
  std::vector<std::uint8_t>& m_out;
};

/// The same way back; remembers whether all was there and within bounds.
class Reader {
 public:
  explicit Reader(std::span<const std::uint8_t> bytes) : m_bytes(bytes) {}
  std::uint64_t number(std::uint64_t most) {
    std::uint64_t bits = 0;
    for (int shift = 0; shift < 63; shift += 7) {
      const auto b = std::uint64_t(byte());
      bits |= (b & 127u) << shift;
      if (b < 128) {
        good = good && bits <= most;
        return good ? bits : 0;
      }
    }
    good = false;
    return 0;
  }
  std::int64_t either_sign(std::uint64_t most) {
    const std::uint64_t bits = number(2 * most + 1);
    const auto half = std::int64_t(bits >> 1);
    return bits & 1u ? -half - 1 : half;
  }
  int byte() {
    good = good && m_at < m_bytes.size();
    return good ? m_bytes[m_at++] : 0;
  }
  template <class T>
  T raw() {
    T value{};
    good = good && m_bytes.size() - m_at >= sizeof value;
    if (!good) return value;
    std::memcpy(&value, m_bytes.data() + m_at, sizeof value);
    m_at += sizeof value;
    return value;
  }
  std::ptrdiff_t read() const { return good ? std::ptrdiff_t(m_at) : -1; }

  bool good = true;

 private:
  std::span<const std::uint8_t> m_bytes;
  std::size_t m_at = 0;
};

struct Units {
  std::int64_t blood = 0, saline = 0, bile = 0;
  bool any() const { return blood + saline + bile > 0; }
};
std::int64_t units(std::int64_t picolitres) {
  return std::clamp<std::int64_t>((picolitres + kUnit / 2) / kUnit, 0, kMost / 3);
}
template <class Volume>
Units units_of(const Volume& v) {
  return {units(v.blood), units(v.saline), units(v.bile)};
}
void put_units(const Units& u, Writer& out) { out.number(u.blood), out.number(u.saline), out.number(u.bile); }
SmallMix take_units(Reader& in) {
  const auto next = [&in] { return std::int32_t(in.number(kMost / 3) * kUnit); };
  SmallMix mix;
  mix.blood = next();
  mix.saline = next();
  mix.bile = next();
  return mix;
}

/// How many places hold something, then each: how far on from the one before, and how much.
template <class Get>
void put_places(std::size_t size, Get&& get, Writer& out) {
  std::vector<std::size_t> places;  // nearly all of them are empty
  for (std::size_t i = 0; i < size; ++i)
    if (get(i).total() > 0 && units_of(get(i)).any()) places.push_back(i);
  out.number(places.size());
  std::size_t last = 0;
  for (const std::size_t i : places) {
    out.number(i - last);
    put_units(units_of(get(i)), out);
    last = i;
  }
}
template <class Set>
void take_places(std::size_t size, Set&& set, Reader& in) {
  const std::uint64_t count = in.number(size);
  std::uint64_t at = 0;
  for (std::uint64_t k = 0; in.good && k < count; ++k) {
    const std::uint64_t on = in.number(size);
    at += on;
    in.good = in.good && at < size && (k == 0 || on > 0);
    const SmallMix mix = take_units(in);
    in.good = in.good && mix.total() > 0;
    if (in.good) set(std::size_t(at), mix);
  }
}

int speed_byte(float v) {
  return 128 + (std::fabs(v) < 1e3f ? int(std::floor(std::clamp(v / kSpeed, -127.0f, 127.0f) + 0.5f)) : 0);
}
float speed_of(int byte) { return kSpeed * float(std::clamp(byte - 128, -127, 127)); }

/// A drop on a surface: which, how that faces, how far above it the drop is, and its speed along it.
void put_ground(const DropletState& d, std::size_t k, Writer& out) {
  const Ground& g = d.ground[k];
  const Vec3f x{d.x[k], d.y[k], d.z[k]};
  out.raw(g.normal);
  const double above = double(dot(g.normal, x) - g.offset) / kStep;
  out.either_sign(std::fabs(above) < double(kHighest) ? std::int64_t(std::floor(above + 0.5)) : 0);
}
void put_drops(const Vec3d corner, const DropletState& d, Writer& out) {
  const auto shown = [&d](std::size_t k) {
    return units_of(d.volume[k]).any() && std::fabs(d.x[k]) < kFarthestShown && std::fabs(d.y[k]) < kFarthestShown &&
           std::fabs(d.z[k]) < kFarthestShown;
  };
  std::size_t count = 0;
  for (std::size_t k = 0; k < std::size_t(d.count); ++k) count += shown(k);
  out.number(count);
  for (std::size_t k = 0; k < std::size_t(d.count); ++k) {
    if (!shown(k)) continue;
    const Vec3d x = Vec3d{double(d.x[k]), double(d.y[k]), double(d.z[k])} - corner;
    for (int c = 0; c < 3; ++c) out.either_sign(std::int64_t(std::floor(x[c] / kStep + 0.5)));
    const bool lies = d.body[k] >= 0;
    const Vec3f ground = lies ? d.ground[k].velocity : Vec3f{0, 0, 0};
    for (const float v : {d.vx[k] - ground.x, d.vy[k] - ground.y, d.vz[k] - ground.z}) out.byte(speed_byte(v));
    put_units(units_of(d.volume[k]), out);
    out.number(d.id[k]);
    out.number(std::uint64_t(lies ? d.body[k] + 1 : 0));
    if (lies) put_ground(d, k, out);
  }
}
void take_ground(Reader& in, DropletState& d, std::size_t k) {
  Ground& g = d.ground[k];
  g = {};
  g.normal = in.raw<Vec3f>();
  const float weight = dot(g.normal, g.normal);
  in.good = in.good && weight > kLeastWeight && weight < kMostWeight;
  g.offset = dot(g.normal, Vec3f{d.x[k], d.y[k], d.z[k]}) - float(kStep * double(in.either_sign(kHighest)));
}
void take_drops(const Vec3d corner, Reader& in, DropletState& d) {
  d.count = 0;
  const std::uint64_t count = in.number(d.x.size());
  for (std::size_t k = 0; in.good && k < count; ++k) {
    double x[3];
    for (int c = 0; c < 3; ++c)
      x[c] = corner[c] + kStep * double(in.either_sign(std::uint64_t(4 * kFarthestShown / kStep)));
    d.x[k] = float(x[0]), d.y[k] = float(x[1]), d.z[k] = float(x[2]);
    d.vx[k] = speed_of(in.byte()), d.vy[k] = speed_of(in.byte()), d.vz[k] = speed_of(in.byte());
    d.volume[k] = take_units(in);
    in.good = in.good && d.volume[k].total() > 0;
    d.radius[k] = radius_of(d.volume[k].total());
    d.id[k] = std::uint32_t(in.number(~std::uint32_t(0)));
    d.body[k] = std::int32_t(in.number(1u << 30)) - 1;
    if (d.body[k] >= 0) take_ground(in, d, k);
    d.count = std::int32_t(k) + 1;
  }
}

/// The square root, so that thin smoke has shades, too; runs of equal cells once.
int shade_of(float density) {
  return density > 0 ? int(std::floor(std::min(kShades * std::sqrt(density), 255.0f) + 0.5f)) : 0;
}
void put_smoke(const std::vector<float>& density, Writer& out) {
  for (std::size_t c = 0; c < density.size();) {
    const int shade = shade_of(density[c]);
    std::size_t run = 1;
    while (run < kLongestRun && c + run < density.size() && shade_of(density[c + run]) == shade) ++run;
    out.byte(shade);
    out.byte(int(run - 1));
    c += run;
  }
}
void take_smoke(Reader& in, std::vector<float>& density) {
  for (std::size_t c = 0; in.good && c < density.size();) {
    const float root = float(in.byte()) / kShades;
    const std::size_t run = std::size_t(in.byte()) + 1;
    in.good = in.good && run <= density.size() - c;
    if (in.good) std::fill_n(density.begin() + std::ptrdiff_t(c), run, root * root);
    c += run;
  }
}

}  // namespace

void put_shown(const FluidsModel& m, const FluidsState& s, std::vector<std::uint8_t>& bytes) {
  Writer out(bytes);
  out.raw(s.smoke.fog);
  out.raw(s.smoke.wipe_left);
  put_smoke(s.smoke.density, out);
  put_places(
      s.droplets.film.size(), [&s](std::size_t i) { return s.droplets.film[i]; }, out);
  const auto cell = [&s](std::size_t i) { return SmallMix{s.pool.blood[i], s.pool.saline[i], s.pool.bile[i]}; };
  put_places(s.pool.blood.size(), cell, out);
  put_drops(m.pool.origin, s.droplets, out);
}

std::ptrdiff_t take_shown(const FluidsModel& m, std::span<const std::uint8_t> bytes, FluidsState& s) {
  show_none(s);
  Reader in(bytes);
  s.smoke.fog = in.raw<double>();
  s.smoke.wipe_left = in.raw<double>();
  in.good = in.good && s.smoke.fog >= 0 && s.smoke.fog <= 1 && std::fabs(s.smoke.wipe_left) < 1e3;
  take_smoke(in, s.smoke.density);
  take_places(
      s.droplets.film.size(), [&s](std::size_t i, const SmallMix& mix) { s.droplets.film[i] = mix; }, in);
  const auto fill = [&s](std::size_t i, const SmallMix& mix) {
    s.pool.blood[i] = mix.blood, s.pool.saline[i] = mix.saline, s.pool.bile[i] = mix.bile;
  };
  take_places(s.pool.blood.size(), fill, in);
  take_drops(m.pool.origin, in, s.droplets);
  const Blood fresh{now_of(m.droplets, s.droplets), 0};  // keyframes do not know what blood is: all of it is new
  std::fill(s.droplets.film_blood.begin(), s.droplets.film_blood.end(), fresh);
  std::fill(s.droplets.blood.begin(), s.droplets.blood.end(), fresh);
  s.pool.shed = fresh;
  return in.read();
}

void show_none(FluidsState& s) {
  s.smoke.fog = s.smoke.wipe_left = 0;
  std::fill(s.smoke.density.begin(), s.smoke.density.end(), 0.0f);
  std::fill(s.droplets.film.begin(), s.droplets.film.end(), SmallMix{});
  s.droplets.count = 0;
  for (std::vector<std::int32_t>* kind : {&s.pool.blood, &s.pool.saline, &s.pool.bile})
    std::fill(kind->begin(), kind->end(), 0);
  for (std::vector<float>* speed : {&s.pool.u, &s.pool.v}) std::fill(speed->begin(), speed->end(), 0.0f);
}

}  // namespace trocar::fluids
