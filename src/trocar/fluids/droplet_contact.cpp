// Drops that meet something: landing, running down, what they leave behind, falling into the pool.
#include <algorithm>
#include <cmath>
#include <cstddef>

#include <trocar/fluids/droplets.hpp>
#include <trocar/numerics/portable.hpp>

namespace trocar::fluids {
namespace {

bool bounded(Vec3f p) {
  return std::fabs(p.x) < 1e3f && std::fabs(p.y) < 1e3f && std::fabs(p.z) < 1e3f;  // NaN is not
}
Vec3f position(const DropletState& s, int i) { return {s.x[i], s.y[i], s.z[i]}; }
Vec3f velocity(const DropletState& s, int i) { return {s.vx[i], s.vy[i], s.vz[i]}; }
void put(DropletState& s, int i, Vec3f x, Vec3f v) {
  s.x[i] = x.x, s.y[i] = x.y, s.z[i] = x.z;
  s.vx[i] = v.x, s.vy[i] = v.y, s.vz[i] = v.z;
}

constexpr float kPressed = 1e-3f;  ///< a running drop pushed or pulled across its surface faster hands it on [m/s]
constexpr float kStill = 1e-4f;    ///< [m/s]
constexpr float kOnBed = 1.5e-3f;  ///< a surface so high above the pool's bed is that bed, as its cells have it [m]

constexpr float kWet = 0.5e-3f;  ///< a pool is one from this depth on [m]

/// What stays the same for all drops of a tick.
struct Moment {
  const DropletModel& m;
  std::span<const Capsule> capsules;
  DropletState& s;
  DropletWork& w;
  Below& below;
  FluidReport& report;
  float dt, run_dt;       ///< a tick; by which a drop on a surface advances at once [s]
  Vec3f g;                ///< gravity [m/s^2]
  float per_viscosity;    ///< rho / 3 mu [s/m^2]
  float retention, hold;  ///< width-free retention and overhang [N/m]
  Vec3f up;               ///< of the pool
  float pool_top;  ///< along it; above it no drop can be in the pool (with 2 mm for what is poured between steps)
  float film;      ///< left behind per area run over [pL/m^2]
};

/// Some of what a drop does is done on one tick of `every` (a power of two), at different ones for different drops.
constexpr std::uint32_t kFilmEvery = 8, kPoolEveryFlying = 2, kPoolEveryUnasked = 4;
bool turn_of(const Moment& t, int i, std::uint32_t every) {
  return ((t.s.id[i] + std::uint32_t(t.s.tick)) & (every - 1)) == 0;
}

// ---- the film

/// After its volume has changed a little.
void refresh_radius(DropletState& s, int i) {
  const float c = float(kM3PerPicolitre * 3 / (4 * portable::pi)) * float(s.volume[i].total()), r = s.radius[i];
  s.radius[i] = r > 0 && c > 0 ? (2 * r + c / (r * r)) / 3 : radius_of(s.volume[i].total());
}
void add(SmallMix& to, const Mix& m) {
  to.blood += std::int32_t(m.blood), to.saline += std::int32_t(m.saline), to.bile += std::int32_t(m.bile);
}

/// Leaves `swept` picolitres behind where there is room, and changes as much with what lies there.
void leave_film(Moment& t, int i, std::int64_t swept) {
  const std::int32_t place = t.s.ground[i].film;
  if (place < 0 || swept <= 0) return;
  SmallMix& film = t.s.film[std::size_t(place)];
  SmallMix& drop = t.s.volume[i];
  const Mix washed = share(widened(film), swept), given = share(widened(drop), std::min(swept, washed.total()));
  const Mix back = share(washed, given.total());
  Blood &blood = t.s.blood[i], &film_blood = t.s.film_blood[std::size_t(place)];
  const Blood before = film_blood;
  film_blood = mean(film_blood, film.blood - back.blood, blood, given.blood);
  blood = mean(blood, drop.blood - given.blood, before, back.blood);
  add(drop, back - given), add(film, given - back);
  const std::int64_t room = std::max<std::int64_t>(t.m.film_capacity - film.total(), 0);
  const Mix left = share(widened(drop), std::min(swept, room));
  film_blood = mean(film_blood, film.blood, blood, left.blood);
  add(drop, Mix{} - left), add(film, left);
  move(t.below.ledger, Place::kDroplets, Place::kFilm, left + given - back);
  refresh_radius(t.s, i);
}

/// What is left of a drop that has become too small to run.
void become_film(Moment& t, int i) {
  const std::int32_t place = t.s.ground[i].film;
  if (place < 0) return;
  SmallMix& film = t.s.film[std::size_t(place)];
  if (film.total() > kMostInACell / 2) return;
  const Mix rest = widened(t.s.volume[i]);
  Blood& blood = t.s.film_blood[std::size_t(place)];
  blood = mean(blood, film.blood, t.s.blood[i], rest.blood);
  add(film, rest);
  t.s.volume[i] = {};
  t.w.emptied = true;
  move(t.below.ledger, Place::kDroplets, Place::kFilm, rest);
}

// ---- on a surface

void note_impact(Moment& t, int i, Vec3f point, Vec3f impulse, float drop_mass) {
  if (t.w.impact_count >= t.m.capacity) return;
  t.w.impacts[t.w.impact_count++] = {t.s.body[i], t.s.ground[i].film, point, impulse, drop_mass};
}

/// Speed along the surface after dt: gravity, retention by the contact line, the film's viscosity.
Vec3f run(const Moment& t, int i, Vec3f along, Vec3f g_along, float drop_mass, float dt) {
  const float r = t.s.radius[i], h = float(t.m.running_height) * r;
  const float tau = t.per_viscosity * (h * h);
  const Vec3f pushed = along + dt * g_along;
  const float stop = dt * t.retention * (2 * r) / drop_mass, speed = length(pushed);
  return speed > stop ? ((speed - stop) / (speed * (1 + dt / tau))) * pushed : Vec3f{0, 0, 0};
}

/// A drop that is on a surface, at the end of the tick. @param dt  by which it advances [s]
void run_down(Moment& t, int i, float dt) {
  DropletState& s = t.s;
  const Ground& ground = s.ground[i];
  const Vec3f n = ground.normal, relative = velocity(s, i) - ground.velocity;
  const float drop_mass = float(mass(widened(s.volume[i]), t.m.density)), r = s.radius[i];
  const float away = dot(n, t.g);
  if (away > 0 && drop_mass * away > t.hold * r) {  // too heavy for what it hangs from
    s.body[i] = -1;
    put(s, i, position(s, i) + (0.1f * r) * n, velocity(s, i));
    return;
  }
  const float across = dot(n, relative);
  if (std::fabs(across) > kPressed) note_impact(t, i, position(s, i), (drop_mass * across) * n, drop_mass);
  const Vec3f along = run(t, i, relative - across * n, t.g - away * n, drop_mass, dt);
  Vec3f x = position(s, i) + dt * (along + ground.velocity);
  x += (ground.offset + 0.5f * r - dot(n, x)) * n;
  put(s, i, x, along + ground.velocity);
  const float speed = length(along);
  if (speed == 0 || !turn_of(t, i, kFilmEvery)) return;
  const float way = std::max(float(kFilmEvery) * t.dt, t.run_dt) * speed;
  leave_film(t, i, std::int64_t(t.film * (2 * r * way)));
  if (s.volume[i].total() < t.m.smallest) become_film(t, i);
}

/// A drop in flight meets a plane: what it has across the surface goes to the body.
void land(Moment& t, int i, const Contact& c) {
  DropletState& s = t.s;
  s.body[i] = c.body;
  s.ground[i] = {c.normal, dot(c.normal, c.point), c.velocity, c.film};
  const Vec3f relative = velocity(s, i) - c.velocity;
  // Looked for some ticks ahead, it is put where it will be.
  if (t.w.ways > 1) put(s, i, c.point + (0.5f * s.radius[i]) * c.normal, velocity(s, i));
  const float across = dot(c.normal, relative);
  if (!(across < 0)) return;
  const float drop_mass = float(mass(widened(s.volume[i]), t.m.density));
  note_impact(t, i, c.point, (drop_mass * across) * c.normal, drop_mass);
  put(s, i, position(s, i), velocity(s, i) - across * c.normal);
}

bool sound(const Contact& c, const DropletState& s) {
  return c.body >= 0 && bounded(c.point) && bounded(c.normal) && bounded(c.velocity) &&
         std::fabs(dot(c.normal, c.normal) - 1) < 0.01f && c.film < std::int32_t(s.film.size());
}

/// The capsule that the point is in (with half its radius for a skin), as a plane; body -1 = none.
Contact capsule_at(const Moment& t, int i, std::int32_t near, Vec3f p) {
  Contact found;
  for (std::size_t k = 0; k < t.capsules.size() && k < 31; ++k) {
    if (((near >> k) & 1) == 0) continue;
    const Capsule& c = t.capsules[k];
    const float share = nearest_share(c, p);
    const Vec3f on_axis = c.a + share * (c.b - c.a), off = p - on_axis;
    const float far = length(off);
    if (!(far < c.radius + 0.6f * t.s.radius[i]) || !(far > 1e-6f)) continue;
    const Vec3f n = off / far;
    found = {on_axis + c.radius * n, n, c.va + share * (c.vb - c.va), c.body, -1};
  }
  return found;
}

/// Is it below the pool's surface? What flies there falls in before.
bool in_pool(const Moment& t, Vec3f p) {
  if (dot(p, t.up) > t.pool_top) return false;
  const PoolPoint at = locate(t.below.model, vec_cast<double>(p));
  const float depth = depth_at(t.below.model, t.below.state, at.i, at.j);
  return depth > kWet && at.height < floor_at(t.below.model, t.below.floor, at.i, at.j) + depth;
}

bool on_a_capsule(const Moment& t, int i) {
  for (const Capsule& c : t.capsules)
    if (c.body == t.s.body[i]) return true;
  return false;
}

/// What the drop is on at the end of the tick: what the caller said, what an instrument says, or what it was on.
/// @param question  as in DropletWork::question_of  @param near  as there
void meet(Moment& t, int i, std::int32_t question, std::int32_t near) {
  DropletState& s = t.s;
  const Vec3f to{t.w.to_x[i], t.w.to_y[i], t.w.to_z[i]};
  const Contact* said = question >= 0 ? &t.w.answers[std::size_t(question)] : nullptr;
  if (said && said->body >= 0 && !sound(*said, s)) {
    t.report.note(FluidReport::kBadContact, question);
    said = nullptr;
  }
  const Contact tool = near != 0 ? capsule_at(t, i, near, to) : Contact{};
  if (s.body[i] < 0) {
    const int ways = ways_of(t.w, velocity(s, i));
    const Vec3f end = ways == 1 ? to : position(s, i) + float(ways) * (to - position(s, i));
    const bool hit = said && said->body >= 0 && dot(said->normal, end - said->point) < 0.5f * s.radius[i];
    if (tool.body >= 0)
      land(t, i, tool);
    else if (hit && (t.w.ways == 1 || !in_pool(t, said->point)))
      land(t, i, *said);
  } else if (tool.body >= 0) {
    s.body[i] = tool.body;
    s.ground[i] = {tool.normal, dot(tool.normal, tool.point), tool.velocity, -1};
  } else if (said && said->body >= 0) {
    s.body[i] = said->body;
    s.ground[i] = {said->normal, dot(said->normal, said->point), said->velocity, said->film};
  } else if (said || on_a_capsule(t, i)) {
    s.body[i] = -1;  // nothing is there any more
  } else {
    s.ground[i].offset += t.run_dt * dot(s.ground[i].normal, s.ground[i].velocity);
  }
}

// ---- into the pool

/// Small drops that a drop throws up, in directions that turn from drop to drop; they take a seventh of it.
void splash(Moment& t, int i, Vec3f surface, Vec3f v, float fall) {
  constexpr float kRing[8][2] = {{1, 0},  {0.70710678f, 0.70710678f},   {0, 1},  {-0.70710678f, 0.70710678f},
                                 {-1, 0}, {-0.70710678f, -0.70710678f}, {0, -1}, {0.70710678f, -0.70710678f}};
  const std::int64_t each = t.s.volume[i].total() / 21;
  if (each < t.m.smallest / 8) return;
  const Vec3f up = vec_cast<float>(t.below.model.up), u = vec_cast<float>(t.below.model.u);
  const Vec3f w = vec_cast<float>(t.below.model.v);
  for (std::uint32_t n = 0; n < 3; ++n) {
    const auto& ring = kRing[(3 * n + t.s.id[i]) % 8];
    const Mix part = share(widened(t.s.volume[i]), each);
    const Vec3f thrown = 0.2f * (v + fall * up) + (0.35f * fall) * up + (0.2f * fall) * (ring[0] * u + ring[1] * w);
    const Vec3f from = surface + (3 * radius_of(each)) * up;
    if (!add_drop(t.m, from, thrown, part, t.s)) return;
    t.s.blood[t.s.count - 1] = t.s.blood[i];
    add(t.s.volume[i], Mix{} - part);
    t.w.to_x[t.s.count - 1] = from.x, t.w.to_y[t.s.count - 1] = from.y, t.w.to_z[t.s.count - 1] = from.z;
  }
}

/// A large drop that lies still on the pool's bed is pool: what lands on level ground would heap up for ever.
bool settles(const Moment& t, int i, float above_bed) {
  const Vec3f along = velocity(t.s, i) - t.s.ground[i].velocity;
  return t.s.volume[i].total() >= t.m.largest_running / 2 && dot(along, along) < kStill * kStill &&
         above_bed < t.s.radius[i] + kOnBed;
}

/// Whether a drop is below the pool's surface (or its bed), and what follows.
void fall_in(Moment& t, int i) {
  const PoolModel& pool = t.below.model;
  if (dot(position(t.s, i), t.up) > t.pool_top) return;
  const PoolPoint at = locate(pool, vec_cast<double>(position(t.s, i)));
  const float bed = floor_at(pool, t.below.floor, at.i, at.j), depth = depth_at(pool, t.below.state, at.i, at.j);
  const bool wet = depth > kWet, flies = t.s.body[i] < 0;
  const bool in = wet && flies ? at.height <= bed + depth : at.height <= bed + (wet ? depth - t.s.radius[i] : -2e-3f);
  const bool lies = !flies && at.inside && settles(t, i, at.height - bed);
  if (!in && !lies && !(flies && !wet && at.height <= bed)) return;
  const Vec3f v = velocity(t.s, i), up = vec_cast<float>(pool.up);
  const Vec3f own{dot(v, vec_cast<float>(pool.u)), dot(v, vec_cast<float>(pool.v)), dot(v, up)};
  if (wet && flies && own.z < 0) {
    const float weber = float(t.m.density.blood / t.m.surface_tension) * own.z * own.z * 2 * t.s.radius[i];
    if (weber > float(t.m.splash)) splash(t, i, position(t.s, i) + (bed + depth - at.height) * up, v, -own.z);
  }
  const Mix volume = widened(t.s.volume[i]);
  // Over its own width and more, so that the surface is raised by no more than half a millimetre or so (our choice).
  const float wide = 60 * std::sqrt(t.s.radius[i] * t.s.radius[i] * t.s.radius[i]);
  detail::mix_into_pool(volume.blood, t.s.blood[i], t.below);
  fall_into(pool, t.below.floor, at.i, at.j, wide, volume, own, t.below.state);
  move(t.below.ledger, Place::kDroplets, Place::kPool, volume);
  t.s.volume[i] = {};
  t.w.emptied = true;
}

// ---- the whole

/// Sets a bit of movers whose end point is in a box.
void mark_within(int count, Vec3f low, Vec3f high, std::int32_t bit, DropletWork& w) {
  const float *x = w.sx.data(), *y = w.sy.data(), *z = w.sz.data();
  std::int32_t* __restrict near = w.near.data();
  for (int i = 0; i < count; ++i) {
    const float dx = std::fabs(x[i] - 0.5f * (low.x + high.x)), dy = std::fabs(y[i] - 0.5f * (low.y + high.y));
    const float dz = std::fabs(z[i] - 0.5f * (low.z + high.z));
    const std::int32_t in_x = dx < 0.5f * (high.x - low.x) ? bit : 0, in_y = dy < 0.5f * (high.y - low.y) ? bit : 0;
    const std::int32_t in_z = dz < 0.5f * (high.z - low.z) ? bit : 0;
    near[i] = near[i] | (in_x & in_y & in_z);
  }
}

/// Bits of the capsules in whose box (grown by the largest drop) a drop ends up.
void find_near(Moment& t) {
  DropletWork& w = t.w;
  for (int k = 0; k < w.mover_count; ++k) {
    const std::int32_t i = w.movers[k];
    w.sx[k] = w.to_x[i], w.sy[k] = w.to_y[i], w.sz[k] = w.to_z[i];
    w.near[k] = 0;
  }
  const float grown = 2 * radius_of(t.m.largest_running);
  for (std::size_t k = 0; k < t.capsules.size(); ++k) {
    const Capsule& c = t.capsules[k];
    if (!trocar::fluids::sound(c) || k >= 31) {
      t.report.note(FluidReport::kBadContact, std::int32_t(k));
      continue;
    }
    const float r = c.radius + grown;
    const Vec3f low{std::min(c.a.x, c.b.x) - r, std::min(c.a.y, c.b.y) - r, std::min(c.a.z, c.b.z) - r};
    const Vec3f high{std::max(c.a.x, c.b.x) + r, std::max(c.a.y, c.b.y) + r, std::max(c.a.z, c.b.z) + r};
    mark_within(w.mover_count, low, high, std::int32_t(1) << k, w);
  }
}

/// Places of film that hold too much let a drop go.
void run_over(Moment& t) {
  for (int k = 0; k < t.w.film_questions; ++k) {
    const Contact& c = t.w.film_answers[std::size_t(k)];
    const std::int32_t place = t.w.overfull[std::size_t(k)];
    if (c.body < 0) continue;
    if (!sound(c, t.s)) {
      t.report.note(FluidReport::kBadContact, place);
      continue;
    }
    SmallMix& film = t.s.film[std::size_t(place)];
    const Mix drop = share(widened(film), std::min(film.total() - t.m.film_capacity, t.m.largest));
    const float r = radius_of(drop.total());
    if (!add_drop(t.m, c.point + (0.5f * r) * c.normal, c.velocity, drop, t.s)) {
      if (drop.empty()) continue;
      t.report.note(FluidReport::kDropletsFull, place);
      detail::put_into_pool(c.point, drop, t.s.film_blood[std::size_t(place)], Place::kFilm, t.below);
    } else {
      const int i = t.s.count - 1;
      t.s.body[i] = c.body;
      t.s.blood[i] = t.s.film_blood[std::size_t(place)];
      t.s.ground[i] = {c.normal, dot(c.normal, c.point), c.velocity, place};
      move(t.below.ledger, Place::kFilm, Place::kDroplets, drop);
    }
    add(film, Mix{} - drop);
  }
}

}  // namespace

FluidReport resolve(const DropletModel& m, std::span<const Capsule> capsules, DropletState& s, DropletWork& w,
                    Below& below) noexcept {
  FluidReport report;
  const Vec3f g = vec_cast<float>(m.gravity);
  Moment t{.m = m,
           .capsules = capsules,
           .s = s,
           .w = w,
           .below = below,
           .report = report,
           .dt = float(m.tick),
           .run_dt = float(m.tick * m.run_period),
           .g = g,
           .per_viscosity = float(m.density.blood / (3 * m.viscosity)),
           .retention = float(m.surface_tension * m.hysteresis),
           .hold = float(2 * portable::pi * m.surface_tension * m.overhang),
           .up = vec_cast<float>(below.model.up),
           .pool_top = float(dot(below.model.origin, below.model.up)) + below.state.highest + 2e-3f,
           .film = float(m.film_thickness * kPicolitresPerM3)};
  w.impact_count = 0;
  find_near(t);
  for (int k = 0; k < w.mover_count; ++k) {  // what splashes or runs over begins its way in the next tick
    const std::int32_t i = w.movers[k], question = w.question_of[k];
    if (s.volume[i].total() <= 0) continue;
    if (question == -1) {
      put(s, i, {w.to_x[i], w.to_y[i], w.to_z[i]}, velocity(s, i));
      if (turn_of(t, i, kPoolEveryUnasked)) fall_in(t, i);
      continue;
    }
    const bool flew = s.body[i] < 0;
    meet(t, i, question, w.near[k]);
    if (s.body[i] >= 0)
      run_down(t, i,
               flew && w.ways > 1 ? t.dt : t.run_dt);  // crowds advance by much at a time: not from the jet's speed
    else
      put(s, i, {w.to_x[i], w.to_y[i], w.to_z[i]}, velocity(s, i));
    if (s.body[i] >= 0 || turn_of(t, i, kPoolEveryFlying)) fall_in(t, i);
  }
  run_over(t);
  if (w.emptied) detail::remove_empty(s);
  ++s.tick;
  return report;
}

Mix draw_drops(const DropletModel&, Vec3f p, float radius, std::int64_t amount, DropletState& s) noexcept {
  Mix out;
  if (!bounded(p) || !(radius > 0)) return out;
  bool any = false;
  for (int i = 0; i < s.count && amount > 0; ++i) {
    const float dx = s.x[i] - p.x, dy = s.y[i] - p.y, dz = s.z[i] - p.z;
    if ((dx * dx + dy * dy) + dz * dz > radius * radius) continue;
    const Mix taken = share(widened(s.volume[i]), amount);
    add(s.volume[i], Mix{} - taken);
    if (s.volume[i].total() > 0) s.radius[i] = radius_of(s.volume[i].total());
    amount -= taken.total();
    out += taken;
    any = true;
  }
  if (any) detail::remove_empty(s);
  return out;
}

DropletWork make_work(const DropletModel& m) {
  DropletWork w;
  const auto n = std::size_t(m.capacity);
  for (auto* a :
       {&w.to_x, &w.to_y, &w.to_z, &w.sx, &w.sy, &w.sz, &w.svx, &w.svy, &w.svz, &w.sr, &w.sm, &w.jx, &w.jy, &w.jz})
    a->assign(n, 0.0f);
  for (auto* a : {&w.asking, &w.movers, &w.near, &w.question_of, &w.chosen, &w.sorted, &w.cell_of, &w.own_cell,
                  &w.joined, &w.neighbours})
    a->assign(n + 1, 0);
  w.pairs.assign(16 * n, {0, 0});
  w.answers.assign(n, Contact{});
  w.impacts.assign(n, Impact{});
  w.overfull.assign(kFilmQuestions, 0);
  w.film_answers.assign(kFilmQuestions, Contact{});
  std::size_t buckets = 1024;
  while (buckets < 2 * n) buckets *= 2;
  w.bucket_first.assign(buckets + 1, 0);
  w.filled.assign(detail::kPairCells / 64, 0);
  return w;
}

}  // namespace trocar::fluids
