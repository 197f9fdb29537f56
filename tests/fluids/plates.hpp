// A scene for tests: a basin, surfaces made of planes, and the caller's half of a tick.
#pragma once

#include <cmath>
#include <vector>

#include <trocar/fluids/fluids.hpp>

namespace trocar::fluids::test {

/// A round plate: where its plane is within `radius` of `centre`. Film places in rings of 4 mm around the centre.
struct Plate {
  Vec3f centre{0, 0, 0}, normal{0, 0, 1}, velocity{0, 0, 0};
  float radius = 0.1f;
  std::int32_t body = 0, first_film = -1;
  int film_cells = 0;
};

struct Scene {
  FluidsModel m;
  FluidsState s;
  FluidsWork w;
  std::vector<float> floor;
  std::vector<Plate> plates;
  std::vector<Outlet> openings;
  std::vector<SuctionIrrigator> tools;
  std::vector<Capsule> capsules;
  std::vector<Drain> drains;
  std::vector<Boiled> boiled;
  SmokeInput smoke;
  Vec3f impulse{0, 0, 0};  ///< of all impacts so far [N s]

  explicit Scene(const FluidsDescription& d)
      : m(build(d)), s(initial_state(m)), w(make_work(m)), floor(std::size_t(d.pool.nx) * d.pool.ny, 0.0f) {}

  FluidsInput input() const { return {openings, tools, capsules, floor, drains, boiled, smoke}; }

  Contact answer(Vec3f p, float reach) const {
    for (const Plate& plate : plates) {
      const Vec3f d = p - plate.centre;
      const float off = dot(d, plate.normal);
      const Vec3f flat = d - off * plate.normal;
      if (off > reach || off < -0.01f || length(flat) > plate.radius) continue;
      const int place = int(length(flat) / 0.004f);
      return {p - off * plate.normal, plate.normal, plate.velocity, plate.body,
              place < plate.film_cells ? plate.first_film + place : -1};
    }
    return {};
  }

  FluidsReport tick() {
    FluidReport first = begin_tick(m, input(), s, w);
    DropletWork& d = w.droplets;
    for (int k = 0; k < d.questions; ++k) {
      const int i = d.asking[k];
      const float r = s.droplets.radius[i];
      d.answers[k] = s.droplets.body[i] < 0 ? answer({d.to_x[i], d.to_y[i], d.to_z[i]}, 0.5f * r)
                                            : answer({s.droplets.x[i], s.droplets.y[i], s.droplets.z[i]}, 3 * r);
    }
    for (int k = 0; k < d.film_questions; ++k)
      for (const Plate& plate : plates) {
        const int ring = d.overfull[k] - plate.first_film;
        if (ring < 0 || ring >= plate.film_cells) continue;
        const Vec3f out = any_perpendicular(plate.normal);
        d.film_answers[k] = {plate.centre + (0.004f * (float(ring) + 0.5f)) * out, plate.normal, plate.velocity,
                             plate.body, d.overfull[k]};
      }
    FluidsReport r = finish_tick(m, input(), s, w);
    r.report = first | r.report;
    for (int k = 0; k < d.impact_count; ++k) impulse += d.impacts[k].impulse;
    return r;
  }

  double millilitres(Place place) const { return double(at(s.ledger, place).total()) / double(kMillilitre); }
  std::uint64_t hash() const {
    core::Hasher h;
    add_to_hash(h, s);
    return h.value();
  }
};

/// A basin of 64 x 64 cells of 2.5 mm around the origin, floor at z = 0, a thousand drops, a hundred places of film.
inline FluidsDescription small_scene() {
  FluidsDescription d;
  d.pool.nx = d.pool.ny = 64;
  d.pool.cell = 0.0025;
  d.pool.origin = {-0.08, -0.08, 0};
  d.droplets.capacity = 1000;
  d.droplets.film_cells = 100;
  d.smoke.origin = {-0.08, -0.08, 0};
  d.smoke.nx = d.smoke.ny = d.smoke.nz = 8;
  d.smoke.cell = 0.02;
  return d;
}

/// `flow` in cubic metres per second of blood out of a hole of `area`.
inline Outlet bleeding(Vec3f at, Vec3f direction, double flow, double area) {
  Outlet o;
  o.position = at, o.direction = direction, o.area = area;
  o.flow.blood = std::int64_t(std::round(flow * 1e-3 * kPicolitresPerM3));
  return o;
}

}  // namespace trocar::fluids::test
