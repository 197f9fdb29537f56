// Peristalsis: directed force waves [KCM99, "morpho-dynamics"; the formula is our choice]. Rings of contraction run
// along the centre line of a hollow organ and draw its wall together:
//
//   f = A n sum_k g(s - v (t - k T)),   g(d) = exp(-d^2 / 2 sigma^2)
//
// with s the way along the line, v the waves' speed, T the time between two of them, n the direction across the line.
// Where v changes along the way, s - v t is v (tau - t) with tau the time that a wave takes to s.
//
// Every node of the organ pulls at the one opposite it, with forces along the line between the two as they lie now:
// what circular muscle does. Whatever the organ's shape, the forces of a wave and their moment sum to zero. A is a
// pressure p (what a manometer in the lumen shows) times the wall's area, shared out over the organ's inside: a node of
// volume V at the distance r from the line has
//
//   A = 3 p V r / R^2,
//
// which over a round section of radius R adds up to p times its outline. On the outermost nodes alone it would fold the
// cells there before the ring is a quarter of the radius deep.
//
//   const ForceWaveModel wave = build(description, rest, volume);
//   add_wave(wave, nodes, t, force);                             // (nodes) [N]
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <trocar/core/fields.hpp>
#include <trocar/core/hash.hpp>
#include <trocar/tissue/network/node_view.hpp>

namespace trocar::tissue {

/// What waves are like at one place; linear in between, constant beyond the first and the last one.
struct ForceWaveStation {
  double s = 0;         ///< way along the centre line [m]
  double pressure = 0;  ///< at a wave's crest [Pa]
  double speed = 0;     ///< [m/s] > 0
};

struct ForceWaveDescription {
  std::vector<Vec3d> centreline;           ///< points, in the direction in which waves run [m]
  std::vector<ForceWaveStation> stations;  ///< by rising s
  double width = 0.010;                    ///< sigma [m]
  double period = 20;                      ///< T [s]
  double first = 0;                        ///< when a crest is at s = 0 [s]
  double cycle = 60;                       ///< the organ is active for a share of this time [s] ...
  double active = 1;                       ///< ... beginning with it; 1: always
};

/// Two nodes on opposite sides of the line.
struct ForceWavePair {
  std::int32_t a = 0, b = 0;
  double force = 0;  ///< of each on the other at a crest [N]
  double delay = 0;  ///< tau [s]
  double sharp = 0;  ///< v / sigma [1/s]

  template <class S, class V>
  static void fields(S& s, V&& v) {
    v("a", s.a), v("b", s.b), v("force", s.force), v("delay", s.delay), v("sharp", s.sharp);
  }
};

struct ForceWaveModel {
  std::vector<ForceWavePair> pairs;
  std::vector<std::int32_t> nodes;  ///< that forces can act on, ascending
  double period = 0, first = 0, cycle = 0, active = 1;

  template <class S, class V>
  static void fields(S& s, V&& v) {
    v("pairs", s.pairs), v("nodes", s.nodes), v("period", s.period), v("first", s.first), v("cycle", s.cycle),
        v("active", s.active);
  }
};

/// Compiles a wave for an organ.
/// @param rest, volume  (nodes) in the drawn shape [m], [m^3]
/// Throws std::invalid_argument where no part of it lies around the line.
ForceWaveModel build(const ForceWaveDescription& description, std::span<const Vec3d> rest,
                     std::span<const double> volume);

/// Share of a pair's force at time t [s], 0 to about 1: the waves that are near it then.
double wave_height(const ForceWaveModel& wave, const ForceWavePair& pair, double t) noexcept;

/// Adds the forces at time t [s] to those of the nodes [N].
void add_wave(const ForceWaveModel& wave, const NodeView& nodes, double t, std::span<Vec3d> force) noexcept;

void add_to_hash(core::Hasher& hasher, const ForceWaveModel& wave) noexcept;

}  // namespace trocar::tissue
