// What the tests of heat share: a body with its state, shapes of tissue, and the account.
#pragma once

#include <algorithm>
#include <cmath>

#include <trocar/tissue/heat/electrosurgery.hpp>
#include <trocar/tissue/heat/heat.hpp>

#include "validation.hpp"

namespace trocar::tissue::test {

/// Tissue below z = 0.
inline void fill_below(const void*, BodyId, Vec3d corner, double cell, std::span<std::uint8_t> tissue) noexcept {
  for (int c = 0; c < kBrickCells; ++c) tissue[c] = corner.z + (c / (kBrickSide * kBrickSide) + 0.5) * cell < 0;
}
inline TissueShape half_space() { return {nullptr, fill_below}; }

/// One brick of tissue, [0, 8 cells)^3, in gas.
inline void fill_cube(const void*, BodyId, Vec3d corner, double cell, std::span<std::uint8_t> tissue) noexcept {
  const bool inside =
      std::fabs(corner.x) < 0.5 * cell && std::fabs(corner.y) < 0.5 * cell && std::fabs(corner.z) < 0.5 * cell;
  std::fill(tissue.begin(), tissue.end(), std::uint8_t(inside));
}
inline TissueShape cube() { return {nullptr, fill_cube}; }

struct Heated {
  HeatModel m;
  HeatState s;
  HeatWork w;
  TissueShape shape;
  std::uint32_t flags = 0;
  double boiled = 0;  ///< [kg]

  explicit Heated(const HeatDescription& d, TissueShape tissue = {})
      : m(build(d)), s(cold(m)), w(make_work(m)), shape(tissue) {}

  void tick(std::span<const HeatSource> sources = {}) {
    const HeatReport r = advance(m, sources, shape, s, w);
    flags |= r.flags;
    boiled += r.boiled;
  }
  void run(double seconds, std::span<const HeatSource> sources = {}) {
    for (int t = 0; t < int(seconds / m.tick + 0.5); ++t) tick(sources);
  }
  double celsius(Vec3d at, BodyId body = BodyId::strand(0)) const {
    return double(reading(m, s, body, at).temperature);
  }
  /// Given over booked, less 1. Only between steps.
  double imbalance() const {
    const HeatBooks& b = s.books;
    const double out = b.boiled + b.burnt + b.perfused + b.surface + b.conducted + b.dropped;
    return (stored(m, s) + out) / b.given - 1;
  }
  /// Farthest point from `from` along `way` that is above a value of `what` [m].
  template <class What>
  double spread(Vec3d from, Vec3d way, double above, What what) const {
    double farthest = 0;
    for (double r = 0; r < 0.03; r += 2e-5)
      if (double(what(reading(m, s, BodyId::strand(0), from + r * way))) > above) farthest = r;
    return farthest;
  }
  double spread_of(double celsius_above, Vec3d from, Vec3d way = {1, 0, 0}) const {
    return spread(from, way, celsius_above, [](const HeatReading& r) { return r.temperature; });
  }
  double coagulated_to(Vec3d from, Vec3d way = {1, 0, 0}) const {
    return spread(from, way, 0.5, [](const HeatReading& r) { return r.coagulated; });
  }
  std::uint64_t hash() const {
    core::Hasher h;
    add_to_hash(h, s);
    return h.value();
  }
};

/// Neither blood nor gas takes anything.
inline HeatDescription insulated() {
  HeatDescription d;
  d.perfusion = 0;
  d.surface = 0;
  return d;
}

/// Heats all cells of cube() alike.
inline HeatSource all_over(const HeatDescription& d, double watts) {
  const double middle = 0.5 * kBrickSide * d.cell;
  return {.by_current = 0,
          .a = {middle, middle, middle},
          .b = {middle, middle, middle},
          .radius = 4.9e-3,
          .reach = 1,
          .watts = watts};
}

/// An electrode in tissue.
struct Operated : Heated {
  ElectrodeDescription e;
  ElectrodeState es;
  GeneratorPanel panel;
  Discharge last;
  using Heated::Heated;
  void press(FootSwitch pedals, const ElectrodeContact& contact) {
    last = energise(e, panel, pedals, contact, m, shape, s, w, es);
    tick(last.span());
  }
  void press_for(double seconds, FootSwitch pedals, const ElectrodeContact& contact) {
    for (int t = 0; t < int(seconds / m.tick + 0.5); ++t) press(pedals, contact);
  }
};
inline constexpr Vec3d kJustBelow{0, 0, -0.1e-3}, kTopCells{0, 0, -0.25e-3};
inline ElectrodeContact tip_at(Vec3d at) { return {.body = BodyId::strand(0), .a = at, .b = at}; }

}  // namespace trocar::tissue::test
