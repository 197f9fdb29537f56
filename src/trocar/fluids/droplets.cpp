// Drops: birth, flight, what the caller is asked.
#include <algorithm>
#include <cmath>
#include <cstring>

#include <trocar/core/field_hash.hpp>
#include <trocar/core/require.hpp>
#include <trocar/fluids/droplets.hpp>
#include <trocar/numerics/portable.hpp>

namespace trocar::fluids {
namespace {

using core::require;

constexpr float kFastest = 20;       ///< no drop is born faster [m/s]
constexpr float kFarthestDrop = 10;  ///< nor lives beyond [m]
constexpr int kMostBirths = 64;      ///< of an opening in a tick

bool power_of_two(int n) { return n > 0 && (n & (n - 1)) == 0; }
Blood fresh(const DropletModel& m, const DropletState& s, const Outlet& o) {
  return {now_of(m, s), o.venous > 0 ? std::min(o.venous, 1.0f) : 0.0f};  // NaN counts as none
}

/// Cube root of a float in the normal range: exponent by a third, then Newton's steps.
float cube_root(float a) {
  if (!(a > 1e-30f)) return 0;
  std::uint32_t bits;
  std::memcpy(&bits, &a, sizeof bits);
  bits = bits / 3 + 709921077u;  // the exponent's bias times 2/3, shifted
  float r;
  std::memcpy(&r, &bits, sizeof r);
  for (int i = 0; i < 4; ++i) r = (2 * r + a / (r * r)) / 3;
  return r;
}

// ---- birth

/// Volume into which a jet from an opening breaks: a ball of 1.89 jet diameters [Rayleigh 1878].
std::int64_t drop_volume(const DropletModel& m, double area) {
  const double jet = 2 * std::sqrt(area / portable::pi), d = 1.89 * jet;
  const double pl = portable::pi / 6 * d * d * d * kPicolitresPerM3;
  return std::int64_t(std::clamp(pl, double(m.smallest), double(m.largest)));
}

Mix bounded_flow(const Mix& flow, FluidReport& report, std::int32_t index) {
  Mix in;
  for (std::int64_t Mix::*species : {&Mix::blood, &Mix::saline, &Mix::bile})
    in.*species = std::clamp<std::int64_t>(flow.*species, 0, kMostAtOnce / 4);
  if (!(in == flow)) report.note(FluidReport::kFlowBounded, index);
  return in;
}

/// Drops of one opening in one tick, along the way that the jet covers in it; speed v = Q / A.
void break_up(const DropletModel& m, const Outlet& o, const Mix& in, std::int32_t index, DropletState& s, Below& below,
              FluidReport& report) {
  Mix& forming = s.forming[std::size_t(index)];
  receive(below.ledger, o.source, Place::kDroplets, in);
  forming += in;
  const double area = o.area > 1e-10 && o.area < 1 ? o.area : 1e-10;
  const std::int64_t each =
      std::clamp(forming.total() / kMostBirths + 1, drop_volume(m, area), std::int64_t(m.largest));
  const auto births = int(std::min<std::int64_t>(forming.total() / each, kMostBirths));
  const float speed = std::min(float(kM3PerPicolitre * double(in.total()) / (m.tick * area)), kFastest);
  const Vec3f velocity = o.velocity + speed * o.direction;
  for (int n = 0; n < births; ++n) {
    const Mix drop = share(forming, each);
    const float ago = float(m.tick) * (float(n) + 0.5f) / float(births);
    if (!add_drop(m, o.position + (speed * ago) * o.direction, velocity, drop, s)) {
      report.note(FluidReport::kDropletsFull, index);
      break;
    }
    s.blood[s.count - 1] = fresh(m, s, o);
    forming -= drop;
  }
  if (forming.total() < each) return;
  report.note(FluidReport::kFlowBounded, index);
  detail::put_into_pool(o.position, forming, fresh(m, s, o), Place::kDroplets, below);
  forming = {};
}

void ooze(const DropletModel& m, const Outlet& o, const Mix& in, DropletState& s, Below& below) {
  receive(below.ledger, o.source, Place::kFilm, in);
  SmallMix& place = s.film[std::size_t(o.film)];
  const Mix fits = share(in, std::int64_t(kMostInACell) - place.total());
  Blood& blood = s.film_blood[std::size_t(o.film)];
  blood = mean(blood, place.blood, fresh(m, s, o), fits.blood);
  place.blood += std::int32_t(fits.blood), place.saline += std::int32_t(fits.saline);
  place.bile += std::int32_t(fits.bile);
  if (!(fits == in)) detail::put_into_pool(o.position, in - fits, fresh(m, s, o), Place::kFilm, below);
}

void open_up(const DropletModel& m, std::span<const Outlet> openings, DropletState& s, Below& below,
             FluidReport& report) {
  for (std::int32_t i = 0; i < std::int32_t(openings.size()); ++i) {
    const Outlet& o = openings[std::size_t(i)];
    const Mix in = bounded_flow(o.flow, report, i);
    if (in.empty()) continue;
    const bool placed = finite(o.position) && finite(o.direction) && finite(o.velocity) &&
                        std::fabs(dot(o.direction, o.direction) - 1) < 0.01f && i < kMostOpenings;
    if (!placed || o.film >= std::int32_t(s.film.size())) {
      report.note(FluidReport::kBadOpening, i);
      receive(below.ledger, o.source, Place::kDroplets, in);
      detail::put_into_pool(o.position, in, fresh(m, s, o), Place::kDroplets, below);
    } else if (o.film >= 0) {
      ooze(m, o, in, s, below);
    } else {
      break_up(m, o, in, i, s, below, report);
    }
  }
}

// ---- flight

struct Flight {
  float gx, gy, gz, dt;          ///< gravity times dt [m/s], dt [s]
  float drag, reynolds, stokes;  ///< see drag_rate()
};

Flight flight_of(const DropletModel& m) {
  const double dt = m.tick;
  Flight f{float(dt * m.gravity.x), float(dt * m.gravity.y), float(dt * m.gravity.z), float(dt), 0, 0, 0};
  if (m.gas_density > 0) {
    f.drag = float(0.375 * m.gas_density / m.density.blood);
    f.reynolds = float(2 * m.gas_density / m.gas_viscosity);
    f.stokes = float(24 / (2 * m.gas_density / m.gas_viscosity));
  }
  return f;
}

/// Some drops side by side.
constexpr int kBatch = 64;
struct Batch {
  float falls[kBatch], radius[kBatch];  ///< falls: 1 in flight, otherwise 0
  float x[kBatch], y[kBatch], z[kBatch], vx[kBatch], vy[kBatch], vz[kBatch];
};

/// Drops in flight fall and are slowed; where they get to replaces where they are. Drag rate: 3/8 rho_gas/rho Cd |v| /
/// r.
void fly(const Flight& f, Batch& b) {
  for (int i = 0; i < kBatch; ++i) {
    const float falls = b.falls[i];
    const float ax = b.vx[i] + falls * f.gx, ay = b.vy[i] + falls * f.gy, az = b.vz[i] + falls * f.gz;
    const float speed = std::sqrt((ax * ax + ay * ay) + az * az), r = b.radius[i];
    const float re = f.reynolds * speed * r;
    const float cd_speed = f.stokes / r + speed * (6 / (1 + std::sqrt(re)) + 0.4f);  // Cd |v|
    const float rate = f.drag * cd_speed / r;
    const float slowed = 1 / (1 + f.dt * rate), keep = falls > 0 ? slowed : 1.0f;
    const float nx = ax * keep, ny = ay * keep, nz = az * keep;
    b.vx[i] = nx, b.vy[i] = ny, b.vz[i] = nz;
    b.x[i] = b.x[i] + f.dt * nx, b.y[i] = b.y[i] + f.dt * ny, b.z[i] = b.z[i] + f.dt * nz;
  }
}

/// All that move in this tick. Where they get to is kept apart.
void fly(const Flight& f, DropletState& s, DropletWork& w) {
  Batch b{};
  for (float& r : b.radius) r = 1e-3f;
  for (int first = 0; first < w.mover_count; first += kBatch) {
    const std::int32_t* who = w.movers.data() + first;
    const int n = std::min(w.mover_count - first, kBatch);
    for (int k = 0; k < n; ++k) {
      const std::int32_t i = who[k];
      b.falls[k] = s.body[i] < 0 ? 1.0f : 0.0f, b.radius[k] = s.radius[i];
      b.x[k] = s.x[i], b.y[k] = s.y[i], b.z[k] = s.z[i];
      b.vx[k] = s.vx[i], b.vy[k] = s.vy[i], b.vz[k] = s.vz[i];
    }
    fly(f, b);
    for (int k = 0; k < n; ++k) {
      const std::int32_t i = who[k];
      s.vx[i] = b.vx[k], s.vy[i] = b.vy[k], s.vz[i] = b.vz[k];
      w.to_x[i] = b.x[k], w.to_y[i] = b.y[k], w.to_z[i] = b.z[k];
    }
  }
}

float size(float a) { return std::fabs(a); }

/// Drops that are nowhere, not finite or too far away, go into the pool.
void catch_lost(DropletState& s, DropletWork& w, Below& below, FluidReport& report) {
  for (int k = 0; k < w.mover_count; ++k) {
    const std::int32_t i = w.movers[k];
    const float far = (size(w.to_x[i]) + size(w.to_y[i])) + size(w.to_z[i]);
    if (far < kFarthestDrop) continue;
    report.note(FluidReport::kBadDroplet, i);
    detail::put_into_pool({s.x[i], s.y[i], s.z[i]}, widened(s.volume[i]), s.blood[i], Place::kDroplets, below);
    s.volume[i] = {};
    s.body[i] = -1;
    w.emptied = true;
  }
}

/// Drops in flight move in every tick, those on surfaces in some.
void choose_movers(const DropletModel& m, const DropletState& s, DropletWork& w) {
  const std::uint32_t running = std::uint32_t(m.run_period) - 1, now = std::uint32_t(s.tick);
  const std::int32_t* body = s.body.data();
  const std::uint32_t* id = s.id.data();
  std::int32_t* movers = w.movers.data();
  int n = 0;
  for (int i = 0; i < s.count; ++i) {
    movers[n] = i;
    n += int(body[i] < 0) | int(((id[i] + now) & running) == 0);
  }
  w.mover_count = n;
}

/// In question_of: moves in this tick all the same, on the plane that it has.
constexpr std::int32_t kRunsUnasked = -2;

/// [m/s] What is slower, on ground that is slower, goes by no more than a millimetre or two until it is asked for.  Our
/// choice
constexpr float kSlow = 0.02f;

/// [m/s] Nothing that was quick four ticks ago is slower than this by drag and gravity: it is asked for again.
constexpr float kWasQuick = 1.0f;

/// In a crowd a drop on a surface is asked for in every second of its turns, a slow one in every fourth. In bits of the
/// tick and the drop's name that are zero when it is.
std::uint32_t skipped_turns(const DropletModel& m, const DropletState& s, std::int32_t i) {
  if (m.fly_period == 1) return 0;
  const Vec3f ground = s.ground[i].velocity, along = Vec3f{s.vx[i], s.vy[i], s.vz[i]} - ground;
  const bool slow = dot(ground, ground) < kSlow * kSlow && dot(along, along) < kSlow * kSlow;
  return std::uint32_t(m.run_period) * (slow ? 3u : 1u);
}

/// @param newborn  the first name of this tick's drops: they are asked for at once, as they come from within tissue
void ask(const DropletModel& m, std::uint32_t newborn, const DropletState& s, DropletWork& w) {
  w.questions = 0;
  w.ways = m.fly_period;
  for (int k = 0; k < w.mover_count; ++k) {
    const std::int32_t i = w.movers[k];
    const std::uint32_t turn = s.id[i] + std::uint32_t(s.tick);
    const bool flies = s.body[i] < 0;
    const std::uint32_t unasked =
        flies ? std::uint32_t(ways_of(w, {s.vx[i], s.vy[i], s.vz[i]}, kWasQuick)) - 1 : skipped_turns(m, s, i);
    const bool asks = int((turn & unasked) == 0) | (int(flies) & int(s.id[i] >= newborn));
    w.question_of[k] = asks ? w.questions : flies ? -1 : kRunsUnasked;
    w.asking[w.questions] = i;
    w.questions += int(asks);
  }
}

/// Places of film that hold more than they can: a sixteenth of all is looked at in a tick.
void ask_for_film(const DropletModel& m, const DropletState& s, DropletWork& w) {
  w.film_questions = 0;
  const std::size_t n = s.film.size(), part = n / 16 + 1, first = part * (s.tick % 16);
  for (std::size_t c = first; c < std::min(first + part, n) && w.film_questions < kFilmQuestions; ++c) {
    if (s.film[c].total() < m.film_capacity + m.smallest) continue;
    w.film_answers[w.film_questions].body = -1;
    w.overfull[w.film_questions++] = std::int32_t(c);
  }
}

}  // namespace

void set_crowd_level_of_detail(DropletDescription& d) noexcept {
  d.run_period = 16;
  d.fly_period = 8;
  d.pair_parts = 8;
}

DropletModel build(const DropletDescription& d, double tick) {
  require(d.capacity >= 1 && d.capacity <= 65536, "droplets: 1 to 65536");
  require(d.film_cells >= 0 && d.film_cells <= 4'000'000, "droplets: up to 4 million places of film");
  require(d.film_capacity >= 0 && d.film_capacity <= kMostInACell / 2, "droplets: film capacity");
  require(length(d.gravity) < 100, "droplets: gravity");
  require(d.smallest >= 100 && d.largest > d.smallest && d.largest <= 200'000'000, "droplets: smallest and largest");
  require(d.largest_running >= d.largest && d.largest_running <= 400'000'000, "droplets: largest on a surface");
  require(d.viscosity > 0 && d.surface_tension >= 0 && d.gas_density >= 0 && d.gas_viscosity > 0,
          "droplets: viscosity, surface tension, gas");
  require(d.density.blood > 0 && d.density.saline > 0 && d.density.bile > 0, "droplets: densities");
  require(d.film_thickness >= 0 && d.hysteresis >= 0 && d.running_height > 0 && d.overhang >= 0 && d.splash > 0,
          "droplets: film, hysteresis, running height, overhang, splash");
  const auto period = [](int n) { return power_of_two(n) && n >= 2 && n <= 16; };
  require(period(d.pair_period) && period(d.run_period), "droplets: periods are 2, 4, 8 or 16");
  require(d.pair_parts == 2 || d.pair_parts == 8, "droplets: parts of pairs are 2 or 8");
  require(power_of_two(d.fly_period) && d.fly_period <= 8, "droplets: the period in flight is 1, 2, 4 or 8");
  require(tick > 0 && tick <= 0.01, "droplets: tick");
  DropletModel m;
  static_cast<DropletDescription&>(m) = d;
  m.tick = tick;
  return m;
}

DropletState no_droplets(const DropletModel& m) {
  DropletState s;
  const auto n = std::size_t(m.capacity);
  for (auto* a : {&s.x, &s.y, &s.z, &s.vx, &s.vy, &s.vz}) a->assign(n, 0.0f);
  s.radius.assign(n, 1e-3f);
  s.body.assign(n, -1);
  s.ground.assign(n, Ground{});
  s.volume.assign(n, SmallMix{});
  s.id.assign(n, 0);
  s.blood.assign(n, Blood{});
  s.film.assign(std::size_t(m.film_cells), SmallMix{});
  s.film_blood.assign(std::size_t(m.film_cells), Blood{});
  return s;
}

float radius_of(std::int64_t picolitres) noexcept {
  return cube_root(float(kM3PerPicolitre * 3 / (4 * portable::pi) * double(picolitres)));
}

bool add_drop(const DropletModel& m, Vec3f p, Vec3f v, const Mix& volume, DropletState& s) noexcept {
  const std::int64_t total = volume.total();
  if (s.count >= m.capacity || total <= 0 || total > m.largest) return false;
  const int i = s.count++;
  s.x[i] = p.x, s.y[i] = p.y, s.z[i] = p.z;
  s.vx[i] = v.x, s.vy[i] = v.y, s.vz[i] = v.z;
  s.radius[i] = radius_of(total);
  s.body[i] = -1;
  s.ground[i] = Ground{};
  s.volume[i] = {std::int32_t(volume.blood), std::int32_t(volume.saline), std::int32_t(volume.bile)};
  s.blood[i] = {now_of(m, s), 0};
  s.id[i] = s.next_id++;
  return true;
}

FluidReport plan(const DropletModel& m, std::span<const Outlet> openings, DropletState& s, DropletWork& w,
                 Below& below) noexcept {
  FluidReport report;
  const std::uint32_t newborn = s.next_id;
  open_up(m, openings, s, below, report);
  const auto period = std::uint64_t(m.pair_period);
  if (s.tick % period == 1) report = report | detail::pull_together(m, {}, m.tick * m.pair_period, s, w);
  const std::uint64_t every = m.pair_parts == 2 ? 2 * period : period;  // the more parts, the smaller
  if (s.tick % every == period / 2 + 1) {
    const auto parts = std::uint32_t(m.pair_parts);
    const detail::Who some{false, std::uint32_t(s.tick / every % parts), parts};
    report = report | detail::pull_together(m, some, double(every) * m.pair_parts * m.tick, s, w);
  }
  w.emptied = false;
  choose_movers(m, s, w);
  fly(flight_of(m), s, w);
  catch_lost(s, w, below, report);
  ask(m, newborn, s, w);
  ask_for_film(m, s, w);
  return report;
}

Mix drops_content(const DropletState& s) noexcept {
  Mix sum;
  for (int i = 0; i < s.count; ++i) sum += widened(s.volume[i]);
  for (const Mix& f : s.forming) sum += f;
  return sum;
}
Mix film_content(const DropletState& s) noexcept {
  Mix sum;
  for (const SmallMix& f : s.film) sum += widened(f);
  return sum;
}

Mix take_film(std::int32_t film, std::int64_t amount, DropletState& s) noexcept {
  if (film < 0 || film >= std::int32_t(s.film.size())) return {};
  SmallMix& place = s.film[std::size_t(film)];
  const Mix out = share(widened(place), amount);
  place.blood -= std::int32_t(out.blood), place.saline -= std::int32_t(out.saline);
  place.bile -= std::int32_t(out.bile);
  return out;
}

namespace detail {

void mix_into_pool(std::int64_t volume, Blood blood, Below& below) noexcept {
  below.state.shed = mean(below.state.shed, fluids::at(below.ledger, Place::kPool).blood, blood, volume);
}

void put_into_pool(Vec3f at, const Mix& volume, Blood blood, Place from, Below& below) noexcept {
  if (volume.empty()) return;
  mix_into_pool(volume.blood, blood, below);
  const PoolPoint p = locate(below.model, vec_cast<double>(at));
  fall_into(below.model, below.floor, p.i, p.j, 4 * float(below.model.cell), volume, {0, 0, 0}, below.state);
  move(below.ledger, from, Place::kPool, volume);
}

void remove_empty(DropletState& s) noexcept {
  for (int i = s.count - 1; i >= 0; --i) {
    if (s.volume[i].total() > 0) continue;
    const int last = --s.count;
    for (auto* a : {&s.x, &s.y, &s.z, &s.vx, &s.vy, &s.vz, &s.radius}) (*a)[i] = (*a)[last];
    s.body[i] = s.body[last];
    s.ground[i] = s.ground[last];
    s.volume[i] = s.volume[last];
    s.id[i] = s.id[last];
    s.blood[i] = s.blood[last];
  }
}

}  // namespace detail

void add_to_hash(core::Hasher& h, const DropletState& s) noexcept { core::add_fields(h, s); }

}  // namespace trocar::fluids
